//! fSpy projects (`.fspy`) and exported cameras (`.json`), which give the camera of a single
//! photograph based on vanishing lines.
//!
//! A project consists of the word `fspy`, a version, the lengths of the JSON state and of the
//! photograph, the state, and the photograph. Coordinates range from 0 to 1 across the photograph,
//! with y down. An exported camera uses coordinates in the image plane instead. There, the longer
//! side ranges from -1 to 1, with y up, and the camera looks along -z.
//!
//! Source: documentation of fSpy-Blender, *The fSpy project file format*.

use super::colmap_binary::ByteReader;
use super::flip_camera_axes;
use crate::known::{Axis, VanishingLines};
use crate::{Error, Lens, Pose, Reconstruction, View};
use nalgebra::{Matrix3, Vector2, Vector3};
use serde::Deserialize;
use serde_json::Value;

/// 4x4 matrix in the JSON of an exported camera, stored by rows.
#[derive(Deserialize)]
struct JsonMatrix {
    rows: [[f64; 4]; 4],
}

/// Point in fSpy's JSON.
#[derive(Deserialize)]
struct JsonPoint {
    x: f64,
    y: f64,
}

/// JSON data of a camera exported by fSpy.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ExportedCamera {
    principal_point: JsonPoint,
    view_transform: JsonMatrix,
    relative_focal_length: f64,
    image_width: u32,
    image_height: u32,
}

/// Reads a camera exported by fSpy.
pub fn read_camera(file: &str, json: &[u8]) -> Result<Reconstruction, Error> {
    let camera: ExportedCamera = serde_json::from_slice(json)
        .map_err(|error| Error::at(file, (error.line(), error.column()), format!("invalid fSpy JSON: {error}")))?;
    let size = [camera.image_width, camera.image_height];
    let half = f64::from(size[0].max(size[1])) / 2.0;
    let mut lens = Lens::new(size, camera.relative_focal_length * half);
    lens.principal_point[0] += half * camera.principal_point.x;
    lens.principal_point[1] -= half * camera.principal_point.y;
    let rows = camera.view_transform.rows;
    let pose = Pose { rotation: Matrix3::from_fn(|i, j| rows[i][j]), translation: Vector3::from_fn(|i, _| rows[i][3]) };
    let view = View { name: file.to_string(), lens: 0, pose: Some(flip_camera_axes(&pose)) };
    Ok(Reconstruction { lenses: vec![lens], views: vec![view], points: Vec::new() })
}

/// Reads a project. Returns its vanishing lines and origin, and the bytes of the photograph.
pub fn read_project<'b>(file: &'b str, content: &'b [u8]) -> Result<(VanishingLines, &'b [u8]), Error> {
    let mut bytes = ByteReader::new(file, content);
    if bytes.take(4).ok() != Some(b"fspy") {
        return Err(Error::in_file(file, "the file is not an fSpy project"));
    }
    let version = bytes.u32()?;
    if version != 1 {
        return Err(bytes.error(format!("the project's version is {version}; only version 1 is supported")));
    }
    let (state, photograph) = (bytes.u32()? as usize, bytes.u32()? as usize);
    let state = bytes.take(state)?;
    let photograph = bytes.take(photograph)?;
    let state: Value = serde_json::from_slice(state)
        .map_err(|error| Error::in_file(file, format!("invalid JSON in the project's state: {error}")))?;
    if state["globalSettings"]["calibrationMode"] != "TwoVanishingPoints" {
        return Err(Error::in_file(
            file,
            "only projects with two vanishing points determine a camera from lines alone",
        ));
    }
    let size = crate::photo::size(file, photograph)?;
    let [width, height] = size.map(f64::from);
    let place = |value: &Value| Some(Vector2::new(value["x"].as_f64()? * width, value["y"].as_f64()? * height));
    let lines = |value: &Value| -> Option<Vec<[Vector2<f64>; 2]>> {
        let segments = value["lineSegments"].as_array()?.iter();
        segments.map(|segment| Some([place(&segment[0])?, place(&segment[1])?])).collect()
    };
    let axis = |value: &Value| Axis::parse(value.as_str()?);
    let (base, two) = (&state["controlPointsStateBase"], &state["controlPointsState2VP"]);
    let settings = &state["calibrationSettingsBase"];
    let center = match state["calibrationSettings2VP"]["principalPointMode"].as_str() {
        Some("Manual") => place(&base["principalPoint"]),
        Some("Default") => Some(Vector2::new(width / 2.0, height / 2.0)),
        _ => return Err(Error::in_file(file, "a principal point from three vanishing points is not supported")),
    };
    let first = lines(&base["firstVanishingPoint"]);
    let second = match state["calibrationSettings2VP"]["quadModeEnabled"].as_bool() {
        // In quad mode, the lines of the second pair connect the ends of the first pair.
        Some(true) => first.as_ref().map(|lines| vec![[lines[0][0], lines[1][0]], [lines[0][1], lines[1][1]]]),
        _ => lines(&two["secondVanishingPoint"]),
    };
    let all = || {
        Some(VanishingLines {
            size,
            center: center?,
            origin: place(&base["origin"])?,
            axes: [axis(&settings["firstVanishingPointAxis"])?, axis(&settings["secondVanishingPointAxis"])?],
            lines: [first?, second?],
        })
    };
    Ok((
        all().ok_or_else(|| Error::in_file(file, "the project's state lacks vanishing lines, axes or the origin"))?,
        photograph,
    ))
}
