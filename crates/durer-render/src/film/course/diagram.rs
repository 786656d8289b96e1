//! Diagrams of the 2004 course: sample positions within pixels, and filter weights.
//!
//! Both show each pixel enlarged to `zoom` times `zoom` pixels.

use super::stored::{CourseFilter, StoredSamples};
use durer_scene::math::{Color, Vec2, Vec3};

#[cfg(test)]
mod tests;

/// Picture of sample positions or filter weights, as the 2004 course draws them; row 0 at the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Colours from 0 to 1; a byte of the file is trunc(255 c).
    pub pixels: Vec<Color>,
}

impl Diagram {
    fn new(width: u32, height: u32, color: impl Fn(u32, u32) -> Color) -> Self {
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Diagram { width, height, pixels: rows.map(|(x, y)| color(x, y)).collect() }
    }
}

/// Draws each sample as a dot of its colour. The background is a checkerboard of black and dark
/// grey pixels; the bottom left pixel is grey.
///
/// This is the course's `-render_samples`. The diagram has `width * zoom` columns. A `zoom` of 0 is
/// treated as 1; the caller must limit the size.
pub fn samples(samples: &StoredSamples, zoom: u32) -> Diagram {
    let zoom = zoom.max(1);
    let (width, height) = samples.size();
    let mut diagram = Diagram::new(width * zoom, height * zoom, |x, y| {
        let from_bottom = height - 1 - y / zoom;
        if (x / zoom + from_bottom).is_multiple_of(2) { Vec3::splat(0.2) } else { Vec3::ZERO }
    });
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        for sample in samples.pixel(x, y) {
            // The course counts rows upwards, so a dot between two rows belongs to the upper one.
            let across = (sample.position.x * zoom as f32) as u32;
            let up = ((1.0 - sample.position.y) * zoom as f32) as u32;
            let (column, row) = (x * zoom + across.min(zoom - 1), y * zoom + (zoom - 1 - up.min(zoom - 1)));
            let place = row as usize * diagram.width as usize + column as usize;
            diagram.pixels[place] = sample.color.clamp(Vec3::ZERO, Vec3::ONE);
        }
    }
    diagram
}

/// Draws a filter's weights in grey over its support around the middle pixel. Other pixels are dark
/// blue, and blue lines separate the pixels.
///
/// This is the course's `-render_filter`. The diagram has `width * zoom + 1` columns. A `zoom` of 0
/// is treated as 1; the caller must limit the size.
pub fn filter(width: u32, height: u32, zoom: u32, filter: CourseFilter) -> Diagram {
    weights(width, height, zoom, filter.support(), |offset| filter.weight(offset))
}

/// Draws a function of the offset from the middle pixel (right and down, in pixels) with a maximum
/// of 1, like [`filter`].
pub fn weights(width: u32, height: u32, zoom: u32, support: u32, weight: impl Fn(Vec2) -> f32) -> Diagram {
    let zoom = zoom.max(1);
    // Middle pixel, counted from the left and from the bottom.
    let (middle_x, middle_y) = (width / 2, height / 2);
    // Twice the offset in diagram pixels is an integer, so only the division rounds.
    let offset = |at: u32, middle: u32| {
        let doubled = 2 * i64::from(at) - i64::from(zoom) * (2 * i64::from(middle) + 1);
        doubled as f32 / (2 * zoom) as f32
    };
    Diagram::new(width * zoom + 1, height * zoom + 1, |x, y| {
        let up = height * zoom - y;
        if x.is_multiple_of(zoom) || up.is_multiple_of(zoom) {
            return Vec3::Z;
        }
        if (x / zoom).abs_diff(middle_x) > support || (up / zoom).abs_diff(middle_y) > support {
            return Vec3::new(0.0, 0.0, 0.5);
        }
        let offset = Vec2::new(offset(x, middle_x), -offset(up, middle_y));
        Vec3::splat(weight(offset).clamp(0.0, 1.0))
    })
}
