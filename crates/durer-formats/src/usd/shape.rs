//! Spheres, boxes, cylinders, cones, capsules, planes and points.
//!
//! Source: *OpenUSD documentation*, UsdGeom.

use super::reader::{Inherited, Reader};
use super::stage::Prim;
use crate::sticks::ball;
use durer_scene::math::Vec3;
use durer_scene::scene::{Group, Object, ObjectKind};
use durer_scene::shape::{Cone, Cuboid, Cylinder, Rectangle, Sphere};
use glam::DAffine3;

impl Reader<'_, '_> {
    /// Adds a shape without points.
    pub fn simple_shape(&mut self, prim: &Prim, kind: &str, here: &Inherited, objects: &mut Vec<Object>) {
        let at = prim.span();
        let number = |name: &str, default: f64| self.number(prim, name).unwrap_or(default) as f32;
        let axis = match self.text(prim, "axis").as_deref() {
            Some("X") => Vec3::X,
            Some("Y") => Vec3::Y,
            _ => Vec3::Z,
        };
        let (radius, height) = match kind {
            "Capsule" => (number("radius", 0.5), number("height", 1.0)),
            _ => (number("radius", 1.0), number("height", 2.0)),
        };
        let (base, top) = (-0.5 * height * axis, 0.5 * height * axis);
        let is_empty = match kind {
            "Sphere" => radius <= 0.0,
            "Cube" => number("size", 2.0) <= 0.0,
            "Plane" => number("width", 2.0) <= 0.0 || number("length", 2.0) <= 0.0,
            "Capsule" => radius <= 0.0 || height < 0.0,
            _ => radius <= 0.0 || height <= 0.0,
        };
        if is_empty {
            let message = format!("a {kind} whose size is not greater than 0 is left out");
            return self.stage.files.report.warn_once("empty-shape", at, message);
        }
        let side = 0.5 * number("size", 2.0);
        let node: ObjectKind = match kind {
            "Sphere" => ObjectKind::Primitive(Sphere { center: Vec3::ZERO, radius }.into()),
            "Cube" => ObjectKind::Primitive(Cuboid { min: Vec3::splat(-side), max: Vec3::splat(side) }.into()),
            "Cylinder" => ObjectKind::Primitive(Cylinder { base, top, radius }.into()),
            "Cone" => ObjectKind::Primitive(Cone { base, top, base_radius: radius, top_radius: 0.0 }.into()),
            "Plane" => {
                let (width, length) = (number("width", 2.0), number("length", 2.0));
                // The width is along x, or along z if that is the normal's neighbour.
                let (u, v) = match axis {
                    Vec3::X => (Vec3::NEG_Z * width, Vec3::Y * length),
                    Vec3::Y => (Vec3::X * width, Vec3::NEG_Z * length),
                    _ => (Vec3::X * width, Vec3::Y * length),
                };
                ObjectKind::Primitive(Rectangle { corner: -0.5 * (u + v), edge0: u, edge1: v }.into())
            }
            _ => {
                let part = |node| Object { node, material: None, span: at };
                let mut parts = vec![part(ball(base, radius)), part(ball(top, radius))];
                if height > 0.0 {
                    parts.push(part(ObjectKind::Primitive(Cylinder { base, top, radius }.into())));
                }
                ObjectKind::Group(Group { objects: parts })
            }
        };
        let material = self.material_of(prim, here.material.as_deref(), at);
        // Objects in a group have their own material.
        let node = match node {
            ObjectKind::Group(mut group) => {
                group.objects.iter_mut().for_each(|part| part.material = material);
                ObjectKind::Group(group)
            }
            other => other,
        };
        self.add(node, material, here.to_world, at, objects);
    }

    /// Adds points as spheres.
    pub fn points(&mut self, prim: &Prim, here: &Inherited, objects: &mut Vec<Object>) {
        let at = prim.span();
        let Some(points) = prim.get(self.stage, "points") else { return };
        let widths = prim.get(self.stage, "widths");
        let widths = widths.as_ref().map_or(&[][..], |widths| widths.value.numbers());
        let material = self.material_of(prim, here.material.as_deref(), at);
        for (i, point) in points.value.numbers().as_chunks::<3>().0.iter().enumerate() {
            let width = widths.get(i).or(widths.first()).copied().unwrap_or(1.0);
            let center = Vec3::from_array(point.map(|x| x as f32));
            if width > 0.0 && width.is_finite() && center.is_finite() {
                let moved = here.to_world * DAffine3::from_translation(center.as_dvec3());
                self.add(ball(Vec3::ZERO, 0.5 * width as f32), material, moved, at, objects);
            }
        }
    }
}
