//! Lights and surroundings in radiometric units, as other programs describe them.

use super::Export;
use super::picture::as_pfm;
use crate::medium::Medium;
use crate::panorama;
use durer_image::{self as image, Encoded};
use durer_scene::describe::FileName;
use durer_scene::light::{Fade, Illuminate as _, Light};
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::Background;
use durer_scene::spectrum::{Curve, illuminants};
use durer_scene::texture::Environment;
use durer_scene::texture::sky::SKY_WIDTH;
use std::f32::consts::PI;

/// Light without extent.
pub(crate) enum PunctualLight {
    /// Point light with a radiant intensity.
    Point { position: Vec3, intensity: Color },
    /// Light in a cone; the angles in degrees from the axis are those of the edge and of the
    /// beginning of the fade.
    Spot { position: Vec3, direction: Vec3, intensity: Color, angle: f32, inner_angle: f32, fade: Fade },
    /// Light from far away, with its irradiance on a surface that faces it, and the angle in
    /// degrees from the centre of its disc to the edge.
    Distant { direction: Vec3, irradiance: Color, spread: f32 },
}

/// Light from all around.
pub(crate) enum Around {
    Even(Color),
    Map {
        environment: Environment,
        /// Number of rows of the picture.
        rows: u32,
        /// File of the picture, its rotation about y in degrees and its factor, unless the picture
        /// is computed.
        file: Option<(FileName, f32, Vec3)>,
    },
}

impl Export<'_> {
    /// Returns the lights of the scene, including its sun. `program` is the name of the other
    /// program, for messages.
    pub fn punctual_lights(&mut self, program: &str) -> Vec<PunctualLight> {
        let lights = self.scene.lights.iter().flatten();
        let mut lights: Vec<PunctualLight> =
            lights.filter_map(|light| self.punctual_light(&light.value, program)).collect();
        if let Some((direction, irradiance)) = self.scene.background.sunlight() {
            self.warn_extent(program);
            let direction = direction.normalize_or(Vec3::NEG_Y);
            lights.push(PunctualLight::Distant { direction, irradiance, spread: 0.0 });
        }
        lights
    }

    /// Returns the spectrum of a light at luminance 1: an illuminant or a file.
    pub(super) fn light_spectrum(&self, name: &FileName) -> Option<Curve> {
        illuminants::illuminant(&name.path).or_else(|| Curve::light(self.spectrum(name)?))
    }

    fn warn_extent(&mut self, program: &str) {
        self.warn_lost(format!("distant lights of {program} have no angular size: shadows are sharp"));
    }

    fn punctual_light(&mut self, light: &Light, program: &str) -> Option<PunctualLight> {
        let mut light = light.with_unit_color();
        if let Some(name) = light.spectrum().cloned() {
            match self.light_spectrum(&name) {
                Some(curve) => *light.color_mut() *= curve.color(),
                None => self.warn_lost(format!("the spectrum `{}` cannot be read: it is left out", name.path)),
            }
        }
        // The colour of a light is the radiance of a white matte surface, which is the illuminance
        // divided by pi.
        match &light {
            Light::Point(point) => {
                let a = point.attenuation.or(point.falloff.map(|f| Vec3::new(1.0, 0.0, f))).unwrap_or(Vec3::X);
                let intensity = if a.x == 0.0 && a.y == 0.0 && a.z > 0.0 {
                    point.color / a.z
                } else {
                    self.warn_lost(format!(
                        "point lights of {program} fall off with the squared distance: their light is equal at the \
                         scene's centre"
                    ));
                    let d = (point.position - self.center()).length().max(1e-3);
                    point.color * (d * d / (a.x + a.y * d + a.z * d * d).max(1e-6))
                };
                Some(PunctualLight::Point { position: point.position, intensity: PI * intensity })
            }
            Light::Directional(far) => {
                let spread = far.spread.unwrap_or(0.0);
                if spread > 0.0 && !self.has_sun_size {
                    self.warn_extent(program);
                }
                let direction = far.direction.normalize_or(Vec3::NEG_Y);
                Some(PunctualLight::Distant { direction, irradiance: PI * far.color, spread })
            }
            Light::Spot(spot) => Some(PunctualLight::Spot {
                position: spot.position,
                direction: spot.direction.normalize_or(Vec3::NEG_Y),
                intensity: PI * spot.color,
                angle: spot.angle,
                inner_angle: spot.inner_angle.min(spot.angle),
                fade: spot.fade,
            }),
            Light::Photometric(_) => {
                self.warn_lost(format!("measured lights are not written to {program}: they are left out"));
                None
            }
        }
    }

    /// Returns the middle of what the camera looks at: of all bounded objects, or the origin.
    fn center(&self) -> Vec3 {
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        durer_scene::scene::extent::points(self.scene, &mut |p| {
            (min, max) = (min.min(p.as_vec3()), max.max(p.as_vec3()));
        });
        if min.x <= max.x { 0.5 * (min + max) } else { Vec3::ZERO }
    }

    /// Returns the medium around the camera: fog without bounds.
    pub fn fog(&mut self, program: &str) -> Option<Medium> {
        let fog = &self.scene.fog.as_ref()?.value;
        if fog.density.is_some() || fog.min.is_some() || fog.max.is_some() {
            self.warn_lost(format!("fog in a box is not written to {program}: it is left out"));
            return None;
        }
        let scattering = fog.extinction * fog.color;
        let absorption = Vec3::splat(fog.extinction) - scattering;
        Some(Medium { absorption, scattering, anisotropy: fog.anisotropy, density: None })
    }

    /// Returns the light from all around, or `None` if there is none.
    pub fn around(&mut self, program: &str) -> Option<Around> {
        let background = &self.scene.background;
        if background.cube_map.is_some() {
            self.warn_lost(format!("cube maps are not written to {program}: the background's colour is written"));
        }
        let (degrees, scale) = background.environment_transform();
        if let Some(name) = &background.environment {
            return self.pictured(name, degrees, scale);
        }
        if background.is_night() {
            return None;
        }
        let Some(texels) = background.sky_texels() else {
            // With path tracing, a scene of Dürer's own that sets no background is black.
            let is_silent = self.scene.up.is_none()
                && *background == Background::default()
                && !self.scene.background_span.has_position();
            return (!is_silent && background.color != Vec3::ZERO).then_some(Around::Even(background.color));
        };
        let environment = Environment::new(SKY_WIDTH, SKY_WIDTH / 2, texels, degrees, scale)?;
        Some(Around::Map { environment, rows: SKY_WIDTH / 2, file: None })
    }

    fn pictured(&mut self, name: &FileName, degrees: f32, scale: Vec3) -> Option<Around> {
        let picture = self.picture_bytes(&self.picture(name).bytes).and_then(|bytes| {
            let encoded = Encoded::open(&bytes, &name.path).ok()?;
            encoded.read_for(Environment::BUILD_BYTES_PER_TEXEL, self.context.memory, image::decode_srgb).ok()
        });
        let Some(picture) = picture else {
            self.warn_lost(format!("the environment `{}` cannot be read: it is left out", name.path));
            return None;
        };
        let (rows, width) = (picture.height, picture.width);
        let environment = Environment::new(width, rows, picture.pixels, degrees, scale)?;
        Some(Around::Map { environment, rows, file: Some((name.clone(), degrees, scale)) })
    }

    /// Returns the file of a picture of the light from all around. In the picture, the light comes
    /// from `light`.
    pub fn panorama_file(&mut self, rows: u32, light: impl Fn(glam::DVec3) -> Color + Sync) -> Option<String> {
        self.file("environment".into(), "environment", "pfm", |_| {
            as_pfm(image::Image::from_pixels(2 * rows, rows, panorama::pixels(light, rows)).ok()?)
        })
    }
}
