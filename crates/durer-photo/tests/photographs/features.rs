//! Tests for feature detection. They check that keypoints are found at the right positions, and
//! that they rotate and scale with the image.

use durer_photo::feature::{GrayImage, features};

/// Returns an image of a Gaussian blob. The position of its centre is given in pixels from the
/// upper left corner.
fn blob(side: usize, x: f32, y: f32, sigma: f32) -> GrayImage {
    let value = |i: usize| {
        let (dx, dy) = ((i % side) as f32 + 0.5 - x, (i / side) as f32 + 0.5 - y);
        0.2 + 0.6 * libm::expf(-(dx * dx + dy * dy) / (2.0 * sigma * sigma))
    };
    GrayImage { width: side, height: side, values: (0..side * side).map(value).collect() }
}

#[test]
fn blobs_are_found_at_their_positions() {
    // Images of up to 1000 pixels are doubled first, but larger images are not. The blobs cover all
    // octaves.
    for (side, x, y, sigma) in [
        (100, 50.3, 47.8, 2.0),
        (90, 40.4, 44.1, 1.3),
        (120, 60.0, 60.5, 5.0),
        (200, 101.2, 90.9, 11.0),
        (1010, 500.25, 333.6, 4.0),
        (1010, 700.7, 401.1, 14.0),
    ] {
        let found = features(&blob(side, x, y, sigma), 100);
        let best =
            found.iter().min_by(|a, b| (a.0.scale - sigma).abs().total_cmp(&(b.0.scale - sigma).abs())).unwrap().0;
        println!("{side} {x} {y} {sigma}: {best:?}");
        assert!((best.x - x).abs() < 0.05 && (best.y - y).abs() < 0.05, "{x} {y} {sigma}: {best:?}");
        assert!((best.scale / sigma - 1.0).abs() < 0.25, "{sigma}: {best:?}");
    }
}
