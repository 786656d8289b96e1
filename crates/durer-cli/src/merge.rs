//! `durer merge`.

use crate::args::MergeArgs;
use crate::guard::Guard;
use crate::keep::read_part;
use crate::output::{Target, say};
use crate::render::{failure, rejected};
use crate::{Failure, bad, output};
use durer::render::merge;
use std::path::PathBuf;

pub fn run(args: &MergeArgs) -> Result<(), Failure> {
    let mut guard = Guard::default();
    let read = |path: &PathBuf| {
        guard.reads(path)?;
        Ok((path.display().to_string(), read_part(path)?))
    };
    let parts: Vec<_> = args.parts.iter().map(read).collect::<Result<_, Failure>>()?;
    let Some((_, first)) = parts.first() else { return Err(bad("there are no parts to merge")) };
    let names: Vec<&str> = first.job().picture_names().collect();
    let target = Target::new(&args.output, &names, &mut guard)?;
    let whole = merge(&parts).map_err(|error| bad(error.to_string()))?;
    drop(parts);
    rejected(&whole.statistics(), args.quiet);
    let rendered = whole.pictures().map_err(failure)?;
    output::save(&target.files(&rendered, args.display.display()?)?, args.quiet)?;
    if args.hash {
        say(&whole.hash().to_string());
    }
    Ok(())
}
