//! Options as a list; and the command itself.

use durer::options::{OptionGroup, statements};
use pyo3::prelude::*;

/// An option: name, help, name of its value, the words that its value may be, and whether it concerns
/// `reading`, the `picture` or the `work`.
type Statement = (&'static str, String, Option<String>, Vec<&'static str>, &'static str);

/// The options of a render.
#[pyfunction]
pub fn options() -> Vec<Statement> {
    let group = |group| match group {
        OptionGroup::Reading => "reading",
        OptionGroup::Picture => "picture",
        OptionGroup::Work => "work",
    };
    statements().into_iter().map(|o| (o.name, o.help, o.value, o.words, group(o.group))).collect()
}

/// Runs the command with the words of a command line, the first of which is the program's name, and
/// returns the exit code. It may end the process.
#[pyfunction]
pub fn command(py: Python, words: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| durer_cli::run(words, |code| std::process::exit(i32::from(code))))
}
