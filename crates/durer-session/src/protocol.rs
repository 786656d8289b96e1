//! Messages between a web page and a session.
//!
//! A page sends [`RequestMessage`]s as JSON and receives [`EventMessage`]s. An answer consists of
//! the length of its JSON (four bytes, little endian), the JSON, and a payload that contains the
//! bytes of pixels or a file. The tests of this crate generate the TypeScript types in
//! `web/src/protocol.ts` from these types.

mod explanation;
mod ray;
mod scene;

pub use explanation::*;
pub use ray::*;
pub use scene::*;
use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// A message from a page to a session. It contains a request and the number of the session.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct RequestMessage {
    /// Number of the session, chosen by the page. A new number opens a new session.
    pub session: u32,
    /// Number of the request, from 1.
    pub id: u32,
    /// The request.
    pub request: Request,
}

/// A message from a session to a page. It contains an event and the number of the request that it
/// answers.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct EventMessage {
    /// Number of the session.
    pub session: u32,
    /// Number of the request that it answers; 0 if unsolicited.
    pub id: u32,
    /// The event.
    pub event: Event,
}

/// A request from a page to a session, such as opening a scene, moving the camera, or explaining a
/// pixel.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Request {
    /// Opens a scene from its text, from a file in the server's folder, or from the server's own
    /// file. The answer is [`Event::Opened`], followed by [`Event::Scene`].
    Open {
        /// Name of the file; its extension determines the format. Empty for the server's own file.
        name: String,
        /// Text of the scene; `None` for a file.
        text: Option<String>,
    },
    /// Uploads a scene file, or a file to which the scene refers.
    Give {
        /// Name of the file, as written in the scene.
        name: String,
        /// Contents in base64.
        base64: String,
        /// True if this is the scene itself.
        opens: bool,
    },
    /// Replaces the text of the scene. The answer is [`Event::Scene`].
    Edit {
        /// The text.
        text: String,
    },
    /// Sets the size of the picture in pixels.
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// Selects the picture to show and its exposure and tone curve.
    Show {
        /// `color`, or the name of an auxiliary picture.
        picture: String,
        /// Exposure in stops: radiance is multiplied by 2 to this power.
        stops: f32,
        /// Name of the tone curve.
        tone: String,
    },
    /// Sets the options of the render job. Options that are not listed get the scene's defaults.
    Options {
        /// Names and values, as on the command line.
        options: Vec<Setting>,
    },
    /// Moves the camera. The answer is [`Event::Camera`].
    Move {
        /// The motion.
        motion: Motion,
        /// True while the motion continues: only coarse pictures are rendered.
        moving: bool,
    },
    /// Sets a field of the camera. The answer is [`Event::Camera`].
    Field {
        /// Keyword of the field in the scene language.
        name: String,
        /// Numbers of its value.
        values: Vec<f32>,
        /// The value, if it is a word.
        word: Option<String>,
        /// True while the motion continues.
        moving: bool,
    },
    /// Replaces the camera with a perspective camera. The answer is [`Event::Camera`].
    Look {
        /// Position of the eye in world space.
        center: [f32; 3],
        /// View direction.
        direction: [f32; 3],
        /// Up direction.
        up: [f32; 3],
        /// Field of view across the larger side, in degrees.
        angle: f32,
        /// True while the motion continues.
        moving: bool,
    },
    /// Replaces the camera with one of another kind at the same place. The answer is
    /// [`Event::Camera`].
    Camera {
        /// Keyword of the new camera, from the `cameras` of [`Event::Opened`].
        keyword: String,
    },
    /// Writes the camera into the text. The answer is [`Event::Text`].
    WriteCamera,
    /// Explains the colour of a pixel. The answer is [`Event::Explained`].
    Explain {
        /// Column from the left.
        x: u32,
        /// Row from the top.
        y: u32,
        /// Index of the sample; `None` selects the sample with the largest contribution.
        sample: Option<u32>,
    },
    /// Intersects a ray with each object. The answer is [`Event::Cast`].
    Cast {
        /// Origin of the ray in world space.
        origin: [f32; 3],
        /// Direction of the ray, of any length.
        direction: [f32; 3],
        /// End of the ray, in lengths of `direction`; `None` for an infinite ray.
        t_max: Option<f32>,
    },
    /// Requests the camera rays through the pixel centres of a coarse raster. The answer is
    /// [`Event::Rays`].
    Rays {
        /// Number of columns of the raster.
        columns: u32,
        /// Number of rows of the raster.
        rows: u32,
        /// The requested row; `None` for all rows.
        row: Option<u32>,
    },
    /// Requests the steps in which a ray traverses an acceleration structure for the objects. The
    /// answer is [`Event::Walk`].
    Walk {
        /// Structure to traverse.
        structure: Structure,
        /// Origin of the ray.
        origin: [f32; 3],
        /// Direction of the ray, of any length.
        direction: [f32; 3],
        /// End of the ray, in lengths of `direction`; `None` for an infinite ray.
        t_max: Option<f32>,
        /// True for a shadow ray, which ends at any hit; false to find the closest hit.
        any: bool,
    },
    /// Requests the bounding boxes of the BVHs of objects and triangles. The answer is
    /// [`Event::Boxes`].
    Boxes,
    /// Requests the values of some pixels. The answer is [`Event::Values`].
    Values {
        /// First column.
        left: u32,
        /// First row.
        top: u32,
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
    },
    /// Renders only a part of the picture. The part is given by its first column, first row, width
    /// and height.
    Crop {
        /// Part to render; `None` for the full picture.
        crop: Option<[u32; 4]>,
    },
    /// Turns denoising of finished pictures on or off.
    Denoise {
        /// True to turn it on.
        on: bool,
    },
    /// Starts secondary rays exactly on the surface and ignores hits closer than `epsilon`, as the
    /// programs of the course do. The answer is [`Event::Scene`].
    Epsilon {
        /// Minimum `t`; `None` for Dürer's exact ray origins.
        epsilon: Option<f32>,
    },
    /// Requests the groups and materials of the scene. The answer is [`Event::Tree`].
    Tree,
    /// Sets a field of a material in a scene without text. The answer is [`Event::Scene`].
    Material {
        /// Number of the material.
        number: u32,
        /// Name of the field.
        name: String,
        /// Numbers of its value.
        values: Vec<f32>,
        /// The value, if it is a word.
        word: Option<String>,
    },
    /// Converts a model to text in the scene language with separate asset files. The answer is
    /// [`Event::Opened`], followed by [`Event::Scene`].
    AsText,
    /// Requests the text of the scene and the files to which it refers. The answer is
    /// [`Event::Packed`], followed by the bytes of the files.
    Pack,
    /// Requests the lesson with which the server was started. The answer is [`Event::Lesson`].
    Lesson,
    /// Requests the common mistakes that can be rendered. The answer is [`Event::Mistakes`].
    Mistakes,
    /// Renders the scene with Whitted's method and a common mistake. The answer is
    /// [`Event::Mistaken`].
    Mistake {
        /// Name of the mistake; `None` renders the correct picture for comparison.
        name: Option<String>,
        /// Value of the mistake, such as a factor; `None` for its first value.
        value: Option<f32>,
        /// Width of the picture in pixels.
        width: u32,
        /// Height of the picture in pixels.
        height: u32,
    },
    /// Requests the outlines of all objects. The answer is [`Event::Outlines`].
    Outlines,
    /// Requests the keywords of the language. The answer is [`Event::Language`].
    Language,
    /// Requests the picture as a file. The answer is [`Event::Exported`] with the bytes of the
    /// file.
    Export {
        /// Name of the file; its extension selects the format.
        name: String,
    },
    /// Writes the text to the file of the scene. The answer is [`Event::Saved`] or
    /// [`Event::Conflict`].
    Save {
        /// True to overwrite changes by other programs.
        force: bool,
    },
    /// Divides the pictures of this session among several workers, each of which has a session
    /// with the same number that receives the same requests. This must be the first request. The
    /// first worker answers them and shows the pictures. The others only render, and send
    /// [`Event::Part`] to the first one.
    Share {
        /// Number of this worker, from 1.
        index: u32,
        /// Number of workers, at most 64.
        count: u32,
    },
    /// Pauses or resumes rendering. Hidden pages use this request.
    Pause {
        /// True to pause.
        pause: bool,
    },
    /// Ends the session.
    Close,
}

/// An event that a session sends to a page: the answer to a request, a new picture, or a
/// notification.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Event {
    /// A scene was opened.
    Opened {
        /// Version of the program.
        version: String,
        /// Name of the file.
        name: String,
        /// Text of the scene; `None` for a model in a binary format.
        text: Option<String>,
        /// True if the scene can be saved.
        saves: bool,
        /// Pictures that can be shown.
        pictures: Vec<NamedChoice>,
        /// Tone curves.
        tones: Vec<String>,
        /// Integrators.
        integrators: Vec<NamedChoice>,
        /// Kinds of cameras, by keyword.
        cameras: Vec<NamedChoice>,
    },
    /// The text of the scene was read and compiled.
    Scene {
        /// Findings of the parser and the compiler.
        findings: Vec<Finding>,
        /// Contents of the scene; `None` after errors, in which case the previous picture remains.
        contents: Option<SceneSummary>,
        /// Time to read and compile it, in milliseconds.
        ms: f64,
    },
    /// Findings of `durer check`, which are computed after the picture is finished.
    Checked {
        /// The findings, including those of [`Event::Scene`].
        findings: Vec<Finding>,
    },
    /// The camera was moved.
    Camera {
        /// The current camera.
        camera: CameraState,
    },
    /// A picture to show. The payload contains four bytes per pixel: red, green, blue and coverage.
    Picture {
        /// Description of the payload.
        head: PictureInfo,
    },
    /// Explanation of a pixel's colour.
    Explained {
        /// The pixel.
        pixel: PixelExplanation,
    },
    /// Results of the intersection tests between a ray and each object.
    Cast {
        /// The results.
        cast: CastResult,
    },
    /// Camera rays, row by row. The value is `None` for a pixel without a ray.
    Rays {
        /// The rays.
        rays: Vec<Option<CameraRay>>,
    },
    /// Traversal of an acceleration structure by a ray.
    Walk {
        /// The traversal.
        walk: Traversal,
    },
    /// Bounding boxes of the BVHs.
    Boxes {
        /// Boxes, level by level, up to a limit.
        boxes: Vec<TreeBox>,
    },
    /// Values of pixels, with three numbers per pixel, row by row. A number is `None` if it is
    /// infinite or NaN.
    Values {
        /// First column.
        left: u32,
        /// First row.
        top: u32,
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// Linear light, or the values of the picture that is shown instead of colour.
        values: Vec<Option<f32>>,
    },
    /// Groups and materials of the scene.
    Tree {
        /// The objects.
        nodes: Vec<SceneNode>,
        /// The materials, by number.
        materials: Vec<MaterialState>,
    },
    /// Text and files of the scene. The bytes of all files follow, one file after another.
    Packed {
        /// Names of the files; the text is first.
        names: Vec<String>,
        /// Sizes in bytes.
        sizes: Vec<u32>,
    },
    /// The lesson.
    Lesson {
        /// Lesson in Markdown; `None` if the server has none.
        text: Option<String>,
    },
    /// Common mistakes, in the order of the lecture's table.
    Mistakes {
        /// The mistakes.
        mistakes: Vec<MistakeChoice>,
    },
    /// Picture of the scene with a mistake. The payload contains four bytes per pixel.
    Mistaken {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Fraction of the pixels whose eight-bit colour differs from the correct picture.
        changed: f64,
        /// Description and code of the mistake for the requested value; `None` for the correct
        /// picture.
        mistake: Option<MistakeChoice>,
    },
    /// Blocks of a picture that a worker has rendered for the first worker. The payload contains
    /// a saved part.
    Part {
        /// Number of changes to the scene, camera and options before this picture.
        revision: u32,
        /// Number of the worker, from 1.
        index: u32,
        /// True if the worker's share is finished.
        finished: bool,
    },
    /// Line drawing of the scene.
    Outlines {
        /// Outlines, one per object, up to a limit.
        outlines: Vec<Outline>,
        /// Lights that have a position or a direction.
        lamps: Vec<LightMarker>,
    },
    /// Keywords of the language.
    Language {
        /// Keywords that begin a statement.
        words: Vec<Keyword>,
    },
    /// The session has changed the text, or the file has changed on disk.
    Text {
        /// The new text.
        text: String,
        /// True if the file changed on disk.
        from_disk: bool,
    },
    /// A picture as a file. The payload contains the file.
    Exported {
        /// Name of the file.
        name: String,
    },
    /// The text was saved.
    Saved,
    /// The text was not saved because the file has changed since it was read.
    Conflict,
    /// The request failed.
    Refused {
        /// Reason.
        why: String,
    },
}

impl EventMessage {
    /// Encodes the message with its payload.
    pub fn encode(&self, payload: &[u8]) -> Vec<u8> {
        // Serializing these types cannot fail.
        let json = serde_json::to_vec(self).unwrap_or_default();
        let mut bytes = Vec::with_capacity(4 + json.len() + payload.len());
        bytes.extend((json.len() as u32).to_le_bytes());
        bytes.extend(json);
        bytes.extend(payload);
        bytes
    }

    /// Decodes a message into its JSON and its payload. Returns `None` if it is malformed.
    pub fn decode(bytes: &[u8]) -> Option<(EventMessage, &[u8])> {
        let (length, rest) = bytes.split_first_chunk::<4>()?;
        let (json, payload) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        Some((serde_json::from_slice(json).ok()?, payload))
    }
}

#[cfg(test)]
mod tests;
