//! Figures of a luminaire that lighting engineers compare, computed from its measured intensities.

use super::{PhotometricProfile, ProfileKind};
use crate::math::{Vec3, fp};
use std::f64::consts::PI;

/// Step of the angles at which intensities are sampled, in degrees.
const STEP: f64 = 0.25;

/// Figures computed from the intensities of a luminaire that is mounted in its usual position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotometricSummary {
    /// Luminous flux in all directions, in lumens.
    pub flux: f64,
    /// Fraction of the flux that goes below the horizontal plane.
    pub downward: f64,
    /// Maximum intensity in candela.
    pub peak: f32,
    /// Vertical and horizontal angle of the maximum intensity, in degrees, as in the file.
    pub peak_angles: [f32; 2],
    /// Angles between the outermost directions with at least half of the plane's maximum intensity,
    /// in degrees: in the plane through the horizontal angles 0 and 180, and in the plane through
    /// 90 and 270.
    pub beam_angles: [f64; 2],
    /// Angles as in `beam_angles`, for a tenth of the maximum intensity.
    pub field_angles: [f64; 2],
}

impl PhotometricProfile {
    /// Computes the figures of the luminaire.
    pub fn summary(&self) -> PhotometricSummary {
        let (flux, down) = self.fluxes();
        let peak = (0..self.candela.len()).max_by(|&a, &b| self.candela[a].total_cmp(&self.candela[b]).then(b.cmp(&a)));
        let peak = peak.unwrap_or(0);
        let rows = self.vertical.len();
        let angles = |share: f32| [0.0, 90.0].map(|plane| self.width(plane, share));
        PhotometricSummary {
            flux,
            downward: if flux > 0.0 { down / flux } else { 0.0 },
            peak: self.candela[peak],
            peak_angles: [self.vertical[peak % rows], self.horizontal[peak / rows]],
            beam_angles: angles(0.5),
            field_angles: angles(0.1),
        }
    }

    /// Intensity in candela in the vertical plane at a horizontal angle, in degrees. `angle` is
    /// measured from straight down; it is negative on the opposite side of the plane.
    pub fn in_plane(&self, plane: f64, angle: f64) -> f32 {
        let plane = if angle < 0.0 { plane + 180.0 } else { plane };
        let (sin, cos) = fp::sin_cos_degrees(angle.abs());
        let (s, c) = fp::sin_cos_degrees(plane);
        self.at(Vec3::new((sin * c) as f32, (sin * s) as f32, cos as f32))
    }

    /// Angle between the outermost directions of a vertical plane in which the intensity is at
    /// least `share` of the plane's maximum, in degrees. Crossings are interpolated linearly.
    fn width(&self, plane: f64, share: f32) -> f64 {
        let count = (180.0 / STEP) as i32;
        let at = |i: i32| self.in_plane(plane, f64::from(i) * STEP);
        let limit = share * (-count..=count).map(at).fold(0.0, f32::max);
        if limit <= 0.0 {
            return 0.0;
        }
        let end = |way: i32| {
            let Some(last) = (0..=count).rev().find(|&i| at(way * i) >= limit) else { return 0.0 };
            let (inside, outside) = (at(way * last), if last < count { at(way * (last + 1)) } else { 0.0 });
            let more = if last < count { (inside - limit) / (inside - outside) } else { 0.0 };
            (f64::from(last) + f64::from(more)) * STEP
        };
        (end(1) + end(-1)).min(360.0)
    }

    /// Flux in all directions and below the horizontal plane, in lumens.
    fn fluxes(&self) -> (f64, f64) {
        let (rows, columns) = (720_u32, 360_u32);
        let (mut sum, mut down) = (0.0, 0.0);
        for i in 0..rows {
            if i == rows / 2 {
                down = sum;
            }
            let (sin, cos) = fp::sin_cos_degrees((f64::from(i) + 0.5) * 180.0 / f64::from(rows));
            for j in 0..columns {
                let (s, c) = fp::sin_cos_degrees((f64::from(j) + 0.5) * 360.0 / f64::from(columns));
                sum += f64::from(self.at(Vec3::new((sin * c) as f32, (sin * s) as f32, cos as f32))) * sin;
            }
        }
        let flux = |sum: f64| sum * 2.0 * PI * PI / f64::from(rows * columns);
        (flux(sum), flux(down))
    }

    /// Luminous flux in lumens. Apart from the sine factor, the result is exact for a profile that
    /// is linear between the angles.
    pub fn flux(&self) -> f64 {
        self.fluxes().0
    }
}

impl ProfileKind {
    /// Letter of the coordinate system.
    pub fn letter(self) -> char {
        match self {
            ProfileKind::A => 'A',
            ProfileKind::B => 'B',
            ProfileKind::C => 'C',
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn by_formula(candela: impl Fn(f64) -> f64) -> PhotometricProfile {
        let vertical: Vec<f32> = (0..=180).map(|i| i as f32).collect();
        let candela = vertical.iter().map(|&angle| candela(fp::sin_cos_degrees(f64::from(angle)).1) as f32).collect();
        PhotometricProfile { kind: ProfileKind::C, vertical, horizontal: vec![0.0], candela }
    }

    #[test]
    fn figures_of_closed_forms() {
        // Lambert's law: the flux is pi times the peak, and half of the peak is at 60 degrees.
        let lambert = by_formula(|cos| 1000.0 * cos.max(0.0)).summary();
        assert!((lambert.flux / (1000.0 * std::f64::consts::PI) - 1.0).abs() < 2e-4, "{lambert:?}");
        assert!((lambert.downward - 1.0).abs() < 1e-9);
        assert_eq!((lambert.peak, lambert.peak_angles), (1000.0, [0.0, 0.0]));
        // 2 acos(0.1)
        let tenth = 2.0 * 84.260_829_5;
        for i in 0..2 {
            assert!((lambert.beam_angles[i] - 120.0).abs() < 0.02, "{lambert:?}");
            assert!((lambert.field_angles[i] - tenth).abs() < 0.02, "{lambert:?}");
        }
        // A light of 100 cd in all directions emits 400 pi lm, half of it downwards.
        let even = by_formula(|_| 100.0).summary();
        assert!((even.flux / (400.0 * std::f64::consts::PI) - 1.0).abs() < 1e-5, "{even:?}");
        assert!((even.downward - 0.5).abs() < 1e-9 && even.beam_angles == [360.0; 2]);
        // The intensity of a spot falls as the eighth power of the cosine.
        let spot = by_formula(|cos| [cos.max(0.0); 8].iter().product()).summary();
        // 2 acos(0.5^(1 / 8))
        let half = 2.0 * 23.5080498;
        assert!((spot.beam_angles[0] - half).abs() < 0.02, "{spot:?}");
        assert!((spot.flux / (2.0 * std::f64::consts::PI / 9.0) - 1.0).abs() < 2e-3, "{spot:?}");
        let dark = by_formula(|_| 0.0).summary();
        assert_eq!((dark.flux, dark.downward, dark.beam_angles), (0.0, 0.0, [0.0; 2]));
    }

    #[test]
    fn planes_differ() {
        // 100 cd up to 30 degrees across, and up to 60 degrees along.
        let vertical: Vec<f32> = (0..=90).map(|i| i as f32).collect();
        let to = |most: f32| vertical.iter().map(move |&angle| if angle <= most { 100.0 } else { 0.0 });
        let candela = to(30.0).chain(to(60.0)).collect();
        let profile = PhotometricProfile {
            kind: ProfileKind::C,
            vertical: vertical.clone(),
            horizontal: vec![0.0, 90.0],
            candela,
        };
        let summary = profile.summary();
        assert_eq!(summary.beam_angles.map(|angle| angle.round()), [61.0, 121.0]);
    }
}
