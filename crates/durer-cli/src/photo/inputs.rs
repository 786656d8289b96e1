//! Input files: photographs, and cameras with points.

use crate::failure::{Failure, bad};
use crate::guard::Guard;
use durer_photo::format::inputs;
use durer_photo::{Error, Reconstruction};
use std::path::{Path, PathBuf};

pub fn wrong(error: Error) -> Failure {
    bad(error.to_string())
}

/// Reads a file.
pub fn bytes(path: &Path, guard: &mut Guard) -> Result<Vec<u8>, Failure> {
    guard.reads(path)?;
    std::fs::read(path).map_err(|error| bad(format!("cannot read `{}`: {error}", path.display())))
}

/// Runs `work` on a number of threads; all processors if `None`.
pub fn threaded<R: Send>(threads: Option<u16>, work: impl FnOnce() -> R + Send) -> Result<R, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from)).build()?;
    Ok(pool.install(work))
}

/// Returns the photographs of a folder, sorted by name.
pub fn photographs(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = std::fs::read_dir(folder)
        .map_err(|error| bad(format!("cannot read the folder `{}`: {error}", folder.display())))?;
    let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, Failure>>()?;
    let known = |path: &PathBuf| {
        let end = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        // Skip the hidden files that macOS writes beside each file on other systems' disks.
        let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        ["jpg", "jpeg", "png"].contains(&&*end) && !hidden && path.is_file()
    };
    paths.retain(known);
    paths.sort();
    match paths.is_empty() {
        true => Err(bad(format!("no photographs (.jpg, .jpeg, .png) in `{}`", folder.display()))),
        false => Ok(paths),
    }
}

pub fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Reads cameras and points. If the file lacks names and sizes of photographs, those of a folder
/// are used, in order.
pub fn read(file: &Path, pictures: Option<&Path>, guard: &mut Guard) -> Result<Reconstruction, Failure> {
    inputs(file).iter().try_for_each(|path| guard.reads(path))?;
    let mut all = durer_photo::format::read(file).map_err(wrong)?;
    let Some(folder) = pictures.filter(|_| all.lenses.iter().any(|lens| lens.size == [0, 0])) else { return Ok(all) };
    let paths = photographs(folder)?;
    if paths.len() != all.views.len() {
        return Err(bad(format!(
            "there are {} photographs in `{}` but {} cameras in `{}`",
            paths.len(),
            folder.display(),
            all.views.len(),
            file.display()
        )));
    }
    for (i, path) in paths.iter().enumerate() {
        let size = durer_photo::photo::size(&path.to_string_lossy(), &bytes(path, guard)?).map_err(wrong)?;
        all.set_picture(i, &name(path), size);
    }
    Ok(all)
}
