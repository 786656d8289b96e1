//! Mistakes in textures and in the images of the sky.

use super::{Mistake, SceneVariant, Values, row};
use crate::mistakes::bugs::{SkyDirection, SkyFaces, TextureBug};

/// Faces of a cube map as bits, in the order left, right, up, down, front, back: all, the sides, up
/// with down, and each face alone.
const FACES: [u8; 9] = [0b11_1111, 0b11_0011, 0b00_1100, 1, 2, 4, 8, 16, 32];

/// Row of a mistake in the images of some faces of the sky.
macro_rules! sky_row {
    ($name:literal, $how:literal, $make:expr) => {
        row(
            $name,
            "flat",
            concat!(
                "the images of {all faces|the four sides|the faces up and down|the face left|the face right|the face \
                 up|the face down|the face front|the face back} of the sky are ",
                $how
            ),
            "each face upright and not mirrored, seen from inside",
            "u or v of a face with the wrong sign, or swapped",
            $make,
        )
        .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]))
    };
}

/// Common mistakes in textures and in the images of the sky.
pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "texture-exchanged",
        "flat",
        "u and v of textures are swapped",
        "texel(u * width, (1 - v) * height)",
        "texel(v * width, (1 - u) * height)",
        |v, _| v.bugs.colors.texture = TextureBug::Exchanged,
    ),
    row(
        "texture-flipped",
        "flat",
        "textures are {upside down|mirrored left to right|rotated by 180 degrees}",
        "texel(u * width, (1 - v) * height)",
        "texel({u * width, v * height|(1 - u) * width, (1 - v) * height|(1 - u) * width, v * height})",
        |v, how| v.bugs.colors.texture = TextureBug::Flipped(how > 0.0, how != 1.0),
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "texture-nearest",
        "flat",
        "textures are not interpolated: the {texel at the rounded-down position|nearest texel|texel at u * (width - 1)} \
         is used",
        "the weighted mean of four texels",
        "texel({(int) (u * width), (int) (v * height)|round(u * width), round(v * height)|(int) (u * (width - 1)), \
         (int) (v * (height - 1))})",
        |v, how| v.bugs.colors.texture = NEAREST[(how as usize).min(2)],
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "texture-shifted",
        "flat",
        "textures are shifted by half a texel {to the right and down|to the left and up}",
        "as in the scene's dialect: x = u * width, or x = u * width - 0.5",
        "the other, or x = u * width + 0.5",
        |v, back| v.bugs.colors.texture = TextureBug::Shifted(if back == 0.0 { -0.5 } else { 0.5 }),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "texture-size",
        "flat",
        "texture coordinates are multiplied by the size minus 1",
        "x = u * width, y = (1 - v) * height",
        "x = u * (width - 1), y = (1 - v) * (height - 1)",
        |v, _| v.bugs.colors.texture = TextureBug::LessOne,
    ),
    row(
        "texture-border",
        "flat",
        "textures are {repeated beyond their border instead of clamped to it|clamped to their border instead of repeated}",
        "{x = min(max(x, 0), width - 1)|x modulo width}",
        "{x modulo width|x = min(max(x, 0), width - 1)}",
        |v, clamped| v.bugs.colors.texture = if clamped == 0.0 { TextureBug::Repeated } else { TextureBug::Clamped },
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "texture-bgr",
        "flat",
        "red and blue of textures are swapped",
        "red, green, blue in the order of the format",
        "blue, green, red",
        |v, _| v.bugs.colors.texture = TextureBug::BlueFirst,
    ),
    row(
        "texture-times-diffuse",
        "flat",
        "textures are multiplied by the diffuse colour instead of replacing it, or the reverse",
        "as in the scene's dialect: kd = texel, or kd = diffuseColor * texel",
        "the other",
        |v, _| v.phongs(|phong| phong.tinted ^= phong.texture.is_some()),
    ),
    row(
        "texture-undecoded",
        "flat",
        "textures are not decoded with the sRGB curve",
        "texel = srgb_to_linear(code / 255)",
        "texel = code / 255",
        |v, _| v.undecoded_textures(),
    ),
    row(
        "texture-vertices",
        "flat",
        "the weights of texture coordinates belong to the wrong vertices: {a b c|b c a|c a b|b a c|a c b|c b a} for a b c",
        "uv = (1 - b - c) uva + b uvb + c uvc",
        "the weights or the coordinates in another order",
        |v, order| v.bugs.colors.uv_permutation = order as usize,
    )
    .with(Values::Only(&[1.0, 2.0, 3.0, 4.0, 5.0])),
    row(
        "sky-direction",
        "flat",
        "the sky is looked up in {the opposite direction|a direction with x negated|a direction with y negated|a \
         direction with z negated|a direction with y and z swapped|a direction with x and z swapped|a direction with \
         x and y swapped|a direction turned by 90 degrees to the left|a direction turned by 90 degrees to the right}",
        "sky(d)",
        "sky({-d|(-x, y, z)|(x, -y, z)|(x, y, -z)|(x, z, y)|(z, y, x)|(y, x, z)|(z, y, -x)|(-z, y, x)})",
        |v, how| {
            v.bugs.colors.sky = match how as usize {
                0 => SkyDirection::Opposite,
                axis @ 1..=3 => SkyDirection::Negated(axis - 1),
                axis @ 4..=6 => SkyDirection::Exchanged(axis - 4),
                way => SkyDirection::Turned(way == 8),
            };
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0])),
    row(
        "sky-faces",
        "flat",
        "faces of the sky are swapped: {left and right|up and down|front and back|all three pairs}",
        "left, right, up, down, front, back for -x, +x, +y, -y, +z, -z",
        "the faces in another order, or a wrong sign in the choice of the face",
        |v, axis| v.bugs.colors.faces = SkyFaces::Exchanged(axis as usize),
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
    sky_row!("sky-mirrored", "mirrored left to right", |v, faces| flip(v, faces, true, false)),
    sky_row!("sky-upside-down", "upside down", |v, faces| flip(v, faces, false, true)),
    sky_row!("sky-rotated", "rotated by 180 degrees", |v, faces| flip(v, faces, true, true)),
    sky_row!("sky-transposed", "transposed", |v, faces| v.bugs.colors.faces = SkyFaces::Transposed(FACES[faces as usize])),
    row(
        "sky-undivided",
        "flat",
        "the coordinates on the sky's faces are not divided by the greatest component of the direction",
        "u = (z / |x| + 1) / 2",
        "u = (z + 1) / 2",
        |v, _| v.bugs.colors.faces = SkyFaces::Undivided,
    ),
    row(
        "sky-nearest",
        "flat",
        "the faces of the sky are not interpolated: the {texel at the rounded-down position|nearest texel|texel at \
         u * (width - 1)} is used",
        "the weighted mean of four texels",
        "texel({(int) (u * width), (int) (v * height)|round(u * width), round(v * height)|(int) (u * (width - 1)), \
         (int) (v * (height - 1))})",
        |v, how| v.bugs.colors.face_texture = NEAREST[(how as usize).min(2)],
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "sky-shifted",
        "flat",
        "the faces of the sky are {shifted by half a texel to the right and down|shifted by half a texel to the left \
         and up|multiplied by the size minus 1}",
        "x = u * width, y = (1 - v) * height",
        "x = u * {width - 0.5|width + 0.5|(width - 1)}",
        |v, how| {
            v.bugs.colors.face_texture =
                [TextureBug::Shifted(-0.5), TextureBug::Shifted(0.5), TextureBug::LessOne][(how as usize).min(2)];
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0])),
    row(
        "sky-bgr",
        "flat",
        "red and blue of the sky's faces are swapped",
        "red, green, blue in the order of the format",
        "blue, green, red",
        |v, _| v.bugs.colors.face_texture = TextureBug::BlueFirst,
    ),
];

/// Lookups of textures without interpolation.
const NEAREST: [TextureBug; 3] = [TextureBug::Nearest, TextureBug::NearestRounded, TextureBug::NearestInside];

/// Flips the images of faces of the sky along u, along v, or both.
fn flip(variant: &mut SceneVariant, faces: f32, u: bool, v: bool) {
    variant.bugs.colors.faces = SkyFaces::Flipped(FACES[faces as usize], u, v);
}
