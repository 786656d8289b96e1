//! Implements `durer photo explain`, which explains a camera or a point.

use super::args::ExplainArgs;
use super::inputs::{from_photo_error, read};
use crate::failure::Failure;
use crate::file_registry::FileRegistry;
use crate::terminal::print_line;
use durer_photo::explain;

/// Runs `durer photo explain`.
pub fn run(args: &ExplainArgs) -> Result<(), Failure> {
    let all = read(&args.file, args.pictures.as_deref(), &mut FileRegistry::default())?;
    let text = match (&args.camera, args.point) {
        (Some(name), _) => explain::find_view(&all, name).and_then(|view| explain::camera(&all, view)),
        (None, point) => explain::point(&all, point.unwrap_or(0)),
    };
    print_line(text.map_err(from_photo_error)?.trim_end());
    Ok(())
}
