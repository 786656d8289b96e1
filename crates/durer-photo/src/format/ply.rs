//! PLY point clouds with colours. Binary little-endian files are written. Text files and big-endian
//! files can also be read.
//!
//! Camera positions are written as red points, so that programs that show points also show the
//! cameras. A comment states how many of the last points are cameras, so that they are not read as
//! points of the scene.
//!
//! Source: Turk, *The PLY Polygon File Format*, 1994.

use super::TokenReader;
use super::colmap_binary::ByteReader;
use crate::{Error, Point, Reconstruction};
use nalgebra::Vector3;

/// Text of the header comment that precedes the number of cameras.
const CAMERA_COMMENT: &str = "cameras at the end:";

/// Number types of PLY, each with its old name, its new name, and its size in bytes.
const NUMBER_TYPES: [(&str, &str, usize); 8] = [
    ("char", "int8", 1),
    ("uchar", "uint8", 1),
    ("short", "int16", 2),
    ("ushort", "uint16", 2),
    ("int", "int32", 4),
    ("uint", "uint32", 4),
    ("float", "float32", 4),
    ("double", "float64", 8),
];

/// Encoding of the vertex rows in a PLY file.
#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Text,
    Little,
    Big,
}

/// Parts of a PLY file's header that are needed to read the points.
struct Header {
    encoding: Encoding,
    /// Number of points.
    count: usize,
    count_position: (usize, usize),
    /// Number of points at the end of the file that are camera positions.
    cameras: usize,
    /// Name and type of each property. The type is an index into [`NUMBER_TYPES`].
    properties: Vec<(String, usize)>,
}

/// Reads the points of a PLY file. Points are grey if the file has no colours. The format contains
/// no observations.
pub fn read(file: &str, bytes: &[u8]) -> Result<Reconstruction, Error> {
    let is_end = |line: &&[u8]| line.trim_ascii_end() == b"end_header";
    let lines = bytes.split_inclusive(|byte| *byte == b'\n').filter(|_| bytes.starts_with(b"ply"));
    let mut length = 0;
    let end = lines.inspect(|line| length += line.len()).find(is_end);
    end.ok_or_else(|| {
        Error::in_file(file, "the file is not a PLY file: there is no header from `ply` to `end_header`")
    })?;
    let head = head(file, &bytes[..length])?;
    let (size, rest) =
        (head.properties.iter().map(|(_, kind)| NUMBER_TYPES[*kind].2).sum::<usize>(), bytes.len() - length);
    // In text files, a number takes at least two bytes including the separator.
    let row = if head.encoding == Encoding::Text { 2 * head.properties.len() } else { size };
    if head.count > rest / row + 1 {
        let why = format!("the file is too short for {} points: {rest} bytes follow the header", head.count);
        return Err(Error::at(file, head.count_position, why));
    }
    let of = |name: &str| head.properties.iter().position(|property| property.0 == name);
    let (Some(x), Some(y), Some(z)) = (of("x"), of("y"), of("z")) else {
        return Err(Error::at(file, head.count_position, "the points need the properties x, y and z"));
    };
    // Colours are integers up to 255 or 65535, or floats from 0 to 1.
    let shade = |i: usize| match NUMBER_TYPES[head.properties[i].1].0 {
        "float" | "double" => (i, 255.0),
        "ushort" => (i, 255.0 / 65535.0),
        _ => (i, 1.0),
    };
    let shades = of("red").zip(of("green")).zip(of("blue")).map(|((r, g), b)| [r, g, b].map(shade));
    let mut reconstruction = Reconstruction::default();
    let mut add = |row: &[f64]| {
        let color = shades.map(|all| all.map(|(i, scale)| (row[i] * scale).round().clamp(0.0, 255.0) as u8));
        let position = Vector3::new(row[x], row[y], row[z]);
        reconstruction.points.push(Point { position, color: color.unwrap_or([128; 3]), track: Vec::new() });
    };
    let mut row = vec![0.0; head.properties.len()];
    if head.encoding == Encoding::Text {
        let mut words = TokenReader::in_rows(file, bytes)?;
        while words.rest_of_line() != "end_header" {
            words.skip_line_end();
        }
        for _ in 0..head.count {
            words.next_position();
            for (value, (name, _)) in row.iter_mut().zip(&head.properties) {
                *value = words.number(name)?;
            }
            words.end_of_row("the properties of a point")?;
            add(&row);
        }
    } else {
        let mut body = ByteReader::new(file, bytes);
        body.take(length)?;
        for _ in 0..head.count {
            for (value, (name, kind)) in row.iter_mut().zip(&head.properties) {
                *value = number(*kind, body.take(NUMBER_TYPES[*kind].2)?, head.encoding);
                if !value.is_finite() {
                    return Err(body.error(format!("expected a finite number for {name}, found {value}")));
                }
            }
            add(&row);
        }
    }
    reconstruction.points.truncate(head.count - head.cameras);
    Ok(reconstruction)
}

fn head(file: &str, text: &[u8]) -> Result<Header, Error> {
    let mut words = TokenReader::in_rows(file, text)?;
    let mut head =
        Header { encoding: Encoding::Text, count: 0, count_position: (1, 1), cameras: 0, properties: Vec::new() };
    let (mut has_points, mut is_theirs) = (false, false);
    words.rest_of_line();
    while !words.is_at_end() {
        let (word, place) = words.word("a line of the header")?;
        let fail = |why: String| Err(Error::at(file, place, why));
        match word {
            "end_header" => break,
            "format" => {
                head.encoding = match words.word("ascii or binary")?.0 {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    other => return fail(format!("`{other}` is not a PLY format")),
                }
            }
            "comment" => {
                let cameras = words.rest_of_line().strip_prefix(CAMERA_COMMENT);
                head.cameras = cameras.and_then(|count| count.trim().parse().ok()).unwrap_or(head.cameras);
            }
            "element" => {
                let name = words.word("an element's name")?.0;
                if name == "vertex" && !has_points {
                    head.count_position = words.next_position();
                    head.count = words.parse("a number of points")?;
                } else if !has_points {
                    return fail(format!("the element `vertex` must come before `{name}`"));
                }
                is_theirs = !has_points;
                has_points = true;
            }
            "property" if is_theirs => {
                let (kind, place) = words.word("a type")?;
                let number = NUMBER_TYPES.iter().position(|(old, new, _)| [old, new].contains(&&kind));
                let Some(number) = number else {
                    return Err(Error::at(file, place, format!("`{kind}` is not a number type")));
                };
                head.properties.push((words.word("a property's name")?.0.to_string(), number));
            }
            "property" | "obj_info" => {}
            other => return fail(format!("`{other}` is not a PLY header keyword")),
        }
        words.rest_of_line();
    }
    if head.properties.is_empty() {
        return Err(Error::in_file(file, "the file has no points: it has no element `vertex` with properties"));
    }
    head.cameras = head.cameras.min(head.count);
    Ok(head)
}

/// Decodes a number. `kind` is the index of the number's type in [`NUMBER_TYPES`].
fn number(kind: usize, bytes: &[u8], encoding: Encoding) -> f64 {
    let mut all = [0; 8];
    all[..bytes.len()].copy_from_slice(bytes);
    if encoding == Encoding::Big {
        all[..bytes.len()].reverse();
    }
    let [a, b, c, d, ..] = all;
    match NUMBER_TYPES[kind].0 {
        "char" => f64::from(a as i8),
        "uchar" => f64::from(a),
        "short" => f64::from(i16::from_le_bytes([a, b])),
        "ushort" => f64::from(u16::from_le_bytes([a, b])),
        "int" => f64::from(i32::from_le_bytes([a, b, c, d])),
        "uint" => f64::from(u32::from_le_bytes([a, b, c, d])),
        "float" => f64::from(f32::from_le_bytes([a, b, c, d])),
        _ => f64::from_le_bytes(all),
    }
}

/// Writes the points, followed by the camera positions in red.
pub fn write(reconstruction: &Reconstruction) -> Vec<u8> {
    let cameras = reconstruction.views.iter().filter_map(|view| Some((view.pose.as_ref()?.center(), [255, 0, 0])));
    let rows: Vec<_> = reconstruction.points.iter().map(|point| (point.position, point.color)).chain(cameras).collect();
    let cameras = rows.len() - reconstruction.points.len();
    let mut head = format!("ply\nformat binary_little_endian 1.0\ncomment {CAMERA_COMMENT} {cameras}\n");
    head += &format!("element vertex {}\n", rows.len());
    for (kind, names) in [("float", ["x", "y", "z"]), ("uchar", ["red", "green", "blue"])] {
        names.iter().for_each(|name| head += &format!("property {kind} {name}\n"));
    }
    let mut bytes = (head + "end_header\n").into_bytes();
    for (position, color) in rows {
        position.iter().for_each(|value| bytes.extend((*value as f32).to_le_bytes()));
        bytes.extend(color);
    }
    bytes
}
