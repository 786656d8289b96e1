//! Data structures for a model part after parsing.

use durer_diag::Span;
use durer_scene::math::{Vec2, Vec3};
use glam::DAffine3;
use std::collections::BTreeMap;

/// Reference to an object, with a transform; it is either a build item or a component of another
/// object.
pub(super) struct ObjectRef {
    /// Name of the part that contains the object, if it is in another part.
    pub part: Option<String>,
    pub id: u32,
    pub transform: DAffine3,
    pub at: Span,
}

/// Object resource of a 3MF model, which is either a mesh or a list of references to other objects.
pub(super) enum Object {
    Mesh(Box<Mesh>),
    Components(Vec<ObjectRef>),
}

/// Content of one model part of a 3MF file: its objects, property lists, and build items.
#[derive(Default)]
pub(super) struct Model {
    pub objects: BTreeMap<u32, (Object, Span)>,
    pub properties: BTreeMap<u32, Properties>,
    pub items: Vec<ObjectRef>,
    /// Length of the part's unit of measurement in millimetres.
    pub unit: f64,
}

/// Reference to a property, which consists of the id of a property list and an index in that list.
pub(super) type Property = (u32, u32);

/// Triangle mesh of a 3MF object, with its beams.
#[derive(Default)]
pub(super) struct Mesh {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Property list and indices for the corners of each triangle; empty if no triangle has any
    /// properties.
    pub properties: Vec<Option<(u32, [u32; 3])>>,
    /// Default property for triangles that have none of their own.
    pub default_property: Option<Property>,
    /// The two vertices of each beam, and the beam's radius at each of them.
    pub beams: Vec<([u32; 2], [f32; 2])>,
    /// Span of the list of triangles.
    pub at: Span,
}

/// Linear RGB colour with opacity.
pub(super) type Color = [f32; 4];

/// List of properties, such as colours or texture coordinates, that the corners of triangles refer
/// to.
pub(super) struct Properties {
    pub group: PropertyKind,
    pub at: Span,
}

/// Content of a property list in a 3MF file.
pub(super) enum PropertyKind {
    /// Appearance of base materials, colours, composites, or multiproperties.
    Colors(Vec<Color>),
    /// Texture coordinates for a texture resource, where v points upwards.
    Texture { picture: u32, uvs: Vec<Vec2> },
    /// A texture: the name of the part that contains the image, and the wrap modes along u and v.
    Picture { part: String, styles: [Option<String>; 2], at: Span },
}

impl PropertyKind {
    pub const NAMES: [&str; 6] =
        ["basematerials", "colorgroup", "texture2d", "texture2dgroup", "compositematerials", "multiproperties"];
}
