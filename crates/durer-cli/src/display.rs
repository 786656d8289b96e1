//! Options for converting to 8-bit pictures.

use crate::failure::{Failure, from_render_error, invalid_input};
use crate::terminal::print_error_line;
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::image::{ChannelBits, Color, Depth, Display, Format, Tone, Transfer, automatic_exposure};
use durer::render::PartialRender;

/// Conversion to 8-bit pictures; floating point formats store the colours unchanged
#[derive(Args, Clone)]
pub struct DisplayArgs {
    /// Transfer curve of 8-bit pictures; `course` is linear and truncates instead of rounding
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    #[command(flatten)]
    pub exposure: ExposureArgs,
    /// Tone mapping curve of 8-bit pictures, for values above 1
    #[arg(long, value_name = "CURVE", default_value = "none", value_parser = PossibleValuesParser::new(Tone::ALL.map(|row| row.0)))]
    pub tone: String,
    /// Bits per channel of PNG and PPM files
    #[arg(long, value_name = "BITS", default_value = "8", value_parser = bits)]
    pub bits: u8,
}

/// Exposure of 8-bit pictures
#[derive(Args, Clone)]
pub struct ExposureArgs {
    /// Exposure of 8-bit pictures in stops, each of which doubles the brightness; `auto` maps the
    /// geometric mean of the luminance to middle grey, unless a tenth of the picture would be white
    #[arg(long, value_name = "EV", default_value = "0", allow_negative_numbers = true, value_parser = exposure)]
    pub exposure: Exposure,
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

/// Value of `--exposure`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// Number of stops, from -60 to 60.
    Stops(f32),
    /// Chosen for each picture by [`automatic_exposure`].
    Auto,
}

impl ExposureArgs {
    /// Returns the factor by which radiance values are multiplied. `colors` are the pixels of the
    /// picture, or `None` if there is no picture from which an exposure could be chosen.
    pub fn factor(&self, colors: Option<&[Color]>) -> f32 {
        let factor = match (self.exposure, colors) {
            (Exposure::Stops(stops), _) => durer::math::fp::pow(2.0, stops),
            (Exposure::Auto, Some(colors)) => automatic_exposure(colors),
            (Exposure::Auto, None) => 1.0,
        };
        match (self.shutter, self.f_number) {
            (Some(shutter), Some(f_number)) => {
                factor * by_camera(shutter, f_number, self.iso.unwrap_or(100.0)).clamp(1e-18, 1e18)
            }
            _ => factor,
        }
    }
}

fn exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    let stops = text.parse::<f32>().ok().filter(|stops| stops.is_finite() && stops.abs() <= 60.0);
    stops.map(Exposure::Stops).ok_or_else(|| "expected a number from -60 to 60, or auto".into())
}

/// Returns the pixel value that a camera records for 1 cd/m², relative to white.
///
/// Source: Lagarde and de Rousiers, *Moving Frostbite to Physically Based Rendering*, SIGGRAPH 2014
/// course, section 5.1.2. White corresponds to 78 / (0.65 S) N² / t, which follows from ISO 12232
/// for a lens that transmits 0.65 of the light.
fn by_camera(shutter: f32, f_number: f32, iso: f32) -> f32 {
    shutter * iso / (1.2 * 100.0 * f_number * f_number)
}

fn bits(text: &str) -> Result<u8, String> {
    text.parse().ok().filter(|bits| matches!(bits, 8 | 16)).ok_or_else(|| "expected 8 or 16".into())
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
    /// Returns the conversion for a finished picture. Prints the exposure that `--exposure auto`
    /// chooses.
    pub fn display_of(&self, part: &PartialRender, quiet: bool) -> Result<Display, Failure> {
        if self.exposure.exposure != Exposure::Auto {
            return Ok(self.display(None));
        }
        let rendered = part.pictures().map_err(from_render_error)?;
        let colors = rendered.pictures.iter().find(|layer| layer.name == "color");
        let Some(colors) = colors else { return Ok(self.display(None)) };
        let display = self.display(Some(&colors.image.pixels));
        if !quiet {
            let stops = durer::math::fp::ln(display.exposure) * std::f32::consts::LOG2_E;
            print_error_line(&format!("note: --exposure auto chose {stops:.2} stops"));
        }
        Ok(display)
    }

    /// Checks that a picture format can hold the requested number of bits.
    pub fn check_bits(&self, format: &Format) -> Result<(), Failure> {
        match self.bits == 8 || format.supports_sixteen_bits() {
            true => Ok(()),
            false => {
                let what = match format.depth {
                    Depth::Float => "stores floating-point numbers",
                    Depth::EightBit => "has 8 bits per channel",
                };
                Err(invalid_input(format!("--bits 16 needs a .png or .ppm file: {} {what}", format.name)))
            }
        }
    }

    /// Returns the exposure, the tone mapping curve, the transfer curve and the number of bits.
    /// `colors` are the pixels for which `--exposure auto` chooses the exposure.
    pub fn display(&self, colors: Option<&[Color]>) -> Display {
        let exposure = self.exposure.factor(colors);
        let bits = if self.bits == 16 { ChannelBits::Sixteen } else { ChannelBits::Eight };
        Display { exposure, tone: Tone::from_name(&self.tone).unwrap_or_default(), transfer: self.transfer(), bits }
    }

    /// Returns the transfer curve.
    pub fn transfer(&self) -> Transfer {
        Transfer::from_name(&self.transfer).unwrap_or_default()
    }
}
