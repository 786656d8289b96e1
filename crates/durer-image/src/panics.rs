//! Panics of other people's code: caught, and not told on the terminal as ours are.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether what this thread does may panic without a word.
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// The result of some work; `None` if it panicked. The process's panic hook stays in place, and
/// hears of all other panics.
pub fn caught<T>(work: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let told = take_hook();
        set_hook(Box::new(move |panic| {
            // A thread that is ending has no word left, and is not ours.
            if !QUIET.try_with(Cell::get).unwrap_or(false) {
                told(panic);
            }
        }));
    });
    let before = QUIET.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    QUIET.set(before);
    result.ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_caught_and_later_ones_are_told() {
        assert_eq!(caught(|| 1), Some(1));
        let inner = caught(|| {
            assert_eq!(caught(|| -> u32 { panic!("not told") }), None);
            assert!(QUIET.get());
        });
        assert_eq!(inner, Some(()));
        assert_eq!(caught(|| Vec::<u32>::new()[0]), None);
        assert!(!QUIET.get());
    }
}
