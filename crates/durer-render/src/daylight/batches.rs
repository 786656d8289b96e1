//! Batches of samples, from whose differences standard errors are computed.

/// Number of batches into which the samples of a sensor are divided.
pub(super) const BATCHES: usize = 16;

/// Value of each batch of samples.
pub(super) type Batches = [f32; BATCHES];

/// Returns the mean of the batches and its standard error.
pub(super) fn mean_and_error(batches: &Batches) -> [f64; 2] {
    let count = BATCHES as f64;
    let mean = batches.iter().map(|&value| f64::from(value)).sum::<f64>() / count;
    let squares: f64 = batches.iter().map(|&value| (f64::from(value) - mean) * (f64::from(value) - mean)).sum();
    [mean, (squares / (count * (count - 1.0))).sqrt()]
}

/// Returns the standard error of a value from the values without each batch.
///
/// Source: Efron, *The jackknife, the bootstrap and other resampling plans*, 1982.
pub(super) fn jackknife_error(without: &[f64]) -> f64 {
    let count = without.len() as f64;
    let mean = without.iter().sum::<f64>() / count;
    let squares: f64 = without.iter().map(|value| (value - mean) * (value - mean)).sum();
    ((count - 1.0) / count * squares).sqrt()
}
