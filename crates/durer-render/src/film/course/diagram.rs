//! Diagrams of the 2004 course, which show sample positions within pixels or filter weights.
//!
//! Both diagrams enlarge each pixel to `zoom` times `zoom` pixels.

use super::stored::{CourseFilter, StoredSamples};
use durer_scene::math::{Color, Vec2, Vec3};

#[cfg(test)]
mod tests;

/// Diagram of sample positions or filter weights in the style of the 2004 course. Row 0 is at the
/// top.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Colours with components from 0 to 1. A byte of the image file is trunc(255 c).
    pub pixels: Vec<Color>,
}

impl Diagram {
    fn new(width: u32, height: u32, color: impl Fn(u32, u32) -> Color) -> Self {
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Diagram { width, height, pixels: rows.map(|(x, y)| color(x, y)).collect() }
    }
}

/// Draws each sample as a dot in the colour of the sample. The background is a checkerboard of
/// black and dark grey pixels, and the pixel at the bottom left is grey.
///
/// This diagram corresponds to the course's option `-render_samples`. It has `width * zoom`
/// columns. A `zoom` of 0 is treated as 1, and the caller must limit the size.
pub fn samples(samples: &StoredSamples, zoom: u32) -> Diagram {
    let zoom = zoom.max(1);
    let (width, height) = samples.size();
    let mut diagram = Diagram::new(width * zoom, height * zoom, |x, y| {
        let from_bottom = height - 1 - y / zoom;
        if (x / zoom + from_bottom).is_multiple_of(2) { Vec3::splat(0.2) } else { Vec3::ZERO }
    });
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        for sample in samples.pixel(x, y) {
            // The course counts rows from the bottom, so a dot on the border of two rows belongs to
            // the upper row.
            let across = (sample.position.x * zoom as f32) as u32;
            let up = ((1.0 - sample.position.y) * zoom as f32) as u32;
            let (column, row) = (x * zoom + across.min(zoom - 1), y * zoom + (zoom - 1 - up.min(zoom - 1)));
            let place = row as usize * diagram.width as usize + column as usize;
            diagram.pixels[place] = sample.color.clamp(Vec3::ZERO, Vec3::ONE);
        }
    }
    diagram
}

/// Draws the weights of a filter in grey over its support around the middle pixel. All other pixels
/// are dark blue, and blue lines separate the pixels.
///
/// This diagram corresponds to the course's option `-render_filter`. It has `width * zoom + 1`
/// columns. A `zoom` of 0 is treated as 1, and the caller must limit the size.
pub fn filter(width: u32, height: u32, zoom: u32, filter: CourseFilter) -> Diagram {
    weights(width, height, zoom, filter.support(), |offset| filter.weight(offset))
}

/// Draws a weight function in the style of [`filter`]. The function has a maximum of 1, and its
/// argument is the offset from the middle pixel, in pixels to the right and down.
pub fn weights(width: u32, height: u32, zoom: u32, support: u32, weight: impl Fn(Vec2) -> f32) -> Diagram {
    let zoom = zoom.max(1);
    // The middle pixel, counted from the left and from the bottom.
    let (middle_x, middle_y) = (width / 2, height / 2);
    // Twice the offset is an integer number of diagram pixels, so only the division rounds.
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
