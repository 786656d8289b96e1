//! SSIM: the structural similarity of two pictures.
//!
//! Source: Wang, Bovik, Sheikh and Simoncelli, *Image Quality Assessment: From Error Visibility to
//! Structural Similarity*, IEEE Transactions on Image Processing 13(4), 2004, equation 13, with a
//! Gaussian window of 11 pixels and a standard deviation of 1.5.

use super::filter::{Filter, Kernel, filter_rows};
use durer_bvh::math::Vec3;

/// Radius of the window in pixels. A picture must be larger than the window.
const RADIUS: usize = 5;
/// The constants are (0.01 L)^2 and (0.03 L)^2, where the range L of the values is 1.
const C1: f32 = 1e-4;
const C2: f32 = 9e-4;
/// Luma of Rec. 601, which the program of the paper's authors uses for colour pictures.
const LUMA: Vec3 = Vec3::new(0.299, 0.587, 0.114);

/// Returns the mean similarity of the luma of two pictures with values from 0 to 1, over all
/// positions at which the window fits into the pictures.
///
/// The result lies between -1 and 1, where 1 means that the pictures are equal. Returns `None` if
/// the pictures are smaller than the window.
pub(super) fn ssim(width: usize, height: usize, a: &[Vec3], b: &[Vec3]) -> Option<f64> {
    if width <= 2 * RADIUS || height <= 2 * RADIUS {
        return None;
    }
    let kernel = Kernel::gaussian(RADIUS, 1.5);
    let filters: [Filter; 5] = std::array::from_fn(|plane| (plane, &kernel, &kernel));
    let planes = |y: usize, rows: &mut [Vec<f32>]| {
        let [x_row, y_row, xx_row, yy_row, xy_row] = rows else { unreachable!("five planes") };
        for column in 0..width {
            let (x, y) = (a[y * width + column].dot(LUMA), b[y * width + column].dot(LUMA));
            (x_row[column], y_row[column]) = (x, y);
            (xx_row[column], yy_row[column], xy_row[column]) = (x * x, y * y, x * y);
        }
    };
    let finish = |_: usize, rows: &[Vec<f32>], out: &mut [f32]| {
        for (column, out) in out.iter_mut().enumerate() {
            let [mx, my, xx, yy, xy] = std::array::from_fn(|plane| rows[plane][column]);
            let (vx, vy, covariance) = (xx - mx * mx, yy - my * my, xy - mx * my);
            *out = (2.0 * mx * my + C1) * (2.0 * covariance + C2) / ((mx * mx + my * my + C1) * (vx + vy + C2));
        }
    };
    let map = filter_rows((width, height), 5, &filters, planes, finish);
    let inside = |row: &[f32]| row[RADIUS..width - RADIUS].iter().map(|&s| f64::from(s)).sum::<f64>();
    let sum: f64 = map.chunks(width).skip(RADIUS).take(height - 2 * RADIUS).map(inside).sum();
    Some(sum / ((width - 2 * RADIUS) * (height - 2 * RADIUS)) as f64)
}
