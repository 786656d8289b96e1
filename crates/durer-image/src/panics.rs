//! Catches panics in third-party decoders, so that they can be reported as errors.
//!
//! This crate does not set a panic hook. A program with a hook that prints panics should call
//! [`are_expected`] first.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    /// True while this thread runs code in which panics are caught.
    static EXPECTED: Cell<bool> = const { Cell::new(false) };
}

/// Runs `work` and returns its result, or `None` if it panicked.
pub fn catch_panic<T>(work: impl FnOnce() -> T) -> Option<T> {
    let before = EXPECTED.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    EXPECTED.set(before);
    result.ok()
}

/// Returns true if [`catch_panic`] would catch a panic in this thread, so that a panic hook does
/// not need to print it. Returns false in a thread that is ending.
pub fn are_expected() -> bool {
    EXPECTED.try_with(Cell::get).unwrap_or(false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_are_expected_only_where_they_are_caught() {
        assert_eq!(catch_panic(|| 1), Some(1));
        let inner = catch_panic(|| {
            assert_eq!(catch_panic(|| -> u32 { panic!("not reported") }), None);
            assert!(are_expected());
        });
        assert_eq!(inner, Some(()));
        assert_eq!(catch_panic(|| Vec::<u32>::new()[0]), None);
        assert!(!are_expected());
    }
}
