//! Watertight ray-triangle intersection. A ray never slips between two triangles that share an
//! edge, and it crosses exactly one of the triangles around an edge or a vertex.
//!
//! A shear transform aligns the ray with one axis. The ray crosses the triangle if the projected
//! edges wind around the origin. Corners that two triangles share are rounded in the same way, and
//! the sign of each edge function is exact, so neighbouring triangles never disagree. If the ray
//! passes through an edge, the result is that of a ray moved by an infinitesimal (e, e^2) in the
//! plane perpendicular to it.
//!
//! Single precision decides whether a triangle is crossed, and double precision is used to compute
//! the distance. Therefore, if rounding puts the origin of a ray on one side of a triangle, the ray
//! starts on that side, however close the origin is to the triangle.
//!
//! Source: Woop, Benthin, Wald, *Watertight Ray/Triangle Intersection*, JCGT 2(1), 2013. The
//! infinitesimal is taken from Edelsbrunner and Mücke, *Simulation of Simplicity*, ACM TOG 9(1),
//! 1990.

use crate::math::{Doubles, Ray, Triple, Vec2, Vec3};
use glam::Vec3A;

#[cfg(test)]
mod tests;

/// Point where a ray crosses a single triangle, as returned by [`WatertightRay::intersect`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Position along the ray.
    pub t: f32,
    /// Second and third barycentric coordinates: the point is (1 - u - v) a + u b + v c.
    pub uv: Vec2,
}

/// A ray prepared for watertight intersection tests with many triangles.
///
/// Its axes are permuted: the longest component of its direction becomes the third axis, and the
/// order of the other two preserves the sides of triangles. `WatertightRay::crosses` and similar
/// methods take corners in this order of axes.
#[derive(Clone, Copy, Debug)]
pub struct WatertightRay {
    axes: &'static AxisOrder,
    origin: Vec3A,
    dir: Vec3A,
    /// Direction of the ray divided by its third component.
    shear: Vec3A,
    min_volume: f64,
}

impl WatertightRay {
    /// Prepares a ray. A ray with a zero or infinite direction hits nothing.
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        let axes = axis_order(ray.dir.into());
        let [origin, dir] = [ray.origin, ray.dir].map(|v| permuted(axes, v.as_ref()));
        let sheared = Self::permuted(axes, origin, dir);
        let shear = if sheared.dir.z.is_finite() { sheared.shear } else { Vec3A::NAN };
        WatertightRay { shear, ..sheared }
    }

    /// Creates a ray with a finite direction from an origin and a direction whose axes
    /// [`axis_order`] has already permuted.
    #[inline(always)]
    pub(crate) fn permuted(axes: &'static AxisOrder, origin: Vec3A, dir: Vec3A) -> Self {
        WatertightRay { axes, origin, dir, shear: dir / dir.z, min_volume: 0.0 }
    }

    /// Sets the smallest |(b - a) x (c - a) · d| of a triangle that the ray with direction d can
    /// hit.
    pub fn min_volume(self, min_volume: f64) -> Self {
        WatertightRay { min_volume, ..self }
    }

    /// Returns the crossing with a triangle in the open interval (`t_min`, `t_max`), from either
    /// side.
    #[inline(always)]
    pub fn intersect(&self, corners: [Vec3; 3], t_min: f32, t_max: f32) -> Option<Crossing> {
        let corners = corners.map(|corner| permuted(self.axes, corner.as_ref()));
        if !self.crosses(corners) {
            return None;
        }
        let t = self.t(corners)?;
        // The comparison also rejects NaN.
        (t > t_min && t < t_max).then(|| Crossing { t, uv: self.uv(corners) })
    }

    /// Returns true if the line of the ray crosses the triangle. Returns false if the triangle is
    /// edge-on.
    pub(crate) fn crosses(&self, corners: [Vec3A; 3]) -> bool {
        let flat @ [a, b, c] = self.flatten(corners);
        let front = is_front(b, c);
        if is_front(c, a) != front || is_front(a, b) != front {
            return false;
        }
        let [a, b, c] = areas(flat.map(doubles));
        let det = a + b + c;
        det != 0.0 && !det.is_nan()
    }

    /// Returns true if the ray hits the front of a triangle that it crosses. Seen from the front,
    /// the corners are in counter-clockwise order.
    pub(crate) fn is_front(&self, corners: [Vec3A; 3]) -> bool {
        let [a, b, c] = areas(self.flatten(corners).map(doubles));
        // No two of the three areas have opposite signs. The axis order compensates for a direction
        // whose longest component is negative.
        a + b + c > 0.0
    }

    /// Returns the second and third barycentric coordinates of the crossing with a triangle that
    /// the ray crosses.
    #[inline(always)]
    pub(crate) fn uv(&self, corners: [Vec3A; 3]) -> Vec2 {
        let [u, v] = uv_across(self.flatten(corners).map(doubles));
        Vec2::new(u as f32, v as f32)
    }

    #[inline(always)]
    pub(crate) fn flatten(&self, [a, b, c]: [Vec3A; 3]) -> [Vec2; 3] {
        [self.flat(a), self.flat(b), self.flat(c)]
    }

    /// Projects a corner onto the plane perpendicular to the ray.
    #[inline(always)]
    fn flat(&self, corner: Vec3A) -> Vec2 {
        let p = corner - self.origin;
        let flat = p - self.shear * p.z;
        Vec2::new(flat.x, flat.y)
    }

    /// Computes `t` of the crossing with a triangle that the ray crosses, within the bounds of the
    /// triangle. It may be infinite.
    #[inline(always)]
    pub(crate) fn t(&self, corners: [Vec3A; 3]) -> Option<f32> {
        let [t, volume] = PreciseLine::single(self.origin, self.dir).t(&Plane::single(corners));
        if volume.abs() < self.min_volume {
            return None;
        }
        Some(t as f32)
    }

    /// Returns the order of the axes in permuted vectors.
    pub(crate) fn axes(&self) -> &'static AxisOrder {
        self.axes
    }

    /// Returns the origin and direction with permuted axes.
    pub(crate) fn ray(&self) -> (Vec3A, Vec3A) {
        (self.origin, self.dir)
    }

    /// Returns the sideways displacement of a corner per unit along the third axis.
    pub(crate) fn shear(&self) -> Vec2 {
        Vec2::new(self.shear.x, self.shear.y)
    }
}

/// Plane of a triangle with permuted axes, for computing `t` in double precision. It holds one
/// plane or several in SIMD lanes.
#[derive(Clone, Copy)]
pub(crate) struct Plane<V: Triple> {
    pub normal: V,
    pub corner: V,
    /// Coordinates of the lowest and the highest corner along the third axis.
    pub heights: [V::Component; 2],
}

impl<V: Triple> Plane<V> {
    #[inline(always)]
    pub fn new([a, b, c]: [V; 3]) -> Self {
        let (lowest, highest) = (a.min(b.min(c)), a.max(b.max(c)));
        Plane { normal: b.sub(a).cross(c.sub(a)), corner: a, heights: [lowest.z(), highest.z()] }
    }
}

impl Plane<[f64; 3]> {
    #[inline(always)]
    pub fn single(corners: [Vec3A; 3]) -> Self {
        Plane::new(corners.map(|corner| corner.as_dvec3().to_array()))
    }
}

/// Line of a ray with permuted axes, for computing `t` in double precision. It holds one line or
/// several in SIMD lanes. Its methods have no branches.
#[derive(Clone, Copy)]
pub(crate) struct PreciseLine<V: Triple> {
    origin: V,
    dir: V,
    /// 1 divided by the third component of the direction.
    inverse: V::Component,
}

impl PreciseLine<[f64; 3]> {
    #[inline(always)]
    pub fn single(origin: Vec3A, dir: Vec3A) -> Self {
        PreciseLine::new(origin.as_dvec3().to_array(), dir.as_dvec3().to_array())
    }
}

impl<V: Triple<Component = f64>> PreciseLine<V> {
    #[inline(always)]
    pub fn new(origin: V, dir: V) -> Self {
        Self::with_inverse(origin, dir, 1.0 / dir.z())
    }
}

impl<V: Triple> PreciseLine<V> {
    /// Creates the line. `inverse` is 1 divided by the third component of the direction.
    #[inline(always)]
    pub fn with_inverse(origin: V, dir: V, inverse: V::Component) -> Self {
        PreciseLine { origin, dir, inverse }
    }

    /// Computes `t` of the crossing with a triangle that the line crosses, and the signed volume (b
    /// - a) x (c - a) · d.
    ///
    /// `t` belongs to the intersection with the plane, clamped to the range between the lowest and
    /// highest corner. The clamping keeps `t` within the triangle even if the triangle is nearly
    /// edge-on or the division results in NaN. Rounding of products is monotonic, so the distances
    /// of all corners lie in that range.
    #[inline(always)]
    pub fn t(&self, plane: &Plane<V>) -> [V::Component; 2] {
        let volume = plane.normal.dot(self.dir);
        let z = self.origin.z();
        let [p, q] = plane.heights;
        let (p, q) = (p.sub(z).mul(self.inverse), q.sub(z).mul(self.inverse));
        let t = plane.normal.dot(plane.corner.sub(self.origin)).div(volume);
        [t.max(p.min(q)).min(p.max(q)), volume]
    }
}

/// Returns the second and third barycentric coordinates of the origin, given the corners of a
/// triangle projected along a ray that crosses it. It works for one triangle or for several in SIMD
/// lanes.
#[inline(always)]
pub(crate) fn uv_across<D: Doubles>(flat: [[D; 2]; 3]) -> [D; 2] {
    let [a, b, c] = areas(flat);
    // The three areas do not differ in sign, so their sum is as accurate as the areas are.
    let det = a.add(b).add(c);
    [b.div(det), c.div(det)]
}

/// Permutation of axes for a ray, given by the axes that become the first, second, and third axis.
/// The fourth entry is only padding.
pub(crate) type AxisOrder = [u32; 4];

/// Returns the axis order of a ray, given the longest component of its direction and its sign (1 if
/// negative).
#[inline(always)]
pub(crate) const fn axis_order_for(longest: usize, negative: usize) -> AxisOrder {
    const AXES: [[AxisOrder; 2]; 4] =
        [[[1, 2, 0, 0], [2, 1, 0, 0]], [[2, 0, 1, 0], [0, 2, 1, 0]], [[0, 1, 2, 0], [1, 0, 2, 0]], [[0; 4]; 2]];
    // The masks make bounds checks unnecessary.
    AXES[longest & 3][negative & 1]
}

/// Returns the axis order of a ray with direction `dir`.
#[inline(always)]
pub(crate) fn axis_order(dir: Vec3A) -> &'static AxisOrder {
    let length = dir.abs();
    let longest = length.cmpeq(Vec3A::splat(length.max_element())).bitmask();
    &TURNED[longest as usize & 7][dir.is_negative_bitmask() as usize & 7]
}

/// Axis orders, indexed by a mask of the longest components of the direction (the last one counts)
/// and a mask of the negative ones.
static TURNED: [[AxisOrder; 8]; 8] = {
    let mut table = [[[0, 1, 2, 0]; 8]; 8];
    let mut at = 8;
    while at < 64 {
        let (longest, signs) = ((at as u32 / 8).ilog2() as usize, at % 8);
        table[at / 8][signs] = axis_order_for(longest, signs >> longest & 1);
        at += 1;
    }
    table
};

#[inline(always)]
fn permuted([x, y, z, _]: &AxisOrder, v: &[f32; 3]) -> Vec3A {
    Vec3A::new(v[*x as usize], v[*y as usize], v[*z as usize])
}

/// Converts a point in the plane perpendicular to a ray to double precision.
fn doubles(p: Vec2) -> [f64; 2] {
    [f64::from(p.x), f64::from(p.y)]
}

/// Returns twice the areas of the triangles from the origin to the three edges. These are
/// unnormalised barycentric coordinates.
#[inline(always)]
fn areas<D: Doubles>([a, b, c]: [[D; 2]; 3]) -> [D; 3] {
    [edge(b, c), edge(c, a), edge(a, b)]
}

/// Returns the edge function of the edge from `p` to `q` at the origin. Products of two `f32` are
/// exact in `f64`.
#[inline(always)]
fn edge<D: Doubles>(p: [D; 2], q: [D; 2]) -> D {
    q[0].mul(p[1]).sub(q[1].mul(p[0]))
}

/// Returns true if the edge from `p` to `q` runs clockwise around the origin. This is the sign of
/// the edge function, which is never treated as zero.
#[inline(always)]
fn is_front(p: Vec2, q: Vec2) -> bool {
    let value = q.x * p.y - q.y * p.x;
    // Rounding is monotonic, so the difference of two rounded products has the sign of the exact
    // difference.
    if value.abs() > 0.0 && value.abs() < f32::INFINITY { value > 0.0 } else { is_front_exact(p, q) }
}

/// Computes [`is_front`] if the result in single precision is zero or overflows.
#[cold]
fn is_front_exact(p: Vec2, q: Vec2) -> bool {
    // Coefficients of the edge function at (e, e^2), with the largest term first: 1, e, e^2.
    // Differences are computed in double precision because they might underflow in single
    // precision.
    let [p, q] = [doubles(p), doubles(q)];
    [edge(p, q), q[1] - p[1], p[0] - q[0]].into_iter().find(|term| *term != 0.0).is_some_and(|term| term > 0.0)
}
