//! Shifts by parts of a pixel, seen at edges.
//!
//! Where a picture f is moved by s, the difference is about -s f'. Least squares over all edges
//! give s even where edges are not smoothed: there a share s of the pixels changes sides. Source:
//! Lucas and Kanade, *An Iterative Image Registration Technique*, 1981.

use super::sample::{Sample, View};
use durer_bvh::math::Vec3;

/// Shifts below this part of a pixel are not told from chance.
const LEAST: f64 = 0.2;

/// Why a picture may differ at edges, if the edges are moved.
pub fn cause(reference: &View, at_edges: &[Sample]) -> Option<String> {
    let [right, stretch_x, down, stretch_y] = flow(reference, at_edges)?;
    let moved = |amount: f64| amount.abs() > LEAST;
    // Pixel i of n at i / (n - 1) instead of (i + 0.5) / n: half a pixel too far out at both
    // borders.
    let is_half = |stretch: f64| (0.3..0.75).contains(&stretch.abs());
    let is_stretched = moved(stretch_x.abs().max(stretch_y.abs()));
    if !moved(right) && !moved(down) && is_half(stretch_x) && is_half(stretch_y) && stretch_x * stretch_y > 0.0 {
        let whose = if stretch_x < 0.0 { "its" } else { "the reference's" };
        return Some(format!(
            "{whose} rays go to i / (n - 1) of the picture's width and height, not through the middle of pixel i, (i + 0.5) / n"
        ));
    }
    // What is stretched otherwise is seen by another camera: why cannot be told from the pictures.
    if is_stretched {
        return None;
    }
    let way = |amount: f64, back: &str, on: &str| {
        moved(amount).then(|| format!("{:.1} pixels {}", amount.abs(), if amount < 0.0 { back } else { on }))
    };
    let ways: Vec<String> =
        [way(right, "to the left", "to the right"), way(down, "up", "down")].into_iter().flatten().collect();
    let half = "rays that do not go through the middle of pixels";
    (!ways.is_empty()).then(|| format!("it is shifted by about {}: {half}", ways.join(" and ")))
}

/// By how many pixels edges are moved to the right in the middle, and more so at the right border
/// than there; the same down.
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

/// Gauss' elimination; `None` where the solution is not determined.
fn solve(mut rows: [[f64; 5]; 4]) -> Option<[f64; 4]> {
    let largest = (0..4).map(|i| rows[i][i]).fold(0.0, f64::max);
    for i in 0..4 {
        // The matrix is symmetric and positive: its diagonal needs no exchange of rows.
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
