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
        let (usual_radius, usual_height) = if kind == "Capsule" { (0.5, 1.0) } else { (1.0, 2.0) };
        // The second version of cylinders and capsules has a radius for each end.
        let radius = number("radiusBottom", number("radius", usual_radius).into());
        let top_radius = number("radiusTop", radius.into());
        let height = number("height", usual_height);
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
            "Cylinder" if top_radius == radius => ObjectKind::Primitive(Cylinder { base, top, radius }.into()),
            "Cylinder" => ObjectKind::Primitive(Cone { base, top, base_radius: radius, top_radius }.into()),
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
                let mut parts = vec![part(ball(base, radius)), part(ball(top, top_radius))];
                if top_radius != radius {
                    let message = "a capsule with two radii has no exact counterpart: its ends are balls around a cone";
                    self.stage.files.report.unsupported_once(at, message);
                }
                if height > 0.0 {
                    let body = match top_radius == radius {
                        true => Cylinder { base, top, radius }.into(),
                        false => Cone { base, top, base_radius: radius, top_radius }.into(),
                    };
                    parts.push(part(ObjectKind::Primitive(body)));
                }
                ObjectKind::Group(Group { objects: parts })
            }
        };
        let material = self.material_of(prim, here, at);
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
        let material = self.material_of(prim, here, at);
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
