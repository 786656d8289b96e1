//! Detection of subpixel shifts at edges.
//!
//! If a picture f is shifted by s, its values change by about -s f'. Fitting s to all edges by
//! least squares works even without antialiasing, because a shift by s then changes a share s of
//! the edge pixels. Source: Lucas and Kanade, *An Iterative Image Registration Technique*, 1981.

use super::sample::{Sample, View};
use durer_bvh::math::Vec3;

/// Smallest shift, in pixels, that can be distinguished from chance.
const LEAST: f64 = 0.2;

/// Explains differences at edges by a shift of the edges, if that is possible.
pub fn cause(reference: &View, at_edges: &[Sample]) -> Option<String> {
    let [right, stretch_x, down, stretch_y] = flow(reference, at_edges)?;
    let moved = |amount: f64| amount.abs() > LEAST;
    // If the ray of pixel i passes through i / (n - 1) instead of (i + 0.5) / n, it is half a pixel
    // too far out at both borders.
    let is_half = |stretch: f64| (0.3..0.75).contains(&stretch.abs());
    let is_stretched = moved(stretch_x.abs().max(stretch_y.abs()));
    if !moved(right) && !moved(down) && is_half(stretch_x) && is_half(stretch_y) && stretch_x * stretch_y > 0.0 {
        let whose = if stretch_x < 0.0 { "the picture's" } else { "the reference's" };
        return Some(format!(
            "{whose} rays pass through i / (n - 1) of the width and height instead of the centre of pixel i, (i + 0.5) \
             / n"
        ));
    }
    // Other stretches come from a different camera, and the pictures alone do not show the reason.
    if is_stretched {
        return None;
    }
    let way = |amount: f64, back: &str, on: &str| {
        moved(amount).then(|| format!("{:.1} pixels {}", amount.abs(), if amount < 0.0 { back } else { on }))
    };
    let ways: Vec<String> =
        [way(right, "to the left", "to the right"), way(down, "up", "down")].into_iter().flatten().collect();
    let half = "rays do not pass through the pixel centres";
    (!ways.is_empty()).then(|| format!("the picture is shifted by about {}, because {half}", ways.join(" and ")))
}

/// Estimates how far edges are shifted, in pixels. Returns the shift to the right in the middle of
/// the picture, the additional shift to the right at the right border, and the same two values for
/// the downward direction.
fn flow(reference: &View, at_edges: &[Sample]) -> Option<[f64; 4]> {
    let mut matrix = [[0.0; 5]; 4];
    let (half_width, half_height) = (reference.width as f64 / 2.0, reference.height as f64 / 2.0);
    for s in at_edges {
        let along_x = 0.5 * (reference.at(s.x - 1, s.y) - reference.at(s.x + 1, s.y));
        let along_y = 0.5 * (reference.at(s.x, s.y - 1) - reference.at(s.x, s.y + 1));
        let (u, v) = ((s.x as f64 + 0.5) / half_width - 1.0, (s.y as f64 + 0.5) / half_height - 1.0);
        let difference: Vec3 = s.test - s.reference;
        for channel in 0..3 {
            let (gx, gy) = (f64::from(along_x[channel]), f64::from(along_y[channel]));
            let row = [gx, gx * u, gy, gy * v];
            for i in 0..4 {
                for j in 0..4 {
                    matrix[i][j] += row[i] * row[j];
                }
                matrix[i][4] += row[i] * f64::from(difference[channel]);
            }
        }
    }
    solve(matrix)
}

/// Solves linear equations by Gaussian elimination; returns `None` if the solution is not unique.
fn solve(mut rows: [[f64; 5]; 4]) -> Option<[f64; 4]> {
    let largest = (0..4).map(|i| rows[i][i]).fold(0.0, f64::max);
    for i in 0..4 {
        // The matrix is symmetric and positive semidefinite, so pivots on the diagonal are
        // sufficient.
        if rows[i][i] <= 1e-6 * largest {
            return None;
        }
        let pivot = rows[i];
        for (other, row) in rows.iter_mut().enumerate() {
            if other != i {
                let factor = row[i] / pivot[i];
                row.iter_mut().zip(pivot).for_each(|(value, pivot)| *value -= factor * pivot);
            }
        }
    }
    Some(std::array::from_fn(|i| rows[i][4] / rows[i][i]))
}
