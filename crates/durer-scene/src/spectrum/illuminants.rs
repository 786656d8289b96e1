//! Standard illuminants, selected by name.
//!
//! Sources: CIE 015:2018, *Colorimetry*: section 4.1 (A, D), table 6 (components of daylight),
//! table 10 (fluorescent illuminants).

use super::black_body::{C2, planck_ratio};
use super::curve::Curve;

/// Temperature of illuminant A, about 2855.5 K. CIE 015 gives this temperature as 2848 K, based on
/// a second radiation constant of 1.435e7 nm K.
const A_KELVIN: f32 = 2_848.0 * (C2 / 1.435e7);

/// Names of illuminants, for use in messages. A name such as `2700K` denotes a black body.
pub const NAMES: &str = "A, D50, D55, D65, D75, E, F2, F7, F11";

/// Returns the spectrum of an illuminant, scaled to luminance 1. The name is A (incandescent bulb),
/// D followed by a temperature (daylight), E (equal energy), F followed by a number (fluorescent),
/// or a black body from 1000K to 20000K.
pub fn illuminant(name: &str) -> Option<Curve> {
    let rows = match name {
        "A" => formula(|nm| planck_ratio(nm, A_KELVIN)),
        "D50" => daylight(5_003.0),
        "D55" => daylight(5_503.0),
        "D65" => daylight(6_504.0),
        "D75" => daylight(7_504.0),
        "E" => formula(|_| 1.0),
        "F2" => tube(&F2),
        "F7" => tube(&F7),
        "F11" => tube(&F11),
        _ => {
            let kelvin: f32 = name.strip_suffix('K')?.parse().ok()?;
            if !(1_000.0..=20_000.0).contains(&kelvin) {
                return None;
            }
            formula(|nm| planck_ratio(nm, kelvin))
        }
    };
    Curve::light(rows)
}

fn formula(value: impl Fn(f32) -> f32) -> Vec<[f32; 2]> {
    (0..=94).map(|i| 360.0 + 5.0 * i as f32).map(|nm| [nm, value(nm)]).collect()
}

fn tube(values: &[f32; 81]) -> Vec<[f32; 2]> {
    values.iter().enumerate().map(|(i, value)| [380.0 + 5.0 * i as f32, *value]).collect()
}

/// Daylight spectrum for a correlated colour temperature from 4000 to 25000 K. It is the sum of a
/// mean spectrum and two components, which are weighted according to the chromaticity.
fn daylight(kelvin: f32) -> Vec<[f32; 2]> {
    let t = 1_000.0 / f64::from(kelvin);
    let x = match kelvin <= 7_000.0 {
        true => 0.244_063 + t * (0.099_11 + t * (2.967_8 - t * 4.607_0)),
        false => 0.237_040 + t * (0.247_48 + t * (1.901_8 - t * 2.006_4)),
    };
    let y = -3.000 * x * x + 2.870 * x - 0.275;
    let all = 0.0241 + 0.2562 * x - 0.7341 * y;
    let first = (-1.3515 - 1.7703 * x + 5.9114 * y) / all;
    let second = (0.0300 - 31.4424 * x + 30.0717 * y) / all;
    let row = |(i, s): (usize, &[f32; 3])| {
        let [mean, one, two] = s.map(f64::from);
        [360.0 + 10.0 * i as f32, (mean + first * one + second * two) as f32]
    };
    PARTS_OF_DAYLIGHT.iter().enumerate().map(row).collect()
}

/// Mean spectrum and two components of daylight, every 10 nm starting at 360 nm.
#[rustfmt::skip]
const PARTS_OF_DAYLIGHT: [[f32; 3]; 48] = [
    [61.5, 38.0, 5.3], [68.8, 42.4, 6.1], [63.4, 38.5, 3.0], [65.8, 35.0, 1.2],
    [94.8, 43.4, -1.1], [104.8, 46.3, -0.5], [105.9, 43.9, -0.7], [96.8, 37.1, -1.2],
    [113.9, 36.7, -2.6], [125.6, 35.9, -2.9], [125.5, 32.6, -2.8], [121.3, 27.9, -2.6],
    [121.3, 24.3, -2.6], [113.5, 20.1, -1.8], [113.1, 16.2, -1.5], [110.8, 13.2, -1.3],
    [106.5, 8.6, -1.2], [108.8, 6.1, -1.0], [105.3, 4.2, -0.5], [104.4, 1.9, -0.3],
    [100.0, -0.0, 0.0], [96.0, -1.6, 0.2], [95.1, -3.5, 0.5], [89.1, -3.5, 2.1],
    [90.5, -5.8, 3.2], [90.3, -7.2, 4.1], [88.4, -8.6, 4.7], [84.0, -9.5, 5.1],
    [85.1, -10.9, 6.7], [81.9, -10.7, 7.3], [82.6, -12.0, 8.6], [84.9, -14.0, 9.8],
    [81.3, -13.6, 10.2], [71.9, -12.0, 8.3], [74.3, -13.3, 9.6], [76.4, -12.9, 8.5],
    [63.3, -10.6, 7.0], [71.7, -11.6, 7.6], [77.0, -12.2, 8.0], [65.2, -10.2, 6.7],
    [47.7, -7.8, 5.2], [68.6, -11.2, 7.4], [65.0, -10.4, 6.8], [66.0, -10.6, 7.0],
    [61.0, -9.7, 6.4], [53.3, -8.3, 5.5], [58.9, -9.3, 6.1], [61.9, -9.8, 6.5],
];

/// Spectrum of a cool white fluorescent tube, every 5 nm starting at 380 nm.
#[rustfmt::skip]
const F2: [f32; 81] = [
    1.18, 1.48, 1.84, 2.15, 3.44, 15.69, 3.85, 3.74, 4.19, 4.62, 5.06, 34.98,
    11.81, 6.27, 6.63, 6.93, 7.19, 7.4, 7.54, 7.62, 7.65, 7.62, 7.62, 7.45,
    7.28, 7.15, 7.05, 7.04, 7.16, 7.47, 8.04, 8.88, 10.01, 24.88, 16.64, 14.59,
    16.16, 17.56, 18.62, 21.47, 22.79, 19.29, 18.66, 17.73, 16.54, 15.21, 13.8, 12.36,
    10.95, 9.65, 8.4, 7.32, 6.31, 5.43, 4.68, 4.02, 3.45, 2.96, 2.55, 2.19,
    1.89, 1.64, 1.53, 1.27, 1.1, 0.99, 0.88, 0.76, 0.68, 0.61, 0.56, 0.54,
    0.51, 0.47, 0.47, 0.43, 0.46, 0.47, 0.4, 0.33, 0.27,
];

/// Spectrum of a broad-band fluorescent tube similar to daylight, every 5 nm starting at 380 nm.
#[rustfmt::skip]
const F7: [f32; 81] = [
    2.56, 3.18, 3.84, 4.53, 6.15, 19.37, 7.37, 7.05, 7.71, 8.41, 9.15, 44.14,
    17.52, 11.35, 12.0, 12.58, 13.08, 13.45, 13.71, 13.88, 13.95, 13.93, 13.82, 13.64,
    13.43, 13.25, 13.08, 12.93, 12.78, 12.6, 12.44, 12.33, 12.26, 29.52, 17.05, 12.44,
    12.58, 12.72, 12.83, 15.46, 16.75, 12.83, 12.67, 12.45, 12.19, 11.89, 11.6, 11.35,
    11.12, 10.95, 10.76, 10.42, 10.11, 10.04, 10.02, 10.11, 9.87, 8.65, 7.27, 6.44,
    5.83, 5.41, 5.04, 4.57, 4.12, 3.77, 3.46, 3.08, 2.73, 2.47, 2.25, 2.06,
    1.9, 1.75, 1.62, 1.54, 1.45, 1.32, 1.17, 0.99, 0.81,
];

/// Spectrum of a fluorescent tube with three narrow bands, every 5 nm starting at 380 nm.
#[rustfmt::skip]
const F11: [f32; 81] = [
    0.91, 0.63, 0.46, 0.37, 1.29, 12.68, 1.59, 1.79, 2.46, 3.33, 4.49, 33.94,
    12.13, 6.95, 7.19, 7.12, 6.72, 6.13, 5.46, 4.79, 5.66, 14.29, 14.96, 8.97,
    4.72, 2.33, 1.47, 1.1, 0.89, 0.83, 1.18, 4.9, 39.59, 72.84, 32.61, 7.52,
    2.83, 1.96, 1.67, 4.43, 11.28, 14.76, 12.73, 9.74, 7.33, 9.72, 55.27, 42.58,
    13.18, 13.16, 12.26, 5.11, 2.07, 2.34, 3.58, 3.01, 2.48, 2.14, 1.54, 1.33,
    1.46, 1.94, 2.0, 1.2, 1.35, 4.1, 5.58, 2.51, 0.57, 0.27, 0.23, 0.21,
    0.24, 0.24, 0.2, 0.24, 0.32, 0.26, 0.16, 0.12, 0.09,
];
