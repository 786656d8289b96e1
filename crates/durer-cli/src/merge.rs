//! Implements `durer merge`, which merges the parts of a picture.

use crate::autosave::read_part;
use crate::display::DisplayArgs;
use crate::failure::{Failure, from_render_error, invalid_input};
use crate::file_registry::FileRegistry;
use crate::output;
use crate::output::Target;
use crate::report::rejected;
use crate::terminal::print_line;
use clap::Args;
use durer::render::merge;
use std::path::PathBuf;

/// Merge the parts of a picture
#[derive(Args)]
#[command(after_help = "Examples:
  durer merge one.part two.part three.part -o picture.exr
  durer merge shards/*.part -o picture.png --hash

The result is identical, bit for bit, to that of a single run. Parts of other pictures, overlapping parts and missing parts
are errors.")]
pub struct MergeArgs {
    /// Part files, in any order
    #[arg(required = true)]
    pub parts: Vec<PathBuf>,
    /// Picture to write
    #[arg(short, long, value_name = "PICTURE")]
    pub output: PathBuf,
    #[command(flatten)]
    pub display: DisplayArgs,
    /// Print the film's hash as the last line of standard output
    #[arg(long)]
    pub hash: bool,
    /// Print only errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Runs `durer merge`.
pub fn run(args: &MergeArgs) -> Result<(), Failure> {
    let mut registry = FileRegistry::default();
    let read = |path: &PathBuf| {
        registry.register_input(path)?;
        Ok((path.display().to_string(), read_part(path)?))
    };
    let parts: Vec<_> = args.parts.iter().map(read).collect::<Result<_, Failure>>()?;
    let Some((_, first)) = parts.first() else { return Err(invalid_input("no parts to merge")) };
    let names: Vec<&str> = first.job().picture_names().collect();
    let target = Target::new(&args.output, &names, &mut registry)?;
    args.display.check_bits(target.format())?;
    let whole = merge(&parts).map_err(|error| invalid_input(error.to_string()))?;
    drop(parts);
    rejected(&whole.statistics(), None, args.quiet);
    let display = args.display.display_of(&whole, args.quiet)?;
    if target.save_colors(&whole, display, args.quiet)?.is_none() {
        output::save(&target.files(&whole.pictures().map_err(from_render_error)?, display)?, args.quiet)?;
    }
    if args.hash {
        print_line(&whole.hash().to_string());
    }
    Ok(())
}
