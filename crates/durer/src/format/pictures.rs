//! Pictures that materials name, for readers of whole scenes.

use super::model::Input;
use super::said::Said;
use crate::describe::FileName;
use crate::diag::{Diagnostic, Span};
use crate::image::{self, Depth, Encoded, Image, ImageError, Layer, Transfer, WriteOptions};
use crate::math::Color;
use crate::scene::{Picture, PictureBytes, Scene};
use crate::source::Digest;
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

    fn decoded(&self, name: &str, at: Span, decode: fn(u8) -> f32) -> Option<Image> {
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

    /// A picture of colours, made of one whose bytes have no curve.
    pub fn curved(&self, picture: &Picture, at: Span) -> Option<Picture> {
        // What was of another format has a curve already.
        let PictureBytes::File(path) = &picture.bytes else { return None };
        let bytes = as_png(self.decoded(path, at, image::decode_linear)?, Transfer::Srgb)?;
        Some(Picture { bytes: PictureBytes::Here(format!("{path}#curved.png"), bytes), mapping: picture.mapping })
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

    /// A picture of numbers, made of another by what its texels' means become; `decode` is the
    /// other's curve. Numbers have none.
    pub fn changed(
        &self,
        picture: &Picture,
        at: Span,
        decode: fn(u8) -> f32,
        change: impl Fn(f32) -> f32,
    ) -> Option<Picture> {
        let (path, image) = match &picture.bytes {
            PictureBytes::File(path) => (path, self.decoded(path, at, decode)?),
            PictureBytes::Here(path, bytes) => (path, self.read(path, bytes, decode).ok()?),
        };
        let texel = |p: &Color| Color::splat(change((p.x + p.y + p.z) / 3.0).clamp(0.0, 1.0));
        let image = Image::from_pixels(image.width, image.height, image.pixels.iter().map(texel).collect()).ok()?;
        let bytes = as_png(image, Transfer::Linear)?;
        let path = format!("{path}#{}.png", &Digest::of(&bytes).to_string()[..12]);
        Some(Picture { bytes: PictureBytes::Here(path, bytes), mapping: picture.mapping })
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
    let most = one.max(other).max_element().max(1.0);
    let pixels = [one, other, other, one].map(|color| color / most);
    let bytes = as_png(Image::from_pixels(2, 2, pixels.to_vec()).ok()?, Transfer::Srgb)?;
    Some((PictureBytes::Here(format!("checkerboard-{other}-{one}.png"), bytes), most))
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
