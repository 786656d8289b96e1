//! Computes the extent of a scene from its description.

use super::{MatrixOp, MatrixRules, Object, ObjectKind, Scene};
use crate::math::Vec3;
use crate::shape::Shape;
use glam::{DAffine3, DVec3};

/// Calls `found` with points whose convex hull contains all bounded objects. Mesh files are not
/// read.
pub fn points(scene: &Scene, found: &mut dyn FnMut(DVec3)) {
    for object in scene.root.iter().flat_map(|root| &root.objects) {
        visit(scene, object, DAffine3::IDENTITY, found);
    }
}

/// Calls `found` with points whose convex hull contains one object, in the coordinate system of its
/// parent.
pub fn object_points(scene: &Scene, object: &Object, found: &mut dyn FnMut(DVec3)) {
    visit(scene, object, DAffine3::IDENTITY, found);
}

fn visit(scene: &Scene, object: &Object, to_world: DAffine3, found: &mut dyn FnMut(DVec3)) {
    let mut offer = |p: Vec3| found(to_world.transform_point3(p.as_dvec3()));
    match &object.node {
        ObjectKind::Group(group) => group.objects.iter().for_each(|object| visit(scene, object, to_world, found)),
        ObjectKind::Transform(ops, inner) => {
            visit(scene, inner, to_world * MatrixOp::product(ops, MatrixRules::default()), found)
        }
        ObjectKind::Solid(_, parts) => parts.iter().for_each(|part| visit(scene, part, to_world, found)),
        ObjectKind::Mesh(mesh) => {
            let Some(data) = scene.assets.meshes.get(&mesh.obj_file.path) else { return };
            // Vertices that no triangle uses are ignored.
            let mut used = vec![false; data.positions.len()];
            data.triangles.iter().flatten().for_each(|&index| used[index as usize] = true);
            data.positions.iter().zip(used).filter(|(_, used)| *used).for_each(|(p, _)| offer(*p));
        }
        ObjectKind::Primitive(shape) => {
            let Some(bounds) = shape.bounds().filter(|bounds| !bounds.is_empty()) else { return };
            for corner in 0..8 {
                let pick = |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
                offer(Vec3::new(pick(0), pick(1), pick(2)));
            }
        }
        ObjectKind::Voxels(grid, _) => [grid.min, grid.max].into_iter().for_each(offer),
        ObjectKind::HeightField(field) => [field.min, field.max].into_iter().for_each(offer),
    }
}
