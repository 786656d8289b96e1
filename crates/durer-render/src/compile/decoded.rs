//! Decoding of pictures to textures.

use durer_diag::{Diagnostic, Diagnostics};
use durer_image::{self as image, Encoded, ImageError, Raster};
use durer_scene::describe::FileName;
use durer_scene::math::Vec3;
use durer_scene::texture::Texture;

/// Meaning of a picture's eight-bit values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Encoding {
    /// Colours with the sRGB curve.
    Srgb,
    /// Linear numbers from 0 to 1.
    Linear,
}

/// Decodes a picture into a texture within a memory limit. Eight-bit pictures stay eight-bit,
/// others become floats.
pub(super) fn decode(
    name: &FileName,
    path: &str,
    bytes: &[u8],
    srgb: bool,
    memory: u64,
    diagnostics: &mut Diagnostics,
) -> Option<Texture> {
    let raster = Encoded::open(bytes, path).and_then(|encoded| encoded.read_raster(memory));
    match used(name, path, raster, diagnostics)? {
        Raster::Eight(picture) => {
            let texture = Texture::new(picture.width, picture.height, picture.pixels)?.with_alpha(Some(picture.alpha));
            Some(if srgb { texture.decoded(image::decode_srgb) } else { texture })
        }
        Raster::Sixteen(mut picture, alpha) => {
            if srgb {
                let linear = |pixel: Vec3| Vec3::from(pixel.to_array().map(image::linear_from_srgb));
                picture.pixels.iter_mut().for_each(|pixel| *pixel = linear(*pixel));
            }
            Some(Texture::from_floats(picture.width, picture.height, picture.pixels)?.with_opacity(alpha))
        }
        Raster::Float(picture, alpha) => {
            if picture.first_non_finite().is_some() || alpha.iter().any(|a| !a.is_finite()) {
                let message = format!("the picture `{path}` has values that are no numbers");
                diagnostics.push(Diagnostic::error(message).code("bad-file").at(name.span));
                return None;
            }
            Some(Texture::from_floats(picture.width, picture.height, picture.pixels)?.with_opacity(alpha))
        }
    }
}

/// Returns the picture, or reports the error where the scene names it.
pub(super) fn used<T>(
    name: &FileName,
    path: &str,
    read: Result<T, ImageError>,
    diagnostics: &mut Diagnostics,
) -> Option<T> {
    let refuse = |error: ImageError| {
        let message = format!("the picture `{path}` cannot be used: {error}");
        let diagnostic = Diagnostic::error(message).code("bad-file").at(name.span);
        diagnostics.push(match error {
            ImageError::Memory { .. } => diagnostic.help("see `--memory`"),
            _ => diagnostic,
        });
    };
    read.map_err(refuse).ok()
}
