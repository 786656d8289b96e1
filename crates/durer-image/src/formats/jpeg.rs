//! JPEG format, with 8 bits per channel, for photographs, textures and web pages. It is lossy.

use super::{Depth, Format, ImageError, ImageHeader, Layer, WriteOptions, codec};
use ::image::{ImageFormat, codecs::jpeg::JpegEncoder};

const NAME: &str = "JPEG";
/// Quality of written files, from 1 to 100. At this quality, the loss is hardly visible.
const QUALITY: u8 = 95;

/// Frame header of a JPEG file: the width, the height, and the horizontal and vertical sampling
/// factors of each component.
struct Frame {
    size: [u64; 2],
    factors: Vec<[u64; 2]>,
}

/// Finds the frame header in a file.
///
/// Source: ITU-T T.81, *Digital Compression and Coding of Continuous-Tone Still Images*, annex
/// B.2.2.
fn frame(bytes: &[u8]) -> Option<Frame> {
    let mut rest = bytes.get(2..)?;
    loop {
        // Bytes before a marker are skipped, as they are by other decoders.
        let at = rest.windows(2).position(|pair| pair[0] == 0xff && !matches!(pair[1], 0 | 0xff))?;
        let marker = rest[at + 1];
        rest = &rest[at + 2..];
        if matches!(marker, 1 | 0xd0..=0xd9) {
            continue;
        }
        let length = usize::from(u16::from_be_bytes(*rest.first_chunk()?));
        let segment = rest.get(2..length)?;
        // Markers in this range start a frame, whatever its coding is. Three of the markers have
        // other meanings.
        if matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
            let &[_, h1, h0, w1, w0, count, ref components @ ..] = segment else { return None };
            let factors = components.chunks_exact(3).take(count.into());
            let factors = factors.map(|c| [u64::from(c[1] >> 4).max(1), u64::from(c[1] & 15).max(1)]).collect();
            return Some(Frame { size: [[w1, w0], [h1, h0]].map(|side| u16::from_be_bytes(side).into()), factors });
        }
        rest = &rest[length..];
    }
}

/// Number of bytes of memory that the decoder needs in addition to the pixels: for the 16-bit
/// coefficients of all components until the last scan, and for rows of blocks while components are
/// upsampled to full size. Components are padded to full blocks at the largest sampling factors.
fn decoding_bytes(Frame { size, factors }: Frame) -> u64 {
    let [across, down] = [0, 1].map(|axis| factors.iter().map(|factors| factors[axis]).max().unwrap_or(1));
    let (columns, rows) = (size[0].div_ceil(8 * across), size[1].div_ceil(8 * down));
    let component = |&[h, v]: &[u64; 2]| {
        let (row, ratio) = (8 * columns * h, (across * down).div_ceil(h * v));
        2 * (64 * columns * rows * h * v + row * (10 * v + v * ratio + 16 * ratio))
    };
    factors.iter().map(component).sum()
}

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["jpg", "jpeg"],
    depth: Depth::EightBit,
    supports_layers: false,
    has_alpha: false,
    max_side: 65535,
    has_signature: |bytes| bytes.starts_with(b"\xff\xd8\xff"),
    head: |bytes| {
        let head = codec::head(&codec::decoder(NAME, ImageFormat::Jpeg, bytes)?);
        let beside = frame(bytes).map_or(6 * head.width * head.height, decoding_bytes);
        Ok(ImageHeader { extra_bytes: bytes.len() as u64 + beside, ..head })
    },
    decode: |bytes| codec::raster(NAME, codec::decoder(NAME, ImageFormat::Jpeg, bytes)?),
    encode,
    rows: None,
};

fn encode(layers: &[Layer], options: &WriteOptions, out: &mut Vec<u8>) -> Result<(), ImageError> {
    layers.iter().try_for_each(|layer| {
        codec::encode_rgb(NAME, JpegEncoder::new_with_quality(&mut *out, QUALITY), layer, options)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_memory_of_the_decoder_follows_from_the_frame() {
        let head = |kind: u8, [w, h]: [u8; 2], factors: &[u8]| {
            let mut bytes = vec![0xff, 0xd8, 0xff, 0xe0, 0, 4, 0xff, 0xc0, 0xff, kind, 0, 8 + 3 * factors.len() as u8];
            bytes.extend([8, 0, h, w, 0, factors.len() as u8]);
            factors.iter().for_each(|factor| bytes.extend([1, *factor, 0]));
            frame(&bytes).map(decoding_bytes)
        };
        // For 4096 x 16 pixels, the decoder needs the coefficients of 1.5 components and some rows.
        let usual = head(0xc2, [16, 16], &[0x22, 0x11, 0x11]).unwrap();
        assert!((3 * 65536..3 * 65536 + 1_800_000).contains(&usual), "{usual}");
        // A picture with one row of pixels needs one row of blocks with 32 x 32 pixels.
        let flat = head(0xc2, [16, 1], &[0x44, 0x44, 0x44]).unwrap();
        assert!(flat > 3 * 2 * 4096 * 32, "{flat}");
        assert_eq!(head(0xc4, [16, 1], &[0x11]), None);
    }
}
