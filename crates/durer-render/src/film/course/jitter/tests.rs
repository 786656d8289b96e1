use super::*;

#[test]
fn the_blur_spreads_a_point_by_its_taps() {
    let (w, h) = (9, 12);
    let mut point = vec![Vec3::ZERO; (w * h) as usize];
    point[(4 * w + 4) as usize] = Vec3::ONE;
    let blurred = blur(&point, w, h);
    for (x, y) in (0..w * h).map(|i| (i % w, i / w)) {
        let tap = |at: u32| if (2..=6).contains(&at) { BLUR[at as usize - 2] } else { 0.0 };
        assert!((blurred[(y * w + x) as usize].x - tap(x) * tap(y)).abs() < 1e-7);
    }
    // At a corner, taps outside the picture use the pixel at the corner.
    point.fill(Vec3::ZERO);
    point[0] = Vec3::ONE;
    let edge = BLUR[0] + BLUR[1] + BLUR[2];
    assert!((blur(&point, w, h)[0].x - edge * edge).abs() < 1e-6);
    assert_eq!(blur(&[Vec3::ONE], 1, 1).len(), 1);
    assert!(blur_and_average(&[], 0, 0).is_empty());
}

#[test]
fn nine_pixels_become_their_mean() {
    let pixels: Vec<Vec3> = (0..54).map(|i| Vec3::splat((i % 9) as f32)).collect();
    let small = average_3x3(&pixels, 9, 6);
    assert_eq!(small, [1.0, 4.0, 7.0, 1.0, 4.0, 7.0].map(Vec3::splat));
}

#[test]
fn jitter_stays_within_half_a_sub_pixel() {
    let offsets = (0..1000).map(|x| jittered_position(1, x, 2 * x) - Vec2::new(x as f32, 2.0 * x as f32));
    assert!(offsets.clone().all(|d| d.abs().max_element() <= 0.5));
    assert!((offsets.sum::<Vec2>() / 1000.0).length() < 0.05);
}
