//! Work on several threads, with the feature `rayon`; without it the same work on one. Results do
//! not depend on which.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// Does both, perhaps at the same time.
pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    #[cfg(feature = "rayon")]
    return rayon::join(a, b);
    #[cfg(not(feature = "rayon"))]
    (a(), b())
}

/// Does all of it on a thread of the pool: from outside, each step that is shared would be handed
/// over and waited for.
pub fn on_pool<A: Send>(work: impl FnOnce() -> A + Send) -> A {
    #[cfg(feature = "rayon")]
    return rayon::scope(|_| work());
    #[cfg(not(feature = "rayon"))]
    work()
}

/// Appends what belongs to 0, 1, 2, ..., at least `together` of them on a thread.
pub fn extend<T: Send>(to: &mut Vec<T>, count: usize, together: usize, of: impl Fn(usize) -> T + Sync + Send) {
    #[cfg(feature = "rayon")]
    to.par_extend((0..count).into_par_iter().with_min_len(together).map(of));
    #[cfg(not(feature = "rayon"))]
    {
        _ = together;
        to.extend((0..count).map(of));
    }
}

/// What becomes of each, in order.
pub fn map<T: Sync, R: Send>(all: &[T], of: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "rayon")]
    return all.par_iter().map(of).collect();
    #[cfg(not(feature = "rayon"))]
    all.iter().map(of).collect()
}

/// What becomes of those of which anything does, in order; at least `together` on a thread.
pub fn filter_map<T: Sync, R: Send>(all: &[T], together: usize, of: impl Fn(&T) -> Option<R> + Sync + Send) -> Vec<R> {
    #[cfg(feature = "rayon")]
    return all.par_iter().with_min_len(together).filter_map(of).collect();
    #[cfg(not(feature = "rayon"))]
    {
        _ = together;
        all.iter().filter_map(of).collect()
    }
}

/// Whether any is so; at least `together` on a thread.
pub fn any<T: Sync>(all: &[T], together: usize, is_so: impl Fn(&T) -> bool + Sync + Send) -> bool {
    #[cfg(feature = "rayon")]
    return all.par_iter().with_min_len(together).any(is_so);
    #[cfg(not(feature = "rayon"))]
    {
        _ = together;
        all.iter().any(is_so)
    }
}

/// Does something with each.
pub fn for_each<T: Send>(all: Vec<T>, work: impl Fn(T) + Sync + Send) {
    #[cfg(feature = "rayon")]
    all.into_par_iter().for_each(work);
    #[cfg(not(feature = "rayon"))]
    all.into_iter().for_each(work);
}
