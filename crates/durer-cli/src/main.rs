//! The `durer` command: a thin shell over the library.

mod args;
mod convert;
mod course;
mod info;
mod manual;
mod output;
mod progress;
mod render;
mod report;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

/// Exit code after a scene, an option or another input that is wrong.
const BAD_INPUT: u8 = 2;
/// Exit code after Ctrl-C.
const INTERRUPTED: u8 = 130;

fn main() -> ExitCode {
    // Under the name of an official program, `durer` is that program.
    let name = std::env::args().next().unwrap_or_default();
    let name = std::path::Path::new(&name).file_stem().and_then(|stem| stem.to_str()).unwrap_or_default().to_string();
    let result = match course::program(&name) {
        Some(program) => course::run(std::env::args().skip(1).collect(), Some(program)),
        None => match Cli::parse().command {
            Command::Render(args) => render::run(&args),
            Command::Course(args) => course::run(args.arguments, None),
            Command::Info(args) => info::run(&args),
            Command::Convert(args) => convert::run(&args),
            Command::Dialects => manual::dialects(),
            Command::Completions { shell } => manual::completions(shell),
            Command::Man => manual::man(),
        },
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.exit(),
    }
}

/// Why a command did not do its work.
enum Failure {
    /// The input is wrong; diagnostics were printed, or the message says why.
    Input(Option<String>),
    /// Something else went wrong.
    Other(anyhow::Error),
    /// The user stopped it.
    Interrupted,
}

impl Failure {
    fn exit(self) -> ExitCode {
        match self {
            Failure::Input(message) => {
                if let Some(message) = message {
                    eprintln!("error: {message}");
                }
                ExitCode::from(BAD_INPUT)
            }
            Failure::Other(error) => {
                eprintln!("error: {error:#}");
                ExitCode::FAILURE
            }
            Failure::Interrupted => {
                eprintln!("interrupted; nothing was written");
                ExitCode::from(INTERRUPTED)
            }
        }
    }
}

impl<E: Into<anyhow::Error>> From<E> for Failure {
    fn from(error: E) -> Self {
        Failure::Other(error.into())
    }
}

/// A wrong input that a message explains.
fn bad(message: impl Into<String>) -> Failure {
    Failure::Input(Some(message.into()))
}
