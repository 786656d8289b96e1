//! Cameras.

use super::document::Element;
use super::reader::Reader;
use durer_diag::{Diagnostic, Span, did_you_mean};
use durer_scene::camera::{Camera, OrthographicCamera, PerspectiveCamera};
use durer_scene::math::fp;
use glam::{DAffine3, DVec3};

/// Camera that a node places.
pub(super) struct CameraData {
    names: [String; 3],
    at: Span,
    to_world: DAffine3,
    is_orthographic: bool,
    /// Half of the width and of the height of the view at distance 1, or of an orthographic view;
    /// at least one is there.
    half: [Option<f64>; 2],
    aspect: Option<f64>,
}

impl<'r> Reader<'r> {
    /// Remembers a camera.
    pub fn read_camera(&mut self, node: &'r Element<'r>, camera: &'r Element<'r>, to_world: DAffine3) {
        let optics = camera.child("optics").and_then(|optics| optics.child("technique_common"));
        let lens = optics.and_then(|optics| {
            optics.children.iter().find(|child| matches!(child.name, "perspective" | "orthographic"))
        });
        let Some(lens) = lens else {
            return self.report.unsupported_once(camera.at, "a camera without the common profile is left out");
        };
        let is_orthographic = lens.name == "orthographic";
        let names = if is_orthographic { ["xmag", "ymag"] } else { ["xfov", "yfov"] };
        let mut half = names.map(|name| self.number(lens, name).map(f64::abs));
        if !is_orthographic {
            half = half.map(|degrees| {
                degrees
                    .filter(|degrees| (1e-3..179.9).contains(degrees))
                    .map(|degrees| fp::tan_f64((0.5 * degrees).to_radians()))
            });
        }
        half = half.map(|half| half.filter(|half| *half > 0.0 && half.is_finite()));
        if half == [None; 2] {
            let message = format!("`{}` needs `{}` or `{}` greater than 0", lens.name, names[0], names[1]);
            return self.report.error(lens.at, message);
        }
        let name = |element: &Element, name: &str| element.get(name).unwrap_or_default().to_string();
        self.cameras.push(CameraData {
            names: [name(node, "name"), name(camera, "name"), name(camera, "id")],
            at: camera.at,
            to_world,
            is_orthographic,
            half,
            aspect: self.number(lens, "aspect_ratio").filter(|aspect| (1e-3..1e3).contains(aspect)),
        });
    }

    /// Sets the camera of the scene to the requested one, or to the first.
    pub fn set_camera(&mut self) {
        let defaults = self.input.scene_defaults;
        let chosen = match &defaults.camera {
            None => self.cameras.first(),
            Some(wanted) => {
                let by_name = self.cameras.iter().find(|camera| camera.names.contains(wanted));
                let found = by_name.or_else(|| self.cameras.get(wanted.parse::<usize>().ok()?));
                if found.is_none() {
                    let names = || self.cameras.iter().flat_map(|camera| &camera.names).filter(|name| !name.is_empty());
                    let known = match did_you_mean(wanted, names().map(String::as_str)) {
                        Some(similar) => format!("did you mean `{similar}`?"),
                        None if self.cameras.is_empty() => "it has no cameras".into(),
                        None => format!("the cameras are {}", names().cloned().collect::<Vec<_>>().join(", ")),
                    };
                    let error = Diagnostic::error(format!("the scene has no camera `{wanted}`: {known}"));
                    self.report.push(error.code("no-camera"));
                }
                found
            }
        };
        let Some(chosen) = chosen else { return };
        (self.scene.camera, self.scene.camera_span) = (Some(chosen.camera(defaults.aspect)), chosen.at);
    }
}

impl CameraData {
    /// Converts the camera for a picture with a ratio of width to height.
    fn camera(&self, aspect: Option<f32>) -> Camera {
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
