//! What somebody knows of a photograph, or of the world in it: points, lines, control points.

use crate::Observation;
use nalgebra::{Vector2, Vector3};

/// A point of the world and its pixel.
pub type Pair = (Vector3<f64>, Vector2<f64>);

/// A place of the world, and where photographs see it.
pub type Control = (Vector3<f64>, Vec<Observation>);

/// A direction along an axis of the world.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Axis {
    /// 0, 1, 2 for x, y, z.
    pub index: usize,
    /// Whether it points to smaller values.
    pub negative: bool,
}

impl Axis {
    /// By its name: `x`, `-x` and so on, or as fSpy has it, `xPositive`, `xNegative`.
    pub fn parse(name: &str) -> Option<Self> {
        let (bare, negative) = match name {
            name if name.ends_with("Negative") => (name.trim_end_matches("Negative"), true),
            name if name.starts_with('-') => (&name[1..], true),
            name => (name.trim_end_matches("Positive").trim_start_matches('+'), false),
        };
        Some(Axis { index: ["x", "y", "z"].iter().position(|axis| *axis == bare)?, negative })
    }

    pub(crate) fn direction(self) -> Vector3<f64> {
        Vector3::ith(self.index, if self.negative { -1.0 } else { 1.0 })
    }
}

/// Lines of a photograph that are parallel in the world, in two directions at right angles to each
/// other.
#[derive(Debug, Clone)]
pub struct VanishingLines {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The principal point in pixels.
    pub center: Vector2<f64>,
    /// The pixel of the world's origin.
    pub origin: Vector2<f64>,
    /// The axis of the world that leads towards each vanishing point.
    pub axes: [Axis; 2],
    /// For each, lines by two of their pixels.
    pub lines: [Vec<[Vector2<f64>; 2]>; 2],
}
