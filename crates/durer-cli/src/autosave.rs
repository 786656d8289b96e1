//! Checkpoints, part files and previews of long renders.

use crate::failure::{Failure, bad};
use crate::guard::{Guard, start_of};
use crate::options::RenderArgs;
use crate::output::{encode, format, lengthened, wrote};
use crate::terminal::complain;
use crate::{progress, report};
use durer::format::folder::FolderSource;
use durer::image::{Destination, Display, Format, save_all};
use durer::render::{Panicked, PartError, PartialRender, RenderEvent};
use std::cell::Cell;
use std::path::Path;
use std::time::{Duration, Instant};

/// Time before the first save, unless `--checkpoint-every` is shorter.
const SHORT: Duration = Duration::from_secs(1);

/// Estimated bytes saved per second, used until the first save is measured.
const SAVED_PER_SECOND: u64 = 200_000_000;

/// Saves unfinished work and previews while a long picture is rendered, and restores saved work.
pub struct Autosave {
    /// File of the saved work.
    place: Option<Destination>,
    /// True if the saved work is an output that the user asked for. Otherwise it is kept only until
    /// the picture is written.
    wanted: bool,
    /// Earlier work to continue, if any.
    saved: Cell<Option<Box<PartialRender>>>,
    resume: bool,
    restart: bool,
    quiet: bool,
    preview: Option<(Destination, &'static Format)>,
    display: Display,
    start: Instant,
    short: Duration,
    /// True if this run has saved work to the file.
    is_ours: Cell<bool>,
    /// Duration of the last save.
    saving: Cell<Option<Duration>>,
    /// True after the first warning that saving failed.
    complained: Cell<bool>,
}

impl Autosave {
    /// Checks before the render that its files can be written. Discards saved work only with
    /// `--restart`.
    pub fn new(args: &RenderArgs, output: &Path, guard: &mut Guard) -> Result<Self, Failure> {
        let work = &args.work;
        let (path, option) = match (&work.checkpoint, work.shard) {
            (_, Some(_)) => (output.to_path_buf(), "--output"),
            (Some(path), _) => (path.clone(), "--checkpoint"),
            _ => (lengthened(output, ".part"), "--checkpoint (default PICTURE.part)"),
        };
        let wanted = work.shard.is_some() || work.checkpoint.is_some();
        // A stream has no folder in which to put a checkpoint.
        let beside_stream = !wanted && (output.starts_with("/dev") || output.starts_with("/proc"));
        let place = match work.no_checkpoint || beside_stream {
            true => None,
            false => Some(guard.saves(option, &path)?),
        };
        if let Some(place) = place.as_ref().filter(|place| place.is_stream() && work.shard.is_none()) {
            return Err(bad(format!(
                "{option}: `{}` is not a regular file and cannot hold saved work",
                place.path().display()
            )));
        }
        let saved = match &place {
            Some(place) if !place.is_stream() => what_was_saved(args, place.path())?,
            _ => None,
        };
        // With --watch, the picture grows while it is rendered.
        let growing = args.watch && !output.starts_with("/dev") && args.view.show == ["color"];
        let growing = growing.then(|| Ok::<_, Failure>((Destination::new(output)?, format(output)?))).transpose()?;
        let preview = work.preview.as_ref().map(|path| {
            // Check the format first, because the name can be invalid.
            let format = format(path)?;
            Ok::<_, Failure>((guard.writes("--preview", path)?, format))
        });
        Ok(Autosave {
            place,
            wanted,
            saved: Cell::new(saved),
            resume: work.resume,
            restart: work.restart,
            quiet: args.quiet,
            preview: preview.transpose()?.or(growing),
            display: args.display.display()?,
            start: Instant::now(),
            short: SHORT.min(work.checkpoint_every),
            is_ours: Cell::new(false),
            saving: Cell::new(None),
            complained: Cell::new(false),
        })
    }

    /// Returns the saved work if it belongs to this render, otherwise `fresh`.
    pub fn begin(&self, fresh: PartialRender) -> Result<PartialRender, Failure> {
        let (Some(saved), Some(place)) = (self.saved.take(), &self.place) else { return Ok(fresh) };
        let name = place.path().display();
        let other = |error| bad(format!("cannot continue `{name}`: {error}; --restart discards it and starts again"));
        fresh.same_work(&saved).map_err(other)?;
        if !self.quiet {
            complain(&format!("note: continuing {name}: {} % done", percent(&saved)));
        }
        Ok(*saved)
    }

    /// Saves the work and the preview if they are due.
    pub fn watch(&self, part: &PartialRender, moment: RenderEvent) {
        let due = self.start.elapsed() >= self.short && self.is_worth_saving(part);
        if let Some(place) = self.place.as_ref().filter(|place| due && !place.is_stream()) {
            let before = Instant::now();
            match save_part(place, part) {
                Ok(()) => self.is_ours.set(true),
                // Do not abort: the picture can still be saved elsewhere.
                Err(error) => self.complain(&error),
            }
            self.saving.set(Some(before.elapsed()));
        }
        if let (RenderEvent::PassDone, Some((place, format))) = (moment, &self.preview) {
            let first = part.pictures().ok().and_then(|rendered| rendered.pictures.into_iter().next());
            let Some(layer) = first else { return };
            let bytes = encode(format, &[layer], self.display, &[]);
            if let Ok(Err(error)) = bytes.map(|bytes| save_all(&[(place, bytes)])) {
                self.complain(&error.to_string());
            }
        }
    }

    /// Returns true if the remaining work probably takes longer than saving.
    fn is_worth_saving(&self, part: &PartialRender) -> bool {
        let (all, done) = part.work();
        let left = self.start.elapsed().as_secs_f64() * all.saturating_sub(done) as f64 / done.max(1) as f64;
        let bytes = PartialRender::bytes_needed(part.job(), part.shard());
        let saving = self.saving.get().map_or(bytes as f64 / SAVED_PER_SECOND as f64, |saving| saving.as_secs_f64());
        left > saving
    }

    fn complain(&self, error: &str) {
        if !self.complained.replace(true) {
            complain(&format!("warning: {error}; rendering continues"));
        }
    }

    /// Writes the finished part file of `--shard`.
    pub fn save(&self, part: &PartialRender) -> Result<(), Failure> {
        let Some(place) = &self.place else { return Ok(()) };
        progress::saving();
        save_part(place, part).map_err(|error| Failure::Other(anyhow::anyhow!(error)))?;
        wrote(place, self.quiet);
        Ok(())
    }

    /// Removes saved work that is no longer needed, after the picture was written. Keeps unfinished
    /// work if the user asked for it.
    pub fn done(&self, part: &PartialRender, finished: bool) {
        let Some(place) = &self.place else { return };
        if !finished && (self.wanted || self.resume) {
            if let Err(error) = save_part(place, part) {
                self.complain(&error);
            }
        } else if self.restart
            || self.is_ours.get()
            || read_part(place.path()).is_ok_and(|old| part.same_work(&old).is_ok())
        {
            // Remove only work on this picture, or work that `--restart` discards. If that fails,
            // the file is useless but harmless.
            let _ = std::fs::remove_file(place.path());
        }
    }

    /// Saves the work so far. Returns the names of the written files.
    pub fn after_interrupt(&self, part: &PartialRender) -> Vec<String> {
        let due = |place: &&Destination| part.work().1 > 0 && !place.is_stream();
        let Some(place) = self.place.as_ref().filter(due) else { return Vec::new() };
        progress::saving();
        match save_part(place, part) {
            Ok(()) => vec![format!("{} (--resume continues it)", place.path().display())],
            Err(error) => {
                self.complain(&error);
                Vec::new()
            }
        }
    }

    /// Saves the work after a panic and returns a failure that says how to reproduce the panic.
    pub fn after_panic(&self, part: &PartialRender, panicked: &Panicked, command: &str) -> Failure {
        let saved = self.after_interrupt(part);
        let kept = if saved.is_empty() { String::new() } else { format!("\nthe work so far is in {}", saved.join("")) };
        Failure::Other(anyhow::anyhow!("{panicked}\nto reproduce it: {command}{kept}"))
    }
}

/// Reads earlier work to continue. Fails if the file is not a part file, or if it holds unfinished
/// work and neither `--resume` nor `--restart` is given.
fn what_was_saved(args: &RenderArgs, path: &Path) -> Result<Option<Box<PartialRender>>, Failure> {
    let name = path.display();
    if !path.exists() {
        return Ok(None);
    }
    check_is_part(path).map_err(bad)?;
    let (work, empty) = (&args.work, path.metadata().is_ok_and(|file| file.len() == 0));
    if work.restart || empty && !work.resume {
        return Ok(None);
    }
    let restart = "--restart discards it and starts again";
    let part = match (read_part_of(path), work.resume) {
        (Ok(Ok(part)), true) => return Ok(Some(Box::new(part))),
        (Ok(Ok(part)), false) => part,
        (Ok(Err(error)), true) => return Err(bad(format!("`{name}` cannot be used: {error}; {restart}"))),
        (Ok(Err(error)), false) => return Err(bad(format!("`{name}` holds earlier work, but {error}; {restart}"))),
        (Err(failure), _) => return Err(failure),
    };
    // A finished shard is an output, like a picture. Other part files are removed when the picture
    // is written.
    if work.shard.is_some() && part.is_finished() {
        return Ok(None);
    }
    let percent = percent(&part);
    Err(bad(format!("`{name}` holds unfinished work, {percent} % done: --resume continues it, {restart}")))
}

fn percent(part: &PartialRender) -> u64 {
    let (all, done) = part.work();
    100 * done / all.max(1)
}

/// Checks that a part file can be written here: the file must not exist, or be empty or a part
/// file.
fn check_is_part(path: &Path) -> Result<(), String> {
    let start = match start_of(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
        start => start.map_err(|error| format!("cannot read `{}`: {error}", path.display()))?,
    };
    match PartialRender::MAGIC.starts_with(&start) {
        true => Ok(()),
        false => {
            Err(format!("`{}` is not a part file and must not be overwritten: choose another name", path.display()))
        }
    }
}

/// Writes a part file. Replaces only part files.
fn save_part(place: &Destination, part: &PartialRender) -> Result<(), String> {
    if !place.is_stream() {
        check_is_part(place.path())?;
    }
    save_all(&[(place, part)]).map_err(|error| error.to_string())
}

/// Reads a part file.
pub fn read_part(path: &Path) -> Result<PartialRender, Failure> {
    read_part_of(path)?.map_err(|error| bad(format!("`{}` cannot be used: {error}", path.display())))
}

fn read_part_of(path: &Path) -> Result<Result<PartialRender, PartError>, Failure> {
    let name = path.display().to_string();
    let bytes = FolderSource::new(".").budget(u64::MAX).read_path(path, &name).map_err(report::unreadable)?;
    Ok(PartialRender::read(&bytes))
}
