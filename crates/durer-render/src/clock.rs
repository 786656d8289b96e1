//! Clock, on platforms that have one.

pub use std::time::Duration;

/// Instant of a clock that never runs backwards.
///
/// WebAssembly without a host has no clock: all instants are equal there, so renders have no time
/// limit and report durations of zero.
#[derive(Clone, Copy, Debug)]
pub struct Instant(#[cfg(not(target_family = "wasm"))] std::time::Instant);

impl Instant {
    /// The present instant.
    pub fn now() -> Self {
        Instant(
            #[cfg(not(target_family = "wasm"))]
            std::time::Instant::now(),
        )
    }

    /// Time since `earlier`; zero if that is later.
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
