//! Parts of a scene that the reader collects before it can convert them.

use durer_diag::Span;
use durer_scene::camera::{Camera, OrthographicCamera, PerspectiveCamera};
use durer_scene::math::fp;
use durer_scene::shape::MeshData;
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// Camera that a node places.
pub(super) struct CameraData {
    pub names: [String; 3],
    pub at: Span,
    pub to_world: DAffine3,
    pub is_orthographic: bool,
    /// Half of the width and of the height of the view at distance 1, or of an orthographic view;
    /// at least one is there.
    pub half: [Option<f64>; 2],
    pub aspect: Option<f64>,
}

impl CameraData {
    /// Converts the camera for a picture with a ratio of width to height.
    pub fn camera(&self, aspect: Option<f32>) -> Camera {
        let own = match self.half {
            [Some(x), Some(y)] => Some(x / y),
            _ => self.aspect,
        };
        let aspect = aspect.map(f64::from).or(own).unwrap_or(1.0);
        // Angles and sizes are measured across the larger side of the picture. The height counts if
        // both are there.
        let larger = match self.half {
            [_, Some(y)] => y * aspect.max(1.0),
            [Some(x), None] => x * (1.0 / aspect).max(1.0),
            [None, None] => 1.0,
        };
        let map = self.to_world;
        let direction = map.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z).as_vec3();
        let up = map.transform_vector3(DVec3::Y).normalize_or(DVec3::Y).as_vec3();
        let center = map.translation.as_vec3();
        if self.is_orthographic {
            let size = (2.0 * larger * map.transform_vector3(DVec3::X).length()) as f32;
            return OrthographicCamera { center, direction, up, size, ..OrthographicCamera::default() }.into();
        }
        let angle = (2.0 * fp::atan_f64(larger)).to_degrees() as f32;
        PerspectiveCamera { center, direction, up, angle: angle.min(179.9) }.into()
    }
}

/// Triangles that share a material.
pub(super) struct Part {
    /// Name that a node binds to a material.
    pub symbol: Option<String>,
    pub data: Arc<MeshData>,
    /// Numbers of the first two sets of texture coordinates.
    pub sets: Vec<u32>,
    pub at: Span,
}

/// List of vectors.
pub(super) struct Source {
    pub values: Vec<f32>,
    pub stride: usize,
    pub count: usize,
}

impl Source {
    /// Returns a vector, which has at least as many components as the stride states.
    pub fn get(&self, index: usize) -> &[f32] {
        self.values.get(index * self.stride..(index + 1) * self.stride).unwrap_or(&[])
    }

    /// Returns the first components of a vector; those that are missing or not finite are 0.
    pub fn vector<const N: usize>(&self, index: usize) -> [f32; N] {
        let own = self.get(index);
        std::array::from_fn(|k| own.get(k).copied().filter(|x| x.is_finite()).unwrap_or(0.0))
    }

    /// Number of components of each vector.
    pub fn width(&self) -> usize {
        self.stride
    }
}
