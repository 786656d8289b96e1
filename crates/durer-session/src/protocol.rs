//! The messages between a page and a session.
//!
//! A page sends [`Ask`]s as JSON and gets [`Answer`]s. An answer is written as the length of its
//! JSON (four
//! bytes, little endian), the JSON, and bytes that belong to it: pixels, or a file. The same types
//! in
//! TypeScript are in `web/src/protocol.ts`, written by the tests of this crate.

mod account;
mod ask;
mod scene;

pub use account::*;
pub use ask::*;
pub use scene::*;
use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// A message to a session.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Ask {
    /// Number of the session, chosen by the page. A new number makes a new session.
    pub session: u32,
    /// Number of the question, from 1.
    pub id: u32,
    /// The question.
    pub request: Request,
}

/// A message from a session.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Answer {
    /// The session.
    pub session: u32,
    /// The question that it answers; 0 where nobody asked.
    pub id: u32,
    /// The event.
    pub event: Event,
}

/// Requests of a page.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Request {
    /// Opens a scene by its text, a file beside that of the server, or the server's own file.
    /// Answer: [`Event::Opened`], then [`Event::Scene`].
    Open {
        /// The name of the file; its ending says the format. Empty for the server's own file.
        name: String,
        /// The text; `None` for a file.
        text: Option<String>,
    },
    /// Gives a file that the scene may name.
    Give {
        /// Its name in the scene.
        name: String,
        /// Its bytes in base64.
        base64: String,
        /// True for the scene itself.
        opens: bool,
    },
    /// Replaces the scene's text. Answer: [`Event::Scene`].
    Edit {
        /// The text.
        text: String,
    },
    /// Sets the size of the picture in pixels.
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// Sets which picture is shown, and how.
    Show {
        /// `color`, or the name of another picture.
        picture: String,
        /// Exposure in stops: light is multiplied by this power of two.
        stops: f32,
        /// Name of the tone curve.
        tone: String,
    },
    /// Sets the options of the job; those that are not named follow from the scene.
    Options {
        /// Names and values, as on the command line.
        options: Vec<Setting>,
    },
    /// Moves the camera. Answer: [`Event::Camera`].
    Move {
        /// How.
        motion: Motion,
        /// True while the motion lasts: only coarse pictures are made.
        moving: bool,
    },
    /// Sets a field of the camera. Answer: [`Event::Camera`].
    Field {
        /// Its name.
        name: String,
        /// Its numbers.
        values: Vec<f32>,
        /// True while the motion lasts.
        moving: bool,
    },
    /// Puts a perspective camera into the scene. Answer: [`Event::Camera`].
    Look {
        /// The eye.
        center: [f32; 3],
        /// View direction.
        direction: [f32; 3],
        /// Up direction.
        up: [f32; 3],
        /// Field of view across the larger side, in degrees.
        angle: f32,
        /// True while the motion lasts.
        moving: bool,
    },
    /// Writes the camera into the text. Answer: [`Event::Text`].
    WriteCamera,
    /// Asks why a pixel has its colour. Answer: [`Event::Explained`].
    Explain {
        /// Column from the left.
        x: u32,
        /// Row from the top.
        y: u32,
        /// Which of its samples; `None`: the one that counts most.
        sample: Option<u32>,
    },
    /// Asks what each object says of a ray. Answer: [`Event::Cast`].
    Cast {
        /// Origin of the ray.
        origin: [f32; 3],
        /// Its direction, of any length.
        direction: [f32; 3],
        /// End.
        t_max: Option<f32>,
    },
    /// Asks for the camera's rays through the middles of the pixels of a coarse raster. Answer:
    /// [`Event::Rays`].
    Rays {
        /// Columns of the raster.
        columns: u32,
        /// Rows of the raster.
        rows: u32,
        /// The only row that is asked for; `None` for all.
        row: Option<u32>,
    },
    /// Asks how a ray goes through a structure over the objects. Answer: [`Event::Walk`].
    Walk {
        /// The structure.
        structure: Structure,
        /// Origin of the ray.
        origin: [f32; 3],
        /// Its direction, of any length.
        direction: [f32; 3],
    },
    /// Asks for the boxes of the trees over objects and triangles. Answer: [`Event::Boxes`].
    Boxes,
    /// Asks for the numbers of some pixels. Answer: [`Event::Values`].
    Values {
        /// First column.
        left: u32,
        /// First row.
        top: u32,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// Renders a part of the picture only: first column, first row, width and height.
    Crop {
        /// The part; `None` for the whole picture.
        crop: Option<[u32; 4]>,
    },
    /// Turns denoising of finished pictures on or off.
    Denoise {
        /// True for on.
        on: bool,
    },
    /// Starts secondary rays on the surface, and ignores hits nearer than this, as the programs of
    /// the course do. Answer: [`Event::Scene`].
    Epsilon {
        /// Least `t`; `None` for the exact starts of rays.
        epsilon: Option<f32>,
    },
    /// Asks for the groups and materials of the scene. Answer: [`Event::Tree`].
    Tree,
    /// Sets a field of a material, in a scene without text. Answer: [`Event::Scene`].
    Material {
        /// Number of the material.
        number: u32,
        /// Name of the field.
        name: String,
        /// Its numbers.
        values: Vec<f32>,
    },
    /// Turns a model into a text of the scene language with files beside it. Answer:
    /// [`Event::Opened`], then [`Event::Scene`].
    AsText,
    /// Asks for the scene's text and its files. Answer: [`Event::Packed`], with their bytes.
    Pack,
    /// Asks for the lesson that the server was started with. Answer: [`Event::Lesson`].
    Lesson,
    /// Asks for the lines of all objects. Answer: [`Event::Outlines`].
    Outlines,
    /// Asks for the words of the language. Answer: [`Event::Language`].
    Language,
    /// Asks for the picture as a file. Answer: [`Event::Exported`], with its bytes.
    Export {
        /// The file's name, whose ending says the format.
        name: String,
    },
    /// Writes the text into the scene's file. Answer: [`Event::Saved`] or [`Event::Conflict`].
    Save {
        /// True to overwrite what other programs wrote meanwhile.
        force: bool,
    },
    /// Pauses or resumes work on the picture, for pages that do not show it.
    Pause {
        /// True to pause.
        pause: bool,
    },
    /// Ends the session.
    Close,
}

/// Events of a session.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Event {
    /// A scene was opened.
    Opened {
        /// The program's version.
        version: String,
        /// Name of the file.
        name: String,
        /// Its text; `None` for a model in a binary format.
        text: Option<String>,
        /// True if it can be saved.
        saves: bool,
        /// Pictures that can be shown.
        pictures: Vec<Choice>,
        /// Tone curves.
        tones: Vec<String>,
        /// Integrators.
        integrators: Vec<Choice>,
    },
    /// A text was read.
    Scene {
        /// Findings of the reader.
        findings: Vec<Finding>,
        /// Contents; `None` if it has errors, and the picture stays the last one.
        contents: Option<Contents>,
        /// Time to read and compile it, in milliseconds.
        ms: f64,
    },
    /// Findings of `durer check`, after the picture.
    Checked {
        /// The findings, those of [`Event::Scene`] among them.
        findings: Vec<Finding>,
    },
    /// The camera was moved.
    Camera {
        /// As it is now.
        camera: CameraState,
    },
    /// A picture; its pixels follow, four bytes each: red, green, blue, coverage.
    Picture {
        /// Meaning.
        head: PictureHead,
    },
    /// Why a pixel has its colour.
    Explained {
        /// The pixel.
        pixel: PixelAccount,
    },
    /// Tests of a ray against each object.
    Cast {
        /// The answer of all.
        cast: CastAccount,
    },
    /// Rays of the camera, row by row; `None` where it sees nothing.
    Rays {
        /// The rays.
        rays: Vec<Option<RayAccount>>,
    },
    /// The way of a ray through a structure.
    Walk {
        /// The way.
        walk: WalkAccount,
    },
    /// Boxes of the trees.
    Boxes {
        /// The boxes, level by level, up to a limit.
        boxes: Vec<BoxState>,
    },
    /// Numbers of pixels, three each, row by row; `None` for infinity.
    Values {
        /// First column.
        left: u32,
        /// First row.
        top: u32,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// The numbers: linear light, or what another picture shows.
        values: Vec<Option<f32>>,
    },
    /// Groups and materials of the scene.
    Tree {
        /// The objects.
        nodes: Vec<TreeNode>,
        /// The materials, by number.
        materials: Vec<MaterialState>,
    },
    /// The scene's text and its files; their bytes follow, one after the other.
    Packed {
        /// Names; the text comes first.
        names: Vec<String>,
        /// Numbers of bytes.
        sizes: Vec<u32>,
    },
    /// The lesson.
    Lesson {
        /// Its Markdown; `None` if the server has none.
        text: Option<String>,
    },
    /// Line drawing of the scene.
    Outlines {
        /// One for each object, up to a limit.
        outlines: Vec<Outline>,
        /// The lights that have a place.
        lamps: Vec<Lamp>,
    },
    /// The words of the language.
    Language {
        /// Words that begin a statement.
        words: Vec<Word>,
    },
    /// The text was changed by the session, or on disk.
    Text {
        /// The new text.
        text: String,
        /// True if it was changed on disk.
        from_disk: bool,
    },
    /// A picture as a file; its bytes follow.
    Exported {
        /// Its name.
        name: String,
    },
    /// The text was saved.
    Saved,
    /// The file was changed since it was read; nothing was written.
    Conflict,
    /// The request failed.
    Refused {
        /// Why.
        why: String,
    },
}

impl Answer {
    /// The message as bytes.
    pub fn encode(&self, payload: &[u8]) -> Vec<u8> {
        // Strings, numbers and lists can always be written.
        let json = serde_json::to_vec(self).unwrap_or_default();
        let mut bytes = Vec::with_capacity(4 + json.len() + payload.len());
        bytes.extend((json.len() as u32).to_le_bytes());
        bytes.extend(json);
        bytes.extend(payload);
        bytes
    }
}

#[cfg(test)]
mod tests;
