//! Conversion between linear floating-point values and 8-bit values.

use durer_bvh::math::{Vec3, fp};
use std::sync::LazyLock;

/// Transfer function that converts linear values to 8-bit values, such as the sRGB curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transfer {
    /// The sRGB curve of IEC 61966-2-1, which screens expect. Values are rounded to the nearest
    /// integer.
    #[default]
    Srgb,
    /// No curve. Values are rounded to the nearest integer.
    Linear,
    /// No curve. Values are truncated instead of rounded, as in the programs of the course.
    Course,
}

impl Transfer {
    /// List of all transfer functions.
    pub const ALL: [Transfer; 3] = [Transfer::Srgb, Transfer::Linear, Transfer::Course];

    /// Name of the function on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Transfer::Srgb => "srgb",
            Transfer::Linear => "linear",
            Transfer::Course => "course",
        }
    }

    /// Finds a transfer function by its name.
    pub fn from_name(name: &str) -> Option<Transfer> {
        Transfer::ALL.into_iter().find(|transfer| transfer.name() == name)
    }

    /// Converts a linear value to an 8-bit value, clamped to 0..=255. NaN becomes 0.
    pub fn encode(self, value: f32) -> u8 {
        match self {
            Transfer::Srgb => SRGB.encode(value),
            Transfer::Linear => round(value),
            Transfer::Course => truncate(value),
        }
    }

    /// Converts a linear value to a 16-bit value, clamped to 0..=65535. NaN becomes 0.
    pub fn encode16(self, value: f32) -> u16 {
        let value = value.clamp(0.0, 1.0);
        match self {
            Transfer::Srgb => (srgb_from_linear(value) * 65535.0).round() as u16,
            Transfer::Linear => (value * 65535.0).round() as u16,
            Transfer::Course => (value * 65535.0) as u16,
        }
    }

    /// Converts each channel of a colour to 8 bits.
    pub fn encode_pixel(self, pixel: Vec3) -> [u8; 3] {
        pixel.to_array().map(|value| self.encode(value))
    }
}

/// Lookup table for encoding 8-bit sRGB values.
static SRGB: LazyLock<SrgbTable> = LazyLock::new(SrgbTable::new);

/// Lookup table that encodes linear values as 8-bit sRGB, using the thresholds between its 256
/// steps.
struct SrgbTable {
    /// Smallest linear value of each step, followed by infinity.
    least: [f32; 257],
    /// Steps at the starts of [`CELLS`] equal intervals of [0, 1]. Each interval contains at most
    /// one threshold.
    guide: [u8; CELLS + 1],
}

/// Number of intervals in the lookup table. The number is larger than the steepest slope of the
/// curve, which is 255 * 12.92 steps per unit at black.
const CELLS: usize = 4096;

impl SrgbTable {
    fn new() -> Self {
        let curve = |value: f32| round(srgb_from_linear(value));
        let mut least = [f32::INFINITY; 257];
        for (step, least) in least.iter_mut().enumerate().take(256) {
            // The bits of positive floating-point numbers have the same order as the numbers, and
            // the curve is monotonic.
            let (mut low, mut high) = (0, 1.0_f32.to_bits());
            while low < high {
                let middle = low.midpoint(high);
                if usize::from(curve(f32::from_bits(middle))) >= step { high = middle } else { low = middle + 1 }
            }
            *least = f32::from_bits(low);
        }
        SrgbTable { least, guide: std::array::from_fn(|cell| curve(cell as f32 / CELLS as f32)) }
    }

    fn encode(&self, value: f32) -> u8 {
        // NaN remains NaN, and its cell is 0.
        let value = value.clamp(0.0, 1.0);
        let step = usize::from(self.guide[(value * CELLS as f32) as usize]);
        (step + usize::from(value >= self.least[step + 1])) as u8
    }
}

/// Multiplies by 255 and rounds to the nearest integer. The cast saturates and turns NaN into 0.
fn round(value: f32) -> u8 {
    (value * 255.0).round() as u8
}

/// Computes `(int)(value * 255)` as in C, and then clamps the result to 0..=255.
///
/// On the machines of the course, values that do not fit into an `int` (infinities, NaN, and very
/// large values) became the smallest `int` and were then clamped to 0.
fn truncate(value: f32) -> u8 {
    let scaled = value * 255.0;
    if scaled < i32::MAX as f32 { (scaled as i32).clamp(0, 255) as u8 } else { 0 }
}

/// Applies the sRGB curve to values in [0, 1].
fn srgb_from_linear(value: f32) -> f32 {
    if value <= 0.0031308 { 12.92 * value } else { 1.055 * fp::pow(value, 1.0 / 2.4) - 0.055 }
}

/// Divides an 8-bit value by 255.
pub fn decode_linear(value: u8) -> f32 {
    f32::from(value) / 255.0
}

/// Converts an 8-bit sRGB value to a linear value with the inverse curve of IEC 61966-2-1.
pub fn decode_srgb(value: u8) -> f32 {
    linear_from_srgb(decode_linear(value))
}

/// Returns the linear values of an sRGB colour in the form `#rrggbb`, or `None` for other texts.
pub fn decode_hexadecimal(text: &str) -> Option<[f32; 3]> {
    let digits =
        text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit()))?;
    let [_, r, g, b] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some([r, g, b].map(decode_srgb))
}

/// Converts an sRGB value in [0, 1] to a linear value.
pub fn linear_from_srgb(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { fp::pow((value + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_colors_are_decoded() {
        assert_eq!(decode_hexadecimal("#ff00Cc"), Some([1.0, 0.0, decode_srgb(204)]));
        assert!(
            ["", "#", "ff00cc", "#ff00c", "#ff00ccc", "#+f00cc", "#ff00cg"]
                .iter()
                .all(|text| decode_hexadecimal(text).is_none())
        );
    }

    #[test]
    fn names_round_trip() {
        for transfer in Transfer::ALL {
            assert_eq!(Transfer::from_name(transfer.name()), Some(transfer));
        }
        assert_eq!(Transfer::from_name("gamma"), None);
    }

    #[test]
    fn edges() {
        let row = |value| Transfer::ALL.map(|transfer| transfer.encode(value));
        assert_eq!(row(0.0), [0, 0, 0]);
        assert_eq!(row(1.0), [255, 255, 255]);
        assert_eq!(row(0.5), [188, 128, 127]);
        assert_eq!(row(0.999), [255, 255, 254]);
        assert_eq!(row(0.0031308), [10, 1, 0]);
        assert_eq!(row(-1.0), [0, 0, 0]);
        assert_eq!(row(7.0), [255, 255, 255]);
        assert_eq!(row(f32::NAN), [0, 0, 0]);
        let row16 = |value| Transfer::ALL.map(|transfer| transfer.encode16(value));
        assert_eq!(row16(0.0), [0, 0, 0]);
        assert_eq!(row16(1.0), [65535, 65535, 65535]);
        // 1.055 * 0.5^(1 / 2.4) - 0.055 = 0.735357, times 65535.
        assert_eq!(row16(0.5), [48192, 32768, 32767]);
        assert_eq!(row16(7.0), [65535, 65535, 65535]);
        assert_eq!(row16(f32::NAN), [0, 0, 0]);
        assert_eq!(row(f32::INFINITY), [255, 255, 0]);
        assert_eq!(row(f32::NEG_INFINITY), [0, 0, 0]);
        // The first value still fits into an `int` after scaling, and the larger ones do not.
        assert_eq!(row(8.0e6), [255, 255, 255]);
        assert_eq!(row(9.0e6), [255, 255, 0]);
        assert_eq!(row(f32::MAX), [255, 255, 0]);
    }

    #[test]
    fn eight_bits_come_back() {
        for value in 0..=255 {
            assert_eq!(Transfer::Srgb.encode(decode_srgb(value)), value);
            assert_eq!(Transfer::Linear.encode(decode_linear(value)), value);
        }
    }

    #[test]
    fn the_table_is_the_curve() {
        let ends = SRGB.least.iter().flat_map(|least| [least.next_down(), *least, least.next_up()]);
        let cells = (0..=CELLS).flat_map(|cell| {
            let start = cell as f32 / CELLS as f32;
            [start.next_down(), start, start.next_up()]
        });
        let others = (0..200_000).map(|i| i as f32 * 6e-6 - 0.1).chain([f32::NAN, f32::NEG_INFINITY, 1e30]);
        for value in ends.chain(cells).chain(others) {
            assert_eq!(Transfer::Srgb.encode(value), round(srgb_from_linear(value)), "{value}");
        }
    }

    #[test]
    fn no_transfer_ever_falls() {
        for transfer in Transfer::ALL {
            let values: Vec<u8> = (0..=100_000).map(|i| transfer.encode(i as f32 / 1e5)).collect();
            assert!(values.is_sorted());
            assert!((0..=255).all(|value| values.contains(&value)));
        }
    }
}
