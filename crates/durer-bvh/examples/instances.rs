//! Places one mesh in many moving instances.
//!
//! Run it with `cargo run --release --example instances`.

use durer_bvh::glam::{DAffine3, DQuat, DVec3};
use durer_bvh::math::{Affine, Ray, Vec3};
use durer_bvh::{BuildQuality, Instance, InstanceBvh, TriangleBvh};
use std::sync::Arc;

/// Mask bits, one for each kind of instance.
const SOLID: u32 = 1;
const GHOST: u32 = 2;

/// Places a mesh on a circle, rotated by `angle` (radians). Any invertible affine map is allowed
/// here.
fn place(angle: f64) -> Affine {
    let turn = DQuat::from_rotation_y(angle);
    Affine::new(DAffine3::from_rotation_translation(turn, turn * DVec3::new(3.0, 0.0, 0.0)))
        .expect("a rotation can be inverted")
}

pub(crate) fn main() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let tetrahedron = Arc::new(TriangleBvh::build(&corners, &faces, BuildQuality::default()));

    let instances = (0..12)
        .map(|i| {
            let kind = if i % 4 == 3 { GHOST } else { SOLID };
            Instance::new(tetrahedron.clone(), place(f64::from(i).to_radians() * 30.0)).with_mask(kind)
        })
        .collect();
    let mut scene = InstanceBvh::new(instances);
    println!("{} instances in {} bytes", scene.instances().len(), scene.memory_usage());

    let ray = Ray::new(Vec3::new(0.0, 0.2, 0.0), Vec3::new(1.0, 0.0, 0.03));
    let hit = scene.closest(&ray).expect("the first lies ahead");
    println!("instance {}, triangle {}, normal {}", hit.instance, hit.triangle, scene.normal(&hit));
    assert_eq!(hit.instance, 0);

    // Rotate the wheel by 30 degrees. The last instance, which only some rays can see, is now in
    // front of the ray.
    scene.update((0..12).map(|i| (i, place(f64::from(i + 1).to_radians() * 30.0))));
    assert_eq!(scene.closest_masked(&ray, GHOST).map(|hit| hit.instance), Some(11));
    assert_eq!(scene.closest_masked(&ray, SOLID), None);
    println!("after a turn, a ghost is ahead");
}
