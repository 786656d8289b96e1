//! In which objects a point lies.

use crate::math::{Ray, Vec3};
use crate::world::World;

/// Directions in which no edge of a thing that was made by hand is likely to run.
const DIRECTIONS: [Vec3; 5] = [
    Vec3::new(0.532, 0.741, 0.411),
    Vec3::new(-0.613, 0.274, 0.741),
    Vec3::new(0.317, -0.831, 0.457),
    Vec3::new(-0.443, -0.389, -0.808),
    Vec3::new(0.687, 0.173, -0.706),
];

/// The objects with an end in which a point lies: a ray to any side leaves them once more than it enters them.
pub(super) fn around(world: &World, point: Vec3) -> Vec<u32> {
    let boxed = |object: &u32| {
        let bounds = world.objects[*object as usize].bounds();
        bounds.is_some_and(|b| b.holds(point))
    };
    let mut inside: Vec<u32> = (0..world.objects.len() as u32).filter(boxed).collect();
    for direction in DIRECTIONS {
        if inside.is_empty() {
            break;
        }
        let mut crossings = vec![0_usize; inside.len()];
        for hit in world.all_hits(&Ray::new(point, direction)) {
            if let Some(at) = inside.iter().position(|object| *object == hit.object) {
                crossings[at] += 1;
            }
        }
        let mut at = 0;
        inside.retain(|_| {
            at += 1;
            crossings[at - 1] % 2 == 1
        });
    }
    inside
}
