//! Plan of a measured grid: false colours, isolux lines and a scale, as SVG.

use super::grid::Grid;
use crate::svg::round_step;
use durer::film::false_color::FalseColorScale;
use durer::image::Transfer;
use durer::math::Vec3;
use durer::measure::{Measured, Uniformity};
use std::fmt::Write as _;

/// Length of the longer side of the plan, in SVG units.
const SIDE: f64 = 600.0;
/// Margin around the plan, in SVG units.
const MARGIN: f64 = 30.0;
/// Width of the scale with its numbers, in SVG units.
const SCALE: f64 = 110.0;
/// Approximate number of isolux lines.
const LINES: f64 = 8.0;

/// Draws a grid as seen from the side of its normal. The first edge points to the right.
pub fn draw(grid: &Grid, points: &[Measured], up: Vec3) -> String {
    let values: Vec<f64> = points.iter().map(|point| point.illuminance).collect();
    let [columns, rows] = grid.counts.map(|count| count as usize);
    let [long, deep] = grid.edges.map(|edge| f64::from(edge.length()));
    let ratio = if long > 0.0 && deep > 0.0 { (deep / long).clamp(0.1, 10.0) } else { 1.0 };
    let (width, height) = if ratio < 1.0 { (SIDE, SIDE * ratio) } else { (SIDE / ratio, SIDE) };
    // Seen from above, the second edge points up or down on the page.
    let is_upward = grid.edges[0].cross(grid.edges[1]).dot(grid.normal(up)) >= 0.0;
    let cell = (width / columns as f64, height / rows as f64);
    let place = |column: f64, row: f64| {
        let y = if is_upward { height - row * cell.1 } else { row * cell.1 };
        (MARGIN + column * cell.0, MARGIN + y)
    };
    let scale = FalseColorScale::from_values(values.iter().map(|&value| value as f32));
    let color = |value: f64| {
        let [r, g, b] = Transfer::Srgb.encode_pixel(scale.color(value as f32));
        format!("#{r:02x}{g:02x}{b:02x}")
    };
    let (whole, total) = (width + 2.0 * MARGIN + SCALE, height + 2.0 * MARGIN + 20.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {whole:.1} {total:.1}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"{whole:.1}\" height=\"{total:.1}\" fill=\"#fff\"/>\n"
    );
    let mut add = |line: std::fmt::Arguments| writeln!(svg, "{line}").unwrap_or_default();
    for (i, &value) in values.iter().enumerate() {
        let (column, row) = ((i % columns) as f64, (i / columns) as f64);
        let (x, y) = place(column, if is_upward { row + 1.0 } else { row });
        // Overlap neighbours slightly, so that no gaps show.
        let (w, h) = (cell.0 + 0.5, cell.1 + 0.5);
        add(format_args!(
            "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" fill=\"{}\"/>",
            color(value)
        ));
    }
    let step = round_step(f64::from(scale.high) / LINES);
    for level in (1..).map(|i| step * f64::from(i)).take_while(|level| *level < f64::from(scale.high)) {
        let segments = isolines(&values, columns, level);
        if segments.is_empty() {
            continue;
        }
        let mut path = String::new();
        for [(a, b), (c, d)] in &segments {
            let ((x0, y0), (x1, y1)) = (place(a + 0.5, b + 0.5), place(c + 0.5, d + 0.5));
            write!(path, "M{x0:.2} {y0:.2}L{x1:.2} {y1:.2}").unwrap_or_default();
        }
        add(format_args!("<path fill=\"none\" stroke=\"#fff\" stroke-width=\"1.2\" d=\"{path}\"/>"));
        let [(a, b), _] = segments[segments.len() / 2];
        let (x, y) = place(a + 0.5, b + 0.5);
        add(format_args!(
            "<text x=\"{x:.2}\" y=\"{y:.2}\" fill=\"#fff\" stroke=\"#000\" stroke-width=\"2.5\" paint-order=\"stroke\" \
             text-anchor=\"middle\">{}</text>",
            level as f32
        ));
    }
    let left = MARGIN + width + 25.0;
    for i in 0..64 {
        let share = f64::from(i) / 64.0;
        let value = f64::from(scale.low) + (1.0 - share) * f64::from(scale.high - scale.low);
        let (y, h) = (MARGIN + share * height, height / 64.0 + 0.5);
        add(format_args!(
            "<rect x=\"{left:.2}\" y=\"{y:.2}\" width=\"18\" height=\"{h:.2}\" fill=\"{}\"/>",
            color(value)
        ));
    }
    for level in (0..).map(|i| step * f64::from(i)).take_while(|level| *level <= f64::from(scale.high)) {
        let y = MARGIN + (1.0 - level / f64::from(scale.high)) * height + 4.0;
        add(format_args!("<text x=\"{:.2}\" y=\"{y:.2}\" fill=\"#222\">{}</text>", left + 24.0, level as f32));
    }
    if let Some(figures) = Uniformity::of(points) {
        let Uniformity { min, average, max } = figures;
        add(format_args!(
            "<text x=\"{MARGIN}\" y=\"{:.2}\" fill=\"#222\">average {average:.1}, minimum {min:.1}, maximum {max:.1}, \
             U0 {:.2}, U1 {:.2}</text>",
            MARGIN + height + 24.0,
            figures.u0(),
            figures.u1()
        ));
    }
    svg + "</svg>\n"
}

/// Point between the values of a grid: column and row.
type Place = (f64, f64);

/// Returns the segments on which the values, interpolated between the points of a grid, equal
/// `level` (marching squares). In a cell whose opposite corners lie on the same side, the mean of
/// the corners decides.
fn isolines(values: &[f64], columns: usize, level: f64) -> Vec<[Place; 2]> {
    let rows = values.len() / columns;
    let mut segments = Vec::new();
    for row in 0..rows.saturating_sub(1) {
        for column in 0..columns.saturating_sub(1) {
            // Corners in order around the cell.
            let corners = [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)];
            let at = corners.map(|(c, r)| values[r * columns + c]);
            let crossing = |i: usize| {
                let j = (i + 1) % 4;
                ((at[i] >= level) != (at[j] >= level)).then(|| {
                    let share = (level - at[i]) / (at[j] - at[i]);
                    let mix = |a: usize, b: usize| a as f64 + share * (b as f64 - a as f64);
                    (mix(corners[i].0, corners[j].0), mix(corners[i].1, corners[j].1))
                })
            };
            let found: Vec<Place> = (0..4).filter_map(crossing).collect();
            match found[..] {
                [a, b] => segments.push([a, b]),
                [a, b, c, d] => {
                    let is_joined = (at.iter().sum::<f64>() / 4.0 >= level) == (at[0] >= level);
                    segments.extend(if is_joined { [[a, b], [c, d]] } else { [[d, a], [b, c]] });
                }
                _ => {}
            }
        }
    }
    segments
}

#[cfg(test)]
mod tests {
    use super::isolines;

    #[test]
    fn lines_lie_where_values_equal_the_level() {
        // The value is the column plus twice the row.
        let values: Vec<f64> = (0..20).map(|i| f64::from(i % 5) + 2.0 * f64::from(i / 5)).collect();
        let segments = isolines(&values, 5, 3.25);
        assert!(!segments.is_empty());
        for (x, y) in segments.iter().flatten() {
            assert!((x + 2.0 * y - 3.25).abs() < 1e-12, "{x} {y}");
        }
        // A saddle: the mean (0.5) is above the level, so the high corners are joined.
        let saddle = isolines(&[1.0, 0.0, 0.0, 1.0], 2, 0.4);
        assert_eq!(saddle.len(), 2);
        for [a, b] in saddle {
            // Each segment cuts off one low corner: (1, 0) or (0, 1).
            let near =
                |corner: (f64, f64)| [a, b].iter().all(|p| (p.0 - corner.0).abs() + (p.1 - corner.1).abs() < 0.5);
            assert!(near((1.0, 0.0)) || near((0.0, 1.0)), "{a:?} {b:?}");
        }
        assert!(isolines(&[1.0; 9], 3, 2.0).is_empty());
    }
}
