//! Film for assignment 5 of the Fall 2012 course. It takes three by three jittered samples per
//! pixel, blurs them and averages them.

use durer_scene::math::{Color, Vec2, Vec3};
use durer_scene::sampler::random_2d;

#[cfg(test)]
mod tests;

/// Returns a sample position for `-jitter`, in sub-pixels. There are three by three sub-pixels per
/// pixel. A uniform random number between -1/2 and 1/2 is added to each integer coordinate.
pub fn jittered_position(seed: u64, x: u32, y: u32) -> Vec2 {
    Vec2::new(x as f32, y as f32) + (random_2d(seed, x, y, 0, 0) - 0.5)
}

/// The five weights of `-filter`, for offsets from -2 to 2 sub-pixels. The sum of the published
/// weights is 1.0011, but the brightness of official pictures corresponds to a sum of 1.
const BLUR: [f32; 5] = [0.1201 / SUM, 0.2339 / SUM, 0.2931 / SUM, 0.2339 / SUM, 0.1201 / SUM];
const SUM: f32 = 1.0011;

/// Blurs a picture along its rows and then along its columns with five taps. Pixels at the border
/// are repeated beyond the edges.
///
/// This function panics if the number of pixels is not `width * height`.
pub fn blur(pixels: &[Color], width: u32, height: u32) -> Vec<Color> {
    let (w, h) = (width as usize, height as usize);
    assert_eq!(pixels.len(), w * h, "the size must be that of the pixels");
    // `at` is the position of the tap plus 2, before the position is clamped to the picture.
    let tap = |at: usize, length: usize| at.saturating_sub(2).min(length - 1);
    let along_rows = from_pixels(w, h, |x, y| (0..5).map(|k| BLUR[k] * pixels[y * w + tap(x + k, w)]).sum());
    from_pixels(w, h, |x, y| (0..5).map(|k| BLUR[k] * along_rows[tap(y + k, h) * w + x]).sum())
}

/// Averages blocks of three by three pixels. The width and height of the result are a third of
/// `width` and `height`, rounded down.
pub fn average_3x3(pixels: &[Color], width: u32, height: u32) -> Vec<Color> {
    let w = width as usize;
    assert_eq!(pixels.len(), w * height as usize, "the size must be that of the pixels");
    from_pixels(w / 3, height as usize / 3, |x, y| {
        (0..9).map(|i| pixels[(3 * y + i / 3) * w + 3 * x + i % 3]).sum::<Vec3>() / 9.0
    })
}

/// Applies `-jitter -filter` to a picture of sub-pixels, which is three times as wide and high as
/// the result.
pub fn blur_and_average(pixels: &[Color], width: u32, height: u32) -> Vec<Color> {
    average_3x3(&blur(pixels, width, height), width, height)
}

/// Creates a picture by computing each pixel from its column and row.
fn from_pixels(width: usize, height: usize, color: impl Fn(usize, usize) -> Color) -> Vec<Color> {
    (0..width * height).map(|i| color(i % width, i / width)).collect()
}
