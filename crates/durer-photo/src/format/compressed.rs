//! Decompresses files compressed by gzip or bzip2, such as those of *Bundle Adjustment in the
//! Large*.

use crate::Error;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Maximum length of a decompressed file in bytes. Without it, a small malicious file could fill
/// the memory.
const MAX_DECOMPRESSED_SIZE: u64 = 4 << 30;

/// Decompresses a file if it begins with a gzip or bzip2 signature.
pub fn decompress(file: &str, bytes: Arc<[u8]>) -> Result<Arc<[u8]>, Error> {
    let (packed, mut reader): (_, Box<dyn Read + '_>) = match bytes.get(..3) {
        Some([0x1f, 0x8b, _]) => ("gzip", Box::new(flate2::read::MultiGzDecoder::new(&*bytes))),
        Some(b"BZh") => ("bzip2", Box::new(bzip2::read::MultiBzDecoder::new(&*bytes))),
        _ => return Ok(bytes),
    };
    let mut plain = Vec::new();
    let read = reader.by_ref().take(MAX_DECOMPRESSED_SIZE + 1).read_to_end(&mut plain);
    read.map_err(|error| Error::in_file(file, format!("cannot decompress the file ({packed}): {error}")))?;
    if plain.len() as u64 > MAX_DECOMPRESSED_SIZE {
        return Err(Error::in_file(
            file,
            format!("the file is longer than {} GiB after decompression", MAX_DECOMPRESSED_SIZE >> 30),
        ));
    }
    Ok(plain.into())
}

/// Removes the extension `.gz` or `.bz2` from a path.
pub fn without_compression_extension(path: &Path) -> PathBuf {
    match path.extension().and_then(|end| end.to_str()) {
        Some("gz" | "bz2") => path.with_extension(""),
        _ => path.to_path_buf(),
    }
}
