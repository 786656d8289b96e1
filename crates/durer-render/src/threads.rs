//! Threads for work in parallel: as many as are wanted, or as can be had; where there are none, the
//! calling thread does it all.

use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder};
use std::io;
use std::sync::{Once, mpsc};

/// More threads than this are never started, whatever is asked for.
pub const MOST: usize = 1024;

/// How many threads there should be: as asked for; else as `RAYON_NUM_THREADS` says; else as many
/// as the machine has.
fn wanted(asked: Option<usize>) -> usize {
    let environment = || std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok().filter(|&count: &usize| count > 0);
    let machine = || std::thread::available_parallelism().map_or(1, usize::from);
    asked.or_else(environment).unwrap_or_else(machine).clamp(1, MOST)
}

/// Starts as many threads as are wanted and can be had. Each waits for what it is to be in a pool.
fn started(asked: Option<usize>) -> Vec<mpsc::Sender<ThreadBuilder>> {
    let start = |_| {
        let (sender, receiver) = mpsc::channel::<ThreadBuilder>();
        let run = move || receiver.recv().into_iter().for_each(ThreadBuilder::run);
        std::thread::Builder::new().spawn(run).ok().map(|_| sender)
    };
    (0..wanted(asked)).map_while(start).collect()
}

/// Gives threads that are started already to a pool: this cannot fail half-way, as starting them
/// can.
fn giving(mut started: Vec<mpsc::Sender<ThreadBuilder>>) -> impl FnMut(ThreadBuilder) -> io::Result<()> {
    move |thread| {
        let sent = started.pop().map(|sender| sender.send(thread));
        sent.and_then(Result::ok).ok_or_else(|| io::Error::other("a thread has ended"))
    }
}

/// Threads of one's own; `None` where the system gives none.
pub fn pool(asked: Option<usize>) -> Option<ThreadPool> {
    let started = started(asked);
    if started.is_empty() {
        prepare();
        return None;
    }
    ThreadPoolBuilder::new().num_threads(started.len()).spawn_handler(giving(started)).build().ok()
}

/// Does some work with threads of its own; without any, in the calling thread.
pub fn install<R: Send>(asked: Option<usize>, work: impl FnOnce() -> R + Send) -> R {
    match pool(asked) {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Starts the threads that all work shares that has none of its own. Programs call it when they
/// begin; where it is not called, they are started when they are needed first, and a system that
/// gives none is an error of the program.
pub fn prepare() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let started = started(None);
        // An error means that there are some already.
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
    fn there_are_as_many_as_asked_for_and_never_too_many() {
        assert_eq!(pool(Some(3)).unwrap().current_num_threads(), 3);
        assert_eq!((wanted(Some(0)), wanted(Some(usize::MAX))), (1, MOST));
        assert_eq!(install(Some(2), rayon::current_num_threads), 2);
    }
}
