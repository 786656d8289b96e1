//! The command line of `durer compare`.

use crate::options::{JobArgs, SceneArgs, ViewArgs};
use crate::values::{percent, tolerance};
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::image::Transfer;
use std::path::PathBuf;

/// Compare a picture with a reference: error metrics, causes, a heat map, a report
#[derive(Args)]
#[command(after_help = "Examples:
  durer compare reference.png mine.png
  durer compare reference.png mine.png --report report.html --tolerance 2/255
  durer compare reference.exr mine.exr --heat heat.png --json
  durer compare reference.png mine.png --scene scene.txt --bounces 4 --report report.html
  durer compare reference/ mine/ --report report.html
  durer compare reference/ class/
  durer compare reference/ class/ --scene scenes/ --csv > class.csv
  durer compare reference/ class/ --table class.csv --report class.html

Pictures in folders are matched by name; their extensions may differ. If no name in REFERENCE exists in PICTURE itself, each
folder in PICTURE counts as one student's submission. Pictures are read from files, not from standard input.

With --scene, the output lists for each differing region the object, its position in the file, its normal, and an
explanation of the ray's colour. Pass the options that the reference was rendered with. With --table, each picture has its own
scene and options; a line of the table is, for example: `mirrors.png,scenes/mirrors.txt,--bounces 4 --samples 1`. Options in the
table replace those of the command line.

Exit code: 0 if the pictures are equal within the tolerance, 1 if one is different or missing, 2 if a picture cannot be
read, sizes differ, an option is invalid, or a file cannot be written.")]
pub struct CompareArgs {
    /// Reference picture, or a folder of reference pictures
    pub reference: PathBuf,
    /// Picture to compare with it, or a folder of pictures
    pub picture: PathBuf,
    /// Write a self-contained HTML report with a slider, a blink comparison, a heat map and a table
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Write a heat map of the FLIP error
    #[arg(long, value_name = "PICTURE")]
    pub heat: Option<PathBuf>,
    /// Largest difference per channel that counts as equal: a number, or a fraction such as 2/255
    #[arg(long, default_value = "1/255", value_parser = tolerance, allow_negative_numbers = true)]
    pub tolerance: f32,
    /// Percentage of pixels that may exceed the tolerance
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percent, allow_negative_numbers = true)]
    pub allow: f64,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Print comma-separated values, one line per picture
    #[arg(long, conflicts_with = "json")]
    pub csv: bool,
    /// Scene of the pictures, or a folder of scenes with matching names. Tries common mistakes on
    /// the scene and reports the one that reproduces the picture; also pass the options of the
    /// reference
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    /// CSV file with the columns picture, scene and options: for each picture, its scene (relative
    /// to the file) and the options that its reference was rendered with
    #[arg(long, value_name = "FILE.csv")]
    pub table: Option<PathBuf>,
    #[command(flatten)]
    pub rendering: RenderingArgs,
}

/// Options that the reference was rendered with
#[derive(Args)]
pub struct RenderingArgs {
    /// Transfer curve for comparing a floating-point picture with an 8-bit one; use the curve of
    /// the reference
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
}

impl RenderingArgs {
    /// Returns the transfer curve of 8-bit pictures.
    pub fn transfer(&self) -> Transfer {
        Transfer::from_name(&self.transfer).unwrap_or_default()
    }
}
