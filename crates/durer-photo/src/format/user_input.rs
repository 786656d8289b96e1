//! Input files that users write by hand to list points, lines, or control points. Each line is a
//! row, and comments begin with `#`.

use super::TokenReader;
use crate::known::{Axis, ControlPoint, PointPixelPair, VanishingLines};
use crate::{Error, Observation};
use nalgebra::{Vector2, Vector3};

/// Reads world points and their pixels from rows of the form `X Y Z u v`.
pub fn read_points(file: &str, bytes: &[u8]) -> Result<Vec<PointPixelPair>, Error> {
    let mut words = TokenReader::in_rows(file, bytes)?;
    let mut pairs = Vec::new();
    while words.next_line('#') {
        let [x, y, z, u, v] = words.numbers("one of X Y Z u v")?;
        words.end_of_row("X Y Z u v")?;
        pairs.push((Vector3::new(x, y, z), Vector2::new(u, v)));
    }
    Ok(pairs)
}

/// Reads vanishing lines from rows of the form `x u1 v1 u2 v2`, and the origin from one row `origin
/// u v`. The first word of a row, such as `x` or `-y`, is the world axis that points to the
/// vanishing point. The file must contain two axes with at least two lines each.
pub fn read_lines(file: &str, bytes: &[u8], size: [u32; 2]) -> Result<VanishingLines, Error> {
    let mut words = TokenReader::in_rows(file, bytes)?;
    let center = Vector2::from(size.map(|side| f64::from(side) / 2.0));
    let (mut sets, mut origin): (Vec<(Axis, Vec<_>)>, _) = (Vec::new(), center);
    while words.next_line('#') {
        let error = words.error("a row must begin with x, y, z, -x, -y, -z or origin");
        let (name, _) = words.word("an axis")?;
        if name == "origin" {
            origin = words.numbers("one of u v")?.into();
            words.end_of_row("origin u v")?;
            continue;
        }
        let axis = Axis::parse(name).ok_or(error)?;
        let [a, b, c, d] = words.numbers("one of u1 v1 u2 v2")?;
        words.end_of_row("an axis u1 v1 u2 v2")?;
        let line = [Vector2::new(a, b), Vector2::new(c, d)];
        match sets.iter_mut().find(|set| set.0 == axis) {
            Some(set) => set.1.push(line),
            None => sets.push((axis, vec![line])),
        }
    }
    let count = sets.len();
    let [one, two] = <[_; 2]>::try_from(sets).map_err(|_| {
        Error::in_file(file, format!("the file must contain lines of two axes, but has lines of {count}"))
    })?;
    Ok(VanishingLines { size, center, origin, axes: [one.0, two.0], lines: [one.1, two.1] })
}

/// Reads control points from rows of the form `X Y Z photograph u v photograph u v ...`. Names of
/// photographs must not contain spaces.
pub fn read_control(file: &str, bytes: &[u8], names: &[&str]) -> Result<Vec<ControlPoint>, Error> {
    let mut words = TokenReader::in_rows(file, bytes)?;
    let mut points = Vec::new();
    while words.next_line('#') {
        let position = words.numbers("one of X Y Z")?.into();
        let mut observations: Vec<Observation> = Vec::new();
        while !words.is_at_end_of_line() {
            let (name, place) = words.word("a photograph")?;
            let fail = |why: &str| Error::at(file, place, format!("{why} `{name}`"));
            let view = names.iter().position(|known| *known == name);
            let view = view.ok_or_else(|| fail("unknown photograph"))?;
            if observations.iter().any(|other| other.view == view) {
                return Err(fail("the row repeats the photograph"));
            }
            observations.push(Observation { view, feature: 0, pixel: words.numbers("one of u v")?.into() });
        }
        points.push((position, observations));
    }
    Ok(points)
}
