//! Writes pictures to files.

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::options::DIAGRAMS;
use crate::progress;
use crate::terminal::print_line;
use durer::check::picture::PictureScan;
use durer::image::{Content, Depth, Destination, Display, Format, Layer, WriteOptions, format_for, save_all};
use durer::render::{BandsError, PartialRender, Rendered};
use std::cell::RefCell;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// File that stands for standard output.
pub const STANDARD_OUTPUT: &str = "/dev/stdout";

/// Returns the image format for a file name. Pictures on standard output are PNG files.
pub fn format(path: &Path) -> Result<&'static Format, Failure> {
    if path == Path::new(STANDARD_OUTPUT) {
        if io::stdout().is_terminal() {
            return Err(invalid_input("standard output is a terminal: redirect it to a file or a program"));
        }
        return Ok(format_for("picture.png").map_err(anyhow::Error::from)?);
    }
    format_for(path).map_err(|error| invalid_input(error.to_string()))
}

/// Returns the layers to write in a format. Floating-point formats store values, and 8-bit formats
/// store displayed pictures.
fn layers<'r>(rendered: &'r Rendered, format: &Format) -> &'r [Layer] {
    match format.depth {
        Depth::Float => &rendered.layers,
        Depth::EightBit => &rendered.pictures,
    }
}

/// Output files of a render: either one for all pictures, or one for each picture.
pub struct Target {
    format: &'static Format,
    /// Files, each with the name of its picture. A file without a picture name holds all pictures.
    /// Diagrams have files of their own because their sizes differ.
    files: Vec<(Option<String>, Destination)>,
}

impl Target {
    /// Prepares the files for the pictures with the given names. Fails before the render starts if
    /// a file could not be written.
    pub fn new(path: &Path, names: &[&str], registry: &mut FileRegistry) -> Result<Self, Failure> {
        let format = format(path)?;
        let diagram = names.iter().any(|name| DIAGRAMS.contains(name));
        if names.len() == 1 || format.supports_layers && !diagram {
            return Ok(Target { format, files: vec![(None, registry.register_output("--output", path)?)] });
        }
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        // Separate files have names such as picture.depth.png.
        let own = |name: &&str| path.with_extension(format!("{name}.{extension}"));
        let files =
            names.iter().map(|name| Ok((Some(name.to_string()), registry.register_output("--output", &own(name))?)));
        Ok(Target { format, files: files.collect::<Result<_, Failure>>()? })
    }

    /// Returns the format of the files.
    pub fn format(&self) -> &'static Format {
        self.format
    }

    /// Returns the file and its format if all pictures share one file.
    pub fn single(&self) -> Option<(&Destination, &'static Format)> {
        match &self.files[..] {
            [(None, destination)] => Some((destination, self.format)),
            _ => None,
        }
    }

    /// Saves the colours of a part file row by row, without keeping the whole picture in memory.
    /// Returns a scan of the colours, or `None` if the file needs data other than colours.
    pub fn save_colors(
        &self,
        part: &PartialRender,
        display: Display,
        quiet: bool,
    ) -> Result<Option<PictureScan>, Failure> {
        let only_colors = part.job().color && part.job().aovs.is_empty();
        let rows = |format: &Format| only_colors && format.rows.is_some() && !format.supports_layers;
        let Some((destination, format)) = self.single().filter(|(_, format)| rows(format)) else { return Ok(None) };
        progress::saving();
        let colors = PartColors { part, format, display, scan: RefCell::new(PictureScan::new(display.exposure)) };
        save_all(&[(destination, &colors)])?;
        print_written(destination, quiet);
        Ok(Some(colors.scan.into_inner()))
    }

    /// Checks that the file formats support a picture size.
    pub fn check_size(&self, width: u32, height: u32) -> Result<(), Failure> {
        self.format.check_size(width, height).map_err(|error| invalid_input(error.to_string()))
    }

    /// Encodes the pictures to the contents of their files.
    pub fn files(&self, rendered: &Rendered, display: Display) -> Result<Vec<(&Destination, Vec<u8>)>, Failure> {
        let layers = layers(rendered, self.format);
        let own = |name: &str| layers.iter().position(|layer| layer.name == name).map(|i| &layers[i..=i]);
        let file = |(name, destination)| {
            let layers = match name {
                None => layers,
                Some(name) => own(name).ok_or_else(|| anyhow::anyhow!("no picture `{name}`"))?,
            };
            Ok((destination, encode(self.format, layers, display, &rendered.attributes)?))
        };
        self.files.iter().map(|(name, destination)| file((name.as_deref(), destination))).collect()
    }
}

/// Source of a file's content: the colours of a part file, which are encoded while they are
/// written.
struct PartColors<'a> {
    part: &'a PartialRender,
    format: &'static Format,
    display: Display,
    /// Scan of the colours that were written.
    scan: RefCell<PictureScan>,
}

impl Content for &PartColors<'_> {
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        let (mut out, mut scan) = (io::BufWriter::new(out), self.scan.borrow_mut());
        let written = self.part.write_colors(self.format, self.display, &mut out, |pixels| scan.add(pixels));
        written.map_err(|error| match error {
            BandsError::Io(error) => error,
            error => io::Error::other(error),
        })?;
        out.flush()
    }
}

/// Encodes one file, including attributes if the format supports them.
pub fn encode(
    format: &Format,
    layers: &[Layer],
    display: impl Into<Display>,
    attributes: &[(&'static str, String)],
) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    // Errors such as an unsupported size are caused by the user's input.
    let options = WriteOptions { display: display.into(), attributes };
    format.write(layers, &options, &mut bytes).map_err(|error| invalid_input(error.to_string()))?;
    Ok(bytes)
}

/// Saves either all files or none.
pub fn save_silently(files: &[(&Destination, Vec<u8>)]) -> Result<(), Failure> {
    progress::saving();
    Ok(save_all(files)?)
}

/// Saves either all files or none, and prints their names.
pub fn save(files: &[(&Destination, Vec<u8>)], quiet: bool) -> Result<(), Failure> {
    save_silently(files)?;
    files.iter().for_each(|(destination, _)| print_written(destination, quiet));
    Ok(())
}

/// Prints the name of a file that was written. Streams are not mentioned because the picture may be
/// on standard output.
pub fn print_written(destination: &Destination, quiet: bool) {
    if !quiet && !destination.is_stream() {
        print_line(&format!("wrote {}", destination.path().display()));
    }
}

/// Appends `end` to a file name.
pub fn with_suffix(path: &Path, end: &str) -> PathBuf {
    let mut name = path.as_os_str().to_os_string();
    name.push(end);
    name.into()
}
