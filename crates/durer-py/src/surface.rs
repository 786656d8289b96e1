//! Surface attributes at hit points: positions, normals, and origins of secondary rays.

use crate::rays::{JOB, points};
use crate::tree::{Target, Tree, zeros};
use crate::work::each;
use durer::math::{Affine, Ray, Vec3, gamma};
use glam::DVec3;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Hits as passed from Python, with objects (for scenes only), triangles, and u and v.
pub type HitInput<'py> = (Option<PyReadonlyArray1<'py, i32>>, PyReadonlyArray1<'py, i32>, PyReadonlyArray2<'py, f32>);

/// Hits on a tree, borrowed from numpy arrays. Their points, normals and secondary origins are
/// computed.
struct Hits<'a> {
    tree: &'a Tree,
    objects: Option<&'a [i32]>,
    triangles: &'a [i32],
    uv: &'a [[f32; 2]],
}

/// Triangle of a hit in object space, with the transform from object space to world space.
struct Face<'a> {
    corners: [DVec3; 3],
    to_world: Option<&'a Affine>,
    center: DVec3,
}

impl<'a> Hits<'a> {
    fn new(tree: &'a Tree, (objects, triangles, uv): &'a HitInput) -> PyResult<Self> {
        let objects = objects.as_ref().map(|objects| objects.as_slice()).transpose()?;
        let (triangles, uv) = (triangles.as_slice()?, uv.as_slice()?.as_chunks().0);
        let count = triangles.len();
        if uv.len() != count || objects.is_some_and(|objects| objects.len() != count) {
            return Err(PyValueError::new_err(
                "the arrays of objects, triangles, and u and v must have the same length",
            ));
        }
        Ok(Hits { tree, objects, triangles, uv })
    }

    fn face(&self, i: usize) -> Option<Face<'a>> {
        let triangle = u32::try_from(self.triangles[i]).ok()?;
        let (tree, to_world) = match &self.tree.target {
            Target::Mesh(tree) => (tree, None),
            Target::Instances(scene) => {
                let object = usize::try_from(self.objects.map_or(0, |objects| objects[i])).ok()?;
                let instance = scene.instances().get(object)?;
                (&instance.bvh, Some(&instance.to_world))
            }
        };
        Some(Face { corners: tree.corners(triangle)?.map(|c| c.as_dvec3()), to_world, center: self.tree.center })
    }
}

impl Face<'_> {
    /// Returns the point at the given barycentric coordinates, in object space.
    fn point(&self, [u, v]: [f32; 2]) -> DVec3 {
        let ([a, b, c], u, v) = (self.corners, f64::from(u), f64::from(v));
        (1.0 - u - v) * a + u * b + v * c
    }

    /// Transforms a point from object space to world space.
    fn to_world(&self, point: DVec3) -> DVec3 {
        self.to_world.map_or(point + self.center, |map| map.forward().transform_point3(point))
    }

    /// Returns the unit normal in object space, or zero if the triangle has no area.
    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// Returns the origin of a secondary ray in a direction, on the side of that direction.
    ///
    /// The kernel decides in single precision whether a ray hits, and computes the distance in
    /// double precision. A ray that starts in front of the triangle's plane, by more than the
    /// rounding error of its origin, therefore does not hit the triangle. `error` bounds this
    /// rounding error, with a safety factor of two in each part:
    ///
    /// - rounding the origin to single precision in object space;
    /// - the transform to world space and back in double precision: either a translation to and
    ///   from the centre of a distant mesh, or a matrix, with the bound of [`Affine::point_error`]
    ///   or the rounding of [`Ray64`];
    /// - the surrounding corners, which the kernel translates to the ray's origin and shears, with
    ///   at most seven roundings. A ray that passes an edge more closely than this could otherwise
    ///   miss the neighbour and hit what is behind it.
    ///
    /// The origin is offset from the plane by twice the bound projected onto the normal, and from
    /// the edges by eight times the bound. It is therefore also in front of the neighbouring
    /// triangles, unless the fold between them is narrower than a few degrees.
    ///
    /// [`Ray64`]: durer::math::Ray64
    fn leave(&self, uv: [f32; 2], dir: Vec3) -> DVec3 {
        const DOUBLE: f64 = 1.0 / (1u64 << 40) as f64;
        let (point, normal) = (self.point(uv), self.normal());
        let (local, back) = match self.to_world {
            None => (dir, DVec3::splat(DOUBLE / 256.0) * self.center.abs()),
            Some(map) => {
                let forward = map.forward();
                let far = forward.translation.abs() + forward.matrix3.abs() * point.abs();
                let local = map.inverse_ray(Ray::new(Vec3::ZERO, dir)).dir;
                (local, map.inverse_error_bound((DOUBLE * far).as_vec3()).as_dvec3())
            }
        };
        let reach = self.corners.iter().map(|corner| (corner - point).abs().max_element()).fold(0.0, f64::max);
        let error = f64::from(gamma(2)) * point.abs() + f64::from(gamma(7)) * DVec3::splat(reach) + back;
        let offset = 2.0 * normal.abs().dot(error);
        let side = if normal.dot(local.as_dvec3()) < 0.0 { -offset } else { offset };
        self.to_world(inset(self.corners, normal, point, 8.0 * error.length()) + side * normal)
    }
}

/// Moves a point inside a triangle away from the edges until its distance from each of them is
/// `margin`. Where the triangle is too narrow, the point moves to the middle. The point moves by at
/// most a few margins.
fn inset(corners: [DVec3; 3], normal: DVec3, point: DVec3, margin: f64) -> DVec3 {
    let [a, b, c] = corners;
    let inward = [(b, c), (c, a), (a, b)].map(|(from, to)| (from, normal.cross(to - from).normalize_or_zero()));
    let mut sides = inward.map(|(from, way)| ((point - from).dot(way), way));
    sides.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(near, way), (next, other), _] = sides;
    if near >= margin {
        return point;
    }
    let cosine = way.dot(other);
    let step = margin - near;
    if next + step * cosine >= margin {
        return point + step * way;
    }
    // At a corner, move away from both sides by the margin.
    let (to_other, square) = (margin - next, 1.0 - cosine * cosine);
    let moved = ((step - to_other * cosine) * way + (to_other - step * cosine) * other) / square;
    if moved.length() <= 4.0 * margin {
        return point + moved;
    }
    // Between two sides that are less than two margins apart, move to the middle.
    let middle = (next - near) / (1.0 - cosine);
    if middle.is_finite() { point + middle.min(margin) * way } else { point }
}

/// Computes a vector for each hit, using all threads.
fn rows<T: numpy::Element + Copy + Default + Send + Sync>(
    py: Python,
    hits: &Hits,
    threads: Option<usize>,
    missing: T,
    of: impl Fn(&Face, usize) -> [T; 3] + Sync + Send,
) -> PyResult<Vec<T>> {
    let mut values = zeros::<T>(py, threads, 3 * hits.triangles.len());
    let jobs = values.as_chunks_mut().0.chunks_mut(JOB).enumerate().collect();
    each(py, threads, None, jobs, |(job, rows): (usize, &mut [[T; 3]]), pace| {
        for (i, row) in rows.iter_mut().enumerate().take_while(|_| pace.should_continue()) {
            let i = JOB * job + i;
            *row = hits.face(i).map_or([missing; 3], |face| of(&face, i));
        }
    })?;
    Ok(values)
}

/// Returns the hit points, in double precision if `double` is true and otherwise in single
/// precision. The result is NaN for misses.
#[pyfunction]
pub fn hit_points<'py>(
    py: Python<'py>,
    tree: PyRef<'py, Tree>,
    met: HitInput<'py>,
    double: bool,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    let hits = Hits::new(&tree, &met)?;
    let point = |face: &Face, i: usize| face.to_world(face.point(hits.uv[i]));
    Ok(match double {
        true => rows(py, &hits, threads, f64::NAN, |face, i| point(face, i).to_array())?.into_pyarray(py).into_any(),
        false => {
            let single = |face: &Face, i: usize| point(face, i).as_vec3().to_array();
            rows(py, &hits, threads, f32::NAN, single)?.into_pyarray(py).into_any()
        }
    })
}

/// Returns the unit normals of the triangles that were hit. They point outwards, even for mirrored
/// instances, and are zero for misses.
#[pyfunction]
pub fn hit_normals<'py>(
    py: Python<'py>,
    tree: PyRef<'py, Tree>,
    met: HitInput<'py>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyArray1<f32>>> {
    let hits = Hits::new(&tree, &met)?;
    let normal = |face: &Face, _| {
        let normal = face.normal().as_vec3();
        face.to_world.map_or(normal, |map| map.normal(normal)).to_array()
    };
    Ok(rows(py, &hits, threads, 0.0, normal)?.into_pyarray(py))
}

/// Returns the origins of secondary rays that start at hits, one for each direction.
#[pyfunction]
pub fn secondary_origins<'py>(
    py: Python<'py>,
    tree: PyRef<'py, Tree>,
    met: HitInput<'py>,
    directions: PyReadonlyArray2<'py, f32>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let hits = Hits::new(&tree, &met)?;
    let directions = points(&directions)?;
    if directions.len() != 3 * hits.triangles.len() {
        return Err(PyValueError::new_err("there must be one direction for each hit"));
    }
    let start = |face: &Face, i: usize| face.leave(hits.uv[i], Vec3::from_slice(&directions[3 * i..])).to_array();
    Ok(rows(py, &hits, threads, f64::NAN, start)?.into_pyarray(py))
}
