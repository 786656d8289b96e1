//! Runs work on threads with the interpreter's lock released, while the calling thread handles
//! Ctrl-C and reports progress.
//!
//! Parallel work runs in a [`pool`] of this process, never in rayon's global pool. After a fork,
//! the global pool would wait for threads that no longer exist.

use durer::threads;
use pyo3::prelude::*;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::cell::RefCell;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two checks for signals, and between two progress reports.
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// Entry of the cache of thread pools, with the process id, the requested number of threads, and
/// the pool.
type KnownPool = (u32, Option<usize>, Option<Arc<ThreadPool>>);

/// Cached thread pools. Each pool belongs to one process, because its threads do not exist after a
/// fork.
static POOLS: Mutex<Vec<KnownPool>> = Mutex::new(Vec::new());

/// Returns the shared pool of this process with the requested number of threads, or `None` if
/// threads are not available.
fn pool(asked: Option<usize>) -> Option<Arc<ThreadPool>> {
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if let Some(known) = pools.iter().find(|known| (known.0, known.1) == (process, asked)) {
        return known.2.clone();
    }
    let pool = threads::pool(asked).map(Arc::new);
    pools.push((process, asked, pool.clone()));
    pool
}

/// Runs work on a number of threads, without holding the interpreter's lock.
pub fn install<R: Send>(py: Python, asked: Option<usize>, work: impl FnOnce() -> R + Send) -> R {
    py.detach(|| match pool(asked) {
        Some(pool) => pool.install(work),
        None => work(),
    })
}

/// Checks for signals such as Ctrl-C, and reports progress to the Python function `watch`.
fn poll(watch: Option<&Py<PyAny>>, done: u64, all: u64) -> PyResult<()> {
    Python::attach(|py| {
        py.check_signals()?;
        watch.map_or(Ok(()), |watch| watch.call1(py, (done, all)).map(|_| ()))
    })
}

/// Polls until the other end of a channel is dropped, which means that the work has ended. Sets
/// `cancel` after Ctrl-C or an exception in `watch`.
fn supervise(
    end: &Receiver<()>,
    watch: Option<&Py<PyAny>>,
    cancel: &AtomicBool,
    progress: &dyn Fn() -> (u64, u64),
) -> PyResult<()> {
    let mut result = Ok(());
    while end.recv_timeout(POLL_INTERVAL) == Err(RecvTimeoutError::Timeout) {
        if result.is_ok() {
            let (done, all) = progress();
            result = poll(watch, done, all);
            cancel.store(result.is_err(), Relaxed);
        }
    }
    result
}

/// Object passed to each job of [`each`] so that the job can check whether to stop. A single item
/// can take milliseconds, so jobs check after every item or every few items.
pub struct Pace<'a> {
    stop: &'a AtomicBool,
    /// Time and result of the last check. Only set if the job runs on the calling thread, which
    /// must check for signals itself.
    own: Option<RefCell<(Instant, PyResult<()>)>>,
}

impl Pace<'_> {
    /// Returns true if the work should continue.
    pub fn should_continue(&self) -> bool {
        if let Some(own) = &self.own {
            let mut own = own.borrow_mut();
            if own.0.elapsed() > POLL_INTERVAL && own.1.is_ok() {
                *own = (Instant::now(), poll(None, 0, 0));
                // Reset the time after the check, which can itself take time.
                own.0 = Instant::now();
                self.stop.store(own.1.is_err(), Relaxed);
            }
        }
        !self.stop.load(Relaxed)
    }

    /// Divides items into ranges and calls `work` for each range, until the job should stop. Ranges
    /// become smaller if items take a long time.
    pub fn ranges(&self, count: usize, mut work: impl FnMut(Range<usize>)) {
        const MOST: usize = 128;
        let (mut from, mut step) = (0, 8);
        while from < count && self.should_continue() {
            let (to, start) = ((from + step).min(count), Instant::now());
            work(from..to);
            step = if start.elapsed() < POLL_INTERVAL / 10 { MOST.min(4 * step) } else { 1.max(step / 4) };
            from = to;
        }
    }
}

/// Runs all jobs on the threads of a pool. Stops after Ctrl-C, or after an exception in `watch`.
pub fn each<J: Send>(
    py: Python,
    asked: Option<usize>,
    watch: Option<Py<PyAny>>,
    mut jobs: Vec<J>,
    work: impl Fn(J, &Pace) + Sync + Send,
) -> PyResult<()> {
    let (all, done, stop) = (jobs.len() as u64, AtomicUsize::new(0), AtomicBool::new(false));
    let run_here = |jobs: Vec<J>| {
        let pace = Pace { stop: &stop, own: Some(RefCell::new((Instant::now(), Ok(())))) };
        jobs.into_iter().take_while(|_| pace.should_continue()).for_each(|job| work(job, &pace));
        pace.own.map_or(Ok(()), |own| own.into_inner().1)
    };
    // A single job does not justify a thread pool.
    if jobs.len() <= 1 {
        py.detach(|| run_here(std::mem::take(&mut jobs)))?;
        return py.check_signals();
    }
    let one = |job| {
        let pace = Pace { stop: &stop, own: None };
        if pace.should_continue() {
            work(job, &pace);
            done.fetch_add(1, Relaxed);
        }
    };
    let result = py.detach(|| {
        let Some(pool) = pool(asked) else {
            return run_here(jobs);
        };
        pool.in_place_scope(|scope| {
            let (end, wait) = channel::<()>();
            let one = &one;
            scope.spawn(move |_| {
                jobs.into_par_iter().with_max_len(1).for_each(one);
                drop(end);
            });
            supervise(&wait, watch.as_ref(), &stop, &|| (done.load(Relaxed) as u64, all))
        })
    });
    result?;
    watch.map_or(Ok(()), |watch| watch.call1(py, (all, all)).map(|_| ()))
}

/// Runs one piece of work on the threads of a pool, and passes `progress`, which returns the work
/// done and the total work, to `watch`. Sets `cancel` after Ctrl-C or an exception in `watch`. If
/// the work panics, returns the panic.
pub fn watched<R: Send>(
    py: Python,
    asked: Option<usize>,
    watch: Option<Py<PyAny>>,
    (cancel, progress): (&AtomicBool, &(dyn Fn() -> (u64, u64) + Sync)),
    work: impl FnOnce() -> R + Send,
) -> PyResult<std::thread::Result<R>> {
    let (answer, result) = py.detach(|| {
        std::thread::scope(|scope| {
            let (end, wait) = channel::<()>();
            let thread = scope.spawn(move || {
                let answer = match pool(asked) {
                    Some(pool) => pool.install(work),
                    None => work(),
                };
                drop(end);
                answer
            });
            let result = supervise(&wait, watch.as_ref(), cancel, progress);
            (thread.join(), result)
        })
    });
    result.map(|()| answer)
}
