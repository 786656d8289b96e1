//! Sources that provide the files of a scene by name, independent of where they are stored.
//!
//! [`AssetSource`] is the trait of all sources. [`MemorySource`] holds files in memory, and
//! `durer_formats::folder::FolderSource` reads files from folders of the file system. Every source
//! has a [`ReadRecord`] of the files that were read.

use durer_diag::did_you_mean;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// BLAKE3 hash of a file or of scene data, displayed as 64 hexadecimal digits.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Digest(pub [u8; 32]);

impl Digest {
    /// Computes the hash of some bytes.
    pub fn of(bytes: &[u8]) -> Self {
        // For less than 1 MiB of data, threads cost more time than they save.
        match bytes.len() < 1 << 20 {
            true => Digest(blake3::hash(bytes).into()),
            false => Digest(blake3::Hasher::new().update_rayon(bytes).finalize().into()),
        }
    }

    /// Creates an incremental hasher for numbers.
    pub fn hasher() -> Hasher {
        Hasher { hasher: blake3::Hasher::new(), buffer: Vec::with_capacity(Hasher::BLOCK) }
    }
}

/// Incremental hasher that hashes numbers as little-endian bytes and returns a [`Digest`].
#[derive(Debug)]
pub struct Hasher {
    hasher: blake3::Hasher,
    buffer: Vec<u8>,
}

impl Hasher {
    /// Buffer size in bytes.
    const BLOCK: usize = 1 << 16;

    /// Adds a 32-bit number to the hash.
    pub fn add_u32(&mut self, word: u32) {
        self.buffer.extend(word.to_le_bytes());
        if self.buffer.len() >= Hasher::BLOCK {
            self.hasher.update(&self.buffer);
            self.buffer.clear();
        }
    }

    /// Adds a count to the hash as a 64-bit number.
    pub fn add_u64(&mut self, count: u64) {
        self.add_u32(count as u32);
        self.add_u32((count >> 32) as u32);
    }

    /// Returns the hash of all added numbers.
    pub fn finish(mut self) -> Digest {
        self.hasher.update(&self.buffer);
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

/// Reason why a file of a scene could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SourceError {
    /// The file was not found at any of the searched paths.
    #[error("the file `{name}` does not exist")] // prose: keep
    Missing {
        /// Requested name.
        name: String,
        /// Paths at which the file was searched for.
        tried: Vec<PathBuf>,
        /// An existing file with a similar name.
        similar: Option<String>,
    },
    /// The file is outside the allowed folders.
    #[error("`{name}` is outside the scene's folder")]
    Outside {
        /// Requested name.
        name: String,
    },
    /// The path is a folder, a device or a pipe.
    #[error("`{name}` is not a regular file")]
    NotAFile {
        /// Requested name.
        name: String,
    },
    /// The file is larger than the remaining budget.
    #[error("`{name}` is too large: {size} bytes, but only {left} bytes of the budget are left")]
    TooLarge {
        /// Requested name.
        name: String,
        /// Size in bytes.
        size: u64,
        /// Number of bytes that remain in the budget.
        left: u64,
    },
    /// Input/output error of the operating system.
    #[error("cannot read `{name}`: {error}")]
    Io {
        /// Requested name.
        name: String,
        /// Error reported by the operating system.
        error: std::io::Error,
    },
}

impl SourceError {
    /// Help text that suggests a similar name or the option to use.
    pub fn help(&self) -> Option<String> {
        match self {
            SourceError::Missing { similar: Some(near), .. } => Some(format!("did you mean `{near}`?")),
            SourceError::Outside { .. } => {
                let only = "a scene can only use files in or below its own folder, unless `--allow-outside` is given";
                Some(only.into())
            }
            _ => None,
        }
    }
}

/// Version of a file, which changes whenever the file is saved again or replaced.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Stamp {
    /// Path of the file.
    pub path: PathBuf,
    /// Time of the last modification, in nanoseconds since 1970.
    pub modified: i128,
    /// Time of the last change of the content or of the times themselves, in nanoseconds since
    /// 1970; 0 if the system records none. Programs that copy files can set `modified`, but not
    /// this time.
    pub changed: i128,
    /// Size in bytes.
    pub size: u64,
    /// Inode number, or 0 if the file system has none. It changes when another file replaces the
    /// file.
    pub number: u64,
}

/// Record of the files that a source has read. It maps their names in the scene to hashes of their
/// contents.
#[derive(Debug, Default)]
pub struct ReadRecord(Mutex<BTreeMap<String, Digest>>);

impl Clone for ReadRecord {
    fn clone(&self) -> Self {
        ReadRecord(Mutex::new(self.hashes().clone()))
    }
}

impl ReadRecord {
    fn hashes(&self) -> MutexGuard<'_, BTreeMap<String, Digest>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds the bytes that were read for a file name.
    pub fn add(&self, name: &str, bytes: &[u8]) {
        self.add_digest(name, Digest::of(bytes));
    }

    /// Adds the hash of the bytes that were read for a file name.
    pub fn add_digest(&self, name: &str, digest: Digest) {
        self.hashes().insert(name.into(), digest);
    }

    /// Returns the hash of the bytes that were read for a file name.
    pub fn digest_of(&self, name: &str) -> Option<Digest> {
        self.hashes().get(name).copied()
    }

    /// Computes a hash of `more` and of all names and hashes in the record.
    pub fn digest(&self, more: &[u8]) -> Digest {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&Digest::of(more).0);
        for (name, digest) in &*self.hashes() {
            hasher.update(&Digest::of(name.as_bytes()).0).update(&digest.0);
        }
        Digest(hasher.finalize().into())
    }
}

/// Source of the files that a scene refers to, such as a folder or memory.
pub trait AssetSource: std::fmt::Debug + Sync {
    /// Reads a file by its name in the scene, and adds it to the record.
    ///
    /// # Errors
    ///
    /// Returns a [`SourceError`] if the file does not exist, is not allowed, or cannot be read.
    fn read(&self, name: &str) -> Result<Arc<[u8]>, SourceError>;

    /// True if a file with this name exists and may be read.
    fn contains(&self, name: &str) -> bool;

    /// Returns the record of the files that were read so far.
    fn record(&self) -> &ReadRecord;

    /// Number of bytes that may still be read. Decompressed bytes count towards the budget too.
    fn budget(&self) -> u64 {
        u64::MAX
    }

    /// Subtracts bytes from the budget.
    fn spend(&self, _bytes: u64) {}

    /// Reads a file that is named by the user rather than by the scene, and can therefore be in any
    /// folder. Adds it to the record under its path.
    ///
    /// # Errors
    ///
    /// See [`AssetSource::read`].
    fn read_user_file(&self, path: &Path) -> Result<Arc<[u8]>, SourceError> {
        self.read(&path.to_string_lossy())
    }

    /// Returns the version of a file by its name in the scene, or `None` if it is unknown.
    fn stamp(&self, _name: &str) -> Option<Stamp> {
        None
    }

    /// Adds to the record a file that was read earlier and has not changed since `stamp`.
    fn record_unchanged(&self, name: &str, _stamp: &Stamp, digest: Digest) {
        self.record().add_digest(name, digest);
    }
}

/// Source of files that are held in memory, by name.
#[derive(Clone, Debug, Default)]
pub struct MemorySource {
    files: BTreeMap<String, Arc<[u8]>>,
    record: ReadRecord,
}

impl MemorySource {
    /// Adds a file, and replaces any file with the same name.
    pub fn insert(&mut self, name: impl Into<String>, bytes: impl Into<Arc<[u8]>>) {
        self.files.insert(name.into(), bytes.into());
    }
}

impl AssetSource for MemorySource {
    fn read(&self, name: &str) -> Result<Arc<[u8]>, SourceError> {
        match self.files.get(name) {
            Some(bytes) => {
                self.record.add(name, bytes);
                Ok(bytes.clone())
            }
            None => {
                let similar = did_you_mean(name, self.files.keys().map(String::as_str)).map(str::to_string);
                Err(SourceError::Missing { name: name.into(), tried: Vec::new(), similar })
            }
        }
    }

    fn contains(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    fn record(&self) -> &ReadRecord {
        &self.record
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_in_memory_are_found_and_recorded() {
        let mut source = MemorySource::default();
        source.insert("cube.obj", *b"v 0 0 0");
        assert!(source.contains("cube.obj") && !source.contains("ball.obj"));
        let empty = source.record().digest(b"");
        assert_eq!(&*source.read("cube.obj").unwrap(), b"v 0 0 0");
        assert_eq!(source.record().digest_of("cube.obj"), Some(Digest::of(b"v 0 0 0")));
        assert_ne!(source.record().digest(b""), empty);
        match source.read("cubes.obj") {
            Err(SourceError::Missing { name, similar, .. }) => {
                assert_eq!((name.as_str(), similar.as_deref()), ("cubes.obj", Some("cube.obj")));
            }
            other => panic!("{other:?}"),
        }
    }
}
