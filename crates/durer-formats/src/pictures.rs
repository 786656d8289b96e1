//! Pictures that materials name, for readers of whole scenes.

use super::model::Input;
use super::said::Said;
use durer_diag::{Diagnostic, Span};
use durer_image::{self as image, Depth, Encoded, Image, ImageError, Layer, Transfer, WriteOptions};
use durer_scene::describe::FileName;
use durer_scene::math::Color;
use durer_scene::scene::{Picture, PictureBytes, Scene};
use durer_scene::source::Digest;
use std::sync::Arc;

/// Bytes a pixel that are there beside a picture while it becomes another one: that, and its eight
/// bits in two ways.
pub(super) const CHANGING: usize = 2 * size_of::<Color>();

/// Finds pictures beside a scene, and tells what is wrong with them.
#[derive(Clone, Copy)]
pub(super) struct Pictures<'a> {
    pub input: &'a Input<'a>,
    pub said: &'a Said,
}

impl Pictures<'_> {
    /// The bytes of a file.
    pub fn bytes(&self, name: &str, at: Span) -> Option<Arc<[u8]>> {
        let bytes = self.input.source.read(name);
        bytes.map_err(|error| self.said.push(Diagnostic::error(error.to_string()).code("missing-file").at(at))).ok()
    }

    /// A file as a picture.
    pub fn image(&self, name: &str, at: Span) -> Option<Image> {
        self.decoded(name, at, image::decode_srgb)
    }

    /// The same with the curve that its bytes have.
    pub fn decoded(&self, name: &str, at: Span, decode: fn(u8) -> f32) -> Option<Image> {
        let bytes = self.bytes(name, at)?;
        self.read(name, &bytes, decode).map_err(|error| self.complain(name, at, &error)).ok()
    }

    /// Decodes a picture that may become another one.
    fn read(&self, name: &str, bytes: &[u8], decode: fn(u8) -> f32) -> Result<Image, ImageError> {
        Encoded::open(bytes, name)?.read_for(CHANGING, self.input.memory, decode)
    }

    /// A file as a picture of eight bits, which other formats become.
    pub fn eight_bits(&self, name: &str, at: Span) -> Option<PictureBytes> {
        let bytes = self.bytes(name, at)?;
        match Encoded::open(&bytes, name) {
            Ok(encoded) if encoded.depth() != Depth::Float => Some(PictureBytes::File(name.to_string())),
            Ok(_) => {
                let eight = as_png(self.image(name, at)?, Transfer::Srgb)?;
                Some(PictureBytes::Here(format!("{name}#8.png"), eight))
            }
            Err(error) => {
                self.complain(name, at, &error);
                None
            }
        }
    }

    /// The same, divided by the greatest number in it where that is more than 1, and that.
    pub fn eight_bits_scaled(&self, name: &str, at: Span) -> Option<(PictureBytes, f32)> {
        let bytes = self.bytes(name, at)?;
        if Encoded::open(&bytes, name).is_ok_and(|encoded| encoded.depth() == Depth::Float) {
            let mut image = self.image(name, at)?;
            let most = image.pixels.iter().fold(1.0, |most: f32, p| most.max(p.max_element()));
            if most > 1.0 && most.is_finite() {
                image.pixels.iter_mut().for_each(|p| *p /= most);
                let eight = as_png(image, Transfer::Srgb)?;
                return Some((PictureBytes::Here(format!("{name}#of-{most}.png"), eight), most));
            }
        }
        Some((self.eight_bits(name, at)?, 1.0))
    }

    /// A picture of colours or of numbers, made of one whose bytes have another curve: `decode` makes
    /// what is meant of a byte's share of 255.
    pub fn recoded(&self, picture: &Picture, at: Span, is_color: bool, decode: impl Fn(f32) -> f32) -> Option<Picture> {
        // What was of another format has a curve already.
        let PictureBytes::File(path) = &picture.bytes else { return None };
        let mut image = self.decoded(path, at, image::decode_linear)?;
        image.pixels.iter_mut().for_each(|pixel| *pixel = pixel.map(&decode).clamp(Color::ZERO, Color::ONE));
        // Numbers have no curve.
        let bytes = as_png(image, if is_color { Transfer::Srgb } else { Transfer::Linear })?;
        let path = format!("{path}#{}.png", &Digest::of(&bytes).to_string()[..12]);
        Some(Picture { bytes: PictureBytes::Here(path, bytes), mapping: picture.mapping })
    }

    /// The mean of all values of a picture.
    pub fn mean(&self, picture: &Picture, at: Span) -> Option<f32> {
        match &picture.bytes {
            PictureBytes::File(path) => self.image(path, at).map(|image| mean(&image)),
            PictureBytes::Here(path, bytes) => {
                self.read(path, bytes, image::decode_linear).ok().map(|image| mean(&image))
            }
        }
    }

    /// A picture of numbers, made of another by what its texels become; `decode` is the other's
    /// curve. Numbers have none.
    pub fn changed(
        &self,
        picture: &Picture,
        at: Span,
        decode: fn(u8) -> f32,
        change: impl Fn(Color) -> f32,
    ) -> Option<Picture> {
        let (path, image) = match &picture.bytes {
            PictureBytes::File(path) => (path, self.decoded(path, at, decode)?),
            PictureBytes::Here(path, bytes) => (path, self.read(path, bytes, decode).ok()?),
        };
        let texel = |p: &Color| Color::splat(change(*p).clamp(0.0, 1.0));
        let image = Image::from_pixels(image.width, image.height, image.pixels.iter().map(texel).collect()).ok()?;
        let bytes = as_png(image, Transfer::Linear)?;
        let path = format!("{path}#{}.png", &Digest::of(&bytes).to_string()[..12]);
        Some(Picture { bytes: PictureBytes::Here(path, bytes), mapping: picture.mapping })
    }

    /// A picture of colours, made of two that lie alike (or of one twice) texel by texel, and what its
    /// values are to be multiplied by. `None` where they lie otherwise.
    pub fn remade(
        &self,
        [one, other]: [&Picture; 2],
        at: Span,
        join: impl Fn(Color, Color) -> Color,
    ) -> Option<(Picture, f32)> {
        if one.mapping != other.mapping {
            return None;
        }
        let image = |picture: &Picture| match &picture.bytes {
            PictureBytes::File(path) => self.image(path, at),
            PictureBytes::Here(path, bytes) => self.read(path, bytes, image::decode_srgb).ok(),
        };
        let (a, b) = (image(one)?, image(other)?);
        let (width, height) = (a.width.max(b.width), a.height.max(b.height));
        // Of the smaller one the nearest texel.
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
        let bytes = as_png(Image::from_pixels(width, height, pixels).ok()?, Transfer::Srgb)?;
        let path = format!("{}#{}.png", one.bytes.path(), &Digest::of(&bytes).to_string()[..12]);
        Some((Picture { bytes: PictureBytes::Here(path, bytes), mapping: one.mapping }, most))
    }

    fn complain(&self, name: &str, at: Span, error: &ImageError) {
        self.said.push(unusable(name, error).at(at));
    }
}

/// What is wrong with a picture.
pub(super) fn unusable(name: &str, error: &ImageError) -> Diagnostic {
    let diagnostic = Diagnostic::error(format!("the picture `{name}` cannot be used: {error}")).code("bad-file");
    match error {
        ImageError::Memory { .. } => diagnostic.help("see `--memory`"),
        _ => diagnostic,
    }
}

/// A name for a picture of a scene.
pub(super) fn asset(scene: &mut Scene, picture: Picture, span: Span) -> FileName {
    // The same picture may lie otherwise on other surfaces.
    let mapping = Digest::of(format!("{:?}", picture.mapping).as_bytes()).to_string();
    let path = format!("{}#{}", picture.bytes.path(), &mapping[..12]);
    scene.assets.pictures.entry(path.clone()).or_insert(picture);
    FileName { path, span }
}

/// A picture of four texels: one colour at the upper left and the lower right, another at the other
/// two. Also what its values are to be multiplied by.
pub(super) fn checkerboard(one: Color, other: Color) -> Option<(PictureBytes, f32)> {
    let (bytes, most) = four([one, other, other, one])?;
    let PictureBytes::Here(_, bytes) = bytes else { return None };
    Some((PictureBytes::Here(format!("checkerboard-{other}-{one}.png"), bytes), most))
}

/// A picture of four texels, the upper row first, and what its values are to be multiplied by.
pub(super) fn four(colors: [Color; 4]) -> Option<(PictureBytes, f32)> {
    let most = colors.iter().fold(1.0, |most: f32, color| most.max(color.max_element()));
    let pixels = colors.map(|color| color / most);
    let bytes = as_png(Image::from_pixels(2, 2, pixels.to_vec()).ok()?, Transfer::Srgb)?;
    let name = format!("corners-{}.png", &Digest::of(format!("{colors:?}").as_bytes()).to_string()[..12]);
    Some((PictureBytes::Here(name, bytes), most))
}

/// A picture as the bytes of a PNG of eight bits.
pub(super) fn as_png(image: Image, transfer: Transfer) -> Option<Arc<[u8]>> {
    let mut bytes = Vec::new();
    let format = image::format_for("a.png").ok()?;
    let options = WriteOptions { display: transfer.into(), ..WriteOptions::default() };
    format.write(&[Layer::color("", image)], &options, &mut bytes).ok()?;
    Some(bytes.into())
}

fn mean(image: &Image) -> f32 {
    let sum: f64 = image.pixels.iter().map(|p| f64::from((p.x + p.y + p.z) / 3.0)).sum();
    (sum / image.pixels.len().max(1) as f64) as f32
}
