//! Reads input files, which are photographs and files of cameras and points.
//!
//! A file that the user names may be in any folder. A file that another file names, or that is
//! found in a folder, must be inside that folder after links are resolved. The same rule applies to
//! the files of a scene.

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use durer::format::folder::FolderSource;
use durer::options::memory::Memory;
use durer::source::SourceError;
use durer_photo::format::{inputs, read_with};
use durer_photo::{Error, Reconstruction};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Converts an error in a photograph or a reconstruction into a failure caused by invalid input.
pub fn from_photo_error(error: Error) -> Failure {
    invalid_input(error.to_string())
}

/// Reads a file that the user named.
pub fn bytes(path: &Path, registry: &mut FileRegistry) -> Result<Arc<[u8]>, Failure> {
    registry.register_input(path)?;
    let read = read_below(FolderSource::new(".").allow_outside(), path);
    read.map_err(|error| invalid_input(error.to_string()))
}

/// Reads a file that a reconstruction names, or that was found in a folder.
pub fn bytes_below(folder: &Path, name: &Path, registry: &mut FileRegistry) -> Result<Arc<[u8]>, Failure> {
    let path = folder.join(name);
    let read = read_below(FolderSource::new(folder), &path).map_err(|error| match error {
        SourceError::Outside { .. } => invalid_input(outside(&path, folder)),
        error => invalid_input(error.to_string()),
    })?;
    registry.register_input(&path)?;
    Ok(read)
}

fn outside(path: &Path, folder: &Path) -> String {
    format!(
        "`{}` lies outside the folder `{}`\nhelp: copy the file into the folder; only files in and below the \
         folder are read",
        path.display(),
        folder.display()
    )
}

/// Reads a regular file that the source allows, provided it fits into memory.
fn read_below(source: FolderSource, path: &Path) -> Result<Arc<[u8]>, SourceError> {
    let most = Memory::default().limit().min(FolderSource::DEFAULT_BUDGET);
    let real = source.allowed(path)?;
    source.budget(most).read_path(&real, &path.to_string_lossy())
}

/// Runs `work` with the given number of threads, where `None` means one per processor.
pub fn with_threads<R: Send>(threads: Option<u16>, work: impl FnOnce() -> R + Send) -> Result<R, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from)).build()?;
    Ok(pool.install(work))
}

/// Returns the photographs of a folder, sorted by name.
pub fn photographs(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = std::fs::read_dir(folder)
        .map_err(|error| invalid_input(format!("cannot read the folder `{}`: {error}", folder.display())))?;
    let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, Failure>>()?;
    let known = |path: &PathBuf| {
        let end = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        // Skip hidden files, such as those that macOS writes next to each file on foreign file
        // systems.
        let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        ["jpg", "jpeg", "png"].contains(&&*end) && !hidden && path.is_file()
    };
    paths.retain(known);
    paths.sort();
    match paths.is_empty() {
        true => Err(invalid_input(format!("no photographs (.jpg, .jpeg, .png) in `{}`", folder.display()))),
        false => Ok(paths),
    }
}

/// Returns the folder of a file.
fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Returns the name of a file without its folder.
pub fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Reads cameras and points. If the file lacks the names and sizes of photographs, the photographs
/// in the folder `pictures` are used in order.
pub fn read(file: &Path, pictures: Option<&Path>, registry: &mut FileRegistry) -> Result<Reconstruction, Failure> {
    inputs(file).iter().try_for_each(|path| registry.register_input(path))?;
    let folder = if file.is_dir() { file } else { folder_of(file) };
    let mut open = |path: &Path| {
        // The user named only the file itself. Other files are named by that file or found in its
        // folder.
        let source = FolderSource::new(folder);
        let source = if path == file { source.allow_outside() } else { source };
        read_below(source, path).map_err(|error| match error {
            SourceError::Outside { .. } => Error::new(outside(path, folder)),
            error => Error::new(error.to_string()),
        })
    };
    let mut all = read_with(file, &mut open).map_err(from_photo_error)?;
    let Some(folder) = pictures.filter(|_| all.lenses.iter().any(|lens| lens.size == [0, 0])) else { return Ok(all) };
    let paths = photographs(folder)?;
    if paths.len() != all.views.len() {
        return Err(invalid_input(format!(
            "there are {} photographs in `{}` but {} cameras in `{}`",
            paths.len(),
            folder.display(),
            all.views.len(),
            file.display()
        )));
    }
    for (i, path) in paths.iter().enumerate() {
        let content = bytes_below(folder, Path::new(path.file_name().unwrap_or_default()), registry)?;
        let size = durer_photo::photo::size(&path.to_string_lossy(), &content).map_err(from_photo_error)?;
        all.set_image(i, &name(path), size);
    }
    Ok(all)
}
