//! The `durer` command: a thin shell over the library.

mod args;
mod check;
mod compare;
mod convert;
mod course;
mod diagrams;
mod explain;
mod guard;
mod info;
mod job;
mod keep;
mod lesson;
mod manual;
mod memory;
mod merge;
mod open;
mod output;
mod page;
mod photo;
mod progress;
mod render;
mod report;
mod verify;
mod words;

use args::{Cli, Command};
use clap::Parser;
use std::path::Path;
use std::process::ExitCode;

/// Exit code after a scene, an option or another input that is wrong.
const BAD_INPUT: u8 = 2;
/// Exit code after anything else that failed.
const OTHER_FAILURE: u8 = 1;
/// Exit code of `durer compare` after pictures that differ: as of `cmp` and `diff`, whose 2 says that something is wrong.
const DIFFERENT: u8 = 1;
/// Exit code of `durer check` after findings.
const FOUND: u8 = 1;

fn main() -> ExitCode {
    progress::hear_interrupts();
    if let Err(error) = durer::bvh::Level::from_environment() {
        return ExitCode::from(bad(error.to_string()).report());
    }
    durer::threads::prepare();
    // Under the name of an official program, `durer` is that program.
    let mut words = std::env::args_os();
    let name = words.next().unwrap_or_default();
    let name = Path::new(&name).file_stem().unwrap_or_default().to_string_lossy();
    let result = match course::program(&name) {
        Some(program) => words
            .map(|word| word.into_string().map_err(|word| bad(format!("{word:?} is not UTF-8"))))
            .collect::<Result<_, _>>()
            .and_then(|arguments| course::run(arguments, Some(program))),
        None => match Cli::parse().command {
            Command::Render(args) => render::run(&args),
            Command::Merge(args) => merge::run(&args),
            Command::Verify(args) => verify::run(&args),
            Command::Explain(args) => explain::run(&args),
            Command::Lesson(args) => lesson::run(&args),
            Command::Course(args) => course::run(args.arguments, None),
            Command::Check(args) => check::run(&args),
            Command::Info(args) => info::run(&args),
            Command::Convert(args) => convert::run(&args),
            Command::Compare(args) => compare::run(&args),
            Command::Photo(args) => photo::run(&args),
            Command::Dialects => manual::dialects(),
            Command::Words(args) => words::run(&args),
            Command::Completions { shell } => manual::completions(shell),
            Command::Man => manual::man(),
        },
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => ExitCode::from(failure.report()),
    }
}

/// Why a command did not do its work.
enum Failure {
    /// The input is wrong; diagnostics were printed, or the message says why.
    Input(Option<String>),
    /// Something else went wrong.
    Other(anyhow::Error),
    /// `durer compare` found pictures that differ, and has said so.
    Different,
    /// `durer check` has found something, and has said so.
    Found,
    /// The user stopped it; says what became of the work.
    Interrupted(String),
}

impl Failure {
    /// Says it, and gives the exit code.
    fn report(self) -> u8 {
        match self {
            Failure::Input(message) => {
                if let Some(message) = message {
                    report::complain(&format!("error: {message}"));
                }
                BAD_INPUT
            }
            Failure::Other(error) => {
                report::complain(&format!("error: {error}"));
                OTHER_FAILURE
            }
            Failure::Different => DIFFERENT,
            Failure::Found => FOUND,
            Failure::Interrupted(what) => {
                report::complain(&format!("interrupted; {what}"));
                progress::interrupted()
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
