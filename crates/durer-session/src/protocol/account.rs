//! Accounts of a pixel and of a ray.

use super::scene::Place;
use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// A formula, with names and with numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Row {
    /// Name of the result.
    pub name: String,
    /// How, in symbols.
    pub formula: String,
    /// The formula with numbers; may be empty.
    pub numbers: String,
    /// The result as text.
    pub result: String,
    /// The result as a number.
    pub value: Option<f64>,
}

/// A part of a ray, for drawing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Segment {
    /// Meaning.
    pub role: Role,
    /// Start.
    pub from: [f32; 3],
    /// End.
    pub to: [f32; 3],
    /// True if it has no end.
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
    /// Title.
    pub title: String,
    /// Its formulas.
    pub rows: Vec<Row>,
    /// The colour that comes of it.
    pub value: [f32; 3],
    /// Contribution to the pixel.
    pub adds: [f32; 3],
    /// Its share of the pixel's luminance.
    pub share: f32,
    /// The value in eight bits.
    pub swatch: [u8; 3],
    /// Place of its object or light in the text.
    pub place: Option<Place>,
    /// Its ray.
    pub segment: Option<Segment>,
    /// Point and normal of what was hit.
    pub normal: Option<[[f32; 3]; 2]>,
    /// The ray in numbers, to ask all objects about it: origin, direction.
    pub ray: Option<[[f32; 3]; 2]>,
    /// End of the ray.
    pub t_max: Option<f32>,
    /// Number of the object that it is about.
    pub object: Option<u32>,
    /// Terms that sum to it.
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
    /// Number of samples.
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

/// Test of a ray against an object.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct ObjectTest {
    /// Number of the object.
    pub object: u32,
    /// Its keyword and line.
    pub name: String,
    /// Place in the text.
    pub place: Option<Place>,
    /// The answer.
    pub verdict: Verdict,
    /// The answer in words.
    pub why: String,
    /// First crossing along the line.
    pub t: Option<f32>,
    /// The formulas, with numbers.
    pub rows: Vec<Row>,
}

/// Tests of a ray against the objects.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct CastAccount {
    /// Origin of the ray.
    pub origin: [f32; 3],
    /// Its direction.
    pub direction: [f32; 3],
    /// Tests of the objects in the order of the text, up to a limit.
    pub tests: Vec<ObjectTest>,
    /// Number of objects beyond the limit.
    pub left_out: u32,
    /// The first hit.
    pub hit: Option<HitAccount>,
}

/// Hit of a ray.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct HitAccount {
    /// Number of the object.
    pub object: u32,
    /// Number of the triangle in a mesh, else 0.
    pub part: u32,
    /// Position along the ray.
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

/// A light, for drawing.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Lamp {
    /// Position; of directional lights, a point from where they shine.
    pub at: [f32; 3],
    /// True if it is infinitely far.
    pub far: bool,
    /// Its keyword and line.
    pub name: String,
}
