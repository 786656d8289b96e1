//! Conversion of linear colours to integer values by exposure, tone mapping, and a transfer
//! function.

use super::Transfer;
use crate::{Color, LUMINANCE};
use durer_bvh::math::{Vec3, fp};
use glam::Mat3;

/// Conversion of linear colours to integer values for a file or a screen by exposure, tone mapping,
/// and a transfer function. Floating-point formats ignore this conversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Display {
    /// Factor by which colours are multiplied before anything else.
    pub exposure: f32,
    /// Operator for tone mapping.
    pub tone: Tone,
    /// Transfer function, which is applied last.
    pub transfer: Transfer,
    /// Number of bits per channel, in formats that support both.
    pub bits: ChannelBits,
}

/// Number of bits per channel of a picture file with integer values. Formats that do not support
/// 16 bits are written with 8; see [`Format::supports_sixteen_bits`](crate::Format).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChannelBits {
    /// Values from 0 to 255.
    #[default]
    Eight,
    /// Values from 0 to 65535.
    Sixteen,
}

impl Default for Display {
    fn default() -> Self {
        Transfer::default().into()
    }
}

impl From<Transfer> for Display {
    fn from(transfer: Transfer) -> Self {
        Display { exposure: 1.0, tone: Tone::None, transfer, bits: ChannelBits::Eight }
    }
}

impl Display {
    /// Converts a colour to 8-bit values.
    pub fn encode_pixel(&self, color: Color) -> [u8; 3] {
        self.transfer.encode_pixel(self.tone.apply(self.exposure * color))
    }

    /// Converts a colour to 16-bit values.
    pub fn encode_pixel16(&self, color: Color) -> [u16; 3] {
        self.tone.apply(self.exposure * color).to_array().map(|value| self.transfer.encode16(value))
    }
}

/// Tone mapping operator, which compresses the range of linear colours so that they can be
/// displayed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    /// No tone mapping; values above 1 are clipped.
    #[default]
    None,
    /// Scales each colour so that its luminance L becomes L / (1 + L). Source: Reinhard and others,
    /// *Photographic Tone Reproduction for Digital Images*, 2002.
    Reinhard,
    /// Applies a fit of the ACES curve to each channel. Source: Narkowicz, *ACES Filmic Tone
    /// Mapping Curve*, 2016.
    Aces,
    /// AgX tone mapping as in Blender. Source: Sobotka; the polynomial is from Wrensch, *Minimal
    /// AgX Implementation*, 2023.
    Agx,
    /// Preserves colours up to a value of 0.8. Source: Khronos, *PBR Neutral Tone Mapper*, 2024.
    KhronosNeutral,
}

impl Tone {
    /// Pairs of an operator's name, as on the command line, and the operator.
    pub const ALL: [(&'static str, Tone); 5] = [
        ("none", Tone::None),
        ("reinhard", Tone::Reinhard),
        ("aces", Tone::Aces),
        ("agx", Tone::Agx),
        ("khronos-neutral", Tone::KhronosNeutral),
    ];

    /// Finds a tone mapping operator by its name.
    pub fn from_name(name: &str) -> Option<Tone> {
        Tone::ALL.iter().find(|row| row.0 == name).map(|row| row.1)
    }

    /// Maps a linear colour to a linear colour for display.
    pub fn apply(self, color: Color) -> Color {
        match self {
            Tone::None => color,
            Tone::Reinhard => {
                let brightness = color.dot(LUMINANCE).max(0.0);
                color / (1.0 + brightness)
            }
            Tone::Aces => {
                let x = 0.6 * color.max(Vec3::ZERO);
                x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)
            }
            Tone::Agx => agx(color),
            Tone::KhronosNeutral => khronos_neutral(color),
        }
    }
}

fn agx(color: Color) -> Color {
    let inset = Mat3::from_cols_array(&[
        0.842_479_06,
        0.042_328_24,
        0.042_375_655,
        0.078_433_6,
        0.878_468_64,
        0.078_433_6,
        0.079_223_745,
        0.079_166_13,
        0.879_143,
    ]);
    let (least, most) = (-12.473_93, 4.026_069);
    let log2 = |x: f32| fp::ln(x.max(1e-10)) * std::f32::consts::LOG2_E;
    let x = (inset * color.max(Vec3::ZERO)).map(|x| (log2(x).clamp(least, most) - least) / (most - least));
    let curve = |x: f32| {
        let (x2, x4) = (x * x, x * x * x * x);
        15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232
    };
    let shown = inset.inverse() * x.map(curve);
    shown.map(|x| fp::pow(x.max(0.0), 2.2))
}

fn khronos_neutral(color: Color) -> Color {
    const START: f32 = 0.8 - 0.04;
    const DESATURATION: f32 = 0.15;
    let least = color.min_element();
    let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    let color = color - offset;
    let peak = color.max_element();
    if peak < START {
        return color;
    }
    let rest = 1.0 - START;
    let shown = 1.0 - rest * rest / (peak + rest - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - shown) + 1.0);
    (color * (shown / peak)).lerp(Vec3::splat(shown), white)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_rise_keep_black_and_stay_within_what_a_screen_shows() {
        for (name, tone) in Tone::ALL.into_iter().skip(1) {
            let at = |x: f32| tone.apply(Vec3::splat(x)).x;
            assert!(at(0.0).abs() < 1e-3, "{name}: {}", at(0.0));
            let mut before = -1.0;
            for i in 0..400 {
                let x = 0.02 * i as f32 * (1.0 + 0.1 * i as f32);
                assert!(at(x) >= before - 1e-4 && at(x) < 1.05, "{name} at {x}: {} after {before}", at(x));
                before = at(x);
            }
            assert!(before > 0.9, "{name}: {before}");
            assert_eq!(Tone::from_name(name), Some(tone));
        }
        // Khronos guarantees that base colours up to 0.8 are preserved, except that the 0.04 that
        // every dielectric reflects is subtracted.
        assert!((Tone::KhronosNeutral.apply(Vec3::splat(0.5)) - 0.46).length() < 1e-6);
        assert_eq!(Tone::None.apply(Vec3::splat(7.0)), Vec3::splat(7.0));
    }
}
