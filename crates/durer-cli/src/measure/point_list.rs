//! Reads lists of measuring points.

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::report;
use durer::format::folder::FolderSource;
use durer::math::Vec3;
use std::path::Path;

/// Maximum size of a list, in bytes.
const MAX_BYTES: u64 = 256 << 20;

/// Reads lines with `x,y,z` or `x,y,z,nx,ny,nz`, separated by commas, semicolons or blanks. A first
/// line with names is skipped, and so are empty lines and lines that begin with `#`.
pub fn read(path: &Path, registry: &mut FileRegistry) -> Result<Vec<(Vec3, Option<Vec3>)>, Failure> {
    registry.register_input(path)?;
    let name = path.display().to_string();
    let bytes = FolderSource::new(".").budget(MAX_BYTES).read_path(path, &name).map_err(report::unreadable)?;
    let text = str::from_utf8(&bytes).map_err(|error| invalid_input(format!("cannot read `{name}`: {error}")))?;
    parse(text).map_err(|error| invalid_input(format!("{name}:{error}")))
}

fn parse(text: &str) -> Result<Vec<(Vec3, Option<Vec3>)>, String> {
    let (mut points, mut is_first) = (Vec::new(), true);
    for (number, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let words: Vec<&str> = match line.contains([',', ';', '\t']) {
            true => line.split([',', ';', '\t']).map(str::trim).collect(),
            false => line.split_whitespace().collect(),
        };
        let numbers: Option<Vec<f32>> =
            words.iter().map(|word| word.parse().ok().filter(|number: &f32| number.is_finite())).collect();
        let is_heading = std::mem::take(&mut is_first) && words.iter().all(|word| word.parse::<f32>().is_err());
        match numbers.as_deref() {
            Some([x, y, z]) => points.push((Vec3::new(*x, *y, *z), None)),
            Some([x, y, z, a, b, c]) => match Vec3::new(*a, *b, *c).try_normalize() {
                Some(normal) => points.push((Vec3::new(*x, *y, *z), Some(normal))),
                None => return Err(format!("{}:1: the normal must not be 0,0,0", number + 1)),
            },
            None if is_heading => {}
            _ => return Err(format!("{}:1: expected x,y,z or x,y,z,nx,ny,nz, found `{line}`", number + 1)),
        }
    }
    if points.is_empty() { Err("1:1: the list has no points".into()) } else { Ok(points) }
}

#[cfg(test)]
mod tests {
    use super::parse;
    use durer::math::Vec3;

    #[test]
    fn lists_of_points() {
        let list = parse("\u{feff}x;y;z\r\n1;2;3\n\n# desk\n0, 0.5, -1, 0, 0, 2\n").unwrap();
        assert_eq!(list, [(Vec3::new(1.0, 2.0, 3.0), None), (Vec3::new(0.0, 0.5, -1.0), Some(Vec3::Z))]);
        let rtrace = parse("2 2 0.8  0 0 1\n2 2 0.9 0 0 1\n").unwrap();
        assert_eq!(rtrace[1], (Vec3::new(2.0, 2.0, 0.9), Some(Vec3::Z)));
        for (text, error) in [
            ("x,y,z\nsome words", "2:1: expected x,y,z or x,y,z,nx,ny,nz, found `some words`"),
            ("", "1:1: the list has no points"),
            ("1,2,3\n1,2", "2:1: expected x,y,z or x,y,z,nx,ny,nz, found `1,2`"),
            ("1,2,x", "1:1: expected x,y,z"),
            ("1,2,inf", "1:1: expected x,y,z"),
            ("1,2,3\nx,y,z", "2:1: expected x,y,z"),
            ("1,2,3,0,0,0", "1:1: the normal must not be 0,0,0"),
        ] {
            assert!(parse(text).unwrap_err().starts_with(error), "{text}: {:?}", parse(text));
        }
    }
}
