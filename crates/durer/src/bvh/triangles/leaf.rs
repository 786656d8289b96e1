//! Up to eight triangles and a ray at once.
//!
//! The test is that of [`Sheared`], with the same roundings. Edge functions in single precision have the right signs
//! wherever they are not zero, so nearly all triangles are refused or accepted by plain vector arithmetic; what is left is
//! for the scalar test, which is exact. Where a triangle is crossed is known between two bounds, which is nearly always
//! enough to tell which of two is nearer.

use crate::bvh::lanes::Lanes;
use crate::shape::watertight::Sheared;

/// Triangles in the plane across a ray.
pub struct Flat<L: Lanes> {
    /// By corner: where it lies across the ray, and its height along the third axis.
    corners: [[L::Floats; 3]; 3],
    /// The edge functions of the edges opposite to the corners.
    edges: [L::Floats; 3],
    /// The signs of a triangle's edge functions say for sure that the line of the ray crosses it.
    pub crossed: u32,
    /// They do not say whether it does.
    pub unsure: u32,
}

/// Bounds of the t at which triangles are crossed; NaN where nothing is known.
pub struct Span<L: Lanes> {
    pub near: L::Floats,
    pub far: L::Floats,
}

impl<L: Lanes> Flat<L> {
    /// Looks at the triangles of a leaf side by side.
    ///
    /// Roundings are the same as in [`Sheared`], so the signs are exact where they are not zero.
    #[inline(always)]
    pub fn new(lanes: L, sheared: &Sheared, corners: &[f32], count: usize) -> Self {
        let (origin, shear) = (sheared.ray().0, sheared.shear());
        let origin = [lanes.splat(origin.x), lanes.splat(origin.y), lanes.splat(origin.z)];
        let shear = [lanes.splat(shear.x), lanes.splat(shear.y)];
        let rows = lanes.rows(corners, count, sheared.axes());
        let corners = [
            flat(lanes, rows[0], origin, shear),
            flat(lanes, rows[1], origin, shear),
            flat(lanes, rows[2], origin, shear),
        ];
        let [a, b, c] = corners;
        let edges @ [u, v, w] = [edge(lanes, b, c), edge(lanes, c, a), edge(lanes, a, b)];
        let zero = lanes.splat(0.0);
        let (least, greatest) = (lanes.min(u, lanes.min(v, w)), lanes.max(u, lanes.max(v, w)));
        let missed = lanes.lt(least, zero) & lanes.lt(zero, greatest);
        let crossed = lanes.lt(zero, least) | lanes.lt(greatest, zero);
        let there = (1 << count) - 1;
        Flat { corners, edges, crossed: crossed & there, unsure: !(missed | crossed) & there }
    }

    /// Where those that are crossed for sure are.
    ///
    /// The height z of the crossing is the mean of the corners' heights by the edge functions. Let R bound how far corners lie across, Z
    /// their heights, and H how far those lie apart. With e = 2^-23 a coordinate across is wrong by at most e (R + 2 Z), so an edge
    /// function by at most e (6 R^2 + 8 R Z). Errors of weights move the mean by their sum times H over the sum of weights, and twice
    /// that is a bound also where the sum of weights is uncertain itself, for then it exceeds H, and both the
    /// mean and the `t` of [`Sheared`] lie between the heights of corners. What else is rounded adds less than 6 e Z, and a few of the
    /// least numbers. `1 / dz` is `inverse_z`; the longest component dz of the direction must lie between 10^-15 and 10^15, and
    /// coordinates below 10^15.
    #[inline(always)]
    pub fn span(&self, lanes: L, inverse_z: f32) -> Span<L> {
        const E: f32 = f32::EPSILON;
        let tiny = lanes.splat(f32::MIN_POSITIVE);
        let ([a, b, c], [u, v, w]) = (self.corners, self.edges);
        let inverse = lanes.div(lanes.splat(1.0), lanes.add(lanes.add(u, v), w));
        let height = lanes.mul(lanes.mul_add(u, a[2], lanes.mul_add(v, b[2], lanes.mul(w, c[2]))), inverse);
        let reach = |p: [L::Floats; 3]| lanes.max(lanes.abs(p[0]), lanes.abs(p[1]));
        let across = lanes.max(reach(a), lanes.max(reach(b), reach(c)));
        let lowest = lanes.min(a[2], lanes.min(b[2], c[2]));
        let highest = lanes.max(a[2], lanes.max(b[2], c[2]));
        let height_most = lanes.max(lanes.abs(lowest), lanes.abs(highest));
        let weights = lanes.mul(lanes.mul(across, lanes.splat(64.0 * E)), lanes.add(across, height_most));
        let moved = lanes.mul_add(lanes.add(weights, tiny), lanes.sub(highest, lowest), tiny);
        let error = lanes.mul_add(moved, lanes.abs(inverse), lanes.mul(height_most, lanes.splat(12.0 * E)));
        let error = lanes.mul_add(error, lanes.splat(inverse_z.abs()), tiny);
        let t = lanes.mul(height, lanes.splat(inverse_z));
        Span { near: lanes.sub(t, error), far: lanes.add(t, error) }
    }
}

/// Corners in the plane across the ray, and their heights along the third axis.
#[inline(always)]
pub fn flat<L: Lanes>(lanes: L, p: [L::Floats; 3], origin: [L::Floats; 3], shear: [L::Floats; 2]) -> [L::Floats; 3] {
    let z = lanes.sub(p[2], origin[2]);
    [
        lanes.sub(lanes.sub(p[0], origin[0]), lanes.mul(shear[0], z)),
        lanes.sub(lanes.sub(p[1], origin[1]), lanes.mul(shear[1], z)),
        z,
    ]
}

/// The edge function of the edge from `p` to `q` about the origin.
#[inline(always)]
pub fn edge<L: Lanes>(lanes: L, p: [L::Floats; 3], q: [L::Floats; 3]) -> L::Floats {
    lanes.sub(lanes.mul(q[0], p[1]), lanes.mul(q[1], p[0]))
}
