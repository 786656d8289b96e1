//! Writes shapes.

use super::prim::{Prim, numbers, vectors};
use super::{PROGRAM, Writer};
use crate::export::shape::Placed;
use durer_scene::math::Vec3;
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use glam::DAffine3;
use std::collections::BTreeMap;

impl Writer<'_> {
    pub(super) fn shapes(&mut self) -> Vec<Prim> {
        let shapes = self.export.shapes(PROGRAM);
        let repeated = self.export.repeated(&shapes, PROGRAM);
        let (mut prims, mut prototypes) = (Vec::new(), BTreeMap::new());
        for (i, shape) in shapes.iter().enumerate() {
            if let Some(light) = self.light_surface(i, shape) {
                prims.push(light);
                continue;
            }
            let key = (shape.key(), shape.material);
            if !repeated.contains(&key) || shape.is_mirrored() {
                prims.extend(self.shape(&format!("Shape_{i}"), shape));
                continue;
            }
            let number = match prototypes.get(&key) {
                Some(number) => *number,
                None => {
                    let own = Placed { to_world: DAffine3::IDENTITY, ..shape.clone() };
                    let number = prototypes.len();
                    let mesh = self.shape("Mesh", &own);
                    let mut class = Prim::class("Xform", format!("_Shape_{number}"));
                    class.children.extend(mesh);
                    self.prototypes.push(class);
                    prototypes.insert(key, number);
                    number
                }
            };
            let instance = Prim::new("Xform", format!("Shape_{i}"))
                .meta("instanceable = true")
                .meta(format!("references = </_Shape_{number}>"));
            prims.push(self.dressed(instance, shape).transform(&shape.to_world));
        }
        prims
    }

    /// Binds the material of a shape to its prim.
    fn dressed(&mut self, prim: Prim, shape: &Placed) -> Prim {
        let bound = self.material(shape.material);
        prim.meta("prepend apiSchemas = [\"MaterialBindingAPI\"]")
            .line(format!("rel material:binding = </World/Materials/{}>", bound.name))
    }

    /// Returns the prim of a shape, or `None` if it cannot be written.
    fn shape(&mut self, name: &str, shape: &Placed) -> Option<Prim> {
        let bound = self.material(shape.material);
        let has_picture = bound.has_picture;
        if let (Some((center, radius)), false) = (shape.sphere(), has_picture) {
            let sphere = Prim::new("Sphere", name).line(format!("double radius = {radius}"));
            return Some(self.dressed(sphere, shape).transform(&DAffine3::from_translation(center)));
        }
        let data = self.export.whole_triangles(shape, PROGRAM)?;
        if has_picture && data.triangle_uvs.is_empty() {
            self.export.warn_lost("some shapes with pictures have no texture coordinates: the pictures are not mapped");
        }
        let (map, data) = match shape.is_mirrored() {
            true => (DAffine3::IDENTITY, crate::export::shape::transformed(data, &shape.to_world)),
            false => (shape.to_world, data),
        };
        let mut prim = Prim::new("Mesh", name)
            .line(format!("uniform bool doubleSided = {}", u8::from(bound.is_double_sided)))
            .line("uniform token subdivisionScheme = \"none\"")
            .line(format!("point3f[] points = {}", vectors(data.positions.iter().map(|p| p.to_array()))))
            .line(format!("int[] faceVertexCounts = {}", numbers(data.triangles.iter().map(|_| 3))))
            .line(format!("int[] faceVertexIndices = {}", numbers(data.triangles.iter().flatten().copied())));
        prim = prim.lines(normals(&data)).lines(coordinates(&data));
        if !data.colors.is_empty() {
            let colors = data.colors.iter().map(|[r, g, b, _]| (bound.vertex_tint * Vec3::new(*r, *g, *b)).to_array());
            prim = prim
                .line(format!("color3f[] primvars:displayColor = {} (interpolation = \"vertex\")", vectors(colors)));
            if data.colors.iter().any(|color| color[3] != 1.0) {
                self.export.warn_lost("the opacity of vertices cannot be written to USD: it is left out");
            }
        }
        Some(self.dressed(prim, shape).transform(&map))
    }
}

/// Returns the lines of the normals of corners. Triangles without normals get those of their plane.
fn normals(data: &MeshData) -> Vec<String> {
    if data.triangle_normals.is_empty() {
        return Vec::new();
    }
    let mut normals = data.normals.clone();
    let mut indices = Vec::with_capacity(3 * data.triangles.len());
    for (corners, own) in data.triangles.iter().zip(&data.triangle_normals) {
        if !own.contains(&NO_INDEX) {
            indices.extend(own);
            continue;
        }
        let [a, b, c] = corners.map(|i| data.positions[i as usize]);
        indices.extend([normals.len() as u32; 3]);
        normals.push((b - a).cross(c - a).normalize_or(Vec3::Y));
    }
    vec![
        format!(
            "normal3f[] primvars:normals = {} (interpolation = \"faceVarying\")",
            vectors(normals.iter().map(|n| n.to_array()))
        ),
        format!("int[] primvars:normals:indices = {}", numbers(indices)),
    ]
}

/// Returns the lines of both sets of texture coordinates.
fn coordinates(data: &MeshData) -> Vec<String> {
    let mut lines = Vec::new();
    if !data.triangle_uvs.is_empty() {
        let mut uvs: Vec<[f32; 2]> = data.uvs.iter().map(|uv| uv.to_array()).collect();
        let missing = uvs.len() as u32;
        let index = |index: &u32| if *index == NO_INDEX { missing } else { *index };
        let indices: Vec<u32> = data.triangle_uvs.iter().flatten().map(index).collect();
        if indices.contains(&missing) {
            uvs.push([0.0; 2]);
        }
        lines.push(format!("texCoord2f[] primvars:st = {} (interpolation = \"faceVarying\")", vectors(uvs)));
        lines.push(format!("int[] primvars:st:indices = {}", numbers(indices)));
    }
    if !data.second_uvs.is_empty() {
        let uvs = data.second_uvs.iter().map(|uv| uv.to_array());
        lines.push(format!("texCoord2f[] primvars:st1 = {} (interpolation = \"vertex\")", vectors(uvs)));
    }
    lines
}
