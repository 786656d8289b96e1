//! The `durer` command-line program, which is a thin layer over the library.

mod args;
mod autosave;
mod check;
mod compare;
mod convert;
mod course;
mod denoise;
mod device;
mod diagrams;
mod display;
mod explain;
mod failure;
mod farm;
mod file_registry;
mod frames;
mod help;
mod info;
mod job;
mod large;
mod lesson;
mod live;
mod manual;
mod measure;
mod merge;
mod open;
mod option_hints;
mod options;
mod output;
mod page;
mod photo;
mod picture;
mod progress;
mod render;
mod report;
mod scene_defaults;
mod stats;
mod svg;
mod terminal;
mod terminal_picture;
mod values;
mod verify;
mod watching;
mod words;

use args::{Cli, Command};
use clap::{CommandFactory, FromArgMatches};
use failure::{Failure, invalid_input};
use std::ffi::OsString;
use std::io::IsTerminal;
use std::path::Path;

#[cfg(unix)]
pub use terminal::check_standard_output;

/// Executes a command line whose first word is the program's name, and returns the exit code.
/// Handles signals. `end` is called in order to end the process at once with an exit code. This
/// happens after a second Ctrl-C or if writing to standard output fails.
pub fn run(words: Vec<OsString>, end: terminal::ExitFn) -> u8 {
    terminal::set_end(end);
    progress::handle_signals();
    if let Err(error) = durer::bvh::SimdLevel::from_environment() {
        return invalid_input(error.to_string()).report();
    }
    if let Err(message) = durer::options::memory::check_address_space() {
        return Failure::Other(anyhow::anyhow!(message)).report();
    }
    if let Some(word) = words.iter().find(|word| word.as_encoded_bytes().iter().any(|b| matches!(b, b'\n' | b'\r'))) {
        return invalid_input(format!("{word:?} contains a line break; names and values must be on one line")).report();
    }
    durer::threads::prepare();
    // If `durer` is started under the name of an official program, it emulates that program.
    let name = words.first().cloned().unwrap_or_default();
    let name = Path::new(&name).file_stem().unwrap_or_default().to_string_lossy();
    let result = match course::program(&name) {
        Some(program) => words
            .into_iter()
            .skip(1)
            .map(|word| word.into_string().map_err(|word| invalid_input(format!("{word:?} is not UTF-8"))))
            .collect::<Result<_, _>>()
            .and_then(|arguments| course::run(arguments, Some(program))),
        None => match parsed(farm::own_options_first(explain::split_ray_argument(words))).command {
            Command::Render(args) => render::run(*args),
            Command::Farm(args) => farm::run(&args),
            Command::Merge(args) => merge::run(&args),
            Command::Verify(args) => verify::run(&args),
            Command::Explain(args) => explain::run(&args),
            Command::Lesson(args) => lesson::run(&args),
            Command::Live(args) => live::run(&args),
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
            Command::Man(args) => manual::man(&args),
        },
    };
    match result {
        Ok(()) => 0,
        Err(failure) => failure.report(),
    }
}

/// Parses a command line. Help is printed like other output, so that write errors are reported.
fn parsed(words: Vec<OsString>) -> Cli {
    let mut program = help::arrange(Cli::command(), words.iter().any(|word| word == "--help-all"));
    let matches = program.try_get_matches_from_mut(&words);
    matches.and_then(|matches| Cli::from_arg_matches(&matches)).unwrap_or_else(|error| {
        let error = option_hints::with_hint(error, &words, &program);
        let (rendered, code) = (error.render(), u8::try_from(error.exit_code()).unwrap_or(terminal::OTHER_FAILURE));
        let text = |is_terminal: bool| match is_terminal && terminal::has_styles() {
            true => rendered.ansi().to_string(),
            false => rendered.to_string(),
        };
        match error.use_stderr() {
            true => terminal::print_error_line(text(std::io::stderr().is_terminal()).trim_end()),
            false => terminal::print_line(text(std::io::stdout().is_terminal()).trim_end()),
        }
        terminal::end(code)
    })
}
