//! SIMD triangle tests, either of several triangles against one ray or of one triangle against
//! several rays.
//!
//! The test gives the same results as the one in
//! [`WatertightRay`](crate::watertight::WatertightRay), with the same rounding. In single
//! precision, the sign of an edge function is correct unless the result is zero, so vector
//! arithmetic is enough to reject or accept nearly all triangles. The exact scalar test decides the
//! remaining cases. For any-hit rays, bounds on t are usually sufficient. For the closest hit, t is
//! computed in double precision for every crossed triangle.

use crate::lanes::FloatLanes;

/// Calls a macro for each corner and axis. (A closure might not be inlined, and it would then be
/// compiled without the instructions of the SIMD level.)
macro_rules! by_corner {
    ($make:ident) => {
        [
            [$make!(0, 0), $make!(0, 1), $make!(0, 2)],
            [$make!(1, 0), $make!(1, 1), $make!(1, 2)],
            [$make!(2, 0), $make!(2, 1), $make!(2, 2)],
        ]
    };
}
pub(super) use by_corner;

/// Triangles projected along rays, with their edge functions. There are either several triangles
/// for one ray or one triangle for several rays.
pub struct ProjectedTriangles<N: FloatLanes> {
    /// Projected position of each corner in the plane perpendicular to the ray, and its height
    /// along the third axis.
    corners: [[N::Floats; 3]; 3],
    /// Edge functions of the edges opposite the corners.
    edges: [N::Floats; 3],
    /// Product of the smallest and the largest edge function. It is positive if all have the same
    /// sign, negative if they do not, and zero if the result is uncertain.
    sign: N::Floats,
}

/// Bounds on the `t` at which rays cross triangles, in single precision. They are NaN if unknown.
/// [`ProjectedTriangles::span`] returns them.
pub struct TBounds<N: FloatLanes> {
    pub near: N::Floats,
    pub far: N::Floats,
}

impl<N: FloatLanes> ProjectedTriangles<N> {
    /// Projects corners. The axes of corners and origins are permuted, as in
    /// [`WatertightRay`](crate::watertight::WatertightRay).
    ///
    /// The rounding is the same as in the scalar test, so edge functions have the exact sign unless
    /// they are zero.
    #[inline(always)]
    pub fn new(numbers: N, corners: [[N::Floats; 3]; 3], origin: [N::Floats; 3], shear: [N::Floats; 2]) -> Self {
        ProjectedTriangles::new_relative(numbers, from_origin(numbers, corners, origin), shear)
    }

    /// Projects corners that are [relative to the origin](from_origin); see
    /// [`ProjectedTriangles::new`].
    #[inline(always)]
    pub fn new_relative(numbers: N, corners: [[N::Floats; 3]; 3], shear: [N::Floats; 2]) -> Self {
        let corners @ [a, b, c] = [
            project(numbers, corners[0], shear),
            project(numbers, corners[1], shear),
            project(numbers, corners[2], shear),
        ];
        let edges @ [u, v, w] = [edge(numbers, b, c), edge(numbers, c, a), edge(numbers, a, b)];
        let sign = numbers.mul(numbers.min(u, numbers.min(v, w)), numbers.max(u, numbers.max(v, w)));
        ProjectedTriangles { corners, edges, sign }
    }

    /// Returns a mask of the triangles that the ray's line certainly misses.
    #[inline(always)]
    pub fn missed(&self, numbers: N) -> u32 {
        numbers.lt(self.sign, numbers.splat(0.0))
    }

    /// Returns a mask of the triangles that the ray's line certainly crosses.
    #[inline(always)]
    pub fn crossed(&self, numbers: N) -> u32 {
        numbers.lt(numbers.splat(0.0), self.sign)
    }

    /// Returns the heights of the lowest and the highest corner.
    #[inline(always)]
    pub fn heights(&self, numbers: N) -> [N::Floats; 2] {
        let [a, b, c] = self.corners;
        ends(numbers, [a[2], b[2], c[2]])
    }

    /// Returns bounds on `t` for triangles that are certainly crossed.
    ///
    /// The height z of the crossing is the mean of the corners' heights, weighted by the edge
    /// functions. Let R be a bound on the coordinates of the corners in the plane perpendicular to
    /// the ray, Z a bound on their heights, and H a bound on the differences between the heights.
    /// With e = 2^-23, the error of a coordinate in that plane is at most e (R + 2 Z), so the error
    /// of an edge function is at most e (6 R^2 + 8 R Z). Errors in the weights change the mean by
    /// at most the sum of the errors times H, divided by the sum of the weights. Twice this value
    /// is a bound even if the sum of the weights is itself uncertain. In that case, the value
    /// exceeds H, and both the mean and the `t` of [`WatertightRay`] lie between the heights of the
    /// corners. Other rounding errors add less than 6 e Z, plus a few times the smallest number.
    ///
    /// `inverse_z` is `1 / dz`. The longest component dz of the direction must lie between 10^-15
    /// and 10^15, and coordinates must be below 10^15.
    #[inline(always)]
    pub fn span(&self, numbers: N, inverse_z: f32) -> TBounds<N> {
        const E: f32 = f32::EPSILON;
        let tiny = numbers.splat(f32::MIN_POSITIVE);
        let ([a, b, c], [u, v, w]) = (self.corners, self.edges);
        let inverse = numbers.div(numbers.splat(1.0), numbers.add(numbers.add(u, v), w));
        let height = numbers.mul(numbers.mul_add(u, a[2], numbers.mul_add(v, b[2], numbers.mul(w, c[2]))), inverse);
        let reach = |p: [N::Floats; 3]| numbers.max(numbers.abs(p[0]), numbers.abs(p[1]));
        let radius = numbers.max(reach(a), numbers.max(reach(b), reach(c)));
        let [lowest, highest] = self.heights(numbers);
        let height_most = numbers.max(numbers.abs(lowest), numbers.abs(highest));
        let weights = numbers.mul(numbers.mul(radius, numbers.splat(64.0 * E)), numbers.add(radius, height_most));
        let moved = numbers.mul_add(numbers.add(weights, tiny), numbers.sub(highest, lowest), tiny);
        let error = numbers.mul_add(moved, numbers.abs(inverse), numbers.mul(height_most, numbers.splat(12.0 * E)));
        let error = numbers.mul_add(error, numbers.splat(inverse_z.abs()), tiny);
        let t = numbers.mul(height, numbers.splat(inverse_z));
        TBounds { near: numbers.sub(t, error), far: numbers.add(t, error) }
    }
}

/// Returns the minimum and maximum of three numbers.
#[inline(always)]
pub fn ends<N: FloatLanes>(numbers: N, [a, b, c]: [N::Floats; 3]) -> [N::Floats; 2] {
    [numbers.min(a, numbers.min(b, c)), numbers.max(a, numbers.max(b, c))]
}

/// Returns the corners relative to an origin.
#[inline(always)]
pub fn from_origin<N: FloatLanes>(
    numbers: N,
    corners: [[N::Floats; 3]; 3],
    origin: [N::Floats; 3],
) -> [[N::Floats; 3]; 3] {
    macro_rules! seen {
        ($corner:literal, $axis:literal) => {
            numbers.sub(corners[$corner][$axis], origin[$axis])
        };
    }
    by_corner!(seen)
}

/// Projects a point, given relative to the origin, onto the plane perpendicular to the ray. The
/// third component is the height along the third axis.
#[inline(always)]
pub fn project<N: FloatLanes>(numbers: N, [x, y, z]: [N::Floats; 3], shear: [N::Floats; 2]) -> [N::Floats; 3] {
    [numbers.sub(x, numbers.mul(shear[0], z)), numbers.sub(y, numbers.mul(shear[1], z)), z]
}

/// Returns the edge function of the edge from `p` to `q` at the origin.
#[inline(always)]
fn edge<N: FloatLanes>(numbers: N, p: [N::Floats; 3], q: [N::Floats; 3]) -> N::Floats {
    numbers.sub(numbers.mul(q[0], p[1]), numbers.mul(q[1], p[0]))
}
