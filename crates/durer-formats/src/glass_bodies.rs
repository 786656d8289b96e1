//! Joins the meshes of glass bodies whose surface is divided into several meshes.
//!
//! pbrt and Mitsuba decide whether a ray enters or leaves a body only by the side of the surface
//! that it hits. Dürer keeps track of the objects that contain the ray, so the surface of each body
//! must be a single object. For this reason, open meshes with the same glass material are joined.

use durer_scene::dialect::MeshNormals;
use durer_scene::material::principled::Walls;
use durer_scene::scene::{Group, Material, MatrixOp, MatrixRules, Object, ObjectKind, Scene};
use durer_scene::shape::mesh::NO_INDEX;
use durer_scene::shape::{Mesh, MeshData};
use glam::{DAffine3, DVec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Returns the name of an object's mesh and the object's transform.
fn mesh_of(object: &Object) -> Option<(&str, DAffine3)> {
    match &object.node {
        ObjectKind::Mesh(mesh) => Some((&mesh.obj_file.path, DAffine3::IDENTITY)),
        ObjectKind::Transform(ops, inner) => {
            mesh_of(inner).map(|(name, map)| (name, MatrixOp::product(ops, MatrixRules::default()) * map))
        }
        _ => None,
    }
}

/// Collects the names of all meshes in a group of objects.
fn used(group: &Group, names: &mut BTreeSet<String>) {
    for object in &group.objects {
        match &object.node {
            ObjectKind::Group(inner) => used(inner, names),
            ObjectKind::Transform(_, inner) => {
                if let ObjectKind::Group(inner) = &inner.node {
                    used(inner, names);
                }
            }
            _ => {}
        }
        names.extend(mesh_of(object).map(|(name, _)| name.to_string()));
    }
}

/// Appends a copy of a mesh, transformed to world space.
fn append(body: &mut MeshData, data: &MeshData, map: DAffine3) {
    let mirrored = map.matrix3.determinant() < 0.0;
    let normals = map.matrix3.inverse().transpose();
    let moved = |n: DVec3| (normals * n).normalize_or_zero().as_vec3();
    let count = data.triangles.len();
    let add = |list: &mut Vec<[u32; 3]>, own: &[[u32; 3]], from: usize| {
        let corners = (0..count).map(|i| own.get(i).copied().unwrap_or([NO_INDEX; 3]));
        list.extend(corners.map(|corners| {
            let [a, b, c] = corners.map(|i| if i == NO_INDEX { i } else { i + from as u32 });
            if mirrored { [a, c, b] } else { [a, b, c] }
        }));
    };
    add(&mut body.triangles, &data.triangles, body.positions.len());
    add(&mut body.triangle_uvs, &data.triangle_uvs, body.uvs.len());
    add(&mut body.triangle_normals, &data.triangle_normals, body.normals.len());
    let place = |p: &durer_scene::math::Vec3| map.transform_point3(p.as_dvec3()).as_vec3();
    body.positions.extend(data.positions.iter().map(place));
    body.normals.extend(data.normals.iter().map(|n| moved(n.as_dvec3())));
    body.uvs.extend(&data.uvs);
    body.flat = true;
}

/// Joins the open meshes of each glass material into one mesh. `name` is the name of the scene
/// file.
pub(super) fn join_bodies(scene: &mut Scene, name: &str) {
    let Some(root) = &mut scene.root else { return };
    let materials = &scene.materials;
    let is_glass = |number: u32| match materials.get(number as usize).map(|m| &m.value) {
        Some(Material::Principled(m)) => m.transmission_weight > 0.0 && m.walls == Walls::Solid,
        _ => false,
    };
    let meshes = &mut scene.assets.meshes;
    let mut skins: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, object) in root.objects.iter().enumerate() {
        let Some(material) = object.material.filter(|&number| is_glass(number)) else { continue };
        let Some(data) = mesh_of(object).and_then(|(name, _)| meshes.get(name)) else { continue };
        let mesh = Mesh::new(Arc::clone(data), MeshNormals::Flat, true);
        if !mesh.open_edges().is_empty() {
            skins.entry(material).or_default().push(i);
        }
    }
    let mut gone: BTreeSet<usize> = BTreeSet::new();
    for (material, skin) in skins.into_iter().filter(|(_, skin)| skin.len() > 1) {
        let mut body = MeshData::default();
        for &i in &skin {
            if let Some((name, map)) = mesh_of(&root.objects[i])
                && let Some(data) = meshes.get(name)
            {
                append(&mut body, data, map);
            }
        }
        let span = root.objects[skin[0]].span;
        let name = format!("{}#body{material}", name);
        meshes.insert(name.clone(), Arc::new(body));
        let path = durer_scene::describe::FileName { path: name, span };
        let node = ObjectKind::Mesh(durer_scene::shape::TriangleMesh { obj_file: path });
        root.objects[skin[0]] = Object { node, material: Some(material), span };
        gone.extend(&skin[1..]);
    }
    if gone.is_empty() {
        return;
    }
    let mut number = 0;
    root.objects.retain(|_| {
        number += 1;
        !gone.contains(&(number - 1))
    });
    let mut names = BTreeSet::new();
    used(root, &mut names);
    meshes.retain(|name, _| names.contains(name));
}
