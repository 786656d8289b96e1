//! Tests of the measures, which compare them with closed forms and with other programs on
//! procedural pictures.

use super::*;
use crate::Image;
use durer_bvh::math::Vec3;

fn picture(width: u32, height: u32, scale: Scale, pixel: impl Fn(u32, u32) -> Vec3) -> Picture {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
    Picture { image: Image::from_pixels(width, height, pixels).unwrap(), scale }
}

/// Creates two procedural pictures: a gradient that is displaced in red, and a checkerboard that is
/// displaced in blue.
fn patterns() -> [Picture; 2] {
    let pattern = |gradient: u32, shift: u32| {
        picture(64, 48, Scale::Display, move |x, y| {
            let blue = (x / 8 + (y + shift) / 8) % 2 * 200 + 20;
            let bytes = [(x * 5 + y * 3 + gradient) % 256, (x * x + y * 7) % 256, blue];
            Vec3::from(bytes.map(|value| value as f32)) / 255.0
        })
    };
    [pattern(0, 0), pattern(9, 1)]
}

fn light(picture: &Picture) -> Picture {
    let pixels = picture.image.pixels.iter().map(|&pixel| pixel * pixel * 20.0).collect();
    Picture { image: Image { pixels, ..picture.image.clone() }, scale: Scale::Linear }
}

/// Creates a grey picture with values from 2^-8 to 2^8, and a copy in which every fourth row is 1.5
/// times as bright.
fn wide_range() -> [Picture; 2] {
    [1.0, 1.5].map(|factor| {
        picture(64, 48, Scale::Linear, move |x, y| {
            let grey = durer_bvh::math::fp::pow(2.0, (x as f32 - 32.0) / 4.0);
            Vec3::new(1.0, 0.5, 0.25) * grey * if y % 4 == 0 { factor } else { 1.0 }
        })
    })
}

#[track_caller]
fn near(value: f64, wanted: f64, within: f64) {
    assert!((value - wanted).abs() < within, "{value} is not {wanted}");
}

/// The expected values were computed for the same pictures with `flip_evaluator` 1.7, the package
/// of FLIP's authors.
#[test]
fn flip_is_that_of_its_authors() {
    let [a, b] = patterns();
    let found = compare(&a, &b, &Options::default()).unwrap();
    near(found.measures.flip, 0.223_555_8, 2e-5);
    for ((x, y), error) in
        [((0, 0), 0.049_283_65), ((30, 20), 0.176_454_95), ((63, 47), 0.889_616_8), ((8, 47), 0.352_648_97)]
    {
        near(found.flip_map[y * 64 + x].into(), error, 1e-4);
    }
    assert_eq!(found.measures.hdr_flip, None);

    let found = compare(&light(&a), &light(&b), &Options::default()).unwrap();
    near(found.measures.hdr_flip.unwrap(), 0.262_547_64, 2e-5);
    near(found.flip_map[0].into(), 0.080_149_23, 1e-4);
    let [a, b] = wide_range();
    near(compare(&a, &b, &Options::default()).unwrap().measures.hdr_flip.unwrap(), 0.158_005_94, 2e-5);
}

/// The expected value comes from scikit-image 0.26: `structural_similarity` with
/// `gaussian_weights=True, sigma=1.5, use_sample_covariance=False`.
#[test]
fn ssim_is_that_of_others() {
    let [a, b] = patterns();
    near(compare(&a, &b, &Options::default()).unwrap().measures.ssim.unwrap(), 0.949_948_12, 1e-5);
}

fn grey(width: u32, height: u32, value: f32) -> Picture {
    picture(width, height, Scale::Display, |_, _| Vec3::splat(value))
}

/// For uniform pictures, the measures have closed forms.
#[test]
fn constant_pictures() {
    let found = compare(&grey(20, 13, 0.4), &grey(20, 13, 0.5), &Options::default()).unwrap();
    near(found.measures.rmse, 0.1, 1e-6);
    near(found.measures.psnr, 20.0, 1e-4);
    near(found.measures.ssim.unwrap(), (2.0 * 0.4 * 0.5 + 1e-4) / (0.16 + 0.25 + 1e-4), 1e-5);
    assert_eq!(found.measures.over_tolerance, 20 * 13);
    let found = compare(&grey(20, 13, 0.0), &grey(20, 13, 1.0), &Options::default()).unwrap();
    // Black and white differ in lightness by 100, and green and blue are 203.3 apart according to
    // equations 6 and 7 of the paper of 2020. The two values are 100^0.7 and 203.3^0.7.
    let (distance, largest) = (25.119, 41.27);
    let color = 0.95 + (distance - 0.4 * largest) / (0.6 * largest) * 0.05;
    near(found.measures.flip, color, 1e-3);
    near(found.measures.psnr, 0.0, 1e-6);
    // SSIM is not defined for a picture that is smaller than the window.
    assert_eq!(compare(&grey(10, 30, 0.0), &grey(10, 30, 1.0), &Options::default()).unwrap().measures.ssim, None);
}

#[test]
fn equal_pictures_are_identical() {
    let [a, _] = patterns();
    for picture in [a.clone(), light(&a), grey(1, 1, 0.3)] {
        let found = compare(&picture, &picture, &Options::default()).unwrap();
        let m = found.measures;
        assert_eq!((found.verdict, m.rmse, m.psnr, m.flip), (Verdict::Identical, 0.0, f64::INFINITY, 0.0));
        assert!(m.largest.is_none() && found.findings.is_empty() && found.regions.is_empty());
        assert!(m.ssim.is_none_or(|ssim| ssim == 1.0));
    }
}

#[test]
fn tolerance_and_share() {
    let a = grey(20, 20, 100.0 / 255.0);
    let mut b = a.clone();
    b.image.pixels[45] = Vec3::splat(102.0 / 255.0);
    let verdict = |tolerance: f32, allowed: f64| {
        compare(&a, &b, &Options { tolerance, allowed_share: allowed, ..Options::default() }).unwrap().verdict
    };
    assert_eq!(verdict(1.0 / 255.0, 0.0), Verdict::Different);
    assert_eq!(verdict(2.0 / 255.0, 0.0), Verdict::Same);
    assert_eq!(verdict(1.0 / 255.0, 1.0 / 400.0), Verdict::Same);
    assert_eq!(verdict(1.0 / 255.0, 0.9 / 400.0), Verdict::Different);
    let largest = compare(&a, &b, &Options::default()).unwrap().measures.largest.unwrap();
    assert_eq!((largest.x, largest.y), (5, 2));
    near(largest.difference.into(), 2.0 / 255.0, 1e-6);
}

#[test]
fn what_is_not_finite_counts() {
    let a = Picture { scale: Scale::Linear, ..grey(20, 20, 0.5) };
    let mut b = a.clone();
    b.image.pixels[21] = Vec3::new(f32::NAN, 0.5, 0.5);
    let found = compare(&a, &b, &Options::default()).unwrap();
    assert_eq!((found.verdict, found.measures.over_tolerance), (Verdict::Different, 1));
    assert_eq!((found.measures.not_finite, found.measures.first_not_finite), ([0, 1], Some((1, 1))));
    assert!(found.measures.rmse.is_finite() && found.measures.flip.is_finite());
    assert_eq!(compare(&b, &b, &Options::default()).unwrap().verdict, Verdict::Identical);
}

#[test]
fn light_is_compared_with_bytes_as_bytes() {
    let bytes = picture(16, 16, Scale::Display, |x, y| Vec3::splat((x * 16 + y) as f32 / 255.0));
    let pixels = bytes.image.pixels.iter().map(|&pixel| Scale::Display.decode(pixel)).collect();
    let light = Picture { image: Image { pixels, ..bytes.image.clone() }, scale: Scale::Linear };
    let found = compare(&bytes, &light, &Options::default()).unwrap();
    assert_eq!((found.verdict, found.scale), (Verdict::Identical, Scale::Display));
    let linear = Options { transfer: Transfer::Linear, ..Options::default() };
    assert_eq!(compare(&bytes, &light, &linear).unwrap().findings[0].kind, "gamma-once-less");
}

#[test]
fn sizes_that_differ_are_an_error() {
    let error = compare(&grey(3, 4, 0.0), &grey(4, 3, 0.0), &Options::default()).unwrap_err().to_string();
    assert!(error.contains("3 x 4 and 4 x 3") && error.contains("swapped"), "{error}");
}

/// Two differing patches give two regions with the right properties.
#[test]
fn regions_are_found() {
    let a = grey(200, 100, 0.5);
    let mut b = a.clone();
    let mut paint = |x: std::ops::Range<usize>, y: std::ops::Range<usize>, value: Vec3| {
        y.for_each(|y| x.clone().for_each(|x| b.image.pixels[y * 200 + x] = value));
    };
    paint(10..30, 20..25, Vec3::new(0.5, 0.5, 0.7));
    paint(150..160, 80..100, Vec3::ZERO);
    let regions = compare(&a, &b, &Options::default()).unwrap().regions;
    let places: Vec<_> = regions.iter().map(|r| (r.x, r.y, r.width, r.height, r.pixels)).collect();
    assert_eq!(places, [(150, 80, 10, 20, 200), (10, 20, 20, 5, 100)]);
    assert!((regions[1].mean_difference - Vec3::new(0.0, 0.0, 0.2)).length() < 1e-6);
    assert_eq!(regions[0].worst, (150, 80));
    near(regions[0].share + regions[1].share, 1.0, 1e-9);
    near(regions[0].share, 150.0 / 154.0, 1e-6);
}

/// Filtering in bands of rows does not change the result: a picture that is taller than one band
/// gives the same measures as its transpose.
#[test]
fn rows_and_columns_are_filtered_alike() {
    let tall = |change: f32| {
        picture(23, 150, Scale::Display, move |x, y| Vec3::splat(((x * 31 + y * y) % 101) as f32 / 101.0 * change))
    };
    let wide = |change: f32| {
        picture(150, 23, Scale::Display, move |y, x| Vec3::splat(((x * 31 + y * y) % 101) as f32 / 101.0 * change))
    };
    let a = compare(&tall(1.0), &tall(0.8), &Options::default()).unwrap();
    let b = compare(&wide(1.0), &wide(0.8), &Options::default()).unwrap();
    near(a.measures.flip, b.measures.flip, 1e-6);
    near(a.measures.ssim.unwrap(), b.measures.ssim.unwrap(), 1e-6);
    for (x, y) in [(0, 0), (22, 149), (7, 63), (7, 64), (11, 80)] {
        near(a.flip_map[y * 23 + x].into(), b.flip_map[x * 150 + y].into(), 1e-4);
    }
}
