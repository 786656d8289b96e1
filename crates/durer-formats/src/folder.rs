//! Asset source that reads files from folders. Only this module opens the files of a scene for
//! reading.
//!
//! The source reads only files below a few allowed folders, and only up to a total number of bytes.

use crate::files::percent_decoded;
use crate::mesh_format_for;
use durer_diag::did_you_mean;
use durer_scene::source::{AssetSource, Digest, ReadRecord, SourceError, Stamp};
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::UNIX_EPOCH;

/// Asset source that reads the files of a scene from folders. The files must lie below the allowed
/// folders, and their total size is limited.
#[derive(Debug)]
pub struct FolderSource {
    /// Folders in which relative names are looked up, in order of precedence.
    search: Vec<PathBuf>,
    /// Folders that must contain the files; empty if files may lie anywhere.
    allowed: Vec<PathBuf>,
    /// Folders that are also searched for the bare file name, without its path.
    assets: Vec<PathBuf>,
    /// Files that are held in memory, by name. Files in memory take precedence over files in
    /// folders.
    in_memory: BTreeMap<String, Arc<[u8]>>,
    record: ReadRecord,
    progress: Mutex<Progress>,
}

/// Number of bytes that a [`FolderSource`] may still read, and the paths that it has read so far.
#[derive(Clone, Debug)]
struct Progress {
    /// Number of bytes that may still be read.
    left: u64,
    /// Paths of all files that the source read or tried to read.
    paths: Vec<PathBuf>,
}

impl Clone for FolderSource {
    fn clone(&self) -> Self {
        FolderSource {
            search: self.search.clone(),
            allowed: self.allowed.clone(),
            assets: self.assets.clone(),
            in_memory: self.in_memory.clone(),
            record: self.record.clone(),
            progress: Mutex::new(self.progress().clone()),
        }
    }
}

impl FolderSource {
    /// Number of bytes that may be read for one scene by default: 4 GiB. See
    /// [`FolderSource::budget`].
    pub const DEFAULT_BUDGET: u64 = 4 << 30;

    /// Creates a source for files in one folder and its subfolders.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        let folder = folder.into();
        FolderSource {
            search: vec![folder.clone()],
            allowed: vec![folder],
            assets: Vec::new(),
            in_memory: BTreeMap::new(),
            record: ReadRecord::default(),
            progress: Mutex::new(Progress { left: FolderSource::DEFAULT_BUDGET, paths: Vec::new() }),
        }
    }

    /// Adds a folder to the search path; if `first` is true, the folder is searched before all
    /// others. Adding a folder does not give permission to read the files in it.
    pub fn search_in(mut self, folder: impl Into<PathBuf>, first: bool) -> Self {
        let at = if first { 0 } else { self.search.len() };
        self.search.insert(at, folder.into());
        self
    }

    /// Allows reading files in another folder and its subfolders.
    pub fn allow(mut self, folder: impl Into<PathBuf>) -> Self {
        // If the list is empty, every folder is already allowed.
        if !self.allowed.is_empty() {
            self.allowed.push(folder.into());
        }
        self
    }

    /// Adds a folder that is searched first for the whole path and then for the file name alone,
    /// and allows reading there.
    pub fn assets(mut self, folder: impl Into<PathBuf>) -> Self {
        let folder = folder.into();
        self.assets.push(folder.clone());
        self.search_in(folder.clone(), false).allow(folder)
    }

    /// Adds a file in memory, which takes the place of any file with this name on disk.
    pub fn add_in_memory(mut self, name: impl Into<String>, bytes: Arc<[u8]>) -> Self {
        self.in_memory.insert(name.into(), bytes);
        self
    }

    /// Allows reading files in any folder.
    pub fn allow_outside(mut self) -> Self {
        self.allowed.clear();
        self
    }

    /// Sets the total number of bytes that may be read.
    pub fn budget(self, bytes: u64) -> Self {
        self.progress().left = bytes;
        self
    }

    fn progress(&self) -> MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the paths of all files that the source read or tried to read.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.progress().paths.clone()
    }

    /// Returns the path of the file with this name, if it exists and may be read.
    pub fn find_path(&self, name: &str) -> Option<PathBuf> {
        self.find(name).ok().filter(|path| path.is_file())
    }

    /// Returns the first path, in search order, that exists and may be read.
    fn find(&self, name: &str) -> Result<PathBuf, SourceError> {
        // Scenes that were written on Windows may contain backslashes.
        let portable = name.replace('\\', "/");
        let path = Path::new(&portable);
        let bare = path.file_name().map(Path::new);
        let mut candidates: Vec<PathBuf> = self.search.iter().map(|folder| folder.join(path)).collect();
        candidates.extend(bare.iter().flat_map(|bare| self.assets.iter().map(move |folder| folder.join(bare))));
        let mut outside = false;
        // If no candidate exists exactly as written, try similar names.
        let others = || self.search.iter().filter_map(|folder| similar_path(folder, path));
        let others: Vec<PathBuf> =
            if candidates.iter().any(|path| path.exists()) { Vec::new() } else { others().collect() };
        for candidate in candidates.iter().chain(&others) {
            let Ok(real) = candidate.canonicalize() else { continue };
            if self.allows(&real) {
                return Ok(real);
            }
            outside = true;
        }
        Err(match outside {
            true => SourceError::Outside { name: name.into() },
            false => {
                let mut tried: Vec<PathBuf> = Vec::new();
                for candidate in candidates {
                    // Skip a folder that is in the search path twice, once with a leading `.`.
                    if !tried.iter().any(|known| same_place(known, &candidate)) {
                        tried.push(candidate);
                    }
                }
                SourceError::Missing { name: name.into(), similar: None, tried }
            }
        })
    }

    /// Returns the name of a file in the same folder that is similar to one of the candidates. If
    /// the folder does not exist, returns the name of a similar folder. Folders that may not be
    /// read are not searched for similar names.
    fn similar_name(&self, candidates: &[PathBuf]) -> Option<String> {
        candidates.iter().find_map(|path| {
            // The part of the path that is wrong is the first one that does not exist.
            let wrong =
                path.ancestors().find(|part| part.parent().is_some_and(|folder| or_current(folder).is_dir()))?;
            let folder = or_current(wrong.parent()?).canonicalize().ok().filter(|folder| self.allows(folder))?;
            // A mesh cannot replace a picture, or the reverse.
            let is_mesh = |path: &Path| mesh_format_for(&path.to_string_lossy()).is_some();
            let is_fitting = |entry: &fs::DirEntry| match wrong == path {
                true => is_mesh(&entry.path()) == is_mesh(path),
                false => entry.path().is_dir(),
            };
            let names: Vec<String> = fs::read_dir(folder)
                .ok()?
                .filter_map(|entry| entry.ok().filter(is_fitting)?.file_name().into_string().ok())
                .take(10_000)
                .collect();
            did_you_mean(wrong.file_name()?.to_str()?, names.iter().map(String::as_str)).map(str::to_string)
        })
    }

    /// Resolves links in the path of an existing file and checks that the file may be read.
    ///
    /// # Errors
    ///
    /// Returns [`SourceError`] if the file does not exist or lies outside the allowed folders.
    pub fn allowed(&self, path: &Path) -> Result<PathBuf, SourceError> {
        let name = || path.display().to_string();
        let real = path.canonicalize().map_err(|error| SourceError::Io { name: name(), error })?;
        if self.allows(&real) { Ok(real) } else { Err(SourceError::Outside { name: name() }) }
    }

    fn allows(&self, real: &Path) -> bool {
        let below = |folder: &PathBuf| folder.canonicalize().is_ok_and(|folder| real.starts_with(folder));
        self.allowed.is_empty() || self.allowed.iter().any(below)
    }

    /// Reads the file at a path without recording the path. `name` is used in messages.
    ///
    /// # Errors
    ///
    /// Returns [`SourceError`], for example if the byte limit has been reached.
    pub fn read_path(&self, path: &Path, name: &str) -> Result<Arc<[u8]>, SourceError> {
        let io = |error| SourceError::Io { name: name.into(), error };
        self.progress().paths.push(path.into());
        let metadata = fs::metadata(path).map_err(io)?;
        if !metadata.is_file() {
            return Err(SourceError::NotAFile { name: name.into() });
        }
        let left = self.progress().left;
        let too_large = |size| SourceError::TooLarge { name: name.into(), size, left };
        if metadata.len() > left {
            return Err(too_large(metadata.len()));
        }
        // The limit also applies to a file that grows while it is being read.
        let bytes = read_all(fs::File::open(path).map_err(io)?, metadata.len() as usize, left).map_err(io)?;
        if bytes.len() as u64 > left {
            return Err(too_large(bytes.len() as u64));
        }
        self.progress().left = left - bytes.len() as u64;
        Ok(bytes)
    }
}

/// Returns the existing file that `path` most likely refers to, for paths that do not exist exactly
/// as written. Decodes percent escapes, resolves `folder/..`, and ignores letter case, as some
/// other systems do.
fn similar_path(folder: &Path, path: &Path) -> Option<PathBuf> {
    let mut names: Vec<&str> = Vec::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            // Resolve `..` by editing the path text, since its folder may not exist, but never
            // leave the search folder.
            Component::ParentDir => names.pop().map(|_| ())?,
            Component::Normal(name) => names.push(name.to_str()?),
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    let candidate = names.into_iter().try_fold(folder.to_path_buf(), |folder, name| same_name(&folder, name))?;
    candidate.is_file().then_some(candidate)
}

/// Returns the folder, or `.` in place of an empty path.
fn or_current(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// Returns true if two paths are equal except for components `.`.
fn same_place(a: &Path, b: &Path) -> bool {
    let [a, b] = [a, b].map(|path| path.components().filter(|part| *part != Component::CurDir));
    a.eq(b)
}

/// Decodes percent escapes; returns the name unchanged if an escape is malformed.
fn unescaped_or_same(name: &str) -> String {
    percent_decoded(name).unwrap_or_else(|| name.to_string())
}

/// Finds an entry of `folder` by its name, as written, with percent escapes decoded, or ignoring
/// letter case.
fn same_name(folder: &Path, name: &str) -> Option<PathBuf> {
    let plain = unescaped_or_same(name);
    let exact = [name, &plain].into_iter().map(|name| folder.join(name)).find(|path| path.exists());
    exact.or_else(|| {
        let lower = plain.to_lowercase();
        let names = fs::read_dir(folder).ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let same = names.take(10_000).filter(|other| other.to_lowercase() == lower).min()?;
        Some(folder.join(same))
    })
}

impl AssetSource for FolderSource {
    fn read(&self, name: &str) -> Result<Arc<[u8]>, SourceError> {
        if let Some(bytes) = self.in_memory.get(name) {
            self.record.add(name, bytes);
            return Ok(bytes.clone());
        }
        match self.find(name) {
            Ok(path) => self.read_path(&path, name).inspect(|bytes| self.record.add(name, bytes)),
            Err(SourceError::Missing { name, tried, .. }) => {
                Err(SourceError::Missing { similar: self.similar_name(&tried), name, tried })
            }
            Err(error) => Err(error),
        }
    }

    fn budget(&self) -> u64 {
        self.progress().left
    }

    fn spend(&self, bytes: u64) {
        let mut progress = self.progress();
        progress.left = progress.left.saturating_sub(bytes);
    }

    fn read_user_file(&self, path: &Path) -> Result<Arc<[u8]>, SourceError> {
        let name = path.display().to_string();
        self.read_path(path, &name).inspect(|bytes| self.record.add(&name, bytes))
    }

    fn contains(&self, name: &str) -> bool {
        self.in_memory.contains_key(name) || self.find(name).is_ok()
    }

    fn record(&self) -> &ReadRecord {
        &self.record
    }

    fn stamp(&self, name: &str) -> Option<Stamp> {
        if self.in_memory.contains_key(name) {
            return None;
        }
        stamp_of(&self.find(name).ok()?)
    }

    fn record_unchanged(&self, name: &str, stamp: &Stamp, digest: Digest) {
        self.record.add_digest(name, digest);
        self.progress().paths.push(stamp.path.clone());
    }
}

/// Returns the version stamp of the file at a path, or `None` if the file does not exist.
pub fn stamp_of(path: &Path) -> Option<Stamp> {
    let metadata = fs::metadata(path).ok()?;
    #[cfg(unix)]
    let (number, changed) = {
        use std::os::unix::fs::MetadataExt as _;
        (metadata.ino(), i128::from(metadata.ctime()) * 1_000_000_000 + i128::from(metadata.ctime_nsec()))
    };
    #[cfg(not(unix))]
    let (number, changed) = (0, 0);
    let modified = match metadata.modified().ok()?.duration_since(UNIX_EPOCH) {
        Ok(after) => after.as_nanos() as i128,
        Err(before) => -(before.duration().as_nanos() as i128),
    };
    Some(Stamp { path: path.into(), modified, changed, size: metadata.len(), number })
}

/// Reads a file whose size should be `size` bytes; if it has grown, reads at most `most + 1` bytes.
/// If the size is exact, the bytes are read directly into the result without being copied.
fn read_all(mut file: fs::File, size: usize, most: u64) -> std::io::Result<Arc<[u8]>> {
    let mut bytes: Arc<[u8]> = std::iter::repeat_n(0, size).collect();
    let mut room = Arc::get_mut(&mut bytes).unwrap_or_default();
    loop {
        match file.read(room) {
            Ok(0) => break,
            Ok(count) => room = &mut std::mem::take(&mut room)[count..],
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    let read = size - room.len();
    let mut more = Vec::new();
    file.take(most.saturating_add(1).saturating_sub(read as u64)).read_to_end(&mut more)?;
    Ok(if read == size && more.is_empty() { bytes } else { [&bytes[..read], &more].concat().into() })
}

#[cfg(test)]
mod tests;
