//! Fresnel reflectance of smooth dielectrics, metals and thin sheets.

use crate::math::{Color, Vec3, fp};
use crate::spectrum::{Spectrum, SpectrumSource, under_daylight};

/// Returns the reflectance of a boundary between two dielectrics for unpolarised light. `cosine` is
/// the cosine of the angle between the light and the normal, from 0 to 1. `eta` is the index behind
/// the boundary, relative to the index in front of it.
///
/// Source: Fresnel's equations, as in *Physically Based Rendering*, 4th edition, section 9.3.5.
pub fn dielectric(cosine: f32, eta: f32) -> f32 {
    let [parallel, perpendicular] = polarised(cosine, eta);
    0.5 * (parallel + perpendicular)
}

/// Returns the reflectance for light polarised parallel and perpendicular to the plane of
/// incidence.
fn polarised(cosine: f32, eta: f32) -> [f32; 2] {
    let sine2 = (1.0 - cosine * cosine).max(0.0) / (eta * eta);
    if sine2 >= 1.0 {
        return [1.0; 2];
    }
    let behind = (1.0 - sine2).sqrt();
    let parallel = (eta * cosine - behind) / (eta * cosine + behind);
    let perpendicular = (cosine - eta * behind) / (cosine + eta * behind);
    [parallel * parallel, perpendicular * perpendicular]
}

/// Returns the colour that a metal reflects at normal incidence, and the colour at cosine 1/7. The
/// light arrives in a medium of index `outside`.
pub fn conductor_colors(eta: &SpectrumSource, k: &SpectrumSource, outside: f32) -> [Color; 2] {
    [1.0, 1.0 / 7.0].map(|cosine| match (eta, k) {
        (SpectrumSource::Rgb(n), SpectrumSource::Rgb(k)) => {
            Vec3::from_array(std::array::from_fn(|i| conductor(cosine, n[i] / outside, k[i] / outside)))
        }
        _ => under_daylight(|nm| conductor(cosine, eta.at(nm) / outside, k.at(nm) / outside)),
    })
}

/// Returns the reflectance of a metal with the complex index n + i k for unpolarised light.
///
/// Source: Fresnel's equations, as in *Physically Based Rendering*, 4th edition, section 9.3.6.
pub fn conductor(cosine: f32, n: f32, k: f32) -> f32 {
    let (c, n, k) = (f64::from(cosine), f64::from(n), f64::from(k));
    let sine2 = 1.0 - c * c;
    let t = n * n - k * k - sine2;
    let both = (t * t + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (both + t)).max(0.0).sqrt();
    let across = (both + c * c - 2.0 * c * a) / (both + c * c + 2.0 * c * a);
    let (sum, twice) = (c * c * both + sine2 * sine2, 2.0 * c * a * sine2);
    let share = 0.5 * across * (1.0 + (sum - twice) / (sum + twice));
    if share.is_finite() { share as f32 } else { 1.0 }
}

/// Thin dielectric sheet, such as a window pane, with internal reflections between its faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// Index of the sheet, relative to the medium around it.
    pub eta: f32,
    /// Transmittance of the interior at normal incidence, or `None` for a sheet without a depth.
    pub inside: Option<Spectrum>,
}

impl Sheet {
    /// Returns the reflectance and transmittance at a cosine, including all internal reflections.
    ///
    /// Without a depth, the reflectance is 2 F / (1 + F) and the transmittance is the remainder. As
    /// in other renderers, these formulas assume unpolarised light at each face. With a depth,
    /// light keeps its polarisation between the faces, and more light is absorbed at oblique
    /// angles.
    pub fn at(&self, cosine: f32) -> (Spectrum, Spectrum) {
        let Sheet { eta, inside } = *self;
        let Some(inside) = inside else {
            let once = dielectric(cosine, eta);
            let reflected = Spectrum::splat(2.0 * once / (1.0 + once));
            return (reflected, Spectrum::ONE - reflected);
        };
        let left = transmittance_at(inside, cosine, eta);
        let [parallel, perpendicular] = polarised(cosine, eta).map(|face| {
            let face = Spectrum::splat(face);
            sum_reflections(face, face, left)
        });
        (0.5 * (parallel.0 + perpendicular.0), 0.5 * (parallel.1 + perpendicular.1))
    }

    /// Returns the reflectance and transmittance of a sheet for unpolarised light, where `face` is
    /// the reflectance of the front face.
    pub fn with_front_face(&self, face: Spectrum, cosine: f32) -> (Spectrum, Spectrum) {
        let left = self.inside.map_or(Spectrum::ONE, |inside| transmittance_at(inside, cosine, self.eta));
        sum_reflections(face, Spectrum::splat(dielectric(cosine, self.eta)), left)
    }
}

/// Returns the transmittance of the interior at an oblique angle, at which the path through the
/// interior is longer.
fn transmittance_at(inside: Spectrum, cosine: f32, eta: f32) -> Spectrum {
    let behind = (1.0 - (1.0 - cosine * cosine).max(0.0) / (eta * eta)).max(0.0).sqrt();
    inside.max(Spectrum::ZERO).map(|left| if left < 1.0 { fp::pow(left, 1.0 / behind.max(1e-3)) } else { 1.0 })
}

/// Returns the reflectance and transmittance of two parallel faces, summed over all internal
/// reflections. The share `left` of the light remains after each pass through the interior.
fn sum_reflections(front: Spectrum, back: Spectrum, left: Spectrum) -> (Spectrum, Spectrum) {
    let entered = Spectrum::ONE - front;
    let again = (Spectrum::ONE - front * back * left * left).max(Spectrum::splat(1e-6));
    (front + entered * entered * back * left * left / again, entered * (Spectrum::ONE - back) * left / again)
}

/// Returns the cosine-weighted mean of [`dielectric`] over the hemisphere.
///
/// Source: a fit by d'Eon, *A Hitchhiker's Guide to Multiple Scattering*. The converse of this fit
/// is used for light from inside. The error is at most 0.6 % for indices from 1 to 3.
pub fn diffuse(eta: f32) -> f32 {
    match eta >= 1.0 {
        true => fp::ln((10_893.0 * eta - 1_438.2) / (-774.4 * eta * eta + 10_212.0 * eta + 1.0)),
        // By conservation of étendue, internal reflection follows from external reflection.
        false => 1.0 - eta * eta * (1.0 - diffuse(1.0 / eta)),
    }
    .clamp(0.0, 1.0)
}

/// Returns the reflectance at normal incidence of a boundary of relative index `eta`.
pub fn ratio_squared(eta: f32) -> f32 {
    let ratio = (eta - 1.0) / (eta + 1.0);
    ratio * ratio
}

/// Returns the weight of white at a cosine in Schlick's approximation, (1 - cosine)^5.
pub fn schlick_weight(cosine: f32) -> f32 {
    let m = (1.0 - cosine).clamp(0.0, 1.0);
    m * m * m * m * m
}

/// Version of [`schlick_weight`] for a boundary of relative index `eta`. Below 1, the angle behind
/// the boundary counts.
pub fn schlick_weight_at(cosine: f32, eta: f32) -> f32 {
    if eta > 1.0 {
        return schlick_weight(cosine);
    }
    schlick_weight((1.0 - (1.0 - cosine * cosine) / (eta * eta)).max(0.0).sqrt())
}

/// Reflectance of the facets of Disney's material: a mixture of Fresnel's equations with Schlick's
/// approximation, for metal and tinted reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisneyFresnel {
    /// Relative index of refraction.
    pub eta: f32,
    /// Share of the dielectric that is not tinted.
    pub plain: f32,
    /// Share of the rest.
    pub schlick: f32,
    /// Reflectance of the rest at normal incidence, times its share.
    pub f0: Spectrum,
}

impl DisneyFresnel {
    /// Returns the reflectance at a cosine.
    pub fn at(&self, cosine: f32) -> Spectrum {
        let weight = schlick_weight_at(cosine, self.eta);
        let plain = if self.plain > 0.0 { self.plain * dielectric(cosine, self.eta) } else { 0.0 };
        Spectrum::splat(plain + self.schlick * weight) + self.f0 * (1.0 - weight)
    }
}

/// Returns the relative index of a boundary whose reflectance at normal incidence is `r0`.
pub fn ior_of_reflectance(r0: f32) -> f32 {
    let root = r0.clamp(0.0, 0.98).sqrt();
    (1.0 + root) / (1.0 - root)
}

/// Returns the reflectance given by Schlick's approximation at 82 degrees (cosine 1/7) if the
/// colour at normal incidence is `f0`. [`F82`] applies its tint at this angle.
pub fn schlick_82(f0: Color) -> Color {
    f0 + (Color::ONE - f0) * fp::pow(6.0 / 7.0, 5.0)
}

/// Reflectance curve of a metal, defined by its colour at normal incidence and a tint at 82
/// degrees.
///
/// Source: Kutz, Hasan and Edmondson, *Novel aspects of the Adobe Standard Material*, 2021, section
/// 2.3, and the section on metal in the OpenPBR specification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct F82 {
    f0: Spectrum,
    /// Amount that is subtracted from Schlick's curve, in units of cos (1 - cos)^6.
    dip: Spectrum,
}

impl F82 {
    /// Curve of a metal that reflects all light at every angle.
    pub const WHITE: F82 = F82 { f0: Spectrum::ONE, dip: Spectrum::ZERO };

    /// Creates the curve of a metal with a colour at normal incidence and a tint.
    pub fn new(f0: Spectrum, tint: Spectrum) -> Self {
        const COSINE: f32 = 1.0 / 7.0;
        let rest = 1.0 - COSINE;
        let (power5, power6) = (rest * rest * rest * rest * rest, rest * rest * rest * rest * rest * rest);
        let schlick = f0 + (Spectrum::ONE - f0) * power5;
        F82 { f0, dip: schlick * (Spectrum::ONE - tint) / (COSINE * power6) }
    }

    /// Returns the reflectance at a cosine from 0 to 1.
    pub fn at(&self, cosine: f32) -> Spectrum {
        let rest = (1.0 - cosine).clamp(0.0, 1.0);
        let power5 = rest * rest * rest * rest * rest;
        (self.f0 + (Spectrum::ONE - self.f0) * power5 - self.dip * cosine * power5 * rest)
            .clamp(Spectrum::ZERO, Spectrum::ONE)
    }
}

/// Reflectance curve of a metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MetalCurve {
    /// Curve through two colours.
    F82(F82),
    /// Fresnel's equations for the complex index n + i k, times a tint.
    Index {
        /// Real part of the index.
        n: Spectrum,
        /// Imaginary part of the index.
        k: Spectrum,
        /// Factor at all angles.
        tint: Spectrum,
    },
}

impl MetalCurve {
    /// Returns the reflectance at a cosine from 0 to 1.
    pub fn at(&self, cosine: f32) -> Spectrum {
        match self {
            MetalCurve::F82(curve) => curve.at(cosine),
            MetalCurve::Index { n, k, tint } => {
                let [n, k] = [n.to_array(), k.to_array()];
                *tint * Spectrum::from_array(std::array::from_fn(|i| conductor(cosine, n[i], k[i])))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conductor_agrees_with_fresnel_equations() {
        // At normal incidence, the reflectance is ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2). For k = 0,
        // the equations for dielectrics apply.
        for (n, k) in [(0.2, 3.4), (1.5, 0.0), (2.9, 3.1)] {
            let right = ((n - 1.0_f32) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
            assert!((conductor(1.0, n, k) - right).abs() < 1e-6);
        }
        for cosine in [0.05, 0.3, 0.8] {
            assert!((conductor(cosine, 1.5, 0.0) - dielectric(cosine, 1.5)).abs() < 1e-6);
        }
    }

    #[test]
    fn conductor_colours_agree_for_curve_and_rgb() {
        // Gold is given by three wavelength bands and by three RGB values.
        let curve = |c: [f32; 3]| {
            let rows = [[300.0, c[2]], [489.0, c[2]], [490.0, c[1]], [579.0, c[1]], [580.0, c[0]], [900.0, c[0]]];
            SpectrumSource::Curve(rows.to_vec())
        };
        let rgb = |c: [f32; 3]| SpectrumSource::Rgb(Vec3::from_array(c));
        let (n, k) = ([0.2, 0.4, 1.5], [3.4, 2.4, 1.7]);
        let [f0, f82] = conductor_colors(&curve(n), &curve(k), 1.0);
        let [g0, g82] = conductor_colors(&rgb(n), &rgb(k), 1.0);
        assert!(
            (f0 - g0).abs().max_element() < 0.12 && (f82 - g82).abs().max_element() < 0.12,
            "{f0} {g0} {f82} {g82}"
        );
    }
}
