//! Converts infinite lights: constant colours and environment maps. All of them are merged into one
//! equirectangular environment map.

use super::defs::{EnvironmentMapping, InfiniteLight};
use super::state::Reader;
use crate::panorama::{self, bilinear};
use crate::pictures::picture_error;
use durer_diag::{Diagnostic, Span};
use durer_image::{self as image, Encoded, Image};
use durer_scene::math::{Color, LUMINANCE, Vec2, Vec3, fp};
use glam::{DAffine3, DVec3};
use std::f32::consts::{FRAC_2_PI, PI, TAU};

/// Maximum height in pixels of the merged environment map.
const MAX_ROWS: u32 = 2048;

/// Environment map of one infinite light, with its transform and scale. The map is merged with the
/// other maps into the environment of the scene.
struct Source {
    image: Image,
    to_light: DAffine3,
    scale: Color,
    map: EnvironmentMapping,
}

impl Reader<'_> {
    /// Merges all infinite lights into the scene's environment map.
    pub fn set_environment(&mut self) {
        let mut even = Color::ZERO;
        let mut sources = Vec::new();
        let mut first = None;
        for infinite in std::mem::take(&mut self.infinite) {
            match infinite {
                InfiniteLight::Constant(color) => even += color,
                InfiniteLight::Picture { name, at, scale, map, to_light, illuminance } => {
                    let memory = panorama::remaining_memory(
                        sources.iter().map(|source: &Source| &source.image),
                        self.input.memory,
                    );
                    let Some((image, map)) = self.environment(&name, at, map, memory) else { continue };
                    let bright = |wanted: f32| wanted / upper_illuminance(&image, map);
                    let scale = scale * illuminance.map_or(1.0, bright);
                    first.get_or_insert((name, at));
                    let scale = if scale.is_finite() { scale } else { Color::ZERO };
                    sources.push(Source { image, to_light, scale, map });
                }
            }
        }
        (self.scene.background.color, self.scene.background.ambient_light) = (even, Color::ZERO);
        let Some((name, at)) = first else { return };
        // Double the number of rows for an equirectangular source. Fine detail near the poles of
        // the source may be far from the poles of the merged map, where fewer texels are available
        // for it.
        // The equal-area map uses the nearest texel, so small ones get many rows, which keep the
        // borders between texels.
        let finer = |source: &Source| match source.map {
            EnvironmentMapping::Equirectangular => 2 * source.image.height,
            EnvironmentMapping::EqualArea => source.image.height.max((8 * source.image.height).min(512)),
        };
        let rows = sources.iter().map(finer).max().unwrap_or(1).min(MAX_ROWS);
        let light = |dir: DVec3| even + sources.iter().map(|source| source.at(dir)).sum::<Color>();
        let memory = panorama::remaining_memory(sources.iter().map(|source| &source.image), self.input.memory);
        if let Err(error) = panorama::set_environment(&mut self.scene, (&name, at), rows, memory, light) {
            self.report.push(picture_error(&name, &error).at(at));
        }
    }

    /// Reads an environment map and determines which mapping it uses.
    fn environment(
        &self,
        name: &str,
        at: Span,
        map: EnvironmentMapping,
        memory: u64,
    ) -> Option<(Image, EnvironmentMapping)> {
        let bytes = match self.input.source.read(name) {
            Ok(bytes) => bytes,
            Err(error) => {
                self.report.push(Diagnostic::error(error.to_string()).code("missing-file").at(at));
                return None;
            }
        };
        // pbrt-v3 treats the bytes of an environment map as linear values.
        let decode = if map == EnvironmentMapping::Equirectangular { image::decode_linear } else { image::decode_srgb };
        let read = Encoded::open(&bytes, name).and_then(|encoded| encoded.read(memory, decode));
        match read {
            Ok(picture) if map == EnvironmentMapping::Equirectangular => Some((picture, map)),
            Ok(picture) if picture.width == picture.height => Some((picture, map)),
            Ok(picture) if picture.width == 2 * picture.height => {
                let what = "this picture is twice as wide as high, so it is read as longitude and latitude, as in \
                            pbrt-v3, with z up";
                self.report.unsupported(at, what);
                Some((picture, EnvironmentMapping::Equirectangular))
            }
            Ok(Image { width, height, .. }) => {
                let message = format!("an environment picture must be square, found {width} x {height} pixels");
                self.report.error_with_help(
                    at,
                    message,
                    Some("make a square picture with pbrt's `imgtool makeequiarea`".into()),
                );
                None
            }
            Err(error) => {
                self.report.push(picture_error(name, &error).at(at));
                None
            }
        }
    }
}

impl Source {
    /// Returns the radiance from a direction in world space. The equal-area map of pbrt-v4 uses
    /// the nearest texel, and the equirectangular map of pbrt-v3 uses bilinear interpolation.
    fn at(&self, dir: DVec3) -> Color {
        let dir = self.to_light.transform_vector3(dir).normalize_or(DVec3::Z).as_vec3();
        let (width, height) = (self.image.width, self.image.height);
        let place = match self.map {
            EnvironmentMapping::EqualArea => equal_area(dir),
            EnvironmentMapping::Equirectangular => {
                let u = fp::atan2(dir.y, dir.x) / TAU;
                Vec2::new(u - u.floor(), fp::atan2((dir.x * dir.x + dir.y * dir.y).sqrt(), dir.z) / PI)
            }
        };
        let texel = |share: f32, count: u32| ((share * count as f32) as u32).min(count - 1);
        let light = match self.map {
            EnvironmentMapping::EqualArea => {
                self.image.get(texel(place.x, width), texel(place.y, height)).unwrap_or_default()
            }
            EnvironmentMapping::Equirectangular => bilinear(&self.image, place),
        };
        let light = if light.is_finite() { light.max(Color::ZERO) } else { Color::ZERO };
        self.scale * light
    }
}

/// Returns the position in the unit square that the equal-area mapping assigns to a unit vector.
///
/// Source: Petrik Clarberg, *Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD*, Journal of
/// Graphics Tools 13(3), 2008.
pub(super) fn equal_area(dir: Vec3) -> Vec2 {
    let Vec3 { x, y, z } = dir.abs();
    let radius = (1.0 - z).max(0.0).sqrt();
    // Angle from the x axis towards the y axis, as a fraction of a quarter turn.
    let turn = if x == 0.0 && y == 0.0 { 0.0 } else { FRAC_2_PI * fp::atan2(y, x) };
    let upper = Vec2::new(radius * (1.0 - turn), radius * turn);
    let place = if dir.z < 0.0 { Vec2::new(1.0 - upper.y, 1.0 - upper.x) } else { upper };
    0.5 * (Vec2::new(place.x.copysign(dir.x), place.y.copysign(dir.y)) + 1.0)
}

/// Returns the unit vector that the equal-area mapping assigns to a position in the unit square.
pub(super) fn equal_area_direction(place: Vec2) -> Vec3 {
    let place = 2.0 * place - 1.0;
    let across = place.abs();
    let distance = 1.0 - (across.x + across.y);
    let radius = 1.0 - distance.abs();
    let turn = if radius == 0.0 { 1.0 } else { (across.y - across.x) / radius + 1.0 } * 0.25 * PI;
    let flat = radius * (2.0 - radius * radius).max(0.0).sqrt();
    let z = (1.0 - radius * radius).copysign(distance);
    Vec3::new((fp::cos(turn) * flat).copysign(place.x), (fp::sin(turn) * flat).copysign(place.y), z)
}

/// Returns the illuminance of a surface that faces +z and is lit by the upper half (z > 0) of an
/// environment map.
fn upper_illuminance(image: &Image, map: EnvironmentMapping) -> f32 {
    let mut sum = 0.0_f64;
    let (width, height) = (image.width, image.height);
    for (i, light) in image.pixels.iter().enumerate() {
        let (x, y) = ((i as u32 % width) as f32 + 0.5, (i as u32 / width) as f32 + 0.5);
        let place = Vec2::new(x / width as f32, y / height as f32);
        let (cosine, size) = match map {
            EnvironmentMapping::EqualArea => (equal_area_direction(place).z, 4.0 * PI),
            EnvironmentMapping::Equirectangular => (fp::cos(PI * place.y), 2.0 * PI * PI * fp::sin(PI * place.y)),
        };
        let luminance = light.dot(LUMINANCE);
        sum += f64::from(luminance * cosine.max(0.0) * size);
    }
    (sum / f64::from(width * height)) as f32
}
