//! Prints lines on standard output and standard error.

use std::io::{ErrorKind, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Exit code of all failures except invalid input. It includes failures to write to standard
/// output.
pub const OTHER_FAILURE: u8 = 1;

/// True if the program was started without a standard output.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Type of function that ends the program with an exit code.
pub type ExitFn = fn(u8) -> !;

/// Function that ends the program early. See [`set_end`].
static END: OnceLock<ExitFn> = OnceLock::new();

/// Sets the function that ends the program. Only the first call has an effect.
pub fn set_end(end: ExitFn) {
    let _ = END.set(end);
}

/// Ends the program with an exit code.
///
/// # Panics
///
/// Panics if [`set_end`] was not called.
pub fn end(code: u8) -> ! {
    match END.get() {
        Some(end) => end(code),
        None => panic!("the program would end with exit code {code}"),
    }
}

/// Records whether the program was started with a standard output.
#[cfg(unix)]
pub fn check_standard_output() {
    CLOSED.store(rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_err(), Relaxed);
}

/// Returns true if there is a standard output.
pub fn has_standard_output() -> bool {
    !CLOSED.load(Relaxed)
}

/// Prints a line on standard output. A closed pipe is not an error because the reader already has
/// all that it needs.
pub fn print_line(line: &str) {
    let written = match has_standard_output() {
        true => writeln!(std::io::stdout(), "{line}"),
        false => Err(std::io::Error::other("the stream is closed")),
    };
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            print_error_line(&format!("error: cannot write to standard output: {error}"));
            end(OTHER_FAILURE);
        }
        _ => {}
    }
}

/// Prints a line on standard error. Errors are ignored because there is nowhere to report them.
pub fn print_error_line(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
