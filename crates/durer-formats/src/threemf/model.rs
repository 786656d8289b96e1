//! Data structures of a model part.

use durer_diag::Span;
use durer_scene::math::{Vec2, Vec3};
use glam::DAffine3;
use std::collections::BTreeMap;

/// A build item or component: an object of a part with a transform.
pub(super) struct ObjectRef {
    /// Name of the object's part if it is another one.
    pub part: Option<String>,
    pub id: u32,
    pub map: DAffine3,
    pub at: Span,
}

/// An object: a mesh, or components.
pub(super) enum Object {
    Mesh(Box<Mesh>),
    Components(Vec<ObjectRef>),
}

/// Content of a model part.
#[derive(Default)]
pub(super) struct Model {
    pub objects: BTreeMap<u32, (Object, Span)>,
    pub properties: BTreeMap<u32, Properties>,
    pub items: Vec<ObjectRef>,
    /// Length of its unit in millimetres.
    pub unit: f64,
}

/// A property: the identifier of its list, and the index in it.
pub(super) type Property = (u32, u32);

/// Positions, triangles and beams.
#[derive(Default)]
pub(super) struct Mesh {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Property list and indices of the corners of each triangle; empty if no triangle names one.
    pub properties: Vec<Option<(u32, [u32; 3])>>,
    /// Default property of triangles that name none.
    pub usual: Option<Property>,
    /// The two vertices of each beam, and the radius at each.
    pub beams: Vec<([u32; 2], [f32; 2])>,
    /// Span of the triangle list.
    pub at: Span,
}

/// Linear colour and opacity.
pub(super) type Color = [f32; 4];

/// A list that the properties of triangles refer to.
pub(super) struct Properties {
    pub group: Group,
    pub at: Span,
}

/// Content of a property list.
pub(super) enum Group {
    /// Appearance of base materials, colours, composites or multiproperties.
    Colors(Vec<Color>),
    /// Texture coordinates in the picture of a resource, with v upwards.
    Texture { picture: u32, uvs: Vec<Vec2> },
    /// A picture: name of its part, and how it continues beyond its borders.
    Picture { part: String, styles: [Option<String>; 2], at: Span },
}

impl Group {
    pub const NAMES: [&str; 6] =
        ["basematerials", "colorgroup", "texture2d", "texture2dgroup", "compositematerials", "multiproperties"];
}
