//! Limits on the number of objects and bytes that a reader creates from a file, because a small
//! file can describe much more than it contains. Readers count objects and bytes here before they
//! allocate memory.

use crate::shared_report::SharedReport;
use durer_diag::{Span, format_bytes_down};
use std::cell::Cell;

/// Maximum number of objects in a scene; the objects of each instance are counted separately.
pub(crate) const MAX_OBJECTS: usize = 1 << 20;
/// Memory in bytes that any file may use, and the additional memory allowed per byte of the file.
const FREE_BYTES: u64 = 256 << 20;
const TIMES: u64 = 64;

/// Counters for the objects and the memory that a reader creates from one file, with their limits.
pub(crate) struct ResourceLimits {
    objects: Cell<usize>,
    /// Number of bytes that may still be used.
    left: Cell<u64>,
    /// Current limit in bytes, and the maximum to which this limit can be raised.
    limit: Cell<u64>,
    memory: u64,
    is_over: Cell<bool>,
}

/// Error that a reader returns when it exceeds its limit of objects or memory.
#[derive(Debug)]
pub(crate) struct LimitExceeded {
    pub message: String,
    /// True for the first error of this kind. Later errors need not be reported.
    pub is_first: bool,
}

impl ResourceLimits {
    /// Creates counters with a fixed memory limit in bytes.
    pub fn with_memory(memory: u64) -> Self {
        let [left, limit] = [Cell::new(memory), Cell::new(memory)];
        ResourceLimits { objects: Cell::new(0), left, limit, memory, is_over: Cell::new(false) }
    }

    /// Creates counters for a file of `length` bytes. The memory limit is proportional to the
    /// length of the file, but not more than `memory`.
    pub fn of_file(length: usize, memory: u64) -> Self {
        let limits = ResourceLimits::with_memory(memory.min(FREE_BYTES));
        let limits = ResourceLimits { memory, ..limits };
        limits.add_input(length);
        limits
    }

    /// Raises the limit in proportion to `length` additional bytes.
    pub fn add_input(&self, length: usize) {
        let more = TIMES.saturating_mul(length as u64).min(self.memory - self.limit.get());
        self.left.set(self.left.get() + more);
        self.limit.set(self.limit.get() + more);
    }

    /// Counts objects and returns an error if there are too many.
    pub fn objects(&self, more: usize) -> Result<(), LimitExceeded> {
        self.objects.set(self.objects.get().saturating_add(more));
        match self.objects.get() <= MAX_OBJECTS {
            true => Ok(()),
            false => {
                Err(self
                    .over(format!("the scene has more than {MAX_OBJECTS} objects, counting those of every instance")))
            }
        }
    }

    /// Returns the number of objects counted so far.
    pub fn object_count(&self) -> usize {
        self.objects.get()
    }

    /// Returns the number of bytes that may still be used.
    pub fn left(&self) -> u64 {
        self.left.get()
    }

    /// Counts `count` items of `size` bytes each and returns an error if they exceed the limit.
    pub fn bytes(&self, count: usize, size: usize) -> Result<(), LimitExceeded> {
        let left = self.left.get().checked_sub((count as u64).saturating_mul(size as u64));
        self.left.set(left.unwrap_or(0));
        let limit = format_bytes_down(self.limit.get());
        left.map(|_| ()).ok_or_else(|| self.over(format!("reading this file needs more memory than {limit}")))
    }

    fn over(&self, message: String) -> LimitExceeded {
        LimitExceeded { message, is_first: !self.is_over.replace(true) }
    }

    /// Counts objects; if there are too many, reports an error and returns false.
    pub fn count_objects_or_report(&self, more: usize, messages: &SharedReport, at: Span) -> bool {
        report(self.objects(more), messages, at)
    }

    /// Counts bytes; if there are too many, reports an error and returns false.
    pub fn count_bytes_or_report(&self, count: usize, size: usize, messages: &SharedReport, at: Span) -> bool {
        report(self.bytes(count, size), messages, at)
    }
}

fn report(result: Result<(), LimitExceeded>, messages: &SharedReport, at: Span) -> bool {
    if let Err(LimitExceeded { message, is_first: true }) = &result {
        messages.error(at, message);
    }
    result.is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_and_memory_are_limited() {
        let limits = ResourceLimits::with_memory(1000);
        assert!(limits.bytes(10, 100).is_ok());
        let error = limits.bytes(1, 1).unwrap_err();
        assert!(error.is_first && error.message.ends_with("than 1000 bytes"), "{error:?}");
        assert!(!limits.bytes(usize::MAX, usize::MAX).unwrap_err().is_first);
        let limits = ResourceLimits::of_file(10, u64::MAX);
        assert!(limits.bytes(1, (FREE_BYTES + 10 * TIMES) as usize).is_ok() && limits.bytes(1, 1).is_err());
        limits.add_input(1);
        // The failed request also used up the remaining bytes.
        assert!(limits.bytes(1, TIMES as usize).is_ok() && limits.bytes(1, 1).is_err());
        assert!(ResourceLimits::of_file(usize::MAX, 5).bytes(6, 1).is_err());
        let limits = ResourceLimits::with_memory(0);
        assert!(
            limits.objects(MAX_OBJECTS).is_ok() && limits.objects(1).is_err() && limits.objects(usize::MAX).is_err()
        );
        assert_eq!(limits.object_count(), usize::MAX);
    }
}
