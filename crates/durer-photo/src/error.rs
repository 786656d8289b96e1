//! Error type of this crate.

use std::fmt;

/// Error of any operation in this crate. It contains a message, and optionally the file, line, and
/// column to which it refers.
#[derive(Debug, Clone, PartialEq)]
pub struct Error {
    /// Description of the problem as a sentence without a final full stop.
    pub message: String,
    /// File as named by the user; empty if the error does not refer to a file.
    pub file: String,
    /// Line and column in a text file, counted from 1.
    pub position: Option<(usize, usize)>,
}

impl Error {
    /// Creates an error that does not refer to a file.
    pub fn new(message: impl Into<String>) -> Self {
        Error { message: message.into(), file: String::new(), position: None }
    }

    /// Creates an error that refers to an entire file.
    pub fn in_file(file: &str, message: impl Into<String>) -> Self {
        Error { message: message.into(), file: file.into(), position: None }
    }

    /// Creates an error at a position in a text file.
    pub fn at(file: &str, place: (usize, usize), message: impl Into<String>) -> Self {
        Error { message: message.into(), file: file.into(), position: Some(place) }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.file.is_empty(), self.position) {
            (true, _) => write!(f, "{}", self.message),
            (false, None) => write!(f, "{}: {}", self.file, self.message),
            (false, Some((line, column))) => write!(f, "{}:{line}:{column}: {}", self.file, self.message),
        }
    }
}

impl std::error::Error for Error {}
