//! `durer merge`.

use crate::args::MergeArgs;
use crate::keep::read_part;
use crate::output::{Target, say};
use crate::render::{failure, rejected};
use crate::{Failure, bad, output};
use durer::image::Transfer;
use durer::render::merge;

pub fn run(args: &MergeArgs) -> Result<(), Failure> {
    let parts = args.parts.iter().map(|path| Ok((path.display().to_string(), read_part(path)?)));
    let parts: Vec<_> = parts.collect::<Result<_, Failure>>()?;
    let Some((_, first)) = parts.first() else { return Err(bad("there are no parts to merge")) };
    let names: Vec<&str> = first.job().picture_names().collect();
    let target = Target::new(args.output.clone(), &names)?;
    let whole = merge(&parts).map_err(|error| bad(error.to_string()))?;
    drop(parts);
    rejected(&whole.statistics(), args.quiet);
    let rendered = whole.pictures().map_err(failure)?;
    let transfer = Transfer::from_name(&args.transfer).unwrap_or_default();
    output::save(&target.files(&rendered, transfer)?, args.quiet)?;
    if args.hash {
        say(&whole.hash().to_string());
    }
    Ok(())
}
