//! Renders pictures that are larger than memory and writes them at the same time.

use crate::display::Exposure;
use crate::failure::{Failure, from_render_error, invalid_input};
use crate::options::RenderArgs;
use crate::output::{Target, print_written};
use crate::progress;
use crate::report::rejected;
use crate::terminal::print_line;
use durer::image::{Content, FORMATS, Format, MAX_PIXELS, WriteOptions, save_all};
use durer::render::{BandedRender, BandsError, Control, Job, RenderError, Statistics};
use durer::source::Digest;
use durer::world::World;
use std::cell::RefCell;
use std::io::{self, Write};
use std::sync::Arc;

/// Returns true if a picture exceeds the memory limit or the maximum size of pictures in memory.
pub fn is_large(job: &Job, needed: u64, memory: Option<u64>) -> bool {
    job.window().pixels() > MAX_PIXELS || memory.is_some_and(|memory| needed > memory)
}

/// Divides a large picture into bands. Fails with the reason if this is not possible.
pub fn bands(args: &RenderArgs, job: &Job, target: &Target, memory: Option<u64>) -> Result<BandedRender, Failure> {
    let refuse = |why: &str| Err(from_render_error(RenderError::Bands(why.into())));
    let (work, window) = (&args.work, job.window());
    let Some((_, format)) = target.single() else {
        return refuse("the output includes pictures other than the colour picture");
    };
    if format.rows.is_none() {
        let others: Vec<_> = FORMATS.iter().filter(|format| format.rows.is_some()).map(|format| format.name).collect();
        return refuse(&format!("{} needs all rows at once; use one of {}", format.name, others.join(", ")));
    }
    format.check_sides(window.width, window.height).map_err(|error| invalid_input(error.to_string()))?;
    for (given, option) in [
        (work.resume || work.restart || work.checkpoint.is_some(), "saved work"),
        (work.preview.is_some(), "--preview"),
        (work.terminal.is_some(), "--terminal"),
        (work.time.is_some(), "--time-limit"),
        (args.denoise.is_some(), "--denoise"),
        (args.stats.is_some(), "--stats"),
    ] {
        if given {
            return refuse(&format!("{option} needs the full picture in memory"));
        }
    }
    // The memory that the scene needs is not known yet, so half of the memory is reserved for it.
    BandedRender::new(job, memory.map_or(u64::MAX, |memory| memory / 2)).map_err(|error| match (error, memory) {
        (RenderError::Memory { needed, .. }, Some(allowed)) => {
            from_render_error(RenderError::Memory { needed: needed.saturating_mul(2), allowed })
        }
        (error, _) => from_render_error(error),
    })
}

/// Statistics and hash of a picture that was written, or an error.
type WriteResult = Result<(Statistics, Option<Digest>), BandsError>;

/// Source of the file contents of a large picture. It renders the picture in bands while the file
/// is written.
struct BandedPicture<'a> {
    bands: &'a BandedRender,
    world: &'a World,
    control: &'a Control,
    format: &'a Format,
    options: WriteOptions<'a>,
    /// Result of the render. `write_to` sets it.
    result: RefCell<Option<WriteResult>>,
}

impl Content for &BandedPicture<'_> {
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut out = io::BufWriter::new(out);
        let written = self.bands.write(self.world, self.control, self.format, &self.options, &mut out);
        let written = written.and_then(|written| Ok(out.flush().map(|()| written)?));
        let result = if written.is_ok() { Ok(()) } else { Err(io::Error::other("the picture was not rendered")) };
        *self.result.borrow_mut() = Some(written);
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
    let Some((destination, format)) = target.single() else { return Ok(()) };
    if args.display.exposure.exposure == Exposure::Auto {
        return Err(invalid_input(
            "--exposure auto needs the whole picture in memory: increase --memory, or give the stops",
        ));
    }
    let options = WriteOptions { display: args.display.display(None), attributes: &[] };
    let large = BandedPicture { bands, world, control, format, options, result: RefCell::new(None) };
    let saved =
        progress::watch(control, args.quiet, || Ok(save_all(&[(destination, &large)]))).map_err(from_render_error)?;
    let (statistics, hash) = match large.result.take() {
        Some(Err(BandsError::Render(error))) => return Err(from_render_error(error)),
        Some(Err(BandsError::Image(error))) => return Err(invalid_input(error.to_string())),
        Some(Err(BandsError::Io(error))) => {
            return Err(Failure::Other(anyhow::anyhow!("cannot write `{}`: {error}", destination.path().display())));
        }
        Some(Ok(result)) => saved.map(|()| result)?,
        None => return Ok(saved?),
    };
    print_written(destination, args.quiet);
    rejected(&statistics, None, args.quiet);
    match hash {
        Some(hash) if args.hash => print_line(&hash.to_string()),
        None if args.hash => {
            return Err(invalid_input("--hash needs a format that stores the top row first: use PNG, PPM or HDR"));
        }
        _ => {}
    }
    Ok(())
}
