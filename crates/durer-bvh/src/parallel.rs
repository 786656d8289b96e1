//! Loops that run in parallel with the feature `rayon` and sequentially without it. The results are
//! the same.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// Runs both closures, in parallel if possible.
pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    #[cfg(feature = "rayon")]
    return rayon::join(a, b);
    #[cfg(not(feature = "rayon"))]
    (a(), b())
}

/// Runs `work` on a thread of the thread pool. If the caller were outside the pool, each parallel
/// step would have to be handed to the pool and awaited.
pub fn on_pool<A: Send>(work: impl FnOnce() -> A + Send) -> A {
    #[cfg(feature = "rayon")]
    return rayon::scope(|_| work());
    #[cfg(not(feature = "rayon"))]
    work()
}

/// Appends `of(0)`, ..., `of(count - 1)` to a list, with at least `together` items per task.
pub fn extend<T: Send>(to: &mut Vec<T>, count: usize, together: usize, of: impl Fn(usize) -> T + Sync + Send) {
    #[cfg(feature = "rayon")]
    to.par_extend((0..count).into_par_iter().with_min_len(together).map(of));
    #[cfg(not(feature = "rayon"))]
    {
        _ = together;
        to.extend((0..count).map(of));
    }
}

/// Maps all items in parallel and keeps their order.
pub fn map<T: Sync, R: Send>(all: &[T], of: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "rayon")]
    return all.par_iter().map(of).collect();
    #[cfg(not(feature = "rayon"))]
    all.iter().map(of).collect()
}

/// Runs `filter_map` in parallel and keeps the order, with at least `together` items per task.
pub fn filter_map<T: Sync, R: Send>(all: &[T], together: usize, of: impl Fn(&T) -> Option<R> + Sync + Send) -> Vec<R> {
    #[cfg(feature = "rayon")]
    return all.par_iter().with_min_len(together).filter_map(of).collect();
    #[cfg(not(feature = "rayon"))]
    {
        _ = together;
        all.iter().filter_map(of).collect()
    }
}

/// Returns true if `is_so` is true for any item, with at least `together` items per task.
pub fn any<T: Sync>(all: &[T], together: usize, is_so: impl Fn(&T) -> bool + Sync + Send) -> bool {
    #[cfg(feature = "rayon")]
    return all.par_iter().with_min_len(together).any(is_so);
    #[cfg(not(feature = "rayon"))]
    {
        _ = together;
        all.iter().any(is_so)
    }
}

/// Calls `work` for each item, in parallel.
pub fn for_each<T: Send>(all: Vec<T>, work: impl Fn(T) + Sync + Send) {
    #[cfg(feature = "rayon")]
    all.into_par_iter().for_each(work);
    #[cfg(not(feature = "rayon"))]
    all.into_iter().for_each(work);
}
