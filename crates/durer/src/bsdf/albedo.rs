//! How much light rough surfaces give back in all directions together, as tables.
//!
//! One reflection off a rough surface loses what would have been reflected a second time. Dividing
//! by these tables gives it back, so that a surface that absorbs nothing stays white. Source:
//! Turquin, *Practical multiple scattering compensation for microfacet models*, 2019.

use super::fresnel;
use super::lobe::fuzz;
use super::microfacet::Ggx;
use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;
use rayon::prelude::*;
use std::sync::LazyLock;

/// Rows and columns of a table.
const SIZE: usize = 32;

/// Points of each integral.
const POINTS: u32 = 1024;

/// A function of a cosine and a roughness, both from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
struct Table(Vec<f32>);

impl Table {
    fn new(value: impl Fn(f32, f32) -> f32 + Sync) -> Self {
        let step = |i: usize| i as f32 / (SIZE - 1) as f32;
        // Cosines are closer together towards grazing directions, where the functions change most.
        let entry = |i: usize| value((step(i % SIZE) * step(i % SIZE)).max(1e-4), step(i / SIZE));
        Table((0..SIZE * SIZE).into_par_iter().map(entry).collect())
    }

    /// Linear between the entries.
    fn at(&self, cosine: f32, roughness: f32) -> f32 {
        let place = |x: f32| {
            let x = x.clamp(0.0, 1.0) * (SIZE - 1) as f32;
            let i = (x as usize).min(SIZE - 2);
            (i, x - i as f32)
        };
        let ((i, a), (j, b)) = (place(cosine.max(0.0).sqrt()), place(roughness));
        let row = |j: usize| self.0[j * SIZE + i] * (1.0 - a) + self.0[j * SIZE + i + 1] * a;
        row(j) * (1.0 - b) + row(j + 1) * b
    }
}

/// Points that fill the unit square evenly: the sequence R2.
///
/// Source: Martin Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences*, 2018.
fn points() -> impl Iterator<Item = Vec2> {
    // Steps of 1/p and 1/p^2 in units of 2^-32, p being the root of p^3 = p + 1.
    let unit = |i: u32, step: u32| ((i.wrapping_mul(step) >> 8) as f32 + 0.5) / 16_777_216.0;
    (0..POINTS).map(move |i| Vec2::new(unit(i, 3_242_174_889), unit(i, 2_447_445_414)))
}

fn mean(value: impl Fn(Vec2) -> f32) -> f32 {
    points().map(|u| f64::from(value(u))).sum::<f64>() as f32 / POINTS as f32
}

fn direction(cosine: f32) -> Vec3 {
    Vec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine)
}

fn isotropic(roughness: f32) -> Ggx {
    Ggx::new(roughness, 0.0).clamped()
}

/// What a single reflection off GGX gives back where every facet reflects all.
pub fn ggx(cosine: f32, roughness: f32) -> f32 {
    static TABLE: LazyLock<Table> = LazyLock::new(|| {
        Table::new(|cosine, roughness| {
            let (ggx, wo) = (isotropic(roughness), direction(cosine));
            mean(|u| {
                let h = ggx.sample_visible(wo, u);
                let wi = 2.0 * wo.dot(h) * h - wo;
                if wi.z > 0.0 { ggx.masking_shadowing(wo, wi) / ggx.masking(wo) } else { 0.0 }
            })
        })
    });
    TABLE.at(cosine, roughness)
}

/// What fuzz of white fibres gives back.
pub fn fuzz(cosine: f32, roughness: f32) -> f32 {
    static TABLE: LazyLock<Table> = LazyLock::new(|| {
        Table::new(|cosine, roughness| {
            let wo = direction(cosine);
            mean(|u| {
                let wi = super::warp::polar(u.x, u.y);
                // Evenly spread directions: density 1 / (2 pi).
                2.0 * std::f32::consts::PI * fuzz::value(roughness, wo, wi) * wi.z
            })
        })
    });
    TABLE.at(cosine, roughness)
}

/// A boundary of two dielectrics of one relative index.
#[derive(Clone, Debug, PartialEq)]
pub struct Dielectric {
    /// The index inside over that outside.
    pub ior: f32,
    /// Reflected from outside and from inside; and all that is not lost.
    tables: [[Table; 2]; 2],
}

impl Dielectric {
    /// Works out the tables of an index.
    pub fn new(ior: f32) -> Self {
        let tables = [ior, 1.0 / ior].map(|eta| {
            [false, true].map(|all| {
                Table::new(|cosine, roughness| {
                    let (ggx, wo) = (isotropic(roughness), direction(cosine));
                    mean(|u| single(ggx, wo, eta, u, all))
                })
            })
        });
        Dielectric { ior, tables }
    }

    /// The share that one reflection gives back, of what is not lost; from inside or from outside.
    pub fn reflected(&self, inside: bool, cosine: f32, roughness: f32) -> f32 {
        let [reflected, all] = &self.tables[usize::from(inside)];
        (reflected.at(cosine, roughness) / all.at(cosine, roughness)).min(1.0)
    }

    /// What multiplies one reflection or refraction, so that nothing is lost.
    pub fn gain(&self, inside: bool, cosine: f32, roughness: f32) -> f32 {
        1.0 / self.tables[usize::from(inside)][1].at(cosine, roughness)
    }
}

/// The mean over the facets of a rough surface that are seen, of what each does at a cosine: by few
/// points, where there are too many kinds of surfaces for tables.
pub fn over_facets(cosine: f32, roughness: f32, value: impl Fn(f32) -> Spectrum) -> Spectrum {
    const FEW: usize = 16;
    let (ggx, wo) = (isotropic(roughness), direction(cosine));
    let (mut sum, mut all) = (Spectrum::ZERO, 0.0);
    for u in points().take(FEW) {
        let h = ggx.sample_visible(wo, u);
        let wi = 2.0 * wo.dot(h) * h - wo;
        let visible = if wi.z > 0.0 { ggx.masking_shadowing(wo, wi) } else { 0.0 };
        (sum, all) = (sum + visible * value(wo.dot(h).max(0.0)), all + visible);
    }
    if all > 0.0 { sum / all } else { value(cosine) }
}

/// One facet's part in what is reflected, or in all that goes on.
fn single(ggx: Ggx, wo: Vec3, eta: f32, u: Vec2, all: bool) -> f32 {
    let h = ggx.sample_visible(wo, u);
    let cosine = wo.dot(h).max(0.0);
    let reflected = fresnel::dielectric(cosine, eta);
    let visible = |wi: Vec3| ggx.masking_shadowing(wo, wi) / ggx.masking(wo);
    let up = 2.0 * cosine * h - wo;
    let mut sum = if up.z > 0.0 { reflected * visible(up) } else { 0.0 };
    if all && reflected < 1.0 {
        let behind = (1.0 - (1.0 - cosine * cosine) / (eta * eta)).max(0.0).sqrt();
        let down = (cosine / eta - behind) * h - wo / eta;
        sum += if down.z < 0.0 { (1.0 - reflected) * visible(down) } else { 0.0 };
    }
    sum
}
