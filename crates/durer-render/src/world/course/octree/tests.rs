use super::*;
use durer_scene::math::Ray;
use durer_scene::math::random::Random;

/// Returns the bounding boxes of small triangles in a cube from -1 to 1.
fn boxes(count: usize, random: &mut Random) -> Vec<Aabb> {
    let mut point = |by: f32| Vec3::from_array([0, 1, 2].map(|_| random.between(-by, by)));
    let corner = |middle: Vec3, off: Vec3| middle + off;
    (0..count)
        .map(|_| {
            let middle = point(0.9);
            Aabb::around([0, 1, 2].map(|_| corner(middle, point(0.1))))
        })
        .collect()
}

fn visited(octree: &Octree, ray: &Ray) -> Vec<u32> {
    let mut found = Vec::new();
    octree.walk(ray.origin, ray.dir, &mut |i| found.push(i));
    found
}

/// Returns true if a ray passes through the middle half of a box.
fn goes_through(ray: &Ray, b: &Aabb) -> bool {
    let inner = Aabb { min: b.min + 0.25 * b.size(), max: b.max - 0.25 * b.size() };
    let [near, far] = [inner.min, inner.max].map(|p| (p - ray.origin) / ray.dir);
    near.min(far).max_element().max(0.0) <= near.max(far).min_element()
}

#[test]
fn ray_visits_every_box_on_its_way() {
    let mut random = Random(7);
    for count in [1, 7, 8, 200, 3000] {
        let boxes = boxes(count, &mut random);
        let octree = Octree::new(boxes.clone());
        for _ in 0..300 {
            let origin = 3.0 * random.direction();
            let aim = Vec3::from_array([0, 1, 2].map(|_| random.between(-0.8, 0.8)));
            let ray = Ray::new(origin, (aim - origin).normalize());
            let found = visited(&octree, &ray);
            for (i, b) in boxes.iter().enumerate().filter(|(_, b)| goes_through(&ray, b)) {
                assert!(found.contains(&(i as u32)), "{count}: {ray:?} misses {b:?}");
            }
        }
    }
}

#[test]
fn axis_parallel_ray_loses_the_far_half_of_divided_cells() {
    // Place two small boxes at each of the eight corners of a cube, so that the root cell is
    // divided.
    let at = |i: u32| Vec3::from_array([4, 2, 1].map(|bit| if i & bit != 0 { 1.0 } else { -1.0 }));
    let small = |i: u32| Aabb { min: at(i) - 0.1, max: at(i) + 0.1 };
    let octree = Octree::new((0..16).map(|i| small(i % 8)).collect());
    let down = |x: f32, y: f32, dir: Vec3| visited(&octree, &Ray::new(Vec3::new(x, y, 5.0), dir));
    // The `t` of the middle plane along x is NaN, so the cells behind this plane are never visited.
    let lost = down(1.0, 1.0, Vec3::NEG_Z);
    assert!(!lost.contains(&7) && !lost.contains(&6), "{lost:?}");
    assert!(down(-1.0, -1.0, Vec3::NEG_Z).contains(&1));
    // If the direction is slightly inclined, no hits are missed.
    let found = down(1.0, 1.0, Vec3::new(-1e-6, -1e-6, -1.0));
    assert!(found.contains(&7) && found.contains(&6), "{found:?}");
    // A cell of seven triangles is not divided, so no triangle is missed.
    let small_world = Octree::new((0..7).map(|i| small(7 - i)).collect());
    assert_eq!(visited(&small_world, &Ray::new(Vec3::new(1.0, 1.0, 5.0), Vec3::NEG_Z)).len(), 7);
}

#[test]
fn division_of_overlapping_boxes_terminates() {
    let whole = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
    let octree = Octree::new(vec![whole; 40]);
    assert!(octree.memory_usage() < 100 << 20, "{} bytes", octree.memory_usage());
    let found = visited(&octree, &Ray::new(Vec3::new(0.3, 0.4, 5.0), Vec3::new(0.01, 0.02, -1.0)));
    assert!((0..40).all(|i| found.contains(&i)));
}

#[test]
fn overlapping_triangles_do_not_stop_the_division_of_other_cells() {
    // The first eight boxes fill 230,000 of the smallest cells. The course's rabbit of 1000
    // triangles fills half as many cells.
    let cube = |min: Vec3, size: f32| Aabb { min, max: min + size };
    let mut boxes = vec![cube(Vec3::ZERO, 0.12); 8];
    boxes.push(cube(Vec3::splat(0.9), 0.1));
    boxes.extend((0..8).map(|i| cube(Vec3::new(0.6, 0.3 + 0.01 * i as f32, 0.2), 0.01)));
    let octree = Octree::new(boxes);
    // Along y, the boxes at 0.3 lie in the second quarter of the octree.
    let along = |y: f32| visited(&octree, &Ray::new(Vec3::new(0.6, 0.33, 5.0), Vec3::new(0.001, y, -1.0)));
    assert!(!along(0.0).iter().any(|&i| i > 8), "{:?}", along(0.0));
    assert!(along(1e-6).iter().any(|&i| i > 8), "{:?}", along(1e-6));
}
