//! Mistakes in how light becomes a file. Turned and exchanged pixels are told from the pictures alone.

use super::{Mistake, Values, row};
use crate::mistakes::habits::{Output, Turn};

const STRAIGHT: Turn =
    Turn { exchange: false, columns_back: false, rows_back: false, bgr: false, moved: (0, 0), black_border: false };

/// Usual exponents; 0 is the curve of sRGB itself.
const POWERS: Values = Values::Only(&[0.0, 2.2, 2.0, 1.8, 2.4]);

pub(super) const MISTAKES: &[Mistake] = &[
    row(
        "mirrored",
        "rays",
        "the picture is mirrored left to right",
        "u = cross(w, up), x from left to right",
        "u = cross(up, w), or x from right to left",
        |v, _| v.turn = Turn { columns_back: true, ..STRAIGHT },
    ),
    row(
        "upside-down",
        "rays",
        "the picture is upside down",
        "rows counted from the top where y points up",
        "row 0 written as the lowest, or read so",
        |v, _| v.turn = Turn { rows_back: true, ..STRAIGHT },
    ),
    row(
        "turned",
        "rays",
        "the picture is turned by 180 degrees",
        "d = D w + x u + y v",
        "d = D w - x u - y v",
        |v, _| v.turn = Turn { columns_back: true, rows_back: true, ..STRAIGHT },
    ),
    row(
        "transposed",
        "rays",
        "columns and rows are exchanged",
        "pixel(i, j): i the column, j the row",
        "pixel(j, i)",
        |v, _| v.turn = Turn { exchange: true, ..STRAIGHT },
    ),
    row(
        "bgr",
        "flat",
        "red and blue are exchanged",
        "red, green, blue in the order of the format",
        "blue, green, red",
        |v, _| v.turn = Turn { bgr: true, ..STRAIGHT },
    ),
    row(
        "shifted",
        "rays",
        "the picture is moved by one pixel ({}: 0 up, 1 down, 2 left, 3 right; 4 to 7 the same, repeating the border)",
        "rows and columns from 0",
        "rows or columns from 1",
        |v, way| {
            const WAYS: [(i32, i32); 4] = [(0, -1), (0, 1), (-1, 0), (1, 0)];
            v.turn = Turn { moved: WAYS[way as usize % 4], black_border: way < 4.0, ..STRAIGHT };
        },
    )
    .with(Values::Only(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])),
    row("tone-mapped", "flat", "light is compressed, not cut off at 1", "min(1, c)", "c / (1 + c)", |v, _| {
        v.output = Output::Toned
    }),
    row(
        "wrapped",
        "flat",
        "values beyond 1 wrap around in eight bits",
        "(unsigned char) (min(1, c) * 255)",
        "(unsigned char) (c * 255)",
        |v, _| v.output = Output::Wrapped,
    ),
    row(
        "scaled-to-maximum",
        "flat",
        "the picture is divided by its brightest value, not cut off at 1",
        "min(1, c) * 255",
        "c / max(all c) * 255",
        |v, _| v.output = Output::Scaled,
    ),
    row(
        "other-rounding",
        "flat",
        "values are rounded where they should be cut off, or the other way: they differ by 1",
        "as the year has it: (int) (c * 255), or round(c * 255)",
        "the other",
        |v, _| v.output = Output::OtherRounding,
    ),
    row(
        "curve-more",
        "flat",
        "the curve of sRGB (gamma) is applied once more than it should be",
        "value = c * 255",
        "value = pow(c, 1 / 2.2) * 255",
        |v, power| v.output = Output::CurveMore(power),
    )
    .with(POWERS),
    row(
        "curve-less",
        "flat",
        "the curve of sRGB (gamma) is undone once more than it should be",
        "value = c * 255",
        "value = pow(c, 2.2) * 255",
        |v, power| v.output = Output::CurveLess(power),
    )
    .with(POWERS),
];
