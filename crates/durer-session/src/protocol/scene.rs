//! Messages about a scene, its camera and its picture.

use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// An option of the render job and its value, as they are written on the command line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Setting {
    /// Name on the command line.
    pub name: String,
    /// Value as on the command line.
    pub value: String,
}

/// A motion of the camera that a page requests, such as an orbit or a pan.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Motion {
    /// Orbits around the target. Angles are in radians.
    Orbit {
        /// To the right.
        right: f32,
        /// Upwards.
        up: f32,
    },
    /// Moves the camera sideways, in units of the visible height at the target.
    Pan {
        /// To the right.
        right: f32,
        /// Upwards.
        up: f32,
    },
    /// Moves the camera towards the target.
    Dolly {
        /// Factor on the distance to the target, 0.01 to 100.
        factor: f32,
    },
    /// Walks through the scene, in units of the distance to the target.
    Walk {
        /// Forwards.
        forward: f32,
        /// To the right.
        right: f32,
        /// Upwards.
        up: f32,
    },
    /// Turns the camera around the eye. Angles are in radians.
    Turn {
        /// To the right.
        right: f32,
        /// Upwards.
        up: f32,
    },
    /// Restores the camera that is defined in the text.
    Home,
    /// Moves the camera back along the view direction until the full scene is visible.
    Frame,
}

/// An item that a page offers for selection, such as an integrator, with its description.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct NamedChoice {
    /// Name of the item.
    pub name: String,
    /// Meaning of the item.
    pub doc: String,
}

/// Position of an item or a finding in the text of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct TextPosition {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// Byte offset of the start.
    pub start: u32,
    /// Byte offset of the end of the keyword, exclusive.
    pub end: u32,
    /// Byte offset of the end of the statement's block, exclusive; equal to `end` if no block
    /// follows the keyword.
    pub block_end: u32,
}

/// Severity of a [`Finding`]: a note, a warning or an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The finding is only informative.
    Note,
    /// The picture may differ from what the author intended.
    Warning,
    /// The scene cannot be rendered.
    Error,
}

/// An error, a warning or a note about the text of a scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Finding {
    /// Severity of the finding.
    pub severity: Severity,
    /// Kind of the finding; may be empty.
    pub code: String,
    /// Message in one sentence.
    pub message: String,
    /// Hint on how to fix the problem.
    pub help: Option<String>,
    /// Effect on the picture.
    pub effect: Option<String>,
    /// Name of the file, if it is not the scene's own.
    pub file: Option<String>,
    /// Place in the file.
    pub place: Option<TextPosition>,
    /// Edits that fix the problem.
    pub fix: Vec<TextEdit>,
}

/// A text replacement that is part of the fix of a [`Finding`].
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct TextEdit {
    /// Byte offset of the start of the replaced range.
    pub start: u32,
    /// Byte offset of its end, exclusive.
    pub end: u32,
    /// Replacement.
    pub text: String,
}

/// Summary of a scene with its camera, objects, lights, bounds and job options.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct SceneSummary {
    /// Name of the dialect.
    pub dialect: String,
    /// The current camera.
    pub camera: CameraState,
    /// Objects by number, up to a limit.
    pub objects: Vec<SceneItem>,
    /// Number of objects.
    pub object_count: u32,
    /// Number of triangles.
    pub triangles: f64,
    /// Lights by number.
    pub lights: Vec<SceneItem>,
    /// Minimum and maximum corner of the bounding box of all bounded objects, in world space.
    pub bounds: [[f32; 3]; 2],
    /// Options of the job, without its size.
    pub job: JobState,
}

/// Options of the render job as a page shows them.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct JobState {
    /// Default size of the scene, in pixels.
    pub size: [u32; 2],
    /// Name of the integrator.
    pub integrator: String,
    /// Samples per pixel.
    pub samples: u32,
    /// Maximum depth of mirrored and transmitted rays.
    pub bounces: u32,
    /// Options that differ from the scene's defaults, as command-line arguments.
    pub words: Vec<String>,
}

/// An object or light in the list of a scene's contents.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct SceneItem {
    /// Keyword and line.
    pub name: String,
    /// Place in the scene's text.
    pub place: Option<TextPosition>,
}

/// The current camera of a session with its position, directions and fields.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct CameraState {
    /// Keyword of the camera.
    pub keyword: String,
    /// Position of the eye in world space.
    pub eye: [f32; 3],
    /// View direction in world space, unit length.
    pub forward: [f32; 3],
    /// Right direction of the picture in world space.
    pub right: [f32; 3],
    /// Up direction of the picture in world space.
    pub up: [f32; 3],
    /// Half the visible width at distance 1, along the larger side.
    pub half_width: f64,
    /// Distance from the eye to the target.
    pub distance: f32,
    /// True if straight lines in space appear as straight lines in the picture, as with a pinhole.
    /// A point at (x, y, z) in the coordinates of `right`, `up` and `forward` is then shown at
    /// (x, y) / (z `half_width`).
    pub projects: bool,
    /// Fields of the camera.
    pub fields: Vec<FieldState>,
    /// Statement of the camera in the scene language.
    pub statement: String,
    /// True if the camera differs from the one in the text.
    pub moved: bool,
}

/// A field of a camera or material, with its value and range.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct FieldState {
    /// Keyword in the scene language.
    pub name: String,
    /// Meaning and unit.
    pub doc: String,
    /// Numbers of the value; empty for words and files.
    pub values: Vec<f32>,
    /// Value, if it is a word or a file name.
    pub text: String,
    /// Minimum value, if there is one.
    pub least: Option<f32>,
    /// Maximum value, if there is one.
    pub most: Option<f32>,
    /// True if the value must be greater than `least`.
    pub above_least: bool,
    /// True if the value must be less than `most`.
    pub below_most: bool,
    /// True for a whole number.
    pub whole: bool,
    /// Possible values, if the value is a word; otherwise empty.
    pub choices: Vec<String>,
}

/// A common mistake that a page can offer as a switch, with its description and its code.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct MistakeChoice {
    /// Name of the mistake.
    pub name: String,
    /// Description in words.
    pub description: String,
    /// Correct code.
    pub right: String,
    /// Wrong code.
    pub wrong: String,
    /// Topic of the lecture that covers the mistake.
    pub topic: String,
    /// Values with which the mistake is tried; a single 0 if it has none.
    pub values: Vec<f32>,
}

/// Description of a picture that is sent to a page, including its size, progress and timing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct PictureInfo {
    /// `color`, or the name of an auxiliary picture.
    pub picture: String,
    /// Width of the payload in pixels.
    pub width: u32,
    /// Height of the payload in pixels.
    pub height: u32,
    /// Width of the full picture in pixels; more than `width` for a coarse picture.
    pub full_width: u32,
    /// Height of the full picture in pixels.
    pub full_height: u32,
    /// Samples per pixel so far.
    pub samples: u32,
    /// Samples per pixel of the finished picture.
    pub all_samples: u32,
    /// Part of the picture that follows, in pixels of the full picture: first column, first row,
    /// width and height. A coarse part may extend beyond the edge.
    pub region: [u32; 4],
    /// Visible error, which `durer render --noise-threshold` limits; `None` if not yet known.
    pub noise: Option<f64>,
    /// Estimated time until the picture is finished, in milliseconds; `None` if not yet known.
    pub left_ms: Option<f64>,
    /// True if the picture is denoised.
    pub denoised: bool,
    /// Number of rays traced.
    pub rays: f64,
    /// Time since the change that the picture shows, in milliseconds.
    pub ms: f64,
    /// Hash of the finished picture, as `durer render --hash` prints it.
    pub hash: Option<String>,
}

/// A keyword that begins a statement of the scene language, with its documentation.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Keyword {
    /// The keyword.
    pub word: String,
    /// Chapter of the manual.
    pub chapter: String,
    /// Meaning.
    pub doc: String,
    /// Fields of its block.
    pub fields: Vec<KeywordField>,
    /// Example.
    pub example: String,
}

/// A field in the block of a statement, with its documentation.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct KeywordField {
    /// The keyword.
    pub word: String,
    /// Type and range.
    pub value: String,
    /// Default value.
    pub default: Option<String>,
    /// True if the field is required.
    pub required: bool,
    /// Meaning and unit.
    pub doc: String,
}
