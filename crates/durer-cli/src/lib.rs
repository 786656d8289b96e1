//! The `durer` command: a thin shell over the library; and, for other programs, its options
//! ([`embed`]).

mod args;
mod check;
mod compare;
mod convert;
mod course;
mod denoise;
mod diagrams;
mod display;
pub mod embed;
mod explain;
mod farm;
mod frames;
mod guard;
mod info;
mod job;
mod keep;
mod large;
mod lesson;
mod manual;
mod measure;
mod memory;
mod merge;
mod method;
mod open;
mod output;
mod page;
mod photo;
mod progress;
mod render;
mod report;
mod staging;
mod stats;
mod verify;
mod watching;
mod words;

use args::{Cli, Command};
use clap::Parser;
use std::ffi::OsString;
use std::path::Path;

/// Exit code after a scene, an option or another input that is wrong.
const BAD_INPUT: u8 = 2;
/// Exit code after anything else that failed.
const OTHER_FAILURE: u8 = 1;
/// Exit code of `durer compare` after pictures that differ: as of `cmp` and `diff`, whose 2 says
/// that something is wrong.
const DIFFERENT: u8 = 1;
/// Exit code of `durer check` after findings.
const FOUND: u8 = 1;

/// Does what a command line says, whose first word is the name of the program; gives the exit code.
/// It hears signals, and may end the process.
pub fn run(words: Vec<OsString>) -> u8 {
    progress::hear_interrupts();
    if let Err(error) = durer::bvh::SimdLevel::from_environment() {
        return bad(error.to_string()).report();
    }
    durer::threads::prepare();
    // Under the name of an official program, `durer` is that program.
    let name = words.first().cloned().unwrap_or_default();
    let name = Path::new(&name).file_stem().unwrap_or_default().to_string_lossy();
    let result = match course::program(&name) {
        Some(program) => words
            .into_iter()
            .skip(1)
            .map(|word| word.into_string().map_err(|word| bad(format!("{word:?} is not UTF-8"))))
            .collect::<Result<_, _>>()
            .and_then(|arguments| course::run(arguments, Some(program))),
        None => match Cli::parse_from(words).command {
            Command::Render(args) => render::run(*args),
            Command::Farm(args) => farm::run(&args),
            Command::Merge(args) => merge::run(&args),
            Command::Verify(args) => verify::run(&args),
            Command::Explain(args) => explain::run(&args),
            Command::Lesson(args) => lesson::run(&args),
            Command::Course(args) => course::run(args.arguments, None),
            Command::Check(args) => check::run(&args),
            Command::Info(args) => info::run(&args),
            Command::Measure(args) => measure::run(&args),
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
        Ok(()) => 0,
        Err(failure) => failure.report(),
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
