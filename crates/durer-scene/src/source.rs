//! Bytes by name: the only place that opens a file for reading.
//!
//! Files are read from a few allowed folders, never beyond them, and within a budget of bytes. What
//! was read is remembered by its hash.

use durer_diag::did_you_mean;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// A BLAKE3 hash; shown as 64 hexadecimal digits.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Digest(pub [u8; 32]);

impl Digest {
    /// The hash of some bytes.
    pub fn of(bytes: &[u8]) -> Self {
        // Below this, threads cost more than they bring.
        match bytes.len() < 1 << 20 {
            true => Digest(blake3::hash(bytes).into()),
            false => Digest(blake3::Hasher::new().update_rayon(bytes).finalize().into()),
        }
    }

    /// A hash of numbers, to be made one by one.
    pub fn hasher() -> Hasher {
        Hasher { hasher: blake3::Hasher::new(), waiting: Vec::with_capacity(Hasher::BLOCK) }
    }
}

/// Makes the hash of many numbers, as little-endian bytes.
#[derive(Debug)]
pub struct Hasher {
    hasher: blake3::Hasher,
    waiting: Vec<u8>,
}

impl Hasher {
    /// Bytes that are hashed at once.
    const BLOCK: usize = 1 << 16;

    /// Adds 32 bits.
    pub fn word(&mut self, word: u32) {
        self.waiting.extend(word.to_le_bytes());
        if self.waiting.len() >= Hasher::BLOCK {
            self.hasher.update(&self.waiting);
            self.waiting.clear();
        }
    }

    /// Adds a count, in 64 bits.
    pub fn count(&mut self, count: u64) {
        self.word(count as u32);
        self.word((count >> 32) as u32);
    }

    /// The hash.
    pub fn finish(mut self) -> Digest {
        self.hasher.update(&self.waiting);
        Digest(self.hasher.finalize().into())
    }
}

impl std::fmt::Display for Digest {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl std::fmt::Debug for Digest {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Why a file could not be had.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    /// It is in none of the places where it was looked for.
    #[error("there is no file `{name}`")]
    Missing {
        /// As it was asked for.
        name: String,
        /// Where it was looked for.
        tried: Vec<PathBuf>,
        /// A file there that has nearly its name.
        near: Option<String>,
    },
    /// It lies outside the allowed folders.
    #[error("`{name}` lies outside the scene's folder")]
    Outside {
        /// As it was asked for.
        name: String,
    },
    /// It is a folder, a device or a pipe.
    #[error("`{name}` is not a regular file")]
    NotAFile {
        /// As it was asked for.
        name: String,
    },
    /// It is larger than what may still be read.
    #[error("`{name}` is too large: {size} bytes, and at most {left} may still be read")]
    TooLarge {
        /// As it was asked for.
        name: String,
        /// Its size in bytes.
        size: u64,
        /// What is left of the budget.
        left: u64,
    },
    /// The system's reason.
    #[error("cannot read `{name}`: {error}")]
    Io {
        /// As it was asked for.
        name: String,
        /// The system's reason.
        error: std::io::Error,
    },
}

impl SourceError {
    /// What may have been meant, or what to do.
    pub fn help(&self) -> Option<String> {
        match self {
            SourceError::Missing { near: Some(near), .. } => Some(format!("did you mean `{near}`?")),
            SourceError::Outside { .. } => {
                let only = "a scene may only name files in and below its own folder, unless `--allow-outside` is given";
                Some(only.into())
            }
            _ => None,
        }
    }
}

/// A file, and what tells whether it was saved since: when that was, its size, and its number in
/// its file system, for one that takes the place of another has another.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Stamp {
    path: PathBuf,
    modified: SystemTime,
    size: u64,
    number: u64,
}

impl Stamp {
    /// That of a path; `None` where there is nothing.
    pub fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        #[cfg(unix)]
        let number = std::os::unix::fs::MetadataExt::ino(&metadata);
        #[cfg(not(unix))]
        let number = 0;
        Some(Stamp { path: path.into(), modified: metadata.modified().ok()?, size: metadata.len(), number })
    }
}

/// Where the files of a scene are, and how much may be read of them.
#[derive(Debug)]
pub struct Source {
    /// Folders in which a relative name is looked for, in this order.
    search: Vec<PathBuf>,
    /// Folders below which a file must lie; empty: anywhere.
    allowed: Vec<PathBuf>,
    /// Folders in which a file is also looked for by its last name alone.
    assets: Vec<PathBuf>,
    /// Files that are in no folder, by name: these are looked at first.
    given: BTreeMap<String, Arc<[u8]>>,
    read: Mutex<Already>,
}

/// What was read already.
#[derive(Clone, Debug)]
struct Already {
    /// Bytes that may still be read.
    left: u64,
    /// Hashes of the files, by the names that the scene gives them.
    files: BTreeMap<String, Digest>,
    /// Where they are.
    paths: Vec<PathBuf>,
}

impl Clone for Source {
    fn clone(&self) -> Self {
        let (search, allowed, assets) = (self.search.clone(), self.allowed.clone(), self.assets.clone());
        let (given, read) = (self.given.clone(), Mutex::new(self.already().clone()));
        Source { search, allowed, assets, given, read }
    }
}

impl Source {
    /// The most that is read for one scene, unless [`Source::budget`] says otherwise: 4 GiB.
    pub const DEFAULT_BUDGET: u64 = 4 << 30;

    /// Files in and below one folder.
    pub fn folder(folder: impl Into<PathBuf>) -> Self {
        let folder = folder.into();
        Source {
            search: vec![folder.clone()],
            allowed: vec![folder],
            assets: Vec::new(),
            given: BTreeMap::new(),
            read: Mutex::new(Already { left: Source::DEFAULT_BUDGET, files: BTreeMap::new(), paths: Vec::new() }),
        }
    }

    /// Looks in another folder too: before the others if `first`. That allows nothing.
    pub fn look_in(mut self, folder: impl Into<PathBuf>, first: bool) -> Self {
        let at = if first { 0 } else { self.search.len() };
        self.search.insert(at, folder.into());
        self
    }

    /// Allows files in and below another folder.
    pub fn allow(mut self, folder: impl Into<PathBuf>) -> Self {
        // Where everything is allowed, so is this.
        if !self.allowed.is_empty() {
            self.allowed.push(folder.into());
        }
        self
    }

    /// Looks in a folder by path and, failing that, by bare file name.
    pub fn assets(mut self, folder: impl Into<PathBuf>) -> Self {
        let folder = folder.into();
        self.assets.push(folder.clone());
        self.look_in(folder.clone(), false).allow(folder)
    }

    /// Has a file by some name that is in no folder, or instead of the one there.
    pub fn give(mut self, name: impl Into<String>, bytes: Arc<[u8]>) -> Self {
        self.given.insert(name.into(), bytes);
        self
    }

    /// Allows files anywhere.
    pub fn allow_outside(mut self) -> Self {
        self.allowed.clear();
        self
    }

    /// Sets how many bytes may be read.
    pub fn budget(self, bytes: u64) -> Self {
        self.already().left = bytes;
        self
    }

    fn already(&self) -> MutexGuard<'_, Already> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The hash of all that was read by name, with the names, and of something more.
    pub fn digest(&self, more: &[u8]) -> Digest {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&Digest::of(more).0);
        for (name, digest) in &self.already().files {
            hasher.update(&Digest::of(name.as_bytes()).0).update(&digest.0);
        }
        Digest(hasher.finalize().into())
    }

    /// Where the files are that were read, or tried to be.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.already().paths.clone()
    }

    /// Counts bytes among those that were read by a name.
    pub fn remember(&self, name: &str, bytes: &[u8]) {
        let digest = Digest::of(bytes);
        self.already().files.insert(name.into(), digest);
    }

    /// The file that a scene means by a name, as it is now; `None` where it is in no folder or may
    /// not be read.
    pub fn stamp(&self, name: &str) -> Option<Stamp> {
        if self.given.contains_key(name) {
            return None;
        }
        Stamp::of(&self.find(name).ok()?)
    }

    /// Where the file of that name is, if there is one that may be read.
    pub fn place(&self, name: &str) -> Option<PathBuf> {
        self.find(name).ok().filter(|path| path.is_file())
    }

    /// The hash of what was read by a name.
    pub fn digest_of(&self, name: &str) -> Option<Digest> {
        self.already().files.get(name).copied()
    }

    /// Counts a file among those that were read by a name, though it was read earlier and is as it
    /// was.
    pub fn remember_unread(&self, name: &str, stamp: &Stamp, digest: Digest) {
        let mut already = self.already();
        already.files.insert(name.into(), digest);
        already.paths.push(stamp.path.clone());
    }

    /// Whether there is a file of that name, which may be read.
    pub fn contains(&self, name: &str) -> bool {
        self.given.contains_key(name) || self.find(name).is_ok()
    }

    /// Reads a file by the name that a scene gives it; what is packed by gzip is unpacked, if the
    /// packed file's size in its last four bytes is one that may still be read.
    pub fn read_unpacked(&self, name: &str) -> Result<Arc<[u8]>, SourceError> {
        let bytes = self.read(name)?;
        if !is_packed(&bytes) {
            return Ok(bytes);
        }
        let left = self.already().left;
        let all = unpacked(&bytes, left).map_err(|problem| {
            let error = std::io::Error::new(std::io::ErrorKind::InvalidData, problem);
            SourceError::Io { name: name.into(), error }
        })?;
        self.already().left = left - all.len() as u64;
        Ok(all)
    }

    /// Reads a file by the name that a scene gives it.
    pub fn read(&self, name: &str) -> Result<Arc<[u8]>, SourceError> {
        if let Some(bytes) = self.given.get(name) {
            self.remember(name, bytes);
            return Ok(bytes.clone());
        }
        match self.find(name) {
            Ok(path) => self.read_path(&path, name).inspect(|bytes| self.remember(name, bytes)),
            Err(SourceError::Missing { name, tried, .. }) => {
                Err(SourceError::Missing { near: self.near(&tried), name, tried })
            }
            Err(error) => Err(error),
        }
    }

    /// The first place where a file of that name is, and may be read.
    fn find(&self, name: &str) -> Result<PathBuf, SourceError> {
        // Scenes from Windows may write backslashes.
        let portable = name.replace('\\', "/");
        let path = Path::new(&portable);
        let bare = path.file_name().map(Path::new);
        let mut candidates: Vec<PathBuf> = self.search.iter().map(|folder| folder.join(path)).collect();
        candidates.extend(bare.iter().flat_map(|bare| self.assets.iter().map(move |folder| folder.join(bare))));
        let mut outside = false;
        for candidate in &candidates {
            let Ok(real) = candidate.canonicalize() else { continue };
            if self.allows(&real) {
                return Ok(real);
            }
            outside = true;
        }
        Err(match outside {
            true => SourceError::Outside { name: name.into() },
            false => SourceError::Missing { name: name.into(), near: None, tried: candidates },
        })
    }

    /// A file beside the candidates that has nearly the name of one. What may not be read is not
    /// listed either.
    fn near(&self, candidates: &[PathBuf]) -> Option<String> {
        candidates.iter().find_map(|path| {
            let folder = path.parent()?.canonicalize().ok().filter(|folder| self.allows(folder))?;
            let names: Vec<String> = fs::read_dir(folder)
                .ok()?
                .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
                .take(10_000)
                .collect();
            did_you_mean(path.file_name()?.to_str()?, names.iter().map(String::as_str)).map(str::to_string)
        })
    }

    fn allows(&self, real: &Path) -> bool {
        let below = |folder: &PathBuf| folder.canonicalize().is_ok_and(|folder| real.starts_with(folder));
        self.allowed.is_empty() || self.allowed.iter().any(below)
    }

    /// Reads a file that the user named, wherever it is.
    pub fn read_path(&self, path: &Path, name: &str) -> Result<Arc<[u8]>, SourceError> {
        let io = |error| SourceError::Io { name: name.into(), error };
        self.already().paths.push(path.into());
        let metadata = fs::metadata(path).map_err(io)?;
        if !metadata.is_file() {
            return Err(SourceError::NotAFile { name: name.into() });
        }
        let left = self.already().left;
        let too_large = |size| SourceError::TooLarge { name: name.into(), size, left };
        if metadata.len() > left {
            return Err(too_large(metadata.len()));
        }
        // A file that grows while it is read is still bounded.
        let bytes = all_of(fs::File::open(path).map_err(io)?, metadata.len() as usize, left).map_err(io)?;
        if bytes.len() as u64 > left {
            return Err(too_large(bytes.len() as u64));
        }
        self.already().left = left - bytes.len() as u64;
        Ok(bytes)
    }
}

/// All bytes of a file of about some size, and of one that has grown at most one more than is
/// allowed. Those of a file of that size are written once, where they stay.
fn all_of(mut file: fs::File, size: usize, most: u64) -> std::io::Result<Arc<[u8]>> {
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

/// Whether bytes are packed by gzip.
pub fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x1f\x8b")
}

/// What is packed by gzip, if it is no more than may be read: the packed file tells its size in its
/// last four bytes, and more than that is not unpacked.
///
/// # Errors
/// Why it is not unpacked.
pub fn unpacked(bytes: &[u8], budget: u64) -> Result<Arc<[u8]>, String> {
    // Deflate packs at most 1032 bytes into one.
    let declared = bytes.last_chunk().map_or(0, |size| u64::from(u32::from_le_bytes(*size)));
    if declared > budget || declared > 1032 * bytes.len() as u64 {
        return Err(format!("the packed file would have {declared} bytes: that is too large"));
    }
    let mut all = Vec::new();
    let mut decoder = flate2::read::GzDecoder::new(bytes).take(declared + 1);
    match decoder.read_to_end(&mut all) {
        Ok(_) if all.len() as u64 == declared => Ok(all.into()),
        Ok(_) => Err("the packed file is not as large as it says".into()),
        Err(error) => Err(format!("the file cannot be unpacked: {error}")),
    }
}

#[cfg(test)]
mod tests;
