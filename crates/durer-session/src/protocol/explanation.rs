//! Explanations of a pixel and of a ray.

use super::scene::TextPosition;
use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// A line of an explanation. It contains a formula in symbols and in numbers, and the result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct FormulaRow {
    /// Name of the result.
    pub name: String,
    /// Formula in symbols.
    pub formula: String,
    /// Formula in numbers; may be empty.
    pub numbers: String,
    /// Result as text.
    pub result: String,
    /// Result as a number, if it is a scalar.
    pub value: Option<f64>,
}

/// A segment of a ray in world space, which a page draws into the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Segment {
    /// Kind of the ray.
    pub role: SegmentKind,
    /// Start in world space.
    pub from: [f32; 3],
    /// End in world space.
    pub to: [f32; 3],
    /// True if the ray leaves the scene.
    pub escapes: bool,
}

/// Kind of the ray to which a [`Segment`] belongs, such as a camera ray or a shadow ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum SegmentKind {
    /// Camera ray.
    Camera,
    /// Mirrored ray.
    Reflected,
    /// Refracted ray.
    Transmitted,
    /// Ray in a sampled direction.
    Scattered,
    /// Shadow ray that reaches its light.
    Lit,
    /// Shadow ray that is blocked.
    Shadowed,
}

/// A term of the sum that gives the colour of a pixel. It contains its formulas and the terms that
/// it consists of.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Term {
    /// Title.
    pub title: String,
    /// Formulas of the term.
    pub rows: Vec<FormulaRow>,
    /// Value of the term, as linear RGB.
    pub value: [f32; 3],
    /// Contribution to the pixel, as linear RGB.
    pub adds: [f32; 3],
    /// Share of the pixel's luminance, 0 to 1.
    pub share: f32,
    /// Value as 8-bit sRGB.
    pub swatch: [u8; 3],
    /// Place of the object or light in the text.
    pub place: Option<TextPosition>,
    /// Segment to draw.
    pub segment: Option<Segment>,
    /// Position and normal of the hit, in world space.
    pub normal: Option<[[f32; 3]; 2]>,
    /// Origin and direction of the ray, for `Request::Cast`.
    pub ray: Option<[[f32; 3]; 2]>,
    /// End of the ray, if finite.
    pub t_max: Option<f32>,
    /// Number of the hit or blocking object.
    pub object: Option<u32>,
    /// Lines that derive the numbers of the term from the fields of the scene.
    pub origins: Vec<String>,
    /// Terms that sum to this one.
    pub terms: Vec<Term>,
}

/// Explanation of the colour of a pixel as a tree of terms for one of its samples.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct PixelExplanation {
    /// Column from the left.
    pub x: u32,
    /// Row from the top.
    pub y: u32,
    /// Colour as linear RGB.
    pub color: [f32; 3],
    /// Colour as 8-bit sRGB.
    pub bytes: [u8; 3],
    /// Number of samples.
    pub samples: u32,
    /// Index of the sample that `tree` explains.
    pub sample: u32,
    /// Position of the sample in the picture, in pixels from the upper left corner.
    pub at: [f32; 2],
    /// Filter weight of the sample, divided by the sum of all weights.
    pub weight: f32,
    /// Tree of terms; `None` if the camera has no ray for this pixel.
    pub tree: Option<Term>,
}

/// Result of testing a ray against one object. The object is the closest hit, a farther hit, or not
/// hit at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The object is the closest hit.
    Closest,
    /// The ray hits the object, but it hits another object first.
    Farther,
    /// The line crosses the object only before the start of the ray.
    Behind,
    /// The line crosses the object only beyond the end of the ray.
    Beyond,
    /// The line misses the object.
    Missed,
}

/// Intersection test between a ray and one object, with the formulas and the result.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct ObjectTest {
    /// Number of the object.
    pub object: u32,
    /// Keyword and line of the object.
    pub name: String,
    /// Place of the object in the text.
    pub place: Option<TextPosition>,
    /// Result of the test.
    pub verdict: Verdict,
    /// Result in words.
    pub why: String,
    /// First crossing along the line, in lengths of the direction.
    pub t: Option<f32>,
    /// Formulas with numbers.
    pub rows: Vec<FormulaRow>,
}

/// Result of [`Request::Cast`](super::Request::Cast), with the intersection tests between a ray and
/// each object.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct CastResult {
    /// Origin of the ray in world space.
    pub origin: [f32; 3],
    /// Direction of the ray.
    pub direction: [f32; 3],
    /// Tests in the order of the text, up to a limit.
    pub tests: Vec<ObjectTest>,
    /// Number of objects beyond the limit.
    pub left_out: u32,
    /// The closest hit.
    pub hit: Option<CastHit>,
}

/// Closest hit of a ray, with its position, normals and texture coordinates.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct CastHit {
    /// Number of the object.
    pub object: u32,
    /// Index of the triangle in a mesh, else 0.
    pub part: u32,
    /// Position along the ray, in lengths of its direction.
    pub t: f32,
    /// Position in world space.
    pub point: [f32; 3],
    /// Geometric normal in world space, unit length.
    pub normal: [f32; 3],
    /// Shading normal in world space, unit length.
    pub shading_normal: [f32; 3],
    /// Texture coordinates, if the surface has any.
    pub uv: Option<[f32; 2]>,
    /// Barycentric coordinates on a triangle.
    pub barycentric: [f32; 3],
}

/// Outline of an object as polylines in world space. A page uses outlines for a line drawing of the
/// scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct Outline {
    /// Number of the object.
    pub object: u32,
    /// Polylines in world space, each as x, y, z of its points.
    pub lines: Vec<Vec<f32>>,
}

/// Position and name of a light. A page uses them for a line drawing of the scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct LightMarker {
    /// Position in world space; for a directional light, a point in the direction from which its
    /// light comes.
    pub at: [f32; 3],
    /// True for a directional light.
    pub far: bool,
    /// Keyword and line of the light.
    pub name: String,
}
