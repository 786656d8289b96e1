//! `durer photo explain`: explains a camera or a point.

use super::args::ExplainArgs;
use super::inputs::{read, wrong};
use crate::failure::Failure;
use crate::guard::Guard;
use crate::terminal::say;
use durer_photo::explain;

/// Runs `durer photo explain`.
pub fn run(args: &ExplainArgs) -> Result<(), Failure> {
    let all = read(&args.file, args.pictures.as_deref(), &mut Guard::default())?;
    let text = match (&args.camera, args.point) {
        (Some(name), _) => explain::find_view(&all, name).and_then(|view| explain::camera(&all, view)),
        (None, point) => explain::point(&all, point.unwrap_or(0)),
    };
    say(text.map_err(wrong)?.trim_end());
    Ok(())
}
