//! Files that are whole or not there.
//!
//! Bytes go into a temporary file beside the target, are synced, and the file takes the target's
//! name. Whatever fails, the old file is intact and nothing is left lying about. The new file has
//! the old one's permissions, or those of an ordinary new file; links to it (hard ones) are not
//! followed, symbolic ones are.

use super::content::Content;
use super::temporary::{Temporary, remove_stale};
use std::fs::{self, File, OpenOptions};
use std::io;
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
    /// A disk or a socket has this name.
    #[error("cannot write `{}`: it is neither a file nor a pipe", path.display())]
    NotAFile {
        /// Where the file should go.
        path: PathBuf,
    },
    /// It is a symbolic link that leads nowhere: what it names is missing, or is itself.
    #[error("cannot write `{}`: it is a symbolic link that leads nowhere", path.display())]
    LostLink {
        /// Where the file should go.
        path: PathBuf,
    },
    /// It is a pipe without a reader, for whom the system would wait.
    #[error("cannot write `{}`: it is a pipe that nobody reads; start the reader first", path.display())]
    NobodyReads {
        /// Where the bytes should go.
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

/// A place for a file that was found to be one that may be written, which is better known before a
/// long work than after it.
#[derive(Debug)]
pub struct Destination {
    path: PathBuf,
    /// The open device or pipe, which is written to as it is: no one can take its reader away
    /// meanwhile.
    stream: Option<File>,
}

impl Destination {
    /// Says what is known to prevent saving. Removes what killed programs left in the folder. A
    /// pipe is opened.
    ///
    /// # Errors
    /// [`SaveError`]. Without one, saving may still fail.
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

    /// Its name.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it is a device or a pipe, in which nothing can be replaced.
    pub fn is_stream(&self) -> bool {
        self.stream.is_some()
    }
}

/// Puts bytes into a file, wholly or not at all. Devices and pipes are written to directly.
///
/// # Errors
/// [`SaveError`]; the old file is intact then, and no other is left.
pub fn save(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), SaveError> {
    save_all(&[(&Destination::new(path.as_ref())?, bytes)])
}

/// Puts contents into several files: all are written beside their targets before the first is
/// renamed.
///
/// # Errors
/// [`SaveError`]. Unless a rename itself fails, which takes a change of the folders meanwhile, no
/// file is changed.
pub fn save_all<C: Content>(files: &[(&Destination, C)]) -> Result<(), SaveError> {
    let mut staged = Vec::with_capacity(files.len());
    for (place, content) in files.iter().filter(|file| !file.0.is_stream()) {
        staged.push(stage(place.path(), content)?);
    }
    // What cannot be renamed cannot be undone either: it comes when the files are safe on the disk.
    for (place, content) in files {
        if let Some(mut stream) = place.stream.as_ref() {
            content.write_to(&mut stream).map_err(|error| SaveError::Io { path: place.path.clone(), error })?;
        }
    }
    for (temporary, target) in staged {
        temporary.persist(&target).map_err(|error| SaveError::Io { path: target.clone(), error })?;
        // The new name should outlive a power cut too; where folders cannot be synced, that is left
        // to the system.
        #[cfg(unix)]
        let _ = File::open(folder_of(&target)).and_then(|folder| folder.sync_all());
    }
    Ok(())
}

/// The file to be replaced and, if it is there, what is known of it; `None` if it is to be written
/// to directly.
fn resolve(path: &Path) -> Result<Option<(PathBuf, Option<fs::Metadata>)>, SaveError> {
    let io = |error| SaveError::Io { path: path.into(), error };
    let old = match fs::metadata(path) {
        Ok(old) if old.is_dir() => return Err(SaveError::IsFolder { path: path.into() }),
        Ok(old) if !old.is_file() && !is_pipe_or_device(&old) => {
            return Err(SaveError::NotAFile { path: path.into() });
        }
        Ok(old) if !old.is_file() || is_stream(path) => return Ok(None),
        // A rename would replace even a file that must not be written.
        Ok(old) => OpenOptions::new().write(true).open(path).map(|_| Some(old)).map_err(io)?,
        Err(_) if fs::symlink_metadata(path).is_ok_and(|link| link.is_symlink()) => {
            return Err(SaveError::LostLink { path: path.into() });
        }
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => None,
        Err(error) => return Err(io(error)),
    };
    // A symbolic link stays one: the file that it names is replaced.
    let target = if old.is_some() { path.canonicalize().map_err(io)? } else { path.to_path_buf() };
    let folder = folder_of(&target);
    if !folder.is_dir() {
        return Err(SaveError::NoFolder { path: path.into(), folder: folder.into() });
    }
    Ok(Some((target, old)))
}

/// Whether bytes may be written to it one after the other.
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

/// Opens a device or pipe without waiting for anybody. A redirected standard output is a file that
/// may have bytes before ours.
fn open_stream(path: &Path) -> Result<File, SaveError> {
    let mut options = OpenOptions::new();
    options.append(true);
    #[cfg(unix)]
    {
        use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
        use std::os::unix::fs::OpenOptionsExt;
        let opened = options.custom_flags(OFlags::NONBLOCK.bits() as i32).open(path).and_then(|stream| {
            // Only opening should not wait: a reader may be slow.
            fcntl_setfl(&stream, fcntl_getfl(&stream)?.difference(OFlags::NONBLOCK))?;
            Ok(stream)
        });
        opened.map_err(|error| match error.raw_os_error() {
            Some(code) if code == rustix::io::Errno::NXIO.raw_os_error() => {
                SaveError::NobodyReads { path: path.into() }
            }
            _ => SaveError::Io { path: path.into(), error },
        })
    }
    #[cfg(not(unix))]
    options.open(path).map_err(|error| SaveError::Io { path: path.into(), error })
}

/// Writes the temporary file for a target.
fn stage(path: &Path, content: &impl Content) -> Result<(Temporary, PathBuf), SaveError> {
    let io = |error| SaveError::Io { path: path.into(), error };
    // What was a file may be something else by now.
    let (target, old) = resolve(path)?.ok_or_else(|| SaveError::NotAFile { path: path.into() })?;
    let temporary = Temporary::new_in(folder_of(&target)).map_err(io)?;
    if let Some(old) = old {
        temporary.file().set_permissions(old.permissions()).map_err(io)?;
    }
    content.write_to(&mut temporary.file()).map_err(io)?;
    temporary.file().sync_all().map_err(io)?;
    Ok((temporary, target))
}

/// The folder of a file; that of a bare name is the current one.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Names of open files: the shell that redirected them holds the file itself, which a rename would
/// not reach.
fn is_stream(path: &Path) -> bool {
    ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc"].iter().any(|stream| path.starts_with(stream))
}

#[cfg(test)]
#[path = "save_tests.rs"]
mod tests;
