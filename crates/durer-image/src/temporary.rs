//! Temporary files that are removed even if the program is killed.
//!
//! On Linux, the file has no name until it is complete (`O_TMPFILE`), so it vanishes when the
//! program ends. Only if it replaces an old file does it have a temporary name for a short time. On
//! other systems, the file has a temporary name from the start. If a killed program has left
//! temporary files, the next program removes them; it recognises them because they are not locked.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::NamedTempFile;

/// Prefix and suffix of the names of temporary files. The names of files that were already complete
/// when they got a name begin with `READY`.
const PREFIX: &str = ".durer-";
const READY: &str = ".durer-ready-";
const SUFFIX: &str = ".tmp";

/// Age above which a file that is not locked and may be incomplete is removed. A younger file may
/// belong to a running program that is about to lock it.
const MIN_STALE_AGE: Duration = Duration::from_secs(60);

/// A temporary file that is being written. [`Temporary::persist`] then moves it to its target.
pub(super) enum Temporary {
    /// A file that has no name.
    #[cfg(target_os = "linux")]
    Unnamed(File, PathBuf),
    /// A file that has a temporary name.
    Named(NamedTempFile),
}

impl Temporary {
    /// Creates an empty file in a folder.
    pub(super) fn new_in(folder: &Path) -> io::Result<Self> {
        #[cfg(target_os = "linux")]
        if let Some(file) = unnamed(folder)? {
            lock(&file);
            return Ok(Temporary::Unnamed(file, folder.into()));
        }
        let named = builder(PREFIX).tempfile_in(folder).map_err(without_path)?;
        lock(named.as_file());
        Ok(Temporary::Named(named))
    }

    pub(super) fn file(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Temporary::Unnamed(file, _) => file,
            Temporary::Named(named) => named.as_file(),
        }
    }

    /// Moves the file to its target path. If there is a file at this path, it is replaced.
    pub(super) fn persist(self, target: &Path) -> io::Result<()> {
        let named = match self {
            Temporary::Named(named) => named,
            #[cfg(target_os = "linux")]
            Temporary::Unnamed(file, folder) => match link(&file, target) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    // A hard link cannot replace a file. A rename can, but it needs a temporary
                    // name.
                    let link = |path: &Path| link(&file, path);
                    let (_, path) = builder(READY).make_in(folder, link)?.into_parts();
                    return path.persist(target).map_err(|failed| failed.error);
                }
                result => return result,
            },
        };
        named.persist(target).map(drop).map_err(|failed| failed.error)
    }
}

fn builder(prefix: &str) -> tempfile::Builder<'_, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(prefix).suffix(SUFFIX);
    // The system applies the user's file mode mask, as it does for any new file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

/// Creates a file without a name, if the system and the folder support this and the file can be
/// given a name later.
#[cfg(target_os = "linux")]
fn unnamed(folder: &Path) -> io::Result<Option<File>> {
    use rustix::fs::{Mode, OFlags};
    if !Path::new("/proc/self/fd").is_dir() {
        return Ok(None);
    }
    match rustix::fs::open(folder, OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC, Mode::from_raw_mode(0o666)) {
        Ok(file) => Ok(Some(file.into())),
        // Systems without support for unnamed files return these errors.
        Err(rustix::io::Errno::OPNOTSUPP | rustix::io::Errno::ISDIR | rustix::io::Errno::INVAL) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

#[cfg(target_os = "linux")]
fn link(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD};
    use std::os::fd::AsRawFd;
    let own = format!("/proc/self/fd/{}", file.as_raw_fd());
    Ok(rustix::fs::linkat(CWD, own, CWD, path, AtFlags::SYMLINK_FOLLOW)?)
}

/// Locks the file, so that other programs do not remove it. If locks are not supported, other
/// programs spare the file only while it is young.
fn lock(file: &File) {
    #[cfg(unix)]
    let _ = rustix::fs::flock(file, rustix::fs::FlockOperation::NonBlockingLockExclusive);
    #[cfg(not(unix))]
    let _ = file;
}

/// Removes temporary files that killed programs have left in a folder.
pub(super) fn remove_stale(folder: &Path) {
    #[cfg(unix)]
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if !name.starts_with(PREFIX) || !name.ends_with(SUFFIX) {
            continue;
        }
        // Opening a pipe would block the program.
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        let Some(file) = is_file.then(|| File::open(entry.path()).ok()).flatten() else { continue };
        let free = rustix::fs::flock(&file, rustix::fs::FlockOperation::NonBlockingLockExclusive).is_ok();
        let age = entry.metadata().and_then(|data| data.modified()).ok().and_then(|time| time.elapsed().ok());
        if free && (name.starts_with(READY) || age.is_some_and(|age| age > MIN_STALE_AGE)) {
            // Ignore errors, because the file may belong to another user.
            let _ = fs::remove_file(entry.path());
        }
    }
    #[cfg(not(unix))]
    let _ = folder;
}

/// Removes the name of the temporary file from an error, because the user does not know this name.
fn without_path(error: io::Error) -> io::Error {
    let inner = error.get_ref().and_then(std::error::Error::source).and_then(|e| e.downcast_ref::<io::Error>());
    match inner.and_then(io::Error::raw_os_error) {
        Some(code) => io::Error::from_raw_os_error(code),
        None => error.kind().into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_killed_programs_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str| fs::write(folder.path().join(name), "").unwrap();
        ["picture.png", ".durer-ready-1.tmp", ".durer-young.tmp", ".durer-ready-no", "other.tmp"]
            .into_iter()
            .for_each(put);
        put(".durer-old.tmp");
        let old = File::options().write(true).open(folder.path().join(".durer-old.tmp")).unwrap();
        old.set_modified(std::time::SystemTime::now() - 2 * MIN_STALE_AGE).unwrap();
        // A file that belongs to a program that is still running.
        let living = builder(READY).tempfile_in(folder.path()).unwrap();
        lock(living.as_file());
        remove_stale(folder.path());
        let there = |name: &str| folder.path().join(name).exists();
        assert!(living.path().exists());
        assert!(there("picture.png") && there(".durer-young.tmp") && there(".durer-ready-no") && there("other.tmp"));
        assert!(!there(".durer-ready-1.tmp") && !there(".durer-old.tmp"));
    }

    #[test]
    fn files_with_and_without_a_name_replace_others() {
        use std::io::Write;
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a");
        let named = |_: &Path| Temporary::Named(builder(PREFIX).tempfile_in(folder.path()).unwrap());
        let usual = |folder: &Path| Temporary::new_in(folder).unwrap();
        for (make, text) in [(&usual as &dyn Fn(&Path) -> Temporary, "1"), (&usual, "2"), (&named, "3")] {
            let temporary = make(folder.path());
            temporary.file().write_all(text.as_bytes()).unwrap();
            temporary.persist(&target).unwrap();
            assert_eq!(fs::read_to_string(&target).unwrap(), text);
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        }
    }
}
