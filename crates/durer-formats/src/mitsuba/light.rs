//! Converts point lights, distant lights, infinite lights and area lights. The values of these
//! lights are radiances.
//!
//! Source: *Mitsuba 3 documentation*, "Emitters".

use super::defs::{AreaEmitter, InfiniteLight};
use super::plugin::Plugin;
use super::state::Reader;
use super::texture::Texture;
use crate::panorama::{self, bilinear};
use crate::pictures::picture_error;
use crate::profile_lights::{Axes, ProfileLight, steps};
use crate::shared_report::NO_COUNTERPART;
use crate::shared_report::suggest;
use durer_diag::Diagnostic;
use durer_image::{self as image, Image};
use durer_scene::describe::FileName;
use durer_scene::light::{DirectionalLight, Fade, Light, PointLight, SpotLight};
use durer_scene::math::{Color, Vec3, fp};
use durer_scene::scene::Spanned;
use glam::{DAffine3, DVec2, DVec3};
use std::f32::consts::PI;
use std::rc::Rc;

/// Height in pixels of the picture that represents a clear sky.
const SKY_ROWS: u32 = 512;

/// Number of vertical and of horizontal angular steps in the profile of a projected picture.
const STEPS: [u32; 2] = [360, 720];

/// Minimum height in pixels at which a picture is used without resampling. Mitsuba places the first
/// and last rows exactly at the poles. At this height or above, the difference is negligible.
pub(super) const FINE_ROWS: u32 = 256;

/// Maximum height in pixels of a resampled environment map.
const MAX_ROWS: u32 = 2048;

impl Reader<'_> {
    /// Returns the colour of a light.
    fn light_color(&self, plugin: &Plugin, name: &'static str) -> Color {
        let Some(property) = plugin.get(name) else { return Vec3::ONE };
        let color = self.emission(property).unwrap_or_else(|| self.color(plugin, name, Vec3::ONE));
        if color.min_element() < 0.0 {
            self.report.unsupported_once(property.at, "negative light has no counterpart: 0 is used");
        }
        color.max(Vec3::ZERO)
    }

    /// Reads a light that does not belong to a shape.
    pub fn emitter(&mut self, plugin: &Rc<Plugin>) {
        let report = self.report;
        let to_world = plugin.transform(report, "to_world");
        let place = |name| plugin.vector(report, name).unwrap_or(to_world.translation).as_vec3();
        let along = |local: DVec3| to_world.transform_vector3(local).normalize_or(DVec3::Z).as_vec3();
        // In Dürer, the colour of a light is the radiance of a white diffuse surface that it
        // illuminates, which is the illuminance divided by pi.
        let value: Light = match plugin.kind.as_str() {
            "point" => {
                let color = self.light_color(plugin, "intensity") / PI;
                PointLight { position: place("position"), color, attenuation: Some(Vec3::Z), ..PointLight::default() }
                    .into()
            }
            "spot" => match self.spot(plugin, to_world) {
                Some(spot) => spot.into(),
                None => return,
            },
            "projector" => return self.projector(plugin, to_world),
            "directional" => {
                let direction = plugin.vector(report, "direction");
                let direction = direction.map_or(along(DVec3::Z), |d| d.normalize_or_zero().as_vec3());
                if direction == Vec3::ZERO {
                    report.error(plugin.span("direction"), "a direction must not be 0 0 0");
                }
                let color = self.light_color(plugin, "irradiance") / PI;
                DirectionalLight { direction, color, ..DirectionalLight::default() }.into()
            }
            "constant" => {
                let color = self.light_color(plugin, "radiance");
                plugin.mark_known(&["sampling_weight"]);
                plugin.warn_unused(report);
                return self.set_infinite_light(InfiniteLight::Constant(color, plugin.at));
            }
            "envmap" => {
                let Some(name) = plugin.text(report, "filename") else {
                    return report.error(plugin.at, "an `envmap` needs a `filename`");
                };
                let (name, at) = (self.loader.path(&name), plugin.span("filename"));
                let scale = plugin.number(report, "scale").unwrap_or(1.0).max(0.0);
                plugin.mark_known(&["sampling_weight", "mis_compensation"]);
                plugin.warn_unused(report);
                return self.set_infinite_light(InfiniteLight::Picture { name, at, scale, to_world });
            }
            "sky" | "sun" | "sunsky" => return self.daylight(plugin, to_world),
            "area" => return report.error(plugin.at, "an `area` light must be inside a shape"),
            other => {
                let known = ["point", "spot", "projector", "directional", "constant", "envmap", "sunsky", "area"];
                let message = format!("the light `{other}` has no counterpart: it is ignored");
                let warning = Diagnostic::warning(message).code(NO_COUNTERPART).at(plugin.at);
                return report.push(Diagnostic { help: suggest(other, known), ..warning });
            }
        };
        plugin.mark_known(&["sampling_weight", "position"]);
        plugin.warn_unused(report);
        self.scene.lights.get_or_insert_default().push(Spanned { value, span: plugin.at });
    }

    /// Reads a spotlight. If the spotlight has a falloff or a picture, this function adds it as a
    /// measured light with that directional distribution and returns `None`.
    fn spot(&mut self, plugin: &Plugin, to_world: DAffine3) -> Option<SpotLight> {
        let report = self.report;
        let angle = plugin.positive(report, "cutoff_angle").unwrap_or(20.0);
        let inner_angle = plugin.number(report, "beam_width").unwrap_or(0.75 * angle).clamp(0.0, angle);
        if angle >= 180.0 {
            report.error(plugin.span("cutoff_angle"), "`cutoff_angle` must be less than 180 degrees");
            return None;
        }
        let intensity = self.light_color(plugin, "intensity");
        let image = self.named_plugin(plugin, "texture").and_then(|texture| self.projected_picture(&texture));
        if image.is_none() && inner_angle == angle {
            let direction = to_world.transform_vector3(DVec3::Z).normalize_or(DVec3::Z).as_vec3();
            let position = to_world.translation.as_vec3();
            let (color, fade) = (intensity / PI, Fade::Smooth);
            return Some(SpotLight { position, direction, color, angle, inner_angle, fade, ..SpotLight::default() });
        }
        plugin.mark_known(&["sampling_weight"]);
        plugin.warn_unused(report);
        // The intensity decreases linearly with the angle.
        let lookup = |dir: Vec3| {
            let degrees = fp::atan2(dir.truncate().length(), dir.z).to_degrees();
            ((angle - degrees) / (angle - inner_angle).max(1e-6)).clamp(0.0, 1.0)
        };
        let axes = Axes::about_z(&to_world);
        let lights = match image {
            None => {
                ProfileLight::new([vec![0.0, inner_angle, angle], vec![0.0]], &axes, |dir| Vec3::splat(lookup(dir)))
            }
            Some(image) => {
                // At distance 1, the picture covers a square as wide as the cone.
                let half = fp::tan_f64(f64::from(angle).to_radians()) as f32;
                ProfileLight::new([steps(angle, STEPS[0]), steps(360.0, STEPS[1])], &axes, |dir| {
                    let lookup = lookup(dir);
                    if lookup > 0.0 && dir.z > 0.0 {
                        lookup * bilinear(&image, 0.5 + 0.5 * dir.truncate() / (dir.z * half))
                    } else {
                        Vec3::ZERO
                    }
                })
            }
        };
        lights.add(&mut self.scene, self.input.name, (to_world, axes), intensity, plugin.at);
        None
    }

    /// Adds a projector as a measured light. The distribution of the light is that of its picture
    /// on the plane at distance 1.
    fn projector(&mut self, plugin: &Plugin, to_world: DAffine3) {
        let report = self.report;
        let image = self.named_plugin(plugin, "irradiance").and_then(|texture| self.projected_picture(&texture));
        let Some(image) = image else {
            return report.unsupported_once(plugin.at, "a projector without a picture is ignored");
        };
        let size = DVec2::new(f64::from(image.width), f64::from(image.height));
        let half = self.half_view(plugin, size).as_vec2();
        let scale = plugin.number(report, "scale").unwrap_or(1.0).max(0.0);
        plugin.mark_known(&["sampling_weight"]);
        plugin.warn_unused(report);
        let axes = Axes::about_z(&to_world);
        let widest = fp::atan2(half.length(), 1.0).to_degrees();
        let lights = ProfileLight::new([steps(widest, STEPS[0]), steps(360.0, STEPS[1])], &axes, |dir| {
            let place = dir.truncate() / (dir.z * half);
            if dir.z <= 0.0 || place.abs().max_element() > 1.0 {
                return Vec3::ZERO;
            }
            // Axes as seen by a camera: +x points left and +y points up.
            bilinear(&image, 0.5 - 0.5 * place) / (dir.z * dir.z * dir.z)
        });
        lights.add(&mut self.scene, self.input.name, (to_world, axes), Vec3::splat(PI * scale), plugin.at);
    }

    /// Returns the picture that a light projects.
    fn projected_picture(&self, texture: &Plugin) -> Option<Image> {
        if texture.kind != "bitmap" {
            self.report.unsupported_once(
                texture.at,
                "a projected texture other than `bitmap` has no counterpart: the texture is ignored",
            );
            return None;
        }
        let name = texture.text(self.report, "filename")?;
        let raw = texture.boolean(self.report, "raw").unwrap_or(false);
        texture.mark_known(&["filter_type", "wrap_mode"]);
        texture.warn_unused(self.report);
        let decode = if raw { image::decode_linear } else { image::decode_srgb };
        self.pictures().decoded(&self.loader.path(&name), texture.span("filename"), decode)
    }

    /// Sets the infinite light. Reports an error if the scene already has one.
    pub(super) fn set_infinite_light(&mut self, light: InfiniteLight) {
        if let Some(first) = &self.infinite {
            let error = Diagnostic::error("a scene may have only one infinite light").code("bad-value");
            return self.report.push(error.at(light.at()).related(first.at(), "the first one is here"));
        }
        self.scene.background_span = light.at();
        self.infinite = Some(light);
    }

    /// Reads the area light that belongs to a shape.
    pub fn area_light(&mut self, plugin: &Plugin) -> Option<AreaEmitter> {
        if plugin.kind != "area" {
            self.report.unsupported_once(
                plugin.at,
                format!("the light `{}` of a shape has no counterpart: it is ignored", plugin.kind),
            );
            return None;
        }
        let even = plugin.get("radiance").is_none_or(|property| self.emission(property).is_some());
        let (color, picture) = match even {
            true => (self.light_color(plugin, "radiance"), None),
            false => match self.bright_texture(plugin, "radiance", Vec3::ONE) {
                Texture::Constant(color) => (color, None),
                Texture::Picture(picture, scale, raw) => {
                    let picture = self.srgb_encoded(picture, raw, plugin.span("radiance"));
                    (scale, Some(picture))
                }
            },
        };
        plugin.mark_known(&["sampling_weight"]);
        plugin.warn_unused(self.report);
        if color == Vec3::ZERO {
            self.report.push(Diagnostic::note("this light is black").code("black-light").at(plugin.at));
        }
        Some(AreaEmitter { color, picture, at: plugin.at, key: plugin.key() })
    }

    /// Converts the infinite light to the environment of the scene.
    pub fn set_environment(&mut self) {
        let background = &mut self.scene.background;
        (background.color, background.ambient_light) = (Vec3::ZERO, Vec3::ZERO);
        match self.infinite.take() {
            None => {}
            Some(InfiniteLight::Constant(color, _)) => background.color = color,
            Some(InfiniteLight::Sky { sky, at, scale, to_world }) => {
                let to_sky = to_world.inverse();
                let light = |dir: DVec3| {
                    let dir = to_sky.transform_vector3(dir).normalize_or(DVec3::Y).as_vec3();
                    // The sky is black below the horizon.
                    if dir.y < 0.0 { Vec3::ZERO } else { scale * sky.at(dir) }
                };
                let name = format!("{}#sky", self.input.name);
                if let Err(error) =
                    panorama::set_environment(&mut self.scene, (&name, at), SKY_ROWS, self.input.memory, light)
                {
                    self.report.push(picture_error(&name, &error).at(at));
                }
            }
            Some(InfiniteLight::Picture { name, at, scale, to_world }) => {
                let Some(picture) = self.pictures().image(&name, at) else { return };
                let is_fine = picture.height >= FINE_ROWS;
                let y = to_world.matrix3.y_axis;
                let is_upright = y.x == 0.0 && y.z == 0.0 && y.y > 0.0;
                // Steps of the picture meet at its poles, where they are sharper than elsewhere. If
                // the poles move, more rows are needed.
                let finer = if is_upright { 1 } else { 4 };
                let rows = (finer * picture.height).clamp(finer * FINE_ROWS, MAX_ROWS);
                // The centre of an environment map is +z in Mitsuba and -z in Dürer.
                if is_fine && is_upright && to_world.matrix3.determinant() > 0.0 {
                    let z = to_world.matrix3.z_axis.as_vec3();
                    let degrees = 180.0 - fp::atan2(z.x, z.z).to_degrees();
                    let background = &mut self.scene.background;
                    background.environment = Some(FileName { path: name, span: at });
                    background.environment_rotation = (degrees != 0.0).then_some(degrees);
                    background.environment_scale = (scale != 1.0).then_some(Vec3::splat(scale));
                    return;
                }
                let to_light = to_world.inverse();
                let light = |dir: DVec3| {
                    let DVec3 { x, y, z } = to_light.transform_vector3(dir).normalize_or(DVec3::Y);
                    scale * panorama::bilinear_between_poles(&picture, DVec3::new(-x, y, -z))
                };
                let memory = panorama::remaining_memory([&picture], self.input.memory);
                if let Err(error) = panorama::set_environment(&mut self.scene, (&name, at), rows, memory, light) {
                    self.report.push(picture_error(&name, &error).at(at));
                }
            }
        }
    }
}
