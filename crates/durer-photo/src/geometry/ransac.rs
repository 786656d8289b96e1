//! RANSAC with local optimisation, for data with outliers.
//!
//! Models are computed from random minimal samples and compared by their sum of truncated squared
//! errors (MSAC). The best model is fitted again to all its inliers. The search ends when it has
//! become unlikely that a better sample will be found.
//!
//! Sources: Fischler, Bolles, *Random Sample Consensus*, CACM 24(6), 1981; Torr, Zisserman,
//! *MLESAC*, CVIU 78, 2000; Chum, Matas, Kittler, *Locally Optimized RANSAC*, DAGM 2003.

use crate::random::Random;

/// Estimation problem that [`ransac`] solves, such as finding a fundamental matrix from pairs of
/// pixels. `N` is the size of a minimal sample.
pub trait RansacProblem<const N: usize> {
    /// Type of the model to estimate, for example a matrix or a pose.
    type Model: Clone;
    /// Returns the number of data items.
    fn count(&self) -> usize;
    /// Returns all models that fit a minimal sample, which is given by indices.
    fn solve_minimal(&self, sample: &[usize; N]) -> Vec<Self::Model>;
    /// Returns the model that best fits all inliers. `model` is the initial estimate.
    fn refine(&self, inliers: &[usize], model: &Self::Model) -> Option<Self::Model>;
    /// Returns the squared error of a data item.
    fn error(&self, model: &Self::Model, index: usize) -> f64;
}

/// Parameters of a RANSAC search.
#[derive(Debug, Clone, Copy)]
pub struct RansacOptions {
    /// Maximum error of an inlier.
    pub threshold: f64,
    /// Maximum number of samples.
    pub samples: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Returns the best model and the indices of its inliers, or `None` if no model has more inliers
/// than its sample.
pub fn ransac<const N: usize, E: RansacProblem<N>>(
    problem: &E,
    search: &RansacOptions,
) -> Option<(E::Model, Vec<usize>)> {
    let count = problem.count();
    if count < N {
        return None;
    }
    let limit = search.threshold * search.threshold;
    let mut random = Random::new(search.seed);
    let mut best: Option<(f64, E::Model)> = None;
    let (mut tried, mut needed) = (0, search.samples);
    while tried < needed {
        tried += 1;
        for model in problem.solve_minimal(&random.sample::<N>(count)) {
            let bound = best.as_ref().map_or(f64::INFINITY, |best| best.0);
            let Some(loss) = loss(problem, &model, limit, bound) else { continue };
            let (loss, model) = refine_locally(problem, model, loss, limit);
            let share = inliers(problem, &model, limit).len() as f64 / count as f64;
            needed = needed.min(samples_for::<N>(share, search.samples));
            best = Some((loss, model));
        }
    }
    let (_, model) = best?;
    let inliers = inliers(problem, &model, limit);
    (inliers.len() > N).then_some((model, inliers))
}

/// Returns the number of samples that are needed so that, with probability 0.9999, at least one of
/// them contains no outliers.
fn samples_for<const N: usize>(share: f64, most: usize) -> usize {
    let good = (0..N).map(|_| share).product::<f64>();
    if good <= 1e-12 {
        return most;
    }
    if good >= 1.0 { 1 } else { (libm::log(1e-4) / libm::log1p(-good)).ceil().max(8.0).min(most as f64) as usize }
}

/// Returns the sum of truncated squared errors, or `None` if the sum reaches `bound`.
fn loss<const N: usize, E: RansacProblem<N>>(problem: &E, model: &E::Model, limit: f64, bound: f64) -> Option<f64> {
    let mut sum = 0.0;
    for index in 0..problem.count() {
        // An error that is NaN counts as an outlier.
        let error = problem.error(model, index);
        sum += if error < limit { error } else { limit };
        if sum >= bound {
            return None;
        }
    }
    Some(sum)
}

fn inliers<const N: usize, E: RansacProblem<N>>(problem: &E, model: &E::Model, limit: f64) -> Vec<usize> {
    (0..problem.count()).filter(|index| problem.error(model, *index) < limit).collect()
}

/// Fits the model repeatedly to its inliers, while the threshold decreases from `start` to `limit`.
fn refine_locally<const N: usize, E: RansacProblem<N>>(
    problem: &E,
    model: E::Model,
    start: f64,
    limit: f64,
) -> (f64, E::Model) {
    let (mut best, mut current) = ((start, model.clone()), model);
    for widened in [4.0, 2.0, 1.0, 1.0] {
        let near = inliers(problem, &current, widened * limit);
        let Some(next) = (near.len() > N).then(|| problem.refine(&near, &current)).flatten() else { break };
        if let Some(loss) = loss(problem, &next, limit, best.0) {
            best = (loss, next.clone());
        }
        current = next;
    }
    best
}
