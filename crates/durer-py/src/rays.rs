//! Rays that are stored in numpy arrays.

use durer::math::{Ray, Ray64, Vec3};
use glam::DVec3;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Number of rays per job, chosen so that the copied rays fit in the cache.
pub const JOB: usize = 2048;

/// Numpy array of points or directions, in single or double precision.
#[derive(FromPyObject)]
pub enum PointArray<'py> {
    Single(PyReadonlyArray2<'py, f32>),
    Double(PyReadonlyArray2<'py, f64>),
}

/// Rays as passed from Python, with their number, origins, directions, `t_min` and `t_max`. Each
/// array has either one row per ray or a single row for all rays.
pub type RayArrays<'py> =
    (usize, PointArray<'py>, PyReadonlyArray2<'py, f32>, PyReadonlyArray1<'py, f32>, PyReadonlyArray1<'py, f32>);

/// Points borrowed from a contiguous array in either precision, with one point per element or a
/// single point for all.
#[derive(Clone, Copy)]
pub enum Points<'a> {
    Single(&'a [f32]),
    Double(&'a [f64]),
}

impl<'a> Points<'a> {
    /// Borrows the points that are stored in an array.
    pub fn new(array: &'a PointArray<'_>) -> PyResult<Self> {
        let wrong = || PyValueError::new_err("points must be contiguous rows of three numbers");
        match array {
            PointArray::Single(array) => Ok(Points::Single(points(array)?)),
            PointArray::Double(array) => {
                let rows = array.as_slice().ok().filter(|slice| slice.len().is_multiple_of(3)).ok_or_else(wrong)?;
                Ok(Points::Double(rows))
            }
        }
    }

    /// Returns the number of rows in the array.
    pub fn count(&self) -> usize {
        match self {
            Points::Single(rows) => rows.len() / 3,
            Points::Double(rows) => rows.len() / 3,
        }
    }

    /// Returns point `i`, or the single point if it applies to all elements.
    pub fn at(&self, i: usize) -> DVec3 {
        let at = if self.count() == 1 { 0 } else { 3 * i };
        match self {
            Points::Single(rows) => Vec3::from_slice(&rows[at..]).as_dvec3(),
            Points::Double(rows) => DVec3::from_slice(&rows[at..]),
        }
    }

    /// Returns point `i` relative to `center`, rounded once to single precision.
    pub fn relative_to(&self, center: DVec3, i: usize) -> Vec3 {
        (self.at(i) - center).as_vec3()
    }
}

/// Rays of a query, borrowed from numpy arrays and read in jobs of [`JOB`] rays.
#[derive(Clone, Copy)]
pub struct Rays<'a> {
    pub count: usize,
    origins: Points<'a>,
    directions: &'a [f32],
    t_min: &'a [f32],
    t_max: &'a [f32],
}

/// Borrows an array as contiguous points.
pub fn points<'a>(array: &'a PyReadonlyArray2<'_, f32>) -> PyResult<&'a [f32]> {
    let wrong = || PyValueError::new_err("points must be contiguous rows of three float32 numbers");
    array.as_slice().ok().filter(|slice| slice.len().is_multiple_of(3)).ok_or_else(wrong)
}

impl<'a> Rays<'a> {
    /// Borrows rays from arrays, after checking that the lengths of the arrays match.
    pub fn new((count, origins, directions, t_min, t_max): &'a RayArrays) -> PyResult<Self> {
        let message = "origins, directions, t_min and t_max must have one entry for all rays or one entry per ray";
        let wrong = || PyValueError::new_err(message);
        let count = *count;
        let (origins, directions) = (Points::new(origins)?, points(directions)?);
        let (t_min, t_max) = (t_min.as_slice()?, t_max.as_slice()?);
        let fits = |length: usize, each: usize| length == each || length == each * count;
        let all = fits(origins.count(), 1) && fits(directions.len(), 3) && fits(t_min.len(), 1) && fits(t_max.len(), 1);
        all.then_some(Rays { count, origins, directions, t_min, t_max }).ok_or_else(wrong)
    }

    /// Returns the rays of the job that begins with ray `first`. Origins are relative to `center`,
    /// and are rounded once.
    pub fn job(&self, first: usize, center: DVec3) -> Vec<Ray> {
        match self.origins {
            Points::Single(rows) if center == DVec3::ZERO => {
                let step = if rows.len() == 3 { 0 } else { 3 };
                self.map_job(first, |i, dir, t_min, t_max| Ray {
                    origin: Vec3::from_slice(&rows[i * step..]),
                    dir,
                    t_min,
                    t_max,
                })
            }
            origins => self.map_job(first, |i, dir, t_min, t_max| Ray {
                origin: origins.relative_to(center, i),
                dir,
                t_min,
                t_max,
            }),
        }
    }

    /// Returns the rays of the job that begins with ray `first`, with origins in double precision.
    pub fn exact_job(&self, first: usize) -> Vec<Ray64> {
        self.map_job(first, |i, dir, t_min, t_max| Ray64::new(self.origins.at(i), dir, t_min, t_max))
    }

    /// Calls the function `ray` for each ray of a job, and collects the results.
    #[inline(always)]
    fn map_job<R>(&self, first: usize, ray: impl Fn(usize, Vec3, f32, f32) -> R) -> Vec<R> {
        let step = |list: &[f32], each: usize| if list.len() == each { 0 } else { each };
        let (direction, t_min, t_max) = (step(self.directions, 3), step(self.t_min, 1), step(self.t_max, 1));
        let one = |i| {
            let dir = Vec3::from_slice(&self.directions[i * direction..]);
            ray(i, dir, self.t_min[i * t_min], self.t_max[i * t_max])
        };
        (first..self.count.min(first + JOB)).map(one).collect()
    }
}
