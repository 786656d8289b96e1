//! List of render options, and the `durer` command itself.

use durer::options::{OptionGroup, option_descriptions};
use pyo3::prelude::*;

/// Render option as passed to Python. It contains the option's name and help, the name of its
/// value, its allowed values, and its group, which is `reading`, `picture` or `work`.
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

/// Runs the command with the words of a command line, which begin with the name of the program.
/// Returns the exit code. Some commands end the process instead.
#[pyfunction]
pub fn command(py: Python, words: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| durer_cli::run(words, |code| std::process::exit(i32::from(code))))
}
