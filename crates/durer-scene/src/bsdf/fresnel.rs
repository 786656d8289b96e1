//! How much light a smooth boundary reflects.

use crate::math::{Color, fp};
use crate::spectrum::Spectrum;

/// The share of unpolarised light that a boundary of two dielectrics reflects. `cosine` is that of
/// the light's way to the normal, from 0 to 1; `eta` is the index behind the boundary over the
/// index before it.
///
/// Source: Fresnel's equations, as in *Physically Based Rendering*, 4th edition, section 9.3.5.
pub fn dielectric(cosine: f32, eta: f32) -> f32 {
    let [parallel, perpendicular] = polarised(cosine, eta);
    0.5 * (parallel + perpendicular)
}

/// The same of light that is polarised along the plane of incidence, and across it.
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

/// A thin sheet of a dielectric: light is reflected to and fro in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// The index inside over that around it.
    pub eta: f32,
    /// What is left of light that crosses its inside at right angles, if the sheet has a depth.
    pub inside: Option<Spectrum>,
}

impl Sheet {
    /// What it reflects and what goes through at a cosine, with all ways to and fro inside.
    ///
    /// Without a depth that is 2 F / (1 + F) and the rest, of unpolarised light at each face, as
    /// others have it. With a depth light stays as it was polarised, and loses more at an angle.
    pub fn at(&self, cosine: f32) -> (Spectrum, Spectrum) {
        let Sheet { eta, inside } = *self;
        let Some(inside) = inside else {
            let once = dielectric(cosine, eta);
            let reflected = Spectrum::splat(2.0 * once / (1.0 + once));
            return (reflected, Spectrum::ONE - reflected);
        };
        let left = left_of(inside, cosine, eta);
        let [parallel, perpendicular] = polarised(cosine, eta).map(|face| {
            let face = Spectrum::splat(face);
            to_and_fro(face, face, left)
        });
        (0.5 * (parallel.0 + perpendicular.0), 0.5 * (parallel.1 + perpendicular.1))
    }

    /// The same where one face reflects otherwise, and light as a whole.
    pub fn faced(&self, face: Spectrum, cosine: f32) -> (Spectrum, Spectrum) {
        let left = self.inside.map_or(Spectrum::ONE, |inside| left_of(inside, cosine, self.eta));
        to_and_fro(face, Spectrum::splat(dielectric(cosine, self.eta)), left)
    }
}

/// What is left of light that crosses a sheet at an angle: its way inside is longer.
fn left_of(inside: Spectrum, cosine: f32, eta: f32) -> Spectrum {
    let behind = (1.0 - (1.0 - cosine * cosine).max(0.0) / (eta * eta)).max(0.0).sqrt();
    inside.max(Spectrum::ZERO).map(|left| if left < 1.0 { fp::pow(left, 1.0 / behind.max(1e-3)) } else { 1.0 })
}

/// What two faces reflect and let through, by the sum over all ways between them, each of which
/// leaves a share.
fn to_and_fro(front: Spectrum, back: Spectrum, left: Spectrum) -> (Spectrum, Spectrum) {
    let entered = Spectrum::ONE - front;
    let again = (Spectrum::ONE - front * back * left * left).max(Spectrum::splat(1e-6));
    (front + entered * entered * back * left * left / again, entered * (Spectrum::ONE - back) * left / again)
}

/// The mean of [`dielectric`] over all directions by their cosine.
///
/// Source: a fit by d'Eon, *A Hitchhiker's Guide to Multiple Scattering*, and its converse for
/// light from inside; good to 0.6 % for indices from 1 to 3.
pub fn diffuse(eta: f32) -> f32 {
    match eta >= 1.0 {
        true => fp::ln((10_893.0 * eta - 1_438.2) / (-774.4 * eta * eta + 10_212.0 * eta + 1.0)),
        // Conservation of étendue: what is reflected inside follows from what is reflected outside.
        false => 1.0 - eta * eta * (1.0 - diffuse(1.0 / eta)),
    }
    .clamp(0.0, 1.0)
}

/// The index over that of what is around it whose boundary reflects a share `r0` at right angles.
pub fn ior_of_reflectance(r0: f32) -> f32 {
    let root = r0.clamp(0.0, 0.98).sqrt();
    (1.0 + root) / (1.0 - root)
}

/// What Schlick's curve from a colour at right angles has at 82 degrees, whose cosine is 1/7: there
/// [`F82`] has its tint.
pub fn schlick_82(f0: Color) -> Color {
    f0 + (Color::ONE - f0) * fp::pow(6.0 / 7.0, 5.0)
}

/// What a metal reflects: its colour at right angles, and a tint at 82 degrees.
///
/// Source: Kutz, Hasan and Edmondson, *Novel aspects of the Adobe Standard Material*, 2021, section
/// 2.3; OpenPBR, Metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct F82 {
    f0: Spectrum,
    /// How much is taken from Schlick's curve, in units of cos (1 - cos)^6.
    dip: Spectrum,
}

impl F82 {
    /// All of every colour, from everywhere.
    pub const WHITE: F82 = F82 { f0: Spectrum::ONE, dip: Spectrum::ZERO };

    /// From the colour at right angles and the tint.
    pub fn new(f0: Spectrum, tint: Spectrum) -> Self {
        const COSINE: f32 = 1.0 / 7.0;
        let rest = 1.0 - COSINE;
        let (power5, power6) = (rest * rest * rest * rest * rest, rest * rest * rest * rest * rest * rest);
        let schlick = f0 + (Spectrum::ONE - f0) * power5;
        F82 { f0, dip: schlick * (Spectrum::ONE - tint) / (COSINE * power6) }
    }

    /// At a cosine from 0 to 1.
    pub fn at(&self, cosine: f32) -> Spectrum {
        let rest = (1.0 - cosine).clamp(0.0, 1.0);
        let power5 = rest * rest * rest * rest * rest;
        (self.f0 + (Spectrum::ONE - self.f0) * power5 - self.dip * cosine * power5 * rest)
            .clamp(Spectrum::ZERO, Spectrum::ONE)
    }
}
