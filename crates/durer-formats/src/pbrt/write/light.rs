//! Writes lights without extent, and light from all around.

use super::text::Directive;
use super::{PROGRAM, Writer};
use crate::export::light::{Around, PunctualLight};
use crate::export::picture::as_pfm;
use crate::pbrt::environment::equal_area_direction;
use durer_image::Image;
use durer_scene::light::Fade;
use durer_scene::math::{Color, Vec2, fp};
use durer_scene::texture::Environment;

/// Number of samples along each side of a texel.
const SAMPLES: u32 = 3;
/// Largest width of an environment map.
const MAX_SIDE: u32 = 1024;

impl Writer<'_> {
    pub(super) fn lights(&mut self) -> String {
        let lights = self.export.punctual_lights(PROGRAM);
        let mut text: String = lights.into_iter().map(|light| self.punctual_light(light)).collect();
        let infinite = match self.export.around(PROGRAM) {
            Some(Around::Even(color)) => Some(Directive::new("LightSource", "infinite").rgb("L", color)),
            Some(Around::Map { environment, rows, .. }) => {
                // A map of this size has about as many texels as the picture.
                let side = (3 * rows / 2).clamp(64, MAX_SIDE);
                let path = self.export.file("environment".into(), "environment", "pfm", |_| {
                    as_pfm(Image::from_pixels(side, side, pixels(&environment, side)).ok()?)
                });
                path.map(|path| Directive::new("LightSource", "infinite").string("filename", &path))
            }
            None => None,
        };
        text += &infinite.map_or(String::new(), Directive::line);
        text
    }

    fn punctual_light(&mut self, light: PunctualLight) -> String {
        let source = |kind: &str| Directive::new("LightSource", kind);
        match light {
            PunctualLight::Point { position, intensity } => {
                source("point").rgb("I", intensity).point("from", position).line()
            }
            PunctualLight::Distant { direction, irradiance, .. } => {
                source("distant").rgb("L", irradiance).point("from", -direction).point("to", Default::default()).line()
            }
            PunctualLight::Spot { position, direction, intensity, angle, inner_angle, fade } => {
                let cosine = |degrees: f32| fp::sin_cos_degrees(f64::from(degrees)).1 as f32;
                let [outer, inner] = [angle, inner_angle].map(cosine);
                // Choose the inner cone so that the flux stays the same. Over the fade, the mean of
                // pbrt's s^2 (3 - 2 s) is 1/2.
                let mean = match fade {
                    Fade::Squared => 1.0 / 3.0,
                    Fade::Smooth => 0.5,
                    Fade::Fourth => 0.2,
                };
                let fitted = inner + (1.0 - 2.0 * mean) * (inner - outer);
                if fade != Fade::Smooth && inner != outer {
                    self.export.warn_lost("spot lights of pbrt fade in another way: the width of the beam is fitted");
                }
                let inner_angle = match fade {
                    Fade::Smooth => inner_angle,
                    _ if fitted >= 1.0 => 0.0,
                    _ => fp::atan2((1.0 - fitted * fitted).max(0.0).sqrt(), fitted).to_degrees(),
                };
                let cone = source("spot").rgb("I", intensity).point("from", position).point("to", position + direction);
                cone.float("coneangle", angle).float("conedeltaangle", angle - inner_angle).line()
            }
        }
    }

    /// Returns the directive for the light that the following shape emits.
    pub(super) fn area(&mut self, emission: &crate::export::surface::Emission) -> String {
        let mut area = Directive::new("AreaLightSource", "diffuse");
        let most = emission.radiance.max_element().max(1e-12);
        let file = emission.picture.as_ref().and_then(|picture| {
            if picture.mapping != Default::default() {
                self.export.warn_lost("pictures of lights of pbrt cover the whole shape: their mapping is left out");
            }
            self.export.color_file(picture, false, "light", |p| p * emission.radiance / most)
        });
        area = match file {
            Some(file) => area.string("filename", &file.path).float("scale", most),
            None => area.rgb("L", emission.radiance),
        };
        (if emission.is_two_sided { area.boolean("twosided", true) } else { area }).line()
    }
}

/// Returns the texels of an equal-area map of the light from all around.
fn pixels(environment: &Environment, side: u32) -> Vec<Color> {
    let texel = |i: u32| {
        let corner = Vec2::new((i % side) as f32, (i / side) as f32);
        let light = |place: u32| {
            let offset = Vec2::new((place % SAMPLES) as f32 + 0.5, (place / SAMPLES) as f32 + 0.5) / SAMPLES as f32;
            environment.at(equal_area_direction((corner + offset) / side as f32))
        };
        (0..SAMPLES * SAMPLES).map(light).sum::<Color>() / (SAMPLES * SAMPLES) as f32
    };
    (0..side * side).map(texel).collect()
}
