//! Triangles and rays side by side: several triangles and a ray, or a triangle and several rays.
//!
//! The test is that of [`WatertightRay`](crate::watertight::WatertightRay), with the same
//! roundings. Edge functions in single precision have the right signs wherever they are not zero,
//! so nearly all triangles are refused or accepted by plain vector arithmetic; what is left is for
//! the scalar test, which is exact. Where any triangle will do, it is enough that t lies between
//! two bounds; where the nearest is wanted, double precision says where each is that is crossed.

use crate::lanes::Numbers;

/// By corner and axis, as a macro makes each. (No closure would do: what is not inlined into a
/// level's entry is compiled without its instructions.)
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

/// Triangles in the planes across rays: several and one ray, or one and several rays.
pub struct Flat<N: Numbers> {
    /// By corner: where it lies across the ray, and its height along the third axis.
    corners: [[N::Floats; 3]; 3],
    /// The edge functions of the edges opposite to the corners.
    edges: [N::Floats; 3],
    /// The product of the least and the greatest of them: positive where all are of one sign,
    /// negative where they are not, and zero where nothing is sure.
    sign: N::Floats,
}

/// Bounds of the t at which triangles are crossed; NaN where nothing is known.
pub struct Span<N: Numbers> {
    pub near: N::Floats,
    pub far: N::Floats,
}

impl<N: Numbers> Flat<N> {
    /// From corners and origins that are turned as
    /// [`WatertightRay`](crate::watertight::WatertightRay) turns them.
    ///
    /// Roundings are the same as there, so signs of edge functions are exact where they are not
    /// zero.
    #[inline(always)]
    pub fn new(numbers: N, corners: [[N::Floats; 3]; 3], origin: [N::Floats; 3], shear: [N::Floats; 2]) -> Self {
        Flat::seen(numbers, from_origin(numbers, corners, origin), shear)
    }

    /// As [`Flat::new`], from corners [as seen from the origin](from_origin).
    #[inline(always)]
    pub fn seen(numbers: N, corners: [[N::Floats; 3]; 3], shear: [N::Floats; 2]) -> Self {
        let corners @ [a, b, c] = [
            across(numbers, corners[0], shear),
            across(numbers, corners[1], shear),
            across(numbers, corners[2], shear),
        ];
        let edges @ [u, v, w] = [edge(numbers, b, c), edge(numbers, c, a), edge(numbers, a, b)];
        let sign = numbers.mul(numbers.min(u, numbers.min(v, w)), numbers.max(u, numbers.max(v, w)));
        Flat { corners, edges, sign }
    }

    /// The signs of the edge functions say for sure that the line of the ray does not cross the
    /// triangle.
    #[inline(always)]
    pub fn missed(&self, numbers: N) -> u32 {
        numbers.lt(self.sign, numbers.splat(0.0))
    }

    /// They say for sure that it does.
    #[inline(always)]
    pub fn crossed(&self, numbers: N) -> u32 {
        numbers.lt(numbers.splat(0.0), self.sign)
    }

    /// The heights of the lowest and of the highest corner.
    #[inline(always)]
    pub fn heights(&self, numbers: N) -> [N::Floats; 2] {
        let [a, b, c] = self.corners;
        ends(numbers, [a[2], b[2], c[2]])
    }

    /// Where those that are crossed for sure are.
    ///
    /// The height z of the crossing is the mean of the corners' heights by the edge functions. Let
    /// R bound how far corners lie across, Z their heights, and H how far those lie apart. With e =
    /// 2^-23 a coordinate across is wrong by at most e (R + 2 Z), so an edge function by at most e
    /// (6 R^2 + 8 R Z). Errors of weights move the mean by their sum times H over the sum of
    /// weights, and twice that is a bound also where the sum of weights is uncertain itself, for
    /// then it exceeds H, and both the mean and the `t` of [`WatertightRay`] lie between the
    /// heights of corners. What else is rounded adds less than 6 e Z, and a few of the least
    /// numbers. `1 / dz` is `inverse_z`; the longest component dz of the direction must lie between
    /// 10^-15 and 10^15, and coordinates below 10^15.
    #[inline(always)]
    pub fn span(&self, numbers: N, inverse_z: f32) -> Span<N> {
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
        Span { near: numbers.sub(t, error), far: numbers.add(t, error) }
    }
}

/// The least and the greatest of three numbers.
#[inline(always)]
pub fn ends<N: Numbers>(numbers: N, [a, b, c]: [N::Floats; 3]) -> [N::Floats; 2] {
    [numbers.min(a, numbers.min(b, c)), numbers.max(a, numbers.max(b, c))]
}

/// Corners as seen from an origin.
#[inline(always)]
pub fn from_origin<N: Numbers>(
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

/// Where a point that is seen from the origin lies in the plane across the ray, and its height
/// along the third axis.
#[inline(always)]
pub fn across<N: Numbers>(numbers: N, [x, y, z]: [N::Floats; 3], shear: [N::Floats; 2]) -> [N::Floats; 3] {
    [numbers.sub(x, numbers.mul(shear[0], z)), numbers.sub(y, numbers.mul(shear[1], z)), z]
}

/// The edge function of the edge from `p` to `q` about the origin.
#[inline(always)]
fn edge<N: Numbers>(numbers: N, p: [N::Floats; 3], q: [N::Floats; 3]) -> N::Floats {
    numbers.sub(numbers.mul(q[0], p[1]), numbers.mul(q[1], p[0]))
}
