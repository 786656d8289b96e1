//! Rays as they lie in arrays.

use durer::math::{Ray, Vec3};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// So many rays are one job: their copies stay in a near cache.
pub const JOB: usize = 2048;

/// How many rays there are; their origins and directions, and where they begin and end: a row for
/// each ray, or one for all.
pub type Asked<'py> = (
    usize,
    PyReadonlyArray2<'py, f32>,
    PyReadonlyArray2<'py, f32>,
    PyReadonlyArray1<'py, f32>,
    PyReadonlyArray1<'py, f32>,
);

/// Rays as they lie in arrays.
#[derive(Clone, Copy)]
pub struct Rays<'a> {
    pub count: usize,
    origins: &'a [f32],
    directions: &'a [f32],
    t_min: &'a [f32],
    t_max: &'a [f32],
}

/// Points in a row: three numbers each.
pub fn points<'a>(array: &'a PyReadonlyArray2<'_, f32>) -> PyResult<&'a [f32]> {
    let wrong = || PyValueError::new_err("points are rows of three float32, one after the other");
    array.as_slice().ok().filter(|slice| slice.len().is_multiple_of(3)).ok_or_else(wrong)
}

/// The i-th of some points, or the only one.
pub fn point(points: &[f32], i: usize) -> Vec3 {
    let at = if points.len() == 3 { 0 } else { 3 * i };
    Vec3::new(points[at], points[at + 1], points[at + 2])
}

impl<'a> Rays<'a> {
    /// The rays of arrays, if these are long enough.
    pub fn new((count, origins, directions, t_min, t_max): &'a Asked) -> PyResult<Self> {
        let wrong = || PyValueError::new_err("rays are float32, one after the other, one for all or one for each");
        let count = *count;
        let (origins, directions) = (points(origins)?, points(directions)?);
        let (t_min, t_max) = (t_min.as_slice()?, t_max.as_slice()?);
        let fits = |length: usize, each: usize| length == each || length == each * count;
        let all = fits(origins.len(), 3) && fits(directions.len(), 3) && fits(t_min.len(), 1) && fits(t_max.len(), 1);
        all.then_some(Rays { count, origins, directions, t_min, t_max }).ok_or_else(wrong)
    }

    /// Those of a job, by the number of the first.
    pub fn job(&self, first: usize) -> Vec<Ray> {
        let step = |list: &[f32], each: usize| if list.len() == each { 0 } else { each };
        let (origin, direction) = (step(self.origins, 3), step(self.directions, 3));
        let (t_min, t_max) = (step(self.t_min, 1), step(self.t_max, 1));
        let ray = |i| Ray {
            origin: Vec3::from_slice(&self.origins[i * origin..]),
            dir: Vec3::from_slice(&self.directions[i * direction..]),
            t_min: self.t_min[i * t_min],
            t_max: self.t_max[i * t_max],
        };
        (first..self.count.min(first + JOB)).map(ray).collect()
    }
}
