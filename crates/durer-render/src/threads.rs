//! Thread pools with as many threads as requested and available. If none can be started, the
//! calling thread does all work.

use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder};
use std::io;
use std::sync::{Once, mpsc};

/// Maximum number of threads.
pub const MOST: usize = 1024;

/// Returns the wanted number of threads: as requested, else `RAYON_NUM_THREADS`, else the number of
/// processors.
fn wanted(requested: Option<usize>) -> usize {
    let environment = || std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok().filter(|&count: &usize| count > 0);
    let machine = || std::thread::available_parallelism().map_or(1, usize::from);
    requested.or_else(environment).unwrap_or_else(machine).clamp(1, MOST)
}

/// Starts the wanted threads, as far as the system allows. Each waits to be assigned to a pool.
fn started(requested: Option<usize>) -> Vec<mpsc::Sender<ThreadBuilder>> {
    let start = |_| {
        let (sender, receiver) = mpsc::channel::<ThreadBuilder>();
        let run = move || receiver.recv().into_iter().for_each(ThreadBuilder::run);
        std::thread::Builder::new().spawn(run).ok().map(|_| sender)
    };
    (0..wanted(requested)).map_while(start).collect()
}

/// Returns a spawn handler that assigns running threads to a pool, which cannot fail halfway,
/// unlike starting new ones.
fn giving(mut started: Vec<mpsc::Sender<ThreadBuilder>>) -> impl FnMut(ThreadBuilder) -> io::Result<()> {
    move |thread| {
        let sent = started.pop().map(|sender| sender.send(thread));
        sent.and_then(Result::ok).ok_or_else(|| io::Error::other("a thread has ended"))
    }
}

/// Returns a private pool; `None` if the system allows no threads.
pub fn pool(requested: Option<usize>) -> Option<ThreadPool> {
    let started = started(requested);
    if started.is_empty() {
        prepare();
        return None;
    }
    ThreadPoolBuilder::new().num_threads(started.len()).spawn_handler(giving(started)).build().ok()
}

/// Runs work in a private pool, or in the calling thread without one.
pub fn install<R: Send>(requested: Option<usize>, work: impl FnOnce() -> R + Send) -> R {
    match pool(requested) {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Starts the threads of the global pool. Programs call it when they begin; otherwise the threads
/// start on first use, and a system that allows none makes the program fail.
pub fn prepare() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let started = started(None);
        // An error means that the global pool exists already.
        let _ = match started.is_empty() {
            true => ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global(),
            false => {
                let builder = ThreadPoolBuilder::new().num_threads(started.len());
                builder.spawn_handler(giving(started)).build_global()
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
        assert_eq!((wanted(Some(0)), wanted(Some(usize::MAX))), (1, MOST));
        assert_eq!(install(Some(2), rayon::current_num_threads), 2);
    }
}
