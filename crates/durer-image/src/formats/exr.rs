//! OpenEXR format: 32-bit floating-point values, compressed without loss, with any number of
//! layers. Files that are written row by row are not compressed and have a single layer.
//!
//! All layers are stored in one part. The first colour layer has the channels R, G, and B, which
//! every viewer displays. The channel names of other layers begin with the name of the layer, for
//! example `normals.R`. A layer with coverage also has a channel A, and its colours are
//! premultiplied, as the format requires.

use super::limits::{pixel_limit, try_vec};
use super::{
    Depth, Format, Image, ImageError, ImageHeader, Layer, LayerKind, Raster, RowFormat, RowLayout, WriteOptions,
};
use ::exr::meta::BlockDescription;
use ::exr::meta::attribute::{ChannelDescription, SampleType};
use ::exr::meta::header::Header;
use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, Image as ExrImage, LineOrder,
    MetaData, ReadChannels, ReadLayers, ReadSpecificChannel, SmallVec, Text, Vec2, WritableImage, read,
};
use durer_bvh::math::Vec3;
use std::cell::RefCell;
use std::collections::HashSet;
use std::io::Cursor;

const NAME: &str = "OpenEXR";
const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

pub const FORMAT: Format = Format {
    name: NAME,
    extensions: &["exr"],
    depth: Depth::Float,
    supports_layers: true,
    has_alpha: true,
    max_side: u32::MAX,
    has_signature: |bytes| bytes.starts_with(&MAGIC),
    head,
    decode,
    encode,
    rows: Some(&ROWS),
};

/// Format for writing row by row, which uses uncompressed blocks of one row so that all offsets are
/// known in advance.
static ROWS: RowFormat = RowFormat { bottom_up: false, head: head_of_rows, row, sixteen_bits: false, png: false };

/// Channels of a single layer, in the order in which each row stores them.
fn letters(alpha: bool) -> &'static [&'static str] {
    if alpha { &["A", "B", "G", "R"] } else { &["B", "G", "R"] }
}

/// Size in bytes of the values in one row.
fn row_bytes(strip: &RowLayout) -> u64 {
    4 * letters(strip.alpha).len() as u64 * u64::from(strip.width)
}

/// Creates the beginning of a file, which consists of the magic number, the version, the
/// attributes, and the offsets of the rows.
///
/// Source: *OpenEXR File Layout*, openexr.com.
fn head_of_rows(strip: &RowLayout) -> Result<Vec<u8>, ImageError> {
    // Each row begins with its number and its size.
    let row = 8 + row_bytes(strip);
    if row > i32::MAX as u64 {
        return Err(ImageError::unsupported(NAME, "rows of more than 2 GiB are not supported"));
    }
    let channels = letters(strip.alpha).iter().map(|letter| ChannelDescription::named(*letter, SampleType::F32));
    let size = (strip.width as usize, strip.height as usize);
    let mut header = Header::new(Text::default(), size, channels.collect());
    header.own_attributes.layer_name = None;
    let header = header.with_encoding(Compression::Uncompressed, BlockDescription::ScanLines, LineOrder::Increasing);
    let mut bytes = [MAGIC, [2, 0, 0, 0]].concat();
    header.write(&mut bytes).map_err(|error| ImageError::unsupported(NAME, error))?;
    sort_attributes(&mut bytes);
    let first = bytes.len() as u64 + 8 * u64::from(strip.height);
    bytes.extend((0..u64::from(strip.height)).flat_map(|y| (first + y * row).to_le_bytes()));
    Ok(bytes)
}

fn row(strip: &RowLayout, y: u32, pixels: &[Vec3], coverage: &[f32], out: &mut Vec<u8>) {
    out.extend(y.to_le_bytes());
    out.extend((row_bytes(strip) as u32).to_le_bytes());
    if strip.alpha {
        out.extend((0..pixels.len()).flat_map(|i| coverage.get(i).unwrap_or(&1.0).to_le_bytes()));
    }
    (0..3).rev().for_each(|axis| out.extend(pixels.iter().flat_map(|pixel| pixel[axis].to_le_bytes())));
}

/// Blocks of 16 rows that are compressed with Deflate, which is lossless and supported by all
/// readers.
const ENCODING: Encoding =
    Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };

fn encode(layers: &[Layer], options: &WriteOptions, out: &mut Vec<u8>) -> Result<(), ImageError> {
    let plain = layers.iter().position(|layer| layer.kind == LayerKind::Color).unwrap_or(0);
    let mut names = HashSet::new();
    let mut list = SmallVec::new();
    for (index, layer) in layers.iter().enumerate() {
        let channels = if layer.coverage.is_some() { &["R", "G", "B", "A"][..] } else { &["R", "G", "B"] };
        for (axis, letter) in channels.iter().enumerate() {
            let name = if index == plain { letter.to_string() } else { format!("{}.{letter}", layer.name) };
            let bad = || ImageError::unsupported(NAME, format!("`{}` cannot be the name of a layer", layer.name));
            let text = Text::new_or_none(&name).filter(|_| !name.starts_with('.')).ok_or_else(bad)?;
            if !names.insert(name) {
                return Err(ImageError::unsupported(NAME, format!("two layers are named `{}`", layer.name)));
            }
            let samples = match layer.coverage.as_ref().filter(|_| axis == 3) {
                Some(coverage) => coverage.clone(),
                None => layer.image.pixels.iter().map(|pixel| pixel[axis]).collect(),
            };
            list.push(AnyChannel::new(text, FlatSamples::F32(samples)));
        }
    }
    let size = layers.first().map(|layer| (layer.image.width as usize, layer.image.height as usize));
    let mut picture = ExrImage::from_encoded_channels(size.unwrap_or_default(), ENCODING, AnyChannels::sort(list));
    for (name, text) in options.attributes {
        // Texts are in Latin-1 in this format, and the attributes are in ASCII.
        let (name, text) = (Text::new_or_none(format!("durer:{name}")), Text::new_or_none(text));
        if let (Some(name), Some(text)) = (name, text) {
            picture.layer_data.attributes.other.insert(name, AttributeValue::Text(text));
        }
    }
    let mut file = Cursor::new(Vec::new());
    picture.write().to_buffered(&mut file).map_err(|error| ImageError::unsupported(NAME, error))?;
    sort_attributes(file.get_mut());
    out.append(file.get_mut());
    Ok(())
}

/// Sorts the attributes in the header of a file that has only one part by their names.
///
/// The encoder writes attributes in the order of a hash map, which varies, but equal pictures
/// should produce equal bytes. An attribute consists of its name and its type, both of which end
/// with a zero byte, followed by the length of its value and the value itself. The header ends with
/// a zero byte.
fn sort_attributes(file: &mut [u8]) {
    // Offset of the first byte after the magic number and the version.
    const START: usize = 8;
    let mut attributes = Vec::new();
    let mut at = START;
    let end_of_text = |from: usize| Some(from + 1 + file.get(from..)?.iter().position(|&byte| byte == 0)?);
    while file.get(at).is_some_and(|&byte| byte != 0) {
        let end = end_of_text(at).and_then(end_of_text).and_then(|length| {
            let value = file.get(length..length + 4)?.try_into().ok().map(u32::from_le_bytes)?;
            Some(length + 4 + value as usize)
        });
        let Some(attribute) = end.and_then(|end| file.get(at..end)) else { return };
        attributes.push(attribute.to_vec());
        at += attribute.len();
    }
    attributes.sort();
    file[START..at].copy_from_slice(&attributes.concat());
}

/// Selects the part to be read, and its channels for red, green, and blue. The first part that has
/// R, G, and B is used. If there is none, the first part with Y is used, and otherwise the first
/// part with a single channel; both are read as grey.
fn chosen(meta: &MetaData) -> Result<(&Header, [Text; 3]), ImageError> {
    let flat = || meta.headers.iter().filter(|header| !header.deep);
    let has = |header: &Header, name: &str| header.channels.list.iter().any(|channel| channel.name.eq(name));
    let colors = ["R", "G", "B"];
    if let Some(header) = flat().find(|header| colors.iter().all(|name| has(header, name))) {
        return Ok((header, colors.map(Text::from)));
    }
    let grey = |name: Text| [name.clone(), name.clone(), name];
    if let Some(header) = flat().find(|header| has(header, "Y")) {
        return Ok((header, grey(Text::from("Y"))));
    }
    let single = flat().find_map(|header| match &header.channels.list[..] {
        [channel] => Some((header, grey(channel.name.clone()))),
        _ => None,
    });
    single.ok_or_else(|| ImageError::unsupported(NAME, "the file has neither channels R, G and B nor a channel Y"))
}

/// Returns the size of the display window and the offset of the stored pixels within it. The stored
/// pixels may cover only a part of the window or extend beyond it.
fn window(header: &Header) -> (Vec2<usize>, Vec2<i64>) {
    let shown = header.shared_attributes.display_window;
    let from = header.own_attributes.layer_position;
    let offset = |a: i32, b: i32| i64::from(a) - i64::from(b);
    (shown.size, Vec2(offset(from.0, shown.position.0), offset(from.1, shown.position.1)))
}

fn head(bytes: &[u8]) -> Result<ImageHeader, ImageError> {
    let meta = MetaData::read_from_buffered(bytes, false).map_err(malformed)?;
    let (header, _) = chosen(&meta)?;
    if header.channels.list.iter().any(|channel| channel.sampling != Vec2(1, 1)) {
        return Err(ImageError::unsupported(NAME, "channels with reduced resolution are not supported"));
    }
    let Vec2(width, height) = header.layer_size;
    // A block is decoded with all of its channels, even unused ones, and exists in three forms:
    // compressed, uncompressed, and sorted by rows.
    let Vec2(across, down) = header.max_block_pixel_size();
    let block = (across.min(width) as u64).saturating_mul(down.min(height) as u64);
    if block.saturating_mul(header.channels.bytes_per_pixel as u64) > pixel_limit(bytes.len()).saturating_mul(16) {
        return Err(ImageError::TooLarge { width: width as u64, height: height as u64, bytes: bytes.len() });
    }
    let (Vec2(width, height), _) = window(header);
    Ok(ImageHeader {
        width: width as u64,
        height: height as u64,
        is_eight_bit: false,
        bytes_per_pixel: size_of::<Vec3>() as u64,
        extra_bytes: block.saturating_mul(3 * header.channels.bytes_per_pixel as u64),
    })
}

fn decode(bytes: &[u8]) -> Result<Raster, ImageError> {
    let meta = MetaData::read_from_buffered(bytes, false).map_err(malformed)?;
    let (header, [red, green, blue]) = chosen(&meta)?;
    let (Vec2(width, height), offset) = window(header);
    // Allocate all memory in advance, so that a lack of memory results in an error.
    let room = RefCell::new(try_vec(width * height, Vec3::ZERO)?);
    let is_grey = red == green;
    let channels = read().no_deep_data().largest_resolution_level().specific_channels();
    let picture = if is_grey {
        let place =
            move |pixels: &mut Vec<Vec3>, at, (grey,): (f32,)| put(pixels, width, (at, offset), Vec3::splat(grey));
        let channels = channels.required(red).collect_pixels(|_, _| room.take(), place);
        let reader = channels.first_valid_layer().all_attributes().non_parallel();
        reader.from_buffered(Cursor::new(bytes)).map_err(malformed)?.layer_data.channel_data.pixels
    } else {
        let place = move |pixels: &mut Vec<Vec3>, at, (r, g, b): (f32, f32, f32)| {
            put(pixels, width, (at, offset), Vec3::new(r, g, b))
        };
        let channels = channels.required(red).required(green).required(blue);
        let reader = channels.collect_pixels(|_, _| room.take(), place).first_valid_layer().all_attributes();
        reader.non_parallel().from_buffered(Cursor::new(bytes)).map_err(malformed)?.layer_data.channel_data.pixels
    };
    Ok(Raster::Float(Image { width: width as u32, height: height as u32, pixels: picture }, Vec::new()))
}

fn put(pixels: &mut [Vec3], width: usize, (Vec2(x, y), offset): (Vec2<usize>, Vec2<i64>), color: Vec3) {
    let [x, y] = [x as i64 + offset.0, y as i64 + offset.1];
    if !(0..width as i64).contains(&x) || y < 0 {
        return;
    }
    if let Some(pixel) = pixels.get_mut(y as usize * width + x as usize) {
        *pixel = color;
    }
}

fn malformed(error: ::exr::error::Error) -> ImageError {
    ImageError::malformed(NAME, error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::exr::prelude::read_all_flat_layers_from_file;

    fn layer(name: &str, kind: LayerKind, value: f32) -> Layer {
        let pixels = (0..6).map(|i| Vec3::new(value, i as f32, -value)).collect();
        Layer { name: name.into(), image: Image { width: 3, height: 2, pixels }.into(), kind, coverage: None }
    }

    #[test]
    fn several_layers_are_read_by_others() {
        let layers = [
            layer("normals", LayerKind::Data, 1.0),
            layer("beauty", LayerKind::Color, 2.0),
            layer("a name that is longer than thirty-one bytes", LayerKind::Data, 3.0),
        ];
        let mut out = Vec::new();
        FORMAT.write(&layers, &WriteOptions::default(), &mut out).unwrap();
        assert_eq!(crate::read(&out, "").unwrap(), *layers[1].image);

        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), &out).unwrap();
        let back = read_all_flat_layers_from_file(file.path()).unwrap();
        let channels = &back.layer_data[0].channel_data.list;
        assert_eq!(channels.len(), 9);
        let normals = channels.iter().find(|channel| channel.name.eq("normals.G")).unwrap();
        assert_eq!(normals.sample_data, FlatSamples::F32((0..6).map(|i| i as f32).collect()));
    }

    #[test]
    fn a_crop_lies_where_its_windows_say() {
        use ::exr::prelude::{IntegerBounds, Layer as ExrLayer, LayerAttributes, SpecificChannels};
        // The pixels (3, 2) and (4, 2) are stored; the display window starts at (1, 1) and has 5 x
        // 4 or only 2 x 2 pixels.
        let read = |shown: (usize, usize)| {
            let channels = SpecificChannels::rgb(|at: Vec2<usize>| (at.0 as f32 + 1.0, 0.0_f32, 0.5_f32));
            let attributes = LayerAttributes { layer_position: Vec2(3, 2), ..LayerAttributes::named("a") };
            let encoding = Encoding { compression: Compression::Uncompressed, ..ENCODING };
            let mut picture = ExrImage::from_layer(ExrLayer::new((2, 1), attributes, encoding, channels));
            picture.attributes.display_window = IntegerBounds::new((1, 1), shown);
            let mut file = Cursor::new(Vec::new());
            picture.write().to_buffered(&mut file).unwrap();
            crate::read(file.get_ref(), "").unwrap()
        };
        let whole = read((5, 4));
        assert_eq!((whole.width, whole.height), (5, 4));
        let lit: Vec<(usize, f32)> =
            whole.pixels.iter().enumerate().filter(|(_, p)| p.z > 0.0).map(|(i, p)| (i, p.x)).collect();
        assert_eq!(lit, [(5 + 2, 1.0), (5 + 3, 2.0)]);
        // Pixels outside the display window are discarded.
        assert!(read((2, 2)).pixels.iter().all(|pixel| *pixel == Vec3::ZERO));
    }

    #[test]
    fn rows_are_read_by_others() {
        for alpha in [false, true] {
            let strip = RowLayout { width: 3, height: 2, alpha, display: Default::default() };
            let rows = [[Vec3::X, Vec3::new(f32::MAX, -2.0, 1e-30), Vec3::ZERO], [Vec3::Y, Vec3::Z, Vec3::ONE]];
            let shares = if alpha { &[0.25, 0.5, 1.0][..] } else { &[] };
            let mut bytes = Vec::new();
            let written = FORMAT.write_rows(strip, &mut bytes, |out| {
                rows.iter().try_for_each(|row| out.rows(row, shares)).map_err(Box::<dyn std::error::Error>::from)
            });
            written.unwrap();
            let file = tempfile::NamedTempFile::new().unwrap();
            std::fs::write(file.path(), &bytes).unwrap();
            let back = read_all_flat_layers_from_file(file.path()).unwrap();
            let channels = &back.layer_data[0].channel_data.list;
            let values = |name: &str| channels.iter().find(|c| c.name.eq(name)).map(|c| c.sample_data.clone());
            for (axis, name) in ["R", "G", "B"].into_iter().enumerate() {
                let expected = rows.iter().flatten().map(|pixel| pixel[axis]).collect();
                assert_eq!(values(name), Some(FlatSamples::F32(expected)), "{name}");
            }
            let expected = alpha.then(|| FlatSamples::F32([shares, shares].concat()));
            assert_eq!(values("A"), expected);
        }
        let strip = RowLayout { width: 1 << 30, height: 1, alpha: false, display: Default::default() };
        assert!(head_of_rows(&strip).is_err());
    }

    #[test]
    fn attributes_are_read_by_others_and_the_bytes_are_always_the_same() {
        let attributes = ["job", "scene", "statistics", "software"].map(|name| (name, format!("{{\"{name}\":1}}")));
        let options = WriteOptions { attributes: &attributes, ..WriteOptions::default() };
        let write = || {
            let mut out = Vec::new();
            FORMAT.write(&[layer("x", LayerKind::Color, 2.0)], &options, &mut out).unwrap();
            out
        };
        let out = write();
        assert!((0..20).all(|_| write() == out));
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), &out).unwrap();
        let back = read_all_flat_layers_from_file(file.path()).unwrap();
        for (name, text) in &attributes {
            let name = Text::from(format!("durer:{name}").as_str());
            assert_eq!(back.layer_data[0].attributes.other[&name], AttributeValue::Text(Text::from(text.as_str())));
        }
    }

    #[test]
    fn partial_coverage_adds_alpha() {
        let shares: Vec<f32> = (0..6).map(|i| i as f32 / 5.0).collect();
        let seen = layer("depth", LayerKind::Data, 1.0).with_coverage(shares.clone());
        let mut out = Vec::new();
        FORMAT.write(&[layer("", LayerKind::Color, 2.0), seen], &WriteOptions::default(), &mut out).unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), &out).unwrap();
        let back = read_all_flat_layers_from_file(file.path()).unwrap();
        let channels = &back.layer_data[0].channel_data.list;
        assert_eq!(channels.len(), 7);
        let alpha = channels.iter().find(|channel| channel.name.eq("depth.A")).unwrap();
        assert_eq!(alpha.sample_data, FlatSamples::F32(shares));
    }

    #[test]
    fn names_must_differ() {
        let write = |a, b| {
            let layers =
                [layer("", LayerKind::Color, 0.0), layer(a, LayerKind::Data, 0.0), layer(b, LayerKind::Data, 0.0)];
            FORMAT.write(&layers, &WriteOptions::default(), &mut Vec::new())
        };
        assert!(write("a", "b").is_ok());
        assert!(write("a", "a").is_err());
        assert!(write("a", "").is_err());
        assert!(write("a", "日本").is_err());
    }
}
