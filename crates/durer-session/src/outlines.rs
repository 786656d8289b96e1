//! A scene in lines, to be drawn in space.

use crate::document::Compiled;
use crate::protocol::{Lamp, Outline};
use durer::light::Emitter;
use durer::math::{Aabb, Vec3};
use durer::render::explain::Names;
use durer::shape::Shape;
use durer::world::{Geometry, Object};

/// At most so many objects are drawn: more hide each other.
const MAX_OBJECTS: usize = 400;
/// And so many triangles of a mesh.
const MAX_TRIANGLES: usize = 600;
/// And so many lights.
const MAX_LAMPS: usize = 32;

/// The lines of all objects.
pub(crate) fn outlines(names: &Names) -> Vec<Outline> {
    let world = names.world;
    let ends = world.bounds().union(Aabb::around([world.camera_frame().eye]));
    let objects = world.objects().iter().take(MAX_OBJECTS).enumerate();
    let one = |(i, object)| Outline {
        object: i as u32,
        lines: lines(object, &ends).into_iter().map(|line| line.iter().flat_map(Vec3::to_array).collect()).collect(),
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

fn lines(object: &Object, ends: &Aabb) -> Vec<Vec<Vec3>> {
    let place = |points: Vec<Vec3>| points.into_iter().map(|p| object.world_point(p)).collect::<Vec<_>>();
    let boxed = || object.bounds().filter(|bounds| !bounds.is_empty()).map_or(Vec::new(), |bounds| edges(&bounds));
    match &object.geometry {
        Geometry::Primitive(shape) => match shape.outline(ends) {
            Some(lines) => lines.into_iter().map(place).collect(),
            None => boxed(),
        },
        Geometry::Mesh(tree) => {
            let count = tree.mesh.len();
            let some = (0..count).step_by(count.div_ceil(MAX_TRIANGLES).max(1));
            let closed = |[a, b, c]: [Vec3; 3]| place(vec![a, b, c, a]);
            some.map(|i| closed(tree.mesh.corners(i as u32))).collect()
        }
        Geometry::Solid(_) => boxed(),
    }
}

fn edges(bounds: &Aabb) -> Vec<Vec<Vec3>> {
    let corners: Vec<Vec3> = bounds.corners().into_iter().collect();
    let edges = (0..8_usize).flat_map(|i| (0..3).map(move |k| (i, i | 1 << k))).filter(|(i, j)| i != j);
    edges.map(|(i, j)| vec![corners[i], corners[j]]).collect()
}
