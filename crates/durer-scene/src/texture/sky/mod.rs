//! Daylight models of the sky and the sun, based on the position of the sun and either the
//! turbidity of the air or measured irradiance. Luminances are in cd/m^2.

pub mod hosek;
pub mod patches;
pub mod perez;
pub mod preetham;

use crate::described_words;
use crate::math::{Color, Vec2, Vec3, fp};
pub use hosek::Hosek;
pub use patches::SkyPatches;
pub use perez::{Irradiance, Perez};
pub use preetham::Preetham;
use std::f32::consts::PI;

/// Angular radius of the sun in degrees.
pub const SUN_RADIUS: f32 = 0.2665;

/// Width of an environment map of a sky, in texels.
pub const SKY_WIDTH: u32 = 512;

/// Fraction of its light that the ground reflects by default.
pub const REFLECTANCE: f32 = 0.2;

described_words! {
    /// Model of the sky: Preetham's clear sky of 1999, the clear sky of Hosek and Wilkie of 2012,
    /// or the all-weather sky of Perez of 1993 for measured irradiance.
    SkyModel { Preetham = "preetham", Hosek = "hosek", Perez = "perez" }
}

/// Sky above a diffuse ground, with the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    dome: Dome,
    /// Radiance that arrives from below the horizon.
    ground: Color,
}

/// Sky above the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Dome {
    Preetham(Preetham),
    Hosek(Hosek),
    /// All-weather sky, and the factor from its relative luminance to cd/m^2.
    Perez(Perez, f32),
}

impl Dome {
    fn at(&self, dir: Vec3) -> Color {
        match self {
            Dome::Preetham(sky) => sky.at(dir),
            Dome::Hosek(sky) => sky.at(dir),
            Dome::Perez(sky, scale) => Color::splat(scale * sky.relative_luminance(dir)),
        }
    }

    fn sun(&self) -> Color {
        match self {
            Dome::Preetham(sky) => sky.sun(),
            Dome::Hosek(sky) => sky.sun(),
            Dome::Perez(sky, _) => Color::splat(sky.sun_illuminance()),
        }
    }

    /// Cosine-weighted mean radiance of the sky without the sun. It equals the illuminance on
    /// horizontal ground divided by pi.
    fn mean_on_horizontal(&self) -> Color {
        const ROWS: u32 = 64;
        let mut sky = Color::ZERO;
        for row in 0..ROWS {
            // Use rings of equal projected area.
            let sine = ((row as f32 + 0.5) / ROWS as f32).sqrt();
            for column in 0..ROWS {
                let (s, c) = fp::sin_cos_degrees((f64::from(column) + 0.5) * 360.0 / f64::from(ROWS));
                let up = (1.0 - sine * sine).sqrt();
                sky += self.at(Vec3::new(sine * s as f32, up, sine * c as f32)) / (ROWS * ROWS) as f32;
            }
        }
        sky
    }
}

impl Sky {
    /// Creates a clear sky. `sun` points to the sun, where y is up. A sun below the horizon is
    /// moved to the horizon. `reflectance` is the fraction of the light from the sky and the sun
    /// that the ground reflects. The default is a ground with a fifth of the luminance of the
    /// zenith.
    pub fn preetham(sun: Vec3, turbidity: f32, reflectance: Option<f32>) -> Self {
        let sky = Preetham::new(sun, turbidity);
        let above = Sky::above(Dome::Preetham(sky), sun, reflectance.unwrap_or_default());
        match reflectance {
            Some(_) => above,
            None => Sky { ground: Vec3::splat(0.2 * sky.zenith_luminance()), ..above },
        }
    }

    /// Creates a clear sky of Hosek and Wilkie; see [`Sky::preetham`]. The ground also brightens
    /// the sky.
    pub fn hosek(sun: Vec3, turbidity: f32, reflectance: Option<f32>) -> Self {
        let share = reflectance.unwrap_or(REFLECTANCE);
        Sky::above(Dome::Hosek(Hosek::new(sun, turbidity, Vec3::splat(share))), sun, share)
    }

    /// Creates an all-weather sky above a ground that reflects the fraction `reflectance` of its
    /// light, by default 0.2.
    pub fn perez(sky: Perez, reflectance: Option<f32>) -> Self {
        let mean = Dome::Perez(sky, 1.0).mean_on_horizontal().x;
        let scale = if mean > 0.0 { sky.sky_illuminance() / (PI * mean) } else { 0.0 };
        Sky::above(Dome::Perez(sky, scale), sky.sun(), reflectance.unwrap_or(REFLECTANCE))
    }

    /// Creates a sky above a ground that reflects the fraction `reflectance` of the light from the
    /// sky and the sun.
    fn above(dome: Dome, sun: Vec3, reflectance: f32) -> Self {
        let ground = reflectance * (dome.mean_on_horizontal() + dome.sun() * raised(sun).y / PI);
        Sky { dome, ground }
    }

    /// Radiance that arrives from a unit direction. Below the horizon, it is the radiance of the
    /// ground.
    pub fn at(&self, dir: Vec3) -> Color {
        if dir.y < 0.0 { self.ground } else { self.dome.at(dir) }
    }

    /// Illuminance from the sun in lux, per colour channel, on a surface that faces the sun.
    pub fn sun(&self) -> Color {
        self.dome.sun()
    }
}

/// Renders a function of the direction as an environment map, with its centre towards -z and y up.
pub fn environment_map(width: u32, height: u32, at: impl Fn(Vec3) -> Color) -> Vec<Color> {
    let pixel = |i: u32| {
        let place = (Vec2::new((i % width) as f32, (i / width) as f32) + 0.5) / Vec2::new(width as f32, height as f32);
        let (sin, cos) = fp::sin_cos_degrees(180.0 * f64::from(place.y));
        let (sin_turn, cos_turn) = fp::sin_cos_degrees(360.0 * f64::from(place.x - 0.5));
        at(Vec3::new((sin * sin_turn) as f32, cos as f32, (-sin * cos_turn) as f32))
    };
    (0..width * height).map(pixel).collect()
}

/// Returns the unit vector to the sun, moved to the horizon if the sun is below it.
fn raised(sun: Vec3) -> Vec3 {
    Vec3::new(sun.x, sun.y.max(0.0), sun.z).normalize_or(Vec3::Y)
}

fn angle(cosine: f32) -> f32 {
    fp::atan2((1.0 - cosine * cosine).max(0.0).sqrt(), cosine)
}

#[cfg(test)]
mod tests;
