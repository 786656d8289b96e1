//! Traces rays against a mesh, one by one and in batches.
//!
//! Run it with `cargo run --release --example ray_query`.

use durer_bvh::math::{Ray, Vec3};
use durer_bvh::{BuildError, BuildQuality, Facing, TriangleBvh};

/// Creates a hilly mesh over the square from -1 to 1, as flat lists of coordinates and indices.
fn hills(cells: u32) -> (Vec<f32>, Vec<u32>) {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for i in 0..=cells {
        for j in 0..=cells {
            let [x, y] = [i, j].map(|k| 2.0 * k as f32 / cells as f32 - 1.0);
            positions.extend([x, y, 0.1 * (1.0 - x * x) * (1.0 - y * y)]);
        }
    }
    let at = |i: u32, j: u32| i * (cells + 1) + j;
    for i in 0..cells {
        for j in 0..cells {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            indices.extend([a, b, c, a, c, d]);
        }
    }
    (positions, indices)
}

pub(crate) fn main() -> Result<(), BuildError> {
    let (positions, indices) = hills(100);
    let bvh = TriangleBvh::from_flat(&positions, &indices, BuildQuality::Best)?;
    println!("{} triangles in {} bytes", bvh.triangle_count(), bvh.memory_usage());

    // Trace one ray, and compute the distance, point, and normal of the hit.
    let ray = Ray::new(Vec3::new(0.05, 0.03, 2.0), Vec3::NEG_Z);
    let hit = bvh.closest(&ray).expect("the sheet lies below");
    println!("t = {}, point {}, normal {}", hit.t, ray.at(hit.t), bvh.normal(&hit));
    assert!((ray.at(hit.t).z - 0.1).abs() < 1e-3);

    // Consecutive rays with similar directions are traced faster as a batch. Rays may begin and end
    // anywhere. Several threads may trace batches at the same time.
    let rays: Vec<Ray> = (0..64 * 64)
        .map(|i| {
            let [x, y] = [i % 64, i / 64].map(|k| (k as f32 + 0.5) / 32.0 - 1.0);
            Ray::new(Vec3::new(x, y, 2.0), Vec3::NEG_Z)
        })
        .collect();
    let mut hits = vec![None; rays.len()];
    bvh.closest_batch(&rays, &mut hits);
    let deepest = hits.iter().flatten().map(|hit| hit.t).fold(0.0, f32::max);
    println!("{} of {} rays hit, none farther than {deepest}", hits.iter().flatten().count(), rays.len());
    assert!(hits.iter().all(Option::is_some));

    // From below, only back faces are visible.
    let up = Ray::new(Vec3::new(0.05, 0.03, -2.0), Vec3::Z);
    assert!(bvh.occluded(&up));
    assert!(!bvh.occluded_where(&up, |_, facing| facing == Facing::Front));

    // Loading a saved tree takes a fraction of the time of building it.
    let bytes = bvh.to_bytes();
    let loaded = TriangleBvh::from_bytes(&bytes).expect("these bytes were just made");
    assert_eq!(loaded.closest(&ray), Some(hit));
    println!("saved in {} bytes", bytes.len());
    Ok(())
}
