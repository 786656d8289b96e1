//! Conversion of linear colours to the 8-bit pixels that a web page shows.

use durer::image::{Display, Layer, Tone, Transfer};

/// Returns the display transform for an exposure in stops and a tone curve. They have the same
/// meaning as the options `--exposure` and `--tone`.
pub(crate) fn display(stops: f32, tone: &str) -> Display {
    let tone = Tone::from_name(tone).unwrap_or_default();
    Display { exposure: durer::math::fp::pow(2.0, stops), tone, ..Transfer::Srgb.into() }
}

/// Returns four bytes for each pixel: red, green, blue and coverage.
pub(crate) fn pixels(layer: &Layer, display: &Display) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(4 * layer.image.pixels.len());
    let alpha = |i: usize| layer.coverage.as_ref().map_or(255, |coverage| (255.0 * coverage[i] + 0.5) as u8);
    for (i, color) in layer.image.pixels.iter().enumerate() {
        let [r, g, b] = display.encode_pixel(*color);
        bytes.extend([r, g, b, alpha(i)]);
    }
    bytes
}
