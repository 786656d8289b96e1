//! `--turntable`: pictures all around a model.

use crate::args::RenderCommand;
use crate::render::{self, Watched};
use crate::{Failure, bad};
use std::path::Path;

/// Renders the model from so many sides, each into a picture of its own: `picture.000.png` and so on.
pub fn run(command: &mut RenderCommand, frames: u16) -> Result<(), Failure> {
    let args = &mut command.render;
    if args.work.shard.is_some() || args.work.checkpoint.is_some() || args.work.preview.is_some() {
        return Err(bad("--turntable makes many pictures: it goes with no --shard, --checkpoint and --preview"));
    }
    if command.pixel.is_some() {
        return Err(bad("--turntable makes many pictures: --pixel looks at one"));
    }
    let output = render::output_of(args);
    let digits = (frames - 1).to_string().len().max(3);
    for frame in 0..frames {
        command.render.reading.staging.turned = Some(360.0 * f32::from(frame) / f32::from(frames));
        command.render.output = Some(numbered(&output, frame, digits));
        render::once(command, &Watched::default())?;
    }
    Ok(())
}

/// `picture.007.png`
fn numbered(path: &Path, frame: u16, digits: usize) -> std::path::PathBuf {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    path.with_extension(format!("{frame:0digits$}.{extension}"))
}
