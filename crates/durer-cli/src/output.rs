//! Pictures into files.

use crate::failure::{Failure, bad};
use crate::guard::Guard;
use crate::options::DIAGRAMS;
use crate::progress;
use crate::terminal::say;
use durer::check::picture::Looks;
use durer::image::{Content, Depth, Destination, Display, Format, Layer, WriteOptions, format_for, save_all};
use durer::render::{BandsError, PartialRender, Rendered};
use std::cell::RefCell;
use std::io::{self, Write};
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
    format: &'static Format,
    /// The file of each, by its name; without a name, that of all. Diagrams go into files of their
    /// own: their sizes differ.
    files: Vec<(Option<String>, Destination)>,
}

impl Target {
    /// For the named pictures; says now what is known to prevent writing them, which is better than
    /// after the work.
    pub fn new(path: &Path, names: &[&str], guard: &mut Guard) -> Result<Self, Failure> {
        let format = format(path)?;
        let diagram = names.iter().any(|name| DIAGRAMS.contains(name));
        if names.len() == 1 || format.layers && !diagram {
            return Ok(Target { format, files: vec![(None, guard.writes("--output", path)?)] });
        }
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        // Named picture.depth.png where each has its own.
        let own = |name: &&str| path.with_extension(format!("{name}.{extension}"));
        let files = names.iter().map(|name| Ok((Some(name.to_string()), guard.writes("--output", &own(name))?)));
        Ok(Target { format, files: files.collect::<Result<_, Failure>>()? })
    }

    /// The file and its format, where all pictures go into one.
    pub fn single(&self) -> Option<(&Destination, &'static Format)> {
        match &self.files[..] {
            [(None, place)] => Some((place, self.format)),
            _ => None,
        }
    }

    /// Saves the colours of a part while they are converted, row by row, without a picture of them
    /// in memory, and says how they look; `None` where the file takes more than that.
    pub fn save_colors(&self, part: &PartialRender, display: Display, quiet: bool) -> Result<Option<Looks>, Failure> {
        let only_colors = part.job().color && part.job().aovs.is_empty();
        let rows = |format: &Format| only_colors && format.rows.is_some() && !format.layers;
        let Some((place, format)) = self.single().filter(|(_, format)| rows(format)) else { return Ok(None) };
        progress::saving();
        let colors = Colors { part, format, display, looks: RefCell::new(Looks::new(display.exposure)) };
        save_all(&[(place, &colors)])?;
        wrote(place, quiet);
        Ok(Some(colors.looks.into_inner()))
    }

    /// Whether pictures of this size fit into the files.
    pub fn check_size(&self, width: u32, height: u32) -> Result<(), Failure> {
        self.format.check_size(width, height).map_err(|error| bad(error.to_string()))
    }

    /// The files for some pictures.
    pub fn files(&self, rendered: &Rendered, display: Display) -> Result<Vec<(&Destination, Vec<u8>)>, Failure> {
        let layers = layers(rendered, self.format);
        let own = |name: &str| layers.iter().position(|layer| layer.name == name).map(|i| &layers[i..=i]);
        let file = |(name, place)| {
            let layers = match name {
                None => layers,
                Some(name) => own(name).ok_or_else(|| anyhow::anyhow!("there is no picture `{name}`"))?,
            };
            Ok((place, encode(self.format, layers, display, &rendered.attributes)?))
        };
        self.files.iter().map(|(name, place)| file((name.as_deref(), place))).collect()
    }
}

/// The colours of a part, which become a file's bytes while they are written.
struct Colors<'a> {
    part: &'a PartialRender,
    format: &'static Format,
    display: Display,
    /// How they look.
    looks: RefCell<Looks>,
}

impl Content for &Colors<'_> {
    fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        let (mut out, mut looks) = (io::BufWriter::new(out), self.looks.borrow_mut());
        let written = self.part.write_colors(self.format, self.display, &mut out, |pixels| looks.add(pixels));
        written.map_err(|error| match error {
            BandsError::Io(error) => error,
            error => io::Error::other(error),
        })?;
        out.flush()
    }
}

/// The bytes of one file, with texts beside the pictures where the format has a place for them.
pub fn encode(
    format: &Format,
    layers: &[Layer],
    display: impl Into<Display>,
    attributes: &[(&'static str, String)],
) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    // What a format cannot hold, a size above all, was asked for.
    let options = WriteOptions { display: display.into(), attributes };
    format.write(layers, &options, &mut bytes).map_err(|error| bad(error.to_string()))?;
    Ok(bytes)
}

/// Saves all files or none.
pub fn save_silently(files: &[(&Destination, Vec<u8>)]) -> Result<(), Failure> {
    progress::saving();
    Ok(save_all(files)?)
}

/// Saves all files or none, and says so.
pub fn save(files: &[(&Destination, Vec<u8>)], quiet: bool) -> Result<(), Failure> {
    save_silently(files)?;
    files.iter().for_each(|(place, _)| wrote(place, quiet));
    Ok(())
}

/// Says what was written. Nothing is said of devices: standard output may be one, and the picture
/// in it.
pub fn wrote(place: &Destination, quiet: bool) {
    if !quiet && !place.is_stream() {
        say(&format!("wrote {}", place.path().display()));
    }
}

/// A name with something more at its end.
pub fn lengthened(path: &Path, end: &str) -> PathBuf {
    let mut name = path.as_os_str().to_os_string();
    name.push(end);
    name.into()
}
