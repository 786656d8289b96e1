//! Renders pictures that are larger than memory while they are written.

use crate::failure::{Failure, bad, failed};
use crate::options::RenderArgs;
use crate::output::{Target, wrote};
use crate::progress;
use crate::report::rejected;
use crate::terminal::say;
use durer::image::{Content, FORMATS, Format, MAX_PIXELS, WriteOptions, save_all};
use durer::render::{BandedRender, BandsError, Control, Job, RenderError, Statistics};
use durer::source::Digest;
use durer::world::World;
use std::cell::RefCell;
use std::io::{self, Write};
use std::sync::Arc;

/// Returns true if a picture exceeds the memory limit, or the maximum size of pictures in memory.
pub fn is_large(job: &Job, needed: u64, memory: Option<u64>) -> bool {
    job.window().pixels() > MAX_PIXELS || memory.is_some_and(|memory| needed > memory)
}

/// Divides a large picture into bands. Fails with the reason if that is not possible.
pub fn bands(args: &RenderArgs, job: &Job, target: &Target, memory: Option<u64>) -> Result<BandedRender, Failure> {
    let refuse = |why: &str| Err(failed(RenderError::Bands(why.into())));
    let (work, window) = (&args.work, job.window());
    let Some((_, format)) = target.single() else {
        return refuse("it includes pictures other than the colour picture");
    };
    if format.rows.is_none() {
        let others: Vec<_> = FORMATS.iter().filter(|format| format.rows.is_some()).map(|format| format.name).collect();
        return refuse(&format!("{} needs all rows at once; use one of {}", format.name, others.join(", ")));
    }
    format.check_sides(window.width, window.height).map_err(|error| bad(error.to_string()))?;
    for (given, option) in [
        (work.resume || work.restart || work.checkpoint.is_some(), "saved work"),
        (work.preview.is_some(), "--preview"),
        (work.time.is_some(), "--time-limit"),
        (args.denoise.is_some(), "--denoise"),
        (args.stats, "--stats"),
    ] {
        if given {
            return refuse(&format!("{option} needs the full picture in memory"));
        }
    }
    // The scene's size is not known yet, so reserve half of the memory for it.
    BandedRender::new(job, memory.map_or(u64::MAX, |memory| memory / 2)).map_err(|error| match (error, memory) {
        (RenderError::Memory { needed, .. }, Some(allowed)) => {
            failed(RenderError::Memory { needed: needed.saturating_mul(2), allowed })
        }
        (error, _) => failed(error),
    })
}

/// Statistics and hash of a written picture, or an error.
type WriteResult = Result<(Statistics, Option<Digest>), BandsError>;

/// Source of a large picture's file content: renders the picture in bands while it is written.
struct Large<'a> {
    bands: &'a BandedRender,
    world: &'a World,
    control: &'a Control,
    format: &'a Format,
    options: WriteOptions<'a>,
    /// Result of the render, set by `write_to`.
    made: RefCell<Option<WriteResult>>,
}

impl Content for &Large<'_> {
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut out = io::BufWriter::new(out);
        let made = self.bands.write(self.world, self.control, self.format, &self.options, &mut out);
        let made = made.and_then(|made| Ok(out.flush().map(|()| made)?));
        let result = if made.is_ok() { Ok(()) } else { Err(io::Error::other("the picture was not rendered")) };
        *self.made.borrow_mut() = Some(made);
        result
    }
}

/// Renders and writes a large picture.
pub fn render(
    bands: &BandedRender,
    world: &World,
    control: &Arc<Control>,
    target: &Target,
    args: &RenderArgs,
) -> Result<(), Failure> {
    let Some((place, format)) = target.single() else { return Ok(()) };
    let options = WriteOptions { display: args.display.display()?, attributes: &[] };
    let large = Large { bands, world, control, format, options, made: RefCell::new(None) };
    let saved = progress::watch(control, args.quiet, || Ok(save_all(&[(place, &large)]))).map_err(failed)?;
    let (statistics, hash) = match large.made.take() {
        Some(Err(BandsError::Render(error))) => return Err(failed(error)),
        Some(Err(BandsError::Image(error))) => return Err(bad(error.to_string())),
        Some(Err(BandsError::Io(error))) => {
            return Err(Failure::Other(anyhow::anyhow!("cannot write `{}`: {error}", place.path().display())));
        }
        Some(Ok(made)) => saved.map(|()| made)?,
        None => return Ok(saved?),
    };
    wrote(place, args.quiet);
    rejected(&statistics, None, args.quiet);
    match hash {
        Some(hash) if args.hash => say(&hash.to_string()),
        None if args.hash => {
            return Err(bad("--hash: this format stores the bottom row first; use PNG, PPM or HDR"));
        }
        _ => {}
    }
    Ok(())
}
