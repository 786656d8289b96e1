//! What a scene looks like in lines, to be drawn in space.

use durer::light::{Emitter, Light};
use durer::math::{Aabb, Vec3};
use durer::shape::Shape;
use durer::world::{Geometry, Object, World};
use serde_json::{Value, json};

/// At most so many objects are drawn: more hide each other.
const MOST: usize = 400;
/// And so many triangles of a mesh.
const MAX_TRIANGLES: usize = 600;

/// The outlines of all objects, each a row of points.
pub fn outlines(world: &World) -> Vec<Vec<Vec3>> {
    let ends = world.bounds().union(Aabb::around([world.camera_frame().eye]));
    world.objects().iter().take(MOST).flat_map(|object| outline(object, &ends)).collect()
}

/// The lights that have a place, and where the others come from.
pub fn lights(world: &World) -> Vec<Value> {
    let bounds = world.bounds().union(Aabb::around([world.camera_frame().eye]));
    let reach = 0.6 * bounds.size().length();
    let one = |(i, light): (usize, &Light)| {
        let seen = light.illuminate(bounds.center().as_dvec3());
        let far = seen.distance.is_infinite();
        let at = bounds.center() + if far { reach } else { seen.distance } * seen.to_light;
        json!({ "at": at, "name": format!("{} {i}", if far { "from light" } else { "light" }) })
    };
    world.lights().iter().enumerate().take(16).map(one).collect()
}

fn outline(object: &Object, ends: &Aabb) -> Vec<Vec<Vec3>> {
    let place = |points: Vec<Vec3>| points.into_iter().map(|p| object.world_point(p)).collect::<Vec<_>>();
    let closed = |[a, b, c]: [Vec3; 3]| vec![a, b, c, a];
    let boxed = || object.bounds().filter(|bounds| !bounds.is_empty()).map_or(Vec::new(), |bounds| boxed(&bounds));
    match &object.geometry {
        Geometry::Primitive(shape) => match shape.outline(ends) {
            Some(lines) => lines.into_iter().map(place).collect(),
            None => boxed(),
        },
        Geometry::Mesh(tree) => {
            let count = tree.mesh.len();
            let some = (0..count).step_by(count.div_ceil(MAX_TRIANGLES).max(1));
            some.map(|i| place(closed(tree.mesh.corners(i as u32)))).collect()
        }
        Geometry::Solid(_) => boxed(),
    }
}

fn boxed(bounds: &Aabb) -> Vec<Vec<Vec3>> {
    let corners: Vec<Vec3> = bounds.corners().into_iter().collect();
    let edges = (0..8_usize).flat_map(|i| (0..3).map(move |k| (i, i | 1 << k))).filter(|(i, j)| i != j);
    edges.map(|(i, j)| vec![corners[i], corners[j]]).collect()
}
