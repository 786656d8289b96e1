//! Options for converting to 8-bit pictures.

use crate::failure::{Failure, invalid_input};
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::image::{Display, Tone, Transfer};

/// Conversion to 8-bit pictures; floating point formats store the colours unchanged
#[derive(Args)]
pub struct DisplayArgs {
    /// Transfer curve of 8-bit pictures; `course` is linear and truncates instead of rounding
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    #[command(flatten)]
    pub exposure: ExposureArgs,
    /// Tone mapping curve of 8-bit pictures, for values above 1
    #[arg(long, value_name = "CURVE", default_value = "none", value_parser = PossibleValuesParser::new(Tone::ALL.map(|row| row.0)))]
    pub tone: String,
}

/// Exposure of 8-bit pictures
#[derive(Args)]
pub struct ExposureArgs {
    /// Exposure of 8-bit pictures in stops; each stop doubles the brightness
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true)]
    pub exposure: f32,
    /// Shutter time of a physical camera in seconds, for example 1/125, for scenes in cd/m^2;
    /// --exposure is added
    #[arg(long, value_name = "SECONDS", value_parser = seconds, requires = "f_number")]
    pub shutter: Option<f32>,
    /// Aperture of the physical camera, as an f-number
    #[arg(long, value_name = "N", value_parser = positive, requires = "shutter")]
    pub f_number: Option<f32>,
    /// ISO sensitivity of the physical camera [default: 100]
    #[arg(long, value_name = "ISO", value_parser = positive, requires = "shutter")]
    pub iso: Option<f32>,
}

impl ExposureArgs {
    /// Returns the factor by which radiance values are multiplied.
    pub fn factor(&self) -> Result<f32, Failure> {
        let stops = self.exposure;
        if !(stops.is_finite() && stops.abs() <= 60.0) {
            return Err(invalid_input("--exposure must be between -60 and 60"));
        }
        let factor = durer::math::fp::pow(2.0, stops);
        Ok(match (self.shutter, self.f_number) {
            (Some(shutter), Some(f_number)) => {
                factor * by_camera(shutter, f_number, self.iso.unwrap_or(100.0)).clamp(1e-18, 1e18)
            }
            _ => factor,
        })
    }
}

/// Returns the pixel value that a camera records for 1 cd/m², relative to white.
///
/// Source: Lagarde and de Rousiers, *Moving Frostbite to Physically Based Rendering*, SIGGRAPH 2014
/// course, section 5.1.2. White corresponds to 78 / (0.65 S) N² / t, which follows from ISO 12232
/// for a lens that transmits 0.65 of the light.
fn by_camera(shutter: f32, f_number: f32, iso: f32) -> f32 {
    shutter * iso / (1.2 * 100.0 * f_number * f_number)
}

fn positive(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a number above 0".into())
}

/// Parses a time in seconds, for example 0.008 or 1/125.
fn seconds(text: &str) -> Result<f32, String> {
    let (over, under) = text.split_once('/').unwrap_or((text, "1"));
    let seconds =
        positive(over).and_then(|over| Ok(over / positive(under)?)).ok().filter(|seconds| seconds.is_normal());
    seconds.ok_or_else(|| "expected a time in seconds, for example 0.008 or 1/125".into())
}

impl DisplayArgs {
    /// Returns the exposure, the tone mapping curve and the transfer curve.
    pub fn display(&self) -> Result<Display, Failure> {
        let exposure = self.exposure.factor()?;
        Ok(Display { exposure, tone: Tone::from_name(&self.tone).unwrap_or_default(), transfer: self.transfer() })
    }

    /// Returns the transfer curve.
    pub fn transfer(&self) -> Transfer {
        Transfer::from_name(&self.transfer).unwrap_or_default()
    }
}
