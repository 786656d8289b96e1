//! Scenes and partial renders, which back `durer.World` and `durer.Part`.

use crate::rays::{self, JOB, Rays};
use crate::work::{each, install, watched};
use durer::check::{CheckInput, check};
use durer::diag::{Diagnostics, Files, Severity};
use durer::film::aov::Aov;
use durer::image::{Layer, LayerKind};
use durer::math::Vec3;
use durer::options::RenderOptions;
use durer::render::explain::SceneNames;
use durer::render::{self, RenderOutcome};
use durer::report;
use durer::source::SourceError;
use durer::world::SurfaceInteraction;
use durer::{LoadOptions, LoadedScene, load, load_text};
use numpy::{IntoPyArray, PyArray1};
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyKeyboardInterrupt, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

create_exception!(
    durer,
    SceneError,
    PyValueError,
    "Raised if a scene cannot be rendered; states the reason and the position in the file."
);
create_exception!(durer, RenderError, PyException, "Raised if a render fails, or if a part cannot be used.");

fn failed(error: impl ToString) -> PyErr {
    RenderError::new_err(error.to_string())
}

/// Scene that was read and compiled, with the diagnostics from reading it.
#[pyclass(frozen, module = "durer._durer")]
pub struct World {
    pub loaded: LoadedScene,
    pub world: durer::world::World,
    files: Files,
    read: Diagnostics,
}

/// Number of integers for each hit: object, triangle and material.
const NUMBERS: usize = 3;
/// Number of floats for each hit: t, point, geometric normal and shading normal.
const VALUES: usize = 10;
/// Number of doubles for each hit: the point, and the offset at which a secondary ray starts.
const PLACES: usize = 4;
/// Arrays that hold the first hits for Python. [`NUMBERS`], [`VALUES`] and [`PLACES`] are the
/// numbers of integers, floats and doubles for each hit.
type NearestArrays<'py> = (Bound<'py, PyArray1<i32>>, Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<f64>>);

/// Slices of the output arrays for several consecutive rays, with integers, floats and doubles.
type Row<'a> = ((&'a mut [i32], &'a mut [f32]), &'a mut [f64]);

/// Formats diagnostics as lines of the form `file:line:column: error: message`.
fn lines(files: &Files, read: &Diagnostics, wanted: impl Fn(Severity) -> bool) -> Vec<String> {
    let line = |d: &durer::diag::Diagnostic| {
        let place = d.span.and_then(|span| {
            let (line, column) = files.position(span)?;
            Some(format!("{}:{line}:{column}: ", files.name(span.file)?))
        });
        let severity = ["note", "warning", "error"][d.severity as usize];
        let help = d.help.as_ref().map(|help| format!(" ({help})"));
        format!("{}{severity}: {}{}", place.unwrap_or_default(), d.message, help.unwrap_or_default())
    };
    read.iter().filter(|d| wanted(d.severity)).map(line).collect()
}

/// Converts an error to an OSError with an error number, so that Python raises, for example,
/// `FileNotFoundError`.
fn unreadable(error: &SourceError, path: &Path) -> PyErr {
    let number = match error {
        SourceError::Io { error, .. } => error.raw_os_error(),
        // On every system, ENOENT is 2.
        SourceError::Missing { .. } => Some(2),
        _ => None,
    };
    match number {
        Some(number) => {
            let said = std::io::Error::from_raw_os_error(number).to_string();
            let said = said.split(" (os error").next().unwrap_or_default().to_owned();
            PyOSError::new_err((number, said, path.as_os_str().to_owned()))
        }
        None => PyOSError::new_err(error.to_string()),
    }
}

/// Options as pairs of a name and a text.
pub type Pairs = Vec<(String, String)>;

pub fn options(pairs: &Pairs) -> PyResult<RenderOptions> {
    let mut options = RenderOptions::default();
    pairs.iter().try_for_each(|(name, text)| options.set(name, text)).map_err(PyValueError::new_err)?;
    Ok(options)
}

impl World {
    /// Reads and compiles a scene.
    fn load(py: Python, path: PathBuf, text: Option<Vec<u8>>, mut options: LoadOptions) -> PyResult<Self> {
        install(py, options.threads, || {
            let (mut files, mut read) = (Files::default(), Diagnostics::default());
            let loaded = match text {
                Some(text) => load_text(&path, text.into(), &options, &mut files, &mut read),
                None => load(&path, &options, &mut files, &mut read).map_err(|e| unreadable(&e, &path))?,
            };
            // Load the scene in the current thread pool.
            options.threads = None;
            let world = loaded.as_ref().and_then(|loaded| loaded.compile(&options, &mut files, &mut read));
            match (loaded, world) {
                (Some(loaded), Some(world)) => Ok(World { loaded, world, files, read }),
                _ => {
                    let message = lines(&files, &read, |severity| severity == Severity::Error).join("\n");
                    let found = report::findings(&durer::check::reader_findings(&read), &files);
                    Err(SceneError::new_err((message, found.to_string())))
                }
            }
        })
    }
}

#[pymethods]
impl World {
    /// Reads a scene from a file, or from a text with embedded files as if it were a file.
    #[new]
    fn new(
        py: Python,
        path: PathBuf,
        text: Option<Vec<u8>>,
        given: Vec<(String, Vec<u8>)>,
        pairs: Pairs,
    ) -> PyResult<Self> {
        let mut options = options(&pairs)?.load_options();
        options.in_memory = given.into_iter().map(|(name, bytes)| (name, bytes.into())).collect();
        World::load(py, path, text, options)
    }

    /// Returns the warnings and notes from reading the scene.
    fn warnings(&self) -> Vec<String> {
        lines(&self.files, &self.read, |severity| severity != Severity::Error)
    }

    /// Returns the name of the dialect.
    fn dialect(&self) -> &'static str {
        self.loaded.dialect.name()
    }

    /// Returns the hash of the scene and of all its files.
    fn digest(&self) -> String {
        self.world.digest().to_string()
    }

    /// Returns the paths of all files that were read.
    fn sources(&self) -> Vec<PathBuf> {
        self.loaded.files()
    }

    /// Returns the scene description as JSON.
    fn description(&self) -> String {
        durer::format::json::write(&self.loaded.scene, self.loaded.dialect)
    }

    /// Creates an empty part of the render with the given options.
    fn part(&self, py: Python, pairs: Pairs) -> PyResult<Part> {
        let options = options(&pairs)?;
        let job = options.resolve(&self.loaded).map_err(PyValueError::new_err)?;
        let part = install(py, None, || render::PartialRender::new(&self.world, &job, options.shard))
            .map_err(|e| PyValueError::new_err(e.to_string()))?;
        Ok(Part(Arc::new(part)))
    }

    /// Returns the camera rays through the centres of a part's pixels: the width and the height of
    /// the picture, and the origin and the direction of each ray, which are NaN if there is none.
    fn rays<'py>(&self, py: Python<'py>, part: &Part) -> (u32, u32, Bound<'py, PyArray1<f32>>) {
        let (job, window) = (part.0.job(), part.0.job().window());
        let rays: Vec<f32> = install(py, None, || {
            let raster = render::raster(&self.world, job.width, job.height);
            let rays = window.pixel_positions().map(|pixel| render::center_ray(&self.world, &raster, pixel));
            let vectors = rays.flat_map(|ray| ray.map_or([Vec3::NAN; 2], |ray| [ray.origin, ray.dir]));
            vectors.flat_map(|vector| vector.to_array()).collect()
        });
        (window.width, window.height, rays.into_pyarray(py))
    }

    /// Continues to render a part. Returns true if the part is finished.
    fn render(&self, py: Python, part: &Part, pairs: Pairs, watch: Option<Py<PyAny>>) -> PyResult<bool> {
        let (control, part) = (options(&pairs)?.control(), part.0.clone());
        let progress = || (control.done_work.load(Relaxed), control.total_work.load(Relaxed));
        let stop = watched(py, None, watch, (&control.cancel, &progress), || {
            part.render(&self.world, &control, &mut |_, _| {})
        })?;
        match stop.map_err(|_| failed("the render failed; this is a bug in durer"))?.map_err(failed)? {
            RenderOutcome::Finished => Ok(true),
            RenderOutcome::OutOfTime => Ok(false),
            RenderOutcome::Cancelled => Err(PyKeyboardInterrupt::new_err("")),
            RenderOutcome::Panicked(panicked) => Err(failed(render::RenderError::from(panicked))),
        }
    }

    /// Returns the first hit of each ray. The arrays contain object, triangle and material, and t,
    /// point, geometric normal and shading normal.
    fn closest<'py>(
        &self,
        py: Python<'py>,
        asked: rays::RayArrays<'py>,
        threads: Option<usize>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<NearestArrays<'py>> {
        let rays = Rays::new(&asked)?;
        let count = rays.count;
        let (mut ids, mut values) = (vec![-1; NUMBERS * count], vec![f32::NAN; VALUES * count]);
        let mut places = vec![f64::NAN; PLACES * count];
        let numbers = ids.chunks_mut(NUMBERS * JOB).zip(values.chunks_mut(VALUES * JOB));
        let jobs = numbers.zip(places.chunks_mut(PLACES * JOB)).enumerate().collect();
        each(py, threads, watch, jobs, |(job, ((ids, values), places)): (usize, Row), pace| {
            let rows = ids.as_chunks_mut::<NUMBERS>().0.iter_mut().zip(values.as_chunks_mut::<VALUES>().0);
            let rows = rows.zip(places.as_chunks_mut::<PLACES>().0);
            for (ray, ((ids, values), place)) in
                rays.exact_job(JOB * job).iter().zip(rows).take_while(|_| pace.should_continue())
            {
                values[0] = f32::INFINITY;
                let Some(SurfaceInteraction { hit, surface, material, .. }) = self.world.intersect(ray, &mut ()) else {
                    continue;
                };
                *ids = [hit.object, self.world.triangle(&hit), material].map(|id| id as i32);
                values[0] = hit.t;
                values[1..4].copy_from_slice(&surface.position.to_array());
                values[4..7].copy_from_slice(&surface.n_geo.to_array());
                values[7..].copy_from_slice(&surface.n_shade.to_array());
                place[..3].copy_from_slice(&surface.point().to_array());
                // Use the same offset as the renderer's secondary rays; see `durer::integrator`.
                place[3] = f64::from(2.0 * surface.n_geo.abs().dot(surface.error));
            }
        })?;
        Ok((ids.into_pyarray(py), values.into_pyarray(py), places.into_pyarray(py)))
    }

    /// Returns an array that is true for each ray that hits anything.
    fn occluded<'py>(
        &self,
        py: Python<'py>,
        asked: rays::RayArrays<'py>,
        threads: Option<usize>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let rays = Rays::new(&asked)?;
        let count = rays.count;
        let mut answers = vec![false; count];
        let jobs = answers.chunks_mut(JOB).enumerate().collect();
        each(py, threads, watch, jobs, |(job, to): (usize, &mut [bool]), pace| {
            let rays = rays.exact_job(JOB * job);
            let pairs = to.iter_mut().zip(&rays).take_while(|_| pace.should_continue());
            pairs.for_each(|(to, ray)| *to = self.world.occluded(ray, &mut ()));
        })?;
        Ok(answers.into_pyarray(py))
    }

    /// Explains the colour of a pixel, and returns the explanation as JSON.
    fn explain(&self, py: Python, pairs: Pairs, pixel: (u32, u32)) -> PyResult<String> {
        let job = options(&pairs)?.resolve(&self.loaded).map_err(PyValueError::new_err)?;
        let explain = || render::explain::explain(&self.world, &job, pixel.0, pixel.1);
        let found = install(py, None, explain).map_err(|error| PyValueError::new_err(error.to_string()))?;
        let names = SceneNames { scene: &self.loaded.scene, world: &self.world, files: &self.files };
        Ok(report::explanation(&report::Explained::Pixel(found), &names).to_string())
    }

    /// Checks the scene, and returns the findings as JSON.
    fn check(&self, py: Python, pairs: Pairs) -> PyResult<String> {
        let job = options(&pairs)?.resolve(&self.loaded).map_err(PyValueError::new_err)?;
        let World { loaded, world, files, read } = self;
        let (scene, dialect) = (&loaded.scene, loaded.dialect);
        let input = CheckInput { scene, world, dialect, files, job: &job, exposure: 1.0, rejected: None };
        Ok(install(py, None, || report::findings(&check(&input, read), files).to_string()))
    }
}

/// Partial render, which can be a shard, an unfinished render or a finished image.
#[pyclass(frozen, module = "durer._durer")]
pub struct Part(Arc<render::PartialRender>);

/// Rendered image for Python, with its name, width, height, values, its coverage if it is not 1
/// everywhere, and a flag that is true if the values are light.
type Picture<'py> = (String, u32, u32, Bound<'py, PyArray1<f32>>, Option<Bound<'py, PyArray1<f32>>>, bool);

fn picture(py: Python, layer: Layer) -> Picture {
    let values: Vec<f32> = layer.image.pixels.iter().flat_map(|pixel| pixel.to_array()).collect();
    let coverage = layer.coverage.map(|coverage| coverage.into_pyarray(py));
    let (width, height, is_light) = (layer.image.width, layer.image.height, layer.kind == LayerKind::Color);
    (layer.name, width, height, values.into_pyarray(py), coverage, is_light)
}

#[pymethods]
impl Part {
    /// Reads a part from the bytes of a `.part` file.
    #[staticmethod]
    fn read(py: Python, bytes: &[u8]) -> PyResult<Part> {
        let part = install(py, None, || render::PartialRender::read(bytes)).map_err(failed)?;
        Ok(Part(Arc::new(part)))
    }

    /// Returns the part as the bytes of a `.part` file.
    fn write<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        let bytes = install(py, None, || self.0.write());
        PyBytes::new(py, &bytes)
    }

    /// Returns the hash of the film's contents.
    fn hash(&self, py: Python) -> String {
        install(py, None, || self.0.hash().to_string())
    }

    /// Returns the hash of everything that determines the image.
    fn identity(&self) -> String {
        self.0.identity().to_string()
    }

    /// Returns the index of the shard and the number of shards, for example `3/16`.
    fn shard(&self) -> String {
        self.0.shard().to_string()
    }

    /// Returns the job as JSON.
    fn job(&self) -> PyResult<String> {
        serde_json::to_string(self.0.job()).map_err(failed)
    }

    /// Returns the total amount of work and the amount that is done.
    fn work(&self) -> (u64, u64) {
        self.0.work()
    }

    /// Returns true if no work is left.
    fn is_finished(&self) -> bool {
        self.0.is_finished()
    }

    /// Returns the numbers of samples, rays, and rejected samples.
    fn statistics(&self) -> (u64, u64, u64) {
        let statistics = self.0.statistics();
        (statistics.samples, statistics.rays, statistics.rejected)
    }

    /// Returns the images with the same values as in floating-point files, or with display values
    /// if `shown` is true.
    fn pictures<'py>(&self, py: Python<'py>, shown: bool) -> PyResult<Vec<Picture<'py>>> {
        let rendered = install(py, None, || self.0.pictures()).map_err(failed)?;
        let layers = if shown { rendered.pictures } else { rendered.layers };
        Ok(layers.into_iter().map(|layer| picture(py, layer)).collect())
    }

    /// Denoises the colour image with the built-in denoiser. Returns it like [`Part::pictures`].
    fn denoised<'py>(&self, py: Python<'py>, world: &World, threads: Option<usize>) -> PyResult<Picture<'py>> {
        let denoised = install(py, threads, || self.0.noisy(&world.world, None).map(|noisy| noisy.denoised()));
        Ok(picture(py, denoised.map_err(failed)?))
    }

    /// Returns the names and descriptions of all images other than colour.
    #[staticmethod]
    fn kinds() -> Vec<(&'static str, &'static str)> {
        durer::film::aov::AOVS.iter().map(|aov: &Aov| (aov.name, aov.doc)).collect()
    }
}

/// Triangles of all meshes in a file: corners of shape (n, 3) and indices of shape (m, 3), both
/// flattened, and the number of objects that are not meshes.
type Triangles<'py> = (Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<u32>>, usize);

/// Reads the meshes of a scene or model file, in world space.
#[pyfunction]
pub fn read_mesh<'py>(py: Python<'py>, path: PathBuf, pairs: Pairs) -> PyResult<Triangles<'py>> {
    let mut load_options = options(&pairs)?.load_options();
    load_options.scene_defaults.meshes_only();
    let world = World::load(py, path, None, load_options)?;
    let (mesh, left_out) = install(py, None, || world.world.merged_mesh());
    let corners: Vec<f32> = mesh.positions.iter().flat_map(|p| p.to_array()).collect();
    Ok((corners.into_pyarray(py), mesh.triangles.concat().into_pyarray(py), left_out))
}

/// Merges parts. Each is given by a name for messages and by the bytes of its file.
#[pyfunction]
pub fn merge(py: Python, parts: Vec<(String, Vec<u8>)>) -> PyResult<Part> {
    let whole = install(py, None, || {
        let read = |(name, bytes): (String, Vec<u8>)| match render::PartialRender::read(&bytes) {
            Ok(part) => Ok((name, part)),
            Err(error) => Err(failed(format!("`{name}` cannot be merged: {error}"))),
        };
        let parts = parts.into_iter().map(read).collect::<PyResult<Vec<_>>>()?;
        render::merge(&parts).map_err(failed)
    })?;
    Ok(Part(Arc::new(whole)))
}
