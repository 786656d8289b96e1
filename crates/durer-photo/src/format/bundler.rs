//! Bundler's `.out` files, versions 0.3 and 0.4: the cameras and points of the Photo Tourism
//! program.
//!
//! Source: Snavely, *Bundler v0.4 User's Manual*, 2010, "Output format and scene representation".

use super::{Words, is_rotation, joined, opposite};
use crate::{Error, Lens, Observation, Point, Pose, Reconstruction, View};
use nalgebra::{Matrix3, Vector2, Vector3};
use std::fmt::Write;

/// Reads a Bundler file. The format contains no image sizes: pixels are relative to the image
/// centre until [`Reconstruction::set_picture`] sets the size.
pub fn read(file: &str, bytes: &[u8]) -> Result<Reconstruction, Error> {
    let mut words = Words::new(file, bytes)?;
    if !words.next_line('#') {
        return Err(words.error("the file is empty"));
    }
    let cameras = words.count("the number of cameras", 30)?;
    let points = words.count("the number of points", 20)?;
    let mut all = Reconstruction::default();
    for number in 0..cameras {
        let start = words.next_place();
        let [focal, k1, k2] = words.numbers("focal length and distortion")?;
        if focal < 0.0 {
            return Err(Error::at(file, start, "a focal length must be positive, or 0 for an unknown camera"));
        }
        let start = words.next_place();
        let rotation = Matrix3::from_row_slice(&words.numbers::<9>("the rotation")?);
        if focal > 0.0 && !is_rotation(&rotation) {
            return Err(Error::at(file, start, "these nine numbers are not a rotation"));
        }
        let translation = Vector3::from(words.numbers::<3>("the translation")?);
        let pose = (focal != 0.0).then(|| opposite(&Pose { rotation, translation }));
        all.lenses.push(Lens { radial: [k1, k2], ..Lens::new([0, 0], focal) });
        all.views.push(View { name: number.to_string(), lens: number, pose });
    }
    for _ in 0..points {
        let position = Vector3::from(words.numbers::<3>("a position")?);
        let mut color = [0; 3];
        for channel in &mut color {
            *channel = words.parse("a colour from 0 to 255")?;
        }
        let mut track = Vec::new();
        for _ in 0..words.count("the number of observations", 8)? {
            let view = words.index("a camera's number", cameras)?;
            let feature = words.parse("a feature's number")?;
            let [x, y] = words.numbers("a pixel position")?;
            track.push(Observation { view, feature, pixel: Vector2::new(x, -y) });
        }
        all.points.push(Point { position, color, track });
    }
    words.end()?;
    Ok(all)
}

/// Writes a Bundler file, version 0.3.
pub fn write(all: &Reconstruction) -> Result<Vec<u8>, Error> {
    let mut text = format!("# Bundle file v0.3\n{} {}\n", all.views.len(), all.points.len());
    for view in &all.views {
        let lens = all.lenses[view.lens];
        super::square(&lens, "Bundler")?;
        let Some(pose) = &view.pose else {
            text.push_str(&"0 0 0\n".repeat(5));
            continue;
        };
        let Pose { rotation, translation } = opposite(pose);
        let _ = writeln!(text, "{:e} {:e} {:e}", lens.focal, lens.radial[0], lens.radial[1]);
        for row in rotation.row_iter().map(|row| joined(row.iter())) {
            let _ = writeln!(text, "{row}");
        }
        let _ = writeln!(text, "{}", joined(translation.iter()));
    }
    for point in &all.points {
        let _ = writeln!(text, "{}\n{}", joined(point.position.iter()), joined(point.color));
        let _ = write!(text, "{}", point.track.len());
        for seen in &point.track {
            let center = all.lenses[all.views[seen.view].lens].center;
            let (x, y) = (seen.pixel.x - center[0], center[1] - seen.pixel.y);
            let _ = write!(text, " {} {} {x} {y}", seen.view, seen.feature);
        }
        text.push('\n');
    }
    Ok(text.into_bytes())
}
