//! Pictures into files.

use crate::args::DIAGRAMS;
use crate::{Failure, bad, progress};
use durer::image::{Depth, Format, Layer, Transfer, WriteOptions, check_target, format_for, save_all};
use durer::render::Rendered;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// The format of a picture's name, or what is wrong with the name.
pub fn format(path: &Path) -> Result<&'static Format, Failure> {
    format_for(path).map_err(|error| bad(error.to_string()))
}

/// The layers as a format holds them: values in floating point, pictures in eight bits.
fn layers<'r>(rendered: &'r Rendered, format: &Format) -> &'r [Layer] {
    match format.depth {
        Depth::Float => &rendered.layers,
        Depth::EightBit => &rendered.pictures,
    }
}

/// Where the pictures of a render go.
pub struct Target {
    path: PathBuf,
    format: &'static Format,
    /// Whether all go into one file. Diagrams do not: their sizes differ.
    together: bool,
}

impl Target {
    /// For the named pictures; says now what is known to prevent writing them, which is better than after the work.
    pub fn new(path: PathBuf, names: &[&str]) -> Result<Self, Failure> {
        let format = format(&path)?;
        let diagram = names.iter().any(|name| DIAGRAMS.contains(name));
        let target = Target { together: names.len() == 1 || format.layers && !diagram, path, format };
        names.iter().try_for_each(|name| check_target(target.file(name)))?;
        Ok(target)
    }

    /// Whether pictures of this size fit into the files.
    pub fn check_size(&self, width: u32, height: u32) -> Result<(), Failure> {
        self.format.check_size(width, height).map_err(|error| bad(error.to_string()))
    }

    /// The file for a picture: named picture.depth.png where each has its own.
    fn file(&self, name: &str) -> PathBuf {
        let extension = self.path.extension().unwrap_or_default().to_string_lossy();
        if self.together { self.path.clone() } else { self.path.with_extension(format!("{name}.{extension}")) }
    }

    /// The files for some pictures.
    pub fn files(&self, rendered: &Rendered, transfer: Transfer) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
        let layers = layers(rendered, self.format);
        let parts = if self.together { layers.chunks(layers.len()) } else { layers.chunks(1) };
        parts
            .map(|part| Ok((self.file(&part[0].name), encode(self.format, part, transfer, &rendered.attributes)?)))
            .collect()
    }
}

/// The bytes of one file, with texts beside the pictures where the format has a place for them.
pub fn encode(
    format: &Format,
    layers: &[Layer],
    transfer: Transfer,
    attributes: &[(&'static str, String)],
) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    // What a format cannot hold, a size above all, was asked for.
    format.write(layers, &WriteOptions { transfer, attributes }, &mut bytes).map_err(|error| bad(error.to_string()))?;
    Ok(bytes)
}

/// Saves all files or none.
pub fn save_silently(files: &[(PathBuf, Vec<u8>)]) -> Result<(), Failure> {
    progress::saving();
    Ok(save_all(files)?)
}

/// Saves all files or none, and says so.
pub fn save(files: &[(PathBuf, Vec<u8>)], quiet: bool) -> Result<(), Failure> {
    save_silently(files)?;
    // Nothing is said of devices: standard output may be one, and the picture in it.
    for (path, _) in files.iter().filter(|(path, _)| !quiet && !path.starts_with("/dev")) {
        say(&format!("wrote {}", path.display()));
    }
    Ok(())
}

/// A line on standard output. A closed pipe is nobody's fault: who closed it has read enough.
pub fn say(line: &str) {
    match writeln!(std::io::stdout(), "{line}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let failure = Failure::Other(anyhow::anyhow!("cannot write to standard output: {error}"));
            std::process::exit(i32::from(failure.report()));
        }
        _ => {}
    }
}

/// A name with something more at its end.
pub fn lengthened(path: &Path, end: &str) -> PathBuf {
    let mut name = path.as_os_str().to_os_string();
    name.push(end);
    name.into()
}
