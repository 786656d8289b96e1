//! Contents of a scene, such as groups, objects and materials. Scenes with text are edited as text.
//! Models have no text, so their materials are edited here.

use crate::document::CompiledDocument;
use crate::fields::{field_states, set_numbers};
use crate::protocol::{FieldState, MaterialState, SceneNode};
use durer::describe::DescribedKind;
use durer::dialect::Dialect;
use durer::scene::{Material, Object, ObjectKind, Scene};

/// Maximum number of nodes that are listed. The same limit applies to materials.
const MAX_NODES: usize = 2000;

/// Returns the objects of a scene as a tree of groups.
pub(crate) fn nodes(compiled: &CompiledDocument) -> Vec<SceneNode> {
    let mut left = MAX_NODES;
    let root = compiled.scene().root.iter().flat_map(|group| &group.objects);
    root.map_while(|object| node(compiled, object, &mut left)).collect()
}

/// Returns an object with its subtree, or `None` if the maximum number of nodes has been reached.
fn node(compiled: &CompiledDocument, object: &Object, left: &mut usize) -> Option<SceneNode> {
    *left = left.checked_sub(1)?;
    let name = match &object.node {
        ObjectKind::Group(_) => "Group".into(),
        ObjectKind::Transform(..) => "Transform".into(),
        ObjectKind::Solid(operation, _) => operation.keyword().into(),
        ObjectKind::Primitive(shape) => shape.own_keyword().into(),
        ObjectKind::Mesh(mesh) => mesh.obj_file.path.clone(),
        ObjectKind::Voxels(..) => "VoxelGrid".into(),
        ObjectKind::HeightField(_) => "HeightField".into(),
    };
    Some(SceneNode {
        name,
        place: compiled.place(object.span),
        material: object.material,
        nodes: object.node.children().iter().map_while(|object| node(compiled, object, left)).collect(),
    })
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
pub(crate) fn set_material(scene: &mut Scene, number: u32, name: &str, values: &[f32]) -> Result<(), String> {
    let material = scene.materials.get_mut(number as usize).ok_or_else(|| format!("there is no material {number}"))?;
    match &mut material.value {
        Material::Phong(phong, _) => set_numbers(&mut **phong, name, values),
        Material::Principled(layers) => set_numbers(&mut **layers, name, values),
        Material::Hair(hair) => set_numbers(hair, name, values),
        Material::Solid(solid, _) => set_numbers(solid, name, values),
    }
}
