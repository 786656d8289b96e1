//! A progress bar, and what Ctrl-C does.

use durer::render::{Control, Job, RenderError};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

/// What Ctrl-C meets: before rendering it ends the program, while rendering it cancels, while saving it waits.
static PHASE: AtomicU8 = AtomicU8::new(0);
const RENDERING: u8 = 1;
const SAVING: u8 = 2;

/// Runs a render with a progress bar (on a terminal) and Ctrl-C.
pub fn watch<T>(
    job: &Job,
    control: &Arc<Control>,
    quiet: bool,
    render: impl FnOnce() -> Result<T, RenderError>,
) -> Result<T, RenderError> {
    let cancelled = Arc::clone(control);
    // A second handler, of another render in this process, would be refused; the first one serves.
    let _ = ctrlc::set_handler(move || match PHASE.load(Relaxed) {
        RENDERING if !cancelled.cancel.swap(true, Relaxed) => {}
        SAVING => {}
        _ => std::process::exit(i32::from(crate::INTERRUPTED)),
    });
    PHASE.store(RENDERING, Relaxed);
    let visible = !quiet && std::io::stderr().is_terminal();
    let result = if visible { with_bar(job, control, render) } else { render() };
    PHASE.store(SAVING, Relaxed);
    result
}

fn with_bar<T>(
    job: &Job,
    control: &Control,
    render: impl FnOnce() -> Result<T, RenderError>,
) -> Result<T, RenderError> {
    let (finished, wait) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let bar = ProgressBar::with_draw_target(Some(job.work()), ProgressDrawTarget::hidden());
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
                bar.set_position(control.done.load(Relaxed));
            }
            bar.finish_and_clear();
        });
        let result = render();
        drop(finished);
        result
    })
}
