//! Decoding of image files into textures.

use durer_diag::{Diagnostic, Diagnostics};
use durer_image::{self as image, Encoded, ImageError, Raster};
use durer_scene::describe::FileName;
use durer_scene::math::Vec3;
use durer_scene::texture::Texture;

/// Interpretation of the eight-bit values of a picture as sRGB colours or linear numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Encoding {
    /// Colours encoded with the sRGB curve.
    Srgb,
    /// Linear numbers from 0 to 1.
    Linear,
}

/// Decodes an image file into a texture, using at most `memory` bytes. Eight-bit pictures keep
/// their eight-bit values, and all others are converted to floats.
pub(super) fn decode(
    name: &FileName,
    path: &str,
    bytes: &[u8],
    srgb: bool,
    memory: u64,
    diagnostics: &mut Diagnostics,
) -> Option<Texture> {
    let raster = Encoded::open(bytes, path).and_then(|encoded| encoded.read_raster(memory));
    match value_or_report(name, path, raster, diagnostics)? {
        Raster::Eight(picture) => {
            let texture = Texture::new(picture.width, picture.height, picture.pixels)?.with_alpha(Some(picture.alpha));
            Some(if srgb { texture.with_decoding(image::decode_srgb) } else { texture })
        }
        Raster::Sixteen(mut picture, alpha) => {
            if srgb {
                let linear = |pixel: Vec3| Vec3::from(pixel.to_array().map(image::linear_from_srgb));
                picture.pixels.iter_mut().for_each(|pixel| *pixel = linear(*pixel));
            }
            Some(Texture::from_floats(picture.width, picture.height, picture.pixels)?.with_opacity(alpha))
        }
        Raster::Float(mut picture, mut alpha) => {
            if let Some(message) = replace_invalid_texels(&mut picture.pixels, picture.width, path) {
                diagnostics.push(Diagnostic::warning(message).code("bad-texels").at(name.span));
            }
            alpha.iter_mut().filter(|a| !a.is_finite()).for_each(|a| *a = 1.0);
            Some(Texture::from_floats(picture.width, picture.height, picture.pixels)?.with_opacity(alpha))
        }
    }
}

/// Largest finite half-precision number, to which infinite texels are clamped. Such texels usually
/// show the sun in an HDR photograph, where it was too bright for the camera.
const BRIGHTEST: f32 = 65_504.0;

/// Replaces NaN texels by 0 and clamps infinite texels to [`BRIGHTEST`]. Returns a warning text if
/// there were any such texels.
pub(super) fn replace_invalid_texels(texels: &mut [Vec3], width: u32, path: &str) -> Option<String> {
    let (mut count, mut first) = (0_usize, None);
    for (i, texel) in texels.iter_mut().enumerate().filter(|(_, texel)| !texel.is_finite()) {
        count += 1;
        first.get_or_insert((i, *texel));
        *texel = texel.map(|x| if x.is_nan() { 0.0 } else { x.clamp(-BRIGHTEST, BRIGHTEST) });
    }
    let (i, texel) = first?;
    let (column, row) = (i % width as usize, i / width as usize);
    let texels = if count == 1 { "one invalid texel".into() } else { format!("{count} invalid texels") };
    let [r, g, b] = texel.to_array();
    Some(format!(
        "the image `{path}` has {texels}: {r} {g} {b} in column {column} of row {row}, counted from 0 at the upper \
         left; NaN is read as 0 and infinity as {BRIGHTEST}"
    ))
}

/// Returns the picture if it was read. Otherwise, reports the error at the place where the scene
/// names the file.
pub(super) fn value_or_report<T>(
    name: &FileName,
    path: &str,
    read: Result<T, ImageError>,
    diagnostics: &mut Diagnostics,
) -> Option<T> {
    let refuse = |error: ImageError| {
        let message = format!("cannot use the image `{path}`: {error}");
        let diagnostic = Diagnostic::error(message).code("bad-file").at(name.span);
        diagnostics.push(match error {
            ImageError::MemoryLimit { .. } => diagnostic.help("see `--memory`"),
            _ => diagnostic,
        });
    };
    read.map_err(refuse).ok()
}
