//! Saves files atomically.
//!
//! The bytes are written to a temporary file in the same folder, this file is synced, and then it
//! is renamed. If anything fails, the old file stays intact and no temporary file remains. The new
//! file has the permissions of the old one or, if there was none, the permissions of any newly
//! created file. Symbolic links are followed, but other hard links to the old file keep the old
//! content.

use super::content::Content;
use super::temporary::{Temporary, remove_stale};
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// Error that occurs when a file is saved with [`save()`] or [`save_all()`]. If there is an old
/// file, it is unchanged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The path is a folder.
    #[error("cannot write `{}`: it is a folder", path.display())]
    IsFolder {
        /// Path of the file to be saved.
        path: PathBuf,
    },
    /// The path is neither a file nor a pipe, but something else, such as a disk or a socket.
    #[error("cannot write `{}`: it is neither a file nor a pipe", path.display())]
    NotAFile {
        /// Path of the file to be saved.
        path: PathBuf,
    },
    /// The path is a dangling symbolic link, whose target is missing or is the link itself.
    #[error("cannot write `{}`: it is a broken symbolic link", path.display())]
    BrokenLink {
        /// Path of the file to be saved.
        path: PathBuf,
    },
    /// The path is a pipe that nobody reads. Opening it would wait until a reader appears.
    #[error("cannot write `{}`: it is a pipe without a reader; start the reader first", path.display())]
    NoReader {
        /// Path of the file to be saved.
        path: PathBuf,
    },
    /// The folder of the file does not exist, or it is a file itself.
    #[error("cannot write `{}`: the folder `{}` does not exist", path.display(), folder.display())]
    NoFolder {
        /// Path of the file to be saved.
        path: PathBuf,
        /// The folder that is missing.
        folder: PathBuf,
    },
    /// The system reported an error, such as missing permission, a full disk, or a closed pipe.
    #[error("cannot write `{}`: {error}", path.display())]
    Io {
        /// Path of the file to be saved.
        path: PathBuf,
        /// Error reported by the operating system.
        #[source]
        error: io::Error,
    },
}

/// Path of a file to be saved, which has been checked to be writable, for example before a long
/// render.
#[derive(Debug)]
pub struct Destination {
    path: PathBuf,
    /// The open device or pipe, to which bytes are written directly. The stream is kept open, so
    /// that the reader of a pipe does not see the end of the data too early.
    stream: Option<File>,
}

impl Destination {
    /// Checks that the path can be written, and opens it if it is a device or a pipe. Also removes
    /// temporary files that killed programs have left in the folder of the path.
    ///
    /// # Errors
    /// Returns [`SaveError`] if the path cannot be written. Saving the file later may still fail.
    pub fn new(path: impl Into<PathBuf>) -> Result<Self, SaveError> {
        let path = path.into();
        let stream = match resolve(&path)? {
            Some((target, _)) => {
                remove_stale(folder_of(&target));
                None
            }
            None => Some(open_stream(&path)?),
        };
        Ok(Destination { path, stream })
    }

    /// Path of the file to be written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns true if the target is a device or a pipe, which cannot be replaced atomically.
    pub fn is_stream(&self) -> bool {
        self.stream.is_some()
    }
}

/// Saves bytes to a file atomically. If the path is a device or a pipe, the bytes are written to it
/// directly.
///
/// # Errors
/// Returns [`SaveError`] if the file cannot be saved. In that case, the old file stays intact and
/// no temporary file remains.
pub fn save(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), SaveError> {
    save_all(&[(&Destination::new(path.as_ref())?, bytes)])
}

/// Saves several files. All files are written to temporary files before the first one is renamed.
///
/// # Errors
/// Returns [`SaveError`] if a file cannot be saved. In that case, all files are unchanged, unless
/// one of the renames failed because its folder changed in the meantime.
pub fn save_all<C: Content>(files: &[(&Destination, C)]) -> Result<(), SaveError> {
    let mut staged = Vec::with_capacity(files.len());
    for (destination, content) in files.iter().filter(|file| !file.0.is_stream()) {
        staged.push(stage(destination.path(), content)?);
    }
    // Writing to streams cannot be undone, so it is done after the files are safely on disk.
    for (destination, content) in files {
        if let Some(mut stream) = destination.stream.as_ref() {
            content.write_to(&mut stream).map_err(|error| SaveError::Io { path: destination.path.clone(), error })?;
        }
    }
    for (temporary, target) in staged {
        temporary.persist(&target).map_err(|error| SaveError::Io { path: target.clone(), error })?;
        // Sync the folder, so that the new name survives a power failure. If folders cannot be
        // synced, this is left to the system.
        #[cfg(unix)]
        let _ = File::open(folder_of(&target)).and_then(|folder| folder.sync_all());
    }
    Ok(())
}

/// Returns the file to be replaced, with its metadata if it exists, or `None` if the path is a
/// device or a pipe, which is written to directly.
fn resolve(path: &Path) -> Result<Option<(PathBuf, Option<fs::Metadata>)>, SaveError> {
    let io = |error| SaveError::Io { path: path.into(), error };
    let old = match fs::metadata(path) {
        Ok(old) if old.is_dir() => return Err(SaveError::IsFolder { path: path.into() }),
        Ok(old) if !old.is_file() && !is_pipe_or_device(&old) => {
            return Err(SaveError::NotAFile { path: path.into() });
        }
        Ok(old) if !old.is_file() || is_stream(path) => return Ok(None),
        // Renaming would replace even a file that has no write permission.
        Ok(old) => OpenOptions::new().write(true).open(path).map(|_| Some(old)).map_err(io)?,
        Err(_) if fs::symlink_metadata(path).is_ok_and(|link| link.is_symlink()) => {
            return Err(SaveError::BrokenLink { path: path.into() });
        }
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => None,
        Err(error) => return Err(io(error)),
    };
    // Keep a symbolic link and replace its target instead.
    let target = if old.is_some() { path.canonicalize().map_err(io)? } else { path.to_path_buf() };
    let folder = folder_of(&target);
    if !folder.is_dir() {
        return Err(SaveError::NoFolder { path: path.into(), folder: folder.into() });
    }
    Ok(Some((target, old)))
}

/// Returns true for a pipe or a character device, to which bytes are written directly.
fn is_pipe_or_device(old: &fs::Metadata) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        old.file_type().is_fifo() || old.file_type().is_char_device()
    }
    #[cfg(not(unix))]
    {
        let _ = old;
        true
    }
}

/// Opens a device or a pipe for appending, without waiting for a reader. Appending matters if
/// standard output is redirected to a file that already contains bytes.
fn open_stream(path: &Path) -> Result<File, SaveError> {
    let mut options = OpenOptions::new();
    options.append(true);
    #[cfg(unix)]
    {
        use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
        use std::os::unix::fs::OpenOptionsExt;
        let opened = options.custom_flags(OFlags::NONBLOCK.bits() as i32).open(path).and_then(|stream| {
            // Later writes must block, because the reader may be slow.
            fcntl_setfl(&stream, fcntl_getfl(&stream)?.difference(OFlags::NONBLOCK))?;
            Ok(stream)
        });
        opened.map_err(|error| match error.raw_os_error() {
            Some(code) if code == rustix::io::Errno::NXIO.raw_os_error() => SaveError::NoReader { path: path.into() },
            _ => SaveError::Io { path: path.into(), error },
        })
    }
    #[cfg(not(unix))]
    options.open(path).map_err(|error| SaveError::Io { path: path.into(), error })
}

/// Writes the temporary file that belongs to a target.
fn stage(path: &Path, content: &impl Content) -> Result<(Temporary, PathBuf), SaveError> {
    let io = |error| SaveError::Io { path: path.into(), error };
    // The path may have become something else since it was checked.
    let (target, old) = resolve(path)?.ok_or_else(|| SaveError::NotAFile { path: path.into() })?;
    let temporary = Temporary::new_in(folder_of(&target)).map_err(io)?;
    if let Some(old) = old {
        temporary.file().set_permissions(old.permissions()).map_err(io)?;
    }
    content.write_to(&mut temporary.file()).map_err(io)?;
    temporary.file().sync_all().map_err(io)?;
    Ok((temporary, target))
}

/// Returns the folder of a file, which is the current folder if the path is only a file name.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Returns true for paths that refer to open files, such as `/dev/stdout`. Renaming a file to such
/// a path would not replace the file that is open.
fn is_stream(path: &Path) -> bool {
    ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc"].iter().any(|stream| path.starts_with(stream))
}

#[cfg(test)]
#[path = "save_tests.rs"]
mod tests;
