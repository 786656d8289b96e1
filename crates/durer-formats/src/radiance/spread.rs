//! Lamps that shine otherwise in each direction: tables over the angles of a lamp, as `ies2rad`
//! writes them, and spotlights.
//!
//! Source: `source.cal` of Radiance, for the functions and the angles; the manual for spotlights.

use super::args::Thing;
use super::data::Table;
use super::words::Word;
use durer_scene::light::photometric::{Profile, ProfileKind};
use durer_scene::math::fp;
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// How a lamp's radiance depends on the direction in which it shines.
#[derive(Debug, PartialEq)]
pub(super) enum Spread {
    Table(Lamp),
    /// The same within a cone about a unit direction.
    Cone {
        aim: DVec3,
        degrees: f64,
        /// How far behind its surface it seems to come from.
        focus: f64,
    },
}

/// A table over the angles of a lamp.
#[derive(Debug, PartialEq)]
pub(super) struct Lamp {
    table: Table,
    correction: Correction,
    factor: f64,
    /// By the coordinates of the table, with what is added to each.
    angles: Vec<(Angle, f64)>,
    /// From the world into the lamp's own axes.
    turn: DMat3,
}

/// What makes a radiance of an intensity.
#[derive(Debug, PartialEq)]
enum Correction {
    Nothing,
    /// Over the cosine to the surface.
    Flat,
    /// Over the area that a box of these sides shows.
    Box(DVec3),
    /// Over the area that an upright cylinder of this diameter and height shows.
    Cylinder(f64, f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Angle {
    /// From straight down.
    Theta,
    /// Around that, from x towards y, turned back wherever it is more than so many degrees.
    Phi(f64),
    /// Of a photometer of type B, the second without its sign.
    Vertical(bool),
    Horizontal(bool),
}

impl Angle {
    /// An angle and what is added to it.
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

    /// Degrees, for a unit direction in which light goes.
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

/// How many coordinates a table has behind its function and its files, if all are a lamp's; else 0.
pub(super) fn coordinates(thing: &Thing) -> usize {
    let names = || thing.texts.iter().skip(3).take_while(|word| !word.text.starts_with('-'));
    if names().all(|word| Angle::of(&word.text).is_some()) { names().count() } else { 0 }
}

impl Lamp {
    /// By the function and the coordinates of a pattern, whose axes are turned into the world;
    /// `None` for functions of others.
    pub fn new(thing: &Thing, table: Table, turn: DMat3) -> Option<Lamp> {
        let number = |i: usize| thing.numbers.get(i).copied();
        let factor = number(0).unwrap_or(1.0).max(0.0);
        let side = |i: usize| number(i).unwrap_or(0.0).abs();
        let correction = match thing.texts.first()?.text.as_str() {
            "corr" => Correction::Nothing,
            "flatcorr" => Correction::Flat,
            // Both are the same far away.
            "boxcorr" | "lboxcorr" => Correction::Box(DVec3::new(side(1), side(2), side(3))),
            "cylcorr" => Correction::Cylinder(side(1), side(2)),
            _ => return None,
        };
        let texts: &[Word] = &thing.texts;
        let angles = texts[3..].iter().map_while(|word| Angle::of(&word.text)).collect::<Vec<_>>();
        (angles.len() == table.dimensions()).then_some(Lamp { table, correction, factor, angles, turn })
    }

    /// In a unit direction of the world, from a surface whose normal has this cosine to it.
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

impl Spread {
    /// What multiplies the radiance in a unit direction, from a surface whose normal has this
    /// cosine to it.
    pub fn at(&self, dir: DVec3, cosine: f64) -> f64 {
        match self {
            Spread::Table(lamp) => lamp.at(dir, cosine),
            Spread::Cone { aim, degrees, .. } => f64::from(aim.dot(dir) >= fp::sin_cos_degrees(*degrees).1),
        }
    }

    pub fn focal_length(&self) -> f64 {
        match self {
            Spread::Table(_) => 0.0,
            Spread::Cone { focus, .. } => *focus,
        }
    }

    /// The direction from which its angles are best told, and one across it.
    pub fn axes(&self) -> [DVec3; 2] {
        match self {
            Spread::Table(lamp) => {
                let back = lamp.turn.transpose();
                [-back.z_axis, back.x_axis].map(DVec3::normalize_or_zero)
            }
            Spread::Cone { aim, .. } => [*aim, aim.any_orthonormal_vector()],
        }
    }

    /// How strong a surface shines in each direction, over its area and its radiance: `shows` is
    /// the share of its area that is seen in a direction, and its cosine there.
    pub fn profile(&self, shows: impl Fn(DVec3) -> (f64, f64)) -> Profile {
        let [down, front] = self.axes();
        let side = front.cross(down);
        let whole = |steps: u32, most: f64| (0..=steps).map(move |i| most * f64::from(i) / f64::from(steps));
        let vertical: Vec<f64> = match self {
            Spread::Table(_) => whole(180, 180.0).collect(),
            // It ends at once.
            Spread::Cone { degrees, .. } if *degrees < 179.9 => {
                whole(36, *degrees).chain([degrees + 0.01, 180.0]).collect()
            }
            Spread::Cone { .. } => whole(90, 180.0).collect(),
        };
        let mut horizontal: Vec<f64> = whole(72, 360.0).collect();
        let value = |around: f64, from: f64| {
            let [(sine, cosine), (s, c)] = [from, around].map(fp::sin_cos_degrees);
            let dir = cosine * down + sine * (c * front + s * side);
            let (share, facing) = shows(dir);
            // Where a cone ends its angle is known better than by the cosine of a direction.
            let strength = match self {
                Spread::Table(lamp) => lamp.at(dir, facing),
                Spread::Cone { degrees, .. } => f64::from(from <= *degrees),
            };
            // What is not seen may be as strong as it likes.
            if share > 0.0 { (share * strength) as f32 } else { 0.0 }
        };
        let column = |&around: &f64| vertical.iter().map(move |&from| (around, from));
        let mut candela: Vec<f32> =
            horizontal.iter().flat_map(column).map(|(around, from)| value(around, from)).collect();
        let rows = vertical.len();
        let most = candela.iter().copied().fold(0.0, f32::max);
        if (rows..candela.len()).all(|i| (candela[i] - candela[i % rows]).abs() <= 1e-4 * most) {
            // The same all around.
            (horizontal, candela) = (vec![0.0], candela[..rows].to_vec());
        }
        let single = |angles: Vec<f64>| angles.into_iter().map(|angle| angle as f32).collect();
        Profile { kind: ProfileKind::C, vertical: single(vertical), horizontal: single(horizontal), candela }
    }
}
