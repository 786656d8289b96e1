//! Tables of the directional albedo of rough surfaces.
//!
//! A single-scattering microfacet model loses the light that would be reflected more than once.
//! Dividing by the values in these tables restores this light, so that a lossless surface stays
//! white. Source: Turquin, *Practical multiple scattering compensation for microfacet models*,
//! 2019.
//!
//! [`super::Tables::prepare`] computes the tables that the materials of a world need, on all
//! threads, when the world is compiled. Other tables are computed on first use.

mod anisotropic;

use super::fresnel;
use super::microfacet::{Ggx, fuzz_value};
use crate::material::principled::Facets;
use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;
use rayon::prelude::*;
use std::sync::OnceLock;

/// Number of rows and number of columns in a table.
const SIZE: usize = 32;

/// Number of sample points for each integral.
const POINTS: u32 = 1024;

/// Table of a function of a cosine and a roughness, such as a directional albedo. Both arguments
/// are in [0, 1].
#[derive(Clone, Debug, PartialEq)]
struct Table(Vec<f32>);

impl Table {
    fn new(value: impl Fn(f32, f32) -> f32 + Sync) -> Self {
        let step = |i: usize| i as f32 / (SIZE - 1) as f32;
        // Place more cosines near grazing directions, where the functions change most.
        let entry = |i: usize| value((step(i % SIZE) * step(i % SIZE)).max(1e-4), step(i / SIZE));
        Table((0..SIZE * SIZE).into_par_iter().map(entry).collect())
    }

    /// Returns the value at a cosine and a roughness, interpolated linearly.
    fn at(&self, cosine: f32, roughness: f32) -> f32 {
        let ((i, a), (j, b)) = (table_position(cosine.max(0.0).sqrt()), table_position(roughness));
        let row = |j: usize| self.0[j * SIZE + i] * (1.0 - a) + self.0[j * SIZE + i + 1] * a;
        row(j) * (1.0 - b) + row(j + 1) * b
    }
}

/// Returns the index of the table entry below `x`, which is in [0, 1], and the fraction of the way
/// to the next entry.
fn table_position(x: f32) -> (usize, f32) {
    table_position_in(x, SIZE)
}

/// Version of [`table_position`] for a table of `size` entries.
fn table_position_in(x: f32, size: usize) -> (usize, f32) {
    let x = x.clamp(0.0, 1.0) * (size - 1) as f32;
    let i = (x as usize).min(size - 2);
    (i, x - i as f32)
}

/// Returns the cosine-weighted mean of `value` over the hemisphere.
fn mean_by_cosine(value: impl Fn(f32) -> f32) -> f32 {
    const STEPS: usize = 512;
    let at = |i: usize| (i as f32 + 0.5) / STEPS as f32;
    let sum: f64 = (0..STEPS).map(|i| f64::from(2.0 * at(i) * value(at(i)))).sum();
    (sum / STEPS as f64) as f32
}

/// Returns the value of `cell`, which is computed by `make` on first use.
///
/// No lock is held while `make` runs. If a lock were held, a waiting rayon thread could steal work
/// that needs the same value, and cause a deadlock. Concurrent callers therefore all compute the
/// value.
fn once<T>(cell: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    cell.get().unwrap_or_else(|| {
        let table = make();
        cell.get_or_init(|| table)
    })
}

/// Returns points that are evenly distributed in the unit square, from the R2 sequence.
///
/// Source: Martin Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences*, 2018.
fn points() -> impl Iterator<Item = Vec2> {
    points_of(POINTS)
}

/// Version of [`points`] for a given number of points.
fn points_of(count: u32) -> impl Iterator<Item = Vec2> {
    // The steps are 1/p and 1/p^2 in units of 2^-32, where p is the root of p^3 = p + 1.
    let unit = |i: u32, step: u32| ((i.wrapping_mul(step) >> 8) as f32 + 0.5) / 16_777_216.0;
    (0..count).map(move |i| Vec2::new(unit(i, 3_242_174_889), unit(i, 2_447_445_414)))
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

/// Returns the directional albedo of single scattering at a GGX surface whose facets reflect all
/// light.
pub fn ggx(cosine: f32, roughness: f32) -> f32 {
    static TABLE: OnceLock<Table> = OnceLock::new();
    let table = once(&TABLE, || {
        Table::new(|cosine, roughness| {
            let (ggx, wo) = (isotropic(roughness), direction(cosine));
            mean(|u| reflection_weight(ggx, wo, u))
        })
    });
    table.at(cosine, roughness)
}

/// Returns the weight of the reflection at one sampled facet that reflects all light.
fn reflection_weight(ggx: Ggx, wo: Vec3, u: Vec2) -> f32 {
    let h = ggx.sample_visible(wo, u);
    let wi = 2.0 * wo.dot(h) * h - wo;
    if wi.z > 0.0 { ggx.masking_shadowing(wo, wi) / ggx.masking(wo) } else { 0.0 }
}

/// Version of [`ggx`] that also accepts anisotropic surfaces. `roughness` is used only if the
/// surface is isotropic.
pub fn ggx_for(surface: Ggx, wo: Vec3, roughness: f32) -> f32 {
    static TABLE: OnceLock<anisotropic::Table> = OnceLock::new();
    match surface.is_isotropic() {
        true => ggx(wo.z, roughness),
        false => once(&TABLE, || anisotropic::Table::new(reflection_weight)).at(surface, wo),
    }
}

/// Returns the directional albedo of fuzz with white fibres.
pub fn fuzz(cosine: f32, roughness: f32) -> f32 {
    static TABLE: OnceLock<Table> = OnceLock::new();
    let table = once(&TABLE, || {
        Table::new(|cosine, roughness| {
            let wo = direction(cosine);
            mean(|u| {
                let wi = super::warp::polar(u.x, u.y);
                // Directions are uniform in the hemisphere, so the pdf is 1 / (2 pi).
                2.0 * std::f32::consts::PI * fuzz_value(roughness, wo, wi) * wi.z
            })
        })
    });
    table.at(cosine, roughness)
}

/// Boundary between two dielectrics with a given relative index. The albedo tables of the boundary
/// are computed on first use.
#[derive(Clone, Debug)]
pub struct DielectricAlbedo {
    /// Index of refraction inside, relative to the index outside.
    pub ior: f32,
    /// Facets of the boundary. With those of Mitsuba, light that is scattered several times between
    /// facets is lost; otherwise, it is reflected and refracted in the same proportion as the rest.
    pub facets: Facets,
    /// Cosine-weighted mean of the reflectance from outside, for a smooth boundary.
    smooth_mean: f32,
    /// Tables for light from outside and from inside. Each pair holds the share of light that is
    /// reflected and the share that is not lost.
    tables: OnceLock<[[Table; 2]; 2]>,
    /// Cosine-weighted mean of the reflectance from outside, for each roughness in the tables.
    means: OnceLock<Vec<f32>>,
    /// Share of light that is not lost, from outside and from inside, for anisotropic surfaces.
    anisotropic: OnceLock<[anisotropic::Table; 2]>,
}

impl PartialEq for DielectricAlbedo {
    fn eq(&self, other: &Self) -> bool {
        self.ior == other.ior && self.facets == other.facets
    }
}

impl DielectricAlbedo {
    /// Creates a boundary with the relative index `ior`. The tables of the boundary are computed on
    /// first use.
    pub fn new(ior: f32, facets: Facets) -> Self {
        let smooth_mean = mean_by_cosine(|cosine| fresnel::dielectric(cosine, ior));
        DielectricAlbedo {
            ior,
            facets,
            smooth_mean,
            tables: OnceLock::new(),
            means: OnceLock::new(),
            anisotropic: OnceLock::new(),
        }
    }

    /// Returns the tables for one side, which hold the share of light that is reflected and the
    /// share that is not lost.
    fn tables(&self, inside: bool) -> &[Table; 2] {
        let both = once(&self.tables, || {
            [self.ior, 1.0 / self.ior].map(|eta| {
                [false, true].map(|all| {
                    Table::new(|cosine, roughness| {
                        let (ggx, wo) = (isotropic(roughness).with(self.facets), direction(cosine));
                        mean(|u| facet_weight(ggx, wo, eta, u, all))
                    })
                })
            })
        });
        &both[usize::from(inside)]
    }

    /// True if the tables have been computed.
    #[cfg(any(test, feature = "testing"))]
    pub(crate) fn is_prepared(&self) -> bool {
        self.tables.get().is_some()
    }

    /// Returns the reflected share of the light that is not lost by single scattering, for light
    /// from inside or from outside.
    pub fn reflected(&self, inside: bool, cosine: f32, roughness: f32) -> f32 {
        let [reflected, all] = self.tables(inside);
        (reflected.at(cosine, roughness) / all.at(cosine, roughness)).min(1.0)
    }

    /// Returns the share of the light from outside that does not pass the boundary, which is the
    /// Fresnel reflectance if the boundary is smooth.
    pub fn reflectance(&self, cosine: f32, roughness: f32) -> f32 {
        match Ggx::new(roughness, 0.0).is_smooth() {
            true => fresnel::dielectric(cosine, self.ior),
            false => self.rough_reflectance(cosine, roughness),
        }
    }

    /// Version of [`DielectricAlbedo::reflectance`] for rough boundaries.
    pub fn rough_reflectance(&self, cosine: f32, roughness: f32) -> f32 {
        if self.facets == Facets::Ggx {
            return self.reflected(false, cosine, roughness);
        }
        let [reflected, all] = self.tables(false);
        (1.0 + reflected.at(cosine, roughness) - all.at(cosine, roughness)).clamp(0.0, 1.0)
    }

    /// Returns the cosine-weighted mean of [`DielectricAlbedo::reflectance`] over the hemisphere.
    pub fn mean(&self, roughness: f32) -> f32 {
        if Ggx::new(roughness, 0.0).is_smooth() {
            return self.smooth_mean;
        }
        let of = |row: usize| {
            let roughness = row as f32 / (SIZE - 1) as f32;
            mean_by_cosine(|cosine| self.rough_reflectance(cosine, roughness))
        };
        let means = once(&self.means, || (0..SIZE).map(of).collect());
        let (i, a) = table_position(roughness);
        means[i] * (1.0 - a) + means[i + 1] * a
    }

    /// Returns a factor for a single reflection or refraction that compensates for the light lost
    /// to multiple scattering.
    pub fn gain(&self, inside: bool, cosine: f32, roughness: f32) -> f32 {
        1.0 / self.tables(inside)[1].at(cosine, roughness)
    }

    /// Version of [`DielectricAlbedo::gain`] that also accepts anisotropic surfaces. `eta` is the
    /// index behind the boundary, relative to the index in front of it. This index differs from
    /// that of the boundary if another medium surrounds the object.
    pub fn gain_for(&self, inside: bool, eta: f32, surface: Ggx, wo: Vec3, roughness: f32) -> f32 {
        let own_eta = if inside { 1.0 / self.ior } else { self.ior };
        if (eta / own_eta - 1.0).abs() > NEAR {
            return 1.0 / anisotropic::quick(|u| facet_weight(surface.clamped(), wo, eta, u, true));
        }
        if surface.is_isotropic() {
            return self.gain(inside, wo.z, roughness);
        }
        let both = once(&self.anisotropic, || {
            [self.ior, 1.0 / self.ior]
                .map(|eta| anisotropic::Table::new(|ggx, wo, u| facet_weight(ggx, wo, eta, u, true)))
        });
        1.0 / both[usize::from(inside)].at(surface, wo)
    }
}

/// Largest relative difference between indices that share a table. The dispersion of glass stays
/// below this limit.
const NEAR: f32 = 0.05;

/// Estimates the mean of `value` over the visible facets of a rough surface from a few points.
/// `value` is a function of the cosine at a facet. This estimate is used for surfaces that have too
/// many parameters for tables.
pub fn over_facets(surface: Ggx, wo: Vec3, value: impl Fn(f32) -> Spectrum) -> Spectrum {
    const FEW: usize = 16;
    let (ggx, cosine) = (surface.clamped(), wo.z);
    let wo = if ggx.is_isotropic() { direction(cosine) } else { wo };
    let (mut sum, mut all) = (Spectrum::ZERO, 0.0);
    for u in points().take(FEW) {
        let h = ggx.sample_visible(wo, u);
        let wi = 2.0 * wo.dot(h) * h - wo;
        let visible = if wi.z > 0.0 { ggx.masking_shadowing(wo, wi) } else { 0.0 };
        (sum, all) = (sum + visible * value(wo.dot(h).max(0.0)), all + visible);
    }
    if all > 0.0 { sum / all } else { value(cosine) }
}

/// Estimates cosine-weighted means over the hemisphere from a few points. The first mean is for one
/// reflection at a boundary, and the second is for reflection and refraction together. This
/// estimate is used where tables are not worth their cost.
pub fn single_means(eta: f32, roughness: f32) -> [f32; 2] {
    const COSINES: usize = 16;
    const FEW: usize = 64;
    let ggx = isotropic(roughness);
    [false, true].map(|all| {
        let at = |i: usize| ((i as f32 + 0.5) / COSINES as f32).sqrt();
        let one = |i: usize| points().take(FEW).map(|u| facet_weight(ggx, direction(at(i)), eta, u, all)).sum::<f32>();
        (0..COSINES).map(one).sum::<f32>() / (COSINES * FEW) as f32
    })
}

/// Estimates the share of light that a rough boundary reflects, for light whose direction has the
/// given cosine, or the share that is not lost if `all` is set. Light that is scattered several
/// times is lost.
pub fn single_share(surface: Ggx, cosine: f32, eta: f32, all: bool) -> f32 {
    // Total internal reflection at a nearly smooth boundary starts at a sharp angle, and many of
    // Beckmann's facets are hidden.
    let many = if eta < 1.0 || surface.facets == Facets::Beckmann { 2 * POINTS } else { POINTS / 4 };
    let (ggx, wo) = (surface.clamped(), direction(cosine));
    let sum: f64 = points_of(many).map(|u| f64::from(facet_weight(ggx, wo, eta, u, all))).sum();
    (sum / f64::from(many)) as f32
}

/// Returns the weight of one sampled facet, for its reflection, or for reflection and refraction if
/// `all` is set.
fn facet_weight(ggx: Ggx, wo: Vec3, eta: f32, u: Vec2, all: bool) -> f32 {
    let h = ggx.sample_visible(wo, u);
    let cosine = wo.dot(h).max(0.0);
    let reflected = fresnel::dielectric(cosine, eta);
    let visible = |wi: Vec3| ggx.sampled_weight(wo, wi, h);
    let up = 2.0 * cosine * h - wo;
    let mut sum = if up.z > 0.0 { reflected * visible(up) } else { 0.0 };
    if all && reflected < 1.0 {
        let behind = (1.0 - (1.0 - cosine * cosine) / (eta * eta)).max(0.0).sqrt();
        let down = (cosine / eta - behind) * h - wo / eta;
        sum += if down.z < 0.0 { (1.0 - reflected) * visible(down) } else { 0.0 };
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;
    use std::time::Duration;

    #[test]
    fn once_does_not_deadlock_if_a_waiting_thread_steals_work() {
        let (sender, done) = mpsc::channel();
        std::thread::spawn(move || {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            let cell = OnceLock::new();
            // Yield, as a thread does while it waits for a part of the table. The thread then
            // steals the next tile.
            let tile = || *once(&cell, || (rayon::yield_now(), 5).1);
            let _ = sender.send(pool.install(|| rayon::join(tile, tile)));
        });
        assert_eq!(done.recv_timeout(Duration::from_secs(20)), Ok((5, 5)));
    }
}
