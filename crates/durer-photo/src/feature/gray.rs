//! Greyscale images.

use rayon::prelude::*;

/// Greyscale image with one `f32` value per pixel, used to detect features.
#[derive(Debug, Clone)]
pub struct GrayImage {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Pixel values, row by row from the top.
    pub values: Vec<f32>,
}

impl GrayImage {
    /// Returns the value of a pixel.
    pub fn at(&self, x: usize, y: usize) -> f32 {
        self.values[y * self.width + x]
    }

    /// Applies a Gaussian blur with standard deviation `sigma` in pixels. The pixels at the edge
    /// are repeated beyond the border.
    pub fn blurred(&self, sigma: f32) -> GrayImage {
        let radius = (4.0 * sigma).ceil() as usize;
        let weight = |i: usize| libm::expf(-((i * i) as f32) / (2.0 * sigma * sigma));
        let half: Vec<f32> = (0..=radius).map(weight).collect();
        let sum = 2.0 * half.iter().sum::<f32>() - half[0];
        let half: Vec<f32> = half.into_iter().map(|w| w / sum).collect();
        let (width, height) = (self.width, self.height);
        let mut across = vec![0.0; width * height];
        across.par_chunks_mut(width).zip(self.values.par_chunks(width)).for_each(|(to, from)| {
            let (first, last) = (from[0], from[width - 1]);
            let mut padded = vec![first; radius];
            padded.extend_from_slice(from);
            padded.resize(width + 2 * radius, last);
            to.iter_mut().zip(&padded[radius..]).for_each(|(to, p)| *to = half[0] * p);
            for (i, w) in half.iter().enumerate().skip(1) {
                let sides = padded[radius - i..].iter().zip(&padded[radius + i..]);
                to.iter_mut().zip(sides).for_each(|(to, (a, b))| *to += w * (a + b));
            }
        });
        let mut values = vec![0.0; width * height];
        let row = |y: isize| &across[y.clamp(0, height as isize - 1) as usize * width..][..width];
        values.par_chunks_mut(width).enumerate().for_each(|(y, to)| {
            let y = y as isize;
            to.iter_mut().zip(row(y)).for_each(|(to, p)| *to = half[0] * p);
            for (i, w) in half.iter().enumerate().skip(1) {
                let sides = row(y - i as isize).iter().zip(row(y + i as isize));
                to.iter_mut().zip(sides).for_each(|(to, (a, b))| *to += w * (a + b));
            }
        });
        GrayImage { width, height, values }
    }

    /// Doubles the size of the image, with linear interpolation between pixel centres.
    pub fn doubled(&self) -> GrayImage {
        let (width, height) = (2 * self.width, 2 * self.height);
        // The centre of pixel i is located at (i + 1/2) / 2 in the smaller image.
        let between = |i: usize, end: usize| {
            let near = i / 2;
            let far = if i.is_multiple_of(2) { near.saturating_sub(1) } else { (near + 1).min(end - 1) };
            (near, far)
        };
        let value = |x: usize, y: usize| {
            let ((x0, x1), (y0, y1)) = (between(x, self.width), between(y, self.height));
            let row = |y: usize| 0.75 * self.at(x0, y) + 0.25 * self.at(x1, y);
            0.75 * row(y0) + 0.25 * row(y1)
        };
        let values = (0..width * height).into_par_iter().map(|i| value(i % width, i / width)).collect();
        GrayImage { width, height, values }
    }

    /// Keeps every second pixel of every second row.
    pub fn halved(&self) -> GrayImage {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let values = (0..width * height).map(|i| self.at(2 * (i % width), 2 * (i / width))).collect();
        GrayImage { width, height, values }
    }

    /// Returns the pixel-wise difference between this image and another of the same size.
    pub fn difference(&self, other: &GrayImage) -> GrayImage {
        let values = self.values.iter().zip(&other.values).map(|(a, b)| a - b).collect();
        GrayImage { values, ..*self }
    }
}
