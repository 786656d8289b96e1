//! Drawing of a luminaire's intensities in two vertical planes (polar diagram) as SVG.

use crate::svg::escape;
use durer::film::false_color::round_step;
use durer::light::PhotometricProfile;
use durer::math::fp;
use std::fmt::Write as _;

/// Radius of the diagram in SVG units.
const RADIUS: f64 = 200.0;
/// Half of the width and height of the drawing, in SVG units.
const HALF: f64 = 250.0;
/// Number of circles for round intensities.
const CIRCLES: f64 = 4.0;

/// Draws the intensities: plane 0-180 as a solid line, and plane 90-270 as a dashed one. Straight
/// down is at the bottom.
pub fn draw(profile: &PhotometricProfile, title: &str) -> String {
    let most = f64::from(profile.max_candela());
    let step = round_step(most / CIRCLES);
    let edge = step * (most / step).ceil().max(1.0);
    let point = |angle: f64, radius: f64| {
        let (sin, cos) = fp::sin_cos_degrees(angle);
        (HALF + RADIUS * radius * sin, HALF + RADIUS * radius * cos)
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {0}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{0}\" height=\"{0}\" fill=\"#fff\"/>\n<g fill=\"none\" stroke=\"#ccc\">\n",
        2.0 * HALF
    );
    let mut add = |line: std::fmt::Arguments| writeln!(svg, "{line}").unwrap_or_default();
    for i in 1..=(edge / step).round() as u32 {
        add(format_args!("<circle cx=\"{HALF}\" cy=\"{HALF}\" r=\"{:.2}\"/>", RADIUS * f64::from(i) * step / edge));
    }
    for angle in (0..360).step_by(30) {
        let (x, y) = point(f64::from(angle), 1.0);
        add(format_args!("<path d=\"M{HALF} {HALF}L{x:.2} {y:.2}\"/>"));
    }
    add(format_args!("</g>\n<g fill=\"#666\" text-anchor=\"middle\">"));
    for angle in (-150..=180).step_by(30) {
        let (x, y) = point(f64::from(angle), 1.09);
        add(format_args!("<text x=\"{x:.2}\" y=\"{:.2}\">{}°</text>", y + 4.0, i32::abs(angle)));
    }
    for i in 1..=(edge / step).round() as u32 {
        let radius = f64::from(i) * step;
        let (x, y) = point(15.0, radius / edge);
        add(format_args!("<text x=\"{x:.2}\" y=\"{y:.2}\">{}</text>", radius as f32));
    }
    add(format_args!("</g>"));
    for (plane, style) in [(0.0, "stroke=\"#1f5fa8\""), (90.0, "stroke=\"#b3402b\" stroke-dasharray=\"6 3\"")] {
        let mut path = String::new();
        for i in -360..=360 {
            let angle = 0.5 * f64::from(i);
            let (x, y) = point(angle, f64::from(profile.in_plane(plane, angle)) / edge);
            let letter = if path.is_empty() { 'M' } else { 'L' };
            write!(path, "{letter}{x:.2} {y:.2}").unwrap_or_default();
        }
        add(format_args!("<path fill=\"none\" stroke-width=\"2\" {style} d=\"{path}\"/>"));
    }
    add(format_args!("<text x=\"12\" y=\"22\" font-size=\"15\">{}</text>", escape(title)));
    add(format_args!("<text x=\"12\" y=\"{}\" fill=\"#1f5fa8\">plane 0-180</text>", 2.0 * HALF - 26.0));
    add(format_args!("<text x=\"12\" y=\"{}\" fill=\"#b3402b\">plane 90-270 (dashed)</text>", 2.0 * HALF - 10.0));
    let end = 2.0 * HALF - 12.0;
    add(format_args!("<text x=\"{end}\" y=\"{end}\" text-anchor=\"end\" fill=\"#666\">candela</text>\n</svg>"));
    svg
}
