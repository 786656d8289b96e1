//! Converts goniometric lights and projectors to measured point lights, with a separate light for
//! each of red, green and blue.
//!
//! Source: *Physically Based Rendering*, 3rd edition, sections 12.3.2 and 12.3.3, and 4th edition,
//! sections 12.2.2 and 12.2.3.

use super::environment::equal_area;
use super::language::Language;
use super::params::Params;
use super::state::Reader;
use crate::panorama::bilinear;
use crate::pictures::{Pictures, picture_error};
use crate::profile_lights::{Axes, ProfileLight, steps};
use durer_image::{self as image, Encoded, Image};
use durer_scene::math::{Color, Vec2, Vec3, fp};
use glam::DAffine3;
use std::f32::consts::{PI, TAU};

/// Maximum number of angular steps in a light profile.
const STEPS: u32 = 720;

/// Number of vertical and of horizontal angular steps in the profile of a projector.
const PROJECTED: [u32; 2] = [360, 720];

/// Directional distribution of a goniometric or projection light, with the vertical and horizontal
/// angles in degrees at which the distribution is sampled.
struct DirectionalPattern {
    axes: Axes,
    angles: [Vec<f32>; 2],
    light: Box<dyn Fn(Vec3) -> Color>,
}

impl Reader<'_> {
    /// Adds a light at the origin of the current space. `color` is its intensity in directions
    /// where the picture has the value 1.
    pub fn pictured_light(&mut self, kind: &str, params: &Params, map: DAffine3, (color, power): (Color, Option<f32>)) {
        let third = self.language == Language::V3;
        let fov = if kind == "projection" { Some(self.fov(params, third)) } else { None };
        let Some(image) = self.light_picture(kind, params, third) else { return };
        let DirectionalPattern { axes, angles: [vertical, horizontal], light } = match fov {
            Some(fov) => {
                let screen = Screen::new(&image, fov);
                let axes = Axes::about_z(&map);
                let angles = [steps(screen.widest(), PROJECTED[0]), steps(360.0, PROJECTED[1])];
                DirectionalPattern { axes, angles, light: Box::new(move |dir| screen.at(&image, dir)) }
            }
            None => {
                let axes = Axes::about_y(&map);
                let count = |texels: u32| (2 * texels).clamp(90, STEPS);
                let angles = [steps(180.0, count(image.height)), steps(360.0, count(image.width))];
                let light =
                    move |dir| if third { lookup_equirectangular(&image, dir) } else { lookup_equal_area(&image, dir) };
                DirectionalPattern { axes, angles, light: Box::new(light) }
            }
        };
        let lights = ProfileLight::new([vertical, horizontal], &axes, light);
        let strength = power.map_or(1.0, |power| {
            let flux = lights.flux();
            if flux > 0.0 { power / flux } else { 0.0 }
        });
        lights.add(&mut self.scene, self.input.name, (map, axes), color * strength, params.at);
    }

    /// Reads the field of view of a projector in degrees, measured across the shorter side of its
    /// picture.
    fn fov(&self, params: &Params, third: bool) -> f32 {
        let fov = params.float("fov").unwrap_or(if third { 45.0 } else { 90.0 });
        if !(fov > 0.0 && fov < 180.0) {
            params.report.error(params.span("fov"), "a field of view must be more than 0 and less than 180 degrees");
        }
        fov.clamp(1e-2, 179.0)
    }

    /// Reads the picture of a light. The picture is white if a pbrt-v3 light does not have one.
    fn light_picture(&self, kind: &str, params: &Params, third: bool) -> Option<Image> {
        let name = if third { "mapname" } else { "filename" };
        let Some(file) = params.text(name).filter(|file| !file.is_empty()).map(str::to_string) else {
            if third {
                return Image::from_pixels(1, 1, vec![Color::ONE]).ok();
            }
            self.report.error(params.at, format!("a light of type `{kind}` needs a `filename`"));
            return None;
        };
        let at = params.get(name).map_or(params.at, |param| param.values_at);
        let bytes = Pictures { input: self.input, report: self.report }.bytes(&file, at)?;
        // pbrt-v3 treats the bytes of a light's picture as linear values.
        let decode = if third { image::decode_linear } else { image::decode_srgb };
        let image = match Encoded::open(&bytes, &file).and_then(|encoded| encoded.read(self.input.memory, decode)) {
            Ok(image) => image,
            Err(error) => {
                self.report.push(picture_error(&file, &error).at(at));
                return None;
            }
        };
        if !third && kind == "goniometric" && image.width != image.height {
            let message = format!(
                "the picture of a `goniometric` light must be square, found {} x {} pixels",
                image.width, image.height
            );
            self.report.error_with_help(
                at,
                message,
                Some("make a square picture with pbrt's `imgtool makeequiarea`".into()),
            );
            return None;
        }
        Some(image)
    }
}

/// Rectangle in the plane at distance 1 onto which a projector projects its picture.
struct Screen {
    half: Vec2,
}

impl Screen {
    fn new(image: &Image, fov: f32) -> Self {
        let aspect = image.width as f32 / image.height as f32;
        let short = fp::tan_f64(f64::from(fov).to_radians() / 2.0) as f32;
        Screen { half: short * Vec2::new(aspect.max(1.0), (1.0 / aspect).max(1.0)) }
    }

    /// Returns the angle in degrees between the optical axis and a corner of the rectangle.
    fn widest(&self) -> f32 {
        fp::atan2(self.half.length(), 1.0).to_degrees()
    }

    /// Returns the value of the picture in a given direction. As in pbrt, the first row of the
    /// picture is at the lowest y.
    fn at(&self, image: &Image, dir: Vec3) -> Color {
        let place = Vec2::new(dir.x, dir.y) / (dir.z * self.half);
        if dir.z <= 0.0 || place.abs().max_element() > 1.0 {
            return Color::ZERO;
        }
        bilinear(image, 0.5 * (place + 1.0))
    }
}

/// Returns the value in a given direction of a picture whose columns are longitudes, measured from
/// x towards z, and whose rows are polar angles, measured from y.
fn lookup_equirectangular(image: &Image, dir: Vec3) -> Color {
    let turn = fp::atan2(dir.z, dir.x) / TAU;
    let down = fp::atan2((dir.x * dir.x + dir.z * dir.z).sqrt(), dir.y) / PI;
    bilinear(image, Vec2::new(turn - turn.floor(), down))
}

/// Returns the grey value of a square equal-area picture in a given direction, which is the mean of
/// its channels.
fn lookup_equal_area(image: &Image, dir: Vec3) -> Color {
    let place = equal_area(dir);
    let texel = |share: f32, count: u32| ((share * count as f32) as u32).min(count - 1);
    let value = image.get(texel(place.x, image.width), texel(place.y, image.height)).unwrap_or_default();
    Color::splat(value.element_sum() / 3.0)
}
