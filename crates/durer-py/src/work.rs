//! Work on threads with the interpreter's lock released, while the calling thread hears Ctrl-C and
//! tells of progress.
//!
//! All that may share its work among threads does so in a [`pool`] of this process, never in the one
//! that rayon has for everybody: after a fork, that one waits for threads which are not there.

use durer::threads;
use pyo3::prelude::*;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How often signals are heard and progress is told.
pub const LOOK: Duration = Duration::from_millis(50);

/// A process, a number of threads that was asked for, and the threads.
type Known = (u32, Option<usize>, Option<Arc<ThreadPool>>);

/// Threads that are kept. They belong to a process: after a fork they are gone.
static POOLS: Mutex<Vec<Known>> = Mutex::new(Vec::new());

/// So many threads, the same for all work of this process; `None` where there are none.
pub fn pool(asked: Option<usize>) -> Option<Arc<ThreadPool>> {
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if let Some(known) = pools.iter().find(|known| (known.0, known.1) == (process, asked)) {
        return known.2.clone();
    }
    let pool = threads::pool(asked).map(Arc::new);
    pools.push((process, asked, pool.clone()));
    pool
}

/// Does some work with so many threads and without the interpreter's lock.
pub fn install<R: Send>(py: Python, asked: Option<usize>, work: impl FnOnce() -> R + Send) -> R {
    py.detach(|| match pool(asked) {
        Some(pool) => pool.install(work),
        None => work(),
    })
}

/// Signals are heard, and `watch`, if it is one, is told how much is done of how much.
pub fn look(watch: Option<&Py<PyAny>>, done: u64, all: u64) -> PyResult<()> {
    Python::attach(|py| {
        py.check_signals()?;
        watch.map_or(Ok(()), |watch| watch.call1(py, (done, all)).map(|_| ()))
    })
}

/// Does all jobs; stops where Ctrl-C was pressed or `watch` raised something.
pub fn each<J: Send>(
    py: Python,
    asked: Option<usize>,
    watch: Option<Py<PyAny>>,
    mut jobs: Vec<J>,
    work: impl Fn(J) + Sync + Send,
) -> PyResult<()> {
    // So little that threads would take longer.
    if jobs.len() <= 1 {
        py.detach(|| jobs.drain(..).for_each(work));
        return py.check_signals();
    }
    let (all, done, stop) = (jobs.len() as u64, AtomicUsize::new(0), AtomicBool::new(false));
    let one = |job| {
        if !stop.load(Relaxed) {
            work(job);
            done.fetch_add(1, Relaxed);
        }
    };
    let result = py.detach(|| {
        let Some(pool) = pool(asked) else {
            jobs.into_iter().for_each(one);
            return Ok(());
        };
        let mut result = Ok(());
        pool.in_place_scope(|scope| {
            let (end, wait) = channel::<()>();
            let one = &one;
            scope.spawn(move |_| {
                jobs.into_par_iter().with_max_len(1).for_each(one);
                drop(end);
            });
            while wait.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if result.is_ok() {
                    result = look(watch.as_ref(), done.load(Relaxed) as u64, all);
                    stop.store(result.is_err(), Relaxed);
                }
            }
        });
        result
    });
    result?;
    watch.map_or(Ok(()), |watch| watch.call1(py, (all, all)).map(|_| ()))
}
