//! Directional distributions of emitters, which are spotlights or tables over angles in the form
//! that `ies2rad` writes.
//!
//! Source: Radiance's `source.cal` for the functions and angles, and the reference manual for
//! spotlights.

use super::args::RadPrimitive;
use super::data::Table;
use super::words::Word;
use durer_scene::light::photometric::{PhotometricProfile, ProfileKind};
use durer_scene::math::fp;
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// Directional distribution of an emitter, which gives a factor for its radiance in each direction
/// of emission.
#[derive(Debug, PartialEq)]
pub(super) enum DirectionalDistribution {
    Table(IntensityTable),
    /// Cone around a unit direction. The factor is constant inside and 0 outside, and `degrees` is
    /// the half angle.
    Cone {
        aim: DVec3,
        degrees: f64,
        /// Distance by which the apparent origin of the light is behind the surface.
        focus: f64,
    },
}

/// Directional distribution that is given by a table over the angles of a light, as in photometric
/// data.
#[derive(Debug, PartialEq)]
pub(super) struct IntensityTable {
    table: Table,
    correction: Correction,
    factor: f64,
    /// Angle that each coordinate of the table represents, and an offset in degrees.
    angles: Vec<(Angle, f64)>,
    /// Rotation from world space to the axes of the light.
    turn: DMat3,
}

/// Correction that converts the light intensity in a table to radiance.
#[derive(Debug, PartialEq)]
enum Correction {
    Nothing,
    /// Divides by the cosine of the angle to the surface normal.
    Flat,
    /// Divides by the projected area of a box with these side lengths.
    Box(DVec3),
    /// Divides by the projected area of an upright cylinder with this diameter and this height.
    Cylinder(f64, f64),
}

/// Angle of an emission direction that a coordinate of the table represents.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Angle {
    /// Angle between the emission direction and the downward direction.
    Theta,
    /// Angle around the vertical axis, measured from x towards y. The angle is mirrored at
    /// multiples of this number of degrees.
    Phi(f64),
    /// Vertical or horizontal angle of a type B photometer. If the flag is true, the sign of the
    /// angle is dropped.
    Vertical(bool),
    Horizontal(bool),
}

impl Angle {
    /// Parses the name of an angle, and returns the angle and its offset.
    fn of(name: &str) -> Option<(Angle, f64)> {
        let at = name.find(['+', '-']).unwrap_or(name.len());
        let (name, more) = name.split_at(at);
        let more = if more.is_empty() { 0.0 } else { more.parse().ok()? };
        let angle = match name {
            "src_theta" => Angle::Theta,
            "src_phi" => Angle::Phi(360.0),
            "src_phi2" => Angle::Phi(180.0),
            "src_phi4" => Angle::Phi(90.0),
            "srcB_vert" => Angle::Vertical(false),
            "srcB_vert2" => Angle::Vertical(true),
            "srcB_horiz" => Angle::Horizontal(false),
            "srcB_horiz2" => Angle::Horizontal(true),
            _ => return None,
        };
        Some((angle, more))
    }

    /// Returns this angle in degrees for a unit direction of emission.
    fn at(self, e: DVec3) -> f64 {
        let degrees = |y: f64, x: f64| f64::from(fp::atan2(y as f32, x as f32)) * 180.0 / PI;
        match self {
            Angle::Theta => degrees((e.x * e.x + e.y * e.y).sqrt(), -e.z),
            Angle::Phi(most) => {
                let around = degrees(e.y, e.x).rem_euclid(360.0);
                let folded = around.rem_euclid(2.0 * most);
                if folded > most { 2.0 * most - folded } else { folded }
            }
            Angle::Vertical(bare) => Angle::bare(degrees(e.x, -e.z), bare),
            Angle::Horizontal(bare) => Angle::bare(degrees(-e.y, -e.z), bare),
        }
    }

    fn bare(degrees: f64, bare: bool) -> f64 {
        if bare { degrees.abs() } else { degrees }
    }
}

/// Returns the number of coordinates in the arguments of a pattern, where they follow the function
/// and the files. The number is 0 if one of the coordinates is not an angle of a light.
pub(super) fn coordinates(primitive: &RadPrimitive) -> usize {
    let names = || primitive.texts.iter().skip(3).take_while(|word| !word.text.starts_with('-'));
    if names().all(|word| Angle::of(&word.text).is_some()) { names().count() } else { 0 }
}

impl IntensityTable {
    /// Creates the distribution from the function and the coordinates of a pattern. Returns `None`
    /// if the function is not from `source.cal`. The matrix `turn` rotates from world space to the
    /// axes of the light.
    pub fn new(primitive: &RadPrimitive, table: Table, turn: DMat3) -> Option<IntensityTable> {
        let number = |i: usize| primitive.numbers.get(i).copied();
        let factor = number(0).unwrap_or(1.0).max(0.0);
        let side = |i: usize| number(i).unwrap_or(0.0).abs();
        let correction = match primitive.texts.first()?.text.as_str() {
            "corr" => Correction::Nothing,
            "flatcorr" => Correction::Flat,
            // At a distance, both corrections are equal.
            "boxcorr" | "lboxcorr" => Correction::Box(DVec3::new(side(1), side(2), side(3))),
            "cylcorr" => Correction::Cylinder(side(1), side(2)),
            _ => return None,
        };
        let texts: &[Word] = &primitive.texts;
        let angles = texts[3..].iter().map_while(|word| Angle::of(&word.text)).collect::<Vec<_>>();
        (angles.len() == table.dimensions()).then_some(IntensityTable { table, correction, factor, angles, turn })
    }

    /// Returns the factor for a unit direction in world space. `cosine` is the cosine of the angle
    /// to the surface normal.
    fn at(&self, dir: DVec3, cosine: f64) -> f64 {
        let e = (self.turn * dir).normalize_or_zero();
        let angles: Vec<f64> = self.angles.iter().map(|(angle, more)| angle.at(e) + more).collect();
        let shown = match self.correction {
            Correction::Nothing => 1.0,
            Correction::Flat => cosine,
            Correction::Box(s) => e.x.abs() * s.y * s.z + e.y.abs() * s.x * s.z + e.z.abs() * s.x * s.y,
            Correction::Cylinder(width, height) => {
                width * height * (1.0 - e.z * e.z).max(0.0).sqrt() + PI / 4.0 * width * width * e.z.abs()
            }
        };
        if shown > 1e-9 { (self.factor * self.table.at(&angles) / shown).max(0.0) } else { 0.0 }
    }
}

impl DirectionalDistribution {
    /// Returns the factor that multiplies the radiance in a unit direction in world space. `cosine`
    /// is the cosine of the angle to the surface normal.
    pub fn at(&self, dir: DVec3, cosine: f64) -> f64 {
        match self {
            DirectionalDistribution::Table(light) => light.at(dir, cosine),
            DirectionalDistribution::Cone { aim, degrees, .. } => {
                f64::from(aim.dot(dir) >= fp::sin_cos_degrees(*degrees).1)
            }
        }
    }

    /// Returns the distance by which the apparent origin of the light is behind the surface.
    pub fn focal_length(&self) -> f64 {
        match self {
            DirectionalDistribution::Table(_) => 0.0,
            DirectionalDistribution::Cone { focus, .. } => *focus,
        }
    }

    /// Returns the axis from which the angles are measured, and a direction that is perpendicular
    /// to it.
    pub fn axes(&self) -> [DVec3; 2] {
        match self {
            DirectionalDistribution::Table(light) => {
                let back = light.turn.transpose();
                [-back.z_axis, back.x_axis].map(DVec3::normalize_or_zero)
            }
            DirectionalDistribution::Cone { aim, .. } => [*aim, aim.any_orthonormal_vector()],
        }
    }

    /// Returns the light profile of a surface for a unit area and a unit radiance. For a direction,
    /// `shows` returns the projected area as a fraction of the area, and the cosine of the angle to
    /// the normal.
    pub fn profile(&self, shows: impl Fn(DVec3) -> (f64, f64)) -> PhotometricProfile {
        let [down, front] = self.axes();
        let side = front.cross(down);
        let whole = |steps: u32, most: f64| (0..=steps).map(move |i| most * f64::from(i) / f64::from(steps));
        let vertical: Vec<f64> = match self {
            DirectionalDistribution::Table(_) => whole(180, 180.0).collect(),
            // The cone has a sharp edge.
            DirectionalDistribution::Cone { degrees, .. } if *degrees < 179.9 => {
                whole(36, *degrees).chain([degrees + 0.01, 180.0]).collect()
            }
            DirectionalDistribution::Cone { .. } => whole(90, 180.0).collect(),
        };
        let mut horizontal: Vec<f64> = whole(72, 360.0).collect();
        let value = |around: f64, from: f64| {
            let [(sine, cosine), (s, c)] = [from, around].map(fp::sin_cos_degrees);
            let dir = cosine * down + sine * (c * front + s * side);
            let (share, facing) = shows(dir);
            // Compare angles at the edge of the cone, which is more precise than comparing the
            // cosines of directions.
            let strength = match self {
                DirectionalDistribution::Table(light) => light.at(dir, facing),
                DirectionalDistribution::Cone { degrees, .. } => f64::from(from <= *degrees),
            };
            // Avoid NaN in directions from which the surface is not visible and in which the factor
            // is infinite.
            if share > 0.0 { (share * strength) as f32 } else { 0.0 }
        };
        let column = |&around: &f64| vertical.iter().map(move |&from| (around, from));
        let mut candela: Vec<f32> =
            horizontal.iter().flat_map(column).map(|(around, from)| value(around, from)).collect();
        let rows = vertical.len();
        let most = candela.iter().copied().fold(0.0, f32::max);
        if (rows..candela.len()).all(|i| (candela[i] - candela[i % rows]).abs() <= 1e-4 * most) {
            // The distribution has rotational symmetry.
            (horizontal, candela) = (vec![0.0], candela[..rows].to_vec());
        }
        let single = |angles: Vec<f64>| angles.into_iter().map(|angle| angle as f32).collect();
        PhotometricProfile { kind: ProfileKind::C, vertical: single(vertical), horizontal: single(horizontal), candela }
    }
}
