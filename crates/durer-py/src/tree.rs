//! Ray and point queries on meshes, and on scenes that consist of instances.

use crate::rays::{JOB, PointArray, Points, RayArrays, Rays, points};
use crate::work::{Pace, each, install};
use durer::bvh::{BuildQuality, Instance, InstanceBvh, InstanceHit, TriangleBvh, TriangleHit};
use durer::math::{Affine, Ray, Ray64, Vec3};
use glam::{DAffine3, DMat3, DVec3};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::Arc;

/// BVH behind `durer.Mesh` or `durer.Scene`. It is either a tree of triangles or a tree of
/// instances of such trees.
#[pyclass(frozen, module = "durer._durer")]
pub struct Tree {
    pub target: Target,
    /// World-space position of the origin of a mesh's coordinates. The coordinates of distant
    /// meshes are relative to their centre, because single precision is more accurate there.
    pub center: DVec3,
}

/// BVH of a [`Tree`], either of triangles or of instances.
pub enum Target {
    Mesh(Arc<TriangleBvh>),
    Instances(InstanceBvh),
}

/// Arrays that hold all hits for Python: t, triangle, object, u and v.
type HitArrays<'py> =
    (Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<i32>>, Bound<'py, PyArray1<i32>>, Bound<'py, PyArray1<f32>>);

/// Arrays that hold the first hits for Python: t, triangle, object (for scenes only), u and v.
type ClosestArrays<'py> = (
    Bound<'py, PyArray1<f32>>,
    Bound<'py, PyArray1<i32>>,
    Option<Bound<'py, PyArray1<i32>>>,
    Bound<'py, PyArray1<f32>>,
);

/// Single hit, with t, triangle, object, u and v. Rays that hit nothing use [`MISS`].
#[derive(Clone, Copy)]
struct Row(f32, i32, i32, [f32; 2]);

impl From<TriangleHit> for Row {
    fn from(hit: TriangleHit) -> Self {
        Row(hit.t, hit.triangle as i32, 0, hit.uv.to_array())
    }
}

impl From<InstanceHit> for Row {
    fn from(hit: InstanceHit) -> Self {
        Row(hit.t, hit.triangle as i32, hit.instance as i32, hit.uv.to_array())
    }
}

const MISS: Row = Row(f32::INFINITY, -1, -1, [0.0; 2]);

impl Tree {
    fn closest_of(&self, rays: &Rays, first: usize, pace: &Pace, mut put: impl FnMut(usize, Row)) {
        match &self.target {
            Target::Mesh(tree) => {
                let rays = rays.job(first, self.center);
                let mut hits = vec![None; rays.len()];
                pace.ranges(rays.len(), |range| tree.closest_batch(&rays[range.clone()], &mut hits[range]));
                for (i, hit) in hits.into_iter().enumerate() {
                    put(i, hit.map_or(MISS, Row::from));
                }
            }
            Target::Instances(scene) => {
                for (i, ray) in rays.exact_job(first).iter().enumerate().take_while(|_| pace.should_continue()) {
                    put(i, scene.closest(ray).map_or(MISS, Row::from));
                }
            }
        }
    }

    fn occluded_of(&self, rays: &Rays, first: usize, pace: &Pace, answers: &mut [bool]) {
        match &self.target {
            Target::Mesh(tree) => {
                let rays = rays.job(first, self.center);
                pace.ranges(rays.len(), |range| tree.occluded_batch(&rays[range.clone()], &mut answers[range]));
            }
            Target::Instances(scene) => {
                let rays = rays.exact_job(first);
                let pairs = answers.iter_mut().zip(&rays).take_while(|_| pace.should_continue());
                pairs.for_each(|(answer, ray)| *answer = scene.occluded(ray));
            }
        }
    }

    fn all_hits_of(&self, rays: &Rays, first: usize, pace: &Pace, mut take: impl FnMut(usize, Vec<Row>)) {
        match &self.target {
            Target::Mesh(tree) => {
                for (i, ray) in rays.job(first, self.center).iter().enumerate().take_while(|_| pace.should_continue()) {
                    take(i, tree.all_hits(ray).into_iter().map(Row::from).collect());
                }
            }
            Target::Instances(scene) => {
                for (i, ray) in rays.exact_job(first).iter().enumerate().take_while(|_| pace.should_continue()) {
                    take(i, scene.all_hits(ray).into_iter().map(Row::from).collect());
                }
            }
        }
    }

    fn contains_point(&self, point: DVec3) -> bool {
        match &self.target {
            Target::Mesh(tree) => tree.hit_count(&outward(tree, (point - self.center).as_vec3())) % 2 == 1,
            Target::Instances(scene) => scene.instances().iter().any(|instance| {
                let ray = instance.to_world.inverse_ray(Ray64::new(point, Vec3::Z, 0.0, f32::INFINITY));
                instance.bvh.hit_count(&ray) % 2 == 1
            }),
        }
    }
}

/// Returns an axis-aligned ray from a point, in the direction in which it leaves the bounding box
/// soonest. If the point is outside the box or NaN, the ray hits nothing.
fn outward(tree: &TriangleBvh, point: Vec3) -> Ray {
    let bounds = tree.bounds();
    let inside = point.cmpge(bounds.min).all() && point.cmple(bounds.max).all();
    let mut best = (f32::INFINITY, Vec3::ZERO);
    for axis in 0..3 {
        let (low, high) = (point[axis] - bounds.min[axis], bounds.max[axis] - point[axis]);
        for (way, sign) in [(low, -1.0), (high, 1.0)] {
            if way < best.0 {
                best = (way, sign * Vec3::AXES[axis]);
            }
        }
    }
    Ray::new(point, if inside { best.1 } else { Vec3::ZERO })
}

/// Returns an array of `count` zeros. Long arrays are written by all threads, because a single
/// thread would take a tenth of the tracing time.
pub fn zeros<T: Clone + Default + Send>(py: Python, threads: Option<usize>, count: usize) -> Vec<T> {
    match count <= 2 * JOB {
        true => vec![T::default(); count],
        false => {
            install(py, threads, || (0..count).into_par_iter().with_min_len(1 << 16).map(|_| T::default()).collect())
        }
    }
}

#[pymethods]
impl Tree {
    /// Builds a tree of triangles. The vertices are relative to `center`.
    #[staticmethod]
    fn from_mesh(
        py: Python,
        vertices: PyReadonlyArray2<f32>,
        faces: PyReadonlyArray2<u32>,
        center: [f64; 3],
        preset: &str,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let names = || BuildQuality::NAMES.map(|row| row.0).join("', '");
        let wrong = || PyValueError::new_err(format!("preset must be '{}', but is '{preset}'", names()));
        let preset = BuildQuality::NAMES.iter().find(|row| row.0 == preset).ok_or_else(wrong)?.1;
        let vertices: Vec<Vec3> = points(&vertices)?.chunks_exact(3).map(Vec3::from_slice).collect();
        let faces: Vec<[u32; 3]> = faces.as_slice()?.as_chunks().0.to_vec();
        let out = |face: &[u32; 3]| face.iter().any(|&i| i as usize >= vertices.len());
        if let Some(i) = faces.iter().position(out) {
            let message = format!("faces[{i}] is {:?}, but there are only {} vertices", faces[i], vertices.len());
            return Err(PyValueError::new_err(message));
        }
        let tree = install(py, threads, || TriangleBvh::build(&vertices, &faces, preset));
        Ok(Tree { target: Target::Mesh(Arc::new(tree)), center: DVec3::from_array(center) })
    }

    /// Refits the tree to the moved vertices of the same triangles.
    fn refitted(
        &self,
        py: Python,
        vertices: PyReadonlyArray2<f32>,
        faces: PyReadonlyArray2<u32>,
        center: [f64; 3],
    ) -> PyResult<Self> {
        let Target::Mesh(tree) = &self.target else { return Err(PyValueError::new_err("only meshes can be refitted")) };
        let vertices: Vec<Vec3> = points(&vertices)?.chunks_exact(3).map(Vec3::from_slice).collect();
        let faces = faces.as_slice()?.as_chunks().0;
        let refitted = install(py, None, || {
            let mut tree = TriangleBvh::clone(tree);
            tree.try_refit(&vertices, faces).map(|()| tree)
        });
        let tree = refitted.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Tree { target: Target::Mesh(Arc::new(tree)), center: DVec3::from_array(center) })
    }

    /// Builds a tree of instances. `matrices` contains three rows of four numbers for each
    /// instance.
    #[staticmethod]
    fn from_instances(trees: Vec<PyRef<Tree>>, matrices: PyReadonlyArray2<f64>) -> PyResult<Self> {
        let rows = matrices.as_slice()?.as_chunks::<12>().0;
        let mut placed = Vec::with_capacity(trees.len());
        for (i, (tree, m)) in trees.iter().zip(rows).enumerate() {
            let (Target::Mesh(mesh), center) = (&tree.target, tree.center) else {
                return Err(PyValueError::new_err(format!("object {i} is not a mesh")));
            };
            let column = |j: usize| DVec3::new(m[j], m[j + 4], m[j + 8]);
            let matrix3 = DMat3::from_cols(column(0), column(1), column(2));
            let singular = || PyValueError::new_err(format!("the matrix of object {i} cannot be inverted"));
            let translation = column(3) + matrix3 * center;
            let to_world = Affine::new(DAffine3 { matrix3, translation }).ok_or_else(singular)?;
            placed.push(Instance::new(mesh.clone(), to_world));
        }
        Ok(Tree { target: Target::Instances(InstanceBvh::new(placed)), center: DVec3::ZERO })
    }

    /// Returns the first hit of each ray.
    fn closest<'py>(
        &self,
        py: Python<'py>,
        asked: RayArrays<'py>,
        threads: Option<usize>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<ClosestArrays<'py>> {
        let rays = Rays::new(&asked)?;
        let count = rays.count;
        let (mut t, mut uv) = (zeros(py, threads, count), zeros::<f32>(py, threads, 2 * count));
        let mut triangle = zeros(py, threads, count);
        // A mesh is a single object, so it needs no array of object indices.
        let mut object = zeros(py, threads, if matches!(self.target, Target::Instances(_)) { count } else { 0 });
        let objects = object.chunks_mut(JOB).map(Some).chain(std::iter::repeat_with(|| None));
        let found = t.chunks_mut(JOB).zip(uv.as_chunks_mut().0.chunks_mut(JOB)).zip(triangle.chunks_mut(JOB));
        let jobs = found.zip(objects).enumerate().collect();
        each(py, threads, watch, jobs, |(job, (((t, uv), triangle), mut object)), pace| {
            self.closest_of(&rays, JOB * job, pace, |i, row| {
                (t[i], triangle[i], uv[i]) = (row.0, row.1, row.3);
                object.iter_mut().for_each(|object| object[i] = row.2);
            });
        })?;
        let object = (!object.is_empty()).then(|| object.into_pyarray(py));
        Ok((t.into_pyarray(py), triangle.into_pyarray(py), object, uv.into_pyarray(py)))
    }

    /// Returns an array that is true for each ray that hits anything.
    fn occluded<'py>(
        &self,
        py: Python<'py>,
        asked: RayArrays<'py>,
        threads: Option<usize>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let rays = Rays::new(&asked)?;
        let count = rays.count;
        let mut answers = vec![false; count];
        let jobs = answers.chunks_mut(JOB).enumerate().collect();
        each(py, threads, watch, jobs, |(job, to), pace| self.occluded_of(&rays, JOB * job, pace, to))?;
        Ok(answers.into_pyarray(py))
    }

    /// Returns the number of triangles that each ray crosses.
    fn count<'py>(
        &self,
        py: Python<'py>,
        asked: RayArrays<'py>,
        threads: Option<usize>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<i32>>> {
        let rays = Rays::new(&asked)?;
        let count = rays.count;
        let mut counts = vec![0; count];
        let jobs = counts.chunks_mut(JOB).enumerate().collect();
        each(py, threads, watch, jobs, |(job, to): (usize, &mut [i32]), pace| {
            self.all_hits_of(&rays, JOB * job, pace, |i, hits| to[i] = hits.len() as i32);
        })?;
        Ok(counts.into_pyarray(py))
    }

    /// Returns the number of hits of each ray, and all hits in the order of the rays.
    fn all_hits<'py>(
        &self,
        py: Python<'py>,
        asked: RayArrays<'py>,
        threads: Option<usize>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<(Bound<'py, PyArray1<i64>>, HitArrays<'py>)> {
        let rays = Rays::new(&asked)?;
        let count = rays.count;
        let mut counts = vec![0; count];
        let mut rows: Vec<Vec<Row>> = vec![Vec::new(); count.div_ceil(JOB)];
        let jobs = counts.chunks_mut(JOB).zip(&mut rows).enumerate().collect();
        each(py, threads, watch, jobs, |(job, (counts, rows)): (usize, (&mut [i64], &mut Vec<Row>)), pace| {
            self.all_hits_of(&rays, JOB * job, pace, |i, hits| {
                counts[i] = hits.len() as i64;
                rows.extend(hits);
            });
        })?;
        let rows: Vec<Row> = rows.concat();
        let t: Vec<f32> = rows.iter().map(|row| row.0).collect();
        let triangle: Vec<i32> = rows.iter().map(|row| row.1).collect();
        let object: Vec<i32> = rows.iter().map(|row| row.2).collect();
        let uv: Vec<f32> = rows.iter().flat_map(|row| row.3).collect();
        let hits = (t.into_pyarray(py), triangle.into_pyarray(py), object.into_pyarray(py), uv.into_pyarray(py));
        Ok((counts.into_pyarray(py), hits))
    }

    /// Returns an array that is true for each point inside the mesh, based on the parity of the
    /// crossings.
    fn contains<'py>(
        &self,
        py: Python<'py>,
        places: PointArray<'py>,
        threads: Option<usize>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let places = Points::new(&places)?;
        let mut answers = vec![false; places.count()];
        let jobs = answers.chunks_mut(JOB).enumerate().collect();
        each(py, threads, watch, jobs, |(job, to): (usize, &mut [bool]), pace| {
            let own = to.iter_mut().enumerate().take_while(|_| pace.should_continue());
            own.for_each(|(i, to)| *to = self.contains_point(places.at(JOB * job + i)));
        })?;
        Ok(answers.into_pyarray(py))
    }

    /// Returns the nearest point on a mesh for each query point. The arrays contain the distance,
    /// triangle, point, u and v.
    #[allow(clippy::type_complexity)]
    fn nearest<'py>(
        &self,
        py: Python<'py>,
        places: PointArray<'py>,
        within: f64,
        threads: Option<usize>,
        watch: Option<Py<PyAny>>,
    ) -> PyResult<(
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<i32>>,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<f64>>,
    )> {
        let Target::Mesh(tree) = &self.target else {
            return Err(PyValueError::new_err("only meshes have nearest points"));
        };
        let places = Points::new(&places)?;
        let count = places.count();
        let (mut distance, mut triangle) = (vec![f64::INFINITY; count], vec![-1; count]);
        let (mut near, mut uv) = (vec![f64::NAN; 3 * count], vec![0.0; 2 * count]);
        let numbers = distance.chunks_mut(JOB).zip(triangle.chunks_mut(JOB));
        let jobs = numbers.zip(near.chunks_mut(3 * JOB)).zip(uv.chunks_mut(2 * JOB)).enumerate();
        each(py, threads, watch, jobs.collect(), |(job, (((distance, triangle), near), uv)), pace| {
            for i in (0..distance.len()).take_while(|_| pace.should_continue()) {
                if let Some(found) = tree.nearest_point(places.relative_to(self.center, JOB * job + i), within) {
                    (distance[i], triangle[i]) = (found.distance, found.triangle as i32);
                    near[3 * i..3 * i + 3].copy_from_slice(&(found.point + self.center).to_array());
                    uv[2 * i..2 * i + 2].copy_from_slice(&found.uv);
                }
            }
        })?;
        Ok((distance.into_pyarray(py), triangle.into_pyarray(py), near.into_pyarray(py), uv.into_pyarray(py)))
    }

    /// Returns the lower and upper corners of the bounding box, relative to `center`.
    fn bounds(&self) -> ([f32; 3], [f32; 3]) {
        let bounds = match &self.target {
            Target::Mesh(tree) => tree.bounds(),
            Target::Instances(scene) => scene.bounds(),
        };
        (bounds.min.to_array(), bounds.max.to_array())
    }

    /// Returns the size in memory in bytes.
    fn bytes(&self) -> usize {
        match &self.target {
            Target::Mesh(tree) => tree.memory_usage(),
            Target::Instances(scene) => scene.memory_usage(),
        }
    }
}
