//! What is saved of work that takes long: checkpoints, parts, previews.

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

/// Work that takes less than this is not saved before it is done, unless somebody wants it more
/// often.
const SHORT: Duration = Duration::from_secs(1);

/// Bytes of work that are taken to be saved in a second, as long as none were.
const SAVED_PER_SECOND: u64 = 200_000_000;

/// Saves work.
pub struct Keeper {
    /// Where it is saved.
    place: Option<Destination>,
    /// Whether that is what the user wants in the end, and not only until the picture is there.
    wanted: bool,
    /// What was saved before and is gone on with.
    saved: Cell<Option<Box<PartialRender>>>,
    resume: bool,
    restart: bool,
    quiet: bool,
    preview: Option<(Destination, &'static Format)>,
    display: Display,
    start: Instant,
    short: Duration,
    /// Whether what is saved there is this work, as far as it was then.
    is_ours: Cell<bool>,
    /// How long saving took the last time.
    saving: Cell<Option<Duration>>,
    /// Whether it was said that saving does not work.
    complained: Cell<bool>,
}

impl Keeper {
    /// Says now what is known to prevent saving. Nothing that is saved is thrown away unless
    /// `--restart` says so.
    pub fn new(args: &RenderArgs, output: &Path, guard: &mut Guard) -> Result<Self, Failure> {
        let work = &args.work;
        let (path, option) = match (&work.checkpoint, work.shard) {
            (_, Some(_)) => (output.to_path_buf(), "--output"),
            (Some(path), _) => (path.clone(), "--checkpoint"),
            _ => (lengthened(output, ".part"), "--checkpoint, which is PICTURE.part unless given,"),
        };
        let wanted = work.shard.is_some() || work.checkpoint.is_some();
        // Beside a stream there is no place.
        let beside_stream = !wanted && (output.starts_with("/dev") || output.starts_with("/proc"));
        let place = match work.no_checkpoint || beside_stream {
            true => None,
            false => Some(guard.saves(option, &path)?),
        };
        if let Some(place) = place.as_ref().filter(|place| place.is_stream() && work.shard.is_none()) {
            return Err(bad(format!("{option}: `{}` is no file, and cannot keep anything", place.path().display())));
        }
        let saved = match &place {
            Some(place) if !place.is_stream() => what_was_saved(args, place.path())?,
            _ => None,
        };
        // Who watches sees the picture while it is made.
        let growing = args.watch && !output.starts_with("/dev") && args.view.show == ["color"];
        let growing = growing.then(|| Ok::<_, Failure>((Destination::new(output)?, format(output)?))).transpose()?;
        let preview = work.preview.as_ref().map(|path| {
            // The name first: it may be wrong altogether.
            let format = format(path)?;
            Ok::<_, Failure>((guard.writes("--preview", path)?, format))
        });
        Ok(Keeper {
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

    /// The part that was saved, if it is to be gone on with; else a fresh one.
    pub fn begin(&self, fresh: PartialRender) -> Result<PartialRender, Failure> {
        let (Some(saved), Some(place)) = (self.saved.take(), &self.place) else { return Ok(fresh) };
        let name = place.path().display();
        let other =
            |error| bad(format!("cannot go on with `{name}`: {error}; --restart throws it away and begins anew"));
        fresh.same_work(&saved).map_err(other)?;
        if !self.quiet {
            complain(&format!("note: going on with {name}: {} % done", percent(&saved)));
        }
        Ok(*saved)
    }

    /// Saves work and preview.
    pub fn watch(&self, part: &PartialRender, moment: RenderEvent) {
        let due = self.start.elapsed() >= self.short && self.is_worth_saving(part);
        if let Some(place) = self.place.as_ref().filter(|place| due && !place.is_stream()) {
            let before = Instant::now();
            match save_part(place, part) {
                Ok(()) => self.is_ours.set(true),
                // The picture may still be saved somewhere else.
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

    /// Whether what is left of the work takes longer than saving does.
    fn is_worth_saving(&self, part: &PartialRender) -> bool {
        let (all, done) = part.work();
        let left = self.start.elapsed().as_secs_f64() * all.saturating_sub(done) as f64 / done.max(1) as f64;
        let bytes = PartialRender::bytes_needed(part.job(), part.shard());
        let saving = self.saving.get().map_or(bytes as f64 / SAVED_PER_SECOND as f64, |saving| saving.as_secs_f64());
        left > saving
    }

    fn complain(&self, error: &str) {
        if !self.complained.replace(true) {
            complain(&format!("warning: {error}; rendering goes on"));
        }
    }

    /// Saves a part that is wanted.
    pub fn save(&self, part: &PartialRender) -> Result<(), Failure> {
        let Some(place) = &self.place else { return Ok(()) };
        progress::saving();
        save_part(place, part).map_err(|error| Failure::Other(anyhow::anyhow!(error)))?;
        wrote(place, self.quiet);
        Ok(())
    }

    /// The picture is saved. Work that is finished is not needed any more.
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
            // Only what is of this picture, or was to be thrown away; if it cannot be removed, it
            // is only in the way.
            let _ = std::fs::remove_file(place.path());
        }
    }

    /// Saves what is there. The names of the files that were written.
    pub fn after_interrupt(&self, part: &PartialRender) -> Vec<String> {
        let due = |place: &&Destination| part.work().1 > 0 && !place.is_stream();
        let Some(place) = self.place.as_ref().filter(due) else { return Vec::new() };
        progress::saving();
        match save_part(place, part) {
            Ok(()) => vec![format!("{} (--resume goes on with it)", place.path().display())],
            Err(error) => {
                self.complain(&error);
                Vec::new()
            }
        }
    }

    /// Saves what is there after an error in this program, and says how to see it again.
    pub fn after_panic(&self, part: &PartialRender, panicked: &Panicked, command: &str) -> Failure {
        let saved = self.after_interrupt(part);
        let kept = if saved.is_empty() { String::new() } else { format!("\nwhat was made is in {}", saved.join("")) };
        Failure::Other(anyhow::anyhow!("{panicked}\nto see it alone: {command}{kept}"))
    }
}

/// What was saved in a file and is to be gone on with. Refuses to replace what is no part at all,
/// and without `--resume` or `--restart` what is not finished.
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
    let restart = "--restart throws it away and begins anew";
    let part = match (read_part_of(path), work.resume) {
        (Ok(Ok(part)), true) => return Ok(Some(Box::new(part))),
        (Ok(Ok(part)), false) => part,
        (Ok(Err(error)), true) => return Err(bad(format!("`{name}` cannot be used: {error}; {restart}"))),
        (Ok(Err(error)), false) => return Err(bad(format!("`{name}` was saved before, and {error}; {restart}"))),
        (Err(failure), _) => return Err(failure),
    };
    // A shard is what is wanted, as a picture is. Beside a picture there is a part only as long as
    // there is no picture of it.
    if work.shard.is_some() && part.is_finished() {
        return Ok(None);
    }
    let percent = percent(&part);
    Err(bad(format!("there is unfinished work in `{name}`, {percent} % done: --resume goes on with it, {restart}")))
}

fn percent(part: &PartialRender) -> u64 {
    let (all, done) = part.work();
    100 * done / all.max(1)
}

/// Whether a file may be replaced by a part: one that is there already, if it is one itself or
/// empty.
fn check_is_part(path: &Path) -> Result<(), String> {
    let start = match start_of(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
        start => start.map_err(|error| format!("cannot read `{}`: {error}", path.display()))?,
    };
    match PartialRender::MAGIC.starts_with(&start) {
        true => Ok(()),
        false => Err(format!(
            "`{}` is no part of a picture, and is not replaced by one: choose another name",
            path.display()
        )),
    }
}

/// Saves a part, over nothing but a part.
fn save_part(place: &Destination, part: &PartialRender) -> Result<(), String> {
    if !place.is_stream() {
        check_is_part(place.path())?;
    }
    save_all(&[(place, part)]).map_err(|error| error.to_string())
}

/// Reads a part from a file.
pub fn read_part(path: &Path) -> Result<PartialRender, Failure> {
    read_part_of(path)?.map_err(|error| bad(format!("`{}` cannot be used: {error}", path.display())))
}

fn read_part_of(path: &Path) -> Result<Result<PartialRender, PartError>, Failure> {
    let name = path.display().to_string();
    let bytes = FolderSource::new(".").budget(u64::MAX).read_path(path, &name).map_err(report::unreadable)?;
    Ok(PartialRender::read(&bytes))
}
