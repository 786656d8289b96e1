//! The command line of `durer compare`.

use crate::options::{JobArgs, SceneArgs, ViewArgs};
use crate::values::{percent, tolerance};
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::image::Transfer;
use std::path::PathBuf;

/// Compare a picture with a reference: measures, causes, a heat map, a report
#[derive(Args)]
#[command(after_help = "Examples:
  durer compare reference.png mine.png
  durer compare reference.png mine.png --report report.html --tolerance 2/255
  durer compare reference.exr mine.exr --heat heat.png --json
  durer compare reference.png mine.png --scene scene.txt --bounces 4 --report report.html
  durer compare reference/ mine/ --report report.html
  durer compare reference/ class/
  durer compare reference/ class/ --scene scenes/ --csv > class.csv

Folders are compared picture by picture, by name; extensions may differ. If no name in REFERENCE exists in PICTURE itself, each
folder in PICTURE counts as one student's.
With --scene, the output names for each region that differs the object, its place in the file, the normal, and why the ray has
its colour. Pass the options with which the reference was rendered.
Exit code: 0 same within the tolerance, 1 different or missing, 2 a picture cannot be read, sizes differ, an option is invalid,
or a file cannot be written.")]
pub struct CompareArgs {
    /// Reference picture, or a folder of references
    pub reference: PathBuf,
    /// Picture to judge, or a folder of pictures
    pub picture: PathBuf,
    /// Write an HTML report in one file: slider, blinking, heat map, table
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Write a heat map of the FLIP errors
    #[arg(long, value_name = "PICTURE")]
    pub heat: Option<PathBuf>,
    /// Largest channel difference that counts as equal, as 2/255 or a number
    #[arg(long, default_value = "1/255", value_parser = tolerance, allow_negative_numbers = true)]
    pub tolerance: f32,
    /// Percentage of pixels that may differ by more
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percent, allow_negative_numbers = true)]
    pub allow: f64,
    /// Transfer curve for comparing a floating point picture with an 8-bit one: the one that made
    /// the reference
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Print a table of comma-separated values, one line a picture
    #[arg(long, conflicts_with = "json")]
    pub csv: bool,
    /// Scene of the pictures, or a folder of scenes with their names: tries common mistakes on it
    /// and names the one that reproduces the picture; pass the options that made the reference too
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
}
