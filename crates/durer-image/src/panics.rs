//! Catches panics of third-party decoders, which are reported as errors.
//!
//! This crate sets no panic hook. A program whose hook prints panics should call [`are_expected`]
//! first.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    /// True while this thread runs code whose panics are caught.
    static EXPECTED: Cell<bool> = const { Cell::new(false) };
}

/// Runs `work` and returns its result; `None` if it panicked.
pub fn catch_panic<T>(work: impl FnOnce() -> T) -> Option<T> {
    let before = EXPECTED.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    EXPECTED.set(before);
    result.ok()
}

/// Returns true if [`catch_panic`] would catch a panic of this thread, so that a panic hook need
/// not print it. False in a thread that is ending.
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
