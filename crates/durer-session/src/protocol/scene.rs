//! Messages about a scene, its camera and its picture.

use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// An option of a job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Setting {
    /// Name on the command line.
    pub name: String,
    /// Value as on the command line.
    pub value: String,
}

/// A motion of the camera.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Motion {
    /// Around what it looks at, in radians: to the right and upwards.
    Orbit {
        /// To the right.
        right: f32,
        /// Upwards.
        up: f32,
    },
    /// Sideways, in heights of what is seen.
    Pan {
        /// To the right.
        right: f32,
        /// Upwards.
        up: f32,
    },
    /// Towards what it looks at: the distance is multiplied by this.
    Dolly {
        /// The factor.
        factor: f32,
    },
    /// On foot, in shares of the distance to what it looks at.
    Walk {
        /// Forwards.
        forward: f32,
        /// To the right.
        right: f32,
        /// Upwards.
        up: f32,
    },
    /// Looks around from where it is, in radians.
    Turn {
        /// To the right.
        right: f32,
        /// Upwards.
        up: f32,
    },
    /// Back to the camera of the text.
    Home,
    /// Away along its direction, until all of the scene is seen.
    Frame,
}

/// One of several.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Choice {
    /// Its name.
    pub name: String,
    /// Its meaning.
    pub doc: String,
}

/// A place in the scene's text.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Place {
    /// Line from 1.
    pub line: u32,
    /// Column from 1, in characters.
    pub column: u32,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// The picture may not be what was meant.
    Warning,
    /// No picture can be made.
    Error,
}

/// Finding in a text.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// Its kind, or nothing.
    pub code: String,
    /// In a sentence.
    pub message: String,
    /// Advice.
    pub help: Option<String>,
    /// Effect on the picture.
    pub effect: Option<String>,
    /// The file, if it is not the scene's.
    pub file: Option<String>,
    /// Place in it.
    pub place: Option<Place>,
    /// Edits that fix it.
    pub fix: Vec<Change>,
}

/// A change of the text.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Change {
    /// First byte that is replaced.
    pub start: u32,
    /// One past the last.
    pub end: u32,
    /// By what.
    pub text: String,
}

/// Contents of a scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Contents {
    /// Name of the dialect.
    pub dialect: String,
    /// The camera.
    pub camera: CameraState,
    /// Objects, by number, up to a limit.
    pub objects: Vec<Thing>,
    /// Number of objects.
    pub object_count: u32,
    /// Number of triangles.
    pub triangles: f64,
    /// Lights, by number.
    pub lights: Vec<Thing>,
    /// Two opposite corners of the box around all that has an end.
    pub bounds: [[f32; 3]; 2],
    /// The job, as on the command line, but for its size.
    pub job: JobState,
}

/// Job of a picture.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct JobState {
    /// The size that the scene has by default.
    pub size: [u32; 2],
    /// Name of the integrator.
    pub integrator: String,
    /// Samples a pixel.
    pub samples: u32,
    /// Levels of mirrored and transmitted rays.
    pub bounces: u32,
    /// Options that differ from the scene's defaults, as words of a command line.
    pub words: Vec<String>,
}

/// Something that is written in a scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Thing {
    /// Its keyword and line.
    pub name: String,
    /// Place in the scene's text.
    pub place: Option<Place>,
}

/// A camera.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct CameraState {
    /// Its keyword.
    pub keyword: String,
    /// The eye.
    pub eye: [f32; 3],
    /// View direction, of length 1.
    pub forward: [f32; 3],
    /// To the right in the picture.
    pub right: [f32; 3],
    /// Upwards in the picture.
    pub up: [f32; 3],
    /// Half the width of what is seen at distance 1, by the larger side.
    pub half_width: f64,
    /// Distance of what it looks at.
    pub distance: f32,
    /// Its fields.
    pub fields: Vec<FieldState>,
    /// How it is written.
    pub statement: String,
    /// True if it differs from the text.
    pub moved: bool,
}

/// A field of a camera.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct FieldState {
    /// Its word in the scene language.
    pub name: String,
    /// Meaning and unit.
    pub doc: String,
    /// Its numbers; none for words and files.
    pub values: Vec<f32>,
    /// Its value if that is a word or a file name.
    pub text: String,
    /// Least value, if there is one.
    pub least: Option<f32>,
    /// Greatest value, if there is one.
    pub most: Option<f32>,
}

/// Description of a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct PictureHead {
    /// `color`, or the name of another picture.
    pub picture: String,
    /// Columns of what follows.
    pub width: u32,
    /// Rows of what follows.
    pub height: u32,
    /// Columns of the whole picture: more than `width` where it is coarse.
    pub full_width: u32,
    /// Rows of the whole picture.
    pub full_height: u32,
    /// Samples that each pixel has.
    pub samples: u32,
    /// Samples that each pixel gets.
    pub all_samples: u32,
    /// The part that follows, in pixels of the whole picture: first column, first row, width and
    /// height. A coarse one may reach beyond the edge.
    pub region: [u32; 4],
    /// Visible error, the quantity that `durer render --noise-threshold` limits, once it is known.
    pub noise: Option<f64>,
    /// Milliseconds until it is finished, once they are known.
    pub left_ms: Option<f64>,
    /// True if it is denoised.
    pub denoised: bool,
    /// Rays traced for it.
    pub rays: f64,
    /// Milliseconds since the change that it shows.
    pub ms: f64,
    /// The hash of its sums, once it is finished: that of `durer render --hash`.
    pub hash: Option<String>,
}

/// A word that begins something in the scene language.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Word {
    /// The word.
    pub word: String,
    /// Its chapter in the manual.
    pub chapter: String,
    /// Meaning.
    pub doc: String,
    /// Its fields.
    pub fields: Vec<WordField>,
    /// How it is written.
    pub example: String,
}

/// A field of a word's block.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct WordField {
    /// The word.
    pub word: String,
    /// Type and range.
    pub value: String,
    /// Default value.
    pub default: Option<String>,
    /// True if it must be given.
    pub required: bool,
    /// Meaning and unit.
    pub doc: String,
}
