//! What is saved of work that takes long: checkpoints, parts, previews.

use crate::args::RenderArgs;
use crate::output::{encode, format, lengthened, say};
use crate::{Failure, bad, progress, report};
use durer::image::{Format, SaveError, Transfer, check_target, save};
use durer::render::{Moment, Panicked, Part};
use durer::source::Source;
use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Work that takes less than this is not saved before it is done, unless somebody wants it more often.
const SHORT: Duration = Duration::from_secs(1);

/// Saves work.
pub struct Keeper {
    /// Where it is saved.
    path: Option<PathBuf>,
    /// Whether that is what the user wants in the end, and not only until the picture is there.
    wanted: bool,
    resume: bool,
    quiet: bool,
    preview: Option<(PathBuf, &'static Format)>,
    transfer: Transfer,
    start: Instant,
    short: Duration,
    /// Whether it was said that saving does not work.
    complained: Cell<bool>,
}

impl Keeper {
    /// Says now what is known to prevent saving.
    pub fn new(args: &RenderArgs, output: &Path) -> Result<Self, Failure> {
        let work = &args.work;
        let beside = || (!output.starts_with("/dev")).then(|| lengthened(output, ".part"));
        let path = match () {
            () if work.shard.is_some() => Some(output.to_path_buf()),
            () if work.no_checkpoint => None,
            () => work.checkpoint.clone().or_else(beside),
        };
        if let Some(path) = path.as_ref().filter(|_| work.checkpoint.is_some() || work.resume) {
            check_target(path)?;
        }
        let preview = work.preview.clone().map(|path| Ok::<_, Failure>((format(&path)?, path))).transpose()?;
        if let Some((_, path)) = &preview {
            check_target(path)?;
        }
        Ok(Keeper {
            path,
            wanted: work.shard.is_some() || work.checkpoint.is_some(),
            resume: work.resume,
            quiet: args.quiet,
            preview: preview.map(|(format, path)| (path, format)),
            transfer: Transfer::from_name(&args.transfer).unwrap_or_default(),
            start: Instant::now(),
            short: SHORT.min(work.checkpoint_every),
            complained: Cell::new(false),
        })
    }

    /// The part that was saved, if it is to be gone on with; else a fresh one.
    pub fn begin(&self, fresh: Part) -> Result<Part, Failure> {
        let Some(path) = self.path.as_ref().filter(|path| path.exists()) else { return Ok(fresh) };
        let name = path.display();
        if !self.resume {
            if !self.quiet && !self.wanted {
                report::complain(&format!("note: there is unfinished work in {name}; --resume would go on with it"));
            }
            return Ok(fresh);
        }
        let saved = read_part(path)?;
        fresh.same_work(&saved).map_err(|error| bad(format!("cannot go on with `{name}`: {error}")))?;
        if !self.quiet {
            let (all, done) = saved.work();
            report::complain(&format!("note: going on with {name}: {} % done", 100 * done / all.max(1)));
        }
        Ok(saved)
    }

    /// Saves work and preview.
    pub fn watch(&self, part: &Part, moment: Moment) {
        if self.start.elapsed() >= self.short
            && let Some(Err(error)) = self.path.as_ref().map(|path| save(path, &part.write()))
        {
            // The picture may still be saved somewhere else.
            self.complain(&error.to_string());
        }
        if let (Moment::PassDone, Some((path, format))) = (moment, &self.preview) {
            let first = part.pictures().ok().and_then(|rendered| rendered.pictures.into_iter().next());
            let Some(layer) = first else { return };
            let bytes = encode(format, &[layer], self.transfer, &[]);
            if let Ok(Err(error)) = bytes.map(|bytes| save(path, &bytes)) {
                self.complain(&error.to_string());
            }
        }
    }

    fn complain(&self, error: &str) {
        if !self.complained.replace(true) {
            report::complain(&format!("warning: {error}; rendering goes on"));
        }
    }

    /// Saves a part that is wanted.
    pub fn save(&self, part: &Part) -> Result<(), SaveError> {
        let Some(path) = &self.path else { return Ok(()) };
        progress::saving();
        save(path, &part.write())?;
        if !self.quiet {
            say(&format!("wrote {}", path.display()));
        }
        Ok(())
    }

    /// The picture is saved. Work that is finished is not needed any more.
    pub fn done(&self, part: &Part, finished: bool) {
        let Some(path) = &self.path else { return };
        if !finished && (self.wanted || self.resume) {
            if let Err(error) = save(path, &part.write()) {
                self.complain(&error.to_string());
            }
        } else if read_part(path).is_ok_and(|old| part.same_work(&old).is_ok()) {
            // Only what is of this picture; if it cannot be removed, it is only in the way.
            let _ = std::fs::remove_file(path);
        }
    }

    /// Saves what is there. The names of the files that were written.
    pub fn after_interrupt(&self, part: &Part) -> Vec<String> {
        let Some(path) = self.path.as_ref().filter(|_| part.work().1 > 0) else { return Vec::new() };
        progress::saving();
        match save(path, &part.write()) {
            Ok(()) => vec![format!("{} (--resume goes on with it)", path.display())],
            Err(error) => {
                self.complain(&error.to_string());
                Vec::new()
            }
        }
    }

    /// Saves what is there after an error in this program, and says how to see it again.
    pub fn after_panic(&self, part: &Part, panicked: &Panicked, command: &str) -> Failure {
        let saved = self.after_interrupt(part);
        let kept = if saved.is_empty() { String::new() } else { format!("\nwhat was made is in {}", saved.join("")) };
        Failure::Other(anyhow::anyhow!("{panicked}\nto see it alone: {command}{kept}"))
    }
}

/// Reads a part from a file.
pub fn read_part(path: &Path) -> Result<Part, Failure> {
    let name = path.display().to_string();
    let bytes = Source::folder(".").budget(u64::MAX).read_path(path, &name).map_err(report::unreadable)?;
    Part::read(&bytes).map_err(|error| bad(format!("`{name}` cannot be used: {error}")))
}
