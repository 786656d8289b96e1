//! Cameras as other programs describe them: a frame, half the view across the larger side, and a
//! lens.

use super::Export;
use durer_scene::camera::{Camera, Handedness, Projection as _};
use durer_scene::math::fp;
use glam::{DAffine3, DMat3, DVec2, DVec3};

/// Width and height of a picture if the scene does not set them.
const SIZE: (u32, u32) = (512, 512);
/// Samples per pixel if the scene does not set them.
const SAMPLES: u32 = 64;
/// Scattering events after the first if the scene does not set them, as in `durer render`.
const BOUNCES: u32 = 16;
/// Field of view in degrees that replaces a camera of another kind.
const ANGLE: f32 = 60.0;

/// Camera of a scene that is being written.
pub(crate) struct View {
    pub center: DVec3,
    /// Axes that point right, up and forward in the picture, each of length 1.
    pub axes: [DVec3; 3],
    /// Half the length of the picture's larger side: at distance 1, or for an orthographic camera
    /// in world units.
    pub half: f64,
    pub is_orthographic: bool,
    /// Radius of the lens; 0 if everything is in focus.
    pub lens_radius: f32,
    pub focus_distance: f32,
    /// Shift of the view to the right and upwards, relative to half the larger side.
    pub shift: DVec2,
    pub near: f32,
    pub far: Option<f32>,
}

impl View {
    /// Field of view in degrees across the picture's larger side.
    pub fn angle(&self) -> f64 {
        2.0 * fp::atan_f64(self.half).to_degrees()
    }

    /// Transform from the camera's space, with its axes as given, to the world.
    pub fn frame(&self, axes: [DVec3; 3]) -> DAffine3 {
        DAffine3 { matrix3: DMat3::from_cols(axes[0], axes[1], axes[2]), translation: self.center }
    }
}

impl Export<'_> {
    /// Returns the size of the picture.
    pub fn size(&self) -> (u32, u32) {
        self.scene.render_defaults.size.unwrap_or(SIZE)
    }

    /// Returns the number of samples per pixel.
    pub fn samples(&self) -> u32 {
        self.scene.render_defaults.samples.unwrap_or(SAMPLES)
    }

    /// Returns the maximum number of scattering events after the first.
    pub fn bounces(&self) -> u32 {
        self.scene.render_defaults.bounces.unwrap_or(BOUNCES)
    }

    /// Returns the camera. `program` is the name of the other program, for messages.
    pub fn view(&mut self, program: &str) -> Option<View> {
        let camera = self.scene.camera.as_ref()?;
        let pose = camera.pose();
        let forward = pose.direction.as_dvec3().normalize_or(DVec3::NEG_Z);
        let right = forward.cross(pose.up.as_dvec3()).normalize_or(forward.any_orthonormal_vector());
        let mut view = View {
            center: pose.center.as_dvec3(),
            axes: [right, right.cross(forward), forward],
            half: 1.0,
            is_orthographic: false,
            lens_radius: 0.0,
            focus_distance: 1.0,
            shift: DVec2::ZERO,
            near: 0.0,
            far: None,
        };
        let half = |angle: f32| fp::tan_f64(f64::from(angle).to_radians() / 2.0);
        let mirror = |view: &mut View, handedness: Handedness| {
            if handedness == Handedness::Left {
                view.axes[0] = -view.axes[0];
            }
        };
        match camera {
            Camera::Perspective(plain) => view.half = half(plain.angle),
            Camera::ThinLens(lens) => {
                view.half = half(lens.angle);
                (view.lens_radius, view.focus_distance) = (0.5 * lens.aperture, lens.focus_distance);
                view.shift = DVec2::new(f64::from(lens.shift_right), f64::from(lens.shift_up));
                (view.near, view.far) = (lens.near, lens.far);
                mirror(&mut view, lens.handedness);
                if lens.blades > 0 && lens.aperture > 0.0 {
                    self.warn_lost(format!("{program} has no aperture with blades: a round one is written"));
                }
            }
            Camera::Orthographic(flat) => {
                (view.half, view.is_orthographic) = (0.5 * f64::from(flat.size), true);
                mirror(&mut view, flat.handedness);
                // The other programs see nothing behind the camera, so it stands at the near plane.
                let near = flat.near.unwrap_or(0.0);
                view.center += f64::from(near) * forward;
                view.far = flat.far.map(|far| far - near);
                if flat.near != Some(0.0) {
                    self.warn_lost(format!(
                        "orthographic cameras of {program} see nothing behind their centre: move the camera back if \
                         something is missing"
                    ));
                }
            }
            _ => {
                view.half = half(ANGLE);
                self.warn_lost(format!("{program} has no camera of this kind: a perspective camera is written"));
            }
        }
        Some(view)
    }
}
