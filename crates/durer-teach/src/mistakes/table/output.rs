//! Mistakes in writing the picture to a file. Flipped pictures and exchanged channels are detected
//! from the pictures alone.

use super::{Mistake, Values, row};
use crate::mistakes::bugs::{OutputBug, PixelOrder};

/// Usual gamma exponents, where 0 stands for the sRGB curve.
const POWERS: Values = Values::Only(&[0.0, 2.2, 2.0, 1.8, 2.4]);

/// Common mistakes in writing the picture to a file.
pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "mirrored",
        "rays",
        "the picture is mirrored left to right",
        "u = cross(w, up), x from left to right",
        "u = cross(up, w), or x from right to left",
        |v, _| v.pixel_order.columns_back ^= true,
    ),
    row(
        "upside-down",
        "rays",
        "the picture is upside down",
        "rows counted from the top where y points up",
        "row 0 written as the lowest, or read so",
        |v, _| v.pixel_order.rows_back ^= true,
    ),
    row(
        "turned",
        "rays",
        "the picture is rotated by 180 degrees",
        "d = D w + x u + y v",
        "d = D w - x u - y v",
        |v, _| {
            v.pixel_order.columns_back ^= true;
            v.pixel_order.rows_back ^= true;
        },
    ),
    row(
        "transposed",
        "rays",
        "columns and rows are swapped",
        "pixel(i, j): i the column, j the row",
        "pixel(j, i)",
        |v, _| v.pixel_order.exchange = true,
    ),
    row(
        "bgr",
        "flat",
        "red and blue are swapped",
        "red, green, blue in the order of the format",
        "blue, green, red",
        |v, _| v.pixel_order.channels = 1,
    ),
    row(
        "channels",
        "flat",
        "the channels are in another order: {green and blue are exchanged|red and green are exchanged|its red, green and blue are green, blue and red|its red, green and blue are blue, red and green}",
        "red, green, blue in the order of the format",
        "another order, or a pixel that begins at another byte",
        |v, order| v.pixel_order.channels = 2 + order as u8,
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0])),
    row(
        "shifted",
        "rays",
        "the picture is shifted by one pixel {up|down|to the left|to the right|up, repeating the border|down, repeating the border|to the left, repeating the border|to the right, repeating the border|up, wrapping around|down, wrapping around|to the left, wrapping around|to the right, wrapping around}",
        "rows and columns from 0",
        "rows or columns from 1",
        |v, way| {
            const DIRECTIONS: [(i32, i32); 4] = [(0, -1), (0, 1), (-1, 0), (1, 0)];
            v.pixel_order = PixelOrder { moved: DIRECTIONS[way as usize % 4], black_border: way < 4.0, rolled: way >= 8.0, ..v.pixel_order };
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0])),
    row("tone-mapped", "flat", "light is compressed instead of clamped to 1", "min(1, c)", "c / (1 + c)", |v, _| {
        v.output = OutputBug::Toned
    }),
    row(
        "wrapped",
        "flat",
        "values beyond 1 wrap around in eight bits{|, and are multiplied by 256}",
        "(unsigned char) (min(1, c) * 255)",
        "(unsigned char) (c * {255|256})",
        |v, more| v.output = OutputBug::Wrapped(255 + more as u16),
    )
    .with(Values::Only(&[0.0, 1.0])),
    row(
        "scaled-to-maximum",
        "flat",
        "the picture is divided by its brightest value instead of clamped to 1",
        "min(1, c) * 255",
        "c / max(all c) * 255",
        |v, _| v.output = OutputBug::Scaled,
    ),
    row(
        "other-rounding",
        "flat",
        "values are rounded instead of truncated, or the reverse: they differ by 1",
        "as in the scene's dialect: (int) (c * 255), or round(c * 255)",
        "the other",
        |v, _| v.output = OutputBug::OtherRounding,
    ),
    row(
        "curve-more",
        "flat",
        "the sRGB curve (gamma) is applied once too often",
        "value = srgb(c) * 255 if the reference has the curve, else c * 255",
        "one curve more: value = srgb(srgb(c)) * 255, or pow(c, 1 / 2.2) * 255",
        |v, power| v.output = OutputBug::ExtraCurve(power),
    )
    .with(POWERS),
    row(
        "curve-less",
        "flat",
        "the sRGB curve (gamma) is missing once, or undone",
        "value = srgb(c) * 255 if the reference has the curve, else c * 255",
        "one curve less: value = c * 255, or pow(c, 2.2) * 255",
        |v, power| v.output = OutputBug::MissingCurve(power),
    )
    .with(POWERS),
    row(
        "halved",
        "rays",
        "the picture is rendered at half the resolution and scaled up",
        "one ray per pixel",
        "one ray per two by two pixels",
        |v, _| {
            v.pixel_order.halved = true;
            v.camera_bugs.sample_position = durer_scene::math::Vec2::ONE;
        },
    ),
    row("negative", "flat", "the picture is a negative: bright and dark are swapped", "c", "1 - c", |v, _| {
        v.output = OutputBug::Negative;
    }),
    row(
        "grey",
        "flat",
        "the picture is grey{||||, from red only|, from green only|, from blue only}",
        "three channels",
        "one, three times",
        |v, how| v.output = OutputBug::Grey(how as u32),
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0])),
    row(
        "steps",
        "flat",
        "there are only {} levels of each colour",
        "256 levels",
        "{} levels",
        |v, steps| v.output = OutputBug::Steps(steps as u32),
    )
    .with(Values::Only(&[2.0, 3.0, 4.0, 8.0, 16.0, 32.0, 64.0])),
    row(
        "picture-factor",
        "flat",
        "the whole picture is {} times as bright as it should be",
        "c * 255",
        "{} * c * 255",
        |v, factor| v.output = OutputBug::Times(factor),
    )
    .with(Values::Numbers(&[0.5, 0.75, 1.3, 2.0])),
];
