//! Photographs read from files, with their pixels and EXIF metadata.

use crate::Error;
use crate::feature::GrayImage;
use crate::jpeg::is_complete;
use image::{DynamicImage, ImageDecoder as _, ImageError, ImageFormat, ImageReader, Limits, RgbImage};
use std::io::Cursor;

/// Maximum length in pixels of the longer side of a photograph. Larger photographs are not read.
const MAX_SIDE: u32 = 20_000;

/// Photograph read from a JPEG or PNG file, with its pixels and EXIF metadata.
pub struct Photo {
    /// File name.
    pub name: String,
    /// Pixels as stored in the file, regardless of the orientation in the metadata.
    pub pixels: RgbImage,
    /// EXIF metadata.
    pub exif: Exif,
}

/// EXIF metadata of a photograph that concern the camera and the focal length.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Exif {
    /// Make and model of the camera.
    pub camera: String,
    /// Focal length in pixels, together with a description of its source.
    pub focal: Option<(f64, String)>,
    /// Message about the focal length if it is implausible.
    pub warning: Option<String>,
}

fn reader<'b>(file: &str, bytes: &'b [u8]) -> Result<ImageReader<Cursor<&'b [u8]>>, Error> {
    let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
    let mut reader = reader.map_err(|error| Error::in_file(file, error.to_string()))?;
    if reader.format().is_none() {
        return Err(Error::in_file(file, "the file is neither a JPEG nor a PNG"));
    }
    let mut limits = Limits::default();
    limits.max_alloc = Some(2 << 30);
    (limits.max_image_width, limits.max_image_height) = (Some(MAX_SIDE), Some(MAX_SIDE));
    reader.limits(limits);
    Ok(reader)
}

fn unreadable(file: &str, error: &ImageError) -> Error {
    Error::in_file(file, format!("cannot be read as a picture: {}", error.to_string().trim_end()))
}

/// Reads the width and height in pixels from the header of a photograph.
pub fn size(file: &str, bytes: &[u8]) -> Result<[u32; 2], Error> {
    let size = reader(file, bytes)?.into_dimensions();
    let (width, height) = size.map_err(|error| unreadable(file, &error))?;
    Ok([width, height])
}

/// Decodes a photograph, provided that this needs at most `memory` bytes.
pub fn read(name: &str, bytes: &[u8], memory: u64) -> Result<Photo, Error> {
    let reader = reader(name, bytes)?;
    if reader.format() == Some(ImageFormat::Jpeg) && !is_complete(bytes) {
        return Err(Error::in_file(name, "cannot be read as a picture: the JPEG is truncated"));
    }
    let decoder = reader.into_decoder().map_err(|error| unreadable(name, &error))?;
    // The decoded picture is converted to three bytes per pixel.
    let (width, height) = decoder.dimensions();
    let needed = decoder.total_bytes().saturating_add(3 * u64::from(width) * u64::from(height));
    if needed > memory {
        let message = format!("a picture of {width} x {height} needs {needed} bytes of memory, more than the limit");
        return Err(Error::in_file(name, message));
    }
    let decoded = DynamicImage::from_decoder(decoder).map_err(|error| unreadable(name, &error))?;
    let pixels = decoded.into_rgb8();
    if pixels.width().min(pixels.height()) < 16 {
        return Err(Error::in_file(name, "the picture is too small: both sides need at least 16 pixels"));
    }
    let exif = exif(bytes, [pixels.width(), pixels.height()]);
    Ok(Photo { name: name.to_string(), pixels, exif })
}

impl Photo {
    /// Returns the width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.pixels.width(), self.pixels.height()]
    }

    /// Returns a greyscale image with values from 0 to 1, whose longer side is reduced to at most
    /// `side` pixels. Also returns the number of original pixels per reduced pixel along x and y.
    pub fn gray(&self, side: u32) -> (GrayImage, [f64; 2]) {
        let [width, height] = self.size();
        let scale = f64::from(side) / f64::from(width.max(height));
        let smaller;
        let pixels = if scale < 1.0 {
            let to = |side: u32| ((f64::from(side) * scale).round() as u32).max(16);
            smaller =
                image::imageops::resize(&self.pixels, to(width), to(height), image::imageops::FilterType::Triangle);
            &smaller
        } else {
            &self.pixels
        };
        let luma = |p: &image::Rgb<u8>| {
            (0.299 * f32::from(p.0[0]) + 0.587 * f32::from(p.0[1]) + 0.114 * f32::from(p.0[2])) / 255.0
        };
        let (w, h) = pixels.dimensions();
        let gray = GrayImage { width: w as usize, height: h as usize, values: pixels.pixels().map(luma).collect() };
        (gray, [f64::from(width) / f64::from(w), f64::from(height) / f64::from(h)])
    }

    /// Returns the colour at a position in pixels.
    pub fn color(&self, x: f64, y: f64) -> [u8; 3] {
        let [width, height] = self.size();
        self.pixels.get_pixel((x.max(0.0) as u32).min(width - 1), (y.max(0.0) as u32).min(height - 1)).0
    }
}

/// Reads the EXIF metadata. Invalid metadata is common, and is treated as missing.
fn exif(bytes: &[u8], size: [u32; 2]) -> Exif {
    use exif::Tag;
    let mut metadata = Exif::default();
    let Ok(exif) = exif::Reader::new().read_from_container(&mut Cursor::new(bytes)) else { return metadata };
    let field = |tag: Tag| exif.get_field(tag, exif::In::PRIMARY);
    let text = |tag: Tag| match field(tag).map(|field| &field.value) {
        Some(exif::Value::Ascii(parts)) => {
            String::from_utf8_lossy(parts.first().map_or(&[][..], |part| part)).trim_matches(['\0', ' ']).to_string()
        }
        _ => String::new(),
    };
    metadata.camera = format!("{} {}", text(Tag::Make), text(Tag::Model)).trim().to_string();
    let number = |tag: Tag| -> Option<f64> {
        let value = match &field(tag)?.value {
            exif::Value::Rational(values) => values.first()?.to_f64(),
            value => f64::from(value.get_uint(0)?),
        };
        Some(value).filter(|value| value.is_finite() && *value > 0.0)
    };
    let [width, height] = size.map(f64::from);
    let diagonal = |a: f64, b: f64| (a * a + b * b).sqrt();
    let longer = width.max(height);
    let from_film = || {
        // The 35 mm equivalent refers to the diagonal of a frame of 36 x 24 mm (CIPA DC-X005).
        let film = number(Tag::FocalLengthIn35mmFilm)?;
        let focal = film * diagonal(width, height) / diagonal(36.0, 24.0);
        Some((focal, format!("{film} mm on 35 mm film")))
    };
    let from_sensor = || {
        let unit = match field(Tag::FocalPlaneResolutionUnit).and_then(|field| field.value.get_uint(0)) {
            Some(3) => 10.0,
            Some(4) => 1.0,
            _ => 25.4,
        };
        let (length, per_unit) = (number(Tag::FocalLength)?, number(Tag::FocalPlaneXResolution)?);
        let taken = number(Tag::PixelXDimension).unwrap_or(width).max(number(Tag::PixelYDimension).unwrap_or(height));
        Some((length * per_unit / unit * longer / taken, format!("{length} mm and the sensor's resolution")))
    };
    let plausible = |(focal, _): &(f64, String)| (0.25..=20.0).contains(&(focal / longer));
    let all: Vec<_> = [from_sensor(), from_film()].into_iter().flatten().collect();
    metadata.focal = all.iter().find(|focal| plausible(focal)).cloned();
    if let (None, Some((focal, how))) = (&metadata.focal, all.first()) {
        metadata.warning = Some(format!("EXIF's focal length, {focal:.0} pixels from {how}, is implausible"));
    }
    metadata
}

impl Photo {
    /// Encodes the photograph as a JPEG whose longer side has at most `side` pixels.
    pub fn to_jpeg(&self, side: u32) -> Result<Vec<u8>, Error> {
        let longer = self.pixels.width().max(self.pixels.height());
        let to = |pixels: u32| (pixels * side).div_ceil(longer).max(1);
        let filter = image::imageops::FilterType::Triangle;
        let smaller = (longer > side)
            .then(|| image::imageops::resize(&self.pixels, to(self.pixels.width()), to(self.pixels.height()), filter));
        let mut bytes = Vec::new();
        let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 80);
        let pixels = smaller.as_ref().unwrap_or(&self.pixels);
        pixels.write_with_encoder(encoder).map_err(|error| Error::in_file(&self.name, error.to_string()))?;
        Ok(bytes)
    }
}
