//! Up to eight triangles at once.
//!
//! The test is that of [`Sheared`], with the same roundings. Edge functions in single precision have the right signs
//! wherever they are not zero, so nearly all triangles are refused or accepted by plain vector arithmetic; what is left is
//! for the scalar test, which is exact.

use crate::bvh::lanes::{Lanes, WIDTH};
use crate::math::Ray;
use crate::shape::watertight::Sheared;

/// What the quick test says, a bit for each triangle of a leaf.
pub struct Quick {
    /// The triangle may be crossed within the range of t.
    pub candidates: u32,
    /// The signs of its edge functions say for sure that its line is.
    pub crossed: u32,
    /// All of it is within the range of t for sure.
    pub inside: u32,
}

/// Tests the triangles of a leaf side by side, by the signs of edge functions and by their bounds along the ray.
///
/// Roundings are the same as in [`Sheared`], so the signs are exact where they are not zero.
#[inline(always)]
pub fn quick<L: Lanes>(lanes: L, ray: &Ray, sheared: &Sheared, corners: &[f32], count: usize, t_last: f32) -> Quick {
    let axes @ [x, y, z] = sheared.axes();
    let origin = [lanes.splat(ray.origin[x]), lanes.splat(ray.origin[y]), lanes.splat(ray.origin[z])];
    let shear = [lanes.splat(sheared.shear().x), lanes.splat(sheared.shear().y)];
    let rows = lanes.rows(corners, count, axes);
    let [a, b, c] =
        [flat(lanes, rows[0], origin, shear), flat(lanes, rows[1], origin, shear), flat(lanes, rows[2], origin, shear)];
    let (u, v, w) = (edge(lanes, b, c), edge(lanes, c, a), edge(lanes, a, b));
    let zero = lanes.splat(0.0);
    let (least, greatest) = (lanes.min(u, lanes.min(v, w)), lanes.max(u, lanes.max(v, w)));
    let missed = lanes.lt(least, zero) & lanes.lt(zero, greatest);
    let crossed = lanes.lt(zero, least) | lanes.lt(greatest, zero);
    // The crossing is no nearer than the nearest corner, and no farther than the farthest, but for rounding.
    const SLACK: f32 = 8.0 * f32::EPSILON;
    let dz = ray.dir[z];
    let (near, far) = (ray.t_min * dz, t_last * dz);
    let (low, high) = if dz > 0.0 { (near, far) } else { (far, near) };
    let [low_slack, high_slack] = [low, high].map(|z| SLACK * z.abs() + f32::MIN_POSITIVE);
    let lowest = lanes.min(a[2], lanes.min(b[2], c[2]));
    let highest = lanes.max(a[2], lanes.max(b[2], c[2]));
    let beside = lanes.lt(lanes.splat(high + high_slack), lowest) | lanes.lt(highest, lanes.splat(low - low_slack));
    let inside = lanes.lt(highest, lanes.splat(high - high_slack)) & lanes.lt(lanes.splat(low + low_slack), lowest);
    Quick { candidates: !(missed | beside) & ((1 << count) - 1), crossed, inside }
}

/// Distances of crossings in double precision, rounded once, as [`Sheared::distance`] finds them; and a bit for each
/// that is certain to be the same.
#[inline(always)]
pub fn distances<L: Lanes>(
    lanes: L,
    ray: &Ray,
    sheared: &Sheared,
    corners: &[f32],
    count: usize,
) -> ([f32; WIDTH], u32) {
    let rows = lanes.rows(corners, count, [0, 1, 2]);
    let o = ray.origin.as_dvec3();
    let origin = [lanes.splat_wide(o.x), lanes.splat_wide(o.y), lanes.splat_wide(o.z)];
    let a = minus(lanes, widen(lanes, rows[0]), origin);
    let b = minus(lanes, widen(lanes, rows[1]), origin);
    let c = minus(lanes, widen(lanes, rows[2]), origin);
    let n = cross(lanes, minus(lanes, b, a), minus(lanes, c, a));
    let d = ray.dir.as_dvec3();
    let volume = dot(lanes, n, [lanes.splat_wide(d.x), lanes.splat_wide(d.y), lanes.splat_wide(d.z)]);
    // Heights are computed again: vectors picked by a number known only now would go through memory.
    let z = sheared.axes()[2];
    let (dz, oz) = (lanes.splat_wide(d[z]), lanes.splat_wide(o[z]));
    let rows = lanes.rows(corners, count, [z; 3]);
    let az = lanes.sub_wide(lanes.widen(rows[0][0]), oz);
    let bz = lanes.sub_wide(lanes.widen(rows[1][0]), oz);
    let cz = lanes.sub_wide(lanes.widen(rows[2][0]), oz);
    let lowest = lanes.min_wide(az, lanes.min_wide(bz, cz));
    let highest = lanes.max_wide(az, lanes.max_wide(bz, cz));
    // A triangle square to the axis has one distance along it.
    let above = lanes.where_equal(lowest, highest, az, dot(lanes, n, a));
    let below = lanes.where_equal(lowest, highest, dz, volume);
    let t = lanes.div_wide(above, below);
    // Products are rounded monotonically: strictly between two corners' heights, t is between their distances.
    let height = lanes.mul_wide(t, dz);
    let square = !(lanes.lt_wide(lowest, highest) | lanes.lt_wide(highest, lowest));
    let between = lanes.lt_wide(lowest, height) & lanes.lt_wide(height, highest);
    (lanes.store(lanes.narrow(t)), square | between)
}

#[inline(always)]
fn widen<L: Lanes>(lanes: L, p: [L::Floats; 3]) -> [L::Doubles; 3] {
    [lanes.widen(p[0]), lanes.widen(p[1]), lanes.widen(p[2])]
}

#[inline(always)]
fn minus<L: Lanes>(lanes: L, p: [L::Doubles; 3], q: [L::Doubles; 3]) -> [L::Doubles; 3] {
    [lanes.sub_wide(p[0], q[0]), lanes.sub_wide(p[1], q[1]), lanes.sub_wide(p[2], q[2])]
}

#[inline(always)]
fn cross<L: Lanes>(lanes: L, p: [L::Doubles; 3], q: [L::Doubles; 3]) -> [L::Doubles; 3] {
    [
        lanes.sub_wide(lanes.mul_wide(p[1], q[2]), lanes.mul_wide(q[1], p[2])),
        lanes.sub_wide(lanes.mul_wide(p[2], q[0]), lanes.mul_wide(q[2], p[0])),
        lanes.sub_wide(lanes.mul_wide(p[0], q[1]), lanes.mul_wide(q[0], p[1])),
    ]
}

#[inline(always)]
fn dot<L: Lanes>(lanes: L, p: [L::Doubles; 3], q: [L::Doubles; 3]) -> L::Doubles {
    let xy = lanes.add_wide(lanes.mul_wide(p[0], q[0]), lanes.mul_wide(p[1], q[1]));
    lanes.add_wide(xy, lanes.mul_wide(p[2], q[2]))
}

/// Corners in the plane across the ray, and their heights along the third axis.
#[inline(always)]
fn flat<L: Lanes>(lanes: L, p: [L::Floats; 3], origin: [L::Floats; 3], shear: [L::Floats; 2]) -> [L::Floats; 3] {
    let z = lanes.sub(p[2], origin[2]);
    [
        lanes.sub(lanes.sub(p[0], origin[0]), lanes.mul(shear[0], z)),
        lanes.sub(lanes.sub(p[1], origin[1]), lanes.mul(shear[1], z)),
        z,
    ]
}

/// The edge function of edges from `p` to `q` about the origin.
#[inline(always)]
fn edge<L: Lanes>(lanes: L, p: [L::Floats; 3], q: [L::Floats; 3]) -> L::Floats {
    lanes.sub(lanes.mul(q[0], p[1]), lanes.mul(q[1], p[0]))
}
