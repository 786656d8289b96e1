//! The command line of `durer compare`.

use crate::options::{JobArgs, SceneArgs, ViewArgs};
use crate::values::{percent, tolerance};
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::image::Transfer;
use std::path::PathBuf;

/// Compare a picture with a reference: numbers, words, a heat map, a page to look at
#[derive(Args)]
#[command(after_help = "Examples:
  durer compare reference.png mine.png
  durer compare reference.png mine.png --report report.html --tolerance 2/255
  durer compare reference.exr mine.exr --heat heat.png --json
  durer compare reference.png mine.png --scene scene.txt --bounces 4 --report report.html
  durer compare reference/ mine/ --report report.html
  durer compare reference/ class/

Folders are compared picture by picture, by name; extensions may differ. Where no name of REFERENCE is in PICTURE itself, but
some are in folders in it, each of those is taken for one student's.
With --scene, each region that differs tells what is there: the object, its place in the file, the normal, and why the ray has
its colour. The options with which the picture was rendered decide that.
Exit code: 0 the same within the tolerance, 1 different or missing, 2 a picture that cannot be read, sizes that differ, wrong
options, or a file that cannot be written.")]
pub struct CompareArgs {
    /// The picture that is right, or a folder of such
    pub reference: PathBuf,
    /// The picture to judge, or a folder of such
    pub picture: PathBuf,
    /// Write a page for a browser, in one file: slider, blinking, heat map, table
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Write a picture of the FLIP errors
    #[arg(long, value_name = "PICTURE")]
    pub heat: Option<PathBuf>,
    /// The largest difference of a channel that counts as the same, as 2/255 or a number
    #[arg(long, default_value = "1/255", value_parser = tolerance, allow_negative_numbers = true)]
    pub tolerance: f32,
    /// The share of pixels, in percent, that may differ by more
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percent, allow_negative_numbers = true)]
    pub allow: f64,
    /// How light becomes eight bits where the other picture has those: as when the reference was
    /// made
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    /// Everything as JSON
    #[arg(long)]
    pub json: bool,
    /// The scene of the pictures, or a folder of scenes of their names: the usual mistakes are
    /// tried on it, and the one that makes the picture is named. Give the options that made the
    /// reference as well
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
}
