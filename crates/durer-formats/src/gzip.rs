//! Reads files that are compressed with gzip.

use durer_scene::source::{AssetSource, SourceError};
use std::io::Read as _;
use std::sync::Arc;

/// Reads a file by its name in the scene, and decompresses it if it is in gzip format. The
/// decompressed data may not exceed the number of bytes that the source may still read.
///
/// # Errors
///
/// Returns the errors of [`AssetSource::read`], and [`SourceError::Io`] if compressed data is
/// damaged or too large for the limit.
pub fn read_decompressed(source: &dyn AssetSource, name: &str) -> Result<Arc<[u8]>, SourceError> {
    let bytes = source.read(name)?;
    if !is_gzip(&bytes) {
        return Ok(bytes);
    }
    let all = decompress(&bytes, source.budget()).map_err(|problem| {
        let error = std::io::Error::new(std::io::ErrorKind::InvalidData, problem);
        SourceError::Io { name: name.into(), error }
    })?;
    source.spend(all.len() as u64);
    Ok(all)
}

/// Returns true if the bytes are in gzip format.
pub fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x1f\x8b")
}

/// Decompresses gzip data, up to a size of `budget` bytes. The output may not be larger than the
/// size that the last four bytes declare.
///
/// # Errors
///
/// Returns an error message if the data is damaged or its output would be too large.
pub fn decompress(bytes: &[u8], budget: u64) -> Result<Arc<[u8]>, String> {
    // Deflate compresses at most 1032 bytes into one byte. The last four bytes contain the
    // uncompressed size of the last member of the file.
    let most = budget.min(1032 * bytes.len() as u64);
    let declared = bytes.last_chunk().map_or(0, |size| u64::from(u32::from_le_bytes(*size)));
    if declared > most {
        return Err(format!("the gzip file is too large, because it unpacks to {declared} bytes"));
    }
    let mut all = Vec::new();
    let mut decoder = flate2::read::MultiGzDecoder::new(bytes).take(most + 1);
    match decoder.read_to_end(&mut all) {
        Ok(_) if all.len() as u64 <= most => Ok(all.into()),
        Ok(_) => Err(format!("the gzip file is too large, because it unpacks to more than {most} bytes")),
        Err(error) => Err(format!("cannot unpack the gzip file: {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gzip_members_are_concatenated() {
        use std::io::Write as _;
        let packed = |text: &str| {
            let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
            encoder.write_all(text.as_bytes()).unwrap();
            encoder.finish().unwrap()
        };
        let both = [packed("a cube, "), packed("a ball")].concat();
        assert_eq!(&*decompress(&both, 100).unwrap(), b"a cube, a ball");
        assert!(decompress(&both, 13).unwrap_err().contains("too large"));
        assert!(decompress(&both[..both.len() - 1], 100).is_err());
    }
}
