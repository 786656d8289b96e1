//! How much memory a picture may take.
//!
//! A declared size is never trusted: it is read from the file's head, and compared with the file's
//! length and with the memory that the caller allows, before anything is decoded.

use super::{ImageError, MAX_PIXELS};

/// Pixels allowed whatever the length of the file: a square of 2048.
const FREE_PIXELS: u64 = 1 << 22;

/// Pixels allowed for each byte of a file. Deflate packs at most 1032 bytes into one, so a picture
/// of eight bits a channel has at most 1032 / 3 of them; twice that for one grey channel.
const PIXELS_PER_BYTE: u64 = 2048;

/// The most pixels that are read from a file of so many bytes.
pub fn pixel_limit(bytes: usize) -> u64 {
    (bytes as u64).saturating_mul(PIXELS_PER_BYTE).saturating_add(FREE_PIXELS).min(MAX_PIXELS)
}

/// Number of pixels of a declared size, if a file of so many bytes may have it.
pub(super) fn declared_count(width: u64, height: u64, bytes: usize) -> Result<usize, ImageError> {
    match width.checked_mul(height) {
        Some(count) if count <= pixel_limit(bytes) && count > 0 => Ok(count as usize),
        Some(0) => Err(ImageError::Size { width: width as u32, height: height as u32 }),
        _ => Err(ImageError::TooLarge { width, height, bytes }),
    }
}

/// So many equal things. Where the system has no memory for them, that is an error and not the end
/// of the program.
pub(super) fn room_for<T: Clone>(count: usize, thing: T) -> Result<Vec<T>, ImageError> {
    let mut all = Vec::new();
    all.try_reserve_exact(count).map_err(|_| ImageError::no_room(count, size_of::<T>()))?;
    all.resize(count, thing);
    Ok(all)
}

/// Number of pixels of a picture, if it is a possible one.
///
/// # Errors
/// [`ImageError::Size`].
pub fn checked_count(width: u32, height: u32) -> Result<usize, ImageError> {
    match u64::from(width) * u64::from(height) {
        count @ 1..=MAX_PIXELS => Ok(count as usize),
        _ => Err(ImageError::Size { width, height }),
    }
}
