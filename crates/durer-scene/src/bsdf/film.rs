//! Thin films, such as soap, oil on water, and the oxide on tempered steel. Light that is reflected
//! at the upper boundary interferes with light that is reflected at the lower one.
//!
//! Sources: Airy's sum of all reflections in a film (Born and Wolf, *Principles of Optics*, section
//! 7.6). For RGB colours, the sum by interference orders is from Belcour and Barla, *A Practical
//! Extension to Microfacet Theory for the Modeling of Varying Iridescence*, SIGGRAPH 2017.

use super::fresnel;
use crate::math::{Vec2, fp};
use crate::spectrum::{Lanes, Spectrum, interference};
use std::f32::consts::TAU;

/// Thin film on a dielectric or metal base, which has an iridescent reflectance. Indices are
/// relative to the medium in front of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Wavelengths of the lanes in nanometres, or 0 for RGB lanes.
    nm: Spectrum,
    /// Index of a dielectric base relative to the medium in front of the film, or reflectance of a
    /// metal base at normal incidence.
    below: Spectrum,
    metal: bool,
    /// Thickness in nanometres.
    thickness: f32,
    /// Index of the film relative to the medium in front of it.
    ior: f32,
    /// Share of the surface that the film covers, from 0 to 1.
    weight: f32,
}

/// Relative position of the refractive index of a metal between the largest index (0) and the
/// smallest index (1) that its reflectance allows. This value suits gold, copper, silver and
/// aluminium.
///
/// Source of the formulas: Gulbrandsen, *Artist Friendly Metallic Fresnel*, JCGT 3(4), 2014.
const METALLIC: f32 = 0.985;

/// Maximum number of interference orders that are summed for RGB colours. Higher orders have no
/// visible effect at eight bits per channel.
const ORDERS: i32 = 12;

impl Film {
    /// Creates a film on a dielectric base. Indices are relative to the medium in front of the
    /// film. `micrometres` is the thickness.
    pub fn on_dielectric(lanes: &Lanes, micrometres: f32, ior: f32, eta: f32, weight: f32) -> Self {
        let below = Spectrum::splat(eta);
        Film { nm: wavelengths(lanes), below, metal: false, thickness: 1_000.0 * micrometres, ior, weight }
    }

    /// Creates a film on a metal base. `reflected` is the reflectance of the base at normal
    /// incidence.
    pub fn on_metal(lanes: &Lanes, micrometres: f32, ior: f32, reflected: Spectrum) -> Self {
        let below = reflected.clamp(Spectrum::splat(0.01), Spectrum::splat(0.999));
        Film { nm: wavelengths(lanes), below, metal: true, thickness: 1_000.0 * micrometres, ior, weight: 1.0 }
    }

    /// Returns the reflectance for unpolarised light at a cosine from 0 to 1. For light from
    /// inside, for which the index of the base is below 1, the reflectance is equal to that from
    /// outside along the same path.
    pub fn reflected(&self, cosine: f32) -> Spectrum {
        if self.metal {
            return self.film_reflectance(cosine);
        }
        let eta = self.below.x;
        let plain = fresnel::dielectric(cosine, eta);
        if plain >= 1.0 {
            return Spectrum::ONE;
        }
        let covered = match eta < 1.0 {
            true => {
                let outside = (1.0 - (1.0 - cosine * cosine) / (eta * eta)).max(0.0).sqrt();
                Film { below: Spectrum::splat(1.0 / eta), ior: self.ior / eta, ..*self }.film_reflectance(outside)
            }
            false => self.film_reflectance(cosine),
        };
        Spectrum::splat(plain).lerp(covered, self.weight)
    }

    fn film_reflectance(&self, cosine: f32) -> Spectrum {
        let sine2 = (1.0 - cosine * cosine).max(0.0);
        let inside2 = 1.0 - sine2 / (self.ior * self.ior);
        if inside2 <= 0.0 {
            return Spectrum::ONE;
        }
        let inside = inside2.sqrt();
        let shift = 2.0 * self.ior * self.thickness * inside;
        let boundaries = [
            (cosine - self.ior * inside) / (cosine + self.ior * inside),
            (self.ior * cosine - inside) / (self.ior * cosine + inside),
        ];
        let mut sum = Spectrum::ZERO;
        for lane in 0..4 {
            // In RGB mode, the fourth lane is a copy of the green one.
            let below = self.lower_boundary(lane, sine2, inside);
            for (first, second) in boundaries.into_iter().zip(below) {
                sum[lane] += match self.nm.x > 0.0 {
                    true => airy(first, second, TAU * shift / self.nm[lane]),
                    false => by_orders(first, second, shift, [0, 1, 2, 1][lane]),
                };
            }
        }
        (0.5 * sum).clamp(Spectrum::ZERO, Spectrum::ONE)
    }

    /// Returns the complex reflection coefficients of the lower boundary, for light polarised
    /// perpendicular and parallel to the plane of incidence.
    fn lower_boundary(&self, lane: usize, sine2: f32, inside: f32) -> [Vec2; 2] {
        let index = match self.metal {
            true => metal_index(self.below[lane]),
            false => Vec2::new(self.below[lane], 0.0),
        };
        // The squared complex cosine behind the boundary is 1 - sin^2 / n^2.
        let square = multiply(index, index);
        let cosine = complex_sqrt(Vec2::X - divide(Vec2::new(sine2, 0.0), square));
        let film = self.ior;
        let (n_cos, film_cosine) = (multiply(index, cosine), Vec2::new(film * inside, 0.0));
        let (cross, film_cos) = (inside * index, film * cosine);
        [divide(film_cosine - n_cos, film_cosine + n_cos), divide(cross - film_cos, cross + film_cos)]
    }
}

fn wavelengths(lanes: &Lanes) -> Spectrum {
    match lanes {
        Lanes::Rgb => Spectrum::ZERO,
        Lanes::Wavelengths(waves) => waves.nm,
    }
}

/// Returns the complex index of refraction of a metal whose reflectance at normal incidence is `r`.
fn metal_index(r: f32) -> Vec2 {
    let root = r.sqrt();
    let n = METALLIC * (1.0 - r) / (1.0 + r) + (1.0 - METALLIC) * (1.0 + root) / (1.0 - root);
    let k2 = (r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    Vec2::new(n, k2.max(0.0).sqrt())
}

/// Returns the Airy reflectance |(a + b z) / (1 + a b z)|^2, where z is a unit phasor.
fn airy(first: f32, second: Vec2, phase: f32) -> f32 {
    let z = multiply(second, Vec2::new(fp::cos(phase), fp::sin(phase)));
    let above = Vec2::new(first, 0.0) + z;
    let below = Vec2::X + first * z;
    above.length_squared() / below.length_squared()
}

/// Returns the mean of [`airy`] over a colour channel under daylight. The mean is computed as a
/// Fourier series in the phase, in which each order is averaged over the daylight spectrum.
fn by_orders(first: f32, second: Vec2, shift: f32, channel: usize) -> f32 {
    let (r1, r2) = (first * first, second.length_squared());
    let through = 1.0 - r1;
    let again = through * through * r2 / (1.0 - r1 * r2).max(1e-6);
    let mut sum = r1 + again;
    // Each order is the previous one multiplied by `step`.
    let step = -first * second;
    let mut order = step;
    for number in 1..=ORDERS {
        let strength = 2.0 * (again - through);
        if (strength * order).length_squared() < 1e-8 {
            break;
        }
        sum += strength * multiply(order, interference(number as f32 * shift)[channel]).x;
        order = multiply(order, step);
    }
    sum
}

fn multiply(a: Vec2, b: Vec2) -> Vec2 {
    Vec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

fn divide(a: Vec2, b: Vec2) -> Vec2 {
    multiply(a, Vec2::new(b.x, -b.y)) / b.length_squared()
}

/// Returns the complex square root in the upper half-plane.
fn complex_sqrt(a: Vec2) -> Vec2 {
    let length = a.length();
    let real = (0.5 * (length + a.x)).max(0.0).sqrt();
    let imaginary = (0.5 * (length - a.x)).max(0.0).sqrt();
    Vec2::new(if a.y < 0.0 { -real } else { real }, imaginary)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::ColorMode;

    fn waves(u: f32) -> Lanes {
        Lanes::new(ColorMode::Spectral, u)
    }

    #[test]
    fn film_without_thickness_contrast_or_weight_has_no_effect() {
        for lanes in [Lanes::Rgb, waves(0.3)] {
            for cosine in [1.0, 0.8, 0.4, 0.1] {
                let plain = fresnel::dielectric(cosine, 1.5);
                let thin = Film::on_dielectric(&lanes, 0.0, 1.3, 1.5, 1.0).reflected(cosine);
                let same = Film::on_dielectric(&lanes, 0.4, 1.5, 1.5, 1.0).reflected(cosine);
                let none = Film::on_dielectric(&lanes, 0.4, 1.3, 1.5, 0.0).reflected(cosine);
                for found in [thin, same, none] {
                    assert!((found - plain).abs().max_element() < 1e-3, "{lanes:?} {cosine}: {found} {plain}");
                }
            }
        }
    }

    #[test]
    fn quarter_wave_film_of_matched_index_reflects_nothing() {
        // The index of the film is the square root of that of the glass, and the thickness is a
        // quarter of the wavelength.
        let lanes = waves(0.4);
        let nm = lanes.hero().unwrap();
        let ior = 1.52_f32.sqrt();
        let film = Film::on_dielectric(&lanes, nm / (4.0 * ior) / 1_000.0, ior, 1.52, 1.0);
        assert!(film.reflected(1.0).x < 1e-6, "{}", film.reflected(1.0));
        // A half-wave film has no effect.
        let film = Film::on_dielectric(&lanes, nm / (2.0 * ior) / 1_000.0, ior, 1.52, 1.0);
        assert!((film.reflected(1.0).x - fresnel::dielectric(1.0, 1.52)).abs() < 1e-5);
    }

    #[test]
    fn film_colours_are_means_over_wavelengths() {
        let n = 8192;
        for (thickness, ior, metal) in [(0.1, 1.33, false), (0.35, 1.33, false), (1.2, 1.6, false), (0.3, 2.2, true)] {
            for cosine in [1.0, 0.6, 0.2] {
                let film = |lanes: &Lanes| match metal {
                    true => Film::on_metal(lanes, thickness, ior, Spectrum::splat(0.85)),
                    false => Film::on_dielectric(lanes, thickness, ior, 1.0, 1.0),
                };
                let lanes = (0..n).map(|i| waves((i as f32 + 0.5) / n as f32));
                let mean = lanes.map(|lanes| {
                    let white = lanes.light(crate::math::Color::ONE);
                    lanes.color(film(&lanes).reflected(cosine) * white).as_dvec3()
                });
                let mean = mean.sum::<glam::DVec3>().as_vec3() / n as f32;
                let colour = film(&Lanes::Rgb).reflected(cosine).truncate();
                let mean = mean.clamp(crate::math::Color::ZERO, crate::math::Color::ONE);
                let off = (mean - colour).abs().max_element();
                assert!(off < 0.004, "{thickness} {ior} {metal} {cosine}: {mean} {colour}");
            }
        }
    }

    #[test]
    fn film_conserves_energy_and_is_equal_from_both_sides() {
        for u in [0.1, 0.5, 0.8] {
            for cosine in [0.95_f32, 0.5, 0.15] {
                let (out, eta) = (Film::on_dielectric(&waves(u), 0.4, 1.9, 1.5, 1.0), 1.0 / 1.5);
                let behind = (1.0 - (1.0 - cosine * cosine) / 2.25).sqrt();
                let back = Film::on_dielectric(&waves(u), 0.4, 1.9 / 1.5, eta, 1.0);
                let (there, here) = (out.reflected(cosine), back.reflected(behind));
                assert!((there - here).abs().max_element() < 1e-4, "{cosine}: {there} {here}");
                assert!(there.min_element() >= 0.0 && there.max_element() <= 1.0);
            }
        }
        let total = Film::on_dielectric(&waves(0.5), 0.4, 1.3 / 1.5, 1.0 / 1.5, 1.0).reflected(0.2);
        assert_eq!(total, Spectrum::ONE);
        assert!((metal_index(0.848).x - 0.41).abs() < 0.1 && metal_index(0.848).y > 2.0, "{}", metal_index(0.848));
    }
}
