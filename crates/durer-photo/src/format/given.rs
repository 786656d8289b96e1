//! What people write by hand: points, lines and control points, a row a line, with `#` before comments.

use super::Words;
use crate::resect::{Axis, Pair, VanishingLines};
use crate::{Error, Observation, Reconstruction};
use nalgebra::{Vector2, Vector3};

/// Points of the world and their pixels: rows `X Y Z u v`.
pub fn read_points(file: &str, bytes: &[u8]) -> Result<Vec<Pair>, Error> {
    let mut words = Words::new(file, bytes)?;
    let mut pairs = Vec::new();
    while words.next_line('#') {
        let [x, y, z, u, v] = words.numbers("of a row X Y Z u v")?;
        if !words.is_at_end_of_line() {
            return Err(words.error("a row is X Y Z u v: nothing follows"));
        }
        pairs.push((Vector3::new(x, y, z), Vector2::new(u, v)));
    }
    Ok(pairs)
}

/// Vanishing lines: rows `x u1 v1 u2 v2`, where `x`, `-y` and so on is the axis that leads towards the vanishing point, and one row
/// `origin u v`. Two axes must be named, each by two lines or more.
pub fn read_lines(file: &str, bytes: &[u8], size: [u32; 2]) -> Result<VanishingLines, Error> {
    let mut words = Words::new(file, bytes)?;
    let center = Vector2::from(size.map(|side| f64::from(side) / 2.0));
    let (mut sets, mut origin): (Vec<(Axis, Vec<_>)>, _) = (Vec::new(), center);
    while words.next_line('#') {
        let error = words.error("a row begins with x, y, z, -x, -y, -z or origin");
        let (name, _) = words.word("an axis")?;
        if name == "origin" {
            origin = words.numbers("the origin's pixel")?.into();
            continue;
        }
        let axis = Axis::parse(name).ok_or(error)?;
        let [a, b, c, d] = words.numbers("of a line's two pixels")?;
        let line = [Vector2::new(a, b), Vector2::new(c, d)];
        match sets.iter_mut().find(|set| set.0 == axis) {
            Some(set) => set.1.push(line),
            None => sets.push((axis, vec![line])),
        }
    }
    let count = sets.len();
    let [one, two] = <[_; 2]>::try_from(sets)
        .map_err(|_| Error::of(file, format!("lines of two axes are needed, and here are {count}")))?;
    Ok(VanishingLines { size, center, origin, axes: [one.0, two.0], lines: [one.1, two.1] })
}

/// A place of the world, and where photographs see it.
pub type Control = (Vector3<f64>, Vec<Observation>);

/// Control points: rows `X Y Z photograph u v photograph u v ...`; names without blanks.
pub fn read_control(file: &str, bytes: &[u8], all: &Reconstruction) -> Result<Vec<Control>, Error> {
    let mut words = Words::new(file, bytes)?;
    let mut points = Vec::new();
    while words.next_line('#') {
        let position = words.numbers("of a place X Y Z")?.into();
        let mut seen = Vec::new();
        while !words.is_at_end_of_line() {
            let error = words.error("there is no such photograph");
            let (name, _) = words.word("a photograph")?;
            let view = all.views.iter().position(|view| view.name == name).ok_or(error)?;
            seen.push(Observation { view, feature: 0, pixel: words.numbers("a pixel")?.into() });
        }
        points.push((position, seen));
    }
    Ok(points)
}
