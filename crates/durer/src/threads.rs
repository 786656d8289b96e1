//! Threads for work in parallel: as many as are wanted, or as can be had; where there are none, the calling thread does it all.

use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::Once;

/// More threads than this are never started, whatever is asked for.
pub const MOST: usize = 1024;

/// Room for the recursion of the most bounces.
const STACK: usize = 16 << 20;

/// How many threads there should be: as asked for; else as `RAYON_NUM_THREADS` says; else as many as the machine has.
fn wanted(asked: Option<usize>) -> usize {
    let environment = || std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok().filter(|&count: &usize| count > 0);
    let machine = || std::thread::available_parallelism().map_or(1, usize::from);
    asked.or_else(environment).unwrap_or_else(machine).clamp(1, MOST)
}

/// The wanted number, and what is tried after it where the system does not give so many.
fn counts(asked: Option<usize>) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(wanted(asked)), |count| Some(count / 2)).take_while(|&count| count > 0)
}

fn builder(count: usize) -> ThreadPoolBuilder {
    ThreadPoolBuilder::new().num_threads(count).stack_size(STACK)
}

/// Threads of one's own; `None` where the system gives none.
pub fn pool(asked: Option<usize>) -> Option<ThreadPool> {
    let pool = counts(asked).find_map(|count| builder(count).build().ok());
    if pool.is_none() {
        prepare();
    }
    pool
}

/// Does some work with threads of its own; without any, in the calling thread.
pub fn install<R: Send>(asked: Option<usize>, work: impl FnOnce() -> R + Send) -> R {
    match pool(asked) {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Starts the threads that all work shares that has none of its own. Programs call it when they begin; where it is not called,
/// they are started when they are needed first, and a system that gives none is an error of the program.
pub fn prepare() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // An error at the end means that there are some already.
        let _ = counts(None).find(|&count| builder(count).build_global().is_ok()).is_some()
            || ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global().is_ok();
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_as_asked_for_and_never_too_many() {
        assert_eq!(pool(Some(3)).unwrap().current_num_threads(), 3);
        assert_eq!((wanted(Some(0)), wanted(Some(usize::MAX))), (1, MOST));
        assert_eq!(counts(Some(5)).collect::<Vec<_>>(), [5, 2, 1]);
        assert_eq!(install(Some(2), rayon::current_num_threads), 2);
    }
}
