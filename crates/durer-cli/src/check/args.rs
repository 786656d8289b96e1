//! The command line of `durer check`.

use crate::display::ExposureArgs;
use crate::options::{JobArgs, SceneArgs, ViewArgs};
use clap::Args;
use std::path::PathBuf;

/// Find and fix problems that make a scene's picture black, white, empty or wrong
#[derive(Args)]
#[command(after_help = "Examples:
  durer check scene.txt
  durer check scene.txt --dialect f04 --bounces 4 --depth-range 9 10
  durer check scene.txt --fix -o mended.txt
  durer check class/*.txt --json

Pass the same options as to `durer render`, because the findings depend on them. Causes are listed before their consequences. --fix applies mechanical fixes, in place or to FILE, and prints what it changed and which findings are left.
It keeps a change only if the finding is gone afterwards.

JSON: {version, scenes: [{scene, dialect, readable, findings: [{code, severity, whole, message, label, effect, help, place,
related, fix}], mended: [{code, place, old, new}]}]}. A place is {file, line, column, end_line, end_column, start, end}:
lines and columns count from 1, start and end are byte offsets. `fix` lists {place, text}; `whole` is true if the finding
ruins the entire picture. Later versions may add fields, but the meaning of a code never changes.

Exit code: 0 if there are no findings or only notes, 1 if there are warnings, 2 if the scene cannot be rendered or an option
is invalid.")]
pub struct CheckArgs {
    /// Scene files; `-` is standard input
    #[arg(required_unless_present = "codes", value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// Exposure, as for `render`, used to decide what is too bright or too dark
    #[command(flatten)]
    pub exposure: ExposureArgs,
    /// Apply the mechanical fixes and write the fixed scene
    #[arg(long)]
    pub fix: bool,
    /// File to write the fixed scene to [default: in place]
    #[arg(short, long, value_name = "FILE", requires = "fix")]
    pub output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// List the codes of all findings and what they mean
    #[arg(long, conflicts_with_all = ["scenes", "fix"])]
    pub codes: bool,
}
