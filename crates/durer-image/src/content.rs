//! Content that is written to files and streams.

use std::io::{self, Write};

/// Content of a file to save: bytes, or a value that is serialised while it is written.
pub trait Content {
    /// Writes the whole content to `out`.
    ///
    /// # Errors
    /// Errors of `out`.
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()>;
}

impl<B: AsRef<[u8]>> Content for B {
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(self.as_ref())
    }
}
