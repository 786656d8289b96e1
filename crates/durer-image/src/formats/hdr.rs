//! Radiance HDR format, with three 8-bit mantissas and a shared exponent per pixel, compressed by
//! run-length encoding.
//!
//! Sources: Ward, *Real Pixels*, Graphics Gems II, and Radiance's `color.c`.

use super::{Depth, Format, ImageError, RowFormat, RowLayout, codec, rows};
use ::image::codecs::hdr::HdrDecoder;
use durer_bvh::math::Vec3;

const NAME: &str = "Radiance HDR";

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["hdr"],
    depth: Depth::Float,
    supports_layers: false,
    has_alpha: false,
    max_side: u32::MAX,
    has_signature: |bytes| bytes.starts_with(b"#?RADIANCE") || bytes.starts_with(b"#?RGBE"),
    head: |bytes| Ok(codec::head(&decoder(bytes)?)),
    decode: |bytes| codec::raster(NAME, decoder(bytes)?),
    encode: |layers, options, out| rows::encode(&ROWS, layers, options, out),
    rows: Some(&ROWS),
};

/// Widths at which rows are compressed. Rows of any other width are written pixel by pixel.
const PACKED_WIDTHS: std::ops::Range<u32> = 8..0x8000;
/// Maximum length of a run, and maximum length of a sequence of literal bytes.
const RUN_LIMIT: usize = 127;
const LITERAL_LIMIT: usize = 128;
/// Minimum length of a run that saves space.
const MIN_RUN: usize = 4;

fn decoder(bytes: &[u8]) -> Result<HdrDecoder<&[u8]>, ImageError> {
    // The strict decoder accepts only one of the two signatures, both of which have already been
    // checked.
    HdrDecoder::new_nonstrict(bytes).map_err(|error| ImageError::malformed(NAME, error))
}

static ROWS: RowFormat = RowFormat {
    bottom_up: false,
    head: |RowLayout { width, height, .. }| {
        Ok(format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes())
    },
    row: |strip, _, pixels, _, out| {
        let row: Vec<[u8; 4]> = pixels.iter().map(|&pixel| rgbe(pixel)).collect();
        if !PACKED_WIDTHS.contains(&strip.width) {
            out.extend(row.as_flattened());
            return;
        }
        out.extend([2, 2, (strip.width >> 8) as u8, strip.width as u8]);
        for channel in 0..4 {
            let bytes: Vec<u8> = row.iter().map(|pixel| pixel[channel]).collect();
            pack(&bytes, out);
        }
    },
    sixteen_bits: false,
    png: false,
};

/// Converts a colour to mantissas and a shared exponent, where channel = mantissa / 256 *
/// 2^(exponent - 128) and the largest mantissa is at least 128.
///
/// Negative values and NaN become 0. Values that are too large, including infinity, become the
/// largest value that can be represented.
fn rgbe(pixel: Vec3) -> [u8; 4] {
    let channels = pixel.to_array().map(|value| f64::from(value.clamp(0.0, f32::MAX).max(0.0)));
    let greatest = channels.into_iter().fold(0.0, f64::max);
    // The code computes greatest = fraction * 2^exponent, with the fraction in 0.5..1, from the
    // bits of an `f64`, in which no `f32` value is subnormal.
    let mut exponent = (greatest.to_bits() >> 52) as i32 - 1022;
    if greatest == 0.0 || exponent < -126 {
        return [0; 4];
    }
    let mantissas = |exponent: i32| {
        let scale = f64::from_bits(((8 - exponent + 1023) as u64) << 52);
        channels.map(|value| (value * scale).round())
    };
    // If a mantissa rounds up to 256, the next exponent must be used.
    if mantissas(exponent).contains(&256.0) {
        exponent += 1;
    }
    let [r, g, b] = mantissas(exponent.min(127)).map(|mantissa| mantissa as u8);
    [r, g, b, (exponent.min(127) + 128) as u8]
}

/// Appends bytes in run-length encoding: a length above 128 is followed by one byte to be repeated,
/// and any other length is followed by that many literal bytes.
fn pack(bytes: &[u8], out: &mut Vec<u8>) {
    let run_at = |at: usize| bytes[at..].iter().take(RUN_LIMIT).take_while(|&&byte| byte == bytes[at]).count();
    let mut at = 0;
    while at < bytes.len() {
        let run = run_at(at);
        if run >= MIN_RUN {
            out.extend([128 + run as u8, bytes[at]]);
            at += run;
            continue;
        }
        // A sequence of literal bytes ends where the next run begins.
        let limit = bytes.len().min(at + LITERAL_LIMIT);
        let end = (at + 1..limit).find(|&next| run_at(next) >= MIN_RUN).unwrap_or(limit);
        out.push((end - at) as u8);
        out.extend(&bytes[at..end]);
        at = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_of_the_shared_exponent() {
        assert_eq!(rgbe(Vec3::ONE), [128, 128, 128, 129]);
        assert_eq!(rgbe(Vec3::new(0.5, 0.25, -3.0)), [128, 64, 0, 128]);
        assert_eq!(rgbe(Vec3::new(0.9999, f32::NAN, 0.0)), [128, 0, 0, 129]);
        assert_eq!(rgbe(Vec3::splat(f32::INFINITY)), [255, 255, 255, 255]);
        assert_eq!(rgbe(Vec3::splat(f32::MIN_POSITIVE)), [128, 128, 128, 3]);
        assert_eq!(rgbe(Vec3::splat(1e-45)), [0; 4]);
        assert_eq!(rgbe(Vec3::ZERO), [0; 4]);
    }

    #[test]
    fn runs_are_packed() {
        let mut out = Vec::new();
        pack(&[7, 7, 7, 1, 2, 9, 9, 9, 9, 9, 3], &mut out);
        assert_eq!(out, [5, 7, 7, 7, 1, 2, 128 + 5, 9, 1, 3]);
        out.clear();
        pack(&[4; 130], &mut out);
        assert_eq!(out, [255, 4, 3, 4, 4, 4]);
    }
}
