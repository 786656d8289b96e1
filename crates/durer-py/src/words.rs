//! The command: its options as a list, and itself.

use durer_cli::embed;
use pyo3::prelude::*;

/// The options of a render: name, help, what follows it, and the words that it takes.
#[pyfunction]
pub fn options() -> Vec<(String, String, Option<String>, Vec<String>)> {
    embed::options().into_iter().map(|option| (option.name, option.help, option.value, option.words)).collect()
}

/// Does what a command line says, whose first word is the program's name; gives the exit code. It
/// may end the process.
#[pyfunction]
pub fn command(py: Python, words: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| durer_cli::run(words, |code| std::process::exit(i32::from(code))))
}
