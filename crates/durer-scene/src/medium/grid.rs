//! Density grids, for example of smoke or a cloud.

use crate::math::{Aabb, Vec3};
use crate::source::Digest;

/// Densities of a participating medium, such as smoke or a cloud, on a regular grid in a box.
#[derive(Clone, Debug, PartialEq)]
pub struct DensityGrid {
    /// Number of grid points along x, y and z, at least one along each axis.
    counts: [u32; 3],
    /// Density values, with x varying fastest.
    values: Vec<f32>,
    max_density: f32,
}

impl DensityGrid {
    /// Creates a grid from density values, with x varying fastest. Returns `None` unless there is
    /// one value per grid point and all values are finite and not negative.
    pub fn new(counts: [u32; 3], values: Vec<f32>) -> Option<Self> {
        let wanted = counts.iter().try_fold(1_usize, |product, &count| product.checked_mul(count as usize))?;
        if wanted == 0 || wanted != values.len() || values.iter().any(|x| !x.is_finite() || *x < 0.0) {
            return None;
        }
        let max_density = values.iter().copied().fold(0.0, f32::max);
        Some(DensityGrid { counts, values, max_density })
    }

    /// Number of grid points along x, y and z.
    pub fn counts(&self) -> [u32; 3] {
        self.counts
    }

    /// Density values, with x varying fastest.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Hash of the entire grid.
    pub fn digest(&self) -> Digest {
        let mut hasher = Digest::hasher();
        self.counts.iter().for_each(|count| hasher.add_u32(*count));
        self.values.iter().for_each(|value| hasher.add_u32(value.to_bits()));
        hasher.finish()
    }

    /// Maximum density.
    pub fn max_density(&self) -> f32 {
        self.max_density
    }

    /// Size in memory in bytes.
    pub fn bytes(&self) -> usize {
        self.values.len() * size_of::<f32>()
    }

    /// Density at a point in the space of the box, interpolated trilinearly between cell centres.
    pub fn at(&self, bounds: &Aabb, point: Vec3) -> f32 {
        let counts = Vec3::from_array(self.counts.map(|n| n as f32));
        let place = (point - bounds.min) / (bounds.max - bounds.min) * counts - 0.5;
        let place = place.max(Vec3::ZERO).min(counts - 1.0);
        let low = place.floor();
        let part = place - low;
        let index = |axis: usize, up: usize| (low[axis] as usize + up).min(self.counts[axis] as usize - 1);
        let value = |x: usize, y: usize, z: usize| {
            let [columns, rows, _] = self.counts.map(|n| n as usize);
            self.values[(index(2, z) * rows + index(1, y)) * columns + index(0, x)]
        };
        let mix = |a: f32, b: f32, part: f32| a + (b - a) * part;
        let row = |y, z| mix(value(0, y, z), value(1, y, z), part.x);
        let slice = |z| mix(row(0, z), row(1, z), part.y);
        mix(slice(0), slice(1), part.z).max(0.0)
    }
}
