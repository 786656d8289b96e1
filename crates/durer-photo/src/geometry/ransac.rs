//! Models of data some of which are false: RANSAC with local optimisation.
//!
//! Small samples give models; the one that explains the data best is kept, and is fitted again to
//! all data that it explains. Truncated squares are summed (MSAC). It ends when a better sample has
//! become unlikely.
//!
//! Sources: Fischler, Bolles, *Random Sample Consensus*, CACM 24(6), 1981; Torr, Zisserman,
//! *MLESAC*, CVIU 78, 2000; Chum, Matas, Kittler, *Locally Optimized RANSAC*, DAGM 2003.

use crate::random::Random;

/// A problem that RANSAC solves: `N` data make a sample.
pub trait Estimate<const N: usize> {
    /// What explains the data.
    type Model: Clone;
    /// How many data there are.
    fn count(&self) -> usize;
    /// The models of a sample.
    fn minimal(&self, sample: &[usize; N]) -> Vec<Self::Model>;
    /// A model fitted to many data, from one near it.
    fn refined(&self, inliers: &[usize], model: &Self::Model) -> Option<Self::Model>;
    /// The square of a datum's error.
    fn error(&self, model: &Self::Model, datum: usize) -> f64;
}

/// How it is searched.
#[derive(Debug, Clone, Copy)]
pub struct Search {
    /// The largest error of a datum that is true.
    pub threshold: f64,
    /// Samples at most.
    pub samples: usize,
    /// Of the random numbers.
    pub seed: u64,
}

/// The best model that was found, and the data that it explains; none where no sample gave a model
/// with more data than made it.
pub fn ransac<const N: usize, E: Estimate<N>>(problem: &E, search: &Search) -> Option<(E::Model, Vec<usize>)> {
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
        for model in problem.minimal(&random.sample::<N>(count)) {
            let bound = best.as_ref().map_or(f64::INFINITY, |best| best.0);
            let Some(loss) = loss(problem, &model, limit, bound) else { continue };
            let (loss, model) = improved(problem, model, loss, limit);
            let share = inliers(problem, &model, limit).len() as f64 / count as f64;
            needed = needed.min(samples_for::<N>(share, search.samples));
            best = Some((loss, model));
        }
    }
    let (_, model) = best?;
    let inliers = inliers(problem, &model, limit);
    (inliers.len() > N).then_some((model, inliers))
}

/// So many samples that with probability 0.9999 one of them has only true data.
fn samples_for<const N: usize>(share: f64, most: usize) -> usize {
    let good = (0..N).map(|_| share).product::<f64>();
    if good <= 1e-12 {
        return most;
    }
    if good >= 1.0 { 1 } else { (libm::log(1e-4) / libm::log1p(-good)).ceil().max(8.0).min(most as f64) as usize }
}

/// The sum of truncated errors, if it is less than a bound.
fn loss<const N: usize, E: Estimate<N>>(problem: &E, model: &E::Model, limit: f64, bound: f64) -> Option<f64> {
    let mut sum = 0.0;
    for datum in 0..problem.count() {
        // What is not a number counts as far off.
        let error = problem.error(model, datum);
        sum += if error < limit { error } else { limit };
        if sum >= bound {
            return None;
        }
    }
    Some(sum)
}

fn inliers<const N: usize, E: Estimate<N>>(problem: &E, model: &E::Model, limit: f64) -> Vec<usize> {
    (0..problem.count()).filter(|datum| problem.error(model, *datum) < limit).collect()
}

/// Fits again and again to what the model explains, from twice the threshold down to it.
fn improved<const N: usize, E: Estimate<N>>(problem: &E, model: E::Model, start: f64, limit: f64) -> (f64, E::Model) {
    let (mut best, mut current) = ((start, model.clone()), model);
    for widened in [4.0, 2.0, 1.0, 1.0] {
        let near = inliers(problem, &current, widened * limit);
        let Some(next) = (near.len() > N).then(|| problem.refined(&near, &current)).flatten() else { break };
        if let Some(loss) = loss(problem, &next, limit, best.0) {
            best = (loss, next.clone());
        }
        current = next;
    }
    best
}
