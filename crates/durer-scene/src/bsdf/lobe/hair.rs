//! Hair and fur, modelled as fibres seen from outside.
//!
//! Light is reflected by the fibre (R), passes through it (TT), or passes through it after one or
//! more internal reflections (TRT and higher). The roughness of the cuticle scales spreads the
//! light along the fibre, and the uneven cross-section spreads it around the fibre. The local x
//! axis lies along the fibre. The tilt of the normal determines the offset across the fibre at
//! which light hits it.
//!
//! Sources: Marschner, Jensen, Cammarano, Worley and Hanrahan, *Light Scattering from Human Hair
//! Fibers*, SIGGRAPH 2003 (the paths of light); d'Eon, Francois, Hill, Letteri and Aubry, *An
//! Energy-Conserving Hair Reflectance Model*, EGSR 2011 (the spread along the fibre and the
//! melanins); Chiang, Bitterli, Tappan and Burley, *A Practical and Controllable Hair and Fur Model
//! for Production Path Tracing*, Eurographics 2016 (the spread around the fibre, the roughness and
//! the colour).

use super::{LobeKind, LobeSample, Scatter};
use crate::bsdf::fresnel;
use crate::material::HairMaterial;
use crate::math::{Color, Vec2, Vec3, fp};
use crate::spectrum::{Lanes, Spectrum, lane_sum};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Number of light paths, which are R, TT, TRT, and all paths with more internal reflections.
const PATHS: usize = 4;

/// Index of the last path, which covers all further internal reflections. The last path spreads
/// light evenly around the fibre.
const LAST_PATH: usize = PATHS - 1;

/// Hair fibre of one material, with its pigment and roughness, which is shared by all points of the
/// fibre.
#[derive(Clone, Debug, PartialEq)]
pub struct Fibre {
    pigment: Pigment,
    /// Index of refraction inside the fibre, relative to the index outside.
    eta: f32,
    /// Sine and cosine of the angles by which the cuticle scales tilt the first three paths.
    tilts: [Vec2; LAST_PATH],
    /// Variance of each path along the fibre.
    variances: [f32; PATHS],
    /// Azimuthal distribution of each path except the last.
    spread: Logistic,
}

/// Pigment of a hair fibre, given by its absorption or by the colour of the hair.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pigment {
    /// Absorption coefficient per radius of the fibre.
    Absorption(Color),
    /// Colour of many fibres together, and a divisor. The logarithm of the colour, divided by the
    /// divisor, is minus the square root of the absorption.
    Color(Color, f32),
}

impl Fibre {
    /// Creates a fibre from a hair material.
    pub fn new(m: &HairMaterial) -> Self {
        // The scales tilt R back by twice their own angle, TT forward by that angle, and TRT
        // forward by four times that angle.
        let tilt = |by: f64| {
            let (sin, cos) = fp::sin_cos_degrees(by * f64::from(m.scale_tilt));
            Vec2::new(sin as f32, cos as f32)
        };
        let along = m.longitudinal_roughness.max(0.02);
        let deviation = 0.726 * along + 0.812 * along * along + 3.7 * fp::pow(along, 20.0);
        let variance = deviation * deviation;
        let around = m.azimuthal_roughness.max(0.02);
        let scale = 0.265 * around + 1.194 * around * around + 5.372 * fp::pow(around, 22.0);
        let melanin = m.eumelanin * Color::new(0.419, 0.697, 1.37) + m.pheomelanin * Color::new(0.187, 0.4, 1.05);
        let (b, b2) = (m.azimuthal_roughness, m.azimuthal_roughness * m.azimuthal_roughness);
        let fit = 5.969 - 0.215 * b + 2.532 * b2 - 10.73 * b2 * b + 5.574 * b2 * b2 + 0.245 * b2 * b2 * b;
        Fibre {
            pigment: match (m.absorption, m.color) {
                (Some(absorption), _) => Pigment::Absorption(absorption.max(Color::ZERO)),
                (None, Some(color)) => Pigment::Color(color, fit),
                (None, None) => Pigment::Absorption(melanin),
            },
            eta: m.ior,
            tilts: [tilt(-2.0), tilt(1.0), tilt(4.0)],
            variances: [variance, 0.25 * variance, 4.0 * variance, 4.0 * variance],
            spread: Logistic::new((PI / 8.0).sqrt() * scale),
        }
    }

    /// Returns the approximate colour of many fibres together.
    pub fn color(&self) -> Color {
        match self.pigment {
            Pigment::Color(color, _) => color,
            // The formula assumes an azimuthal roughness of 0.
            Pigment::Absorption(absorption) => absorption.map(|sigma| fp::exp(-5.969 * sigma.sqrt())),
        }
    }

    /// Returns the hair lobe for light in the given lanes.
    pub fn lobe(&self, lanes: &Lanes) -> Hair<'_> {
        let absorption = match self.pigment {
            Pigment::Absorption(absorption) => lanes.coefficient(absorption),
            Pigment::Color(color, fit) => {
                let depth = lanes.reflectance(color).map(|share| fp::ln(share.clamp(1e-4, 1.0))) / fit;
                depth * depth
            }
        };
        Hair { fibre: self, absorption }
    }

    /// Returns the longitudinal sine and cosine of the view direction, after the tilt that the
    /// scales cause for a path.
    fn tilted(&self, path: usize, out: &FibreDirection) -> Vec2 {
        let Some(tilt) = self.tilts.get(path) else { return out.along };
        let sine = out.along.x * tilt.y + out.along.y * tilt.x;
        Vec2::new(sine, (out.along.y * tilt.y - out.along.x * tilt.x).abs())
    }
}

/// Scattering lobe of a hair fibre, with its absorption in the current lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hair<'a> {
    fibre: &'a Fibre,
    /// Absorption coefficient per radius of the fibre.
    absorption: Spectrum,
}

/// Direction in the coordinates of a hair fibre, which are a longitudinal and an azimuthal angle.
struct FibreDirection {
    /// Sine and cosine of the angle between the direction and the plane perpendicular to the fibre.
    along: Vec2,
    /// Angle around the fibre, from the y axis to the z axis.
    around: f32,
}

impl FibreDirection {
    fn of(w: Vec3) -> Self {
        let along = Vec2::new(w.x.clamp(-1.0, 1.0), (w.y * w.y + w.z * w.z).sqrt());
        FibreDirection { along, around: TAU * fp::atan2_turn(w.z, w.y) }
    }
}

/// Distribution of light among the paths through a hair fibre, for one view direction.
struct PathLobes {
    shares: [Spectrum; PATHS],
    /// Sampling weight of each path, and their sum.
    sampling_weights: [f32; PATHS],
    total: f32,
    /// Azimuthal angles between the light and the normal, outside and inside the fibre.
    angles: [f32; 2],
}

impl PathLobes {
    /// Returns the angle by which a path deflects light around the fibre.
    fn turn(&self, path: usize) -> f32 {
        let path = path as f32;
        2.0 * path * self.angles[1] - 2.0 * self.angles[0] + path * PI
    }
}

impl Hair<'_> {
    fn path_lobes(&self, wo: Vec3, out: &FibreDirection) -> PathLobes {
        let eta = self.fibre.eta;
        let (sine, cosine) = (out.along.x, out.along.y.max(1e-6));
        let outside = out.around - FRAC_PI_2;
        // Compute the effective index of a cross-section of the fibre. The sine outside is minus
        // the cosine of the angle from y.
        let across = (eta * eta - sine * sine).max(1e-12).sqrt() / cosine;
        let sine_inside = (-wo.y / cosine / across).clamp(-1.0, 1.0);
        let cosine_inside = (1.0 - sine_inside * sine_inside).sqrt();
        let cosine_along = (1.0 - sine * sine / (eta * eta)).max(1e-6).sqrt();
        let through = (self.absorption * (-2.0 * cosine_inside / cosine_along)).map(fp::exp);
        let mirrored = fresnel::dielectric(wo.z.clamp(0.0, 1.0), eta);
        let once = (1.0 - mirrored) * (1.0 - mirrored) * through;
        let inside = mirrored * through;
        let rest = inside * inside / (Spectrum::ONE - inside).max(Spectrum::splat(1e-6));
        let shares = [Spectrum::splat(mirrored), once, once * inside, once * rest];
        let sampling_weights = shares.map(lane_sum);
        PathLobes {
            shares,
            sampling_weights,
            total: sampling_weights.iter().sum(),
            angles: [outside, fp::asin(sine_inside)],
        }
    }

    /// Returns the pdf of a path, per unit of the sine along the fibre and per radian around it.
    fn density(&self, path: usize, paths: &PathLobes, out: &FibreDirection, incident: &FibreDirection) -> f32 {
        let along = longitudinal(self.fibre.variances[path], self.fibre.tilted(path, out), incident.along);
        if path == LAST_PATH {
            return along / TAU;
        }
        let off = incident.around - out.around - paths.turn(path);
        along * self.fibre.spread.density(off - TAU * (off / TAU).round())
    }
}

impl Scatter for Hair<'_> {
    #[inline]
    fn kind(&self) -> LobeKind {
        LobeKind { is_fibre: true, ..LobeKind::DIFFUSE.transmitting() }
    }

    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        let (out, incident) = (FibreDirection::of(wo), FibreDirection::of(wi));
        let paths = self.path_lobes(wo, &out);
        let (mut value, mut density) = (Spectrum::ZERO, 0.0);
        for path in 0..PATHS {
            let lobe_value = self.density(path, &paths, &out, &incident);
            value += paths.shares[path] * lobe_value;
            density += paths.sampling_weights[path] * lobe_value;
        }
        (value, density / paths.total)
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<LobeSample> {
        let out = FibreDirection::of(wo);
        let paths = self.path_lobes(wo, &out);
        let (mut rest, mut path) = (choice * paths.total, 0);
        while path < LAST_PATH && rest >= paths.sampling_weights[path] {
            rest -= paths.sampling_weights[path];
            path += 1;
        }
        // Reuse the remainder of `choice`, which is again uniformly distributed.
        let again = (rest / paths.sampling_weights[path]).clamp(0.0, 1.0 - f32::EPSILON * 0.5);
        let (turned, variance) = (self.fibre.tilted(path, &out), self.fibre.variances[path]);
        // Sample the angle to the mirror direction on a sphere.
        let cosine = 1.0 + variance * fp::ln((u.x + (1.0 - u.x) * fp::exp(-2.0 / variance)).max(f32::MIN_POSITIVE));
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let beside = fp::sin_cos_turn(u.y).1;
        let along = (sine * beside * turned.y - cosine * turned.x).clamp(-1.0, 1.0);
        let turn = match path {
            LAST_PATH => TAU * again,
            _ => paths.turn(path) + self.fibre.spread.sample(again),
        };
        let (sin, cos) = fp::sin_cos_turn((out.around + turn) / TAU);
        let across = (1.0 - along * along).max(0.0).sqrt();
        Some(LobeSample { wi: Vec3::new(along, across * cos, across * sin), value: Spectrum::ONE })
    }
}

/// Returns the longitudinal scattering, which is a distribution on the sphere around the mirror
/// direction that is averaged around the fibre. Both directions are given by their sine and cosine.
fn longitudinal(variance: f32, out: Vec2, incident: Vec2) -> f32 {
    let [out, incident] = [out.as_dvec2(), incident.as_dvec2()];
    // This is 1 minus the cosine of the angle to the mirror cone.
    let below = (1.0 - (incident.y * out.y - incident.x * out.x)) as f32;
    let height = variance * (1.0 - fp::exp(-2.0 / variance));
    bessel((incident.y * out.y) as f32 / variance) * fp::exp(-below / variance) / height
}

/// Returns the modified Bessel function of the first kind and order 0, divided by e^x, for x >= 0.
///
/// Source: Abramowitz and Stegun, *Handbook of Mathematical Functions*, 9.8.1 and 9.8.2.
fn bessel(x: f32) -> f32 {
    const NEAR: [f32; 7] = [1.0, 3.515_623, 3.089_942_5, 1.206_749_2, 0.265_973_2, 0.036_076_8, 0.004_581_3];
    const FAR: [f32; 9] = [
        0.398_942_3,
        0.013_285_92,
        0.002_253_19,
        -0.001_575_65,
        0.009_162_81,
        -0.020_577_06,
        0.026_355_37,
        -0.016_476_33,
        0.003_923_77,
    ];
    let sum = |c: &[f32], x: f32| c.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let t = x / 3.75;
    if t < 1.0 { sum(&NEAR, t * t) * fp::exp(-x) } else { sum(&FAR, 1.0 / t) / x.sqrt() }
}

/// Logistic distribution truncated to [-pi, pi], for the azimuthal scattering of hair. The logistic
/// distribution is close to a normal distribution, but cheap to sample.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Logistic {
    scale: f32,
    /// Probability of a value below -pi, and probability of a value between -pi and pi.
    below: f32,
    inside: f32,
}

impl Logistic {
    fn new(scale: f32) -> Self {
        let below = 1.0 / (1.0 + fp::exp(PI / scale));
        Logistic { scale, below, inside: 1.0 - 2.0 * below }
    }

    fn density(&self, x: f32) -> f32 {
        let e = fp::exp(-x.abs() / self.scale);
        e / (self.scale * (1.0 + e) * (1.0 + e) * self.inside)
    }

    fn sample(&self, u: f32) -> f32 {
        let u = (self.below + u * self.inside).clamp(f32::MIN_POSITIVE, 1.0 - f32::EPSILON * 0.5);
        (-self.scale * fp::ln(1.0 / u - 1.0)).clamp(-PI, PI)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::warp;
    use crate::math::random::Random;

    fn fibre(longitudinal_roughness: f32, azimuthal_roughness: f32) -> Fibre {
        let absorption = Some(Color::ZERO);
        Fibre::new(&HairMaterial { absorption, longitudinal_roughness, azimuthal_roughness, ..Default::default() })
    }

    /// Returns the integral over all directions, estimated from uniform samples.
    fn over_all(random: &mut Random, value: impl Fn(Vec3) -> f32) -> f64 {
        const MANY: u32 = 200_000;
        let one = |_| f64::from(value(warp::sphere(Vec2::new(random.unit(), random.unit()))));
        (0..MANY).map(one).sum::<f64>() / f64::from(MANY) * 4.0 * f64::from(PI)
    }

    #[test]
    fn lossless_fibre_scatters_all_light() {
        let mut random = Random(81);
        for (along, around) in [(0.3, 0.3), (0.25, 0.7), (0.6, 0.4), (1.0, 1.0)] {
            let fibre = fibre(along, around);
            for (cosine, turn) in [(1.0, 0.0), (0.8, 0.1), (0.4, 0.2), (0.4, 0.55), (0.1, 0.9)] {
                let (hair, wo) = (fibre.lobe(&Lanes::Rgb), warp::polar(cosine, turn));
                let white = over_all(&mut random, |wi| hair.eval(wo, wi).0.x);
                let density = over_all(&mut random, |wi| hair.eval(wo, wi).1);
                assert!((white - 1.0).abs() < 0.03 && (density - 1.0).abs() < 0.03, "{along} {around} {wo}: {white}");
            }
        }
    }

    #[test]
    fn bessel_agrees_with_its_series() {
        for i in 0..120_u8 {
            let x = 0.1 * f32::from(i);
            let (mut term, mut sum) = (1.0, 1.0);
            for k in 1..40_u8 {
                term *= 0.25 * f64::from(x) * f64::from(x) / (f64::from(k) * f64::from(k));
                sum += term;
            }
            let exact = sum / libm::exp(f64::from(x));
            assert!((f64::from(bessel(x)) - exact).abs() < 1e-6, "{x}: {} {exact}", bessel(x));
        }
    }

    #[test]
    fn hair_colour_round_trips_and_melanin_sets_absorption() {
        let color = Color::new(0.6, 0.3, 0.1);
        let of = |m: HairMaterial| Fibre::new(&m).lobe(&Lanes::Rgb).absorption.truncate();
        let by_color = of(HairMaterial { color: Some(color), azimuthal_roughness: 0.0, ..Default::default() });
        let absorption = Some(by_color);
        let again = Fibre::new(&HairMaterial { absorption, ..Default::default() }).color();
        assert!((again - color).abs().max_element() < 1e-4, "{again}");
        let brown = of(HairMaterial { eumelanin: 2.0, pheomelanin: 1.0, ..Default::default() });
        assert!((brown - Color::new(1.025, 1.794, 3.79)).abs().max_element() < 1e-4, "{brown}");
    }

    #[test]
    fn smooth_fibre_reflects_into_a_cone() {
        // Light leaves along Marschner's cone. The longitudinal angle of this light is that at
        // which it arrives, minus the tilt of the scales.
        let m = HairMaterial { longitudinal_roughness: 0.05, scale_tilt: 3.0, ..Default::default() };
        let fibre = Fibre::new(&HairMaterial { absorption: Some(Color::splat(1e3)), ..m });
        let hair = fibre.lobe(&Lanes::Rgb);
        let wo = Vec3::new(0.5, 0.0, 0.75_f32.sqrt());
        let mut random = Random(82);
        let mut mean = 0.0;
        for _ in 0..2_000 {
            let mut unit = || random.unit();
            let wi = hair.sample(wo, unit(), Vec2::new(unit(), unit())).unwrap().wi;
            mean += f64::from(fp::asin(wi.x).to_degrees()) / 2_000.0;
        }
        // The view angle of 30 degrees is turned back by twice the tilt.
        assert!((mean + 24.0).abs() < 0.5, "{mean}");
    }
}
