//! Search for measuring points inside objects, where no light arrives.

use super::printed;
use crate::report;
use durer::camera::Projection;
use durer::diag::Diagnostic;
use durer::math::Vec3;
use durer::measure::Sensor;
use durer::world::{Object, World};
use rayon::prelude::*;

/// Returns for each sensor whether it is inside an object and receives no light. `is_dark` is true
/// for sensors without light. A closed object that contains the camera or a point with light is a
/// room or transparent, and does not count.
pub fn find(world: &World, sensors: &[Sensor], is_dark: &[bool]) -> Vec<bool> {
    if !is_dark.contains(&true) {
        return vec![false; sensors.len()];
    }
    let contains = |object: &Object, point: Vec3| {
        object.bounds().is_none_or(|bounds| bounds.contains(point)) && object.contains(point)
    };
    let camera = world.camera().pose().center;
    let bodies: Vec<&Object> = world
        .objects()
        .par_iter()
        .filter(|object| {
            let contains_any = |wanted: bool| {
                let mut points = sensors.iter().zip(is_dark).filter(|(_, dark)| **dark == wanted);
                points.any(|(sensor, _)| contains(object, sensor.point))
            };
            contains_any(true) && !contains(object, camera) && !contains_any(false)
        })
        .collect();
    let is_inside = |(sensor, dark): (&Sensor, &bool)| *dark && bodies.iter().any(|body| contains(body, sensor.point));
    sensors.par_iter().zip(is_dark).map(is_inside).collect()
}

/// Prints the number of sensors inside objects, and the first of them.
pub fn warn(sensors: &[Sensor], inside: &[bool]) {
    let enclosed = inside.iter().filter(|inside| **inside).count();
    let Some((first, _)) = sensors.iter().zip(inside).find(|(_, inside)| **inside) else { return };
    let (of, are) = (report::counted(sensors.len(), "point"), if enclosed == 1 { "is" } else { "are" });
    let first = printed::vector(first.point);
    let message = format!("{enclosed} of {of} {are} inside an object, where no light arrives; the first is {first}");
    report::note(&Diagnostic::warning(message).code("inside"));
}
