//! A progress bar, and what Ctrl-C does.

use crate::Failure;
use durer::render::{Control, RenderError};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::time::{Duration, Instant};

/// What Ctrl-C meets.
enum Phase {
    /// Nothing is written yet: it ends the program.
    Harmless,
    /// It cancels; a second one ends the program.
    Rendering(Arc<Control>),
    /// It waits until the files are whole; a second one ends the program. Says whether there was a first.
    Saving(bool),
}

/// Whoever changes it holds it, so that nothing begins to be saved while the program ends.
static PHASE: Mutex<Phase> = Mutex::new(Phase::Harmless);

fn phase() -> MutexGuard<'static, Phase> {
    PHASE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sets what Ctrl-C does from now on.
pub fn hear_interrupts() {
    let handler = || match &mut *phase() {
        Phase::Rendering(control) if !control.cancel.swap(true, Relaxed) => {}
        Phase::Saving(asked @ false) => *asked = true,
        phase => {
            let what = if matches!(phase, Phase::Harmless) { "nothing was written" } else { "not all was saved" };
            std::process::exit(i32::from(Failure::Interrupted(what.into()).report()))
        }
    };
    // Where there can be no handler, Ctrl-C ends the program as it ends others.
    let _ = ctrlc::set_handler(handler);
}

/// Files are about to be saved.
pub fn saving() {
    *phase() = Phase::Saving(false);
}

/// Runs a render with a progress bar (on a terminal) and Ctrl-C.
pub fn watch<T>(
    control: &Arc<Control>,
    quiet: bool,
    render: impl FnOnce() -> Result<T, RenderError>,
) -> Result<T, RenderError> {
    *phase() = Phase::Rendering(Arc::clone(control));
    let visible = !quiet && std::io::stderr().is_terminal();
    let result = if visible { with_bar(control, render) } else { render() };
    *phase() = Phase::Harmless;
    result
}

fn with_bar<T>(control: &Control, render: impl FnOnce() -> Result<T, RenderError>) -> Result<T, RenderError> {
    let (finished, wait) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {eta} left");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            let start = Instant::now();
            // The sender is dropped when the render ends.
            while wait.recv_timeout(Duration::from_millis(100)) == Err(mpsc::RecvTimeoutError::Timeout) {
                if bar.is_hidden() && start.elapsed() > Duration::from_millis(500) {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                }
                let rays = control.rays.load(Relaxed) as f64 / start.elapsed().as_secs_f64();
                bar.set_message(format!("{:.2} M rays/s", rays / 1e6));
                bar.set_length(control.all.load(Relaxed));
                bar.set_position(control.done.load(Relaxed));
            }
            bar.finish_and_clear();
        });
        let result = render();
        drop(finished);
        result
    })
}

/// Works through a list one by one, with a line that tells how far it is where that takes long (on a terminal).
pub fn each<T, R>(names: &[String], items: Vec<T>, quiet: bool, mut work: impl FnMut(T) -> R) -> Vec<R> {
    let bar = ProgressBar::with_draw_target(Some(items.len() as u64), ProgressDrawTarget::hidden());
    let style = ProgressStyle::with_template("{bar:40} {pos} of {len}  {elapsed}  {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    if !quiet && std::io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::stderr());
        bar.enable_steady_tick(Duration::from_millis(200));
    }
    let done = names.iter().zip(items).map(|(name, item)| {
        bar.set_message(name.clone());
        let result = work(item);
        bar.inc(1);
        result
    });
    let done = done.collect();
    bar.finish_and_clear();
    done
}

/// Works with a bar that shows how far it is, from 0 to 1, where that takes long (on a terminal).
pub fn shares<R>(name: &'static str, work: impl FnOnce(&(dyn Fn(f64) + Sync)) -> R) -> R {
    let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::hidden());
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {elapsed}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.set_message(name);
    let start = Instant::now();
    let result = work(&|share| {
        if bar.is_hidden() && start.elapsed() > Duration::from_millis(500) && std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        bar.set_position((1000.0 * share) as u64);
    });
    bar.finish_and_clear();
    result
}
