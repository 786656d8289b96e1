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
    /// Makes pictures of eight bits brighter by so many stops: each doubles the light
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true)]
    pub exposure: f32,
    /// What becomes of light that eight bits cannot hold
    #[arg(long, value_name = "CURVE", default_value = "none", value_parser = PossibleValuesParser::new(Tone::ALL.map(|row| row.0)))]
    pub tone: String,
}

/// What stops multiply light by.
pub fn factor(stops: f32) -> Result<f32, Failure> {
    if !(stops.is_finite() && stops.abs() <= 60.0) {
        return Err(bad("--exposure must be between -60 and 60"));
    }
    Ok(durer::math::fp::pow(2.0, stops))
}

impl DisplayArgs {
    /// What the options say.
    pub fn display(&self) -> Result<Display, Failure> {
        let exposure = factor(self.exposure)?;
        Ok(Display { exposure, tone: Tone::from_name(&self.tone).unwrap_or_default(), transfer: self.transfer() })
    }

    /// The curve alone.
    pub fn transfer(&self) -> Transfer {
        Transfer::from_name(&self.transfer).unwrap_or_default()
    }
}
