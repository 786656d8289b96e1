//! Memory limits for decoding pictures.
//!
//! The size that a header states is not trusted. Before a picture is decoded, its size is compared
//! with the length of the file and with the memory that the caller allows.

use super::{ImageError, MAX_PIXELS};

/// Number of pixels that are allowed for a file of any length, which is 2048 x 2048.
const FREE_PIXELS: u64 = 1 << 22;

/// Number of additional pixels that are allowed for each byte of the file. Deflate compresses by a
/// factor of at most 1032, so a byte can hold at most 1032 / 3 pixels with three 8-bit channels, or
/// 1032 pixels with one grey channel. The limit is about twice the larger of these numbers.
const PIXELS_PER_BYTE: u64 = 2048;

/// Returns the maximum number of pixels that are read from a file of `bytes` bytes.
pub fn pixel_limit(bytes: usize) -> u64 {
    (bytes as u64).saturating_mul(PIXELS_PER_BYTE).saturating_add(FREE_PIXELS).min(MAX_PIXELS)
}

/// Returns the number of pixels in a picture whose header states this size, if this number is
/// allowed for a file of `bytes` bytes.
pub(super) fn declared_count(width: u64, height: u64, bytes: usize) -> Result<usize, ImageError> {
    match width.checked_mul(height) {
        Some(count) if count <= pixel_limit(bytes) && count > 0 => Ok(count as usize),
        Some(0) => Err(ImageError::InvalidSize { width: width as u32, height: height as u32 }),
        _ => Err(ImageError::TooLarge { width, height, bytes }),
    }
}

/// Creates a list of `count` copies of a value. If there is not enough memory, the function returns
/// an error instead of ending the program.
pub(super) fn try_vec<T: Clone>(count: usize, item: T) -> Result<Vec<T>, ImageError> {
    let mut all = Vec::new();
    all.try_reserve_exact(count).map_err(|_| ImageError::out_of_memory(count, size_of::<T>()))?;
    all.resize(count, item);
    Ok(all)
}

/// Returns true if this many bytes can be allocated at the moment. If a system limit is too low,
/// this lets large jobs fail with an error before they start.
pub fn can_allocate(bytes: u64) -> bool {
    let length = usize::try_from(bytes).unwrap_or(usize::MAX);
    // The check uses no memory, because the system provides pages only when they are written to.
    Vec::<u8>::new().try_reserve_exact(length).is_ok()
}

/// Returns the number of pixels in a picture, if its size is valid.
///
/// # Errors
/// [`ImageError::InvalidSize`].
pub fn checked_count(width: u32, height: u32) -> Result<usize, ImageError> {
    match u64::from(width) * u64::from(height) {
        count @ 1..=MAX_PIXELS => Ok(count as usize),
        _ => Err(ImageError::InvalidSize { width, height }),
    }
}
