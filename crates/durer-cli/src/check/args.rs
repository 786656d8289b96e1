//! The command line of `durer check`.

use crate::display::ExposureArgs;
use crate::options::{JobArgs, SceneArgs, ViewArgs};
use clap::Args;
use std::path::PathBuf;

/// Say what is wrong with a scene whose picture is black, white, empty or odd, and mend it
#[derive(Args)]
#[command(after_help = "Examples:
  durer check scene.txt
  durer check scene.txt --dialect f04 --bounces 4 --depth-range 9 10
  durer check scene.txt --fix -o mended.txt
  durer check class/*.txt --json

Give the options with which the picture is rendered: they decide what is odd. Findings stand in the order of cause: what comes
of others is told after them. --fix writes what is mechanical, in place or into FILE, and tells what it changed and what is
left; a change after which the finding is still there is not made.

JSON: {version, scenes: [{scene, dialect, readable, findings: [{code, severity, whole, message, label, effect, help, place,
related, fix}], mended: [{code, place, old, new}]}]}. A place is {file, line, column, end_line, end_column, start, end}, lines and
columns from 1, start and end in bytes; `fix` lists {place, text}, and `whole` says that the whole picture is spoilt. A higher
version may add fields; codes are never given another meaning.

Exit code: 0 nothing found but notes, 1 warnings, 2 a scene of which no picture can be made, or wrong options.")]
pub struct CheckArgs {
    /// The scene files
    #[arg(required_unless_present = "codes", value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// As of `render`: it decides what is too bright or too dark
    #[command(flatten)]
    pub exposure: ExposureArgs,
    /// Write the scene anew, with all changed that is mechanical
    #[arg(long)]
    pub fix: bool,
    /// Where to write it [default: in place]
    #[arg(short, long, value_name = "FILE", requires = "fix")]
    pub output: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    pub json: bool,
    /// List the codes of all findings, with their meaning
    #[arg(long, conflicts_with_all = ["scenes", "fix"])]
    pub codes: bool,
}
