//! A scene in lines, to be drawn in space.

use crate::document::Compiled;
use crate::protocol::{Lamp, Outline};
use durer::light::Emitter;
use durer::math::{Aabb, Vec3};
use durer::render::explain::Names;
use durer::report::outline;

/// Objects drawn at most: more would hide each other.
const MAX_OBJECTS: usize = 400;
/// Lights drawn at most.
const MAX_LAMPS: usize = 32;

/// The lines of all objects.
pub(crate) fn outlines(names: &Names) -> Vec<Outline> {
    let world = names.world;
    let ends = world.bounds().union(Aabb::around([world.camera_frame().eye]));
    let objects = world.objects().iter().take(MAX_OBJECTS).enumerate();
    let one = |(i, object)| Outline {
        object: i as u32,
        lines: outline(object, &ends).into_iter().map(|line| line.iter().flat_map(Vec3::to_array).collect()).collect(),
    };
    objects.map(one).collect()
}

/// The lights, those without a place beside the scene.
pub(crate) fn lamps(compiled: &Compiled) -> Vec<Lamp> {
    let world = &compiled.world;
    let bounds = world.bounds().union(Aabb::around([world.camera_frame().eye]));
    let reach = 0.6 * bounds.size().length();
    let lamps = world.lights().iter().take(MAX_LAMPS).enumerate();
    let one = |(i, light): (usize, &durer::light::Light)| {
        let seen = light.illuminate(bounds.center().as_dvec3());
        let far = seen.distance.is_infinite();
        let at = bounds.center() + if far { reach } else { seen.distance } * seen.to_light;
        Lamp { at: at.into(), far, name: compiled.light(i) }
    };
    lamps.map(one).collect()
}
