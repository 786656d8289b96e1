//! Data structures of a parsed model part.

use durer_diag::Span;
use durer_scene::math::{Vec2, Vec3};
use glam::DAffine3;
use std::collections::BTreeMap;

/// Reference to an object with a transform: a build item, or a component of another object.
pub(super) struct ObjectRef {
    /// Name of the part that contains the object, if it is another part.
    pub part: Option<String>,
    pub id: u32,
    pub transform: DAffine3,
    pub at: Span,
}

/// Object resource of a 3MF model: a mesh, or references to other objects.
pub(super) enum Object {
    Mesh(Box<Mesh>),
    Components(Vec<ObjectRef>),
}

/// Content of one 3MF model part: its objects, property lists and build items.
#[derive(Default)]
pub(super) struct Model {
    pub objects: BTreeMap<u32, (Object, Span)>,
    pub properties: BTreeMap<u32, Properties>,
    pub items: Vec<ObjectRef>,
    /// Length of its unit of measurement in millimetres.
    pub unit: f64,
}

/// Reference to a property: the id of its property list, and the index in that list.
pub(super) type Property = (u32, u32);

/// Triangle mesh and beams of a 3MF object.
#[derive(Default)]
pub(super) struct Mesh {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Property list and indices for the corners of each triangle; empty if no triangle has
    /// properties.
    pub properties: Vec<Option<(u32, [u32; 3])>>,
    /// Default property of triangles without their own.
    pub default_property: Option<Property>,
    /// The two vertices of each beam, and the radius at each.
    pub beams: Vec<([u32; 2], [f32; 2])>,
    /// Span of the triangle list.
    pub at: Span,
}

/// Linear RGB colour and opacity.
pub(super) type Color = [f32; 4];

/// Property list, such as colours or texture coordinates, that triangle corners refer to.
pub(super) struct Properties {
    pub group: PropertyKind,
    pub at: Span,
}

/// Content of a 3MF property list.
pub(super) enum PropertyKind {
    /// Appearance of base materials, colours, composites or multiproperties.
    Colors(Vec<Color>),
    /// Texture coordinates in a texture resource, with v upwards.
    Texture { picture: u32, uvs: Vec<Vec2> },
    /// A texture: the name of the image's part, and the wrap mode along u and v.
    Picture { part: String, styles: [Option<String>; 2], at: Span },
}

impl PropertyKind {
    pub const NAMES: [&str; 6] =
        ["basematerials", "colorgroup", "texture2d", "texture2dgroup", "compositematerials", "multiproperties"];
}
