//! Pictures into files.

use crate::{Failure, bad};
use durer::image::{Depth, Format, Layer, Transfer, WriteOptions, format_for, save_all};
use durer::render::Rendered;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The format of a picture's name, or what is wrong with the name.
pub fn format(path: &Path) -> Result<&'static Format, Failure> {
    format_for(path).map_err(|error| bad(error.to_string()))
}

/// The layers as a format holds them: values in floating point, pictures in eight bits.
pub fn layers<'r>(rendered: &'r Rendered, format: &Format) -> &'r [Layer] {
    match format.depth {
        Depth::Float => &rendered.layers,
        Depth::EightBit => &rendered.pictures,
    }
}

/// The files for some layers: one if they fit into it, else one for each, named picture.depth.png.
pub fn files(
    path: &Path,
    format: &Format,
    layers: &[Layer],
    transfer: Transfer,
) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    if layers.len() == 1 || format.layers {
        return Ok(vec![(path.to_path_buf(), encode(format, layers, transfer)?)]);
    }
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    let named = |layer: &Layer| path.with_extension(format!("{}.{extension}", layer.name));
    layers.iter().map(|layer| Ok((named(layer), encode(format, std::slice::from_ref(layer), transfer)?))).collect()
}

/// The bytes of one file.
pub fn encode(format: &Format, layers: &[Layer], transfer: Transfer) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    format.write(layers, &WriteOptions { transfer }, &mut bytes)?;
    Ok(bytes)
}

/// Saves all files or none, and says so.
pub fn save(files: &[(PathBuf, Vec<u8>)], quiet: bool) -> Result<(), Failure> {
    save_all(files)?;
    if !quiet {
        for (path, _) in files {
            say(&format!("wrote {}", path.display()));
        }
    }
    Ok(())
}

/// A line on standard output; a closed pipe is nobody's fault.
pub fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}
