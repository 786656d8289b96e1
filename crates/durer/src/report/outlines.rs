//! Line drawings of a scene in world space.

use durer_render::world::{Geometry, Object, World};
use durer_scene::light::Illuminate;
use durer_scene::math::{Aabb, Vec3};
use durer_scene::shape::Shape;
use serde_json::{Value, json};

/// Maximum number of objects that are drawn. More objects would hide each other.
const MAX_OBJECTS: usize = 400;
/// Maximum number of triangles that are drawn for each mesh.
const MAX_TRIANGLES: usize = 600;

/// Returns polylines in world space that outline the objects.
pub fn outlines(world: &World) -> Vec<Vec<Vec3>> {
    object_outlines(world).flatten().collect()
}

/// Returns the polylines of each of the first 400 objects in world space, in the order of the
/// object numbers.
pub fn object_outlines(world: &World) -> impl Iterator<Item = Vec<Vec<Vec3>>> {
    let ends = with_camera(world);
    world.objects().iter().take(MAX_OBJECTS).map(move |object| outline(object, &ends))
}

/// Position at which a line drawing of a scene shows a light.
pub struct LightMark {
    /// Position of the light in world space. For a directional light, this is a point outside the
    /// scene in the direction from which the light comes.
    pub at: Vec3,
    /// True for a light at infinity, such as a directional light.
    pub is_far: bool,
}

/// Returns a mark for each light, in the order of the light numbers.
pub fn light_marks(world: &World) -> impl Iterator<Item = LightMark> {
    let bounds = with_camera(world);
    let reach = 0.6 * bounds.size().length();
    world.lights().iter().map(move |light| {
        let sample = light.illuminate(bounds.center().as_dvec3());
        let is_far = sample.distance.is_infinite();
        LightMark { at: bounds.center() + if is_far { reach } else { sample.distance } * sample.to_light, is_far }
    })
}

/// Returns the names and positions of the first 16 lights as JSON. See [`light_marks`].
pub fn lights(world: &World) -> Vec<Value> {
    let one = |(i, mark): (usize, LightMark)| json!({ "at": mark.at, "name": format!("{} {i}", if mark.is_far { "from light" } else { "light" }) });
    light_marks(world).enumerate().take(16).map(one).collect()
}

/// Returns the bounding box of the scene and the eye of its camera.
fn with_camera(world: &World) -> Aabb {
    world.bounds().union(Aabb::around([world.camera_frame().eye]))
}

/// Returns the polylines of one object in world space. Unbounded objects are clipped to `ends`.
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
