//! Reads a mesh file and traces rays through its triangles.

use durer::bvh::{BuildQuality, TriangleBvh};
use durer::prelude::*;

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A cube of side 1 around the origin.
    let mesh = durer::open_mesh(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/meshes/cube.obj"))?;
    println!("{} vertices, {} triangles", mesh.positions.len(), mesh.triangles.len());
    let bvh = TriangleBvh::try_build(&mesh.positions, &mesh.triangles, BuildQuality::Best)?;

    let ray = Ray::new(vec3(0.1, 0.2, 5.0), Vec3::NEG_Z);
    let hit = bvh.closest(&ray).ok_or("the ray misses")?;
    println!("triangle {} at t = {}, point {}, normal {}", hit.triangle, hit.t, ray.at(hit.t), bvh.normal(&hit));
    assert_eq!((hit.t, bvh.normal(&hit)), (4.5, Vec3::Z));

    // A grid of parallel rays, 1/16 apart, in one call.
    let place = |i: u32| (i as f32 + 0.5) / 16.0 - 2.0;
    let rays: Vec<Ray> = (0..64 * 64).map(|i| Ray::new(vec3(place(i % 64), place(i / 64), 5.0), Vec3::NEG_Z)).collect();
    let mut hits = vec![None; rays.len()];
    bvh.closest_batch(&rays, &mut hits);
    println!("{} of {} rays hit", hits.iter().flatten().count(), rays.len());
    assert_eq!(hits.iter().flatten().count(), 16 * 16);
    Ok(())
}
