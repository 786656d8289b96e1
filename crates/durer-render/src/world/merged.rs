//! Merging of all meshes of a world into one mesh in world space.

use super::{Geometry, World};
use durer_scene::math::Vec3;
use durer_scene::shape::MeshData;
use durer_scene::shape::Shape as _;
use durer_scene::shape::mesh::NO_INDEX;
use std::borrow::Cow;

impl World {
    /// Merges all meshes and tessellated shapes into one mesh in world space. The result includes
    /// the number of objects that were left out because they have no triangles: planes and solids.
    pub fn merged_mesh(&self) -> (MeshData, usize) {
        let (mut all, mut left_out) = (MeshData::default(), 0);
        for object in self.objects() {
            let triangles = match &object.geometry {
                Geometry::Mesh(tree) => {
                    let (normals, triangle_normals) = tree.mesh.normals();
                    Some((tree.mesh.to_data(), Cow::Borrowed(normals), triangle_normals))
                }
                Geometry::Primitive(shape) => shape.to_mesh().map(|mut data| {
                    let normals = std::mem::take(&mut data.normals);
                    let triangle_normals = std::mem::take(&mut data.triangle_normals);
                    (Cow::Owned(data), Cow::Owned(normals), Cow::Owned(triangle_normals))
                }),
                Geometry::Solid(_) => None,
            };
            let Some((data, normals, triangle_normals)) = triangles else {
                left_out += 1;
                continue;
            };
            let point = |p: &Vec3| object.world_point(*p);
            let normal = |n: &Vec3| object.to_world.as_ref().map_or(*n, |to_world| to_world.normal(*n));
            let bases = [&all.positions.len(), &all.uvs.len(), &all.normals.len()].map(|count| *count as u32);
            all.flat |= data.flat;
            let before = all.triangles.len();
            // A reflection turns triangles inside out, so two of their corners are swapped.
            let mirrors = object.to_world.as_ref().is_some_and(|to_world| to_world.flips_handedness());
            let turned = |list: &[[u32; 3]], base: u32| -> Vec<[u32; 3]> {
                let moved = |i: u32| if i == NO_INDEX { i } else { i + base };
                let turn = |[a, b, c]: [u32; 3]| if mirrors { [a, c, b] } else { [a, b, c] };
                list.iter().map(|t| turn(t.map(moved))).collect()
            };
            if !data.colors.is_empty() {
                all.colors.resize(all.positions.len(), [1.0; 4]);
                all.colors.extend(&data.colors);
            }
            all.positions.extend(data.positions.iter().map(point));
            all.uvs.extend(&data.uvs);
            all.normals.extend(normals.iter().map(normal));
            all.triangles.extend(turned(&data.triangles, bases[0]));
            for (list, own, base) in [
                (&mut all.triangle_uvs, &data.triangle_uvs[..], bases[1]),
                (&mut all.triangle_normals, &triangle_normals, bases[2]),
            ] {
                if !own.is_empty() {
                    list.resize(before, [NO_INDEX; 3]);
                    list.extend(turned(own, base));
                }
            }
        }
        if !all.colors.is_empty() {
            all.colors.resize(all.positions.len(), [1.0; 4]);
        }
        for list in [&mut all.triangle_uvs, &mut all.triangle_normals] {
            if !list.is_empty() {
                list.resize(all.triangles.len(), [NO_INDEX; 3]);
            }
        }
        (all, left_out)
    }
}
