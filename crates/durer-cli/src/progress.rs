//! Shows progress bars and handles Ctrl-C and other signals.

use crate::failure::{Failure, interrupted_by};
use durer::render::{Control, RenderError};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::time::{Duration, Instant};

/// Phase of the program. It determines how the program reacts to a signal such as Ctrl-C.
enum Phase {
    /// No output exists yet, so the signal ends the program.
    BeforeWriting,
    /// The program is waiting for changes, so the signal ends it without an error.
    Idle,
    /// The first signal cancels the render, and a second one ends the program.
    Rendering(Arc<Control>),
    /// The first signal takes effect when the files are complete, and a second one ends the
    /// program. The flag is true after the first signal.
    Saving(bool),
}

/// Signals within this interval count as one because some programs send a signal to both the
/// process and its group.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(500);

/// Current phase. The phase is locked while it changes, so that no save starts while the program
/// ends.
static PHASE: Mutex<Phase> = Mutex::new(Phase::BeforeWriting);
/// Time of the last signal. Signals repeated within [`SIGNAL_INTERVAL`] do not count.
static LAST: Mutex<Option<Instant>> = Mutex::new(None);

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reacts to a signal according to the current phase.
fn interrupt(signal: u8) {
    let (mut last, mut phase) = (locked(&LAST), locked(&PHASE));
    if last.is_some_and(|last| last.elapsed() < SIGNAL_INTERVAL) {
        return;
    }
    *last = Some(Instant::now());
    interrupted_by(signal);
    match &mut *phase {
        Phase::Rendering(control) if !control.cancel.swap(true, Relaxed) => {}
        Phase::Saving(requested @ false) => *requested = true,
        Phase::Idle => end(0),
        phase => {
            let what =
                if matches!(phase, Phase::BeforeWriting) { "nothing was written" } else { "not everything was saved" };
            end(Failure::Interrupted(what.into()).report())
        }
    }
}

/// Starts handling signals. If that fails, signals end the program as usual.
#[cfg(unix)]
pub fn handle_signals() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    // Because SIGXFSZ is handled, exceeding the file size limit becomes a write error that names
    // the file.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    let ignored = ignored_signals();
    let heard = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(move |signal| ignored >> (signal - 1) & 1 == 0);
    let (ready, wait) = mpsc::channel();
    let listener = std::thread::Builder::new().name("signals".into()).spawn(move || {
        let mut signals = signal_hook::iterator::Signals::new(heard);
        let _ = ready.send(());
        signals.iter_mut().flat_map(|signals| signals.forever()).for_each(|signal| interrupt(signal as u8));
    });
    // Wait until the thread is listening. Until then, signals end the program.
    if listener.is_ok() {
        let _ = wait.recv();
    }
}

/// Returns a mask of the signals that the parent process has set to be ignored, for example with
/// `nohup`.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    // If /proc is missing, assume that no signal is ignored.
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Starts handling Ctrl-C, Ctrl-Break and the other console events. If the window is closed, the
/// operating system ends the program anyway, and only earlier saves remain.
#[cfg(not(unix))]
pub fn handle_signals() {
    let _ = ctrlc::set_handler(|| interrupt(2));
}

/// Enters the phase in which the program waits for changes. A signal that arrived during a save
/// takes effect now.
pub fn idle() {
    let signal = locked(&LAST);
    let mut phase = locked(&PHASE);
    if signal.is_some() {
        end(0);
    }
    *phase = Phase::Idle;
}

/// Leaves the phase in which the program waits for changes.
pub fn busy() {
    *locked(&PHASE) = Phase::BeforeWriting;
}

/// Enters the phase in which files are written.
pub fn saving() {
    *locked(&PHASE) = Phase::Saving(false);
}

/// Runs a render and shows a progress bar if the output is a terminal. Ctrl-C cancels the render.
pub fn watch<T>(
    control: &Arc<Control>,
    quiet: bool,
    render: impl FnOnce() -> Result<T, RenderError>,
) -> Result<T, RenderError> {
    *locked(&PHASE) = Phase::Rendering(Arc::clone(control));
    let result = with_progress(control, quiet, render);
    *locked(&PHASE) = Phase::BeforeWriting;
    result
}

/// Runs work and shows a progress bar if the output is a terminal. Unlike in [`watch`], signals end
/// the program at once because nothing needs to be saved.
pub fn with_progress<T>(control: &Control, quiet: bool, work: impl FnOnce() -> T) -> T {
    if !quiet && std::io::stderr().is_terminal() { with_bar(control, work) } else { work() }
}

/// Child process that ends together with this program.
static CHILD: Mutex<Option<Child>> = Mutex::new(None);

/// Runs a command and returns its output. A signal that ends this program also ends the command.
pub fn run_child(command: &mut Command) -> std::io::Result<Output> {
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    *locked(&CHILD) = Some(child);
    loop {
        let mut child = locked(&CHILD);
        if child.as_mut().map_or(Ok(None), Child::try_wait)?.is_some() {
            let ended = child.take().ok_or(std::io::ErrorKind::Interrupted)?;
            return ended.wait_with_output();
        }
        drop(child);
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Ends the program and its child process.
fn end(code: u8) {
    if let Some(child) = locked(&CHILD).as_mut() {
        // Ignore errors because the child may have ended already.
        let _ = child.kill();
    }
    crate::terminal::end(code)
}

fn with_bar<T>(control: &Control, render: impl FnOnce() -> T) -> T {
    let (finished, wait) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        let show = move || {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {eta} left");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            let start = Instant::now();
            // The wait ends when the sender is dropped at the end of the render.
            while wait.recv_timeout(Duration::from_millis(100)) == Err(mpsc::RecvTimeoutError::Timeout) {
                if bar.is_hidden() && start.elapsed() > Duration::from_millis(500) {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                }
                let rays = control.rays.load(Relaxed) as f64 / start.elapsed().as_secs_f64();
                bar.set_message(format!("{:.2} M rays/s", rays / 1e6));
                bar.set_length(control.total_work.load(Relaxed));
                bar.set_position(control.done_work.load(Relaxed));
            }
            bar.finish_and_clear();
        };
        // If no thread can be started, show no bar.
        let _ = std::thread::Builder::new().spawn_scoped(scope, show);
        let result = render();
        drop(finished);
        result
    })
}

/// Processes items one after another and shows a progress line if the output is a terminal.
pub fn each<T, R>(names: &[String], items: Vec<T>, quiet: bool, mut work: impl FnMut(T) -> R) -> Vec<R> {
    let bar = ProgressBar::with_draw_target(Some(items.len() as u64), ProgressDrawTarget::hidden());
    let style = ProgressStyle::with_template("{bar:40} {pos} of {len}  {elapsed}  {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    if !quiet && std::io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::stderr());
        // The ticker panics if it cannot start a thread.
        if std::thread::Builder::new().spawn(|| {}).is_ok() {
            bar.enable_steady_tick(Duration::from_millis(200));
        }
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

/// Runs `work`. If it takes long and the output is a terminal, shows its progress from 0 to 1.
pub fn show_progress<R>(name: &'static str, work: impl FnOnce(&(dyn Fn(f64) + Sync)) -> R) -> R {
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
