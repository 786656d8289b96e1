//! Reads and writes COLMAP's tables as text files.

use super::colmap::{ColmapTables, ImageRow, MODELS, PointRow, error, features, insert_unique, lens, parameters};
use super::{TokenReader, joined};
use crate::model::quaternion_of;
use crate::{Error, Reconstruction};
use std::fmt::Write;

/// Reads the contents of cameras.txt, images.txt, and points3D.txt. Each is given with its file
/// name.
pub fn read(folder: &str, [cameras, images, points]: [(&str, &[u8]); 3]) -> Result<Reconstruction, Error> {
    let mut tables = ColmapTables::default();
    let mut words = TokenReader::in_rows(cameras.0, cameras.1)?;
    while words.next_line('#') {
        let id = words.parse("a camera's id")?;
        let (name, place) = words.word("a camera's model")?;
        let known = MODELS.iter().position(|model| model.0 == name);
        let names = MODELS.map(|model| model.0).join(", ");
        let model = known.ok_or_else(|| {
            Error::at(
                cameras.0,
                place,
                format!("the camera model `{name}` is not supported; supported models: {names}"),
            )
        })?;
        let size = [words.parse("a width")?, words.parse("a height")?];
        let numbers = (0..MODELS[model].2).map(|_| words.number("a parameter")).collect::<Result<Vec<_>, _>>()?;
        let lens = lens(model, size, &numbers).map_err(|why| Error::at(cameras.0, place, why))?;
        words.end_of_row("a camera's id, model, width, height and parameters")?;
        insert_unique(&mut tables.cameras, id, lens).map_err(|why| words.error(why))?;
    }
    let mut words = TokenReader::in_rows(images.0, images.1)?;
    while words.next_line('#') {
        let id = words.parse("an image's id")?;
        let (quaternion, translation) = (words.numbers("a quaternion")?, words.numbers("a translation")?);
        let camera = words.parse("a camera's id")?;
        words.is_at_end_of_line();
        let name = words.rest_of_line().to_string();
        // The second line of an image can be empty. It begins after the end of the first line.
        let mut list = Vec::new();
        words.skip_line_end();
        while !words.is_at_end_of_line() {
            list.push(words.numbers("a feature's position")?);
            words.parse::<i64>("a point's id")?;
        }
        let image = ImageRow { quaternion, translation, camera, name, features: list };
        insert_unique(&mut tables.images, id, image).map_err(|why| words.error(why))?;
    }
    let mut words = TokenReader::in_rows(points.0, points.1)?;
    while words.next_line('#') {
        let id = words.parse("a point's id")?;
        let position = words.numbers("a position")?;
        let mut color = [0; 3];
        for channel in &mut color {
            *channel = words.parse("a colour from 0 to 255")?;
        }
        words.number("an error")?;
        let mut track = Vec::new();
        while !words.is_at_end_of_line() {
            track.push((words.parse("an image's id")?, words.parse("a feature's number")?));
        }
        insert_unique(&mut tables.points, id, PointRow { position, color, track }).map_err(|why| words.error(why))?;
    }
    tables.into_reconstruction(folder)
}

/// Writes cameras.txt, images.txt, and points3D.txt. Photographs without a pose are omitted.
pub fn write(reconstruction: &Reconstruction) -> [String; 3] {
    let (features, numbers) = features(reconstruction);
    let mut cameras = String::from("# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n");
    for (i, lens) in reconstruction.lenses.iter().enumerate() {
        let (model, p) = parameters(lens);
        let [width, height] = lens.size;
        let _ = writeln!(cameras, "{} {} {width} {height} {}", i + 1, MODELS[model].0, joined(p));
    }
    let mut images =
        String::from("# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n# POINTS2D[] as (X, Y, POINT3D_ID)\n");
    for (i, view) in reconstruction.views.iter().enumerate() {
        let Some(pose) = &view.pose else { continue };
        let (q, t) = (joined(quaternion_of(&pose.rotation)), joined(pose.translation.iter()));
        let _ = writeln!(images, "{} {q} {t} {} {}", i + 1, view.lens + 1, view.name);
        let list = features[i].iter().map(|(pixel, id)| format!("{} {} {id}", pixel.x, pixel.y));
        let _ = writeln!(images, "{}", joined(list));
    }
    let mut points = String::from("# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n");
    for (i, point) in reconstruction.points.iter().enumerate() {
        let posed = point
            .track
            .iter()
            .zip(&numbers[i])
            .filter(|(observation, _)| reconstruction.views[observation.view].pose.is_some());
        let track = joined(posed.map(|(observation, number)| format!("{} {number}", observation.view + 1)));
        let (position, color, error) =
            (joined(point.position.iter()), joined(point.color), error(reconstruction, point));
        let _ = writeln!(points, "{} {position} {color} {error} {track}", i + 1);
    }
    [cameras, images, points]
}
