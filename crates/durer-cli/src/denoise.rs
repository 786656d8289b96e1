//! Implements `--denoise` with Open Image Denoise if it is installed, and with the built-in
//! denoiser otherwise.

mod oidn;

use crate::failure::{Failure, invalid_input};
use crate::report;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use durer::diag::Diagnostic;
use durer::image::Layer;
use durer::render::NoisyPicture;

/// Denoiser selected with `--denoise`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Denoiser {
    /// Open Image Denoise if it is found, otherwise the built-in denoiser.
    #[default]
    Auto,
    /// Open Image Denoise.
    Oidn,
    /// Built-in denoiser, which is bit-identical on every machine.
    Own,
}

impl Denoiser {
    const NAMES: [&'static str; 3] = ["auto", "oidn", "own"];

    /// Returns a parser for denoiser names.
    pub fn parser() -> impl TypedValueParser<Value = Denoiser> {
        PossibleValuesParser::new(Denoiser::NAMES).map(|name| match name.as_str() {
            "oidn" => Denoiser::Oidn,
            "own" => Denoiser::Own,
            _ => Denoiser::Auto,
        })
    }

    /// Denoises a colour picture and returns it as a layer.
    pub fn clean(self, noisy: NoisyPicture, threads: Option<usize>, quiet: bool) -> Result<Layer, Failure> {
        if self == Denoiser::Own {
            return Ok(noisy.denoised());
        }
        match oidn::denoise(&noisy, threads) {
            Ok(clean) => Ok(noisy.layer(clean)),
            Err(why) if self == Denoiser::Oidn => Err(invalid_input(format!("{why}; {INSTALL_HINT}"))),
            Err(why) => {
                if !quiet {
                    report::note(&Diagnostic::note(format!(
                        "using the built-in denoiser because {why}; {INSTALL_HINT}"
                    )));
                }
                Ok(noisy.denoised())
            }
        }
    }
}

/// Advice about installing Open Image Denoise.
const INSTALL_HINT: &str = "to install Open Image Denoise, run `pip install pyoidn` and set OIDN_DIR to its folder \
                   `pyoidn/oidn`, or to any other folder with the library; `--denoise=own` needs no library";
