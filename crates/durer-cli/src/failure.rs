//! Failures of commands, and their exit codes.

use crate::terminal::{OTHER_FAILURE, print_error_line};
use durer::render::RenderError;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// Exit code for an invalid scene, an invalid option or other invalid input.
const BAD_INPUT: u8 = 2;
/// Exit code of `durer compare` if the pictures differ. As with `cmp` and `diff`, 1 means
/// differences and 2 means errors.
const DIFFERENT: u8 = 1;
/// Exit code of `durer check` if it reports warnings or errors.
const FINDINGS: u8 = 1;

/// Number of the last signal. Ctrl-C is signal 2.
static SIGNAL: AtomicU8 = AtomicU8::new(2);

/// Records the signal that interrupted the work. As in shells, the exit code is 128 plus the number
/// of the signal, which is 130 for Ctrl-C.
pub fn interrupted_by(signal: u8) {
    SIGNAL.store(signal, Relaxed);
}

/// Reason for the failure of a command. It determines the message and the exit code.
pub enum Failure {
    /// The input is invalid. Either diagnostics were already printed, or the message gives the
    /// reason.
    Input(Option<String>),
    /// Any other error.
    Other(anyhow::Error),
    /// `durer compare` found differences, which have already been printed.
    Different,
    /// `durer check` found problems, which have already been printed.
    FindingsReported,
    /// The user interrupted the work. The message says what was saved.
    Interrupted(String),
}

impl Failure {
    /// Prints a message about the failure and returns the exit code.
    pub fn report(self) -> u8 {
        match self {
            Failure::Input(message) => {
                if let Some(message) = message {
                    print_error_line(&format!("error: {message}"));
                }
                BAD_INPUT
            }
            Failure::Other(error) => {
                print_error_line(&format!("error: {error}"));
                OTHER_FAILURE
            }
            Failure::Different => DIFFERENT,
            Failure::FindingsReported => FINDINGS,
            Failure::Interrupted(what) => {
                print_error_line(&format!("interrupted; {what}"));
                128 + SIGNAL.load(Relaxed)
            }
        }
    }
}

impl<E: Into<anyhow::Error>> From<E> for Failure {
    fn from(error: E) -> Self {
        Failure::Other(error.into())
    }
}

/// Returns a failure for invalid input.
pub fn invalid_input(message: impl Into<String>) -> Failure {
    Failure::Input(Some(message.into()))
}

/// Converts a render error into a failure.
pub fn from_render_error(error: RenderError) -> Failure {
    match error {
        RenderError::Cancelled => Failure::Interrupted("nothing was written".into()),
        RenderError::Panic(_) => error.into(),
        RenderError::Memory { .. } | RenderError::NoMemory(_) => invalid_input(format!("{error}; see --memory")),
        _ => invalid_input(error.to_string()),
    }
}
