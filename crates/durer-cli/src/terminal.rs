//! Lines on standard output and on standard error.

use std::io::{ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Exit code after anything that failed but a wrong input: standard output among that.
pub const OTHER_FAILURE: u8 = 1;

/// Whether the program was started without a standard output.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Finds that out. It has to be before the standard library begins, which then puts the device in
/// its place that swallows everything.
#[cfg(unix)]
#[ctor::ctor(unsafe)]
fn look_at_standard_output() {
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
            std::process::exit(i32::from(OTHER_FAILURE));
        }
        _ => {}
    }
}

/// A line on standard error; where that is closed, there is nobody to tell.
pub fn complain(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
