//! Chi-squared test for the tests of this crate and of dependent crates.

/// Statistic of the chi-squared test: sum of (observed - expected)^2 / expected.
pub fn chi_squared(observed: &[u32], expected: &[f64]) -> f64 {
    observed.iter().zip(expected).map(|(&o, &e)| (f64::from(o) - e) * (f64::from(o) - e) / e).sum()
}

/// Quantile of the chi-squared distribution that corresponds to the normal quantile `z`. The
/// statistic exceeds it with probability 1e-4 for `z` = 3.719, and falls below it with probability
/// 1e-4 for `z` = -3.719.
///
/// Source: Wilson, Hilferty, *The Distribution of Chi-Square*, PNAS 1931.
pub fn chi_squared_quantile(degrees: usize, z: f64) -> f64 {
    let k = 2.0 / (9.0 * degrees as f64);
    let root = 1.0 - k + z * k.sqrt();
    degrees as f64 * root * root * root
}
