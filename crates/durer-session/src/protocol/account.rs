//! What is said of a pixel, and of a ray.

use super::scene::Place;
use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

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
