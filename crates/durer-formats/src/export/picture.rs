//! Pictures of textures as files beside the scene: copied if possible, otherwise converted to 8-bit
//! PNG.

use super::Export;
use super::surface::Mask;
use crate::pictures::{CONVERSION_BYTES_PER_PIXEL, as_png};
use durer_image::{self as image, Encoded, Image, Transfer};
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::{PictureBytes, TextureImage};
use durer_scene::texture::Channel;

/// File of a texture, and whether its bytes are linear or sRGB.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PictureFile {
    pub path: String,
    pub is_linear: bool,
}

impl Export<'_> {
    /// Returns the file of a colour picture, to whose values `change` is applied. `what` names the
    /// change, which is none for `color`. `is_linear` is true if 8-bit values are linear.
    pub fn color_file(
        &mut self,
        picture: &TextureImage,
        is_linear: bool,
        what: &str,
        change: impl Fn(Color) -> Color,
    ) -> Option<PictureFile> {
        let name = picture.bytes.path().to_string();
        let key = format!("{name} {is_linear} {what} {}", is_memory(&picture.bytes));
        let bytes = self.picture_bytes(&picture.bytes).unwrap_or_default();
        let path = if what == "color" && is_common(&bytes) {
            let extension = if bytes.starts_with(b"\x89PNG") { "png" } else { "jpg" };
            self.file(key, &stem(&name), extension, |_| Some(bytes.to_vec()))
        } else {
            let transfer = if is_linear { Transfer::Linear } else { Transfer::Srgb };
            self.file(key, &stem(&name), "png", |export| {
                let image = export.decoded(picture, is_linear)?;
                recolored(image, |p| change(p).clamp(Vec3::ZERO, Vec3::ONE), transfer)
            })
        };
        self.found(path.map(|path| PictureFile { path, is_linear }), &name)
    }

    /// Returns the file of a linear picture with the numbers of one channel, to which `change` is
    /// applied. `what` names the change.
    pub fn number_file(
        &mut self,
        picture: &TextureImage,
        what: &str,
        change: impl Fn(f32) -> f32,
    ) -> Option<PictureFile> {
        let name = picture.bytes.path().to_string();
        let (mapping, channel) = (picture.mapping, picture.mapping.channel.unwrap_or(Channel::Red));
        let key = format!("{name} {what} {channel:?} {:?} {}", mapping.range, is_memory(&picture.bytes));
        let path = self.file(key, &format!("{}-{what}", stem(&name)), "png", |export| {
            let texel = |rgba| Vec3::splat(change(mapping.map_to_range(channel.of(rgba))).clamp(0.0, 1.0));
            if channel == Channel::Alpha {
                let (image, alphas) = export.decoded_with_alpha(picture)?;
                let mut alphas = alphas.into_iter();
                return recolored(image, |_| texel([0.0, 0.0, 0.0, alphas.next().unwrap_or(1.0)]), Transfer::Linear);
            }
            recolored(export.decoded(picture, true)?, |p| texel([p.x, p.y, p.z, 1.0]), Transfer::Linear)
        });
        self.found(path.map(|path| PictureFile { path, is_linear: true }), &name)
    }

    /// Returns the file of an opacity that is multiplied by a picture.
    pub fn opacity_file(&mut self, mask: &Mask, opacity: f32) -> Option<PictureFile> {
        let mut picture = mask.picture.clone();
        let has_alpha = mask.is_alpha && self.has_alpha(&picture);
        if has_alpha {
            picture.mapping.channel = Some(Channel::Alpha);
        }
        let cutoff = picture.mapping.cutoff.filter(|_| has_alpha);
        let present = |x: f32| cutoff.map_or(x, |least| f32::from(x >= least));
        self.number_file(&picture, &format!("opacity-{opacity}"), |x| opacity * present(x))
    }

    /// True if any texel of a picture is not opaque.
    pub fn has_alpha(&self, picture: &TextureImage) -> bool {
        self.decoded_with_alpha(picture).is_some_and(|(_, alphas)| alphas.iter().any(|alpha| *alpha < 1.0))
    }

    /// Returns the file of a picture with values of any size, as Portable FloatMap.
    pub fn bright_file(&mut self, picture: &TextureImage, factor: Vec3) -> Option<PictureFile> {
        let name = picture.bytes.path().to_string();
        let path = self.file(format!("{name} bright {factor}"), &stem(&name), "pfm", |export| {
            let mut image = export.decoded(picture, false)?;
            image.pixels.iter_mut().for_each(|p| *p *= factor);
            as_pfm(image)
        });
        self.found(path.map(|path| PictureFile { path, is_linear: true }), &name)
    }

    fn found(&mut self, file: Option<PictureFile>, name: &str) -> Option<PictureFile> {
        if file.is_none() {
            self.warn_lost(format!("the picture `{name}` cannot be read: it is left out"));
        }
        file
    }

    fn decoded(&self, picture: &TextureImage, is_linear: bool) -> Option<Image> {
        let decode = if is_linear { image::decode_linear } else { image::decode_srgb };
        let bytes = self.picture_bytes(&picture.bytes)?;
        let encoded = Encoded::open(&bytes, picture.bytes.path()).ok()?;
        encoded.read_for(CONVERSION_BYTES_PER_PIXEL, self.context.memory, decode).ok()
    }

    fn decoded_with_alpha(&self, picture: &TextureImage) -> Option<(Image, Vec<f32>)> {
        let bytes = self.picture_bytes(&picture.bytes)?;
        let encoded = Encoded::open(&bytes, picture.bytes.path()).ok()?;
        let alphas = encoded.read8(self.context.memory).ok()?.alpha;
        Some((self.decoded(picture, true)?, alphas.into_iter().map(|alpha| f32::from(alpha) / 255.0).collect()))
    }
}

/// True for the formats that all programs read.
fn is_common(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89PNG") || bytes.starts_with(&[0xff, 0xd8, 0xff])
}

fn is_memory(bytes: &PictureBytes) -> bool {
    matches!(bytes, PictureBytes::Memory(..))
}

/// Returns a name without its extension.
fn stem(name: &str) -> String {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_string()
}

fn recolored(mut image: Image, mut change: impl FnMut(Color) -> Color, transfer: Transfer) -> Option<Vec<u8>> {
    image.pixels.iter_mut().for_each(|p| *p = change(*p));
    Some(as_png(image, transfer)?.to_vec())
}

/// Encodes a picture as a Portable FloatMap.
pub(crate) fn as_pfm(image: Image) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let format = image::format_for("a.pfm").ok()?;
    format.write(&[image::Layer::data("", image)], &image::WriteOptions::default(), &mut bytes).ok()?;
    Some(bytes)
}
