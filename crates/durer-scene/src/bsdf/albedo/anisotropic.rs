//! Directional albedo of anisotropic surfaces.
//!
//! The albedo of an anisotropic surface depends on the azimuth of the view, and most strongly near
//! the smoother axis. Therefore, the table is not indexed by the azimuth and two roughnesses, but
//! by the slopes of the facets relative to the view direction. The indices are the spread of the
//! slopes along the view direction, their spread across it, and the correlation of the two. In
//! these coordinates, the albedo is smooth for every anisotropy.

use super::{direction, table_position_in};
use crate::bsdf::microfacet::{Ggx, SMOOTH};
use crate::math::{Vec2, Vec3, fp};
use rayon::prelude::*;

/// Number of table entries for the cosine, the spread along the view direction, the spread across
/// it, and the correlation.
const SIZES: [usize; 4] = [16, 16, 10, 5];

/// Number of integration points around the normal, and in the direction towards it. The error is at
/// most 0.1 %.
const EXACT: [usize; 2] = [32, 24];

/// Number of integration points for a single shading point, in the same order as in [`EXACT`].
const QUICK: [usize; 2] = [16, 16];

/// Four-dimensional table of a function of the GGX distribution and the view direction, such as the
/// directional albedo of anisotropic surfaces.
#[derive(Clone, Debug)]
pub(super) struct Table(Vec<f32>);

impl Table {
    /// Tabulates the mean of `value` over the visible facets. `value` uses two numbers to sample a
    /// facet.
    pub fn new(value: impl Fn(Ggx, Vec3, Vec2) -> f32 + Sync) -> Self {
        let entry = |mut i: usize| {
            let at = SIZES.map(|size| {
                let k = i % size;
                i /= size;
                k as f32 / (size - 1) as f32
            });
            let (ggx, wo) = from_axes(at);
            integral(EXACT, |u| value(ggx, wo, u))
        };
        Table((0..SIZES.iter().product()).into_par_iter().map(entry).collect())
    }

    /// Returns the value for a surface and a view direction by cubic interpolation.
    pub fn at(&self, ggx: Ggx, wo: Vec3) -> f32 {
        let axes = axes(ggx.clamped(), wo);
        let parts: [(usize, [f32; 4]); 4] = std::array::from_fn(|axis| cubic(axes[axis], SIZES[axis]));
        let [(c, wc), (a, wa), (b, wb), (r, wr)] = parts;
        let mut sum = 0.0;
        for (k, wr) in wr.into_iter().enumerate() {
            for (j, wb) in wb.into_iter().enumerate() {
                for (i, wa) in wa.into_iter().enumerate() {
                    let row = c + SIZES[0] * ((a + i) + SIZES[1] * ((b + j) + SIZES[2] * (r + k)));
                    let line: f32 = self.0[row..row + 4].iter().zip(wc).map(|(entry, w)| entry * w).sum();
                    sum += wr * wb * wa * line;
                }
            }
        }
        sum
    }
}

/// Returns the mean of `value` over the visible facets, for a single shading point.
pub(super) fn quick(value: impl Fn(Vec2) -> f32) -> f32 {
    integral(QUICK, value)
}

/// Returns the mean over the unit square of a function that is periodic in x. The points are denser
/// near y = 1, where the facets lie along the view direction.
fn integral([around, towards]: [usize; 2], value: impl Fn(Vec2) -> f32) -> f32 {
    let mut sum = 0.0;
    for j in 0..towards {
        let rest = 1.0 - (j as f32 + 0.5) / towards as f32;
        let ring = (0..around).map(|i| value(Vec2::new((i as f32 + 0.5) / around as f32, 1.0 - rest * rest)));
        sum += 2.0 * rest * ring.sum::<f32>();
    }
    sum / (around * towards) as f32
}

/// Returns the coordinates in the table, each of which is in [0, 1].
fn axes(ggx: Ggx, wo: Vec3) -> [f32; 4] {
    let across = Vec2::new(wo.x, wo.y).try_normalize().unwrap_or(Vec2::X);
    let (x2, y2) = (ggx.alpha.x * ggx.alpha.x, ggx.alpha.y * ggx.alpha.y);
    let (c2, s2) = (across.x * across.x, across.y * across.y);
    let (along, beside) = (x2 * c2 + y2 * s2, x2 * s2 + y2 * c2);
    let both = ((x2 - y2) * across.x * across.y).abs();
    let correlation = both / (along * beside).sqrt().max(f32::MIN_POSITIVE);
    [wo.z.max(0.0).sqrt(), along.sqrt().sqrt(), beside.sqrt().sqrt(), correlation.min(1.0)]
}

/// Inverse of [`axes`].
fn from_axes([cosine, along, beside, correlation]: [f32; 4]) -> (Ggx, Vec3) {
    let [along, beside] = [along * along, beside * beside].map(|alpha| alpha.max(SMOOTH));
    let both = correlation * along * beside;
    let (a2, b2) = (along * along, beside * beside);
    // Compute the eigenvalues and the axis of the covariance matrix of the slopes.
    let apart = ((a2 - b2) * (a2 - b2) + 4.0 * both * both).sqrt();
    let x2 = 0.5 * (a2 + b2 + apart);
    let y2 = a2 * b2 * (1.0 - correlation * correlation) / x2;
    let (sin, cos) = fp::sin_cos_turn(0.5 * fp::atan2_turn(2.0 * both, a2 - b2));
    let flat = direction((cosine * cosine).max(1e-4));
    (Ggx::of(Vec2::new(x2.sqrt(), y2.sqrt())).clamped(), Vec3::new(flat.x * cos, flat.x * sin, flat.z))
}

/// Returns the index of the first of the four entries around `x`, which is in [0, 1], and the
/// weight of each entry.
fn cubic(x: f32, size: usize) -> (usize, [f32; 4]) {
    let (i, f) = table_position_in(x, size);
    let first = i.saturating_sub(1).min(size - 4);
    // Compute the position relative to the first of the four entries.
    let t = f + (i - first) as f32;
    let [a, b, c] = [t - 1.0, t - 2.0, t - 3.0];
    (first, [-a * b * c / 6.0, t * b * c / 2.0, -t * a * c / 2.0, t * a * b / 6.0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::albedo;
    use crate::math::random::Random;

    #[test]
    fn axes_round_trip() {
        let mut random = Random(21);
        for _ in 0..200 {
            let at: [f32; 4] = std::array::from_fn(|_| random.between(0.2, 0.95));
            let (ggx, wo) = from_axes(at);
            let back = axes(ggx, wo);
            assert!(at.iter().zip(back).all(|(a, b)| (a - b).abs() < 2e-3), "{at:?} {back:?}");
        }
    }

    #[test]
    fn anisotropic_table_agrees_with_isotropic_table() {
        for (cosine, roughness) in [(0.9, 0.3), (0.5, 0.6), (0.2, 0.9), (0.7, 1.0)] {
            let ggx = Ggx::new(roughness, 0.0);
            // A slight anisotropy is enough to select the anisotropic table.
            let uneven = Ggx::of(Vec2::new(ggx.alpha.x, ggx.alpha.x * (1.0 - 1e-6)));
            let (own, even) = (albedo::ggx_for(uneven, direction(cosine), roughness), albedo::ggx(cosine, roughness));
            assert!((own - even).abs() < 3e-3, "{cosine} {roughness}: {own} {even}");
        }
    }
}
