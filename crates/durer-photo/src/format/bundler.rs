//! Bundler's `.out` files in versions 0.3 and 0.4, which contain the cameras and points of the
//! Photo Tourism program.
//!
//! Source: Snavely, *Bundler v0.4 User's Manual*, 2010, "Output format and scene representation".

use super::{TokenReader, flip_camera_axes, is_rotation, joined};
use crate::{Error, Lens, Observation, Point, Pose, Reconstruction, View};
use nalgebra::{Matrix3, Vector2, Vector3};
use std::fmt::Write;

/// Reads a Bundler file. The format contains no image sizes, so pixels are relative to the image
/// centre until [`Reconstruction::set_image`] sets the size.
pub fn read(file: &str, bytes: &[u8]) -> Result<Reconstruction, Error> {
    let mut words = TokenReader::new(file, bytes)?;
    if !words.next_line('#') {
        return Err(words.error("the file is empty"));
    }
    let cameras = words.count("the number of cameras", 30)?;
    let points = words.count("the number of points", 20)?;
    let mut reconstruction = Reconstruction::default();
    for number in 0..cameras {
        let start = words.next_position();
        let [focal, k1, k2] = words.numbers("focal length and distortion")?;
        if focal < 0.0 {
            return Err(Error::at(file, start, "a focal length must be positive, or 0 for an unknown camera"));
        }
        let start = words.next_position();
        let rotation = Matrix3::from_row_slice(&words.numbers::<9>("the rotation")?);
        if focal > 0.0 && !is_rotation(&rotation) {
            return Err(Error::at(file, start, "the nine numbers do not form a rotation matrix"));
        }
        let translation = Vector3::from(words.numbers::<3>("the translation")?);
        let pose = (focal != 0.0).then(|| flip_camera_axes(&Pose { rotation, translation }));
        reconstruction.lenses.push(Lens { distortion: [k1, k2], ..Lens::new([0, 0], focal) });
        reconstruction.views.push(View { name: number.to_string(), lens: number, pose });
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
        reconstruction.points.push(Point { position, color, track });
    }
    words.end()?;
    Ok(reconstruction)
}

/// Writes a Bundler file in version 0.3.
pub fn write(reconstruction: &Reconstruction) -> Result<Vec<u8>, Error> {
    let mut text = format!("# Bundle file v0.3\n{} {}\n", reconstruction.views.len(), reconstruction.points.len());
    for view in &reconstruction.views {
        let lens = reconstruction.lenses[view.lens];
        super::require_square_pixels(&lens, "Bundler")?;
        let Some(pose) = &view.pose else {
            text.push_str(&"0 0 0\n".repeat(5));
            continue;
        };
        let Pose { rotation, translation } = flip_camera_axes(pose);
        let _ = writeln!(text, "{:e} {:e} {:e}", lens.focal, lens.distortion[0], lens.distortion[1]);
        for row in rotation.row_iter().map(|row| joined(row.iter())) {
            let _ = writeln!(text, "{row}");
        }
        let _ = writeln!(text, "{}", joined(translation.iter()));
    }
    for point in &reconstruction.points {
        let _ = writeln!(text, "{}\n{}", joined(point.position.iter()), joined(point.color));
        let _ = write!(text, "{}", point.track.len());
        for observation in &point.track {
            let center = reconstruction.lenses[reconstruction.views[observation.view].lens].principal_point;
            let (x, y) = (observation.pixel.x - center[0], center[1] - observation.pixel.y);
            let _ = write!(text, " {} {} {x} {y}", observation.view, observation.feature);
        }
        text.push('\n');
    }
    Ok(text.into_bytes())
}
