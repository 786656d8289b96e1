//! Converts shapes together with their area lights.

use super::defs::{AreaLight, Opacity};
use super::language::Language;
use super::params::{Kind, Param, Params};
use super::state::{Reader, SHAPE};
use super::{curve, mesh, quadrics, surfaces};
use crate::files::mesh_file;
use crate::shared_report::suggest;
use durer_diag::Span;
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::{Object, ObjectKind};
use durer_scene::shape::{Disc, MeshData, Sphere};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::BTreeSet;
use std::f32::consts::PI;
use std::rc::Rc;
use std::sync::Arc;

/// Maximum total number of triangles of all tessellated shapes, and the number of triangles above
/// which curves get fewer sides. Tests use a low maximum so that they can reach it quickly.
const MAX_TRIANGLES: usize = if cfg!(test) { 1 << 18 } else { 1 << 24 };
const MANY: usize = 1 << 20;

/// Geometry of a pbrt shape, before it gets a material and is added to the scene.
struct ShapeDef {
    node: ObjectKind,
    /// Total area in world space, and the number of area lights that the shape counts as.
    area: f32,
    lights: usize,
    /// Transform from object space to world space.
    to_world: DAffine3,
    /// True if the normals point inwards in pbrt, but outwards in Dürer.
    inside_out: bool,
}

impl Reader<'_> {
    /// Executes a `Shape` directive, which adds the shape to the scene with the current material
    /// and area light.
    pub fn shape(&mut self, kind: &str, at: Span, list: Vec<Rc<Param>>) {
        if let Some(light) = &self.state.area_light {
            self.used_lights.insert((light.at.file, light.at.start));
        }
        self.state.shapes += 1;
        self.used_materials.extend(self.state.material_at.map(|at| (at.file, at.start)));
        let params = self.params(list, Some(SHAPE), at);
        let opacity = self.opacity(&params);
        let to_world = self.map(at);
        // The orientation of a quadric is defined in object space, and that of a triangle in world
        // space.
        let flipped = self.state.reversed != (to_world.matrix3.determinant() < 0.0);
        let third = self.language == Language::V3;
        let shape = match kind {
            "sphere" => self.sphere(&params, to_world, flipped),
            "disk" => self.disk(&params, to_world, flipped),
            "cylinder" => {
                let data = mesh::cylinder(&params, flipped);
                data.and_then(|data| self.tessellated(data, to_world, at))
            }
            "trianglemesh" => {
                let data = mesh::triangles(&params, self.state.reversed);
                data.and_then(|data| self.mesh(None, Arc::new(data), to_world, at))
            }
            "bilinearmesh" => {
                let data = mesh::bilinear(&params, self.state.reversed);
                data.and_then(|data| self.tessellated(data, to_world, at))
            }
            "loopsubdiv" => {
                let data = mesh::subdivided(&params, self.state.reversed, MAX_TRIANGLES - self.tessellated_triangles);
                data.and_then(|data| self.tessellated(data, to_world, at))
            }
            "plymesh" => self.ply(&params, to_world, at),
            "curve" => {
                let data = curve::mesh(&params, self.state.reversed, self.tessellated_triangles > MANY);
                data.and_then(|data| self.tessellated(data, to_world, at))
            }
            "cone" | "paraboloid" | "hyperboloid" | "heightfield" | "nurbs" if third => {
                let data = match kind {
                    "cone" => Some(quadrics::cone(&params, flipped)),
                    "paraboloid" => quadrics::paraboloid(&params, flipped),
                    "hyperboloid" => quadrics::hyperboloid(&params, flipped),
                    "heightfield" => surfaces::heights(&params, self.state.reversed),
                    _ => surfaces::nurbs(&params, self.state.reversed),
                };
                data.and_then(|data| self.tessellated(data, to_world, at))
            }
            other => {
                let mut cached = vec![
                    "sphere",
                    "disk",
                    "cylinder",
                    "trianglemesh",
                    "plymesh",
                    "bilinearmesh",
                    "loopsubdiv",
                    "curve",
                ];
                if third {
                    cached.extend(["cone", "hyperboloid", "paraboloid", "heightfield", "nurbs"]);
                }
                let mut help = suggest(other, cached);
                if ["cone", "hyperboloid", "paraboloid", "heightfield", "nurbs"].contains(&other) {
                    help = Some(format!("`{other}` is a shape of pbrt-v3, not of pbrt-v4"));
                }
                return self.report.error_with_help(at, format!("unknown shape `{other}`"), help);
            }
        };
        // A mesh is one area light for each triangle, and a bilinear mesh for each patch.
        let shape = shape.map(|shape| match kind {
            "trianglemesh" | "plymesh" | "loopsubdiv" | "curve" => shape,
            "bilinearmesh" => ShapeDef { lights: mesh::patch_count(&params), ..shape },
            _ => ShapeDef { lights: 1, ..shape },
        });
        params.mark_known(&["alpha"]);
        if third {
            params.warn_unsupported(&["shadowalpha"], "shadows use `alpha`");
        }
        params.warn_unused(&format!("the shape `{kind}`"));
        if let Some(shape) = shape {
            self.add_shape(shape, &opacity, at);
        }
    }

    /// Adds a shape to the scene, with its material and its light.
    fn add_shape(&mut self, shape: ShapeDef, opacity: &Opacity, at: Span) {
        let light = self.state.area_light.clone();
        let light = light.filter(|light| {
            let inside = self.defining.is_some();
            if inside {
                self.report.unsupported_once(light.at, "instanced objects do not emit light, as in pbrt");
            }
            !inside
        });
        let material = self.material_with_medium();
        if let Some(light) = light.as_ref().filter(|light| !light.is_enclosed) {
            let (_, shapes, materials) =
                self.open_lights.entry((light.at.file, light.at.start)).or_insert((light.at, 0, BTreeSet::new()));
            *shapes += 1;
            materials.insert(material);
        }
        let mut light = light.map(|light| (light.clone(), radiance(&light, &shape)));
        if let Some((light, _)) = light.as_mut().filter(|_| shape.inside_out) {
            *light = Rc::new(AreaLight { two_sided: true, ..(**light).clone() });
        }
        let radiance = light.as_ref().map(|(light, radiance)| (&**light, *radiance));
        let Some(material) = self.material_index(material, radiance, opacity) else {
            if light.is_some() {
                self.report.unsupported_once(at, "an `interface` surface does not emit light");
            }
            return;
        };
        if self.limits.count_objects_or_report(1, self.report, at) {
            let inner = Object { node: shape.node, material: Some(material), span: at };
            self.add(inner.transformed(shape.to_world));
        }
    }

    fn opacity(&mut self, params: &Params) -> Opacity {
        let (share, picture) = self.number_or_texture(params, "alpha", 1.0, |share| share);
        Opacity { share, picture }
    }

    fn sphere(&mut self, params: &Params, to_world: DAffine3, flipped: bool) -> Option<ShapeDef> {
        let radius = params.positive("radius").unwrap_or(1.0);
        let ends = quadrics::z_range(params, [-radius, radius]);
        if quadrics::sweep_degrees(params) < 360.0 || ends[0] > -radius || ends[1] < radius {
            let data = quadrics::sphere(params, radius, ends, flipped)?;
            return self.tessellated(data, to_world, params.at);
        }
        if flipped && self.state.area_light.as_ref().is_some_and(|light| !light.two_sided) {
            self.report
                .unsupported_once(params.at, "a sphere that emits inwards has no counterpart: it emits on both sides");
        }
        let world = radius * to_world.transform_vector3(DVec3::X).length() as f32;
        let (center, to_world) = match to_world.matrix3 == DAffine3::IDENTITY.matrix3 {
            // In pbrt, the poles are on the z axis, and u is 0 at +x. In Dürer, the poles are on
            // the y axis and u = 1/2 is at -z.
            _ if self.is_pictured()
                || self.is_anisotropic()
                || params.get("alpha").is_some_and(|param| param.kind == Kind::Texture) =>
            {
                let turned = DMat3::from_cols(DVec3::NEG_Y, DVec3::Z, DVec3::X);
                (Vec3::ZERO, to_world * DAffine3::from_mat3(turned))
            }
            true => (to_world.translation.as_vec3(), DAffine3::IDENTITY),
            false => (Vec3::ZERO, to_world),
        };
        let node = ObjectKind::Primitive(Sphere { center, radius }.into());
        Some(ShapeDef { node, area: 4.0 * PI * world * world, lights: 1, to_world, inside_out: flipped })
    }

    fn disk(&mut self, params: &Params, to_world: DAffine3, flipped: bool) -> Option<ShapeDef> {
        let radius = params.positive("radius").unwrap_or(1.0);
        let inner_radius = params.float("innerradius").unwrap_or(0.0).max(0.0);
        let height = params.float("height").unwrap_or(0.0);
        if inner_radius >= radius {
            self.report.error(params.span("innerradius"), "`innerradius` must be less than `radius`");
            return None;
        }
        if quadrics::sweep_degrees(params) < 360.0 {
            let data = quadrics::disk(params, [inner_radius, radius], height, flipped);
            return self.tessellated(data, to_world, params.at);
        }
        let normal = if flipped { Vec3::NEG_Z } else { Vec3::Z };
        let stretch = to_world.transform_vector3(DVec3::X).cross(to_world.transform_vector3(DVec3::Y)).length() as f32;
        let area = PI * (radius * radius - inner_radius * inner_radius) * stretch;
        let node = ObjectKind::Primitive(Disc { center: height * Vec3::Z, normal, radius, inner_radius }.into());
        Some(ShapeDef { node, area, lights: 1, to_world, inside_out: false })
    }

    /// Tessellates a shape. All tessellated shapes together can have at most `MAX_TRIANGLES`
    /// triangles.
    fn tessellated(&mut self, data: MeshData, to_world: DAffine3, at: Span) -> Option<ShapeDef> {
        self.tessellated_triangles = self.tessellated_triangles.saturating_add(data.triangles.len());
        if self.tessellated_triangles > MAX_TRIANGLES {
            self.tessellated_triangles = MAX_TRIANGLES;
            let what = format!("tessellated shapes beyond {MAX_TRIANGLES} triangles are left out");
            self.report.unsupported_once(at, what);
            return None;
        }
        self.mesh(None, Arc::new(data), to_world, at)
    }

    /// Returns a mesh under a name that several shapes share, or under a new name.
    fn mesh(&mut self, name: Option<String>, data: Arc<MeshData>, to_world: DAffine3, at: Span) -> Option<ShapeDef> {
        if data.triangles.is_empty() {
            return None;
        }
        let corner = |i: u32| to_world.transform_point3(data.positions[i as usize].as_dvec3());
        let twice = |[a, b, c]: &[u32; 3]| (corner(*b) - corner(*a)).cross(corner(*c) - corner(*a)).length();
        // The area is needed only for a light whose power is given.
        let has_power = self.state.area_light.as_ref().is_some_and(|light| light.power.is_some());
        let area = if has_power { 0.5 * data.triangles.iter().map(twice).sum::<f64>() as f32 } else { 1.0 };
        let name = name.unwrap_or_else(|| format!("{}#{}", self.input.name, self.scene.assets.meshes.len()));
        let lights = data.triangles.len();
        let node = self.scene.add_mesh(&name, data, at);
        Some(ShapeDef { node, area, lights, to_world, inside_out: false })
    }

    fn ply(&mut self, params: &Params, to_world: DAffine3, at: Span) -> Option<ShapeDef> {
        params.warn_unsupported(&["displacement"], "the surface is not displaced");
        params.mark_known(&["edgelength"]);
        let Some(name) = params.text("filename").map(str::to_string) else {
            self.report.error(at, "a `plymesh` needs a `filename`");
            return None;
        };
        let reversed = self.state.reversed;
        let key = (name.clone(), reversed);
        let data = match self.meshes.get(&key) {
            Some(cached) => cached.clone(),
            None => {
                let place = params.get("filename").map_or(at, |param| param.values_at);
                let mut data = mesh_file(self.input, self.report, &name, place)?.oriented(reversed);
                // pbrt ignores the colours of vertices.
                data.colors.clear();
                let data = Arc::new(data);
                self.meshes.insert(key, data.clone());
                data
            }
        };
        let asset = if reversed { format!("{name}#reversed") } else { name };
        self.mesh(Some(asset), data, to_world, at)
    }
}

/// Returns the radiance of an area light. The power of an area light is divided equally among the
/// lights of its shape. A mesh has one light for each triangle.
fn radiance(light: &AreaLight, shape: &ShapeDef) -> Color {
    let Some(power) = light.power else { return light.radiance };
    let sides = if light.two_sided { 2.0 } else { 1.0 };
    let strength = power / (sides * PI * shape.area / shape.lights as f32);
    if strength.is_finite() { light.radiance * strength } else { Color::ZERO }
}
