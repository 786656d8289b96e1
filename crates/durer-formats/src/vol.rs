//! Reader and writer of Mitsuba's volume files, which contain densities on a grid.
//!
//! A file is little-endian and contains `VOL` and the version (3), followed by 32-bit numbers: the
//! type (1 for `f32`), the counts along x, y, and z, the number of channels (1), the six
//! coordinates of the bounds, and the values, ordered so that x varies fastest. Source:
//! documentation of Mitsuba 3, `gridvolume`.

use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_scene::math::{Aabb, Vec3};
use durer_scene::medium::DensityGrid;

const HEADER: usize = 48;

/// Reads a density grid and its bounds. The densities may use at most `memory` bytes.
pub fn read(bytes: &[u8], file: u32, memory: u64, diagnostics: &mut Diagnostics) -> Option<(Aabb, DensityGrid)> {
    with_diagnostics(parse(bytes, memory), bytes, file, diagnostics)
}

/// Returns the mean of the values in a file, which can have one or three channels.
pub fn mean(bytes: &[u8], file: u32, memory: u64, diagnostics: &mut Diagnostics) -> Option<Vec3> {
    let (_, _, channels, values) = with_diagnostics(values(bytes, &[1, 3], memory), bytes, file, diagnostics)?;
    let mut sums = [0.0; 3];
    values.iter().zip((0..channels).cycle()).for_each(|(value, channel)| sums[channel] += f64::from(*value));
    let count = (values.len() / channels) as f64;
    Some(Vec3::from_array(std::array::from_fn(|i| (sums[i.min(channels - 1)] / count) as f32)))
}

/// Byte offset where an error occurred, and the error message.
type ParseError = (usize, String);

fn with_diagnostics<T>(
    read: Result<T, ParseError>,
    bytes: &[u8],
    file: u32,
    diagnostics: &mut Diagnostics,
) -> Option<T> {
    let report = |(at, message): ParseError| {
        let at = at.min(bytes.len()) as u32;
        diagnostics.push(Diagnostic::error(message).code("bad-file").at(Span { file, start: at, end: at }));
    };
    read.map_err(report).ok()
}

fn parse(bytes: &[u8], memory: u64) -> Result<(Aabb, DensityGrid), ParseError> {
    let (bounds, counts, _, values) = values(bytes, &[1], memory)?;
    let grid = DensityGrid::new(counts, values);
    grid.map(|grid| (bounds, grid)).ok_or((HEADER, "the densities cannot be used".into()))
}

/// Reads the bounds, the counts along the axes, the number of channels, and the values of a file.
/// `channels` lists the numbers of channels that the caller can handle.
fn values(bytes: &[u8], channels: &[usize], memory: u64) -> Result<(Aabb, [u32; 3], usize, Vec<f32>), ParseError> {
    if !bytes.starts_with(b"VOL") || bytes.get(3) != Some(&3) {
        return Err((0, "a Mitsuba volume file must begin with `VOL` and version 3".into()));
    }
    let word = |at: usize| -> Result<[u8; 4], ParseError> {
        let found = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
        found.ok_or_else(|| (at, format!("the file ends within its header of {HEADER} bytes")))
    };
    let whole = |at: usize| word(at).map(i32::from_le_bytes);
    let real = |at: usize| word(at).map(f32::from_le_bytes);
    if whole(4)? != 1 {
        return Err((4, "only volumes of 32-bit floating point numbers can be read (type 1)".into()));
    }
    let counts = [whole(8)?, whole(12)?, whole(16)?];
    if counts.iter().any(|&n| n < 1) {
        let [x, y, z] = counts;
        return Err((8, format!("the grid of {x} x {y} x {z} points is empty")));
    }
    let own = whole(20)?;
    let Some(&channels) = channels.iter().find(|&&n| own == n as i32) else {
        let wanted: Vec<String> = channels.iter().map(usize::to_string).collect();
        return Err((20, format!("the volume must have {} channel, but has {own}", wanted.join(" or "))));
    };
    let min = Vec3::new(real(24)?, real(28)?, real(32)?);
    let max = Vec3::new(real(36)?, real(40)?, real(44)?);
    if !(min.is_finite() && max.is_finite() && min.cmplt(max).all()) {
        return Err((24, "the bounding box of the volume is empty or not finite".into()));
    }
    let wanted = counts.iter().fold(channels as u64, |product, &n| product.saturating_mul(n as u64));
    let there = (bytes.len() - HEADER) as u64 / 4;
    if there < wanted {
        return Err((bytes.len(), format!("the file ends after {there} of {wanted} densities")));
    }
    if wanted.saturating_mul(4) > memory {
        return Err((8, format!("{wanted} densities exceed the memory limit")));
    }
    let values = bytes[HEADER..].chunks_exact(4).take(wanted as usize);
    let values: Vec<f32> = values.map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]])).collect();
    let bad = values.iter().position(|x| !x.is_finite() || *x < 0.0);
    if let Some(bad) = bad {
        return Err((
            HEADER + 4 * bad,
            format!("density number {} is {}, but must be 0 or more", bad + 1, values[bad]),
        ));
    }
    Ok((Aabb { min, max }, counts.map(|n| n as u32), channels, values))
}

/// Encodes a density grid as a volume file.
pub fn write(bounds: &Aabb, grid: &DensityGrid) -> Vec<u8> {
    let mut bytes = b"VOL\x03".to_vec();
    let [x, y, z] = grid.counts();
    [1, x, y, z, 1].iter().for_each(|n: &u32| bytes.extend(n.to_le_bytes()));
    let corners = [bounds.min, bounds.max];
    let corners = corners.iter().flat_map(|corner| corner.to_array());
    corners.chain(grid.values().iter().copied()).for_each(|x| bytes.extend(x.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a file that contains 2 x 1 x 1 densities.
    fn file() -> Vec<u8> {
        let mut bytes = b"VOL\x03".to_vec();
        [1_i32, 2, 1, 1, 1].iter().for_each(|n| bytes.extend(n.to_le_bytes()));
        [0.0_f32, 0.0, 0.0, 2.0, 1.0, 1.0, 0.5, 4.0].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes
    }

    #[test]
    fn volume_is_read_and_its_errors_have_byte_offsets() {
        let (bounds, grid) = parse(&file(), 1 << 20).unwrap();
        assert_eq!((bounds.max, grid.max_density()), (Vec3::new(2.0, 1.0, 1.0), 4.0));
        assert_eq!(grid.at(&bounds, Vec3::new(0.5, 0.5, 0.5)), 0.5);
        for length in 0..file().len() {
            let (at, message) = parse(&file()[..length], 1 << 20).unwrap_err();
            assert!(at <= length && !message.is_empty());
        }
        let changed = |at: usize, four: [u8; 4]| {
            let mut bytes = file();
            bytes[at..at + 4].copy_from_slice(&four);
            parse(&bytes, 1 << 20).unwrap_err().0
        };
        assert_eq!(changed(8, (-1_i32).to_le_bytes()), 8);
        assert_eq!(changed(20, 3_i32.to_le_bytes()), 20);
        assert_eq!(changed(24, f32::NAN.to_le_bytes()), 24);
        assert_eq!(changed(52, (-1.0_f32).to_le_bytes()), 52);
        assert_eq!(parse(&file(), 7).unwrap_err().0, 8);
        // The file declares counts that are larger than any file can hold.
        assert_eq!(changed(8, i32::MAX.to_le_bytes()), file().len());
    }
}
