//! `--denoise`: by Open Image Denoise where that is found, else by our own.

mod oidn;

use crate::failure::{Failure, bad};
use crate::report;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use durer::diag::Diagnostic;
use durer::image::Layer;
use durer::render::Noisy;

/// Which denoiser is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Denoiser {
    /// Open Image Denoise where it is found, else our own.
    #[default]
    Auto,
    /// Open Image Denoise.
    Oidn,
    /// Our own, whose bits are the same everywhere.
    Own,
}

impl Denoiser {
    const NAMES: [&'static str; 3] = ["auto", "oidn", "own"];

    /// Reads its name.
    pub fn parser() -> impl TypedValueParser<Value = Denoiser> {
        PossibleValuesParser::new(Denoiser::NAMES).map(|name| match name.as_str() {
            "oidn" => Denoiser::Oidn,
            "own" => Denoiser::Own,
            _ => Denoiser::Auto,
        })
    }

    /// The picture without its noise.
    pub fn clean(self, noisy: Noisy, threads: Option<usize>, quiet: bool) -> Result<Layer, Failure> {
        if self == Denoiser::Own {
            return Ok(noisy.denoised());
        }
        match oidn::denoise(&noisy, threads) {
            Ok(clean) => Ok(noisy.layer(clean)),
            Err(why) if self == Denoiser::Oidn => Err(bad(format!("{why}; {HOW}"))),
            Err(why) => {
                if !quiet {
                    report::note(&Diagnostic::note(format!(
                        "noise is taken out by our own denoiser, for {why}; {HOW}"
                    )));
                }
                Ok(noisy.denoised())
            }
        }
    }
}

/// How the library is got.
const HOW: &str = "`pip install pyoidn` brings Open Image Denoise: set OIDN_DIR to the folder `pyoidn/oidn` that it makes, \
                   or to any other that has the library; `--denoise=own` asks for none";
