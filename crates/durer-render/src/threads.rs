//! Thread pools with the requested number of threads, or with fewer threads if the system allows
//! fewer. If the system allows none, the calling thread does all the work.

use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder};
use std::io;
use std::sync::{Once, mpsc};

/// Maximum number of threads.
pub const MAX_THREADS: usize = 1024;

/// Returns the number of threads to start. This is the requested number if there is one, otherwise
/// the value of `RAYON_NUM_THREADS` if it is set, and otherwise the number of processors.
fn wanted(requested: Option<usize>) -> usize {
    let environment = || std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok().filter(|&count: &usize| count > 0);
    let machine = || std::thread::available_parallelism().map_or(1, usize::from);
    requested.or_else(environment).unwrap_or_else(machine).clamp(1, MAX_THREADS)
}

/// Starts the number of threads that [`wanted`] returns, or as many as the system allows. Each
/// thread waits until it is assigned to a pool.
fn start_threads(requested: Option<usize>) -> Vec<mpsc::Sender<ThreadBuilder>> {
    let start = |_| {
        let (sender, receiver) = mpsc::channel::<ThreadBuilder>();
        let run = move || receiver.recv().into_iter().for_each(ThreadBuilder::run);
        std::thread::Builder::new().spawn(run).ok().map(|_| sender)
    };
    (0..wanted(requested)).map_while(start).collect()
}

/// Returns a spawn handler that assigns running threads to a pool. Unlike starting new threads,
/// this cannot fail after some threads have been added.
fn spawn_handler(mut started: Vec<mpsc::Sender<ThreadBuilder>>) -> impl FnMut(ThreadBuilder) -> io::Result<()> {
    move |thread| {
        let sent = started.pop().map(|sender| sender.send(thread));
        sent.and_then(Result::ok).ok_or_else(|| io::Error::other("a thread has ended"))
    }
}

/// Returns a new thread pool, or `None` if the system allows no threads.
pub fn pool(requested: Option<usize>) -> Option<ThreadPool> {
    let started = start_threads(requested);
    if started.is_empty() {
        prepare();
        return None;
    }
    ThreadPoolBuilder::new().num_threads(started.len()).spawn_handler(spawn_handler(started)).build().ok()
}

/// Runs the work in a new thread pool or, if there is none, in the calling thread.
pub fn install<R: Send>(requested: Option<usize>, work: impl FnOnce() -> R + Send) -> R {
    match pool(requested) {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Starts the threads of rayon's global pool. Programs should call this function when they start.
/// Otherwise, the threads are started when they are first used, and the program fails if the system
/// allows none.
pub fn prepare() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let started = start_threads(None);
        // An error means that the global pool already exists.
        let _ = match started.is_empty() {
            true => ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global(),
            false => {
                let builder = ThreadPoolBuilder::new().num_threads(started.len());
                builder.spawn_handler(spawn_handler(started)).build_global()
            }
        };
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thread_count_is_as_requested_up_to_the_maximum() {
        assert_eq!(pool(Some(3)).unwrap().current_num_threads(), 3);
        assert_eq!((wanted(Some(0)), wanted(Some(usize::MAX))), (1, MAX_THREADS));
        assert_eq!(install(Some(2), rayon::current_num_threads), 2);
    }
}
