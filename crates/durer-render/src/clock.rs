//! Monotonic clock that also compiles for WebAssembly, where there may be none.

pub use std::time::Duration;

/// Instant of a monotonic clock, used for time limits and to measure renders.
///
/// WebAssembly without a host has no clock: all instants are equal there, so renders have no time
/// limit and report durations of zero.
#[derive(Clone, Copy, Debug)]
pub struct Instant(#[cfg(not(target_family = "wasm"))] std::time::Instant);

impl Instant {
    /// Returns the current instant.
    pub fn now() -> Self {
        Instant(
            #[cfg(not(target_family = "wasm"))]
            std::time::Instant::now(),
        )
    }

    /// Time elapsed since `earlier`, or zero if `earlier` is later than this instant.
    pub fn duration_since(self, earlier: Instant) -> Duration {
        #[cfg(not(target_family = "wasm"))]
        return self.0.duration_since(earlier.0);
        #[cfg(target_family = "wasm")]
        {
            let Instant() = earlier;
            Duration::ZERO
        }
    }

    /// Time since this instant.
    pub fn elapsed(self) -> Duration {
        Instant::now().duration_since(self)
    }
}
