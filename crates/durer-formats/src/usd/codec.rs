//! Compression in USD's binary files: LZ4 blocks, and integers stored as differences of few bits.
//!
//! Source: *OpenUSD specification*, "USDC file format".

/// Minimum number of elements of an array that is stored compressed.
pub(super) const MIN_COMPRESSED: usize = 16;

/// Error in compressed data.
pub(super) const BROKEN: &str = "its compressed data are damaged";

/// Decompresses data that expand to `size` bytes. The first byte is the number of LZ4 blocks, each
/// preceded by its length, or 0 for a single block.
pub(super) fn decompress(data: &[u8], size: usize) -> Result<Vec<u8>, String> {
    // An LZ4 byte stands for at most 255 bytes.
    if size > 255 * data.len() {
        return Err(BROKEN.into());
    }
    let (&blocks, mut rest) = data.split_first().ok_or(BROKEN)?;
    let mut out = vec![0; size];
    if blocks == 0 {
        let length = lz4_flex::block::decompress_into(rest, &mut out).map_err(|_| BROKEN)?;
        out.truncate(length);
        return Ok(out);
    }
    let mut done = 0;
    for _ in 0..blocks {
        let (length, tail) = rest.split_first_chunk::<4>().ok_or(BROKEN)?;
        let length = u32::from_le_bytes(*length) as usize;
        let (block, tail) = tail.split_at_checked(length).ok_or(BROKEN)?;
        done += lz4_flex::block::decompress_into(block, &mut out[done..]).map_err(|_| BROKEN)?;
        rest = tail;
    }
    out.truncate(done);
    Ok(out)
}

/// Returns the number of bytes that `count` encoded integers of 4 or 8 bytes need at most.
fn encoded_size(count: usize, width: usize) -> usize {
    width + count.div_ceil(4) + count * width
}

/// Decodes `count` integers of 32 bits.
pub(super) fn integers(data: &[u8], count: usize) -> Result<Vec<i32>, String> {
    let all = differences::<4>(data, count, [0, 1, 2, 4])?;
    Ok(all.into_iter().map(|x| x as i32).collect())
}

/// Decodes `count` integers of 64 bits.
pub(super) fn long_integers(data: &[u8], count: usize) -> Result<Vec<i64>, String> {
    differences::<8>(data, count, [0, 2, 4, 8])
}

/// Decodes integers of `WIDTH` bytes. The data contain the most frequent difference between
/// neighbours, a code of two bits for each integer, and the differences; `sizes` are the bytes of a
/// difference for each code.
fn differences<const WIDTH: usize>(data: &[u8], count: usize, sizes: [usize; 4]) -> Result<Vec<i64>, String> {
    // An encoded integer takes at least two bits, and an LZ4 byte stands for at most 255 bytes.
    if count / 4 > 255 * data.len() {
        return Err(BROKEN.into());
    }
    let size = encoded_size(count, WIDTH).min(255 * data.len());
    let plain = decompress(data, size)?;
    let (common, rest) = plain.split_at_checked(WIDTH).ok_or(BROKEN)?;
    let (codes, mut rest) = rest.split_at_checked(count.div_ceil(4)).ok_or(BROKEN)?;
    let common = signed(common);
    let (mut out, mut last) = (Vec::with_capacity(count), 0i64);
    for i in 0..count {
        let code = codes[i / 4] >> (2 * (i % 4)) & 3;
        let step = match sizes[usize::from(code)] {
            0 => common,
            size => {
                let (step, tail) = rest.split_at_checked(size).ok_or(BROKEN)?;
                rest = tail;
                signed(step)
            }
        };
        last = match WIDTH {
            4 => i64::from((last as i32).wrapping_add(step as i32)),
            _ => last.wrapping_add(step),
        };
        out.push(last);
    }
    Ok(out)
}

/// Returns a signed little-endian integer of 1 to 8 bytes.
fn signed(bytes: &[u8]) -> i64 {
    let negative = bytes.last().is_some_and(|byte| byte & 0x80 != 0);
    let mut wide = [if negative { 0xff } else { 0 }; 8];
    wide[..bytes.len()].copy_from_slice(bytes);
    i64::from_le_bytes(wide)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns an LZ4 block of one literal run, for data of less than 15 bytes.
    fn literal(data: &[u8]) -> Vec<u8> {
        [&[0, (data.len() as u8) << 4][..], data].concat()
    }

    #[test]
    fn integers_are_sums_of_differences() {
        // The common difference is 1. The codes are 0, 1, 0 and 2: 1, 1 - 3, -2 + 1, -1 + 500.
        let plain = [1, 0, 0, 0, 0b10_00_01_00, 0xfd, 0xf4, 0x01];
        assert_eq!(integers(&literal(&plain), 4).unwrap(), [1, -2, -1, 499]);
        assert!(integers(&literal(&plain[..7]), 4).is_err());
        assert!(integers(&literal(&plain), usize::MAX / 8).is_err());
        let plain = [2, 0, 0, 0, 0, 0, 0, 0, 0b01_00, 0xff, 0xff];
        assert_eq!(long_integers(&literal(&plain), 2).unwrap(), [2, 1]);
    }

    #[test]
    fn announced_sizes_allocate_nothing() {
        assert!(decompress(&[0, 0], usize::MAX).is_err());
        assert!(decompress(&[], 0).is_err());
        assert!(decompress(&[2, 1, 0, 0, 0], 10).is_err());
    }
}
