//! Writes the folder of a lesson. Only files of an earlier lesson are replaced.

use super::step_files::TEXT;
use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::output::save_silently;
use durer::format::folder::FolderSource;
use durer::image::Destination;
use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// First line of a lesson's text. It identifies an earlier lesson.
pub const MARK: &str =
    "<!-- Written by durer lesson, which also replaces or removes the files that are linked here. -->";

/// Maximum size of a lesson's text in bytes.
const MAX_TEXT: u64 = 16 << 20;

/// Output folder of `durer lesson`, and the files of an earlier lesson that may be replaced.
pub struct Folder {
    path: PathBuf,
    /// True if the folder does not exist yet.
    new: bool,
    /// Files that an earlier lesson wrote.
    own: BTreeSet<String>,
}

impl Folder {
    /// Checks before the render that the folder can be written.
    pub fn new(path: PathBuf, registry: &mut FileRegistry) -> Result<Self, Failure> {
        if path.exists() && !path.is_dir() {
            return Err(invalid_input(format!("`{}` is a file; a lesson needs a folder", path.display())));
        }
        let new = !path.exists();
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if new && !parent.is_dir() {
            return Err(invalid_input(format!("folder `{}` does not exist", parent.display())));
        }
        if !new {
            Destination::new(path.join(TEXT))?;
        }
        let text = FolderSource::new(&path).budget(MAX_TEXT).read_path(&path.join(TEXT), TEXT);
        let own = text.map(|text| linked(&String::from_utf8_lossy(&text))).unwrap_or_default();
        own.iter().try_for_each(|name| registry.register_removal("--output", &path.join(name)))?;
        Ok(Folder { path, new, own })
    }

    /// Writes either all files or none, and removes files of an earlier lesson that are no longer
    /// needed. Returns the path of the folder.
    pub fn write(self, files: Vec<(String, Vec<u8>)>, registry: &mut FileRegistry) -> Result<PathBuf, Failure> {
        let foreign = |name: &String| !self.own.contains(name) && self.path.join(name).exists();
        if let Some((name, _)) = files.iter().find(|(name, _)| foreign(name)) {
            let path = self.path.join(name);
            return Err(invalid_input(format!(
                "`{}` does not belong to an earlier lesson: choose another folder, or move the file",
                path.display()
            )));
        }
        if self.new {
            let failed = |error| anyhow::anyhow!("cannot create the folder `{}`: {error}", self.path.display());
            std::fs::create_dir(&self.path).map_err(failed)?;
        }
        let names: BTreeSet<String> = files.iter().map(|file| file.0.clone()).collect();
        let mut destination = |name: &String| match self.own.contains(name) {
            true => Ok(Destination::new(self.path.join(name))?),
            false => registry.register_output("--output", &self.path.join(name)),
        };
        let destinations = files.iter().map(|(name, _)| destination(name)).collect::<Result<Vec<_>, Failure>>();
        let saved = destinations.and_then(|destinations| {
            let bytes = files.into_iter().map(|(_, bytes)| bytes);
            save_silently(&destinations.iter().zip(bytes).collect::<Vec<_>>())
        });
        if let Err(failure) = saved {
            // Remove the folder if this run created it. If that fails, an empty folder remains.
            let _ = if self.new { std::fs::remove_dir(&self.path) } else { Ok(()) };
            return Err(failure);
        }
        for stale in self.own.difference(&names) {
            match std::fs::remove_file(self.path.join(stale)) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    return Err(anyhow::anyhow!("cannot remove `{}`: {error}", self.path.join(stale).display()).into());
                }
                _ => {}
            }
        }
        Ok(self.path)
    }
}

/// Returns the names of the files that a lesson's text links to. The list is empty if the text is
/// not a lesson.
fn linked(text: &str) -> BTreeSet<String> {
    if text.lines().next() != Some(MARK) {
        return BTreeSet::new();
    }
    let names = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    // Ignore paths that lead outside the folder.
    let names = names.filter(|name| !name.is_empty() && !name.contains(['/', '\\']) && !name.starts_with('.'));
    names.map(str::to_string).chain([TEXT.to_string()]).collect()
}
