//! Denoiser that is guided by the surface visible at each pixel.
//!
//! On a smooth surface, the irradiance, which is the light divided by the albedo, is also smooth.
//! The filter averages the irradiance over pixels with similar normals, positions, and albedos, and
//! it does so more strongly where the variance is higher. Denoised pictures are only estimates, and
//! they are biased.
//!
//! Source: Dammertz and others, *Edge-Avoiding À-Trous Wavelet Transform for fast Global
//! Illumination Filtering*, HPG 2010. The weights based on variance are the spatial half of Schied
//! and others, *Spatiotemporal Variance-Guided Filtering*, HPG 2017.

use super::Image;
use crate::{Color, LUMINANCE};
use durer_bvh::math::{Vec3, fp};
use rayon::prelude::*;

/// Auxiliary images that guide the denoiser: the albedo, normal, position, and variance of each
/// pixel, stored row by row.
#[derive(Clone, Copy, Debug)]
pub struct GuideImages<'a> {
    /// Albedo of the surface.
    pub albedo: &'a [Color],
    /// Unit normal of the surface, or zero where the camera ray hit nothing.
    pub normal: &'a [Vec3],
    /// Position of the surface point.
    pub position: &'a [Vec3],
    /// Estimated variance of the luminance of the pixel.
    pub variance: &'a [f32],
}

/// Number of filter passes. The step width doubles with each pass.
const ROUNDS: u32 = 5;

/// One row of the filter kernel, which is a cubic B-spline.
const KERNEL: [f32; 5] = [1.0 / 16.0, 0.25, 0.375, 0.25, 1.0 / 16.0];

/// Pixel during denoising, with its light divided by the albedo and the variance of its luminance.
#[derive(Clone, Copy)]
struct Pixel {
    light: Color,
    variance: f32,
}

fn luminance(color: Color) -> f32 {
    color.dot(LUMINANCE)
}

/// Denoises a picture. The result is the same, bit for bit, for any number of threads.
///
/// Returns `None` if the size of a guide image differs from the size of the picture.
pub fn denoise(picture: &Image, guides: &GuideImages) -> Option<Image> {
    let count = picture.pixels.len();
    let fits = |length: usize| length == count;
    if !(fits(guides.albedo.len())
        && fits(guides.normal.len())
        && fits(guides.position.len())
        && fits(guides.variance.len()))
    {
        return None;
    }
    // For surfaces without an albedo, such as mirrors and lights, filter the light itself.
    let albedo: Vec<Color> =
        guides.albedo.iter().map(|&a| if a.min_element() > 0.01 { a } else { Color::ONE }).collect();
    let mut pixels: Vec<Pixel> = (0..count)
        .map(|i| {
            let scale = luminance(albedo[i]);
            Pixel { light: picture.pixels[i] / albedo[i], variance: guides.variance[i].max(0.0) / (scale * scale) }
        })
        .collect();
    for round in 0..ROUNDS {
        let before = &pixels;
        pixels = (0..count).into_par_iter().map(|i| averaged(before, guides, picture.width, i, 1 << round)).collect();
    }
    let pixels = pixels.iter().zip(&albedo).map(|(pixel, &albedo)| pixel.light * albedo).collect();
    Some(Image { width: picture.width, height: picture.height, pixels })
}

fn averaged(pixels: &[Pixel], guides: &GuideImages, width: u32, i: usize, step: i64) -> Pixel {
    let (width, height) = (i64::from(width), pixels.len() as i64 / i64::from(width));
    let (x, y) = (i as i64 % width, i as i64 / width);
    let at = |x: i64, y: i64| ((0..width).contains(&x) && (0..height).contains(&y)).then_some((y * width + x) as usize);
    // The variances are noisy too, so average them over neighbouring pixels.
    let near = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
    let (sum, weights) = near
        .filter_map(|(dx, dy)| {
            Some((at(x + dx, y + dy)?, [0.5, 0.25][(dx != 0) as usize] * [0.5, 0.25][(dy != 0) as usize]))
        })
        .fold((0.0, 0.0), |(sum, all), (j, weight): (usize, f32)| (sum + weight * pixels[j].variance, all + weight));
    let deviation = (sum / weights).sqrt();
    let (normal, position, own) = (guides.normal[i], guides.position[i], luminance(pixels[i].light));
    let hit = normal != Vec3::ZERO;
    let (mut light, mut variance, mut all) = (Color::ZERO, 0.0, 0.0);
    for (row, dy) in KERNEL.iter().zip(-2..=2) {
        for (column, dx) in KERNEL.iter().zip(-2..=2) {
            let Some(j) = at(x + dx * step, y + dy * step) else { continue };
            if hit != (guides.normal[j] != Vec3::ZERO) {
                continue;
            }
            let mut weight = row * column;
            if hit {
                weight *= fp::pow(normal.dot(guides.normal[j]).max(0.0), 64.0);
                // Distance from the tangent plane, relative to the distance between the points.
                let way = guides.position[j] - position;
                let beside = way.dot(normal).abs() / way.length().max(1e-20);
                weight *= fp::exp(-8.0 * beside * beside);
            }
            let other = guides.albedo[j] - guides.albedo[i];
            weight *= fp::exp(-other.length_squared() / 0.02);
            let apart = (luminance(pixels[j].light) - own).abs();
            weight *= fp::exp(-apart / (4.0 * deviation + 1e-6));
            light += weight * pixels[j].light;
            variance += weight * weight * pixels[j].variance;
            all += weight;
        }
    }
    // The pixel itself always has a positive weight.
    Pixel { light: light / all, variance: variance / (all * all) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_bvh::internal::random::Random;

    /// Creates pictures of two walls that meet in the middle. One of the walls is checkered, and
    /// the light increases to the right. One picture has no noise, and the other has noise of a
    /// known variance.
    fn noisy(deviation: f32) -> (Image, Image, [Vec<Vec3>; 3], Vec<f32>) {
        let (width, height) = (48_u32, 32_u32);
        let mut random = Random(11);
        let (mut truth, mut noisy) = (Vec::new(), Vec::new());
        let mut guides: [Vec<Vec3>; 3] = Default::default();
        for i in 0..width * height {
            let (x, y) = ((i % width) as f32, (i / width) as f32);
            let left = x < 24.0;
            let albedo = if left && (x as u32 / 4 + y as u32 / 4).is_multiple_of(2) { 0.3 } else { 0.8 };
            let light = if left { 1.0 } else { 0.3 + 0.02 * x };
            truth.push(Color::splat(albedo * light));
            let off = (0..12).map(|_| random.between(0.0, 1.0)).sum::<f32>() - 6.0;
            noisy.push(Color::splat(albedo * light + deviation * off));
            guides[0].push(Color::splat(albedo));
            guides[1].push(if left { Vec3::Z } else { Vec3::X });
            guides[2].push(if left { Vec3::new(x, y, 0.0) } else { Vec3::new(24.0, y, 24.0 - x) });
        }
        let variance = vec![deviation * deviation; noisy.len()];
        (Image { width, height, pixels: truth }, Image { width, height, pixels: noisy }, guides, variance)
    }

    fn error(a: &Image, b: &Image) -> f32 {
        let squares = a.pixels.iter().zip(&b.pixels).map(|(a, b)| (a.x - b.x) * (a.x - b.x));
        (squares.sum::<f32>() / a.pixels.len() as f32).sqrt()
    }

    #[test]
    fn noise_goes_and_edges_stay() {
        let (truth, noisy, [albedo, normal, position], variance) = noisy(0.08);
        let guides = GuideImages { albedo: &albedo, normal: &normal, position: &position, variance: &variance };
        let clean = denoise(&noisy, &guides).unwrap();
        assert!(
            error(&clean, &truth) < 0.25 * error(&noisy, &truth),
            "{} {}",
            error(&clean, &truth),
            error(&noisy, &truth)
        );
        // Without noise, denoising changes hardly anything.
        let none = vec![0.0; variance.len()];
        let same = denoise(&truth, &GuideImages { variance: &none, ..guides }).unwrap();
        assert!(error(&same, &truth) < 1e-3, "{}", error(&same, &truth));
        assert!(denoise(&truth, &GuideImages { variance: &none[1..], ..guides }).is_none());
    }
}
