//! Writes shapes with their materials, the light that they emit, and the media inside.

use super::text::{Directive, scoped, transform};
use super::view::named_medium;
use super::{PROGRAM, Writer};
use crate::export::shape::Placed;
use crate::export::surface::{Look, Mask, Surface, material_name};
use durer_scene::math::Vec3;
use durer_scene::shape::MeshData;
use glam::{DAffine3, DMat3};
use std::collections::BTreeSet;

/// Number of triangles up to which a mesh is part of the scene file.
const FEW: usize = 12;

impl Writer<'_> {
    pub(super) fn shapes(&mut self) -> String {
        let shapes = self.export.shapes(PROGRAM);
        let repeated = self.export.repeated(&shapes, PROGRAM);
        let (mut text, mut groups) = (String::new(), BTreeSet::new());
        for shape in &shapes {
            let look = self.look(shape.material);
            if look.is_interface() && look.medium.is_none() {
                continue;
            }
            let key = (shape.key(), shape.material);
            // Lights cannot be in a group.
            if look.emission.is_some() || shape.is_mirrored() || !repeated.contains(&key) {
                text += &self.shape(shape, &look);
                continue;
            }
            let name = group(repeated.iter().position(|other| *other == key));
            if groups.insert(key) {
                let local = Placed { to_world: DAffine3::IDENTITY, ..shape.clone() };
                text += &format!("ObjectBegin \"{name}\"\n{}ObjectEnd\n", self.shape(&local, &look));
            }
            text += &scoped(&format!("{}ObjectInstance \"{name}\"\n", transform(&shape.to_world)));
        }
        text
    }

    fn look(&mut self, material: Option<u32>) -> Look {
        if let Some(look) = self.looks.get(&material) {
            return look.clone();
        }
        let look = material.map_or_else(Look::plain, |number| self.export.look(number, PROGRAM));
        self.looks.insert(material, look.clone());
        if !look.is_interface() {
            self.material(&material_name(material), &look.surface);
        }
        if let Some(medium) = &look.medium {
            self.named += &named_medium(&inside(material), medium);
        }
        look
    }

    fn shape(&mut self, shape: &Placed, look: &Look) -> String {
        let mut text = match look.is_interface() {
            true => "Material \"interface\"\n".to_string(),
            false => format!("NamedMaterial \"{}\"\n", material_name(shape.material)),
        };
        if look.medium.is_some() {
            let fog = if self.export.scene.fog.is_some() { "fog" } else { "" };
            text += &format!("MediumInterface \"{}\" \"{fog}\"\n", inside(shape.material));
        }
        if let Some(emission) = &look.emission {
            text += &self.area(emission);
        }
        let Some((map, directive)) = self.geometry(shape, look.needs_uv()) else { return String::new() };
        text += &transform(&map);
        let directive = match &look.surface {
            Surface::Masked(_, opacity, mask) => self.masked(directive, *opacity, mask.as_ref()),
            _ => directive,
        };
        scoped(&(text + &directive.line()))
    }

    /// Adds the opacity of a shape.
    fn masked(&mut self, directive: Directive, opacity: f32, mask: Option<&Mask>) -> Directive {
        let texture = mask.and_then(|mask| {
            let file = self.export.opacity_file(mask, opacity)?;
            Some(self.texture("float", &file, &mask.picture.mapping, 1.0))
        });
        match texture {
            Some(texture) => directive.texts("texture", "alpha", &[&texture]),
            None => directive.float("alpha", opacity),
        }
    }

    /// Returns the directive of a shape and its transform, or `None` if it cannot be written.
    fn geometry(&mut self, shape: &Placed, needs_uv: bool) -> Option<(DAffine3, Directive)> {
        if let (Some((center, radius)), false) = (shape.sphere(), needs_uv) {
            return Some((
                DAffine3::from_translation(center),
                Directive::new("Shape", "sphere").float("radius", radius),
            ));
        }
        if let Some((map, radius)) = shape.turned_sphere() {
            return Some((map, Directive::new("Shape", "sphere").float("radius", radius)));
        }
        if let (Some((center, normal, radius)), false) = (shape.disc(), needs_uv) {
            let (x, y) = normal.any_orthonormal_pair();
            let x = if x.cross(y).dot(normal) < 0.0 { -x } else { x };
            let map = DAffine3 { matrix3: DMat3::from_cols(x, y, normal), translation: center };
            return Some((map, Directive::new("Shape", "disk").float("radius", radius)));
        }
        let (map, data) = self.export.mesh(shape, needs_uv, PROGRAM)?;
        if data.triangles.len() <= FEW && data.triangle_normals.is_empty() && data.triangle_uvs.is_empty() {
            return Some((map, listed(&data)));
        }
        let path = self.export.mesh_file(shape, || data)?;
        Some((map, Directive::new("Shape", "plymesh").string("filename", &path)))
    }
}

/// Returns a mesh whose vertices are in the scene file.
fn listed(data: &MeshData) -> Directive {
    let points = data.positions.iter().flat_map(Vec3::to_array);
    let mesh = Directive::new("Shape", "trianglemesh").numbers("point3", "P", points);
    mesh.numbers("integer", "indices", data.triangles.iter().flatten())
}

fn group(number: Option<usize>) -> String {
    format!("group-{}", number.unwrap_or_default())
}

/// Returns the name of the medium inside objects of a material.
fn inside(material: Option<u32>) -> String {
    format!("inside-{}", material_name(material))
}
