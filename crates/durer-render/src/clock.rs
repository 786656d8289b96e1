//! A monotonic clock that also compiles for WebAssembly, where the host may not provide a clock.

pub use std::time::Duration;

/// Instant of a monotonic clock. It is used for time limits and to measure the duration of renders.
///
/// WebAssembly without a host has no clock. All instants are equal there, so renders have no time
/// limit and report a duration of zero.
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

    /// Returns the time from `earlier` to this instant, or zero if `earlier` is later.
    pub fn duration_since(self, earlier: Instant) -> Duration {
        #[cfg(not(target_family = "wasm"))]
        return self.0.duration_since(earlier.0);
        #[cfg(target_family = "wasm")]
        {
            let Instant() = earlier;
            Duration::ZERO
        }
    }

    /// Returns the time that has passed since this instant.
    pub fn elapsed(self) -> Duration {
        Instant::now().duration_since(self)
    }
}
