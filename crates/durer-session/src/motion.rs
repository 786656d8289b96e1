//! Motions of the camera, such as orbiting and panning.

use crate::fields::{NewValue, field_states, set_value};
use crate::protocol::{CameraState, Motion};
use durer::camera::{Camera, Projection};
use durer::describe::{DescribedKind, Value};
use durer::dialect::Dialect;
use durer::math::{Aabb, Vec2, Vec3};
use durer::world::World;
use glam::Quat;

/// Minimum angle between the view direction of an orbiting camera and the axis of the orbit, in
/// radians.
const POLE: f32 = 0.02;

/// Returns the distance from the eye to the point that the camera looks at, in world units.
pub(crate) fn distance(world: &World) -> f32 {
    let frame = world.camera_frame();
    let ray = durer::math::Ray::new(frame.eye, frame.forward);
    let bounds = world.bounds();
    let center = if bounds.is_empty() { 1.0 } else { (bounds.center() - frame.eye).dot(frame.forward) };
    let hit = world.closest(&ray, &mut ()).map(|hit| hit.t).filter(|t| t.is_finite());
    // Ignore a hit that is far beyond the scene, for example on a ground plane near the horizon,
    // because it is not a useful centre for an orbit.
    let size = if bounds.is_empty() { f32::INFINITY } else { bounds.size().length() };
    let near = hit.filter(|&t| t <= center.max(0.0) + size);
    near.unwrap_or(center).max(1e-3 * frame.eye.length().max(1.0))
}

/// Returns the index of the camera field with this name.
fn field(camera: &Camera, name: &str) -> Option<usize> {
    camera.fields().iter().position(|field| field.name == name)
}

fn set(camera: &mut Camera, name: &str, value: Vec3) {
    if let Some(at) = field(camera, name) {
        camera.set(at, Value::Vec3(value));
    }
}

/// Returns the camera after a motion and the distance to its target.
pub(crate) fn moved(world: &World, written: &Camera, mut distance: f32, motion: Motion) -> (Camera, f32) {
    let frame = world.camera_frame();
    let (mut eye, mut forward) = (frame.eye, frame.forward.normalize_or(Vec3::NEG_Z));
    let axis = world.camera().pose().up.normalize_or(Vec3::Y);
    let (right, up) = (frame.right.normalize_or(Vec3::X), frame.up.normalize_or(Vec3::Y));
    let target = eye + distance * forward;
    let height = 2.0 * distance * frame.half_width.min(4.0) as f32;
    match motion {
        Motion::Orbit { right: x, up: y } => {
            forward = turned(forward, axis, right, -x, -y);
            eye = target - distance * forward;
        }
        Motion::Turn { right: x, up: y } => forward = turned(forward, axis, right, -x, y),
        Motion::Pan { right: x, up: y } => eye -= height * (x * right + y * up),
        Motion::Dolly { factor } => {
            distance *= factor.clamp(0.01, 100.0);
            eye = target - distance * forward;
        }
        Motion::Walk { forward: z, right: x, up: y } => {
            eye += distance.min(10.0 * height) * (z * forward + x * right + y * up);
        }
        Motion::Home => {
            return (written.clone(), distance);
        }
        Motion::Frame => {
            let bounds = world.bounds();
            if !bounds.is_empty() {
                distance = reach(&bounds) / frame.half_width.clamp(0.05, 1.0) as f32;
                eye = bounds.center() - distance * forward;
            }
        }
    }
    let mut camera = world.camera().clone();
    if eye.is_finite() && forward.is_finite() {
        set(&mut camera, "center", eye);
        set(&mut camera, "direction", forward);
    }
    (camera, distance)
}

fn reach(bounds: &Aabb) -> f32 {
    0.55 * bounds.size().length().max(1e-3)
}

/// Rotates a direction around an axis by `around` radians and then tilts it towards the axis by
/// `towards` radians.
fn turned(forward: Vec3, axis: Vec3, right: Vec3, around: f32, towards: f32) -> Vec3 {
    let angle = forward.angle_between(axis);
    let limit = std::f32::consts::PI - POLE;
    // A camera that already looks along the axis keeps its angle.
    let wanted = (angle - towards).clamp(POLE.min(angle), limit.max(angle));
    let pitched = Quat::from_axis_angle(right, angle - wanted) * forward;
    (Quat::from_axis_angle(axis, around) * pitched).normalize_or(forward)
}

/// Returns the camera with this keyword in the scene language, at the place of the world's camera.
/// `distance` is the distance to the target. Fields that both cameras have keep their values as far
/// as they are valid.
pub(crate) fn camera_of_kind(world: &World, distance: f32, keyword: &str) -> Result<Camera, String> {
    let (old, frame) = (world.camera(), world.camera_frame());
    let camera = Camera::kinds().into_iter().find(|kind| kind.own_keyword() == keyword);
    let mut camera = camera.ok_or_else(|| format!("there is no camera `{keyword}`"))?;
    for (i, field) in camera.fields().iter().enumerate() {
        let same = old.fields().iter().position(|own| own.name == field.name && own.kind == field.kind);
        let value = same.and_then(|at| old.get(at)).filter(|value| field.constraint.validate(value).is_ok());
        if let Some(value) = value {
            camera.set(i, value);
        }
    }
    set(&mut camera, "center", frame.eye);
    set(&mut camera, "direction", frame.forward);
    set(&mut camera, "up", frame.up);
    let aside = distance * frame.half_width as f32 * frame.right;
    // These cameras have no field for the centre.
    match &mut camera {
        Camera::PushBroom(broom) => (broom.start, broom.end) = (frame.eye - aside, frame.eye + aside),
        Camera::MultipleCenter(many) => {
            let row = |eye: Vec3| {
                let ([a, b, c], [d, e, f]) = (eye.to_array(), (eye + distance * frame.forward).to_array());
                [a, b, c, d, e, f]
            };
            many.path = vec![row(frame.eye - aside), row(frame.eye + aside)];
        }
        Camera::Projective(photo) => {
            let [x, y] = [photo.width, photo.height].map(|side| 0.5 * (side - 1.0));
            let focal = 0.5 * photo.width.max(photo.height) / frame.half_width as f32;
            let row = |row: Vec3| row.extend(-row.dot(frame.eye)).to_array();
            let across = focal * frame.right + x * frame.forward;
            photo.matrix = vec![row(across), row(y * frame.forward - focal * frame.up), row(frame.forward)];
        }
        _ => {}
    }
    Ok(camera)
}

/// Sets the value of the camera field whose keyword in the scene language is `word`.
pub(crate) fn set_field(camera: &mut Camera, word: &str, new: NewValue) -> Result<(), String> {
    let mut changed = camera.clone();
    set_value(&mut changed, word, new)?;
    changed.validate()?;
    *camera = changed;
    Ok(())
}

/// Returns the state of a camera for the web page.
pub(crate) fn state(world: &World, written: &Camera, dialect: Dialect, distance: f32) -> CameraState {
    let (camera, frame) = (world.camera(), world.camera_frame());
    CameraState {
        keyword: camera.keyword(dialect).into(),
        eye: frame.eye.into(),
        forward: frame.forward.into(),
        right: frame.right.into(),
        up: frame.up.into(),
        half_width: frame.half_width,
        distance,
        projects: projects(world, distance),
        fields: field_states(camera),
        statement: statement(camera, dialect),
        moved: camera != written,
    }
}

/// Returns true if the camera shows points at `distance` where a pinhole would show them.
fn projects(world: &World, distance: f32) -> bool {
    let frame = world.camera_frame();
    let half = frame.half_width as f32;
    [Vec2::new(0.25, -0.625), Vec2::new(-0.75, 0.125), Vec2::new(0.5, 0.5)].into_iter().all(|place| {
        let direction = frame.forward + half * (place.x * frame.right + place.y * frame.up);
        let mut seen = Vec::new();
        let point = frame.eye + distance * direction;
        world.camera().project(frame, point, Vec2::splat(0.5), &mut |at| seen.push(at));
        matches!(seen[..], [at] if at.distance(place) < 1e-3)
    })
}

/// Returns the camera as a statement in the scene language. If the dialect has no such camera, the
/// statement is in Dürer's own.
pub(crate) fn statement(camera: &Camera, dialect: Dialect) -> String {
    let is_known = camera.keywords().iter().any(|(_, set)| dialect.is_in(*set));
    let dialect = if is_known { dialect } else { Dialect::Durer };
    let numbers = |row: &Vec<f32>| row.iter().map(f32::to_string).collect::<Vec<_>>().join(" ");
    let fields = camera.fields().iter().enumerate().filter_map(|(i, field)| {
        let word = field.keyword(dialect)?;
        let value = match camera.get(i)? {
            Value::Float(x) => x.to_string(),
            Value::Int(i) => i.to_string(),
            Value::Vec3(v) => format!("{} {} {}", v.x, v.y, v.z),
            Value::Word(word) => word,
            Value::Path(name) => name.path,
            Value::Rows(rows) => format!("{{ {} }}", rows.iter().map(numbers).collect::<Vec<_>>().join("  ")),
        };
        Some(format!("{word} {value}"))
    });
    format!("{} {{ {} }}", camera.keyword(dialect), fields.collect::<Vec<_>>().join(" "))
}
