//! Converts shapes to scene objects.
//!
//! Source: *Mitsuba 3 documentation*, "Shapes".

use super::curve;
use super::plugin::{Key, Plugin, is_inside_out};
use super::serialized;
use super::state::Reader;
use super::tessellate;
use super::transform::frame;
use crate::files::mesh_file;
use crate::medium::Medium;
use crate::shared_report::NO_COUNTERPART;
use crate::shared_report::suggest;
use crate::smooth::smoothed;
use durer_diag::{Diagnostic, Span};
use durer_image::Transfer;
use durer_scene::math::Vec3;
use durer_scene::scene::{Group, Object, ObjectKind};
use durer_scene::shape::{Disc, MeshData, Sphere};
use glam::{DAffine3, DMat3, DVec3};
use std::rc::Rc;
use std::sync::Arc;

const SHAPES: [&str; 13] = [
    "sphere",
    "disk",
    "rectangle",
    "cube",
    "cylinder",
    "obj",
    "ply",
    "serialized",
    "shapegroup",
    "instance",
    "merge",
    "bsplinecurve",
    "linearcurve",
];

impl Reader<'_> {
    /// Converts a shape plugin to objects, and appends them to a list.
    pub fn shape(&mut self, plugin: &Rc<Plugin>, objects: &mut Vec<Object>, depth: u32) {
        if self.too_deep(depth, plugin.at) {
            return;
        }
        let (report, at) = (self.report, plugin.at);
        let to_world = plugin.transform(report, "to_world");
        let shape = match plugin.kind.as_str() {
            // Shape groups are visible only through instances.
            "shapegroup" => return,
            "instance" => self.instance(plugin, to_world, objects, depth),
            "merge" => {
                for (_, part) in self.child_plugins(plugin, Some("shape")) {
                    self.shape(&part, objects, depth + 1);
                }
                None
            }
            "sphere" => self.sphere(plugin, to_world),
            "disk" => self.disk(plugin, to_world),
            "rectangle" => {
                self.mesh(plugin, "rectangle", to_world, || Some(tessellate::with_tangents(tessellate::rectangle())))
            }
            "cube" => self.mesh(plugin, "cube", to_world, || Some(tessellate::with_tangents(tessellate::cube()))),
            "cylinder" => self.cylinder(plugin, to_world),
            "obj" | "ply" | "serialized" => self.file(plugin, to_world),
            "bsplinecurve" | "linearcurve" => self.curves(plugin, to_world),
            other => {
                let message = format!("the shape `{other}` has no counterpart: it is ignored");
                let warning = Diagnostic::warning(message).code(NO_COUNTERPART).at(at);
                return report.push(Diagnostic { help: suggest(other, SHAPES), ..warning });
            }
        };
        if let Some((node, to_world)) = shape {
            let inside = self.interior_medium(plugin);
            let area_emitter = self.child_plugins(plugin, Some("emitter")).into_iter().next();
            let area_emitter = area_emitter.and_then(|(_, emitter)| self.area_light(&emitter));
            self.inside_out = matches!(node, ObjectKind::Primitive(_)) && is_inside_out(plugin, report);
            self.hides_backs = plugin.kind.ends_with("curve");
            let material = self.child_plugins(plugin, Some("bsdf")).into_iter().next().map(|(_, bsdf)| bsdf);
            match self.material_index(material.as_ref(), area_emitter.as_ref(), inside, at) {
                Some(number) => {
                    let inner = Object { node, material: Some(number), span: at };
                    self.add(objects, inner.transformed(to_world));
                }
                None if area_emitter.is_some() => report.unsupported_once(at, "a `null` surface does not emit light"),
                None => {}
            }
        } else if !matches!(plugin.kind.as_str(), "instance" | "merge") {
            // The shape has already been reported, so do not report its materials as unused too.
            for class in ["bsdf", "emitter", "medium"] {
                self.child_plugins(plugin, Some(class));
            }
        }
        plugin.mark_known(&["flip_normals"]);
        plugin.warn_unused(report);
    }

    fn instance(
        &mut self,
        plugin: &Rc<Plugin>,
        to_world: DAffine3,
        objects: &mut Vec<Object>,
        depth: u32,
    ) -> Option<(ObjectKind, DAffine3)> {
        let groups = self.child_plugins(plugin, Some("shape"));
        let Some((property, group)) = groups.into_iter().find(|(_, group)| group.kind == "shapegroup") else {
            self.report.error(plugin.at, "an `instance` needs a `shapegroup`");
            return None;
        };
        let (group, count) = match self.groups.get(&group.key()) {
            Some(cached) => cached.clone(),
            None => {
                let (mut inner, before) = (Vec::new(), self.loader.limits.object_count());
                for (_, part) in self.child_plugins(&group, Some("shape")) {
                    self.shape(&part, &mut inner, depth + 1);
                }
                let entry = (Rc::new(Group { objects: inner }), self.loader.limits.object_count() - before);
                self.groups.insert(group.key(), entry.clone());
                entry
            }
        };
        // Count the instance itself as well, because its content may be empty.
        if self.count_objects(count + 1, property.at) {
            let inner = Object { node: ObjectKind::Group((*group).clone()), material: None, span: plugin.at };
            objects.push(inner.transformed(to_world));
        }
        None
    }

    /// Reads the medium that is inside a shape.
    fn interior_medium(&mut self, plugin: &Plugin) -> Option<(Medium, Key)> {
        let media = self.child_plugins(plugin, Some("medium"));
        // Ignore `exterior`, which is either the interior of another shape or the medium around the
        // camera.
        let (_, medium) = media.into_iter().find(|(property, _)| property.name == "interior")?;
        self.medium(&medium)
    }

    /// Returns true if the material or emitter of a shape uses a picture.
    fn has_picture(&self, plugin: &Plugin) -> bool {
        self.has_texture(plugin, &["bitmap", "checkerboard"])
    }

    /// Returns true if a shape has a texture of one of the given types.
    fn has_texture(&self, plugin: &Plugin, kinds: &[&str]) -> bool {
        let parts = self.reachable(plugin, &["texture", "bsdf", "emitter"]);
        parts.iter().any(|part| part.element == "texture" && kinds.contains(&part.kind.as_str()))
    }

    /// Returns true if the material of a shape is anisotropic. In that case, the direction of u
    /// matters.
    fn is_anisotropic(&self, plugin: &Plugin) -> bool {
        let words = ["alpha_u", "alpha_v", "anisotropic"];
        let parts = self.reachable(plugin, &["bsdf"]);
        parts.iter().flat_map(|part| &part.properties).any(|property| words.contains(&property.name.as_str()))
    }

    /// Returns true if a shape has a normal map.
    fn has_normal_map(&self, plugin: &Plugin) -> bool {
        self.reachable(plugin, &["bsdf"]).iter().any(|part| part.kind == "normalmap")
    }

    fn is_flipped(&self, plugin: &Plugin) -> bool {
        plugin.boolean(self.report, "flip_normals").unwrap_or(false)
    }

    /// Returns true if light can pass the surface of a shape.
    fn is_glass(&self, plugin: &Plugin) -> bool {
        let glass = |part: &Rc<Plugin>| part.kind.ends_with("dielectric") || part.kind.starts_with("principled");
        self.reachable(plugin, &["bsdf"]).iter().any(glass)
    }

    fn sphere(&mut self, plugin: &Plugin, to_world: DAffine3) -> Option<(ObjectKind, DAffine3)> {
        let radius = plugin.positive(self.report, "radius").unwrap_or(1.0);
        let center = plugin.vector(self.report, "center").unwrap_or(DVec3::ZERO);
        let to_world = to_world * DAffine3::from_translation(center);
        // An analytic sphere cannot face inwards.
        if is_inside_out(plugin, self.report)
            && (!self.is_glass(plugin) || !self.child_plugins(plugin, Some("emitter")).is_empty())
        {
            let flipped = self.is_flipped(plugin);
            return self.mesh(plugin, &format!("sphere-{radius}"), to_world, || {
                Some(tessellate::sphere(radius).oriented(!flipped))
            });
        }
        let (center, to_world) = match self.has_picture(plugin) || self.is_anisotropic(plugin) {
            // In Mitsuba, the poles are on the z axis, and u is 0 at +x. In Dürer the poles are on
            // the y axis, and u = 1/2 is at -z.
            true => {
                let turned = DMat3::from_cols(DVec3::NEG_Y, DVec3::Z, DVec3::X);
                (Vec3::ZERO, to_world * DAffine3::from_mat3(turned))
            }
            false if to_world.matrix3 == DMat3::IDENTITY => (to_world.translation.as_vec3(), DAffine3::IDENTITY),
            false => (Vec3::ZERO, to_world),
        };
        Some((ObjectKind::Primitive(Sphere { center, radius }.into()), to_world))
    }

    fn disk(&mut self, plugin: &Plugin, to_world: DAffine3) -> Option<(ObjectKind, DAffine3)> {
        // The texture coordinates of discs differ in Dürer.
        if self.has_picture(plugin) || self.is_anisotropic(plugin) || self.has_normal_map(plugin) {
            return self.mesh(plugin, "disk", to_world, || Some(tessellate::with_tangents(tessellate::disk())));
        }
        let normal = if self.is_flipped(plugin) { Vec3::NEG_Z } else { Vec3::Z };
        let disc = Disc { center: Vec3::ZERO, normal, radius: 1.0, inner_radius: 0.0 };
        Some((ObjectKind::Primitive(disc.into()), to_world))
    }

    fn cylinder(&mut self, plugin: &Plugin, to_world: DAffine3) -> Option<(ObjectKind, DAffine3)> {
        let report = self.report;
        let end = |name, default| plugin.vector(report, name).unwrap_or(default);
        let ends = [end("p0", DVec3::ZERO), end("p1", DVec3::Z)];
        let radius = plugin.positive(report, "radius").unwrap_or(1.0);
        let along = ends[1] - ends[0];
        if along == DVec3::ZERO {
            report.error(plugin.span("p1"), "`p0` and `p1` of a cylinder must differ");
            return None;
        }
        let axes = frame(along.normalize()) * DMat3::from_diagonal(DVec3::new(1.0, 1.0, along.length()));
        let to_world = to_world * DAffine3 { matrix3: axes, translation: ends[0] };
        self.mesh(plugin, &format!("cylinder-{radius}"), to_world, || {
            Some(tessellate::with_tangents(tessellate::cylinder(radius)))
        })
    }

    /// Returns the path of the file that a shape names, and the span of that name in the scene.
    fn path(&self, plugin: &Plugin) -> Option<(String, Span)> {
        let Some(name) = plugin.text(self.report, "filename") else {
            self.report.error(plugin.at, format!("the shape `{}` needs a `filename`", plugin.kind));
            return None;
        };
        Some((self.loader.path(&name), plugin.span("filename")))
    }

    /// Returns the index of the mesh that the shape uses within its file.
    fn shape_index(&self, plugin: &Plugin) -> Option<u32> {
        let number = plugin.number(self.report, "shape_index").unwrap_or(0.0);
        if !(0.0..=16_777_216.0).contains(&number) || number.fract() != 0.0 {
            self.report.error(plugin.span("shape_index"), "`shape_index` must be an integer of 0 or more");
            return None;
        }
        Some(number as u32)
    }

    fn file(&mut self, plugin: &Plugin, to_world: DAffine3) -> Option<(ObjectKind, DAffine3)> {
        let report = self.report;
        let (path, at) = self.path(plugin)?;
        let number = match plugin.kind.as_str() {
            "serialized" => Some(self.shape_index(plugin)?),
            _ => None,
        };
        let flat = plugin.boolean(report, "face_normals").unwrap_or(false);
        let is_obj = plugin.kind == "obj";
        // Mitsuba flips v in OBJ files, where v points up as it does in Dürer. Mitsuba does not
        // flip v in PLY files.
        let over = plugin.boolean(report, "flip_tex_coords").unwrap_or(is_obj);
        let mirrored = to_world.matrix3.determinant() < 0.0;
        let uneven = uneven(&to_world.matrix3);
        let input = self.input;
        let colored = self.has_texture(plugin, &["mesh_attribute"]);
        let leaning = !is_obj && self.has_normal_map(plugin);
        let turns = [
            (flat, "#flat"),
            (mirrored, "#mirrored"),
            (over != is_obj, "#turned"),
            (colored, "#colored"),
            (leaning, "#leaning"),
        ];
        let whole = number.map_or(path.clone(), |number| format!("{path}#{number}"));
        let whole = uneven.map_or(whole.clone(), |matrix| format!("{whole}#{:?}", matrix.to_cols_array()));
        let key = turns.iter().filter(|turn| turn.0).fold(whole, |key, turn| key + turn.1);
        self.mesh(plugin, &key, to_world, || {
            let mut data = match number {
                Some(number) => serialized::mesh(input, report, (&path, at), number)?,
                None => mesh_file(input, report, &path, at)?,
            };
            if flat {
                (data.normals, data.triangle_normals) = (Vec::new(), Vec::new());
            }
            // The orientation of faces without normals follows from the order of their corners in
            // world space.
            if mirrored && data.triangle_normals.is_empty() {
                data = data.oriented(true);
            }
            if !flat && data.triangle_normals.is_empty() {
                // Vertices at the same position are not merged if their texture coordinates differ.
                let uvs = std::mem::take(&mut data.triangle_uvs);
                let part = |i: usize, k: usize| Some(uvs.get(i).map_or(0, |uvs| uvs[k]));
                match uneven {
                    Some(matrix) => smoothed_in_world(&mut data, &matrix, part),
                    None => smoothed(&mut data, part),
                }
                data.triangle_uvs = uvs;
            }
            // Keep vertex colours only if a texture uses them. Convert the vertex colours of PLY
            // files to sRGB.
            let number = |x: f32| f32::from(Transfer::Srgb.encode(x)) / 255.0;
            data.colors
                .iter_mut()
                .for_each(|[r, g, b, a]| (*r, *g, *b, *a) = (number(*r), number(*g), number(*b), 1.0));
            if !colored {
                data.colors.clear();
            }
            data.flat = flat;
            if leaning && data.triangle_uvs.len() == data.triangles.len() {
                data = tessellate::with_tangents(data);
            }
            Some(if over { tessellate::with_flipped_v(data) } else { data })
        })
    }

    /// Builds tubes for the curves in a file. Mitsuba's `to_world` does not scale their radii.
    fn curves(&mut self, plugin: &Plugin, to_world: DAffine3) -> Option<(ObjectKind, DAffine3)> {
        let report = self.report;
        let (path, at) = self.path(plugin)?;
        let (input, is_spline) = (self.input, plugin.kind == "bsplinecurve");
        let mut key = if is_spline { path.clone() } else { format!("{path}#linear") };
        let is_rigid = (to_world.matrix3.transpose() * to_world.matrix3).abs_diff_eq(DMat3::IDENTITY, 1e-6)
            && to_world.matrix3.determinant() > 0.0;
        let (inner, outer) = if is_rigid { (DAffine3::IDENTITY, to_world) } else { (to_world, DAffine3::IDENTITY) };
        if !is_rigid {
            key += &format!("#{:?}", inner.to_cols_array());
        }
        self.mesh(plugin, &key, outer, || curve::tubes(input, report, (&path, at), is_spline, inner))
    }

    /// Returns a mesh and its transform. As in Mitsuba, v = 0 is the upper edge of a picture.
    fn mesh(
        &mut self,
        plugin: &Plugin,
        name: &str,
        to_world: DAffine3,
        make: impl FnOnce() -> Option<MeshData>,
    ) -> Option<(ObjectKind, DAffine3)> {
        let flipped = self.is_flipped(plugin);
        let name = format!("{name}{}", if flipped { "#flipped" } else { "" });
        let data = match self.meshes.get(&name) {
            Some(cached) => cached.clone(),
            None => {
                let data = make().filter(|data| !data.triangles.is_empty()).map(|data| {
                    let flat = data.flat;
                    Arc::new(MeshData { flat, ..tessellate::with_flipped_v(data).oriented(flipped) })
                });
                self.meshes.insert(name.clone(), data.clone());
                data
            }
        };
        Some((self.scene.add_mesh(&name, data?, plugin.at), to_world))
    }
}

/// Returns the matrix if it does not scale equally in all directions. Angles between edges then
/// differ in the world, and so do normals that are weighted by angles.
fn uneven(matrix: &DMat3) -> Option<DMat3> {
    let square = matrix.transpose() * *matrix;
    let scale = square.x_axis.x;
    (!square.abs_diff_eq(DMat3::from_diagonal(DVec3::splat(scale)), 1e-6 * scale)).then_some(*matrix)
}

/// Version of [`smoothed`] that computes the normals in the world, to which a matrix leads.
fn smoothed_in_world(data: &mut MeshData, matrix: &DMat3, part: impl Fn(usize, usize) -> Option<u32>) {
    let (own, before) = (data.positions.clone(), data.normals.len());
    data.positions.iter_mut().for_each(|p| *p = (*matrix * p.as_dvec3()).as_vec3());
    smoothed(data, part);
    // The inverse transpose leads from normals of the object to normals in the world. The faces of
    // mirrored meshes were turned around before.
    let back = matrix.determinant().signum() * matrix.transpose();
    for n in &mut data.normals[before..] {
        *n = (back * n.as_dvec3()).normalize_or(n.as_dvec3()).as_vec3();
    }
    data.positions = own;
}
