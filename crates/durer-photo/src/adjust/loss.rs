//! Loss functions for bundle adjustment.

/// Loss function ρ(s) that weights residuals in bundle adjustment. s is the squared length of a
/// residual in square pixels, and the cost is half the sum of ρ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Loss {
    /// Least squares, with ρ = s.
    Squared,
    /// Huber loss with threshold d in pixels. It is s up to d², and 2 d √s - d² above, which grows
    /// linearly with the residual.
    Huber(f64),
    /// Cauchy loss with scale c in pixels, c² ln(1 + s / c²). It gives outliers little weight.
    Cauchy(f64),
}

impl Loss {
    /// Returns the value of ρ(s) and its derivative.
    pub(super) fn at(self, s: f64) -> (f64, f64) {
        match self {
            Loss::Huber(d) if s > d * d => (2.0 * d * s.sqrt() - d * d, d / s.sqrt()),
            Loss::Cauchy(c) => (c * c * libm::log1p(s / (c * c)), 1.0 / (1.0 + s / (c * c))),
            Loss::Squared | Loss::Huber(_) => (s, 1.0),
        }
    }
}
