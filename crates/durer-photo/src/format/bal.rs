//! Problem files in the format of *Bundle Adjustment in the Large* (BAL), a benchmark for solvers.
//!
//! Source: Agarwal, Snavely, Seitz, Szeliski, *Bundle Adjustment in the Large*, ECCV 2010, and the
//! web page with its data.

use super::{TokenReader, flip_camera_axes, joined};
use crate::model::{axis_angle_of, rotation_of};
use crate::{Error, Lens, Observation, Point, Pose, Reconstruction, View};
use nalgebra::{Vector2, Vector3};
use std::fmt::Write;

/// Reads a BAL problem. The format contains neither image sizes nor colours, so pixels are relative
/// to the image centre, and points are grey.
pub fn read(file: &str, bytes: &[u8]) -> Result<Reconstruction, Error> {
    let mut words = TokenReader::new(file, bytes)?;
    let cameras = words.count("the number of cameras", 18)?;
    let points = words.count("the number of points", 6)?;
    let observations = words.count("the number of observations", 8)?;
    let mut tracks = vec![Vec::new(); points];
    for _ in 0..observations {
        let view = words.index("a camera's number", cameras)?;
        let track: &mut Vec<Observation> = &mut tracks[words.index("a point's number", points)?];
        let [x, y] = words.numbers("a pixel position")?;
        track.push(Observation { view, feature: track.len(), pixel: Vector2::new(x, -y) });
    }
    let mut reconstruction = Reconstruction::default();
    for number in 0..cameras {
        let start = words.next_position();
        let [rx, ry, rz, x, y, z, focal, k1, k2] = words.numbers("a camera's nine parameters")?;
        if focal == 0.0 {
            return Err(Error::at(file, start, "the camera's focal length (its seventh parameter) is 0"));
        }
        let rotation = rotation_of(&Vector3::new(rx, ry, rz));
        let pose = flip_camera_axes(&Pose { rotation, translation: Vector3::new(x, y, z) });
        reconstruction.lenses.push(Lens { distortion: [k1, k2], ..Lens::new([0, 0], focal) });
        reconstruction.views.push(View { name: number.to_string(), lens: number, pose: Some(pose) });
    }
    for track in tracks {
        let position = Vector3::from(words.numbers::<3>("a point's position")?);
        reconstruction.points.push(Point { position, color: [128; 3], track });
    }
    words.end()?;
    Ok(reconstruction)
}

/// Writes a BAL problem. Photographs without a pose are omitted.
pub fn write(reconstruction: &Reconstruction) -> Result<Vec<u8>, Error> {
    let mut numbers = vec![None; reconstruction.views.len()];
    let mut cameras = String::new();
    let mut count = 0;
    for (number, view) in numbers.iter_mut().zip(&reconstruction.views) {
        let Some(pose) = &view.pose else { continue };
        let lens = reconstruction.lenses[view.lens];
        super::require_square_pixels(&lens, "BAL")?;
        let pose = flip_camera_axes(pose);
        let all = axis_angle_of(&pose.rotation).iter().chain(pose.translation.iter()).copied().collect::<Vec<_>>();
        for value in all.into_iter().chain([lens.focal, lens.distortion[0], lens.distortion[1]]) {
            let _ = writeln!(cameras, "{value:e}");
        }
        *number = Some(count);
        count += 1;
    }
    let (mut text, mut observations) = (String::new(), 0);
    for (i, point) in reconstruction.points.iter().enumerate() {
        for observation in &point.track {
            let Some(number) = numbers[observation.view] else { continue };
            let center = reconstruction.lenses[reconstruction.views[observation.view].lens].principal_point;
            let _ =
                writeln!(text, "{number} {i} {} {}", observation.pixel.x - center[0], center[1] - observation.pixel.y);
            observations += 1;
        }
    }
    text.insert_str(0, &format!("{count} {} {observations}\n", reconstruction.points.len()));
    text.push_str(&cameras);
    reconstruction
        .points
        .iter()
        .for_each(|point| text.push_str(&(joined(point.position.iter()).replace(' ', "\n") + "\n")));
    Ok(text.into_bytes())
}
