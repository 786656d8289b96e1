//! Up to eight triangles at once.
//!
//! The test is that of [`Sheared`], with the same roundings. Edge functions in single precision have the right signs
//! wherever they are not zero, so nearly all triangles are refused or accepted by plain vector arithmetic; what is left is
//! for the scalar test, which is exact.

use crate::bvh::lanes::Lanes;
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
pub fn quick<L: Lanes>(
    lanes: L,
    sheared: &Sheared,
    corners: &[f32],
    count: usize,
    (t_min, t_last): (f32, f32),
) -> Quick {
    let (origin, dir) = sheared.ray();
    let origin = [lanes.splat(origin.x), lanes.splat(origin.y), lanes.splat(origin.z)];
    let shear = [lanes.splat(sheared.shear().x), lanes.splat(sheared.shear().y)];
    let rows = lanes.rows(corners, count, sheared.axes());
    let [a, b, c] =
        [flat(lanes, rows[0], origin, shear), flat(lanes, rows[1], origin, shear), flat(lanes, rows[2], origin, shear)];
    let (u, v, w) = (edge(lanes, b, c), edge(lanes, c, a), edge(lanes, a, b));
    let zero = lanes.splat(0.0);
    let (least, greatest) = (lanes.min(u, lanes.min(v, w)), lanes.max(u, lanes.max(v, w)));
    let missed = lanes.lt(least, zero) & lanes.lt(zero, greatest);
    let crossed = lanes.lt(zero, least) | lanes.lt(greatest, zero);
    // The crossing is no nearer than the nearest corner, and no farther than the farthest, but for rounding.
    const SLACK: f32 = 8.0 * f32::EPSILON;
    let (near, far) = (t_min * dir.z, t_last * dir.z);
    let (low, high) = if dir.z > 0.0 { (near, far) } else { (far, near) };
    let [low_slack, high_slack] = [low, high].map(|z| SLACK * z.abs() + f32::MIN_POSITIVE);
    let lowest = lanes.min(a[2], lanes.min(b[2], c[2]));
    let highest = lanes.max(a[2], lanes.max(b[2], c[2]));
    let beside = lanes.lt(lanes.splat(high + high_slack), lowest) | lanes.lt(highest, lanes.splat(low - low_slack));
    let inside = lanes.lt(highest, lanes.splat(high - high_slack)) & lanes.lt(lanes.splat(low + low_slack), lowest);
    Quick { candidates: !(missed | beside) & ((1 << count) - 1), crossed, inside }
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

/// The edge function of edges from `p` to `q` about the origin.
#[inline(always)]
pub fn edge<L: Lanes>(lanes: L, p: [L::Floats; 3], q: [L::Floats; 3]) -> L::Floats {
    lanes.sub(lanes.mul(q[0], p[1]), lanes.mul(q[1], p[0]))
}
