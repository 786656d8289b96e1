//! Heat maps that show errors as colours.

use crate::Image8;

/// Colours for errors at equal steps from 0 to 1. Their lightness increases, so that the map can
/// also be read in greyscale.
const RAMP: [[f32; 3]; 6] = [
    [0.0, 0.0, 8.0],
    [64.0, 10.0, 110.0],
    [165.0, 30.0, 100.0],
    [235.0, 85.0, 40.0],
    [252.0, 180.0, 40.0],
    [255.0, 255.0, 210.0],
];

/// Heat map of errors from 0 (black) to 1 (light yellow), stored row by row.
pub fn heat_map(width: u32, height: u32, errors: &[f32]) -> Image8 {
    Image8 { width, height, pixels: errors.iter().map(|&error| heat(error)).collect(), alpha: Vec::new() }
}

fn heat(error: f32) -> [u8; 3] {
    // NaN is treated as zero.
    let error = if error > 0.0 { error.min(1.0) } else { 0.0 };
    let place = error * (RAMP.len() - 1) as f32;
    let below = (place as usize).min(RAMP.len() - 2);
    let part = place - below as f32;
    std::array::from_fn(|c| (RAMP[below][c] + part * (RAMP[below + 1][c] - RAMP[below][c])).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_is_lighter() {
        let errors: Vec<f32> = (0..=100).map(|i| i as f32 / 100.0).collect();
        let map = heat_map(101, 1, &errors);
        let light = |p: &[u8; 3]| 2126 * u32::from(p[0]) + 7152 * u32::from(p[1]) + 722 * u32::from(p[2]);
        assert!(map.pixels.is_sorted_by(|a, b| light(a) < light(b)));
        assert_eq!((heat(-1.0), heat(f32::NAN), heat(7.0)), ([0, 0, 8], [0, 0, 8], [255, 255, 210]));
    }
}
