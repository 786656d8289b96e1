//! Why a command did not do its work, and the exit codes of that.

use crate::terminal::{OTHER_FAILURE, complain};
use durer::render::RenderError;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// Exit code after a scene, an option or another input that is wrong.
const BAD_INPUT: u8 = 2;
/// Exit code of `durer compare` after pictures that differ: as of `cmp` and `diff`, whose 2 says
/// that something is wrong.
const DIFFERENT: u8 = 1;
/// Exit code of `durer check` after findings.
const FOUND: u8 = 1;

/// The last signal's number: 2 is that of Ctrl-C.
static SIGNAL: AtomicU8 = AtomicU8::new(2);

/// A signal has interrupted the work: the exit code tells which, 130 after Ctrl-C, as shells have
/// it.
pub fn interrupted_by(signal: u8) {
    SIGNAL.store(signal, Relaxed);
}

/// Why a command did not do its work.
pub enum Failure {
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
    pub fn report(self) -> u8 {
        match self {
            Failure::Input(message) => {
                if let Some(message) = message {
                    complain(&format!("error: {message}"));
                }
                BAD_INPUT
            }
            Failure::Other(error) => {
                complain(&format!("error: {error}"));
                OTHER_FAILURE
            }
            Failure::Different => DIFFERENT,
            Failure::Found => FOUND,
            Failure::Interrupted(what) => {
                complain(&format!("interrupted; {what}"));
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

/// A wrong input that a message explains.
pub fn bad(message: impl Into<String>) -> Failure {
    Failure::Input(Some(message.into()))
}

/// What a failed render means for the shell.
pub fn failed(error: RenderError) -> Failure {
    match error {
        RenderError::Cancelled => Failure::Interrupted("nothing was written".into()),
        RenderError::Panic(_) => error.into(),
        RenderError::Memory { .. } => bad(format!("{error}; see --memory")),
        _ => bad(error.to_string()),
    }
}
