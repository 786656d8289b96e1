//! Reader of ZIP archives. The reader checks the uncompressed size of a part before it allocates
//! memory for the part.

use flate2::read::DeflateDecoder;
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder};
use std::collections::BTreeMap;
use std::io::Read;

/// Maximum number of parts that an archive may have.
const MAX_PARTS: usize = 1 << 16;
/// Limits that protect against decompression bombs: the maximum ratio between the size of all
/// uncompressed parts and the size of the archive, and a number of bytes that is always allowed.
/// Models stored as text compress to about a tenth of their size, and rarely to a fiftieth.
const MAX_RATIO: u64 = 200;
const FREE_BYTES: u64 = 1 << 24;

/// ZIP archive in memory; its parts are decompressed on request.
pub(super) struct Zip<'a> {
    bytes: &'a [u8],
    /// Location, compression method, and uncompressed size of each part, by the name of the part.
    parts: BTreeMap<String, (ZipArchiveEntryWayfinder, CompressionMethod, u64)>,
    /// Names of the parts in the order of the archive.
    order: Vec<String>,
    /// Number of bytes that may still be decompressed.
    left: u64,
}

/// Returns true if bytes begin like a ZIP archive.
pub(super) fn recognise(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04")
}

impl<'a> Zip<'a> {
    /// Reads the list of parts in an archive.
    pub fn open(bytes: &'a [u8]) -> Result<Self, String> {
        let archive = ZipArchive::from_slice(bytes).map_err(|error| error.to_string())?;
        let (mut parts, mut order) = (BTreeMap::new(), Vec::new());
        let mut entries = archive.entries();
        while let Some(entry) = entries.next_entry().map_err(|error| error.to_string())? {
            let Ok(name) = std::str::from_utf8(entry.file_path().as_bytes()).map(str::to_string) else { continue };
            if parts.len() >= MAX_PARTS {
                return Err(format!("the archive has more than {MAX_PARTS} parts"));
            }
            let part = (entry.wayfinder(), entry.compression_method(), entry.uncompressed_size_hint());
            if parts.insert(name.clone(), part).is_some() {
                return Err(format!("two parts have the name `{name}`"));
            }
            order.push(name);
        }
        Ok(Zip { bytes, parts, order, left: FREE_BYTES + MAX_RATIO * bytes.len() as u64 })
    }

    /// Returns the names of all parts in the archive.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parts.keys().map(String::as_str)
    }

    /// Returns the name of the first part of the archive that meets a condition.
    pub fn first_name(&self, condition: impl Fn(&str) -> bool) -> Option<&str> {
        self.order.iter().map(String::as_str).find(|name| condition(name))
    }

    /// Decompresses a part; returns `None` if the archive has no such part.
    pub fn part(&mut self, name: &str) -> Option<Result<Vec<u8>, String>> {
        let (place, method, size) = *self.parts.get(name)?;
        Some(self.unpacked(place, method, size))
    }

    fn unpacked(
        &mut self,
        place: ZipArchiveEntryWayfinder,
        method: CompressionMethod,
        size: u64,
    ) -> Result<Vec<u8>, String> {
        if size > self.left {
            return Err(format!(
                "it unpacks to {size} bytes, which exceeds the limit of {MAX_RATIO} times the archive's size"
            ));
        }
        self.left -= size;
        let archive = ZipArchive::from_slice(self.bytes).map_err(|error| error.to_string())?;
        let entry = archive.get_entry(place).map_err(|error| error.to_string())?;
        let mut bytes = Vec::new();
        // The decoder checks the size and the checksum when it reaches the end of the part, so
        // reading one byte more than the stated size reveals a wrong size.
        let read = match method {
            CompressionMethod::STORE => entry.verifying_reader(entry.data()).take(size + 1).read_to_end(&mut bytes),
            CompressionMethod::DEFLATE => {
                let inflated = DeflateDecoder::new(entry.data());
                entry.verifying_reader(inflated).take(size + 1).read_to_end(&mut bytes)
            }
            _ => return Err("its compression method is not deflate".into()),
        };
        read.map_err(|error| error.to_string())?;
        if bytes.len() as u64 != size {
            return Err(format!("it does not unpack to its stated size of {size} bytes"));
        }
        Ok(bytes)
    }
}
