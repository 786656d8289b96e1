//! `durer convert`.

use crate::args::ConvertArgs;
use crate::guard::Guard;
use crate::open::load_options;
use crate::{Failure, output, report};
use durer::diag::{Diagnostics, Files};
use durer::dialect::Dialect;
use durer::format::course::write;
use durer::load;

pub fn run(args: &ConvertArgs) -> Result<(), Failure> {
    let mut guard = Guard::default();
    guard.reads(&args.scene)?;
    let place = guard.writes("--output", &args.output)?;
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let options = load_options(&args.reading);
    let loaded = load(&args.scene, &options, &mut files, &mut diagnostics).map_err(report::unreadable)?;
    report::print(&files, &diagnostics, false);
    let loaded = loaded.ok_or(Failure::Input(None))?;
    if let Some(guess) = &loaded.guess {
        report::note(&guess.note());
    }
    let dialect = args.to.as_deref().and_then(Dialect::from_name).unwrap_or(loaded.dialect);
    output::save(&[(&place, write(&loaded.scene, dialect).into_bytes())], false)
}
