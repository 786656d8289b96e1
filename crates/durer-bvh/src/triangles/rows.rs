//! Layout of a leaf: nine rows with the coordinates of the corners, and one row with triangle
//! numbers.

use crate::build::is_finite;
use crate::lanes::ROWS;
use crate::math::Vec3;

/// Bit that turns a triangle number below 2^28 into a normal `f32`. Arithmetic also runs on the
/// lanes beyond the end of a row, and subnormal numbers would slow it down.
pub(super) const TAG: u32 = 1 << 30;

/// Returns the number of the triangle in a lane of a leaf with `count` triangles.
#[inline(always)]
pub(super) fn number(rows: &[f32], count: usize, lane: usize) -> u32 {
    rows[(ROWS - 1) * count + lane].to_bits() & !TAG
}

/// Writes a triangle into the rows of a leaf with `count` triangles. `rows` begins at the lane of
/// the triangle. If a corner is not finite, all corners are set to NaN so that no ray hits the
/// triangle.
pub(super) fn put(rows: &mut [f32], count: usize, number: u32, corners: [Vec3; 3]) {
    let [a, b, c] = if is_finite(&corners) { corners } else { [Vec3::NAN; 3] };
    let tagged = f32::from_bits(number | TAG);
    let column = [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, tagged];
    rows.iter_mut().step_by(count).zip(column).for_each(|(to, x)| *to = x);
}
