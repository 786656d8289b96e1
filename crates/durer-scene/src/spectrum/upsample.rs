//! Spectral upsampling, which finds smooth spectra for colours.
//!
//! Source: Jakob and Hanika, *A Low-Dimensional Function Space for Efficient Spectral Upsampling*,
//! Computer Graphics Forum 38(2), 2019. Each spectrum is a sigmoid of a quadratic function of the
//! wavelength. Its three coefficients are fitted on a grid of colours and interpolated between grid
//! points.

#[cfg(test)]
use super::integral;
use super::tables::{FIRST, LAST};
use super::{OBSERVER, Spectrum};
use crate::math::Color;
use std::sync::LazyLock;

/// Smooth spectrum with values in [0, 1], given by the three coefficients of a sigmoid.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SigmoidSpectrum([f32; 3]);

impl SigmoidSpectrum {
    /// Values of the spectrum at four wavelengths in nanometres.
    fn at(&self, nm: Spectrum) -> Spectrum {
        let [a, b, c] = self.0;
        let place = (nm - FIRST) / (LAST - FIRST);
        let x = (a * place + b) * place + c;
        // Compute 0.5 + x / (2 sqrt(1 + x^2)) without cancellation for large negative x.
        x.map(|x| {
            let root = (1.0 + x * x).sqrt();
            if x < 0.0 { 0.5 / (root * (root - x)) } else { 0.5 + 0.5 * x / root }
        })
    }
}

/// Number of grid points along the axes of the two smaller channels.
const SIDE: usize = 24;

/// Number of grid points along the axis of the largest channel.
const STRENGTHS: usize = 10;

/// Table of coefficients for spectral upsampling. Its indices are the largest channel of a colour,
/// the value of that channel, and the ratios of the other two channels to it.
struct Table(Vec<[f32; 3]>);

static TABLE: LazyLock<Table> = LazyLock::new(Table::new);

/// Reflectance spectrum of a colour in [0, 1]. A colour darker than 0.5 uses the scaled spectrum of
/// a brighter colour with the same hue.
pub(super) fn reflectance(color: Color, nm: Spectrum) -> Spectrum {
    let scale = (2.0 * color.max_element()).clamp(1e-12, 1.0);
    scale * TABLE.lookup(color / scale).at(nm)
}

/// Returns grid value `k`, from 0.5 to 1. Grid values are denser near white, where the coefficients
/// change most.
fn strength(k: usize) -> f64 {
    let rest = 1.0 - k as f64 / (STRENGTHS - 1) as f64;
    1.0 - 0.5 * rest * rest
}

/// Largest channel value that is fitted. At 1, the coefficients would be unbounded.
const NEARLY_WHITE: f64 = 1.0 - 1e-4;

impl Table {
    fn new() -> Self {
        let fit = Fit::new();
        let mut all = vec![[0.0; 3]; 3 * STRENGTHS * SIDE * SIDE];
        for greatest in 0..3 {
            for (j, i) in (0..SIDE * SIDE).map(|n| (n / SIDE, n % SIDE)) {
                // Place more grid points near pure colours.
                let share = |n: usize| {
                    let step = n as f64 / (SIDE - 1) as f64;
                    step * step
                };
                // Start each fit from the result for the neighbouring grid point.
                let mut numbers = [0.0; 3];
                for k in 0..STRENGTHS {
                    let most = strength(k).min(NEARLY_WHITE);
                    let mut color = [most; 3];
                    color[(greatest + 1) % 3] = most * share(i);
                    color[(greatest + 2) % 3] = most * share(j);
                    numbers = fit.fit(color, numbers);
                    all[Self::place(greatest, k, j, i)] = numbers.map(|x| x as f32);
                }
            }
        }
        Table(all)
    }

    fn place(greatest: usize, k: usize, j: usize, i: usize) -> usize {
        ((greatest * STRENGTHS + k) * SIDE + j) * SIDE + i
    }

    fn lookup(&self, color: Color) -> SigmoidSpectrum {
        let [r, g, b] = color.to_array();
        let greatest = if r >= g && r >= b {
            0
        } else if g >= b {
            1
        } else {
            2
        };
        let most = color[greatest].max(1e-12);
        let last = (SIDE - 1) as f32;
        let share = |n: usize| (color[(greatest + n) % 3] / most).clamp(0.0, 1.0).sqrt() * last;
        let k = (0..STRENGTHS - 1).rev().find(|&k| strength(k) <= f64::from(most)).unwrap_or(0);
        let (low, high) = (strength(k) as f32, strength(k + 1) as f32);
        let (x, y) = (share(1), share(2));
        let (i, j) = ((x as usize).min(SIDE - 2), (y as usize).min(SIDE - 2));
        // Interpolate linearly in the ratio itself, not in its square root.
        let part = |x: f32, i: usize| {
            let i = i as f32;
            ((x * x - i * i) / (2.0 * i + 1.0)).clamp(0.0, 1.0)
        };
        let parts = [part(x, i), part(y, j), ((most - low) / (high - low)).clamp(0.0, 1.0)];
        let mut sum = [0.0; 3];
        for corner in 0..8 {
            let [a, b, c] = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight: f32 =
                [a, b, c].iter().zip(parts).map(|(&up, part)| if up == 1 { part } else { 1.0 - part }).product();
            let numbers = self.0[Self::place(greatest, k + c, j + b, i + a)];
            (0..3).for_each(|n| sum[n] += weight * numbers[n]);
        }
        SigmoidSpectrum(sum)
    }
}

/// Forward model for fitting a smooth spectrum to a colour. It computes the spectrum's colour under
/// daylight.
struct Fit {
    /// Normalized wavelengths in [0, 1], with their weights for red, green and blue.
    rows: Vec<(f64, [f64; 3])>,
}

impl Fit {
    fn new() -> Self {
        let steps = ((LAST - FIRST) / 2.5) as usize;
        // Use Simpson's rule over pairs of steps.
        let rows = (0..=steps).map(|n| {
            let nm = FIRST + 2.5 * n as f32;
            let weight = if n == 0 || n == steps {
                1.0
            } else if n % 2 == 1 {
                4.0
            } else {
                2.0
            } * 2.5
                / 3.0;
            let [x, y, z, light] = super::observer_and_daylight(nm).map(f64::from);
            let scale = weight * light * f64::from(OBSERVER.daylight);
            let rgb = OBSERVER.to_rgb.map(|m| {
                let [a, b, c] = m.map(f64::from);
                scale * (a * x + b * y + c * z)
            });
            (f64::from((nm - FIRST) / (LAST - FIRST)), rgb)
        });
        Fit { rows: rows.collect() }
    }

    /// Returns the colour of a spectrum, and its derivatives with respect to the three
    /// coefficients.
    fn color(&self, [a, b, c]: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let (mut color, mut change) = ([0.0; 3], [[0.0; 3]; 3]);
        for &(place, rgb) in &self.rows {
            let x = (a * place + b) * place + c;
            let root = (1.0 + x * x).sqrt();
            let value = 0.5 + 0.5 * x / root;
            let slope = 0.5 / (root * root * root);
            for channel in 0..3 {
                color[channel] += value * rgb[channel];
                let slope = slope * rgb[channel];
                for (number, by) in [place * place, place, 1.0].into_iter().enumerate() {
                    change[channel][number] += slope * by;
                }
            }
        }
        (color, change)
    }

    /// Fits the three coefficients of a colour by the Levenberg-Marquardt method, starting from
    /// `start`.
    fn fit(&self, wanted: [f64; 3], start: [f64; 3]) -> [f64; 3] {
        let mut numbers = start;
        let (mut color, mut change) = self.color(numbers);
        let error = |color: [f64; 3]| (0..3).map(|n| (color[n] - wanted[n]) * (color[n] - wanted[n])).sum::<f64>();
        let mut damping = 1e-6;
        for _ in 0..40 {
            let off = error(color);
            if off < 1e-14 || damping > 1e3 {
                break;
            }
            let (mut normal, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
            for row in 0..3 {
                for column in 0..3 {
                    normal[row][column] = (0..3).map(|n| change[n][row] * change[n][column]).sum();
                }
                normal[row][row] += damping * (normal[row][row] + 1e-9);
                right[row] = (0..3).map(|n| change[n][row] * (wanted[n] - color[n])).sum();
            }
            let step = glam::DMat3::from_cols_array_2d(&normal).inverse() * glam::DVec3::from_array(right);
            let next: [f64; 3] = std::array::from_fn(|n| (numbers[n] + step[n]).clamp(-400.0, 400.0));
            let (next_color, next_change) = self.color(next);
            match step.is_finite() && error(next_color) < off {
                true => {
                    (numbers, color, change) = (next, next_color, next_change);
                    damping = (damping * 0.1).max(1e-12);
                }
                false => damping *= 10.0,
            }
        }
        numbers
    }
}

/// Colour of an upsampled reflectance under daylight.
#[cfg(test)]
pub(super) fn color_of(color: Color) -> Color {
    let weight = f64::from(OBSERVER.daylight);
    Color::from_array(OBSERVER.to_rgb.map(|m| {
        integral(|nm, [x, y, z, light]| {
            let [a, b, c] = m.map(f64::from);
            weight * f64::from(reflectance(color, Spectrum::splat(nm)).x) * (a * x + b * y + c * z) * light
        }) as f32
    }))
}
