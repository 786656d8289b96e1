//! Reads and converts the pictures that materials use, for readers of scenes.

use super::model::ReadInput;
use super::shared_report::SharedReport;
use durer_diag::{Diagnostic, Span};
use durer_image::{self as image, Depth, Encoded, Image, ImageError, Layer, Transfer, WriteOptions};
use durer_scene::describe::FileName;
use durer_scene::math::Color;
use durer_scene::scene::{PictureBytes, Scene, TextureImage};
use durer_scene::source::Digest;
use std::sync::Arc;

/// Number of bytes of memory needed per pixel to convert a picture, not counting the picture
/// itself: for the new picture and its 8-bit data, both raw and encoded.
pub(super) const CONVERSION_BYTES_PER_PIXEL: usize = 2 * size_of::<Color>();

/// Largest number of texels of a picture that is derived in single precision.
const MOST_REFINED: u64 = 1 << 22;

/// Reader for the pictures that a scene names, which also converts pictures and reports errors.
#[derive(Clone, Copy)]
pub(super) struct Pictures<'a> {
    pub input: &'a ReadInput<'a>,
    pub report: &'a SharedReport,
}

impl Pictures<'_> {
    /// Reads the bytes of a file.
    pub fn bytes(&self, name: &str, at: Span) -> Option<Arc<[u8]>> {
        let bytes = self.input.source.read(name);
        bytes.map_err(|error| self.report.push(Diagnostic::error(error.to_string()).code("missing-file").at(at))).ok()
    }

    /// Reads a file as a picture and decodes 8-bit values as sRGB.
    pub fn image(&self, name: &str, at: Span) -> Option<Image> {
        self.decoded(name, at, image::decode_srgb)
    }

    /// Decodes a picture in memory, and decodes 8-bit values as sRGB.
    pub fn of_bytes(&self, name: &str, bytes: &[u8], at: Span) -> Option<Image> {
        self.read(name, bytes, image::decode_srgb).map_err(|error| self.report_error(name, at, &error)).ok()
    }

    /// Reads a file as a picture. `decode` is the transfer function of the 8-bit values.
    pub fn decoded(&self, name: &str, at: Span, decode: fn(u8) -> f32) -> Option<Image> {
        let bytes = self.bytes(name, at)?;
        self.read(name, &bytes, decode).map_err(|error| self.report_error(name, at, &error)).ok()
    }

    /// Decodes a picture, and reserves memory for converting it.
    fn read(&self, name: &str, bytes: &[u8], decode: fn(u8) -> f32) -> Result<Image, ImageError> {
        Encoded::open(bytes, name)?.read_for(CONVERSION_BYTES_PER_PIXEL, self.input.memory, decode)
    }

    /// Returns a file as an 8-bit picture; pictures in floating-point formats are converted to PNG.
    pub fn eight_bits(&self, name: &str, at: Span) -> Option<PictureBytes> {
        let bytes = self.bytes(name, at)?;
        match Encoded::open(&bytes, name) {
            Ok(encoded) if encoded.depth() != Depth::Float => Some(PictureBytes::File(name.to_string())),
            Ok(_) => {
                let eight = as_png(self.image(name, at)?, Transfer::Srgb)?;
                Some(PictureBytes::Memory(format!("{name}#8.png"), eight))
            }
            Err(error) => {
                self.report_error(name, at, &error);
                None
            }
        }
    }

    /// Returns a file with its own depth, together with a factor for its values. A floating-point
    /// picture is divided by its maximum if that is above 1 and `scaled` is true, and otherwise
    /// limited to 1. The factor is what it was divided by.
    pub fn own_depth(&self, name: &str, scaled: bool, at: Span) -> Option<(PictureBytes, f32)> {
        let bytes = self.bytes(name, at)?;
        if !Encoded::open(&bytes, name).is_ok_and(|encoded| encoded.depth() == Depth::Float) {
            return Some((self.eight_bits(name, at)?, 1.0));
        }
        let mut image = self.image(name, at)?;
        let most = image.pixels.iter().fold(1.0, |most: f32, p| most.max(p.max_element()));
        let factor = if scaled && most.is_finite() { most } else { 1.0 };
        image.pixels.iter_mut().for_each(|p| *p = (*p / factor).clamp(Color::ZERO, Color::ONE));
        Some((PictureBytes::Memory(format!("{name}#of-{factor}.pfm"), as_pfm(image)?), factor))
    }

    /// Converts a picture with another transfer function to sRGB if `is_color` is true, and to
    /// linear values otherwise. `decode` converts an 8-bit value, scaled to the range from 0 to 1,
    /// to a linear value.
    pub fn reencoded(
        &self,
        picture: &TextureImage,
        at: Span,
        is_color: bool,
        decode: impl Fn(f32) -> f32,
    ) -> Option<TextureImage> {
        // Pictures in memory have already been converted to a standard transfer function.
        let PictureBytes::File(path) = &picture.bytes else { return None };
        let mut image = self.decoded(path, at, image::decode_linear)?;
        image.pixels.iter_mut().for_each(|pixel| *pixel = pixel.map(&decode).clamp(Color::ZERO, Color::ONE));
        // Pictures with data other than colours stay linear.
        derived(picture, image, if is_color { Transfer::Srgb } else { Transfer::Linear })
    }

    /// Returns the mean of all values in a picture.
    pub fn mean(&self, picture: &TextureImage, at: Span) -> Option<f32> {
        match &picture.bytes {
            PictureBytes::File(path) => self.image(path, at).map(|image| mean(&image)),
            PictureBytes::Memory(path, bytes) => {
                self.read(path, bytes, image::decode_linear).ok().map(|image| mean(&image))
            }
        }
    }

    /// Creates a linear picture of numbers by applying `change` to each texel of another picture.
    /// `decode` is the transfer function of that picture.
    pub fn changed(
        &self,
        picture: &TextureImage,
        at: Span,
        decode: fn(u8) -> f32,
        change: impl Fn(Color) -> f32,
    ) -> Option<TextureImage> {
        self.linear(picture, at, decode, |texel| Color::splat(change(texel)))
    }

    /// Version of [`Pictures::linear`] that first interpolates `finer` texels along each side of a
    /// texel, as far as the picture stays below [`MOST_REFINED`] texels.
    pub fn refined(
        &self,
        picture: &TextureImage,
        at: Span,
        decode: fn(u8) -> f32,
        finer: u32,
        change: impl Fn(Color) -> Color,
    ) -> Option<TextureImage> {
        let image = self.source(picture, at, decode)?;
        let texels = u64::from(image.width) * u64::from(image.height);
        let finer = (1..=finer).rev().find(|n| texels * u64::from(n * n) <= MOST_REFINED).unwrap_or(1);
        if finer == 1 || picture.mapping.nearest {
            return self.linear(picture, at, decode, change);
        }
        let (width, height) = (image.width * finer, image.height * finer);
        let mut pixels = Vec::with_capacity((width * height) as usize);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let place = |x: u32| {
                let x = (x as f32 + 0.5) / finer as f32 - 0.5;
                (x.floor() as i64, x - x.floor())
            };
            let ((i, a), (j, b)) = (place(x), place(y));
            let [across, down] = picture.mapping.wrap;
            let texel = |i: i64, j: i64| {
                let (x, y) = (across.index(i, image.width), down.index(j, image.height));
                image.get(x, y).unwrap_or_default()
            };
            let row = |j: i64| texel(i, j).lerp(texel(i + 1, j), a);
            pixels.push(change(row(j).lerp(row(j + 1), b)).clamp(Color::ZERO, Color::ONE));
        }
        derived(picture, Image::from_pixels(width, height, pixels).ok()?, Transfer::Linear)
    }

    /// Decodes a picture.
    fn source(&self, picture: &TextureImage, at: Span, decode: fn(u8) -> f32) -> Option<Image> {
        match &picture.bytes {
            PictureBytes::File(path) => self.decoded(path, at, decode),
            PictureBytes::Memory(path, bytes) => self.read(path, bytes, decode).ok(),
        }
    }

    /// Creates a linear picture by applying `change` to each texel of another picture. `decode` is
    /// the transfer function of that picture.
    pub fn linear(
        &self,
        picture: &TextureImage,
        at: Span,
        decode: fn(u8) -> f32,
        change: impl Fn(Color) -> Color,
    ) -> Option<TextureImage> {
        let image = self.source(picture, at, decode)?;
        let texel = |p: &Color| change(*p).clamp(Color::ZERO, Color::ONE);
        let image = Image::from_pixels(image.width, image.height, image.pixels.iter().map(texel).collect()).ok()?;
        derived(picture, image, Transfer::Linear)
    }

    /// Combines two pictures that have the same mapping, texel by texel. Both can be the same
    /// picture.
    /// Returns the colour picture and the factor for its values, or `None` if the mappings differ.
    pub fn joined(
        &self,
        [one, other]: [&TextureImage; 2],
        at: Span,
        join: impl Fn(Color, Color) -> Color,
    ) -> Option<(TextureImage, f32)> {
        if one.mapping != other.mapping {
            return None;
        }
        let (a, b) = (self.source(one, at, image::decode_srgb)?, self.source(other, at, image::decode_srgb)?);
        let (width, height) = (a.width.max(b.width), a.height.max(b.height));
        // Use the nearest texel of the smaller picture.
        let place = |i: u32, of: u32, count: u32| (u64::from(i) * u64::from(count) / u64::from(of)) as u32;
        let from = |picture: &Image, x: u32, y: u32| {
            picture.get(place(x, width, picture.width), place(y, height, picture.height)).unwrap_or_default()
        };
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            pixels.push(join(from(&a, x, y), from(&b, x, y)).max(Color::ZERO));
        }
        let most = pixels.iter().fold(1.0, |most: f32, p| most.max(p.max_element()));
        let most = if most.is_finite() { most } else { 1.0 };
        pixels.iter_mut().for_each(|p| *p /= most);
        Some((derived(one, Image::from_pixels(width, height, pixels).ok()?, Transfer::Srgb)?, most))
    }

    fn report_error(&self, name: &str, at: Span, error: &ImageError) {
        self.report.push(picture_error(name, error).at(at));
    }
}

/// Returns the error for a picture that cannot be decoded.
pub(super) fn picture_error(name: &str, error: &ImageError) -> Diagnostic {
    let diagnostic = Diagnostic::error(format!("the picture `{name}` cannot be used: {error}")).code("bad-file");
    match error {
        ImageError::MemoryLimit { .. } => diagnostic.help("see `--memory`"),
        _ => diagnostic,
    }
}

/// Adds a picture to the assets of the scene and returns its asset name.
pub(super) fn asset(scene: &mut Scene, picture: TextureImage, span: Span) -> FileName {
    // Include the mapping in the name, because the same file can be used with several mappings.
    let mapping = Digest::of(format!("{:?}", picture.mapping).as_bytes()).to_string();
    let path = format!("{}#{}", picture.bytes.path(), &mapping[..12]);
    scene.assets.pictures.entry(path.clone()).or_insert(picture);
    FileName { path, span }
}

/// Returns a picture with four texels: `one` at the upper left and lower right, and `other` at the
/// remaining two. Also returns the factor for its values.
pub(super) fn checkerboard(one: Color, other: Color) -> Option<(PictureBytes, f32)> {
    let (bytes, most) = from_four_texels([one, other, other, one])?;
    let PictureBytes::Memory(_, bytes) = bytes else { return None };
    Some((PictureBytes::Memory(format!("checkerboard-{other}-{one}.pfm"), bytes), most))
}

/// Returns a picture with four texels, given in rows from the top, and the factor for its values.
pub(super) fn from_four_texels(colors: [Color; 4]) -> Option<(PictureBytes, f32)> {
    let most = colors.iter().fold(1.0, |most: f32, color| most.max(color.max_element()));
    let pixels = colors.map(|color| color / most);
    // Eight bits would round the colours.
    let bytes = as_pfm(Image::from_pixels(2, 2, pixels.to_vec()).ok()?)?;
    let name = format!("corners-{}.pfm", &Digest::of(format!("{colors:?}").as_bytes()).to_string()[..12]);
    Some((PictureBytes::Memory(name, bytes), most))
}

/// Returns a picture that was derived from another one, with the same mapping. Eight bits would
/// round the values, so only large pictures are stored with eight bits and the given transfer
/// function, unless the other picture has single precision.
fn derived(from: &TextureImage, image: Image, transfer: Transfer) -> Option<TextureImage> {
    let is_float = matches!(&from.bytes, PictureBytes::Memory(path, _) if path.ends_with(".pfm"));
    let (bytes, kind) = match is_float || image.pixels.len() as u64 <= MOST_REFINED {
        true => (as_pfm(image)?, "pfm"),
        false => (as_png(image, transfer)?, "png"),
    };
    let path = format!("{}#{}.{kind}", from.bytes.path(), &Digest::of(&bytes).to_string()[..12]);
    Some(TextureImage { bytes: PictureBytes::Memory(path, bytes), mapping: from.mapping })
}

/// Encodes a picture as an 8-bit PNG.
pub(super) fn as_png(image: Image, transfer: Transfer) -> Option<Arc<[u8]>> {
    encoded("a.png", image, transfer)
}

/// Encodes a picture as a PFM picture, which keeps single precision.
fn as_pfm(image: Image) -> Option<Arc<[u8]>> {
    encoded("a.pfm", image, Transfer::Linear)
}

/// Encodes a picture in the format that the extension of `name` selects.
fn encoded(name: &str, image: Image, transfer: Transfer) -> Option<Arc<[u8]>> {
    let mut bytes = Vec::new();
    let options = WriteOptions { display: transfer.into(), ..WriteOptions::default() };
    image::format_for(name).ok()?.write(&[Layer::color("", image)], &options, &mut bytes).ok()?;
    Some(bytes.into())
}

fn mean(image: &Image) -> f32 {
    let sum: f64 = image.pixels.iter().map(|p| f64::from((p.x + p.y + p.z) / 3.0)).sum();
    (sum / image.pixels.len().max(1) as f64) as f32
}
