//! Checkpoints, part files and previews for long renders.

use crate::display::DisplayArgs;
use crate::failure::{Failure, invalid_input};
use crate::file_registry::{FileRegistry, start_of};
use crate::options::RenderArgs;
use crate::output::{encode, format, print_written, with_suffix};
use crate::terminal::print_error_line;
use crate::terminal_picture::TerminalPicture;
use crate::{progress, report};
use durer::format::folder::FolderSource;
use durer::image::{Destination, Display, Format, Layer, save_all};
use durer::options::memory::Memory;
use durer::render::{Panicked, PartError, PartialRender, RenderEvent};
use std::cell::Cell;
use std::path::Path;
use std::time::{Duration, Instant};

/// Time before the first save, unless `--checkpoint-every` is shorter.
const SHORT: Duration = Duration::from_secs(1);

/// Estimated number of bytes saved per second, used until the first save has been measured.
const SAVED_PER_SECOND: u64 = 200_000_000;

/// Saves unfinished work and previews while a long picture is being rendered, and restores saved
/// work.
pub struct Autosave {
    /// File for the saved work.
    destination: Option<Destination>,
    /// True if the saved work is an output that the user asked for. Otherwise, the file is kept
    /// only until the picture has been written.
    is_output: bool,
    /// Earlier work to continue, if there is any.
    saved: Cell<Option<Box<PartialRender>>>,
    resume: bool,
    restart: bool,
    quiet: bool,
    preview: Option<(Destination, &'static Format)>,
    terminal: Option<TerminalPicture>,
    display: DisplayArgs,
    start: Instant,
    first_save_after: Duration,
    /// True if this run has already saved work to the file.
    saved_by_this_run: Cell<bool>,
    /// Duration of the last save.
    saving: Cell<Option<Duration>>,
    /// True after the first warning that saving failed.
    warned: Cell<bool>,
}

impl Autosave {
    /// Checks that its files can be written before the render starts. Discards saved work only if
    /// `--restart` is given.
    pub fn new(args: &RenderArgs, output: &Path, registry: &mut FileRegistry) -> Result<Self, Failure> {
        let work = &args.work;
        let (path, option) = match (&work.checkpoint, work.shard) {
            (_, Some(_)) => (output.to_path_buf(), "--output"),
            (Some(path), _) => (path.clone(), "--checkpoint"),
            _ => (with_suffix(output, ".part"), "--checkpoint (default PICTURE.part)"),
        };
        let wanted = work.shard.is_some() || work.checkpoint.is_some();
        // A stream has no folder that could hold a checkpoint.
        let beside_stream = !wanted && (output.starts_with("/dev") || output.starts_with("/proc"));
        let destination = match work.no_checkpoint || beside_stream {
            true => None,
            false => Some(registry.register_saved_work(option, &path)?),
        };
        if let Some(destination) =
            destination.as_ref().filter(|destination| destination.is_stream() && work.shard.is_none())
        {
            return Err(invalid_input(format!(
                "{option}: `{}` is not a regular file and cannot hold saved work",
                destination.path().display()
            )));
        }
        let saved = match &destination {
            Some(destination) if !destination.is_stream() => read_saved_work(args, destination.path())?,
            _ => None,
        };
        // With --watch, the picture on disk grows while it is being rendered.
        let growing = args.watch && !output.starts_with("/dev") && args.view.show == ["color"];
        let growing = growing.then(|| Ok::<_, Failure>((Destination::new(output)?, format(output)?))).transpose()?;
        let preview = work.preview.as_ref().map(|path| {
            // Check the format first because the name can be invalid.
            let format = format(path)?;
            Ok::<_, Failure>((registry.register_output("--preview", path)?, format))
        });
        Ok(Autosave {
            destination,
            is_output: wanted,
            saved: Cell::new(saved),
            resume: work.resume,
            restart: work.restart,
            quiet: args.quiet,
            preview: preview.transpose()?.or(growing),
            terminal: work.terminal.map(TerminalPicture::new).transpose()?,
            display: args.display.clone(),
            start: Instant::now(),
            first_save_after: SHORT.min(work.checkpoint_every),
            saved_by_this_run: Cell::new(false),
            saving: Cell::new(None),
            warned: Cell::new(false),
        })
    }

    /// Returns the saved work if it belongs to this render, and `fresh` otherwise.
    pub fn begin(&self, fresh: PartialRender) -> Result<PartialRender, Failure> {
        let (Some(saved), Some(destination)) = (self.saved.take(), &self.destination) else { return Ok(fresh) };
        let name = destination.path().display();
        let other = |error| {
            invalid_input(format!(
                "cannot continue `{name}`: {error}; pass --restart to discard the file and start again"
            ))
        };
        fresh.same_work(&saved).map_err(other)?;
        if !self.quiet {
            print_error_line(&format!("note: continuing {name}: {} % done", percent(&saved)));
        }
        Ok(*saved)
    }

    /// Saves the work and the preview if it is time to do so.
    pub fn watch(&self, part: &PartialRender, moment: RenderEvent) {
        let due = self.start.elapsed() >= self.first_save_after && self.is_worth_saving(part);
        if let Some(destination) = self.destination.as_ref().filter(|destination| due && !destination.is_stream()) {
            let before = Instant::now();
            match save_part(destination, part) {
                Ok(()) => self.saved_by_this_run.set(true),
                // Do not abort, because the picture can still be saved elsewhere.
                Err(error) => self.warn_once(&error),
            }
            self.saving.set(Some(before.elapsed()));
        }
        if moment == RenderEvent::PassDone && (self.preview.is_some() || self.terminal.is_some()) {
            let first = part.pictures().ok().and_then(|rendered| rendered.pictures.into_iter().next());
            let Some(layer) = first else { return };
            let display = self.display.display(Some(&layer.image.pixels));
            if let Some(terminal) = &self.terminal {
                terminal.draw(&layer, display, &format!("{} %", percent(part)));
            }
            let Some((destination, format)) = &self.preview else { return };
            let bytes = encode(format, &[layer], display, &[]);
            if let Ok(Err(error)) = bytes.map(|bytes| save_all(&[(destination, bytes)])) {
                self.warn_once(&error.to_string());
            }
        }
    }

    /// Returns true if the picture is drawn in the terminal.
    pub fn draws_in_terminal(&self) -> bool {
        self.terminal.is_some()
    }

    /// Draws the final picture in the terminal.
    pub fn draw_final(&self, layer: &Layer, display: Display) {
        if let Some(terminal) = &self.terminal {
            terminal.draw(layer, display, "");
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

    fn warn_once(&self, error: &str) {
        if !self.warned.replace(true) {
            print_error_line(&format!("warning: {error}; rendering continues"));
        }
    }

    /// Writes the finished part file that `--shard` produces.
    pub fn save(&self, part: &PartialRender) -> Result<(), Failure> {
        let Some(destination) = &self.destination else { return Ok(()) };
        progress::saving();
        save_part(destination, part).map_err(|error| Failure::Other(anyhow::anyhow!(error)))?;
        print_written(destination, self.quiet);
        Ok(())
    }

    /// After the picture has been written, removes saved work that is no longer needed. Unfinished
    /// work is kept if the user asked for it.
    pub fn done(&self, part: &PartialRender, finished: bool) {
        let Some(destination) = &self.destination else { return };
        if !finished && (self.is_output || self.resume) {
            if let Err(error) = save_part(destination, part) {
                self.warn_once(&error);
            }
        } else if self.restart
            || self.saved_by_this_run.get()
            || read_part(destination.path()).is_ok_and(|old| part.same_work(&old).is_ok())
        {
            // Remove only work on this picture, or work that `--restart` discards. If the removal
            // fails, the file is useless but harmless.
            let _ = std::fs::remove_file(destination.path());
        }
    }

    /// Saves the work so far. Returns the names of the written files.
    pub fn after_interrupt(&self, part: &PartialRender) -> Vec<String> {
        let due = |destination: &&Destination| part.work().1 > 0 && !destination.is_stream();
        let Some(destination) = self.destination.as_ref().filter(due) else { return Vec::new() };
        progress::saving();
        match save_part(destination, part) {
            Ok(()) => vec![format!("{} (--resume continues from this file)", destination.path().display())],
            Err(error) => {
                self.warn_once(&error);
                Vec::new()
            }
        }
    }

    /// Saves the work after a panic and returns a failure that says how to reproduce the panic.
    pub fn after_panic(&self, part: &PartialRender, panicked: &Panicked, command: &str) -> Failure {
        let saved = self.after_interrupt(part);
        let note = if saved.is_empty() { String::new() } else { format!("\nthe work so far is in {}", saved.join("")) };
        Failure::Other(anyhow::anyhow!("{panicked}\nto reproduce the error, run: {command}{note}"))
    }
}

/// Reads earlier work in order to continue it. Fails if the file is not a part file. Also fails if
/// it holds unfinished work and neither `--resume` nor `--restart` is given.
fn read_saved_work(args: &RenderArgs, path: &Path) -> Result<Option<Box<PartialRender>>, Failure> {
    let name = path.display();
    if !path.exists() {
        return Ok(None);
    }
    check_is_part(path).map_err(invalid_input)?;
    let (work, empty) = (&args.work, path.metadata().is_ok_and(|file| file.len() == 0));
    if work.restart || empty && !work.resume {
        return Ok(None);
    }
    let restart = "pass --restart to discard the file and start again";
    let part = match (read_part_of(path), work.resume) {
        (Ok(Ok(part)), true) => return Ok(Some(Box::new(part))),
        (Ok(Ok(part)), false) => part,
        (Ok(Err(error)), true) => return Err(invalid_input(format!("`{name}` cannot be used: {error}; {restart}"))),
        (Ok(Err(error)), false) => {
            return Err(invalid_input(format!("`{name}` holds earlier work, but {error}; {restart}")));
        }
        (Err(failure), _) => return Err(failure),
    };
    // A finished shard is an output, like a picture. Other part files are removed once the picture
    // has been written.
    if work.shard.is_some() && part.is_finished() {
        return Ok(None);
    }
    let percent = percent(&part);
    Err(invalid_input(format!(
        "`{name}` holds unfinished work ({percent} % done): pass --resume to continue from the file, or {restart}"
    )))
}

fn percent(part: &PartialRender) -> u64 {
    let (all, done) = part.work();
    100 * done / all.max(1)
}

/// Checks that a part file can be written to this path. Either the file does not exist, or it is
/// empty or a part file.
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

/// Writes a part file. Replaces an existing file only if it is a part file.
fn save_part(destination: &Destination, part: &PartialRender) -> Result<(), String> {
    if !destination.is_stream() {
        check_is_part(destination.path())?;
    }
    save_all(&[(destination, part)]).map_err(|error| error.to_string())
}

/// Reads a part file.
pub fn read_part(path: &Path) -> Result<PartialRender, Failure> {
    read_part_of(path)?.map_err(|error| invalid_input(format!("`{}` cannot be used: {error}", path.display())))
}

fn read_part_of(path: &Path) -> Result<Result<PartialRender, PartError>, Failure> {
    let name = path.display().to_string();
    let source = FolderSource::new(".").budget(Memory::default().limit());
    let bytes = source.read_path(path, &name).map_err(report::unreadable)?;
    Ok(PartialRender::read(&bytes))
}
