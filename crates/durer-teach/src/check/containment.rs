//! Determines which objects contain a point.

use durer_render::world::World;
use durer_scene::math::{Ray, Ray64, Vec3};

/// Directions that are unlikely to be parallel to an edge of a hand-modelled object.
const DIRECTIONS: [Vec3; 5] = [
    Vec3::new(0.532, 0.741, 0.411),
    Vec3::new(-0.613, 0.274, 0.741),
    Vec3::new(0.317, -0.831, 0.457),
    Vec3::new(-0.443, -0.389, -0.808),
    Vec3::new(0.687, 0.173, -0.706),
];

/// Returns the bounded objects that contain a point. A ray from such a point in each test direction
/// crosses the surface an odd number of times.
pub(super) fn containing_objects(world: &World, point: Vec3) -> Vec<u32> {
    let boxed = |object: &u32| {
        let bounds = world.objects()[*object as usize].bounds();
        // A flat object, such as a single polygon, contains nothing.
        bounds.is_some_and(|b| b.contains(point) && b.size().min_element() > 0.0)
    };
    let mut inside: Vec<u32> = (0..world.objects().len() as u32).filter(boxed).collect();
    for direction in DIRECTIONS {
        if inside.is_empty() {
            break;
        }
        // Test each object separately, because a ray hits only one of two surfaces that coincide.
        inside.retain(|&object| {
            let mut rest = Ray64::from(Ray::new(point, direction));
            let crossings = std::iter::from_fn(|| {
                let t = world.hit_of(object, &rest)?.t;
                rest.rounded.t_min = t;
                Some(t)
            });
            crossings.count() % 2 == 1
        });
    }
    inside
}
