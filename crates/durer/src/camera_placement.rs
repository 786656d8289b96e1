//! Placement of the camera by options.

use durer_bvh::glam::DVec3;
use durer_render::world::World;
use durer_scene::camera::{Camera, PerspectiveCamera, Projection};
use durer_scene::describe::{DescribedKind, Value};
use durer_scene::math::Vec3;
use durer_scene::scene::Axis;
use durer_scene::scene::defaults::{ModelAxes, rotation};

/// Eye, target and field of view that replace those of the scene's camera. If any is given, the
/// scene is rendered with a perspective camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CameraPlacement {
    /// Position of the eye in world space, or `None` for that of the scene's camera.
    pub eye: Option<Vec3>,
    /// Point at which the camera looks, in world space. `None` keeps the view direction or, if the
    /// eye moves, looks at the center of the scene.
    pub target: Option<Vec3>,
    /// Field of view across the larger side of the picture, in degrees, between 0 and 180. `None`
    /// keeps that of a perspective camera, and means 40 for others.
    pub fov: Option<f32>,
}

impl CameraPlacement {
    /// Places the camera of a world. `up` is the up axis of a model. A moved or turned camera keeps
    /// it upright in the picture; without it, the camera keeps its own up direction.
    ///
    /// # Errors
    ///
    /// Returns a message if the eye is at the target.
    pub(crate) fn apply(&self, world: &mut World, up: Option<Axis>) -> Result<(), String> {
        if *self == CameraPlacement::default() {
            return Ok(());
        }
        let pose = world.camera().pose();
        let usual = match world.camera() {
            Camera::Perspective(camera) => camera.angle,
            _ => 40.0,
        };
        let eye = self.eye.unwrap_or(pose.center);
        let bounds = world.bounds();
        let middle = self.eye.filter(|_| !bounds.is_empty()).map(|_| bounds.center());
        let direction = self.target.or(middle).map_or(pose.direction, |target| target - eye);
        if !direction.length_squared().is_normal() {
            return Err("the camera cannot look at the point where it is: choose another `--eye` or `--target`".into());
        }
        let is_moved = self.eye.is_some() || self.target.is_some();
        let upright = up.filter(|_| is_moved).map(|up| ModelAxes::new(up).up.as_vec3());
        let up = upright.unwrap_or(pose.up);
        // A camera that looks along its up direction needs another one.
        let is_along = direction.normalize().cross(up.normalize_or(Vec3::Y)).length() < 1e-3;
        let up = if is_along { up.any_orthogonal_vector() } else { up };
        let camera = PerspectiveCamera { center: eye, direction, up, angle: self.fov.unwrap_or(usual) };
        world.set_camera(camera.into());
        Ok(())
    }
}

/// Rotates the camera of a world counter-clockwise as seen from above by this many degrees. The
/// vertical axis passes through the point on the camera's line of sight that is beside the center
/// of the scene. `up` is the up axis of a model. The camera keeps its kind.
///
/// # Errors
///
/// Returns a message if the camera is not defined by a position and a view direction.
pub(crate) fn orbit(world: &mut World, up: Option<Axis>, degrees: f32) -> Result<(), String> {
    let mut camera = world.camera().clone();
    let pose = camera.pose();
    let [center, direction, own_up] = [pose.center, pose.direction, pose.up].map(Vec3::as_dvec3);
    let forward = direction.normalize_or(DVec3::NEG_Z);
    let vertical = up.map_or_else(|| vertical(forward, own_up), |up| ModelAxes::new(up).up);
    let bounds = world.bounds();
    let middle = if bounds.is_empty() { center } else { bounds.center().as_dvec3() };
    let pivot = center + (middle - center).dot(forward).max(0.0) * forward;
    let turned = rotation(vertical, f64::from(degrees));
    let moved =
        [("center", pivot + turned * (center - pivot)), ("direction", turned * direction), ("up", turned * own_up)];
    for (name, value) in moved {
        let Some(field) = camera.fields().iter().position(|field| field.name == name) else {
            return Err(format!(
                "a `{}` cannot be rotated around the scene: place another camera with `--eye X,Y,Z`",
                camera.own_keyword()
            ));
        };
        camera.set(field, Value::Vec3(value.as_vec3()));
    }
    world.set_camera(camera);
    Ok(())
}

/// Returns the vertical of a scene without an up axis, from the view direction and the up direction
/// of its camera: y, unless the camera is upright along another direction.
fn vertical(forward: DVec3, up: DVec3) -> DVec3 {
    let upright = up.reject_from(forward).normalize_or(DVec3::Y);
    let looks_down = forward.y.abs() > 0.9;
    if looks_down || upright.y.abs() > 0.1 { DVec3::Y } else { up.normalize_or(DVec3::Y) }
}
