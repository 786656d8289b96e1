//! Lights of the common profile. A white diffuse surface that faces a light of colour 1 is white.

use super::document::Element;
use super::reader::Reader;
use durer_scene::light::{DirectionalLight, Light, PointLight, SpotLight};
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::{Background, Spanned, extent};
use glam::{DAffine3, DVec3};
use std::f32::consts::PI;

impl<'r> Reader<'r> {
    /// Adds a light.
    pub fn light(&mut self, light: &'r Element<'r>, to_world: DAffine3) {
        let common = light.child("technique_common");
        let kind = common.and_then(|common| {
            let kinds = ["ambient", "directional", "point", "spot"];
            common.children.iter().find(|child| kinds.contains(&child.name))
        });
        let Some(kind) = kind else {
            return self.report.unsupported_once(light.at, "a light without the common profile is left out");
        };
        let color = kind.child("color").and_then(|color| self.color(color)).unwrap_or(Vec3::ONE);
        if color == Vec3::ZERO {
            return;
        }
        // Since version 2.8, Blender writes watts, and for suns watts per square metre.
        let is_in_watts = self.blender.is_some_and(|version| version >= 2.8);
        let scale = f64::from(fp::pow(to_world.matrix3.determinant().abs() as f32, 1.0 / 3.0));
        let number = |name: &str, default: f64| self.number(kind, name).map_or(default, |number| number.max(0.0));
        let mut attenuation = [
            number("constant_attenuation", 1.0),
            number("linear_attenuation", 0.0),
            number("quadratic_attenuation", 0.0),
        ];
        if attenuation == [0.0; 3] {
            attenuation = [1.0, 0.0, 0.0];
        }
        let mut power = 1.0;
        if is_in_watts {
            power = if kind.name == "directional" { 1.0 / PI } else { 0.25 / (PI * PI) };
            attenuation = [0.0, 0.0, scale * scale];
        }
        // Distances are in metres, and the coefficients are for the unit of the file.
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let attenuation = [attenuation[0], attenuation[1] / scale, attenuation[2] / (scale * scale)];
        let color = color * power;
        let direction = to_world.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z).as_vec3();
        let position = to_world.translation.as_vec3();
        let value: Light = match kind.name {
            "ambient" => {
                let background = &mut self.scene.background;
                if !self.scene.background_span.has_position() {
                    *background = Background { color: Vec3::ZERO, ..Background::default() };
                    self.scene.background_span = light.at;
                }
                background.color += color;
                self.scene.is_lit = true;
                return;
            }
            "directional" => DirectionalLight { direction, color, ..DirectionalLight::default() }.into(),
            "point" => {
                let attenuation = Some(DVec3::from_array(attenuation).as_vec3());
                PointLight { position, color, attenuation, ..PointLight::default() }.into()
            }
            _ => {
                // Programs write the angle between the edges of the cone.
                let angle = (0.5 * number("falloff_angle", 180.0)).clamp(1e-3, 180.0);
                let exponent = number("falloff_exponent", 0.0).min(1e4);
                let inner_angle = match is_in_watts {
                    // Blender writes the soft share of the cone.
                    true => angle * (1.0 - exponent.min(1.0)),
                    false => inner_angle(angle, exponent),
                };
                let lights = self.scene.lights.as_ref().map_or(0, Vec::len);
                self.spots.push((lights, attenuation, light.at));
                let (angle, inner_angle) = (angle as f32, inner_angle as f32);
                SpotLight { position, direction, color, angle, inner_angle, ..SpotLight::default() }.into()
            }
        };
        self.scene.lights.get_or_insert_default().push(Spanned { value, span: light.at });
    }

    /// Gives spotlights the strength at the centre of the scene that their attenuation states,
    /// since Dürer's spotlights fall off with the squared distance.
    pub fn set_attenuation_of_spots(&mut self) {
        if self.spots.is_empty() {
            return;
        }
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        extent::points(&self.scene, &mut |p| (min, max) = (min.min(p), max.max(p)));
        let center = if min.x <= max.x { 0.5 * (min + max) } else { DVec3::ZERO };
        for (number, [constant, linear, quadratic], at) in std::mem::take(&mut self.spots) {
            let light = self.scene.lights.as_mut().and_then(|lights| lights.get_mut(number));
            let Some(Light::Spot(spot)) = light.map(|light| &mut light.value) else { continue };
            let distance = (spot.position.as_dvec3() - center).length();
            let factor = match constant == 0.0 && linear == 0.0 {
                true => 1.0 / quadratic,
                false => distance * distance / (constant + linear * distance + quadratic * distance * distance),
            };
            spot.color *= factor as f32;
            if constant != 0.0 || linear != 0.0 {
                let message = "spotlights fall off with the squared distance: at the centre of the scene, they have the \
                               strength that the file states";
                self.report.unsupported_once(at, message);
            }
        }
    }
}

/// Returns the angle at which the fade of a spotlight begins, so that it has the flux of a cone in
/// which the intensity falls off with a power of the cosine. Angles are in degrees.
fn inner_angle(angle: f64, exponent: f64) -> f64 {
    if exponent == 0.0 {
        return angle;
    }
    let outer = fp::sin_cos_degrees(angle).1.max(0.0);
    let flux = (1.0 - f64::from(fp::pow(outer as f32, exponent as f32 + 1.0))) / (exponent + 1.0);
    let inner = (0.5 * (3.0 * (1.0 - flux) - outer)).clamp(outer, 1.0);
    fp::atan2_f64((1.0 - inner * inner).sqrt(), inner).to_degrees()
}
