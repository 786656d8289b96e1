//! Search for measuring points inside objects, where no light arrives.

use durer::camera::Projection;
use durer::math::Vec3;
use durer::measure::{Measured, Sensor};
use durer::world::{Object, World};
use rayon::prelude::*;

/// Returns for each sensor whether it is inside an object and receives no light. A closed object
/// that contains the camera or a point with light is a room or transparent, and does not count.
pub fn find(world: &World, sensors: &[Sensor], points: &[Measured]) -> Vec<bool> {
    let is_dark: Vec<bool> = points.iter().map(|point| point.illuminance == 0.0).collect();
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
                let mut points = sensors.iter().zip(&is_dark).filter(|(_, dark)| **dark == wanted);
                points.any(|(sensor, _)| contains(object, sensor.point))
            };
            contains_any(true) && !contains(object, camera) && !contains_any(false)
        })
        .collect();
    let is_inside = |(sensor, dark): (&Sensor, &bool)| *dark && bodies.iter().any(|body| contains(body, sensor.point));
    sensors.par_iter().zip(&is_dark).map(is_inside).collect()
}
