//! Photometric light: a point light with a measured intensity in each direction.

use super::{Illuminate, LightLiSample, with_luminance};
use crate::describe::{Constraint, FileName, described};
use crate::dialect::set;
use crate::math::{Color, Vec3, fp};
use crate::source::Digest;
use glam::DVec3;
use std::f32::consts::PI;

described! {
    /// Point light with a measured intensity distribution in candela, from an IES or EULUMDAT file.
    PhotometricLight ["PhotometricLight" in set::DURER] {
        /// Position.
        position: Vec3 = Vec3::ZERO, required, Constraint::Any, ["position" in set::DURER];
        /// Measurement: an IES file (LM-63-1986 to 2019) or an EULUMDAT file (`.ldt`).
        file: FileName = FileName::default(), required, Constraint::Any, ["file" in set::DURER];
        /// Direction that the lower side of the light faces, of any length.
        direction: Vec3 = Vec3::NEG_Y, optional, Constraint::NonZero, ["direction" in set::DURER];
        /// Direction of horizontal angle 0; made perpendicular to `direction`.
        front: Vec3 = Vec3::X, optional, Constraint::NonZero, ["front" in set::DURER];
        /// Distance behind the position at which the light appears to originate, for example with a
        /// reflector: light at distance d fades as if at d + `focalLength`.
        focal_length: f32 = 0.0, optional, Constraint::NonNegative, ["focalLength" in set::DURER];
        /// Factor on the measured light, per colour channel.
        color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["color" in set::DURER];
        /// Luminous flux in lumens, instead of the value in the file; `color` then sets only the
        /// hue.
        lumens: Option<f32> = None, optional, Constraint::NonNegative, ["lumens" in set::DURER];
        /// Measured spectrum, multiplied by `color`: a file (`lamp.csv`, `lamps.csv:column`) or an
        /// illuminant (A, D65, F2, 2700K). `--color spectral` uses the spectrum; otherwise its RGB
        /// colour is used.
        spectrum: Option<FileName> = None, optional, Constraint::Any, ["spectrum" in set::DURER];
    }
}

impl PhotometricLight {
    /// Returns the light with its `lumens`, if set, converted to its colour.
    pub fn with_flux(&self, profile: &PhotometricProfile) -> Self {
        let Some(lumens) = self.lumens else { return self.clone() };
        let flux = profile.flux() as f32;
        let color = if flux > 0.0 { with_luminance(self.color, lumens / flux) } else { Color::ZERO };
        PhotometricLight { color, lumens: None, ..self.clone() }
    }
}

impl Illuminate for PhotometricLight {
    /// Returns the light for an intensity of 1 candela in all directions. The caller multiplies it
    /// by the profile.
    fn illuminate(&self, point: DVec3) -> LightLiSample {
        let offset = (self.position.as_dvec3() - point).as_vec3();
        let distance = offset.length();
        // The colour of a light is the radiance of a white diffuse surface, which is the
        // illuminance divided by pi.
        let faded = distance + self.focal_length;
        let color = self.color / (PI * faded * faded);
        LightLiSample { to_light: offset.normalize_or(Vec3::Y), distance, color }
    }

    fn color(&self) -> Color {
        self.color
    }

    fn color_mut(&mut self) -> &mut Color {
        &mut self.color
    }

    fn spectrum(&self) -> Option<&FileName> {
        self.spectrum.as_ref()
    }

    /// Converting `lumens` requires the photometric file; see [`PhotometricLight::with_flux`].
    fn with_unit_color(&self) -> Self {
        self.clone()
    }

    fn inverse_square(&self) -> Option<(Vec3, Color)> {
        Some((self.position, self.color / PI))
    }

    fn profile(&self) -> Option<&FileName> {
        Some(&self.file)
    }

    fn to_profile(&self, dir: Vec3) -> Vec3 {
        let down = self.direction.normalize_or(Vec3::NEG_Y);
        let front = self.front - down * self.front.dot(down);
        let front = front.try_normalize().unwrap_or_else(|| down.any_orthonormal_vector());
        Vec3::new(dir.dot(front), dir.dot(front.cross(down)), dir.dot(down))
    }

    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    fn position(&self) -> Option<Vec3> {
        Some(self.position)
    }

    fn direction(&self) -> Option<Vec3> {
        Some(self.direction)
    }

    /// Use 90 degrees, since most luminaires light the hemisphere below them.
    fn cone(&self) -> Option<f32> {
        Some(90.0)
    }

    fn angular_radius(&self) -> f32 {
        0.0
    }
}

/// Measured intensity of a luminaire in each direction, from an IES or EULUMDAT file.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotometricProfile {
    /// Coordinate system of the angles.
    pub kind: ProfileKind,
    /// Vertical angles in degrees, in ascending order.
    pub vertical: Vec<f32>,
    /// Horizontal angles in degrees, in ascending order.
    pub horizontal: Vec<f32>,
    /// Intensities in candela, with the vertical angle varying fastest.
    pub candela: Vec<f32>,
}

/// Coordinate system of a photometric measurement: type A, B or C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProfileKind {
    /// Type C: vertical angles are measured from straight down, and horizontal angles around that
    /// axis.
    C,
    /// Type B: planes are rotated about the horizontal axis that runs across the front of the
    /// luminaire.
    B,
    /// Type A: planes are rotated about the vertical axis.
    A,
}

impl PhotometricProfile {
    /// Hash of the entire profile.
    pub fn digest(&self) -> Digest {
        let mut hasher = Digest::hasher();
        hasher.add_u64(self.kind as u64);
        for values in [&self.vertical, &self.horizontal, &self.candela] {
            hasher.add_u64(values.len() as u64);
            values.iter().for_each(|value| hasher.add_u32(value.to_bits()));
        }
        hasher.finish()
    }

    /// Maximum intensity, in candela.
    pub fn max_candela(&self) -> f32 {
        self.candela.iter().copied().fold(0.0, f32::max)
    }

    /// Intensity in candela in a direction, interpolated linearly between angles. It is 0 outside
    /// the range of vertical angles. In `dir`, x points to horizontal angle 0 and z points down.
    pub fn at(&self, dir: Vec3) -> f32 {
        let degrees = |y: f32, x: f32| fp::atan2(y, x).to_degrees();
        let across = |a: f32, b: f32| (a * a + b * b).sqrt();
        let (vertical, horizontal) = match self.kind {
            ProfileKind::C => (degrees(across(dir.x, dir.y), dir.z), degrees(dir.y, dir.x)),
            // The luminaire faces z, which points down when it is mounted. Angles increase towards
            // y and x.
            ProfileKind::B => (degrees(dir.x, across(dir.y, dir.z)), degrees(dir.y, dir.z)),
            ProfileKind::A => (degrees(dir.y, across(dir.x, dir.z)), degrees(dir.x, dir.z)),
        };
        let horizontal = self.apply_symmetry(horizontal);
        // If the file contains only one half of the distribution, mirror it.
        let vertical = if self.vertical[0] >= 0.0 { vertical.abs() } else { vertical };
        let (Some((i, a)), Some((j, b))) = (place(&self.vertical, vertical), place(&self.horizontal, horizontal))
        else {
            return 0.0;
        };
        let value = |i: usize, j: usize| {
            let (i, j) = (i.min(self.vertical.len() - 1), j.min(self.horizontal.len() - 1));
            self.candela[j * self.vertical.len() + i]
        };
        let row = |j: usize| value(i, j) * (1.0 - a) + value(i + 1, j) * a;
        row(j) * (1.0 - b) + row(j + 1) * b
    }

    /// Maps a horizontal angle into the range of angles in the file, using the symmetry that this
    /// range implies.
    fn apply_symmetry(&self, angle: f32) -> f32 {
        let (first, last) = (self.horizontal[0], self.horizontal[self.horizontal.len() - 1]);
        if self.horizontal.len() == 1 {
            return first;
        }
        if self.kind != ProfileKind::C {
            return if first >= 0.0 { angle.abs() } else { angle };
        }
        let angle = angle.rem_euclid(360.0);
        let half = if angle > 180.0 { 360.0 - angle } else { angle };
        match (first, last) {
            (0.0, 90.0) => half.min(180.0 - half),
            (0.0, 180.0) => half,
            // The distribution is symmetric about the plane through 90 and 270 degrees.
            (90.0, 270.0) if angle < 90.0 => 180.0 - angle,
            (90.0, 270.0) if angle > 270.0 => 540.0 - angle,
            _ => angle,
        }
    }
}

/// Index of the last angle at or before `wanted`, and the position between that angle and the next
/// as a fraction. `None` if `wanted` is out of range.
fn place(angles: &[f32], wanted: f32) -> Option<(usize, f32)> {
    const SLACK: f32 = 1e-3;
    let (first, last) = (angles[0], angles[angles.len() - 1]);
    if angles.len() == 1 {
        return Some((0, 0.0));
    }
    if wanted < first - SLACK || wanted > last + SLACK {
        return None;
    }
    let i = angles.partition_point(|&angle| angle <= wanted).clamp(1, angles.len() - 1) - 1;
    Some((i, ((wanted - angles[i]) / (angles[i + 1] - angles[i])).clamp(0.0, 1.0)))
}

mod summary;

pub use summary::PhotometricSummary;
