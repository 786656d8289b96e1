//! Division of the sky into patches, for daylight coefficients.
//!
//! Sources: Tregenza, *Subdivision of the sky hemisphere for luminance measurements*, Lighting
//! Research and Technology 19, 1987, for 145 patches in seven rows and a cap; Reinhart's finer
//! divisions, which split each row and each patch. The order is that of Radiance's `gendaymtx`.

use crate::math::{Vec3, fp};

/// Number of patches in each of Tregenza's rows, starting at the horizon.
const ROWS: [u32; 7] = [30, 30, 24, 24, 18, 12, 6];

/// Division of the sky above the horizon into patches of about the same solid angle. Directions are
/// unit vectors with y up. Patches are numbered from 0, row by row from the horizon, and in each
/// row from north (-z) through east (x). The last patch is the cap around the zenith.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyPatches {
    rows: Vec<PatchRow>,
    /// Height of a row in degrees.
    height: f64,
}

/// Row of patches between two altitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PatchRow {
    /// Number of the first patch.
    first: usize,
    /// Number of patches.
    count: u32,
}

impl SkyPatches {
    /// Numbers of patches of the available divisions.
    pub const COUNTS: [usize; 3] = [145, 577, 2305];

    /// Creates a division into one of the numbers of patches in [`SkyPatches::COUNTS`]; `None` for
    /// other numbers.
    pub fn new(count: usize) -> Option<Self> {
        let split = 1 << SkyPatches::COUNTS.iter().position(|known| *known == count)?;
        let mut first = 0;
        let counts = ROWS.iter().flat_map(|row| std::iter::repeat_n(row * split, split as usize)).chain([1]);
        let rows = counts.map(|count| {
            let row = PatchRow { first, count };
            first += count as usize;
            row
        });
        Some(SkyPatches { rows: rows.collect(), height: 90.0 / (7.0 * f64::from(split) + 0.5) })
    }

    /// Number of patches; at least 145.
    pub fn count(&self) -> usize {
        self.rows.last().map_or(0, |row| row.first + 1)
    }

    /// Height of a row in degrees, which is about the width of a patch.
    pub fn row_height(&self) -> f64 {
        self.height
    }

    /// Returns the patch that contains a unit direction. Directions below the horizon belong to the
    /// lowest row.
    pub fn patch(&self, dir: Vec3) -> usize {
        let altitude = f64::from(fp::asin(dir.y.clamp(0.0, 1.0)).to_degrees());
        let PatchRow { first, count } = self.rows[((altitude / self.height) as usize).min(self.rows.len() - 1)];
        let turn = fp::atan2_turn(dir.x, -dir.z);
        let column = (turn.rem_euclid(1.0) * count as f32 + 0.5) as usize;
        first + column % count as usize
    }

    /// Returns the unit direction to the centre of a patch, which is smaller than
    /// [`SkyPatches::count`].
    pub fn center(&self, patch: usize) -> Vec3 {
        let (row, PatchRow { first, count }) = self.row_of(patch);
        let altitude = if count == 1 { 90.0 } else { self.height * (row as f64 + 0.5) };
        crate::texture::almanac::direction([altitude, 360.0 * (patch - first) as f64 / f64::from(count)])
    }

    /// Returns the solid angle of a patch in steradians.
    pub fn solid_angle(&self, patch: usize) -> f64 {
        let (row, PatchRow { count, .. }) = self.row_of(patch);
        let sine = |edge: usize| fp::sin_cos_degrees((self.height * edge as f64).min(90.0)).0;
        std::f64::consts::TAU * (sine(row + 1) - sine(row)) / f64::from(count)
    }

    fn row_of(&self, patch: usize) -> (usize, PatchRow) {
        let row = self.rows.partition_point(|row| row.first <= patch).saturating_sub(1);
        (row, self.rows[row])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_cover_the_sky_once() {
        assert_eq!(SkyPatches::new(146), None);
        for count in SkyPatches::COUNTS {
            let sky = SkyPatches::new(count).unwrap();
            assert_eq!(sky.count(), count);
            let whole: f64 = (0..count).map(|patch| sky.solid_angle(patch)).sum();
            assert!((whole - std::f64::consts::TAU).abs() < 1e-9, "{whole}");
            for patch in 0..count {
                assert_eq!(sky.patch(sky.center(patch)), patch, "{count}");
            }
        }
        let sky = SkyPatches::new(145).unwrap();
        // The first patch is in the north, and the next one is east of it.
        assert_eq!((sky.patch(Vec3::NEG_Z), sky.patch(Vec3::Y)), (0, 144));
        assert!(sky.center(1).x > 0.0);
        assert_eq!(sky.patch(Vec3::new(-0.01, 0.0, -1.0)), 0);
        assert_eq!(sky.patch(Vec3::new(-0.2, -0.5, -1.0).normalize()), 29);
    }

    #[test]
    fn random_directions_hit_patches_in_proportion_to_their_solid_angles() {
        let sky = SkyPatches::new(145).unwrap();
        let mut hits = vec![0_u32; 145];
        let samples = 1 << 18;
        for sample in 0..samples {
            let u = crate::sampler::sample_2d(0, 0, 0, sample, 0);
            let (sin, cos) = fp::sin_cos_degrees(360.0 * f64::from(u.y));
            let flat = f64::from(1.0 - u.x * u.x).sqrt();
            hits[sky.patch(Vec3::new((flat * sin) as f32, u.x, (flat * cos) as f32))] += 1;
        }
        for (patch, hits) in hits.into_iter().enumerate() {
            let share = f64::from(hits) / f64::from(samples) * std::f64::consts::TAU;
            assert!((share / sky.solid_angle(patch) - 1.0).abs() < 0.05, "{patch}: {share}");
        }
    }
}
