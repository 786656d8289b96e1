//! Contents of a scene, such as groups, objects and materials. Scenes with text are edited as text.
//! Models have no text, so their materials are edited here.

use crate::document::CompiledDocument;
use crate::fields::{NewValue, field_states, set_value};
use crate::protocol::{FieldState, MaterialState, SceneNode};
use durer::describe::DescribedKind;
use durer::dialect::Dialect;
use durer::scene::{Material, Object, ObjectKind, Scene};

/// Maximum number of nodes that are listed. The same limit applies to materials.
const MAX_NODES: usize = 2000;

/// Returns the objects of a scene as a tree of groups.
pub(crate) fn nodes(compiled: &CompiledDocument) -> Vec<SceneNode> {
    let scene = compiled.scene();
    let is_whole = |object: &Object| !matches!(object.node, ObjectKind::Solid(..));
    let is_numbered = scene.objects().all(is_whole)
        && scene.objects().filter(|object| is_leaf(object)).count() == compiled.world.objects().len();
    let mut listing = Listing { compiled, left: MAX_NODES, next: is_numbered.then_some(0) };
    let root = scene.root.iter().flat_map(|group| &group.objects);
    root.map_while(|object| listing.node(object)).collect()
}

/// True for objects that the renderer numbers.
fn is_leaf(object: &Object) -> bool {
    !matches!(object.node, ObjectKind::Group(_) | ObjectKind::Transform(..))
}

/// State of the listing of a scene's objects.
struct Listing<'a> {
    compiled: &'a CompiledDocument,
    /// Number of nodes that may still be listed.
    left: usize,
    /// Number of the next object in the order of rendering, or `None` if the objects of the scene
    /// and those that are rendered do not correspond, for example because a solid is rendered as
    /// several pieces.
    next: Option<u32>,
}

impl Listing<'_> {
    /// Returns an object with its subtree, or `None` if the maximum number of nodes has been
    /// reached.
    fn node(&mut self, object: &Object) -> Option<SceneNode> {
        self.left = self.left.checked_sub(1)?;
        let is_leaf = is_leaf(object);
        let number = self.next.filter(|_| is_leaf);
        self.next = self.next.map(|next| next + u32::from(is_leaf));
        let nodes = object.node.children().iter().map_while(|object| self.node(object)).collect();
        Some(SceneNode {
            name: name(object),
            place: self.compiled.place(object.span),
            object: number,
            material: object.material,
            nodes,
        })
    }
}

fn name(object: &Object) -> String {
    match &object.node {
        ObjectKind::Group(_) => "Group".into(),
        ObjectKind::Transform(..) => "Transform".into(),
        ObjectKind::Solid(operation, _) => operation.keyword().into(),
        ObjectKind::Primitive(shape) => shape.own_keyword().into(),
        ObjectKind::Mesh(mesh) => mesh.obj_file.path.clone(),
        ObjectKind::Voxels(..) => "VoxelGrid".into(),
        ObjectKind::HeightField(_) => "HeightField".into(),
    }
}

/// Returns the materials of a scene with their fields.
pub(crate) fn materials(compiled: &CompiledDocument) -> Vec<MaterialState> {
    let all = compiled.scene().materials.iter().take(MAX_NODES);
    all.map(|material| {
        let (name, fields) = described(&material.value);
        MaterialState { name: name.into(), place: compiled.place(material.span), fields }
    })
    .collect()
}

fn described(material: &Material) -> (&'static str, Vec<FieldState>) {
    fn of(list: &impl DescribedKind) -> (&'static str, Vec<FieldState>) {
        (list.keyword(Dialect::Durer), field_states(list))
    }
    match material {
        Material::Phong(phong, _) => of(&**phong),
        Material::Principled(layers) => of(&**layers),
        Material::Hair(hair) => of(hair),
        Material::Solid(solid, _) => of(solid),
    }
}

/// Sets a field of a material.
pub(crate) fn set_material(scene: &mut Scene, number: u32, name: &str, new: NewValue) -> Result<(), String> {
    let material = scene.materials.get_mut(number as usize).ok_or_else(|| format!("there is no material {number}"))?;
    match &mut material.value {
        Material::Phong(phong, _) => set_value(&mut **phong, name, new),
        Material::Principled(layers) => set_value(&mut **layers, name, new),
        Material::Hair(hair) => set_value(hair, name, new),
        Material::Solid(solid, _) => set_value(solid, name, new),
    }
}
