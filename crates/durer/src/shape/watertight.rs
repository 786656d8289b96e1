//! Ray against triangle, watertight: a ray never slips between two triangles that share an edge, and
//! crosses exactly one of those around an edge or a vertex.
//!
//! The triangle is sheared so that the ray runs along one axis; what remains is whether a polygon's edges go
//! round the origin of a plane. Corners shared by two triangles are rounded alike, and the sign of each edge
//! function is exact, so two neighbours never disagree. Where an edge passes through the ray, the ray counts
//! as moved by an infinitesimal (e, e^2) in the plane across it.
//!
//! Single precision says whether a triangle is crossed; where, double precision says. A ray that starts beside a
//! triangle, off by no more than the rounding of its origin, is therefore on the right side of it.
//!
//! Sources: Woop, Benthin, Wald, *Watertight Ray/Triangle Intersection*, JCGT 2(1), 2013; the infinitesimal is
//! Edelsbrunner and Mücke's *Simulation of Simplicity*, ACM TOG 9(1), 1990.

use super::Crossing;
use crate::math::{Ray, Vec2, Vec3};
use glam::{DVec3, Vec3A};

/// A ray prepared for many triangles.
///
/// It is turned: the longest component of its direction counts as the third axis, and the other two are in the order that keeps
/// the sides of triangles. So are the corners that [`Sheared::crosses`] and others take.
#[derive(Clone, Copy, Debug)]
pub struct Sheared {
    axes: [usize; 3],
    origin: Vec3A,
    dir: Vec3A,
    shear: Vec2,
    least_volume: f64,
}

impl Sheared {
    /// Prepares a ray. One without direction, or with an infinite one, hits nothing.
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        let sheared = Self::finite(ray);
        let shear = if sheared.dir.z.is_finite() { sheared.shear } else { Vec2::NAN };
        Sheared { shear, ..sheared }
    }

    /// Prepares a ray that has a finite direction.
    #[inline(always)]
    pub(crate) fn finite(ray: &Ray) -> Self {
        let (dir, length) = (Vec3A::from(ray.dir), Vec3A::from(ray.dir).abs());
        let longest = length.cmpeq(Vec3A::splat(length.max_element())).bitmask();
        let [x, y, z, _] = TURNED[longest as usize & 7][dir.is_negative_bitmask() as usize & 7];
        let axes = [x as usize, y as usize, z as usize];
        let (origin, dir) = (turned(axes, ray.origin.as_ref()), turned(axes, ray.dir.as_ref()));
        Sheared {
            axes,
            origin: origin.into(),
            dir: dir.into(),
            shear: Vec2::new(dir.x / dir.z, dir.y / dir.z),
            least_volume: 0.0,
        }
    }

    /// Misses triangles for which |(b - a) x (c - a) · d| is less than this: see
    /// [`ThinTriangles`](crate::dialect::Compat::ThinTriangles).
    pub fn least_volume(self, least_volume: f64) -> Self {
        Sheared { least_volume, ..self }
    }

    /// The crossing with a triangle in the open interval (`t_min`, `t_max`), from either side.
    #[inline(always)]
    pub fn intersect(&self, corners: [Vec3; 3], t_min: f32, t_max: f32) -> Option<Crossing> {
        let corners = corners.map(|corner| turned(self.axes, corner.as_ref()));
        if !self.crosses(corners) {
            return None;
        }
        let t = self.t(corners)?;
        // Refuses also NaN.
        (t > t_min && t < t_max).then(|| Crossing { t, uv: self.uv(corners) })
    }

    /// Whether the line of the ray crosses a triangle, and does not just see it from its side.
    pub(crate) fn crosses(&self, corners: [Vec3; 3]) -> bool {
        let flat @ [a, b, c] = self.flatten(corners);
        let front = is_front(b, c);
        if is_front(c, a) != front || is_front(a, b) != front {
            return false;
        }
        let det = areas(flat).element_sum();
        det != 0.0 && !det.is_nan()
    }

    /// The second and third barycentric coordinate of the crossing with a triangle that is crossed.
    #[inline(always)]
    pub(crate) fn uv(&self, corners: [Vec3; 3]) -> Vec2 {
        uv_across(self.flatten(corners))
    }

    #[inline(always)]
    pub(crate) fn flatten(&self, [a, b, c]: [Vec3; 3]) -> [Vec2; 3] {
        [self.flat(a), self.flat(b), self.flat(c)]
    }

    /// A corner in the plane across the ray.
    #[inline(always)]
    fn flat(&self, corner: Vec3) -> Vec2 {
        let p = corner - Vec3::from(self.origin);
        Vec2::new(p.x - self.shear.x * p.z, p.y - self.shear.y * p.z)
    }

    /// Where the ray's line crosses a triangle that it crosses: within the triangle's bounds. It may be infinite.
    #[inline(always)]
    pub(crate) fn t(&self, corners: [Vec3; 3]) -> Option<f32> {
        let Plane { normal, offset, heights } = Plane::new(self.origin.into(), corners);
        self.t_of([offset, normal.dot(self.dir.as_dvec3())], heights)
    }

    /// The same, from a corner's distance to the plane of the triangle, and that which the ray's direction goes, both times any
    /// number; and the heights of the lowest and of the highest corner.
    #[inline(always)]
    pub(crate) fn t_of(&self, [offset, volume]: [f64; 2], heights: [f64; 2]) -> Option<f32> {
        if volume.abs() < self.least_volume {
            return None;
        }
        Some(t_between(offset / volume, heights, self.dir.z))
    }

    /// The axes in the order of turned vectors.
    pub(crate) fn axes(&self) -> [usize; 3] {
        self.axes
    }

    /// Origin and direction, turned.
    pub(crate) fn ray(&self) -> (Vec3A, Vec3A) {
        (self.origin, self.dir)
    }

    /// How far a corner moves across for each unit along the third axis.
    pub(crate) fn shear(&self) -> Vec2 {
        self.shear
    }
}

/// The plane of a turned triangle, as seen from the origin of a turned ray. Nothing of it branches, so that it can be had for
/// several rays side by side.
pub(crate) struct Plane {
    normal: DVec3,
    offset: f64,
    /// The heights of the lowest and of the highest corner.
    heights: [f64; 2],
}

impl Plane {
    #[inline(always)]
    pub fn new(origin: Vec3, [a, b, c]: [Vec3; 3]) -> Self {
        let heights = heights(origin.z, [a.z, b.z, c.z]);
        let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
        let normal = (b - a).cross(c - a);
        Plane { normal, offset: normal.dot(a - origin.as_dvec3()), heights }
    }

    /// Where a direction that crosses the triangle leads to it.
    #[inline(always)]
    pub fn t(&self, dir: Vec3) -> f32 {
        t_between(self.offset / self.normal.dot(dir.as_dvec3()), self.heights, dir.z)
    }
}

/// The heights of the lowest and of the highest corner above the origin.
#[inline(always)]
pub(crate) fn heights(origin: f32, [a, b, c]: [f32; 3]) -> [f64; 2] {
    let (lowest, highest) = (least(a, least(b, c)), most(a, most(b, c)));
    [f64::from(lowest) - f64::from(origin), f64::from(highest) - f64::from(origin)]
}

/// Where a ray of the height `dz` meets a plane, but between the heights of the lowest and of the highest corner.
///
/// Seen from nearly its side, the triangle still bounds t, also where that is no number. Divisions are rounded
/// monotonically: the corners' distances are between those of the lowest and of the highest.
#[inline(always)]
pub(crate) fn t_between(t: f64, heights: [f64; 2], dz: f32) -> f32 {
    let dz = f64::from(dz);
    let [p, q] = heights.map(|height| height / dz);
    least(most(t, least(p, q)), most(p, q)) as f32
}

/// The second and third barycentric coordinate of the origin, by the corners in the plane across a ray that crosses the triangle.
#[inline(always)]
pub(crate) fn uv_across(flat: [Vec2; 3]) -> Vec2 {
    // None of the three is of another sign than the others, so their sum is as exact as they are.
    let areas = areas(flat);
    let det = areas.element_sum();
    Vec2::new((areas.y / det) as f32, (areas.z / det) as f32)
}

/// The lesser of two numbers, the second where the first is none.
#[inline(always)]
fn least<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// The greater of two numbers, the second where the first is none.
#[inline(always)]
fn most<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The axes that turn a ray, by the longest component of its direction and whether that is negative (1) or not (0).
#[inline(always)]
pub(crate) const fn turned_axes(longest: usize, negative: usize) -> [usize; 3] {
    const AXES: [[[usize; 3]; 2]; 4] =
        [[[1, 2, 0], [2, 1, 0]], [[2, 0, 1], [0, 2, 1]], [[0, 1, 2], [1, 0, 2]], [[0; 3]; 2]];
    // So masked, indices need not be tested.
    AXES[longest & 3][negative & 1]
}

/// The axes that turn a ray, by which components of its direction are longest (a bit for each; the last of them counts) and which are
/// negative.
static TURNED: [[[u32; 4]; 8]; 8] = {
    let mut table = [[[0, 1, 2, 0]; 8]; 8];
    let mut at = 8;
    while at < 64 {
        let (longest, signs) = ((at as u32 / 8).ilog2() as usize, at % 8);
        let [x, y, z] = turned_axes(longest, signs >> longest & 1);
        table[at / 8][signs] = [x as u32, y as u32, z as u32, 0];
        at += 1;
    }
    table
};

#[inline(always)]
fn turned([x, y, z]: [usize; 3], v: &[f32; 3]) -> Vec3 {
    Vec3::new(v[x], v[y], v[z])
}

/// Twice the areas of the triangles from the origin to the three edges: unnormalised barycentric coordinates.
#[inline(always)]
fn areas([a, b, c]: [Vec2; 3]) -> DVec3 {
    DVec3::new(edge(b, c), edge(c, a), edge(a, b))
}

/// Whether the edge from `p` to `q` goes round the origin clockwise: the sign of the edge function, never zero.
#[inline(always)]
fn is_front(p: Vec2, q: Vec2) -> bool {
    let value = q.x * p.y - q.y * p.x;
    // Rounding is monotonic: the difference of two rounded products has the sign of the true one.
    if value.abs() > 0.0 && value.abs() < f32::INFINITY { value > 0.0 } else { is_front_exact(p, q) }
}

/// As [`is_front`], where single precision sees zero or overflows.
#[cold]
fn is_front_exact(p: Vec2, q: Vec2) -> bool {
    // Terms of the edge function about (e, e^2), in falling order: 1, e, e^2. Differences in double precision, for
    // those of single precision may underflow.
    [edge(p, q), f64::from(q.y) - f64::from(p.y), f64::from(p.x) - f64::from(q.x)]
        .into_iter()
        .find(|term| *term != 0.0)
        .is_some_and(|term| term > 0.0)
}

/// The edge function of the edge from `p` to `q` about the origin: a product of two f32 is exact in f64.
fn edge(p: Vec2, q: Vec2) -> f64 {
    f64::from(q.x) * f64::from(p.y) - f64::from(q.y) * f64::from(p.x)
}
