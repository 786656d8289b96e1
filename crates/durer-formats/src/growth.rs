//! Limits on the objects and bytes that a reader creates from a file, which can be much more than
//! the file contains. Readers count both here before they allocate memory.

use crate::shared_report::SharedReport;
use durer_diag::{Span, format_bytes_down};
use std::cell::Cell;

/// Maximum number of objects in a scene, counting those of each instance.
pub(crate) const MAX_OBJECTS: usize = 1 << 20;
/// Memory in bytes that every file may use, and additional memory per byte of the file.
const FREE: u64 = 256 << 20;
const TIMES: u64 = 64;

/// Counters of the objects and of the memory that a reader creates from one file, with their
/// limits.
pub(crate) struct Growth {
    objects: Cell<usize>,
    /// Remaining bytes.
    left: Cell<u64>,
    /// Current limit in bytes, and the maximum of that limit.
    limit: Cell<u64>,
    memory: u64,
    is_over: Cell<bool>,
}

/// Error: a reader exceeded its limit of objects or memory.
#[derive(Debug)]
pub(crate) struct TooMuch {
    pub message: String,
    /// True for the first error. Later ones need not be reported.
    pub is_first: bool,
}

impl Growth {
    /// Creates counters with a fixed memory limit in bytes.
    pub fn within(memory: u64) -> Self {
        let [left, limit] = [Cell::new(memory), Cell::new(memory)];
        Growth { objects: Cell::new(0), left, limit, memory, is_over: Cell::new(false) }
    }

    /// Creates counters for a file of `length` bytes. The memory limit is in proportion to the
    /// length, and at most `memory`.
    pub fn of_file(length: usize, memory: u64) -> Self {
        let growth = Growth::within(memory.min(FREE));
        let growth = Growth { memory, ..growth };
        growth.feed(length);
        growth
    }

    /// Raises the limit in proportion to another `length` bytes.
    pub fn feed(&self, length: usize) {
        let more = TIMES.saturating_mul(length as u64).min(self.memory - self.limit.get());
        self.left.set(self.left.get() + more);
        self.limit.set(self.limit.get() + more);
    }

    /// Counts objects; returns an error if they are too many.
    pub fn objects(&self, more: usize) -> Result<(), TooMuch> {
        self.objects.set(self.objects.get().saturating_add(more));
        match self.objects.get() <= MAX_OBJECTS {
            true => Ok(()),
            false => {
                Err(self.over(format!("too many objects: more than {MAX_OBJECTS}, counting those of every instance")))
            }
        }
    }

    /// Returns the number of objects so far.
    pub fn object_count(&self) -> usize {
        self.objects.get()
    }

    /// Returns the number of remaining bytes.
    pub fn left(&self) -> u64 {
        self.left.get()
    }

    /// Counts `count` items of `size` bytes each; returns an error if they exceed the limit.
    pub fn bytes(&self, count: usize, size: usize) -> Result<(), TooMuch> {
        let left = self.left.get().checked_sub((count as u64).saturating_mul(size as u64));
        self.left.set(left.unwrap_or(0));
        let limit = format_bytes_down(self.limit.get());
        left.map(|_| ()).ok_or_else(|| self.over(format!("reading this file needs more memory than {limit}")))
    }

    fn over(&self, message: String) -> TooMuch {
        TooMuch { message, is_first: !self.is_over.replace(true) }
    }

    /// Counts objects; reports an error and returns false if they are too many.
    pub fn has_objects(&self, more: usize, messages: &SharedReport, at: Span) -> bool {
        report(self.objects(more), messages, at)
    }

    /// Counts bytes; reports an error and returns false if they are too many.
    pub fn has_bytes(&self, count: usize, size: usize, messages: &SharedReport, at: Span) -> bool {
        report(self.bytes(count, size), messages, at)
    }
}

fn report(result: Result<(), TooMuch>, messages: &SharedReport, at: Span) -> bool {
    if let Err(TooMuch { message, is_first: true }) = &result {
        messages.bad(at, message);
    }
    result.is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_grows_is_limited_by_the_file_and_by_memory() {
        let growth = Growth::within(1000);
        assert!(growth.bytes(10, 100).is_ok());
        let error = growth.bytes(1, 1).unwrap_err();
        assert!(error.is_first && error.message.ends_with("than 1000 bytes"), "{error:?}");
        assert!(!growth.bytes(usize::MAX, usize::MAX).unwrap_err().is_first);
        let growth = Growth::of_file(10, u64::MAX);
        assert!(growth.bytes(1, (FREE + 10 * TIMES) as usize).is_ok() && growth.bytes(1, 1).is_err());
        growth.feed(1);
        // The failed request used up the rest.
        assert!(growth.bytes(1, TIMES as usize).is_ok() && growth.bytes(1, 1).is_err());
        assert!(Growth::of_file(usize::MAX, 5).bytes(6, 1).is_err());
        let growth = Growth::within(0);
        assert!(
            growth.objects(MAX_OBJECTS).is_ok() && growth.objects(1).is_err() && growth.objects(usize::MAX).is_err()
        );
        assert_eq!(growth.object_count(), usize::MAX);
    }
}
