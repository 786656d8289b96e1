//! Lights: of surfaces, at points, far away. Their units are those of radiance.
//!
//! Source of all meanings: *Mitsuba 3 documentation*, "Emitters".

use super::made::{Infinite, Shine};
use super::plugin::Plugin;
use super::state::Reader;
use super::texture::Texture;
use crate::describe::FileName;
use crate::diag::Diagnostic;
use crate::format::panorama;
use crate::format::pictures::unusable;
use crate::format::said::meant;
use crate::light::{DirectionalLight, Fade, Light, PointLight, SpotLight};
use crate::math::{Color, Vec3, fp};
use crate::scene::Spanned;
use glam::DVec3;
use std::f32::consts::PI;
use std::rc::Rc;

/// Rows of a picture of all directions that is turned.
const MAX_ROWS: u32 = 2048;

impl Reader<'_> {
    /// The colour of a light.
    fn strength(&self, plugin: &Plugin, name: &'static str) -> Color {
        let Some(property) = plugin.get(name) else { return Vec3::ONE };
        let color = self.shining(property).unwrap_or_else(|| self.color(plugin, name, Vec3::ONE));
        if color.min_element() < 0.0 {
            self.said.once(property.at, "light that is less than 0 has no counterpart: it is taken for 0");
        }
        color.max(Vec3::ZERO)
    }

    /// A light that is no surface.
    pub fn emitter(&mut self, plugin: &Rc<Plugin>) {
        let said = self.said;
        let to_world = plugin.map(said, "to_world");
        let place = |name| plugin.vector(said, name).unwrap_or(to_world.translation).as_vec3();
        let along = |local: DVec3| to_world.transform_vector3(local).normalize_or(DVec3::Z).as_vec3();
        // A light's colour is what a white matte surface shows: illuminance over pi.
        let value: Light = match plugin.kind.as_str() {
            "point" => {
                let color = self.strength(plugin, "intensity") / PI;
                PointLight { position: place("position"), color, attenuation: Some(Vec3::Z), ..PointLight::default() }
                    .into()
            }
            "spot" => {
                let angle = plugin.positive(said, "cutoff_angle").unwrap_or(20.0);
                let inner_angle = plugin.number(said, "beam_width").unwrap_or(0.75 * angle).clamp(0.0, angle);
                if inner_angle < angle {
                    said.once(plugin.at, "a spot fades by the cosine here, and not by the angle, towards its border");
                }
                if angle >= 180.0 {
                    said.bad(plugin.place("cutoff_angle"), "`cutoff_angle` must be less than 180 degrees");
                }
                if plugin.get("texture").is_some() {
                    said.once(plugin.place("texture"), "a picture in a spot has no counterpart: it shines evenly");
                }
                let (color, direction) = (self.strength(plugin, "intensity") / PI, along(DVec3::Z));
                let position = place("");
                SpotLight { position, direction, color, angle, inner_angle, fade: Fade::Smooth, ..SpotLight::default() }
                    .into()
            }
            "projector" => {
                said.once(plugin.at, "a projector has no counterpart: it is left out");
                return;
            }
            "directional" => {
                let direction = plugin.vector(said, "direction");
                let direction = direction.map_or(along(DVec3::Z), |d| d.normalize_or_zero().as_vec3());
                if direction == Vec3::ZERO {
                    said.bad(plugin.place("direction"), "a direction must have a length");
                }
                let color = self.strength(plugin, "irradiance") / PI;
                DirectionalLight { direction, color, ..DirectionalLight::default() }.into()
            }
            "constant" => {
                let color = self.strength(plugin, "radiance");
                plugin.known(&["sampling_weight"]);
                plugin.finish(said);
                return self.far(Infinite::Even(color, plugin.at));
            }
            "envmap" => {
                let Some(name) = plugin.text(said, "filename") else {
                    return said.bad(plugin.at, "an `envmap` needs a `filename`");
                };
                let (name, at) = (self.loader.path(&name), plugin.place("filename"));
                let scale = plugin.number(said, "scale").unwrap_or(1.0).max(0.0);
                plugin.known(&["sampling_weight", "mis_compensation"]);
                plugin.finish(said);
                return self.far(Infinite::Picture { name, at, scale, to_world });
            }
            "area" => return said.bad(plugin.at, "an `area` light stands inside of a shape"),
            other => {
                let known = ["point", "spot", "directional", "constant", "envmap", "area"];
                let message = format!("the light `{other}` has no counterpart: it is left out");
                let warning = Diagnostic::warning(message).code("NO_COUNTERPART").at(plugin.at);
                return said.push(Diagnostic { help: meant(other, known), ..warning });
            }
        };
        plugin.known(&["sampling_weight", "position"]);
        plugin.finish(said);
        self.scene.lights.get_or_insert_default().push(Spanned { value, span: plugin.at });
    }

    fn far(&mut self, light: Infinite) {
        if let Some(first) = &self.infinite {
            let error = Diagnostic::error("a scene has one light that is infinitely far away").code("bad-value");
            return self.said.push(error.at(light.at()).related(first.at(), "the first is here"));
        }
        self.infinite = Some(light);
    }

    /// The light of a shape.
    pub fn area_light(&mut self, plugin: &Plugin) -> Option<Shine> {
        if plugin.kind != "area" {
            self.said
                .once(plugin.at, format!("the light `{}` of a shape has no counterpart: it is left out", plugin.kind));
            return None;
        }
        let even = plugin.get("radiance").is_none_or(|property| self.shining(property).is_some());
        let (color, picture) = match even {
            true => (self.strength(plugin, "radiance"), None),
            false => match self.bright_texture(plugin, "radiance", Vec3::ONE) {
                Texture::Even(color) => (color, None),
                Texture::Picture(picture, scale, raw) => {
                    let picture = self.without_curve(picture, raw, plugin.place("radiance"));
                    (scale, Some(picture))
                }
            },
        };
        plugin.known(&["sampling_weight"]);
        plugin.finish(self.said);
        if color == Vec3::ZERO {
            self.said.push(Diagnostic::note("this light is black").code("black-light").at(plugin.at));
        }
        Some(Shine { color, picture, both: false, at: plugin.at, key: plugin.key() })
    }

    /// Puts what is infinitely far away behind the scene.
    pub fn surround(&mut self) {
        let background = &mut self.scene.background;
        (background.color, background.ambient_light) = (Vec3::ZERO, Vec3::ZERO);
        match self.infinite.take() {
            None => {}
            Some(Infinite::Even(color, _)) => background.color = color,
            Some(Infinite::Picture { name, at, scale, to_world }) => {
                let Some(picture) = self.pictures().image(&name, at) else { return };
                let rows = picture.height.min(MAX_ROWS);
                let y = to_world.matrix3.y_axis;
                // The middle of Mitsuba's pictures is where its z points, and of ours where -z
                // does.
                if y.x == 0.0 && y.z == 0.0 && y.y > 0.0 && to_world.matrix3.determinant() > 0.0 {
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
                    scale * panorama::looked_up(&picture, DVec3::new(-x, y, -z))
                };
                let memory = panorama::beside([&picture], self.input.memory);
                if let Err(error) = panorama::surround(&mut self.scene, (&name, at), rows, memory, light) {
                    self.said.push(unusable(&name, &error).at(at));
                }
            }
        }
    }
}
