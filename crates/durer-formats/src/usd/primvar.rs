//! Primvars: values over the points, faces or corners of a mesh.

use super::layer::Value;
use super::stage::{Prim, Stage};

/// Name of the primvar with the display colour.
pub(super) const DISPLAY_COLOR: &str = "primvars:displayColor";

/// Elements of a mesh to which the values of a primvar belong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Interpolation {
    Constant,
    Face,
    Point,
    Corner,
}

/// Values over the elements of a mesh.
pub(super) struct Primvar {
    pub width: usize,
    pub values: Vec<f64>,
    /// Index of the value of each element; empty if the values are in the order of the elements.
    indices: Vec<f64>,
    pub interpolation: Interpolation,
}

impl Primvar {
    /// Reads an attribute with the number of components `width`. `default` is the interpolation if
    /// the file does not state one.
    pub fn read(stage: &Stage, prim: &Prim, name: &str, width: usize, default: Interpolation) -> Option<Primvar> {
        let opinion = prim.get(stage, name)?;
        let values = opinion.value.numbers().to_vec();
        if values.is_empty() || values.len() % width != 0 {
            return None;
        }
        let indices = prim.numbers(stage, &format!("{name}:indices"));
        let interpolation = match opinion.metadata.get("interpolation").and_then(Value::text) {
            Some("constant") => Interpolation::Constant,
            Some("uniform") => Interpolation::Face,
            Some("vertex" | "varying") => Interpolation::Point,
            Some("faceVarying") => Interpolation::Corner,
            _ => default,
        };
        Some(Primvar { width, values, indices, interpolation })
    }

    /// Reads a constant attribute of an ancestor, which prims below it inherit.
    pub fn inherited(stage: &Stage, ancestor: Option<&Prim>, name: &str, width: usize) -> Option<Primvar> {
        let values = Primvar::read(stage, ancestor?, name, width, Interpolation::Constant)?;
        (values.interpolation == Interpolation::Constant).then_some(values)
    }

    /// Returns the index of the value at a corner, given the indices of its face, point and corner.
    pub fn index(&self, face: usize, point: usize, corner: usize) -> Option<usize> {
        let element = match self.interpolation {
            Interpolation::Constant => 0,
            Interpolation::Face => face,
            Interpolation::Point => point,
            Interpolation::Corner => corner,
        };
        let index = match self.indices.is_empty() {
            true => element,
            false => *self.indices.get(element).filter(|index| **index >= 0.0)? as usize,
        };
        (index < self.values.len() / self.width).then_some(index)
    }

    /// Returns the components of a value.
    pub fn value(&self, index: usize) -> &[f64] {
        &self.values[self.width * index..self.width * (index + 1)]
    }
}
