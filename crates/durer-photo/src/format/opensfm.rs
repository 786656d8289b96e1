//! Reads and writes OpenSfM's `reconstruction.json` and `tracks.csv`.
//!
//! Source: OpenSfM documentation, "Reconstruction file format", "Tracks" and "Geometric Models".

use super::TokenReader;
use crate::model::{axis_angle_of, rotation_of};
use crate::{Error, Lens, Observation, Point, Pose, Reconstruction, View};
use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Camera in OpenSfM's JSON, which is a lens shared by several shots.
#[derive(Serialize, Deserialize)]
struct Camera {
    projection_type: String,
    width: u32,
    height: u32,
    focal: f64,
    #[serde(default)]
    k1: f64,
    #[serde(default)]
    k2: f64,
}

/// Photograph in OpenSfM's JSON, with a pose and the name of its camera.
#[derive(Serialize, Deserialize)]
struct Shot {
    rotation: [f64; 3],
    translation: [f64; 3],
    camera: String,
}

/// Scene point in OpenSfM's JSON.
#[derive(Serialize, Deserialize)]
struct JsonPoint {
    color: [f64; 3],
    coordinates: [f64; 3],
}

/// One of the reconstructions in OpenSfM's JSON.
#[derive(Serialize, Deserialize)]
struct JsonReconstruction {
    cameras: BTreeMap<String, Camera>,
    shots: BTreeMap<String, Shot>,
    points: BTreeMap<String, JsonPoint>,
}

/// Reads a reconstruction, and its tracks if they are given. If the file contains several
/// reconstructions, the one with the most shots is used.
pub fn read(file: &str, json: &[u8], tracks: Option<(&str, &[u8])>) -> Result<Reconstruction, Error> {
    let parts: Vec<JsonReconstruction> = serde_json::from_slice(json)
        .map_err(|error| Error::at(file, (error.line(), error.column()), format!("invalid OpenSfM JSON: {error}")))?;
    let part = parts.into_iter().reduce(|best, next| if next.shots.len() > best.shots.len() { next } else { best });
    let part = part.ok_or_else(|| Error::in_file(file, "the file has no reconstruction"))?;
    let mut reconstruction = Reconstruction::default();
    let mut lens_of = BTreeMap::new();
    for (name, camera) in part.cameras {
        if camera.projection_type != "perspective" {
            let why = format!("cameras of type `{}` are not supported, only `perspective`", camera.projection_type);
            return Err(Error::in_file(file, why));
        }
        let size = [camera.width, camera.height];
        if size.contains(&0) || !(camera.focal.is_finite() && camera.focal > 0.0) {
            return Err(Error::in_file(file, format!("camera `{name}` has no valid width, height or focal length")));
        }
        let focal = camera.focal * f64::from(size[0].max(size[1]));
        lens_of.insert(name, reconstruction.lenses.len());
        reconstruction.lenses.push(Lens { distortion: [camera.k1, camera.k2], ..Lens::new(size, focal) });
    }
    for (name, shot) in part.shots {
        let lens = lens_of.get(&shot.camera);
        let lens = *lens.ok_or_else(|| Error::in_file(file, format!("camera `{}` does not exist", shot.camera)))?;
        let rotation = rotation_of(&Vector3::from(shot.rotation));
        let pose = Some(Pose { rotation, translation: Vector3::from(shot.translation) });
        reconstruction.views.push(View { name, lens, pose });
    }
    let mut point_of = BTreeMap::new();
    for (id, place) in part.points {
        point_of.insert(id, reconstruction.points.len());
        let color = place.color.map(|channel| channel.clamp(0.0, 255.0) as u8);
        reconstruction.points.push(Point { position: Vector3::from(place.coordinates), color, track: Vec::new() });
    }
    if let Some((file, bytes)) = tracks {
        let views: BTreeMap<String, usize> =
            reconstruction.views.iter().enumerate().map(|(i, view)| (view.name.clone(), i)).collect();
        read_tracks(file, bytes, &mut reconstruction, &views, &point_of)?;
    }
    Ok(reconstruction)
}

/// Adds the observations from `tracks.csv`. Rows with unknown photographs or points are skipped,
/// since some tracks have no point.
fn read_tracks(
    file: &str,
    bytes: &[u8],
    reconstruction: &mut Reconstruction,
    views: &BTreeMap<String, usize>,
    points: &BTreeMap<String, usize>,
) -> Result<(), Error> {
    let mut words = TokenReader::new(file, bytes)?;
    let (version, place) = words.word("OPENSFM_TRACKS_VERSION")?;
    if !["OPENSFM_TRACKS_VERSION_v1", "OPENSFM_TRACKS_VERSION_v2"].contains(&version) {
        return Err(Error::at(file, place, format!("`{version}` is not OPENSFM_TRACKS_VERSION_v1 or _v2")));
    }
    words.rest_of_line();
    while !words.is_at_end() {
        // Fields are separated by tabs, since names can contain spaces.
        let error = words.error("expected a row of tab-separated fields: photograph, track, feature, x, y, ...");
        let fields: Vec<&str> = words.rest_of_line().split('\t').collect();
        let number = |i: usize| fields.get(i)?.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        let feature = fields.get(2).and_then(|field| field.trim().parse().ok());
        let (Some(feature), Some(x), Some(y)) = (feature, number(3), number(4)) else { return Err(error) };
        let (Some(view), Some(point)) = (views.get(fields[0]), points.get(fields[1])) else { continue };
        let lens = reconstruction.lenses[reconstruction.views[*view].lens];
        let pixel = Vector2::from(lens.principal_point) + lens.longer_side() * Vector2::new(x, y);
        reconstruction.points[*point].track.push(Observation { view: *view, feature, pixel });
    }
    reconstruction.points.iter_mut().for_each(|point| point.track.sort_by_key(|observation| observation.view));
    Ok(())
}

/// Writes reconstruction.json and tracks.csv. Photographs without a pose are omitted.
pub fn write(reconstruction: &Reconstruction) -> Result<[String; 2], Error> {
    let name = |lens: usize| format!("camera {}", lens + 1);
    let mut part = JsonReconstruction { cameras: BTreeMap::new(), shots: BTreeMap::new(), points: BTreeMap::new() };
    for (i, lens) in reconstruction.lenses.iter().enumerate() {
        super::require_square_pixels(lens, "OpenSfM")?;
        let ([width, height], [k1, k2]) = (lens.size, lens.distortion);
        if width == 0 || height == 0 {
            return Err(Error::new("OpenSfM files need the size of the photographs: pass their folder"));
        }
        let focal = lens.focal / lens.longer_side();
        part.cameras.insert(name(i), Camera { projection_type: "perspective".into(), width, height, focal, k1, k2 });
    }
    for view in &reconstruction.views {
        let Some(pose) = &view.pose else { continue };
        let (rotation, translation) = (axis_angle_of(&pose.rotation).into(), pose.translation.into());
        part.shots.insert(view.name.clone(), Shot { rotation, translation, camera: name(view.lens) });
    }
    let mut tracks = String::from("OPENSFM_TRACKS_VERSION_v2\n");
    for (i, point) in reconstruction.points.iter().enumerate() {
        let place = JsonPoint { color: point.color.map(f64::from), coordinates: point.position.into() };
        part.points.insert(i.to_string(), place);
        for observation in &point.track {
            let view = &reconstruction.views[observation.view];
            let lens = reconstruction.lenses[view.lens];
            let p = (observation.pixel - Vector2::from(lens.principal_point)) / lens.longer_side();
            let [r, g, b] = point.color;
            // The size of the feature is unknown, so use OpenSfM's default of 0.001.
            let row = (&view.name, i, observation.feature, p.x, p.y);
            let _ =
                writeln!(tracks, "{}\t{}\t{}\t{}\t{}\t0.001\t{r}\t{g}\t{b}\t-1\t-1", row.0, row.1, row.2, row.3, row.4);
        }
    }
    let json = serde_json::to_string_pretty(&[part]).map_err(|error| Error::new(error.to_string()))?;
    Ok([json + "\n", tracks])
}
