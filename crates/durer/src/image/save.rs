//! Files that are whole or not there.
//!
//! Bytes go into a temporary file beside the target, are synced, and the file takes the target's name. Whatever
//! fails, the old file is intact and nothing is left lying about. The new file has the old one's permissions, or
//! those of an ordinary new file; links to it (hard ones) are not followed, symbolic ones are.

use super::temporary::{Temporary, remove_stale};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Why a file could not be saved. The old file, if there is one, is as it was.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// A folder has this name.
    #[error("cannot write `{}`: it is a folder", path.display())]
    IsFolder {
        /// Where the file should go.
        path: PathBuf,
    },
    /// The folder for the file is not there, or is a file itself.
    #[error("cannot write `{}`: there is no folder `{}`", path.display(), folder.display())]
    NoFolder {
        /// Where the file should go.
        path: PathBuf,
        /// The folder that is missing.
        folder: PathBuf,
    },
    /// The system's reason: no permission, no space left, a closed pipe.
    #[error("cannot write `{}`: {error}", path.display())]
    Io {
        /// Where the file should go.
        path: PathBuf,
        /// The system's reason.
        #[source]
        error: io::Error,
    },
}

/// Puts bytes into a file, wholly or not at all. Devices and pipes are written to directly.
///
/// # Errors
/// [`SaveError`]; the old file is intact then, and no other is left.
pub fn save(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), SaveError> {
    save_all(&[(path, bytes)])
}

/// Puts bytes into several files: all are written beside their targets before the first is renamed.
///
/// # Errors
/// [`SaveError`]. Unless a rename itself fails, which takes a change of the folders meanwhile, no file is changed.
pub fn save_all<P: AsRef<Path>, B: AsRef<[u8]>>(files: &[(P, B)]) -> Result<(), SaveError> {
    let mut staged = Vec::with_capacity(files.len());
    for (path, bytes) in files {
        staged.push(stage(path.as_ref(), bytes.as_ref())?);
    }
    // What cannot be renamed cannot be undone either: it comes when the files are safe on the disk.
    for ((path, bytes), _) in files.iter().zip(&staged).filter(|(_, staged)| staged.is_none()) {
        let io = |error| SaveError::Io { path: path.as_ref().into(), error };
        // A redirected standard output is a file that may have bytes before ours.
        let mut device = OpenOptions::new().append(true).open(path).map_err(io)?;
        device.write_all(bytes.as_ref()).map_err(io)?;
    }
    for (temporary, target) in staged.into_iter().flatten() {
        temporary.persist(&target).map_err(|error| SaveError::Io { path: target.clone(), error })?;
        // The new name should outlive a power cut too; where folders cannot be synced, that is left to the system.
        #[cfg(unix)]
        let _ = File::open(folder_of(&target)).and_then(|folder| folder.sync_all());
    }
    Ok(())
}

/// Says beforehand what is known to prevent saving: better than after a long work. Removes what killed programs left there.
///
/// # Errors
/// [`SaveError`]. Without one, saving may still fail.
pub fn check_target(path: impl AsRef<Path>) -> Result<(), SaveError> {
    if let Some((target, _)) = resolve(path.as_ref())? {
        remove_stale(folder_of(&target));
    }
    Ok(())
}

/// The file to be replaced and, if it is there, what is known of it; `None` if it is to be written to directly.
fn resolve(path: &Path) -> Result<Option<(PathBuf, Option<fs::Metadata>)>, SaveError> {
    let io = |error| SaveError::Io { path: path.into(), error };
    let old = match fs::metadata(path) {
        Ok(old) if old.is_dir() => return Err(SaveError::IsFolder { path: path.into() }),
        Ok(old) if !old.is_file() || is_stream(path) => return Ok(None),
        // A rename would replace even a file that must not be written.
        Ok(old) => OpenOptions::new().write(true).open(path).map(|_| Some(old)).map_err(io)?,
        Err(_) => None,
    };
    // A symbolic link stays one: the file that it names is replaced.
    let target = if old.is_some() { path.canonicalize().map_err(io)? } else { path.to_path_buf() };
    let folder = folder_of(&target);
    if !folder.is_dir() {
        return Err(SaveError::NoFolder { path: path.into(), folder: folder.into() });
    }
    Ok(Some((target, old)))
}

/// Writes the temporary file for a target; `None` if the target is to be written to directly.
fn stage(path: &Path, bytes: &[u8]) -> Result<Option<(Temporary, PathBuf)>, SaveError> {
    let io = |error| SaveError::Io { path: path.into(), error };
    let Some((target, old)) = resolve(path)? else { return Ok(None) };
    let temporary = Temporary::new_in(folder_of(&target)).map_err(io)?;
    if let Some(old) = old {
        temporary.file().set_permissions(old.permissions()).map_err(io)?;
    }
    temporary.file().write_all(bytes).map_err(io)?;
    temporary.file().sync_all().map_err(io)?;
    Ok(Some((temporary, target)))
}

/// The folder of a file; that of a bare name is the current one.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Names of open files: the shell that redirected them holds the file itself, which a rename would not reach.
fn is_stream(path: &Path) -> bool {
    ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc"].iter().any(|stream| path.starts_with(stream))
}

#[cfg(test)]
#[path = "save_tests.rs"]
mod tests;
