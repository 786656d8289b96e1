//! Implements `--watch`, which renders again whenever a file of the scene is saved.

use crate::failure::Failure;
use crate::options::RenderArgs;
use crate::picture::{WatchState, render_picture};
use crate::terminal::print_error_line;
use crate::{progress, report};
use durer::compile::AssetCache;
use durer::format::folder::stamp_of;
use durer::source::Stamp;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

/// Interval between checks of the files. It is short because the user is waiting for the picture.
const CHECK_INTERVAL: Duration = Duration::from_millis(10);
/// Time for which files must stay unchanged, because some programs save in several steps.
const SETTLE_TIME: Duration = Duration::from_millis(50);

/// Returns the current time stamps of the files.
fn stamp(files: &[PathBuf]) -> Vec<Option<Stamp>> {
    files.iter().map(|path| stamp_of(path)).collect()
}

/// Renders again and again until Ctrl-C. If the scene has errors, prints them and waits until a
/// file changes.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    let named = [&args.reading.scene_defaults.view_file, &args.reading.scene_defaults.environment];
    let always: Vec<PathBuf> =
        [Some(args.scene.clone())].into_iter().chain(named.map(Clone::clone)).flatten().collect();
    let mut files = always.clone();
    let cache = Arc::new(AssetCache::default());
    loop {
        let before = stamp(&files);
        let watched = WatchState::keeping(&cache);
        let result = while_watching(&files, &before, &watched, || render_picture(args, None, &watched));
        let stale = watched.outdated.load(Relaxed);
        match result {
            Ok(()) => {}
            Err(Failure::Interrupted(_)) if stale => {}
            // Saving a file can fix only errors in files.
            Err(failure @ Failure::Input(_)) => {
                failure.report();
            }
            Err(failure) => return Err(failure),
        }
        // If the scene cannot be read, the same files are still watched.
        let found = watched.files.into_inner().unwrap_or_default();
        let before = match found.is_empty() {
            true => before,
            false => {
                let known = |path: &Path| files.iter().position(|file| file == path).map(|i| before[i].clone());
                let next: Vec<PathBuf> = always.iter().chain(&found).cloned().collect();
                let fresh = stamp(&next);
                let before =
                    next.iter().zip(&fresh).map(|(path, now)| known(path).unwrap_or_else(|| now.clone())).collect();
                files = next;
                before
            }
        };
        if !args.quiet {
            let count = report::counted(files.len(), "file");
            let reused = match cache.statistics().reused {
                0 => String::new(),
                n => format!(" ({n} meshes and pictures reused)"),
            };
            print_error_line(&format!("watching {count}{reused}; press Ctrl-C to stop"));
        }
        progress::idle();
        while stamp(&files) == before {
            std::thread::sleep(CHECK_INTERVAL);
        }
        wait_until_unchanged(&files);
        progress::busy();
    }
}

/// Waits until the files have stayed unchanged for [`SETTLE_TIME`], but at most 40 times as long.
fn wait_until_unchanged(files: &[PathBuf]) {
    let mut last = stamp(files);
    for _ in 0..40 {
        std::thread::sleep(SETTLE_TIME);
        let now = stamp(files);
        if now == last && now.iter().all(Option::is_some) {
            return;
        }
        last = now;
    }
}

/// Runs `work` and cancels it if a file is saved.
fn while_watching<R>(files: &[PathBuf], before: &[Option<Stamp>], watched: &WatchState, work: impl FnOnce() -> R) -> R {
    let (finished, wait) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        let look = move || {
            while wait.recv_timeout(SETTLE_TIME) == Err(RecvTimeoutError::Timeout) {
                if stamp(files) != before {
                    watched.cancel();
                    return;
                }
            }
        };
        // If no thread can be started, the work runs to completion.
        let _ = std::thread::Builder::new().spawn_scoped(scope, look);
        let result = work();
        drop(finished);
        result
    })
}
