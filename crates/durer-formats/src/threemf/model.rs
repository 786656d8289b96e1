//! What is in a file of a model.

use durer_diag::Span;
use durer_scene::math::{Vec2, Vec3};
use glam::DAffine3;
use std::collections::BTreeMap;

/// What is shown: an object of a part, moved.
pub(super) struct Place {
    /// The name of the part, where that is another one.
    pub part: Option<String>,
    pub id: u32,
    pub map: DAffine3,
    pub at: Span,
}

/// An object: a mesh, or others.
pub(super) enum Object {
    Mesh(Box<Mesh>),
    Components(Vec<Place>),
}

/// A file of a model.
#[derive(Default)]
pub(super) struct Model {
    pub objects: BTreeMap<u32, (Object, Span)>,
    pub properties: BTreeMap<u32, Properties>,
    pub items: Vec<Place>,
    /// Millimetres of its unit.
    pub unit: f64,
}

/// A property: the number of its list, and its place there.
pub(super) type Property = (u32, u32);

/// Positions, triangles, beams.
#[derive(Default)]
pub(super) struct Mesh {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// By triangle, if any has one: the list, and the places of its corners.
    pub properties: Vec<Option<(u32, [u32; 3])>>,
    /// What triangles are made of that do not say it.
    pub usual: Option<Property>,
    /// Two ends, and the radius at each.
    pub beams: Vec<([u32; 2], [f32; 2])>,
    /// Where the first triangle of a list is.
    pub at: Span,
}

/// Colour and opacity, linear.
pub(super) type Color = [f32; 4];

/// A list that triangles point into.
pub(super) struct Properties {
    pub group: Group,
    pub at: Span,
}

/// What a list holds.
pub(super) enum Group {
    /// Of materials, vertices, composites or several at once: what they look like.
    Colors(Vec<Color>),
    /// Places in the picture of a resource, with v upwards.
    Texture { picture: u32, uvs: Vec<Vec2> },
    /// The name of a picture's part, and how it goes on beyond its borders.
    Picture { part: String, styles: [Option<String>; 2], at: Span },
}

impl Group {
    pub const NAMES: [&str; 6] =
        ["basematerials", "colorgroup", "texture2d", "texture2dgroup", "compositematerials", "multiproperties"];
}
