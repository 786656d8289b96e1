//! Lines on standard output and on standard error.

use std::io::{ErrorKind, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Exit code after anything that failed but a wrong input: standard output among that.
pub const OTHER_FAILURE: u8 = 1;

/// Whether the program was started without a standard output.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Ends the program with an exit code.
pub type End = fn(u8) -> !;

/// How the program ends before its work is done.
static END: OnceLock<End> = OnceLock::new();

/// Sets how the program ends; the first call counts.
pub fn set_end(end: End) {
    let _ = END.set(end);
}

/// Ends the program.
///
/// # Panics
///
/// If nobody said how: see [`set_end`].
pub fn end(code: u8) -> ! {
    match END.get() {
        Some(end) => end(code),
        None => panic!("the program would end with exit code {code}"),
    }
}

/// Finds out whether there is a standard output.
#[cfg(unix)]
pub fn look_at_standard_output() {
    CLOSED.store(rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_err(), Relaxed);
}

/// Whether there is a standard output.
pub fn has_standard_output() -> bool {
    !CLOSED.load(Relaxed)
}

/// A line on standard output. A closed pipe is nobody's fault: who closed it has read enough.
pub fn say(line: &str) {
    let written = match has_standard_output() {
        true => writeln!(std::io::stdout(), "{line}"),
        false => Err(std::io::Error::other("it is closed")),
    };
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            complain(&format!("error: cannot write to standard output: {error}"));
            end(OTHER_FAILURE);
        }
        _ => {}
    }
}

/// A line on standard error; where that is closed, there is nobody to tell.
pub fn complain(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
