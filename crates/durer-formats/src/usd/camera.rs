//! Cameras.
//!
//! Source: *OpenUSD documentation*, `UsdGeomCamera`. Apertures and focal lengths are in tenths of a
//! world unit.

use super::reader::{CameraData, Reader};
use super::stage::Prim;
use crate::named_choice::{NO_CAMERA, choose};
use durer_diag::Diagnostic;
use durer_scene::camera::{Camera, OrthographicCamera, PerspectiveCamera, ThinLensCamera};
use durer_scene::math::fp;
use glam::{DAffine3, DVec3};

impl Reader<'_, '_> {
    /// Remembers a camera.
    pub fn read_camera(&mut self, prim: &Prim, to_world: DAffine3) {
        let number = |name: &str, default: f64| self.number(prim, name).unwrap_or(default);
        let clipping =
            prim.get(self.stage, "clippingRange").and_then(|o| o.value.numbers().first_chunk::<2>().copied());
        self.cameras.push(CameraData {
            name: prim.name().to_string(),
            path: prim.path.clone(),
            at: prim.span(),
            to_world,
            is_orthographic: self.text(prim, "projection").as_deref() == Some("orthographic"),
            film: [number("horizontalAperture", 20.955), number("verticalAperture", 15.2908)].map(|x| 0.1 * x),
            offset: [number("horizontalApertureOffset", 0.0), number("verticalApertureOffset", 0.0)].map(|x| 0.1 * x),
            focal_length: 0.1 * number("focalLength", 50.0),
            f_stop: number("fStop", 0.0),
            focus_distance: number("focusDistance", 0.0),
            clipping,
        });
    }

    /// Sets the camera of the scene to the requested one, or to the first.
    pub fn set_camera(&mut self) {
        let defaults = self.stage.files.input.scene_defaults;
        self.scene.camera_names = self.cameras.iter().map(|camera| camera.name.clone()).collect();
        let names: Vec<_> = self.cameras.iter().map(|camera| vec![&*camera.name, &*camera.path]).collect();
        let chosen = match choose("camera", &names, defaults.camera.as_deref()) {
            Ok(Some(index)) => &self.cameras[index],
            Ok(None) => return,
            Err(message) => return self.stage.files.report.push(Diagnostic::error(message).code(NO_CAMERA)),
        };
        match chosen.camera(defaults.aspect) {
            Some(camera) => (self.scene.camera, self.scene.camera_span) = (Some(camera), chosen.at),
            None => {
                let message = format!("the camera `{}` has no valid aperture or focal length", chosen.name);
                self.stage.files.report.error(chosen.at, message);
            }
        }
    }
}

impl CameraData {
    /// Converts the camera for a picture with a ratio of width to height.
    fn camera(&self, aspect: Option<f32>) -> Option<Camera> {
        let [width, height] = self.film;
        if !(width > 0.0 && height > 0.0 && self.focal_length > 0.0) {
            return None;
        }
        // The width of the film counts, and the height follows from the picture.
        let aspect = aspect.map_or(width / height, f64::from);
        let larger = width.max(width / aspect);
        let map = self.to_world;
        let direction = map.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z).as_vec3();
        let up = map.transform_vector3(DVec3::Y).normalize_or(DVec3::Y).as_vec3();
        let center = map.translation.as_vec3();
        if self.is_orthographic {
            // The size of an orthographic view is its aperture in tenths of a world unit.
            let size = (larger * map.transform_vector3(DVec3::X).length()) as f32;
            return Some(OrthographicCamera { center, direction, up, size, ..OrthographicCamera::default() }.into());
        }
        let angle = (2.0 * fp::atan_f64(0.5 * larger / self.focal_length)).to_degrees() as f32;
        let shift = self.offset.map(|offset| (2.0 * offset / larger) as f32);
        let has_lens = self.f_stop > 0.0 && self.focus_distance > 0.0;
        let [near, far] = self.clipping.unwrap_or([0.0, f64::INFINITY]);
        let far = (far > near && far < 1e6).then_some(far as f32);
        if !has_lens && shift == [0.0; 2] && near <= 0.0 && far.is_none() {
            return Some(PerspectiveCamera { center, direction, up, angle: angle.min(179.9) }.into());
        }
        Some(
            ThinLensCamera {
                center,
                direction,
                up,
                angle: angle.min(179.9),
                aperture: if has_lens { (self.focal_length / self.f_stop) as f32 } else { 0.0 },
                focus_distance: if has_lens { self.focus_distance as f32 } else { 1.0 },
                shift_right: shift[0],
                shift_up: shift[1],
                near: near.max(0.0) as f32,
                far,
                ..ThinLensCamera::default()
            }
            .into(),
        )
    }
}
