//! How colours become eight bits, from options.

use crate::failure::{Failure, bad};
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::image::{Display, Tone, Transfer};

/// How colours become eight bits; floating point formats keep them as they are
#[derive(Args)]
pub struct DisplayArgs {
    /// How colours become eight bits: sRGB's curve, none, or none and truncated as the course has
    /// it
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    #[command(flatten)]
    pub exposure: ExposureArgs,
    /// What becomes of light that eight bits cannot hold
    #[arg(long, value_name = "CURVE", default_value = "none", value_parser = PossibleValuesParser::new(Tone::ALL.map(|row| row.0)))]
    pub tone: String,
}

/// How bright pictures of eight bits are
#[derive(Args)]
pub struct ExposureArgs {
    /// Makes pictures of eight bits brighter by so many stops: each doubles the light
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true)]
    pub exposure: f32,
    /// How long a camera's shutter is open, for scenes in cd/m^2: 1/125, say; --exposure comes on
    /// top
    #[arg(long, value_name = "SECONDS", value_parser = seconds, requires = "f_number")]
    pub shutter: Option<f32>,
    /// That camera's focal length over the width of its pupil
    #[arg(long, value_name = "N", value_parser = positive, requires = "shutter")]
    pub f_number: Option<f32>,
    /// That camera's sensitivity [default: 100]
    #[arg(long, value_name = "ISO", value_parser = positive, requires = "shutter")]
    pub iso: Option<f32>,
}

impl ExposureArgs {
    /// What light is multiplied by.
    pub fn factor(&self) -> Result<f32, Failure> {
        let stops = self.exposure;
        if !(stops.is_finite() && stops.abs() <= 60.0) {
            return Err(bad("--exposure must be between -60 and 60"));
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

/// What a camera makes of 1 cd/m², where 1 is white.
///
/// Source: Lagarde and de Rousiers, *Moving Frostbite to Physically Based Rendering*, SIGGRAPH 2014
/// course, section 5.1.2: white is 78 / (0.65 S) N² / t, after ISO 12232 and a lens that lets 0.65
/// of the light through.
fn by_camera(shutter: f32, f_number: f32, iso: f32) -> f32 {
    shutter * iso / (1.2 * 100.0 * f_number * f_number)
}

fn positive(text: &str) -> Result<f32, String> {
    let number = text.parse::<f32>().ok().filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "a number above 0 is needed".into())
}

/// Seconds, as 0.008 or 1/125.
fn seconds(text: &str) -> Result<f32, String> {
    let (over, under) = text.split_once('/').unwrap_or((text, "1"));
    let seconds =
        positive(over).and_then(|over| Ok(over / positive(under)?)).ok().filter(|seconds| seconds.is_normal());
    seconds.ok_or_else(|| "seconds are as 0.008 or 1/125".into())
}

impl DisplayArgs {
    /// What the options say.
    pub fn display(&self) -> Result<Display, Failure> {
        let exposure = self.exposure.factor()?;
        Ok(Display { exposure, tone: Tone::from_name(&self.tone).unwrap_or_default(), transfer: self.transfer() })
    }

    /// The curve alone.
    pub fn transfer(&self) -> Transfer {
        Transfer::from_name(&self.transfer).unwrap_or_default()
    }
}
