//! Line drawings of a scene in world space.

use durer_render::world::{Geometry, Object, World};
use durer_scene::light::{Emitter, Light};
use durer_scene::math::{Aabb, Vec3};
use durer_scene::shape::Shape;
use serde_json::{Value, json};

/// Maximum number of objects drawn; more would hide each other.
const MAX_OBJECTS: usize = 400;
/// Maximum number of triangles drawn of a mesh.
const MAX_TRIANGLES: usize = 600;

/// Returns polylines that outline the objects, in world space.
pub fn outlines(world: &World) -> Vec<Vec<Vec3>> {
    let ends = world.bounds().union(Aabb::around([world.camera_frame().eye]));
    world.objects().iter().take(MAX_OBJECTS).flat_map(|object| outline(object, &ends)).collect()
}

/// Returns the lights with name and position; for directional lights, a point in the direction they
/// come from.
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

/// Polylines that outline one object in world space; where it has no end, within a box.
pub fn outline(object: &Object, ends: &Aabb) -> Vec<Vec<Vec3>> {
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
