//! Illuminance at points, which backs `World.measure`.

use crate::work::watched;
use crate::world::{Pairs, World, options};
use durer::integrator::{Integrator, IntegratorContext};
use durer::math::{LUMINANCE, Vec3};
use durer::measure::{IlluminanceKind, MeasureOptions, Measurement, Sensor, measure as measure_light};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

/// Steps of the progress that `watch` gets.
const PROGRESS_STEPS: u64 = 1000;

/// Measured light for Python: the irradiance of each channel, the illuminance, its standard error
/// and the number of samples of each point, and true if rare lights dominate an error.
type Light<'py> =
    (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<u32>>, bool);

/// Measures the light at `sensors`: points of shape (n, 3) and unit normals of shape (n, 3).
/// `kind` is the name of an illuminance. `precision` is the number of samples, if it is not the
/// default, and the error target.
#[pyfunction]
pub fn measure<'py>(
    py: Python<'py>,
    world: &World,
    sensors: (PyReadonlyArray2<'py, f32>, PyReadonlyArray2<'py, f32>),
    kind: &str,
    precision: (Option<u32>, Option<f64>),
    pairs: Pairs,
    watch: Option<Py<PyAny>>,
) -> PyResult<Light<'py>> {
    let ((points, normals), (samples, error)) = (sensors, precision);
    let kind = IlluminanceKind::from_name(kind).ok_or_else(|| {
        let names = IlluminanceKind::ALL.map(IlluminanceKind::name).join(", ");
        PyValueError::new_err(format!("kind must be one of {names}, but is {kind:?}"))
    })?;
    let options = options(&pairs)?;
    let job = options.resolve(&world.loaded).map_err(PyValueError::new_err)?;
    let vectors = |array: &PyReadonlyArray2<f32>| -> PyResult<Vec<Vec3>> {
        Ok(array.as_slice()?.chunks_exact(3).map(Vec3::from_slice).collect())
    };
    let sensors = vectors(&points)?.into_iter().zip(vectors(&normals)?);
    let sensors: Vec<Sensor> = sensors.map(|(point, normal)| Sensor { point, normal }).collect();
    let lumens = world.world.lumens().unwrap_or(LUMINANCE);
    let samples = samples.unwrap_or_else(|| MeasureOptions::default_samples(error));
    let settings = MeasureOptions { kind, samples, error, seed: job.seed, lumens };
    let (cancel, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let progress = || (done.load(Relaxed), PROGRESS_STEPS);
    let found = watched(py, options.threads, watch, (&cancel, &progress), || {
        let context = IntegratorContext {
            world: &world.world,
            settings: job.settings,
            cone: None,
            seed: job.seed,
            cancel: Some(&cancel),
        };
        match job.method.create(context) {
            Integrator::Path(path) | Integrator::Photons(path) => {
                Some(measure_light(&path, &sensors, &settings, &|share| {
                    done.store((share * PROGRESS_STEPS as f64) as u64, Relaxed);
                }))
            }
            _ => None,
        }
    })?
    .unwrap_or_else(|panic| resume_unwind(panic));
    let Some(Measurement { points, has_rare_light }) = found else {
        return Err(PyValueError::new_err(
            "only path tracing can measure light: the integrator must be path or photons",
        ));
    };
    let irradiance: Vec<f64> = points.iter().flat_map(|point| point.irradiance).collect();
    let column = |value: fn(&durer::measure::Measured) -> f64| points.iter().map(value).collect::<Vec<_>>();
    Ok((
        irradiance.into_pyarray(py),
        column(|point| point.illuminance).into_pyarray(py),
        column(|point| point.error).into_pyarray(py),
        points.iter().map(|point| point.samples).collect::<Vec<_>>().into_pyarray(py),
        has_rare_light,
    ))
}
