//! Computes distances from points to a mesh.
//!
//! Run it with `cargo run --release --example closest_point`.

use durer_bvh::math::{Ray, Vec3};
use durer_bvh::{BuildQuality, TriangleBvh};

pub(crate) fn main() {
    // A cube from -1 to 1, with two outward-facing triangles per side.
    let corner = |i: u32| Vec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 }));
    let corners: Vec<Vec3> = (0..8).map(corner).collect();
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles: Vec<[u32; 3]> = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let bvh = TriangleBvh::build(&corners, &triangles, BuildQuality::default());

    for place in [Vec3::new(3.0, 0.2, 0.1), Vec3::new(2.0, 2.0, 2.0), Vec3::new(0.5, 0.0, 0.0)] {
        let nearest = bvh.nearest_point(place, f64::INFINITY).expect("there are triangles");
        // From inside, a ray in any direction crosses a closed mesh an odd number of times.
        let is_inside = bvh.hit_count(&Ray::new(place, Vec3::new(0.3, 0.2, 0.9))) % 2 == 1;
        let sign = if is_inside { -1.0 } else { 1.0 };
        println!("{place} is {:.3} from {}", sign * nearest.distance, nearest.point);
        let expected = (place.abs() - 1.0).max(Vec3::ZERO).length() + (place.abs() - 1.0).max_element().min(0.0);
        assert!((sign * nearest.distance - f64::from(expected)).abs() < 1e-6);
    }
    // With a distance limit, the query skips geometry beyond it.
    assert!(bvh.nearest_point(Vec3::new(3.0, 0.2, 0.1), 1.5).is_none());
}
