//! Plan of a measured grid: false colours, isolux lines, axes and a scale, as SVG.

use super::grid::Grid;
use durer::film::false_color::FalseColorScale;
use durer::film::false_color::round_step;
use durer::image::Transfer;
use durer::math::Vec3;
use std::fmt::Write as _;

/// Length of the longer side of the plan, in SVG units.
const SIDE: f64 = 600.0;
/// Margin around the plan with the numbers of the axes, in SVG units.
const MARGIN: f64 = 60.0;
/// Colour of cells inside objects, which have no value.
const NO_VALUE: &str = "#bbb";
/// Approximate number of ticks of an axis.
const TICKS: f64 = 6.0;
/// Width of the scale with its numbers, in SVG units.
const SCALE: f64 = 110.0;
/// Length from which an isolux line has a label, in SVG units.
const LABELLED_LENGTH: f64 = 60.0;
/// Approximate number of isolux lines.
const LINES: f64 = 8.0;

/// Axis of a plan: its name, and its coordinates at the start and at the end of an edge.
struct Axis {
    name: String,
    ends: [f64; 2],
}

impl Axis {
    /// Returns the axis along an edge. If the edge is parallel to an axis of the world, it has the
    /// coordinates of that axis; otherwise, it has the distance from the corner.
    fn along(grid: &Grid, edge: usize) -> Axis {
        let (corner, along) = (grid.corner, grid.edges[edge]);
        let length = along.length();
        let parallel = (0..3).find(|&axis| along[axis].abs() >= length * (1.0 - 1e-6) && length > 0.0);
        match parallel {
            Some(axis) => {
                let start = f64::from(corner[axis]);
                Axis { name: ["x", "y", "z"][axis].into(), ends: [start, start + f64::from(along[axis])] }
            }
            None => Axis { name: format!("along edge {}", edge + 1), ends: [0.0, f64::from(length)] },
        }
    }

    /// Returns round coordinates on the axis, each with its share of the way along the edge.
    fn ticks(&self) -> Vec<(f64, f32)> {
        let [start, end] = self.ends;
        let (low, high) = (start.min(end), start.max(end));
        let step = round_step((high - low) / TICKS);
        let first = (low / step - 1e-6).ceil();
        let ticks = (0..).map(|i| (first + f64::from(i)) * step).take_while(|tick| *tick <= high + 1e-6 * step);
        ticks.take(64).map(|tick| ((tick - start) / (end - start), tick as f32)).collect()
    }
}

/// Text and lines on a plan.
pub struct Legend<'a> {
    /// Unit of the values.
    pub unit: &'static str,
    /// Line below the plan.
    pub caption: String,
    /// Values of the isolines; round values if empty.
    pub levels: &'a [f64],
}

/// Draws a grid as seen from the side of its normal. The first edge points to the right. Points
/// with the value NaN, which are inside objects, are grey.
pub fn draw(grid: &Grid, values: &[f64], up: Vec3, legend: &Legend) -> String {
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
    let scale = FalseColorScale::from_values(values.iter().filter(|value| !value.is_nan()).map(|&value| value as f32));
    let color = |value: f64| {
        if value.is_nan() {
            return NO_VALUE.to_string();
        }
        let [r, g, b] = Transfer::Srgb.encode_pixel(scale.color(value as f32));
        format!("#{r:02x}{g:02x}{b:02x}")
    };
    let (whole, total) = (width + 2.0 * MARGIN + SCALE, height + 2.0 * MARGIN + 10.0);
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
    let round = || (1..).map(|i| step * f64::from(i)).take_while(|level| *level < f64::from(scale.high)).collect();
    let levels = if legend.levels.is_empty() { round() } else { legend.levels.to_vec() };
    for level in levels {
        let segments = isolines(values, columns, level);
        if segments.is_empty() {
            continue;
        }
        let (mut path, mut length) = (String::new(), 0.0);
        for [(a, b), (c, d)] in &segments {
            let ((x0, y0), (x1, y1)) = (place(a + 0.5, b + 0.5), place(c + 0.5, d + 0.5));
            length += ((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0)).sqrt();
            write!(path, "M{x0:.2} {y0:.2}L{x1:.2} {y1:.2}").unwrap_or_default();
        }
        add(format_args!("<path fill=\"none\" stroke=\"#fff\" stroke-width=\"1.2\" d=\"{path}\"/>"));
        // The label would hide a shorter line.
        if length < LABELLED_LENGTH {
            continue;
        }
        let [(a, b), _] = segments[segments.len() / 2];
        let (x, y) = place(a + 0.5, b + 0.5);
        // The outline is a text of its own, because not every viewer draws it below the letters.
        for style in ["fill=\"#fff\" stroke=\"#fff\" stroke-width=\"4\" stroke-linejoin=\"round\"", "fill=\"#000\""] {
            add(format_args!(
                "<text x=\"{x:.2}\" y=\"{:.2}\" {style} font-size=\"13\" text-anchor=\"middle\">{}</text>",
                y + 4.0,
                level as f32
            ));
        }
    }
    let [across, upright] = [0, 1].map(|edge| Axis::along(grid, edge));
    add(format_args!("<g fill=\"#222\" stroke=\"none\">"));
    for (share, tick) in across.ticks() {
        let (x, y) = (MARGIN + share * width, MARGIN + height);
        add(format_args!("<path d=\"M{x:.2} {y:.2}v5\" stroke=\"#222\"/>"));
        add(format_args!("<text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"middle\">{tick}</text>", y + 18.0));
    }
    for (share, tick) in upright.ticks() {
        let y = MARGIN + if is_upward { 1.0 - share } else { share } * height;
        add(format_args!("<path d=\"M{MARGIN} {y:.2}h-5\" stroke=\"#222\"/>"));
        add(format_args!("<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\">{tick}</text>", MARGIN - 8.0, y + 4.0));
    }
    let middle = (MARGIN + 0.5 * width, MARGIN + 0.5 * height);
    add(format_args!(
        "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"middle\">{}</text>",
        middle.0,
        MARGIN + height + 34.0,
        across.name
    ));
    add(format_args!(
        "<text transform=\"translate(16 {:.2}) rotate(-90)\" text-anchor=\"middle\">{}</text></g>",
        middle.1, upright.name
    ));
    let left = MARGIN + width + 25.0;
    add(format_args!("<text x=\"{left:.2}\" y=\"{:.2}\" fill=\"#222\">{}</text>", MARGIN - 10.0, legend.unit));
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
    add(format_args!(
        "<text x=\"{MARGIN}\" y=\"{:.2}\" fill=\"#222\">{}{}</text>",
        MARGIN + height + 56.0,
        legend.caption,
        if values.iter().any(|value| value.is_nan()) { "; grey: inside an object" } else { "" }
    ));
    svg + "</svg>\n"
}

/// Point between the values of a grid: column and row.
type Place = (f64, f64);

/// Returns the segments on which the values, interpolated between the points of a grid, equal
/// `level` (marching squares). In a cell whose opposite corners lie on the same side, the mean of
/// the corners decides. Cells with a corner that has no value have no lines.
fn isolines(values: &[f64], columns: usize, level: f64) -> Vec<[Place; 2]> {
    let rows = values.len() / columns;
    let mut segments = Vec::new();
    for row in 0..rows.saturating_sub(1) {
        for column in 0..columns.saturating_sub(1) {
            // Corners in order around the cell.
            let corners = [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)];
            let at = corners.map(|(c, r)| values[r * columns + c]);
            if at.iter().any(|value| value.is_nan()) {
                continue;
            }
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
    use super::{Axis, isolines};
    use crate::measure::grid::parse;

    #[test]
    fn axes_have_round_coordinates_of_the_world() {
        let grid = parse("1,0.8,6:4,0,0:0,0,-3:4x3").unwrap();
        let [x, z] = [0, 1].map(|edge| Axis::along(&grid, edge));
        assert_eq!((&*x.name, &*z.name), ("x", "z"));
        let ticks = |axis: &Axis| -> Vec<(f32, f32)> {
            axis.ticks().iter().map(|(share, tick)| ((1e6 * share).round() as f32 / 1e6, *tick)).collect()
        };
        assert_eq!(ticks(&x), [(0.0, 1.0), (0.25, 2.0), (0.5, 3.0), (0.75, 4.0), (1.0, 5.0)]);
        let z = ticks(&z);
        assert_eq!((z[0], z[z.len() - 1], z.len()), ((1.0, 3.0), (0.0, 6.0), 7));
        let oblique = Axis::along(&parse("0,0,0:3,0,4:0,1,0:2x2").unwrap(), 0);
        assert_eq!((&*oblique.name, oblique.ends), ("along edge 1", [0.0, 5.0]));
    }

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
        assert!(isolines(&[0.0, f64::NAN, 2.0, 2.0], 2, 1.0).is_empty());
    }
}
