//! Known facts about a photograph or the world in it: points, lines, and control points.

use crate::Observation;
use nalgebra::{Vector2, Vector3};

/// A world point and its pixel.
pub type Pair = (Vector3<f64>, Vector2<f64>);

/// A world point and its observations.
pub type Control = (Vector3<f64>, Vec<Observation>);

/// A direction along a world axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Axis {
    /// 0, 1, 2 for x, y, z.
    pub index: usize,
    /// True if the direction points to smaller values.
    pub negative: bool,
}

impl Axis {
    /// Parses a name: `x`, `-x`, and so on, or `xPositive`, `xNegative` as in fSpy.
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

/// Lines of a photograph that are parallel in the world, in two perpendicular directions.
#[derive(Debug, Clone)]
pub struct VanishingLines {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Principal point in pixels.
    pub center: Vector2<f64>,
    /// Pixel of the world origin.
    pub origin: Vector2<f64>,
    /// World axis that leads towards each vanishing point.
    pub axes: [Axis; 2],
    /// Lines for each axis, given by two of their pixels.
    pub lines: [Vec<[Vector2<f64>; 2]>; 2],
}
