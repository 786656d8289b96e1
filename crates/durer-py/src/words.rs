//! The list of render options, and the `durer` command itself.

use durer::options::{OptionGroup, option_descriptions};
use pyo3::prelude::*;

/// Render option as passed to Python: its name, help, name of its value, allowed values, and group:
/// `reading`, `picture` or `work`.
type OptionInfo = (&'static str, String, Option<String>, Vec<&'static str>, &'static str);

/// Returns all render options.
#[pyfunction]
pub fn options() -> Vec<OptionInfo> {
    let group = |group| match group {
        OptionGroup::Loading => "reading",
        OptionGroup::Picture => "picture",
        OptionGroup::Execution => "work",
    };
    option_descriptions().into_iter().map(|o| (o.name, o.help, o.value, o.words, group(o.group))).collect()
}

/// Runs the command with the words of a command line, beginning with the program's name, and
/// returns the exit code. Some commands end the process instead.
#[pyfunction]
pub fn command(py: Python, words: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| durer_cli::run(words, |code| std::process::exit(i32::from(code))))
}
