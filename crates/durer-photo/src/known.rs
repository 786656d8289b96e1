//! User input about the world that a photograph shows: points, parallel lines, and control points.

use crate::Observation;
use nalgebra::{Vector2, Vector3};

/// World point, and the pixel at which it appears in a photograph.
pub type PointPixelPair = (Vector3<f64>, Vector2<f64>);

/// Control point with a known position in the world, and its observations.
pub type ControlPoint = (Vector3<f64>, Vec<Observation>);

/// Signed world axis, such as x or -y, towards which a set of vanishing lines leads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Axis {
    /// Index of the axis: 0, 1, 2 for x, y, z.
    pub index: usize,
    /// True if the axis has a negative sign.
    pub negative: bool,
}

impl Axis {
    /// Parses the name of an axis: `x`, `-x`, and so on, or fSpy's `xPositive` and `xNegative`.
    pub fn parse(name: &str) -> Option<Self> {
        let (bare, negative) = match name {
            name if name.ends_with("Negative") => (name.trim_end_matches("Negative"), true),
            name if name.starts_with('-') => (&name[1..], true),
            name => (name.trim_end_matches("Positive").trim_start_matches('+'), false),
        };
        Some(Axis { index: ["x", "y", "z"].iter().position(|axis| *axis == bare)?, negative })
    }

    /// Returns the unit vector of the axis.
    pub(crate) fn direction(self) -> Vector3<f64> {
        Vector3::ith(self.index, if self.negative { -1.0 } else { 1.0 })
    }
}

/// Input for computing a camera from vanishing points. It contains two sets of lines in a
/// photograph, each parallel to one world axis.
#[derive(Debug, Clone)]
pub struct VanishingLines {
    /// Width and height of the photograph in pixels.
    pub size: [u32; 2],
    /// Principal point in pixels.
    pub center: Vector2<f64>,
    /// Pixel at which the world origin appears.
    pub origin: Vector2<f64>,
    /// World axis that leads towards each vanishing point.
    pub axes: [Axis; 2],
    /// Lines that lead along each axis. A line is given by two points in pixels.
    pub lines: [Vec<[Vector2<f64>; 2]>; 2],
}
