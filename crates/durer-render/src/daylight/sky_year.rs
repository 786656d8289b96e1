//! Sky of a year: the luminances of its patches and the sun in each interval of the weather.

use crate::world::World;
use durer_scene::light::{DirectionalLight, Light};
use durer_scene::math::{Color, Vec3, fp};
use durer_scene::scene::Axis;
use durer_scene::scene::defaults::ModelAxes;
use durer_scene::texture::Environment;
use durer_scene::texture::sky::{Perez, SKY_WIDTH, SUN_RADIUS, Sky, SkyPatches, environment_map};
use durer_scene::weather::{Daylight, Weather};
use std::f64::consts::PI;

/// Width of the environment map that guides the paths of a year, in texels.
const GUIDE_WIDTH: u32 = 256;

/// Minimum radiance of that map, as a fraction of its mean, so that paths find all directions.
const GUIDE_MIN: f64 = 0.02;

/// Directions of the sky in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyAxes {
    east: Vec3,
    up: Vec3,
    north: Vec3,
}

impl SkyAxes {
    /// Creates the directions for a scene. If y is up, -z is north and x is east; if z is up, y is
    /// north and x is east. `turn` rotates north and east about the up axis, in degrees towards
    /// east.
    pub fn new(up: Axis, turn: f64) -> Self {
        let ModelAxes { right, up, front } = ModelAxes::new(up);
        let (sin, cos) = fp::sin_cos_degrees(turn);
        let north = cos * -front + sin * right;
        SkyAxes { east: north.cross(up).as_vec3(), up: up.as_vec3(), north: north.as_vec3() }
    }

    /// Converts a direction in world space to one where x is east, y is up and -z is north.
    pub fn to_sky(&self, dir: Vec3) -> Vec3 {
        Vec3::new(dir.dot(self.east), dir.dot(self.up), -dir.dot(self.north))
    }

    /// Converts a direction where x is east, y is up and -z is north to world space.
    pub fn to_world(&self, dir: Vec3) -> Vec3 {
        dir.x * self.east + dir.y * self.up - dir.z * self.north
    }
}

/// Sun of one interval.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SunOfHour {
    /// Unit direction to the sun in world space.
    pub dir: Vec3,
    /// Illuminance on a surface that faces the sun, in lux; greater than 0.
    pub illuminance: f32,
    /// Patches around the sun, each with its weight per steradian. The weights times the solid
    /// angles add up to 1.
    pub around: Vec<(u32, f32)>,
}

/// Interval of a year in which the sky emits light.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BrightHour {
    /// Index of the row of the weather.
    pub row: usize,
    /// Luminances of the patches and of the ground, in cd/m^2.
    pub luminances: Vec<f32>,
    /// Sun; `None` if it emits no light.
    pub sun: Option<SunOfHour>,
}

/// Sky of a year above a scene, computed from its weather.
#[derive(Clone, Debug)]
pub struct SkyYear {
    pub(super) patches: SkyPatches,
    pub(super) axes: SkyAxes,
    pub(super) bright: Vec<BrightHour>,
    pub(super) weather: Weather,
    /// For each row, true if its values are missing although the sun is up.
    pub(super) missing: Vec<bool>,
    /// Mean luminance of the patches, including the sun, and of the ground.
    mean: Vec<f64>,
}

impl SkyYear {
    /// Computes the luminances of the patches for all rows of the weather. The ground below the
    /// horizon reflects the fraction `ground` of the light from sun and sky.
    pub fn new(weather: &Weather, axes: SkyAxes, patches: SkyPatches, ground: f32) -> Self {
        let solid_angles: Vec<f64> = (0..patches.count()).map(|patch| patches.solid_angle(patch)).collect();
        let centers: Vec<Vec3> = (0..patches.count()).map(|patch| patches.center(patch)).collect();
        let (mut bright, mut missing) = (Vec::new(), Vec::with_capacity(weather.rows.len()));
        for (row, interval) in weather.rows.iter().enumerate() {
            let daylight = interval.daylight(&weather.place);
            missing.push(daylight == Daylight::Missing);
            let Daylight::Sky(sky) = daylight else { continue };
            let mut luminances: Vec<f32> = centers.iter().map(|center| sky.relative_luminance(*center)).collect();
            let level = luminances.iter().zip(&solid_angles).zip(&centers);
            let level: f64 = level.map(|((light, angle), center)| f64::from(light * center.y) * angle).sum();
            let scale = if level > 0.0 { f64::from(sky.sky_illuminance()) / level } else { 0.0 };
            luminances.iter_mut().for_each(|light| *light *= scale as f32);
            let reflected = sky.sky_illuminance() + sky.sun_illuminance() * sky.sun().y;
            luminances.push(ground * reflected / std::f32::consts::PI);
            let sun = (sky.sun_illuminance() > 0.0).then(|| SunOfHour {
                dir: axes.to_world(sky.sun()),
                illuminance: sky.sun_illuminance(),
                around: around(&patches, &centers, &solid_angles, sky.sun()),
            });
            bright.push(BrightHour { row, luminances, sun });
        }
        let mut mean = vec![0.0; patches.count() + 1];
        for BrightHour { luminances, sun, .. } in &bright {
            mean.iter_mut().zip(luminances).for_each(|(mean, light)| *mean += f64::from(*light));
            if let Some(SunOfHour { illuminance, around, .. }) = sun {
                around.iter().for_each(|(patch, weight)| mean[*patch as usize] += f64::from(illuminance * weight));
            }
        }
        mean.iter_mut().for_each(|mean| *mean /= weather.rows.len() as f64);
        SkyYear { patches, axes, bright, weather: weather.clone(), missing, mean }
    }

    /// Returns true if the sky emits light in no row.
    pub fn is_dark(&self) -> bool {
        self.bright.is_empty()
    }

    /// Returns the index of the patch, or of the ground, for a direction in world space.
    pub(super) fn patch(&self, dir: Vec3) -> usize {
        let dir = self.axes.to_sky(dir.normalize_or(Vec3::Y));
        if dir.y < 0.0 { self.patches.count() } else { self.patches.patch(dir) }
    }

    /// Lights a world for [`annual`](super::annual) by the mean sky of the year, which guides the
    /// paths to bright directions. All other light is removed.
    pub fn light(&self, world: World) -> World {
        let all: f64 = self.mean.iter().sum();
        let floor = if all > 0.0 { GUIDE_MIN * all / self.mean.len() as f64 } else { 1.0 };
        let at = |dir: Vec3| Color::splat((self.mean[self.patch(dir)] + floor) as f32);
        let texels = environment_map(GUIDE_WIDTH, GUIDE_WIDTH / 2, at);
        let map = Environment::new(GUIDE_WIDTH, GUIDE_WIDTH / 2, texels, 0.0, Color::ONE);
        world.with_light(map, Vec::new())
    }
}

/// Returns the patches around a sun in sky space, with weights that fall linearly to 0 at the
/// distance of one row. Between the centres of patches, the sum changes continuously.
fn around(patches: &SkyPatches, centers: &[Vec3], solid_angles: &[f64], sun: Vec3) -> Vec<(u32, f32)> {
    let radius = patches.row_height().to_radians() as f32;
    let weight = |center: &Vec3| {
        // The chord is the angle to within 0.1 % for these small angles, and exact near 0.
        1.0 - center.distance(sun) / radius
    };
    let near = centers.iter().map(weight).enumerate().filter(|(_, weight)| *weight > 0.0);
    let mut near: Vec<(usize, f64)> = near.map(|(patch, weight)| (patch, f64::from(weight))).collect();
    if near.is_empty() {
        near.push((patches.patch(sun), 1.0));
    }
    let all: f64 = near.iter().map(|(_, weight)| weight).sum();
    near.into_iter().map(|(patch, weight)| (patch as u32, (weight / (all * solid_angles[patch])) as f32)).collect()
}

/// Lights a world by the sun and the sky of one interval, instead of all its other light. The
/// ground below the horizon reflects the fraction `ground` of the light from sun and sky. In a
/// world with a [luminous efficacy](World::lumens), the light is in watts.
pub fn light_of_hour(world: World, sky: &Perez, axes: &SkyAxes, ground: f32) -> World {
    let unit = 1.0 / world.lumens().map_or(1.0, |lumens| lumens.element_sum());
    let dome = Sky::perez(*sky, Some(ground));
    let texels = environment_map(SKY_WIDTH, SKY_WIDTH / 2, |dir| dome.at(axes.to_sky(dir)));
    let map = Environment::new(SKY_WIDTH, SKY_WIDTH / 2, texels, 0.0, Color::splat(unit));
    let color = unit * dome.sun() / PI as f32;
    let sun = DirectionalLight {
        direction: -axes.to_world(sky.sun()),
        color,
        spread: Some(SUN_RADIUS),
        ..DirectionalLight::default()
    };
    let is_bright = color.max_element() > 0.0;
    world.with_light(map, if is_bright { vec![Light::from(sun)] } else { Vec::new() })
}
