//! Implements `durer photo`, which computes cameras and points from photographs.

mod args;
mod camera;
mod explain;
mod inputs;
mod matching;
mod place;
mod results;
mod solve;
mod tour;

pub use args::PhotoArgs;

use crate::failure::Failure;
use crate::file_registry::FileRegistry;
use args::PhotoCommand;
use inputs::read;
use results::{Results, report};

/// Runs the subcommands of `durer photo`.
pub fn run(args: &PhotoArgs) -> Result<(), Failure> {
    match &args.command {
        PhotoCommand::Match(args) => matching::run(args),
        PhotoCommand::Solve(args) => solve::run(args),
        PhotoCommand::Camera(args) => camera::run(args),
        PhotoCommand::Place(args) => place::run(args),
        PhotoCommand::Explain(args) => explain::run(args),
        PhotoCommand::Convert(args) => {
            let mut registry = FileRegistry::default();
            let mut results = Results::new(&args.results, &mut registry)?;
            let all = read(&args.file, args.pictures.as_deref(), &mut registry)?;
            results.add(&all)?;
            results.save(args.quiet)?;
            if !args.quiet {
                report(&all);
            }
            Ok(())
        }
        PhotoCommand::Tour(args) => tour::run(args),
    }
}
