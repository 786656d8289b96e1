//! Cameras.

use super::document::Element;
use super::parts::CameraData;
use super::reader::Reader;
use crate::named_choice::{NO_CAMERA, choose};
use durer_diag::Diagnostic;
use durer_scene::math::fp;
use glam::DAffine3;

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
        let names: Vec<Vec<&str>> =
            self.cameras.iter().map(|camera| camera.names.iter().map(String::as_str).collect()).collect();
        let first = |names: &Vec<&str>| names.iter().find(|name| !name.is_empty()).map(ToString::to_string);
        self.scene.camera_names = names.iter().map(|names| first(names).unwrap_or_default()).collect();
        let chosen = match choose("camera", &names, defaults.camera.as_deref()) {
            Ok(Some(index)) => &self.cameras[index],
            Ok(None) => return,
            Err(message) => return self.report.push(Diagnostic::error(message).code(NO_CAMERA)),
        };
        (self.scene.camera, self.scene.camera_span) = (Some(chosen.camera(defaults.aspect)), chosen.at);
    }
}
