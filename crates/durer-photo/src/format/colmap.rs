//! COLMAP folders with `cameras`, `images`, and `points3D`. This module is shared by the
//! [text](super::colmap_text) and [binary](super::colmap_binary) formats.
//!
//! Source: Schönberger, *COLMAP* manual, "Output Format" and "Camera Models".

use crate::model::rotation_of_quaternion;
use crate::{Error, Lens, Observation, Point, Pose, Reconstruction, View};
use nalgebra::{Vector2, Vector3};
use std::collections::BTreeMap;
use std::fmt::Display;

/// Supported camera models, each with its name, its number in binary files, and its number of
/// parameters.
pub const MODELS: [(&str, i32, usize); 5] =
    [("SIMPLE_PINHOLE", 0, 3), ("PINHOLE", 1, 4), ("SIMPLE_RADIAL", 2, 4), ("RADIAL", 3, 5), ("OPENCV", 4, 8)];

/// Creates a lens from the parameters of a camera model.
pub fn lens(model: usize, size: [u32; 2], p: &[f64]) -> Result<Lens, String> {
    let (focal, vertical, principal_point, distortion) = match model {
        0 => (p[0], p[0], [p[1], p[2]], [0.0; 2]),
        1 => (p[0], p[1], [p[2], p[3]], [0.0; 2]),
        2 => (p[0], p[0], [p[1], p[2]], [p[3], 0.0]),
        3 => (p[0], p[0], [p[1], p[2]], [p[3], p[4]]),
        _ if p[6] != 0.0 || p[7] != 0.0 => {
            return Err("tangential distortion is not supported: p1 and p2 must be 0".into());
        }
        _ => (p[0], p[1], [p[2], p[3]], [p[4], p[5]]),
    };
    if focal <= 0.0 || vertical <= 0.0 {
        return Err("focal lengths must be positive".into());
    }
    Ok(Lens { size, focal, aspect: vertical / focal, principal_point, distortion })
}

/// Converts a lens to an index into [`MODELS`] and the parameters of that model.
pub fn parameters(lens: &Lens) -> (usize, Vec<f64>) {
    let ([x, y], [k1, k2]) = (lens.principal_point, lens.distortion);
    match lens.aspect {
        1.0 => (3, vec![lens.focal, x, y, k1, k2]),
        aspect => (4, vec![lens.focal, lens.focal * aspect, x, y, k1, k2, 0.0, 0.0]),
    }
}

/// Row of COLMAP's `images` table, with the pose, name, and features of one photograph.
pub struct ImageRow {
    pub quaternion: [f64; 4],
    pub translation: [f64; 3],
    pub camera: u32,
    pub name: String,
    /// Positions of the features in pixels.
    pub features: Vec<[f64; 2]>,
}

/// Row of COLMAP's `points3D` table, with a point and its observations.
pub struct PointRow {
    pub position: [f64; 3],
    pub color: [u8; 3],
    /// Pairs of an image id and a feature number.
    pub track: Vec<(u32, usize)>,
}

/// Contents of a COLMAP folder, with cameras, images, and points stored by their ids in the files.
#[derive(Default)]
pub struct ColmapTables {
    pub cameras: BTreeMap<u32, Lens>,
    pub images: BTreeMap<u32, ImageRow>,
    pub points: BTreeMap<u64, PointRow>,
}

/// Inserts a row into a table, or returns an error if the id is already present.
pub fn insert_unique<Id: Ord + Copy + Display, T>(into: &mut BTreeMap<Id, T>, id: Id, row: T) -> Result<(), String> {
    match into.insert(id, row) {
        None => Ok(()),
        Some(_) => Err(format!("the id {id} occurs twice")),
    }
}

impl ColmapTables {
    /// Converts the tables to a reconstruction. Ids are replaced by consecutive indices in the same
    /// order.
    pub fn into_reconstruction(self, file: &str) -> Result<Reconstruction, Error> {
        let fail = |why: String| Error::in_file(file, why);
        let lens_of: BTreeMap<u32, usize> = self.cameras.keys().enumerate().map(|(i, id)| (*id, i)).collect();
        let view_of: BTreeMap<u32, usize> = self.images.keys().enumerate().map(|(i, id)| (*id, i)).collect();
        let mut reconstruction = Reconstruction { lenses: self.cameras.into_values().collect(), ..Default::default() };
        for (id, image) in &self.images {
            let lens = *lens_of
                .get(&image.camera)
                .ok_or_else(|| fail(format!("image {id} refers to camera {}, which does not exist", image.camera)))?;
            if image.quaternion.iter().all(|c| *c == 0.0) {
                return Err(fail(format!("image {id} has a quaternion of length 0")));
            }
            let rotation = rotation_of_quaternion(image.quaternion);
            let pose = Some(Pose { rotation, translation: Vector3::from(image.translation) });
            reconstruction.views.push(View { name: image.name.clone(), lens, pose });
        }
        for (id, row) in self.points {
            let observation_of = |(image, feature): (u32, usize)| {
                let pixel = self.images.get(&image).and_then(|image| image.features.get(feature));
                let pixel = pixel.ok_or_else(|| fail(format!("point {id}: image {image} has no feature {feature}")))?;
                Ok(Observation { view: view_of[&image], feature, pixel: Vector2::from(*pixel) })
            };
            let track = row.track.into_iter().map(observation_of).collect::<Result<_, Error>>()?;
            reconstruction.points.push(Point { position: Vector3::from(row.position), color: row.color, track });
        }
        Ok(reconstruction)
    }
}

/// Features of one photograph that observe a point. Each has a pixel and the id of the point.
pub type Features = Vec<(Vector2<f64>, usize)>;

/// Returns the features of each photograph in the order in which they are written. Also returns the
/// feature numbers of the observations of each point.
pub fn features(reconstruction: &Reconstruction) -> (Vec<Features>, Vec<Vec<usize>>) {
    let mut features = vec![Vec::new(); reconstruction.views.len()];
    let mut numbers = Vec::new();
    for (i, point) in reconstruction.points.iter().enumerate() {
        let number = |observation: &Observation| {
            features[observation.view].push((observation.pixel, i + 1));
            features[observation.view].len() - 1
        };
        numbers.push(point.track.iter().map(number).collect());
    }
    (features, numbers)
}

/// Returns the mean length in pixels of the residuals of a point.
pub fn error(reconstruction: &Reconstruction, point: &Point) -> f64 {
    let lengths: Vec<f64> = point
        .track
        .iter()
        .filter_map(|observation| Some(reconstruction.residual(&point.position, observation)?.norm()))
        .collect();
    lengths.iter().sum::<f64>() / lengths.len().max(1) as f64
}
