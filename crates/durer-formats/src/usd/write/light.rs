//! Writes lights without extent, light surfaces, and light from all around.

use super::prim::{Prim, tuple};
use super::{PROGRAM, Writer};
use crate::export::light::{Around, PunctualLight};
use crate::export::shape::Placed;
use durer_image as image;
use durer_scene::light::Fade;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Walls;
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::{Background, Material};
use glam::{DAffine3, DMat3, DVec3};

/// Radius of the spheres that stand for lights without extent.
const RADIUS: f32 = 0.001;
/// Largest number of rows of the picture of an environment that is computed.
const MAX_ROWS: u32 = 1024;

/// Returns the lines of the colour and the intensity of a light, of which one is at most 1.
fn strength(light: Color) -> [String; 2] {
    let most = light.max_element().max(1e-12);
    [format!("color3f inputs:color = {}", tuple((light / most).to_array())), format!("float inputs:intensity = {most}")]
}

/// Returns a transform that turns -z to a direction.
fn facing(direction: Vec3, position: Vec3) -> DAffine3 {
    let z = -direction.as_dvec3().normalize_or(DVec3::NEG_Y);
    let (x, y) = z.any_orthonormal_pair();
    let x = if x.cross(y).dot(z) < 0.0 { -x } else { x };
    DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: position.as_dvec3() }
}

impl Writer<'_> {
    pub(super) fn lights(&mut self) -> Vec<Prim> {
        let lights = self.export.punctual_lights(PROGRAM);
        let mut prims: Vec<Prim> =
            lights.into_iter().enumerate().map(|(i, light)| self.punctual_light(i, light)).collect();
        self.has_light |= !prims.is_empty();
        let scene = self.export.scene;
        let is_set = scene.background != Background::default() || scene.background_span.has_position();
        if scene.up.is_some() && !is_set {
            // A model states nothing about its surroundings.
            return prims;
        }
        let around = self.export.around(PROGRAM);
        match around.and_then(|around| self.around(around)) {
            Some(dome) => prims.push(dome),
            // Without a light, other programs and Dürer would add one.
            None if !self.has_light => {
                let black = Prim::new("DomeLight", "Sky").lines(strength(Vec3::ZERO));
                prims.push(black);
            }
            None => {}
        }
        prims
    }

    fn punctual_light(&mut self, number: usize, light: PunctualLight) -> Prim {
        let name = format!("Light_{number}");
        // Seen from far away, a sphere with `normalize` has a quarter of its intensity.
        let point = |name: String, intensity: Color| {
            let light = Prim::new("SphereLight", name).lines(strength(4.0 * intensity));
            light
                .line("bool inputs:normalize = 1")
                .line(format!("float inputs:radius = {RADIUS}"))
                .line("bool treatAsPoint = 1")
        };
        match light {
            PunctualLight::Point { position, intensity } => {
                point(name, intensity).transform(&DAffine3::from_translation(position.as_dvec3()))
            }
            PunctualLight::Spot { position, direction, intensity, angle, inner_angle, fade } => {
                if fade != Fade::Squared && inner_angle < angle {
                    self.export.warn_lost("the edges of spotlights of USD fade in one way: they differ slightly");
                }
                point(name, intensity)
                    .meta("prepend apiSchemas = [\"ShapingAPI\"]")
                    .line(format!("float inputs:shaping:cone:angle = {angle}"))
                    .line(format!("float inputs:shaping:cone:softness = {}", 1.0 - inner_angle / angle))
                    .transform(&facing(direction, position))
            }
            PunctualLight::Distant { direction, irradiance, spread } => Prim::new("DistantLight", name)
                .lines(strength(irradiance))
                .line(format!("float inputs:angle = {}", 2.0 * spread))
                .line("bool inputs:normalize = 1")
                .transform(&facing(direction, Vec3::ZERO)),
        }
    }

    /// Returns a light in place of a shape that only emits light, if there is one of its form.
    pub(super) fn light_surface(&mut self, number: usize, shape: &Placed) -> Option<Prim> {
        let Material::Principled(m) = &self.export.scene.materials.get(shape.material? as usize)?.value else {
            return None;
        };
        let is_plain = m.emission_texture.is_none() && m.emission_vertex_colors == Default::default();
        if m.emission_luminance <= 0.0 || m.walls == Walls::Thin || !is_plain || !is_black(m) {
            return None;
        }
        let radiance = self.export.emitted(m);
        let name = format!("Light_Surface_{number}");
        let prim = if let Some((center, radius)) = shape.sphere() {
            Prim::new("SphereLight", name)
                .line(format!("float inputs:radius = {radius}"))
                .transform(&DAffine3::from_translation(center))
        } else if let Some((corner, [a, b])) = shape.rectangle() {
            // The light goes to -z.
            let (x, y) = (-a.normalize_or_zero(), b.normalize_or_zero());
            let map = DAffine3 { matrix3: DMat3::from_cols(x, y, x.cross(y)), translation: corner + 0.5 * (a + b) };
            Prim::new("RectLight", name)
                .line(format!("float inputs:width = {}", a.length()))
                .line(format!("float inputs:height = {}", b.length()))
                .transform(&map)
        } else {
            let (center, normal, radius) = shape.disc()?;
            Prim::new("DiskLight", name)
                .line(format!("float inputs:radius = {radius}"))
                .transform(&facing(normal.as_vec3(), center.as_vec3()))
        };
        self.has_light = true;
        Some(prim.lines(strength(radiance)))
    }

    fn around(&mut self, around: Around) -> Option<Prim> {
        let (environment, rows, file) = match around {
            Around::Even(color) => return Some(Prim::new("DomeLight", "Sky").lines(strength(color))),
            Around::Map { environment, rows, file } => (environment, rows, file),
        };
        let dome = |path: &str, scale: Vec3, degrees: f32| {
            let (sin, cos) = durer_scene::math::fp::sin_cos_degrees(f64::from(180.0 - degrees));
            let turn = DMat3::from_cols(DVec3::new(cos, 0.0, -sin), DVec3::Y, DVec3::new(sin, 0.0, cos));
            Prim::new("DomeLight", "Sky")
                .lines(strength(scale))
                .line(format!("asset inputs:texture:file = @{path}@"))
                .line("token inputs:texture:format = \"latlong\"")
                .transform(&DAffine3::from_mat3(turn))
        };
        if let Some((name, degrees, scale)) = file {
            let picture = self.export.picture(&name);
            let path = picture.bytes.path().to_string();
            let made = self.export.file(name.path.clone(), &path, &crate::extension(&path), |export| {
                export.picture_bytes(&picture.bytes).map(|bytes| bytes.to_vec())
            });
            return made.map(|path| dome(&path, scale, degrees));
        }
        let light = |dir: DVec3| environment.at(dir.as_vec3());
        let path = match image::format_for("a.exr") {
            Ok(format) => self.export.file("environment".into(), "environment", "exr", |_| {
                let rows = rows.min(MAX_ROWS);
                let pixels = crate::panorama::pixels(light, rows);
                let layer = image::Layer::color("", image::Image::from_pixels(2 * rows, rows, pixels).ok()?);
                let mut bytes = Vec::new();
                format.write(&[layer], &image::WriteOptions::default(), &mut bytes).ok()?;
                Some(bytes)
            }),
            Err(_) => self.export.panorama_file(rows.min(MAX_ROWS), light),
        };
        path.map(|path| dome(&path, Vec3::ONE, 0.0))
    }
}

/// True if a material reflects nothing.
fn is_black(m: &PrincipledMaterial) -> bool {
    let base = m.base_weight == 0.0 || m.base_color == Vec3::ZERO;
    base && m.specular_weight == 0.0
        && m.coat_weight == 0.0
        && m.fuzz_weight == 0.0
        && m.transmission_weight == 0.0
        && m.opacity == 1.0
        && m.opacity_texture.is_none()
}
