//! Content to be written to files and streams.

use std::io::{self, Write};

/// Content of a file to be saved, which is either bytes or a value that is serialised while it is
/// written.
pub trait Content {
    /// Writes the entire content to `out`.
    ///
    /// # Errors
    /// Returns the errors that `out` reports.
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()>;
}

impl<B: AsRef<[u8]>> Content for B {
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(self.as_ref())
    }
}
