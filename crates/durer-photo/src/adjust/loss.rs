//! Losses: how much a residual counts.

/// What half of is summed: a function ρ of the square s of a residual's length, in square pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Loss {
    /// ρ = s: least squares.
    Squared,
    /// Huber's: s to the given length d, beyond that 2 d √s - d², which grows with the length only.
    Huber(f64),
    /// Cauchy's: c² ln(1 + s / c²) for the given length c; what is far off counts for hardly
    /// anything.
    Cauchy(f64),
}

impl Loss {
    /// ρ and its derivative by s.
    pub(super) fn at(self, s: f64) -> (f64, f64) {
        match self {
            Loss::Huber(d) if s > d * d => (2.0 * d * s.sqrt() - d * d, d / s.sqrt()),
            Loss::Cauchy(c) => (c * c * libm::log1p(s / (c * c)), 1.0 / (1.0 + s / (c * c))),
            Loss::Squared | Loss::Huber(_) => (s, 1.0),
        }
    }
}
