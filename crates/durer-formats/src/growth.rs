//! Growth of a file: what a reader makes of it that may be far larger than it. Readers count
//! objects and bytes here before they make them.

use crate::shared_report::SharedReport;
use durer_diag::{Span, at_most};
use std::cell::Cell;

/// Maximum number of objects in a scene, those of instances counted each time.
pub(crate) const MAX_OBJECTS: usize = 1 << 20;
/// Bytes that any file may grow to, and further bytes for each byte of the file.
const FREE: u64 = 256 << 20;
const TIMES: u64 = 64;

/// Counters of what was made of a file.
pub(crate) struct Growth {
    objects: Cell<usize>,
    /// Remaining bytes.
    left: Cell<u64>,
    /// Limit on bytes, and the limit that it never exceeds.
    limit: Cell<u64>,
    memory: u64,
    is_over: Cell<bool>,
}

/// A limit was exceeded.
#[derive(Debug)]
pub(crate) struct TooMuch {
    pub message: String,
    /// True the first time; one message is enough.
    pub is_first: bool,
}

impl Growth {
    /// Growth within a memory limit in bytes.
    pub fn within(memory: u64) -> Self {
        let [left, limit] = [Cell::new(memory), Cell::new(memory)];
        Growth { objects: Cell::new(0), left, limit, memory, is_over: Cell::new(false) }
    }

    /// Growth of a file of some length, in proportion to it and within a memory limit.
    pub fn of_file(length: usize, memory: u64) -> Self {
        let growth = Growth::within(memory.min(FREE));
        let growth = Growth { memory, ..growth };
        growth.feed(length);
        growth
    }

    /// Adds the bytes of a file to those that may grow.
    pub fn feed(&self, length: usize) {
        let more = TIMES.saturating_mul(length as u64).min(self.memory - self.limit.get());
        self.left.set(self.left.get() + more);
        self.limit.set(self.limit.get() + more);
    }

    /// Counts objects.
    pub fn objects(&self, more: usize) -> Result<(), TooMuch> {
        self.objects.set(self.objects.get().saturating_add(more));
        match self.objects.get() <= MAX_OBJECTS {
            true => Ok(()),
            false => {
                Err(self.over(format!("more than {MAX_OBJECTS} objects, those of instances counted, are too many")))
            }
        }
    }

    /// Number of objects so far.
    pub fn object_count(&self) -> usize {
        self.objects.get()
    }

    /// Remaining bytes.
    pub fn left(&self) -> u64 {
        self.left.get()
    }

    /// Counts `count` things of `size` bytes each.
    pub fn bytes(&self, count: usize, size: usize) -> Result<(), TooMuch> {
        let left = self.left.get().checked_sub((count as u64).saturating_mul(size as u64));
        self.left.set(left.unwrap_or(0));
        let limit = at_most(self.limit.get());
        left.map(|_| ()).ok_or_else(|| self.over(format!("what this file makes needs more memory than {limit}")))
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
        // The failed byte was taken.
        assert!(growth.bytes(1, TIMES as usize).is_ok() && growth.bytes(1, 1).is_err());
        assert!(Growth::of_file(usize::MAX, 5).bytes(6, 1).is_err());
        let growth = Growth::within(0);
        assert!(
            growth.objects(MAX_OBJECTS).is_ok() && growth.objects(1).is_err() && growth.objects(usize::MAX).is_err()
        );
        assert_eq!(growth.object_count(), usize::MAX);
    }
}
