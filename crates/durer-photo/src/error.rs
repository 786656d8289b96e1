//! What is wrong with an input, and where.

use std::fmt;

/// A message, with the place in a file where there is one.
#[derive(Debug, Clone, PartialEq)]
pub struct Error {
    /// What is wrong, as a sentence without its full stop.
    pub message: String,
    /// The file, as the user named it; empty where no file is to blame.
    pub file: String,
    /// Line and column, counted from 1, in a text.
    pub place: Option<(usize, usize)>,
}

impl Error {
    /// An error of no file in particular.
    pub fn new(message: impl Into<String>) -> Self {
        Error { message: message.into(), file: String::new(), place: None }
    }

    /// An error in a file as a whole.
    pub fn of(file: &str, message: impl Into<String>) -> Self {
        Error { message: message.into(), file: file.into(), place: None }
    }

    /// An error at a place of a text.
    pub fn at(file: &str, place: (usize, usize), message: impl Into<String>) -> Self {
        Error { message: message.into(), file: file.into(), place: Some(place) }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.file.is_empty(), self.place) {
            (true, _) => write!(f, "{}", self.message),
            (false, None) => write!(f, "{}: {}", self.file, self.message),
            (false, Some((line, column))) => write!(f, "{}:{line}:{column}: {}", self.file, self.message),
        }
    }
}

impl std::error::Error for Error {}
