//! The messages between a page and a session.
//!
//! A page sends [`Ask`]s as JSON and gets [`Answer`]s. An answer is written as the length of its
//! JSON (four
//! bytes, little endian), the JSON, and bytes that belong to it: pixels, or a file. The same types
//! in
//! TypeScript are in `web/src/protocol.ts`, written by the tests of this crate.

mod account;
mod scene;

pub use account::*;
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
    /// Opens a scene by its text, or the file that the server was started with. Answer:
    /// [`Event::Opened`], then
    /// [`Event::Scene`].
    Open {
        /// The name of the file; its ending says the format.
        name: String,
        /// The text; `None` for the file of the server.
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
