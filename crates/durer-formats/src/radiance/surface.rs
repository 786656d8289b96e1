//! Converts surfaces.

use super::args::RadPrimitive;
use super::body::MaterialMesh;
use super::context::PrimitiveContext;
use super::converted::{ConvertedModifier, MaterialKind};
use super::outline::EmitterShape;
use super::state::Reader;
use super::words::Word;
use durer_diag::Span;
use durer_scene::math::Vec3;
use durer_scene::scene::ObjectKind;
use durer_scene::shape::{Disc, Sphere};
use glam::DVec3;

impl Reader<'_> {
    /// Converts a surface primitive.
    pub fn surface(&mut self, primitive: &RadPrimitive, modifier: Option<usize>, place: &PrimitiveContext) {
        let at = primitive.at();
        if !self.count_shapes(1, at) {
            return;
        }
        let map = place.map;
        // Transforms in Radiance are similarity transforms, so they scale all lengths by the same
        // factor.
        let scale = map.matrix3.x_axis.length();
        match primitive.kind.text.as_str() {
            "instance" | "mesh" => {
                let name = primitive.texts.first().map_or(String::new(), Word::quoted);
                let help = match primitive.kind.text.as_str() {
                    "mesh" => "Radiance meshes are not supported: convert the original OBJ to polygons with `obj2rad`",
                    _ => "octrees are not supported: write `!xform OPTIONS FILE.rad` with the octree's source file",
                };
                self.warn_missing_files(primitive);
                let message = format!("{name} is left out: {help}");
                self.report.unsupported_once(at, message);
            }
            "source" => self.source(primitive, modifier, place),
            "sphere" | "bubble" => {
                if !primitive.has(&[4], self.report) {
                    return;
                }
                let radius = primitive.numbers[3];
                if radius < 0.0 {
                    let message = "the radius of a sphere is negative, so its surface faces inwards, as in Radiance";
                    self.report.warn_once("bad-value", at, message);
                }
                let inward = ((primitive.kind.text == "bubble") != (radius < 0.0)) != place.inverted;
                let (center, radius) = (map.transform_point3(primitive.point(0)), scale * radius.abs());
                if radius == 0.0 {
                    return self.report.warn_once("bad-value", at, "a sphere of radius 0 is left out");
                }
                let Some((converted, number)) =
                    self.surface_material(modifier, &EmitterShape::Ball { center, radius }, at)
                else {
                    return;
                };
                let number = match &converted.kind {
                    MaterialKind::Glass { outside: Some(outside), .. } if inward => *outside,
                    MaterialKind::Emitter { .. } if inward => {
                        self.report
                            .unsupported_once(at, "a sphere that emits inwards has no counterpart: it emits outwards");
                        number
                    }
                    _ => number,
                };
                let sphere = Sphere { center: center.as_vec3(), radius: radius as f32 };
                self.add(ObjectKind::Primitive(sphere.into()), number, at);
            }
            "polygon" => {
                if primitive.numbers.len() < 9 || !primitive.numbers.len().is_multiple_of(3) {
                    let message = format!(
                        "a polygon needs at least 3 vertices with 3 numbers each, but this polygon has {} numbers",
                        primitive.numbers.len()
                    );
                    return self.report.error(at, message);
                }
                let corners: Vec<DVec3> = (0..primitive.numbers.len() / 3).map(|i| primitive.point(3 * i)).collect();
                self.polygon(modifier, &corners, place, at);
            }
            "ring" => {
                if !primitive.has(&[8], self.report) {
                    return;
                }
                let radii = [primitive.numbers[6], primitive.numbers[7]].map(|r| scale * r.abs());
                let (inner, outer) = (radii[0].min(radii[1]), radii[0].max(radii[1]));
                let side = if place.inverted { -1.0 } else { 1.0 };
                let Some(normal) =
                    map.transform_vector3(side * primitive.point(3)).try_normalize().filter(|_| outer > 0.0)
                else {
                    return self.report.warn_once(
                        "bad-value",
                        at,
                        "a ring without a direction or a radius is left out",
                    );
                };
                let center = map.transform_point3(primitive.point(0));
                let outline = EmitterShape::Ring { center, normal, radii: [inner, outer] };
                let Some((converted, number)) = self.surface_material(modifier, &outline, at) else { return };
                if converted.is_glass() {
                    return self.body(number, at).add_ring(center, normal, [inner, outer]);
                }
                let [center, normal] = [center, normal].map(|v| v.as_vec3());
                if inner < outer {
                    let ring = Disc { center, normal, radius: outer as f32, inner_radius: inner as f32 };
                    self.add(ObjectKind::Primitive(ring.into()), number, at);
                }
            }
            kind @ ("cone" | "cup" | "cylinder" | "tube") => {
                let straight = matches!(kind, "cylinder" | "tube");
                if !primitive.has(if straight { &[7] } else { &[8] }, self.report) || !self.count_shapes(256, at) {
                    return;
                }
                let radii = [primitive.numbers[6], primitive.numbers[if straight { 6 } else { 7 }]];
                let ends = [primitive.point(0), primitive.point(3)];
                let length = ends[0].distance(ends[1]);
                if radii[0] * radii[1] < 0.0 || radii == [0.0; 2] || (length == 0.0 && radii[0] == radii[1]) {
                    let what = "without a length, or with radii that are all 0 or differ in sign, is left out";
                    return self.report.warn_once("bad-value", at, format!("a {kind} {what}"));
                }
                let inward = (matches!(kind, "cup" | "tube") != (radii[0] + radii[1] < 0.0)) != place.inverted;
                let radii = radii.map(f64::abs);
                let outline = EmitterShape::Side {
                    ends: ends.map(|end| map.transform_point3(end)),
                    radii: radii.map(|radius| scale * radius),
                };
                let Some((_, number)) = self.surface_material(modifier, &outline, at) else { return };
                self.body(number, at).add_side(ends, radii, map, inward);
            }
            _ => {}
        }
    }

    /// Adds a face that a generator has created. An unknown material is reported only for the first
    /// face of the generator's output.
    pub fn facet(&mut self, modifier: &Word, corners: &[DVec3], name: &Word, place: &PrimitiveContext, first: bool) {
        let known = modifier.text == "void" || self.names.contains_key(&modifier.text);
        if !known && !first {
            return;
        }
        if let Some(modifier) = self.find(modifier) {
            self.polygon(modifier, corners, place, name.at);
        }
    }

    fn polygon(&mut self, modifier: Option<usize>, corners: &[DVec3], place: &PrimitiveContext, at: Span) {
        if !self.count_shapes(corners.len(), at) {
            return;
        }
        let mut corners: Vec<DVec3> = corners.iter().map(|p| place.map.transform_point3(*p)).collect();
        if place.inverted != (place.map.matrix3.determinant() < 0.0) {
            corners.reverse();
        }
        let Some((_, number)) = self.surface_material(modifier, &EmitterShape::Polygon(&corners), at) else { return };
        let corners: Vec<Vec3> = corners.iter().map(|p| p.as_vec3()).collect();
        let mut triangles = Vec::with_capacity(corners.len() - 2);
        if self.triangulator.triangulate(corners.len(), |i| corners[i], |triangle| triangles.push(triangle)).is_err() {
            return self.report.error(at, "this polygon is too complex to triangulate");
        }
        self.body(number, at).add_face(&corners, &triangles);
    }

    /// Returns the mesh that contains all surfaces with a material.
    fn body(&mut self, number: u32, at: Span) -> &mut MaterialMesh {
        self.bodies.entry(number).or_insert_with(|| MaterialMesh::new(at))
    }

    /// Returns the converted material of a surface and the number of that material, or `None` if
    /// the surface is not shown. If the material has a directional distribution, adds point lights
    /// instead of the surface.
    fn surface_material(
        &mut self,
        modifier: Option<usize>,
        outline: &EmitterShape,
        at: Span,
    ) -> Option<(std::rc::Rc<ConvertedModifier>, u32)> {
        // Surfaces with the modifier `void` are intended for other programs.
        let converted = self.convert(modifier?);
        match converted.kind {
            MaterialKind::DirectionalEmitter { .. } => {
                self.point_lights(&converted, outline, at);
                None
            }
            _ => converted.number.map(|number| (converted, number)),
        }
    }
}
