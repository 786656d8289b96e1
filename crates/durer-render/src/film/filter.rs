//! Reconstruction filters: the weight of a sample at an offset from a pixel's centre.
//!
//! Each filter is a product of the same function of `dx` and of `dy`, zero beyond the radius.
//! Filters are importance-sampled: a uniform position is warped to an offset with a density
//! proportional to the filter's absolute value. Every sample of a pixel thus has the same weight,
//! up to sign, and contributes to that pixel only. Source: Pharr, Jakob, Humphreys, *Physically
//! Based Rendering*, 4th edition, section 8.8.

use durer_scene::math::{Vec2, fp};
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;

#[cfg(test)]
mod tests;

/// Pixel reconstruction filter of a render. Lengths are in pixels and must be positive and finite.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Filter {
    /// Constant weight. Sharp, but aliases.
    Box {
        /// Half the width.
        radius: f32,
    },
    /// Falls linearly to zero at the radius.
    Tent {
        /// Half the width.
        radius: f32,
    },
    /// exp(-d^2 / (2 sigma^2)), shifted to be zero at the radius.
    Gaussian {
        /// Standard deviation.
        sigma: f32,
        /// Half the width.
        radius: f32,
    },
    /// Blackman-Harris window, a sum of four cosines: close to a Gaussian without its tail, no
    /// ringing.
    ///
    /// Source: Harris, *On the Use of Windows for Harmonic Analysis*, Proc. IEEE 66(1), 1978.
    BlackmanHarris {
        /// Half the width.
        radius: f32,
    },
    /// Mitchell-Netravali cubic with B = C = 1/3 and negative lobes. The sharpest filter; can ring.
    ///
    /// Source: Mitchell, Netravali, *Reconstruction Filters in Computer Graphics*, SIGGRAPH 1988.
    Mitchell {
        /// Half the width.
        radius: f32,
    },
}

impl Default for Filter {
    fn default() -> Self {
        Filter::BlackmanHarris { radius: 1.5 }
    }
}

impl Filter {
    /// All filters at their default sizes, with their names on the command line.
    pub const NAMES: [(&'static str, Filter); 5] = [
        ("box", Filter::Box { radius: 0.5 }),
        ("tent", Filter::Tent { radius: 1.0 }),
        ("gaussian", Filter::Gaussian { sigma: 0.5, radius: 1.5 }),
        ("blackman-harris", Filter::BlackmanHarris { radius: 1.5 }),
        ("mitchell", Filter::Mitchell { radius: 2.0 }),
    ];

    /// Returns the filter with this name at its default size.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(n, _)| *n == name).map(|&(_, filter)| filter)
    }

    /// Returns the filter with another radius. A Gaussian's sigma scales with it.
    pub fn with_radius(self, radius: f32) -> Self {
        match self {
            Filter::Box { .. } => Filter::Box { radius },
            Filter::Tent { .. } => Filter::Tent { radius },
            Filter::Gaussian { sigma, radius: old } => Filter::Gaussian { sigma: sigma * (radius / old), radius },
            Filter::BlackmanHarris { .. } => Filter::BlackmanHarris { radius },
            Filter::Mitchell { .. } => Filter::Mitchell { radius },
        }
    }

    /// Returns half the filter's width in pixels. The weight is zero farther out.
    pub fn radius(self) -> f32 {
        match self {
            Filter::Box { radius }
            | Filter::Tent { radius }
            | Filter::Gaussian { radius, .. }
            | Filter::BlackmanHarris { radius }
            | Filter::Mitchell { radius } => radius,
        }
    }

    /// Returns the weight at an offset from the pixel's centre, in pixels. Not normalized, and
    /// negative in the lobes of the Mitchell filter.
    pub fn weight(self, dx: f32, dy: f32) -> f32 {
        self.profile(dx.abs()) * self.profile(dy.abs())
    }

    /// Returns the weight along one axis at a distance d >= 0.
    fn profile(self, d: f32) -> f32 {
        if d > self.radius() {
            return 0.0;
        }
        match self {
            Filter::Box { .. } => 1.0,
            Filter::Tent { radius } => 1.0 - d / radius,
            Filter::Gaussian { sigma, radius } => {
                let bell = |x: f32| fp::exp(-x * x / (2.0 * sigma * sigma));
                bell(d) - bell(radius)
            }
            Filter::BlackmanHarris { radius } => {
                let a = PI * (d / radius);
                0.35875 + 0.48829 * fp::cos(a) + 0.14128 * fp::cos(2.0 * a) + 0.01168 * fp::cos(3.0 * a)
            }
            Filter::Mitchell { radius } => {
                let x = 2.0 * d / radius;
                if x < 1.0 {
                    (7.0 * x - 12.0) * x * x * (1.0 / 6.0) + 16.0 / 18.0
                } else {
                    ((-7.0 / 3.0 * x + 12.0) * x - 20.0) * x * (1.0 / 6.0) + 32.0 / 18.0
                }
            }
        }
    }

    /// Prepares importance sampling by building a table of 8 KiB, once per render.
    pub fn sampler(self) -> FilterSampler {
        FilterSampler::new(self)
    }
}

/// Importance sampler of a reconstruction filter: draws offsets in proportion to the filter's
/// absolute value.
///
/// The filter's integral along an axis is inverted once at `SHARES + 1` knots, and the density is
/// constant between two knots. An offset is wrong by less than the distance of its two knots, which
/// is on average below a thousandth of the radius; a test checks this.
#[derive(Clone, Debug)]
pub struct FilterSampler {
    filter: Filter,
    /// Distances from the centre that contain 0, 1, 2, ... of `SHARES` equal shares of the absolute
    /// filter's integral.
    knots: Box<[f32; SHARES + 1]>,
    /// Integral of the absolute filter divided by that of the filter, squared because there are two
    /// axes. It is the magnitude of the sample weights.
    gain: f32,
}

/// Number of equal shares of a filter's integral from the centre to the radius.
const SHARES: usize = 2048;

/// Number of linear pieces from the centre to the radius for integrating the filter.
const BINS: usize = 1024;

impl FilterSampler {
    fn new(filter: Filter) -> Self {
        let value = |i: usize| f64::from(filter.profile(filter.radius() * (i as f32 / BINS as f32)));
        let values: Vec<f64> = (0..=BINS).map(value).collect();
        let trapezoid = |a: f64, b: f64| 0.5 * (a + b);
        let signed: f64 = values.windows(2).map(|pair| trapezoid(pair[0], pair[1])).sum();
        // Integral of the absolute filter from the centre to the end of each bin, starting with 0.
        let parts = values.windows(2).map(|pair| trapezoid(pair[0].abs(), pair[1].abs()));
        let integral: Vec<f64> = std::iter::once(0.0)
            .chain(parts.scan(0.0, |sum, part| {
                *sum += part;
                Some(*sum)
            }))
            .collect();
        let absolute = integral[BINS];
        // A filter whose integral is not positive is sampled without gain.
        let gain = if signed > 0.0 { (absolute / signed) * (absolute / signed) } else { 1.0 };
        let distance = |share: usize| {
            let target = share as f64 / SHARES as f64 * absolute;
            let bin = (integral.partition_point(|&sum| sum <= target)).clamp(1, BINS) - 1;
            let (start, end) = (values[bin].abs(), values[bin + 1].abs());
            // Solve start * t + (end - start) * t^2 / 2 = rest for t in the bin, without
            // cancellation.
            let rest = target - integral[bin];
            let root = (start * start + 2.0 * (end - start) * rest).max(0.0).sqrt();
            let t = if rest > 0.0 { (2.0 * rest / (start + root)).min(1.0) } else { 0.0 };
            ((bin as f64 + t) / BINS as f64 * f64::from(filter.radius())) as f32
        };
        FilterSampler { filter, knots: Box::new(std::array::from_fn(distance)), gain: gain as f32 }
    }

    /// Returns the magnitude of the sample weights: 1 for filters without negative lobes, greater
    /// for others.
    pub fn gain(&self) -> f32 {
        match self.filter {
            Filter::Mitchell { .. } => self.gain,
            _ => 1.0,
        }
    }

    /// Warps a uniform position in [0,1)^2 to an offset from the pixel's centre. Returns the offset
    /// and the sample's weight.
    ///
    /// The weight is 1 for filters without negative lobes. For others it has a constant magnitude,
    /// the filter's sign and mean 1. Offsets are monotonic in the positions, so stratification is
    /// preserved.
    pub fn sample(&self, position: Vec2) -> (Vec2, f32) {
        let offset = Vec2::new(self.warp(position.x), self.warp(position.y));
        (offset, self.weight(offset))
    }

    /// Warps several positions, stored as all x followed by all y.
    #[inline(always)]
    pub fn samples<const N: usize>(&self, positions: &[[f32; N]; 2]) -> ([[f32; N]; 2], [f32; N]) {
        let (mut offsets, mut weights) = ([[0.0; N]; 2], [1.0; N]);
        for axis in 0..2 {
            for i in 0..N {
                offsets[axis][i] = self.warp(positions[axis][i]);
            }
        }
        for i in 0..N {
            weights[i] = self.weight(Vec2::new(offsets[0][i], offsets[1][i]));
        }
        (offsets, weights)
    }

    #[inline]
    fn weight(&self, offset: Vec2) -> f32 {
        match self.filter {
            Filter::Mitchell { .. } => self.gain.copysign(self.filter.weight(offset.x, offset.y)),
            _ => 1.0,
        }
    }

    /// Maps a uniform number in [0,1) to an offset along one axis; 1/2 is the centre.
    #[inline(always)]
    fn warp(&self, u: f32) -> f32 {
        let v = 2.0 * u - 1.0;
        let place = v.abs() * SHARES as f32;
        let share = (place as usize).min(SHARES - 1);
        let (near, far) = (self.knots[share], self.knots[share + 1]);
        (near + (place - share as f32) * (far - near)).copysign(v)
    }
}
