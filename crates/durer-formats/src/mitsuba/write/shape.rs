//! Writes shapes with their materials, the light that they emit, and the media inside.

use super::element::Element;
use super::{PROGRAM, Writer};
use crate::export::shape::{Geometry, Placed};
use crate::export::surface::{Emission, Look, material_name};
use crate::mitsuba::tessellate::with_flipped_v;
use crate::mitsuba::transform::frame;
use durer_scene::shape::Primitive;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::BTreeMap;

/// Distance of the back side of a light from its front side, relative to its size.
const SHEET: f64 = 1e-4;

impl Writer<'_> {
    pub(super) fn shapes(&mut self) -> Vec<Element> {
        let shapes = self.export.shapes(PROGRAM);
        let repeated = self.export.repeated(&shapes, PROGRAM);
        let (mut elements, mut groups) = (Vec::new(), BTreeMap::new());
        for shape in &shapes {
            let look = self.look(shape.material);
            if look.is_interface() && look.medium.is_none() {
                continue;
            }
            let key = (shape.key(), shape.material);
            // Lights and media cannot be in a group.
            let is_plain = look.emission.is_none() && look.medium.is_none() && !shape.is_mirrored();
            if is_plain && repeated.contains(&key) {
                let group = match groups.get(&key) {
                    Some(group) => *group,
                    None => {
                        let number = groups.len();
                        let parts = self.shape(&Placed { to_world: DAffine3::IDENTITY, ..shape.clone() }, &look);
                        let group = Element::plugin("shape", "shapegroup").with("id", format!("group-{number}"));
                        self.shared.push(group.and_all(parts));
                        groups.insert(key, number);
                        number
                    }
                };
                let instance = Element::plugin("shape", "instance").transform("to_world", &shape.to_world);
                elements.push(instance.and(Element::new("ref").with("id", format!("group-{group}"))));
            } else {
                elements.extend(self.shape(shape, &look));
            }
        }
        elements
    }

    pub(super) fn look(&mut self, material: Option<u32>) -> Look {
        if let Some(look) = self.looks.get(&material) {
            return look.clone();
        }
        let look = material.map_or_else(Look::plain, |number| self.export.look(number, PROGRAM));
        self.looks.insert(material, look.clone());
        if !look.is_interface() {
            let bsdf = self.bsdf(&look.surface).with("id", material_name(material));
            self.shared.push(bsdf);
        }
        look
    }

    /// Returns the elements of a shape: usually one, and none if it cannot be written.
    fn shape(&mut self, shape: &Placed, look: &Look) -> Vec<Element> {
        let Some(geometry) = self.geometry(shape, look.needs_uv()) else { return Vec::new() };
        let mut elements = Vec::new();
        if look.emission.as_ref().is_some_and(|emission| emission.is_two_sided) {
            match back(shape) {
                Some(element) if !look.needs_uv() => elements.push(element),
                _ => self.export.warn_lost("area lights of Mitsuba emit on one side: the other side stays dark"),
            }
        }
        elements.insert(0, geometry);
        elements.into_iter().map(|element| self.dressed(element, shape.material, look)).collect()
    }

    /// Adds the material, the light and the medium to a shape.
    fn dressed(&mut self, mut element: Element, material: Option<u32>, look: &Look) -> Element {
        element = match look.is_interface() {
            true => element.and(Element::plugin("bsdf", "null")),
            false => element.and(Element::new("ref").with("id", material_name(material))),
        };
        if let Some(emission) = &look.emission {
            element = element.and(self.area(emission));
        }
        match &look.medium {
            Some(medium) => element.and(self.medium("interior", medium)),
            None => element,
        }
    }

    fn area(&mut self, emission: &Emission) -> Element {
        let area = Element::plugin("emitter", "area");
        match &emission.picture {
            Some(picture) => match self.export.bright_file(picture, emission.radiance) {
                Some(file) => area.and(self.bitmap("radiance", &file, &picture.mapping)),
                None => area.rgb("radiance", emission.radiance),
            },
            None => area.rgb("radiance", emission.radiance),
        }
    }

    /// Returns the element of a shape without its material, or `None` if it cannot be written.
    fn geometry(&mut self, shape: &Placed, needs_uv: bool) -> Option<Element> {
        let map = &shape.to_world;
        if let (Some((center, radius)), false) = (shape.sphere(), needs_uv) {
            return Some(Element::plugin("shape", "sphere").float("radius", radius).vector(
                "point",
                "center",
                center.to_array(),
            ));
        }
        if let Some((map, radius)) = shape.turned_sphere() {
            return Some(Element::plugin("shape", "sphere").float("radius", radius).transform("to_world", &map));
        }
        if let (Some((corner, [a, b])), false) = (shape.rectangle(), needs_uv) {
            return Some(rectangle(corner, [a, b]));
        }
        if let (Some((center, normal, radius)), false) = (shape.disc(), needs_uv) {
            return Some(disk(center, normal, radius));
        }
        if let (Geometry::Primitive(Primitive::Cuboid(cuboid)), false) = (&shape.geometry, needs_uv) {
            let (min, max) = (cuboid.min.as_dvec3(), cuboid.max.as_dvec3());
            let own = DAffine3::from_translation(0.5 * (min + max)) * DAffine3::from_scale(0.5 * (max - min));
            // A mirrored cube is the same cube, mirrored once more about its middle.
            let side = if shape.is_mirrored() { DVec3::NEG_ONE } else { DVec3::ONE };
            return Some(
                Element::plugin("shape", "cube").transform("to_world", &(*map * own * DAffine3::from_scale(side))),
            );
        }
        let (map, data) = self.export.mesh(shape, needs_uv, PROGRAM)?;
        let is_flat = data.flat;
        let path = self.export.mesh_file(shape, || with_flipped_v(data))?;
        let mesh = Element::plugin("shape", "ply").text("filename", &path);
        let mesh = if is_flat { mesh.boolean("face_normals", true) } else { mesh };
        Some(if shape.is_mirrored() { mesh } else { mesh.transform("to_world", &map) })
    }
}

/// Returns the back side of a flat shape, slightly behind its front side.
fn back(shape: &Placed) -> Option<Element> {
    if let Some((corner, [a, b])) = shape.rectangle() {
        let normal = a.cross(b).normalize_or_zero();
        return Some(rectangle(corner - SHEET * a.length().min(b.length()) * normal, [b, a]));
    }
    let (center, normal, radius) = shape.disc()?;
    Some(disk(center - SHEET * radius * normal, -normal, radius))
}

fn rectangle(corner: DVec3, [a, b]: [DVec3; 2]) -> Element {
    let matrix3 = DMat3::from_cols(0.5 * a, 0.5 * b, a.cross(b).normalize_or(DVec3::Z));
    let map = DAffine3 { matrix3, translation: corner + 0.5 * (a + b) };
    Element::plugin("shape", "rectangle").transform("to_world", &map)
}

fn disk(center: DVec3, normal: DVec3, radius: f64) -> Element {
    let map = DAffine3 {
        matrix3: frame(normal) * DMat3::from_diagonal(DVec3::new(radius, radius, 1.0)),
        translation: center,
    };
    Element::plugin("shape", "disk").transform("to_world", &map)
}
