//! Reconstruction filters, which define the weight of a sample at an offset from the centre of a
//! pixel.
//!
//! Each filter is the product of one function applied to `dx` and the same function applied to
//! `dy`. The function is zero beyond the radius. Filters are importance-sampled: a uniform position
//! is warped to an offset whose density is proportional to the absolute value of the filter. All
//! samples of a pixel therefore have the same weight, apart from the sign, and contribute only to
//! that pixel. Source: Pharr, Jakob, Humphreys, *Physically Based Rendering*, 4th edition, section
//! 8.8.

use durer_scene::math::{Vec2, fp};
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;

#[cfg(test)]
mod tests;

/// Filter that reconstructs pixels in a render. Lengths are in pixels and must be positive and
/// finite.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Filter {
    /// Constant weight. The picture is sharp but shows aliasing.
    Box {
        /// Half the width of the filter.
        radius: f32,
    },
    /// Weight that decreases linearly to zero at the radius.
    Tent {
        /// Half the width of the filter.
        radius: f32,
    },
    /// The Gaussian exp(-d^2 / (2 sigma^2)), shifted so that it is zero at the radius.
    Gaussian {
        /// Standard deviation.
        sigma: f32,
        /// Half the width of the filter.
        radius: f32,
    },
    /// Blackman-Harris window, a sum of four cosines. It resembles a Gaussian without tails and
    /// causes no ringing.
    ///
    /// Source: Harris, *On the Use of Windows for Harmonic Analysis*, Proc. IEEE 66(1), 1978.
    BlackmanHarris {
        /// Half the width of the filter.
        radius: f32,
    },
    /// Mitchell-Netravali cubic with B = C = 1/3. It is the sharpest filter, but its negative lobes
    /// can cause ringing.
    ///
    /// Source: Mitchell, Netravali, *Reconstruction Filters in Computer Graphics*, SIGGRAPH 1988.
    Mitchell {
        /// Half the width of the filter.
        radius: f32,
    },
}

impl Default for Filter {
    fn default() -> Self {
        Filter::BlackmanHarris { radius: 1.5 }
    }
}

impl Filter {
    /// All filters with their default sizes and their names on the command line.
    pub const NAMES: [(&'static str, Filter); 5] = [
        ("box", Filter::Box { radius: 0.5 }),
        ("tent", Filter::Tent { radius: 1.0 }),
        ("gaussian", Filter::Gaussian { sigma: 0.5, radius: 1.5 }),
        ("blackman-harris", Filter::BlackmanHarris { radius: 1.5 }),
        ("mitchell", Filter::Mitchell { radius: 2.0 }),
    ];

    /// Returns the filter with the given name and its default size.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(n, _)| *n == name).map(|&(_, filter)| filter)
    }

    /// Returns the filter with a different radius. The sigma of a Gaussian is scaled by the same
    /// factor.
    pub fn with_radius(self, radius: f32) -> Self {
        match self {
            Filter::Box { .. } => Filter::Box { radius },
            Filter::Tent { .. } => Filter::Tent { radius },
            Filter::Gaussian { sigma, radius: old } => Filter::Gaussian { sigma: sigma * (radius / old), radius },
            Filter::BlackmanHarris { .. } => Filter::BlackmanHarris { radius },
            Filter::Mitchell { .. } => Filter::Mitchell { radius },
        }
    }

    /// Returns half the width of the filter in pixels. The weight is zero beyond this distance.
    pub fn radius(self) -> f32 {
        match self {
            Filter::Box { radius }
            | Filter::Tent { radius }
            | Filter::Gaussian { radius, .. }
            | Filter::BlackmanHarris { radius }
            | Filter::Mitchell { radius } => radius,
        }
    }

    /// Returns the weight at an offset from the pixel's centre, in pixels. The weights are not
    /// normalized, and they are negative in the lobes of the Mitchell filter.
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

    /// Prepares importance sampling by building a table of 8 KiB. This is done once per render.
    pub fn sampler(self) -> FilterSampler {
        FilterSampler::new(self)
    }
}

/// Importance sampler for a reconstruction filter. It draws offsets in proportion to the absolute
/// value of the filter.
///
/// The integral of the filter along an axis is inverted once at `SHARES + 1` knots, and the density
/// is constant between two knots. The error of an offset is less than the distance between the two
/// knots around it. That distance is on average below a thousandth of the radius, which a test
/// checks.
#[derive(Clone, Debug)]
pub struct FilterSampler {
    filter: Filter,
    /// Distances from the centre within which the absolute filter has 0, 1, 2, ... of `SHARES`
    /// equal shares of its integral.
    knots: Box<[f32; SHARES + 1]>,
    /// Magnitude of the sample weights. It is the integral of the absolute filter divided by the
    /// integral of the filter, squared because there are two axes.
    gain: f32,
}

/// Number of equal shares into which a filter's integral from the centre to the radius is divided.
const SHARES: usize = 2048;

/// Number of linear pieces between the centre and the radius when a filter is integrated.
const BINS: usize = 1024;

impl FilterSampler {
    fn new(filter: Filter) -> Self {
        let value = |i: usize| f64::from(filter.profile(filter.radius() * (i as f32 / BINS as f32)));
        let values: Vec<f64> = (0..=BINS).map(value).collect();
        let trapezoid = |a: f64, b: f64| 0.5 * (a + b);
        let signed: f64 = values.windows(2).map(|pair| trapezoid(pair[0], pair[1])).sum();
        // Integral of the absolute filter from the centre to the end of each bin. The first value
        // is 0.
        let parts = values.windows(2).map(|pair| trapezoid(pair[0].abs(), pair[1].abs()));
        let integral: Vec<f64> = std::iter::once(0.0)
            .chain(parts.scan(0.0, |sum, part| {
                *sum += part;
                Some(*sum)
            }))
            .collect();
        let absolute = integral[BINS];
        // If the integral of a filter is not positive, the filter is sampled with a gain of 1.
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

    /// Returns the magnitude of the sample weights. It is 1 for filters without negative lobes and
    /// greater than 1 for others.
    pub fn gain(&self) -> f32 {
        match self.filter {
            Filter::Mitchell { .. } => self.gain,
            _ => 1.0,
        }
    }

    /// Warps a uniform position in [0,1)^2 to an offset from the centre of a pixel. Returns the
    /// offset and the weight of the sample.
    ///
    /// The weight is 1 for filters without negative lobes. For other filters, all weights have the
    /// same magnitude, the sign of the filter and a mean of 1. Offsets are monotonic functions of
    /// the positions, so stratification is preserved.
    pub fn sample(&self, position: Vec2) -> (Vec2, f32) {
        let offset = Vec2::new(self.warp(position.x), self.warp(position.y));
        (offset, self.weight(offset))
    }

    /// Warps several positions. All x coordinates are stored before all y coordinates.
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

    /// Maps a uniform number in [0,1) to an offset along one axis. The centre corresponds to 1/2.
    #[inline(always)]
    fn warp(&self, u: f32) -> f32 {
        let v = 2.0 * u - 1.0;
        let place = v.abs() * SHARES as f32;
        let share = (place as usize).min(SHARES - 1);
        let (near, far) = (self.knots[share], self.knots[share + 1]);
        (near + (place - share as f32) * (far - near)).copysign(v)
    }
}
