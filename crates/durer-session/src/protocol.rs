//! The messages between a page and a session.
//!
//! A page sends [`Ask`]s as JSON and gets [`Answer`]s. An answer is written as the length of its JSON (four
//! bytes, little endian), the JSON, and bytes that belong to it: pixels, or a file. The same types in
//! TypeScript are in `web/src/protocol.ts`, written by the tests of this crate.

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
    /// What it says.
    pub event: Event,
}

/// What a page can ask.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Request {
    /// Opens a scene by its text, or the file that the server was started with. Answer: [`Event::Opened`], then
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
        /// Whether it is the scene itself.
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
        /// What multiplies light, in powers of two.
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
        /// Whether more is to come at once: then only coarse pictures are made.
        moving: bool,
    },
    /// Sets a field of the camera. Answer: [`Event::Camera`].
    Field {
        /// Its name.
        name: String,
        /// Its numbers.
        values: Vec<f32>,
        /// Whether more is to come at once.
        moving: bool,
    },
    /// Puts a perspective camera into the scene. Answer: [`Event::Camera`].
    Look {
        /// The eye.
        center: [f32; 3],
        /// Where it looks.
        direction: [f32; 3],
        /// What is up.
        up: [f32; 3],
        /// Field of view across the larger side, in degrees.
        angle: f32,
        /// Whether more is to come at once.
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
        /// Where the ray starts.
        origin: [f32; 3],
        /// Its direction, of any length.
        direction: [f32; 3],
        /// Where it ends.
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
        /// Whether what others wrote meanwhile is overwritten.
        force: bool,
    },
    /// Ends the session.
    Close,
}

/// What a session says.
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
        /// Whether it can be saved.
        saves: bool,
        /// All pictures that can be shown.
        pictures: Vec<Choice>,
        /// All tone curves.
        tones: Vec<String>,
        /// All integrators.
        integrators: Vec<Choice>,
    },
    /// A text was read.
    Scene {
        /// What is wrong or odd with it.
        findings: Vec<Finding>,
        /// What is in it; `None` where it has errors: the picture is that of the last one without.
        contents: Option<Contents>,
        /// Time to read and compile it, in milliseconds.
        ms: f64,
    },
    /// What `durer check` finds, once there is time to look.
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
        /// What it is.
        head: PictureHead,
    },
    /// Why a pixel has its colour.
    Explained {
        /// The pixel.
        pixel: PixelAccount,
    },
    /// What each object says of a ray.
    Cast {
        /// The answer of all.
        cast: CastAccount,
    },
    /// What the scene looks like in lines.
    Outlines {
        /// One for each object, up to a limit.
        outlines: Vec<Outline>,
        /// The lights that have a place.
        lamps: Vec<Lamp>,
    },
    /// The words of the language.
    Language {
        /// All that begin something.
        words: Vec<Word>,
    },
    /// The text was changed by the session, or on disk.
    Text {
        /// The new text.
        text: String,
        /// Whether it was changed on disk.
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
    /// What was asked cannot be done.
    Refused {
        /// Why.
        why: String,
    },
}

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
    /// Where the scene has it.
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

/// What is wrong or odd with a text.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// Its kind, or nothing.
    pub code: String,
    /// In a sentence.
    pub message: String,
    /// What may have been meant.
    pub help: Option<String>,
    /// What comes of it in the picture.
    pub effect: Option<String>,
    /// The file, if it is not the scene's.
    pub file: Option<String>,
    /// Where in it.
    pub place: Option<Place>,
    /// What mends it.
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

/// What is in a scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Contents {
    /// Name of the dialect.
    pub dialect: String,
    /// The camera.
    pub camera: CameraState,
    /// Objects, by number, up to a limit.
    pub objects: Vec<Thing>,
    /// How many objects there are.
    pub object_count: u32,
    /// How many triangles they have.
    pub triangles: f64,
    /// Lights, by number.
    pub lights: Vec<Thing>,
    /// Two opposite corners of the box around all that has an end.
    pub bounds: [[f32; 3]; 2],
    /// The job, as on the command line, but for its size.
    pub job: JobState,
}

/// What a picture of a scene is made with.
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
    /// Where it is written, if in the scene's text.
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
    /// Where it looks, of length 1.
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
    /// Whether it was moved.
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
    /// What it says where it has no numbers.
    pub text: String,
    /// Least value, if there is one.
    pub least: Option<f32>,
    /// Greatest value, if there is one.
    pub most: Option<f32>,
}

/// What a picture is.
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
    /// Rays traced for it.
    pub rays: f64,
    /// Milliseconds since the change that it shows.
    pub ms: f64,
    /// The hash of its sums, once it is finished: that of `durer render --hash`.
    pub hash: Option<String>,
}

/// A formula, with names and with numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Row {
    /// What is computed.
    pub name: String,
    /// How, in symbols.
    pub formula: String,
    /// The same in numbers; may be empty.
    pub numbers: String,
    /// What comes of it, in words.
    pub result: String,
    /// What comes of it, as a number.
    pub value: Option<f64>,
}

/// A part of a ray, for drawing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Segment {
    /// What it is.
    pub role: Role,
    /// Where it begins.
    pub from: [f32; 3],
    /// Where it ends.
    pub to: [f32; 3],
    /// Whether it goes on for ever.
    pub escapes: bool,
}

/// The kind of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// From the camera.
    Camera,
    /// From a mirror.
    Reflected,
    /// Through glass.
    Transmitted,
    /// In a random direction.
    Scattered,
    /// To a light that is seen.
    Lit,
    /// To a light that is hidden.
    Shadowed,
}

/// A term of a pixel's colour.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Term {
    /// What it is, in a few words.
    pub title: String,
    /// Its formulas.
    pub rows: Vec<Row>,
    /// The colour that comes of it.
    pub value: [f32; 3],
    /// What it adds to the pixel.
    pub adds: [f32; 3],
    /// Its share of the pixel's luminance.
    pub share: f32,
    /// The value in eight bits.
    pub swatch: [u8; 3],
    /// Where the thing is written that it is about.
    pub place: Option<Place>,
    /// Its ray.
    pub segment: Option<Segment>,
    /// Point and normal of what was hit.
    pub normal: Option<[[f32; 3]; 2]>,
    /// The ray in numbers, to ask all objects about it: origin, direction.
    pub ray: Option<[[f32; 3]; 2]>,
    /// Where that ray ends.
    pub t_max: Option<f32>,
    /// Number of the object that it is about.
    pub object: Option<u32>,
    /// What it is the sum of.
    pub terms: Vec<Term>,
}

/// A pixel and all that made it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct PixelAccount {
    /// Column from the left.
    pub x: u32,
    /// Row from the top.
    pub y: u32,
    /// The colour, in linear light.
    pub color: [f32; 3],
    /// In eight bits.
    pub bytes: [u8; 3],
    /// How many samples it has.
    pub samples: u32,
    /// Which of them the tree is of.
    pub sample: u32,
    /// Place in the picture, in pixels from the upper left corner.
    pub at: [f32; 2],
    /// The weight of that sample, divided by those of all.
    pub weight: f32,
    /// The tree; `None` where the camera sees nothing.
    pub tree: Option<Term>,
}

/// How an object answers a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It is the first that is hit.
    Closest,
    /// It is hit behind another.
    Farther,
    /// The line meets it behind the ray's start only.
    Behind,
    /// The line meets it behind the ray's end only.
    Beyond,
    /// The line does not meet it.
    Missed,
}

/// What an object says of a ray.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct ObjectTest {
    /// Number of the object.
    pub object: u32,
    /// Its keyword and line.
    pub name: String,
    /// Where it is written.
    pub place: Option<Place>,
    /// The answer.
    pub verdict: Verdict,
    /// The answer in words.
    pub why: String,
    /// Where the ray meets it first.
    pub t: Option<f32>,
    /// The formulas, with numbers.
    pub rows: Vec<Row>,
}

/// What all objects say of a ray.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct CastAccount {
    /// Where the ray starts.
    pub origin: [f32; 3],
    /// Its direction.
    pub direction: [f32; 3],
    /// All objects, up to a limit, in the order in which they are written.
    pub tests: Vec<ObjectTest>,
    /// How many objects were not told about.
    pub left_out: u32,
    /// The first hit.
    pub hit: Option<HitAccount>,
}

/// Where a ray hits.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct HitAccount {
    /// Number of the object.
    pub object: u32,
    /// Number of the triangle in a mesh, else 0.
    pub part: u32,
    /// Where on the ray.
    pub t: f32,
    /// The point.
    pub point: [f32; 3],
    /// Normal of the surface.
    pub normal: [f32; 3],
    /// Normal for shading.
    pub shading_normal: [f32; 3],
    /// Texture coordinates.
    pub uv: Option<[f32; 2]>,
    /// Barycentric coordinates on a triangle.
    pub barycentric: [f32; 3],
}

/// An object in lines.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Outline {
    /// Number of the object.
    pub object: u32,
    /// Lines, each a row of points, three numbers each.
    pub lines: Vec<Vec<f32>>,
}

/// A light that has a place.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Lamp {
    /// Where it is, or from where it comes.
    pub at: [f32; 3],
    /// Whether it is infinitely far.
    pub far: bool,
    /// Its keyword and line.
    pub name: String,
}

/// A word that begins something in the scene language.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Word {
    /// The word.
    pub word: String,
    /// Its chapter in the manual.
    pub chapter: String,
    /// What it is.
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
    /// What holds where it is not given.
    pub default: Option<String>,
    /// Whether it must be given.
    pub required: bool,
    /// Meaning and unit.
    pub doc: String,
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
