//! Tests of trees and grids with difficult boxes.

use super::traverse::{TraversalRay, is_valid};
use super::*;
use crate::math::random::Random;
use crate::math::{Aabb, Ray, Vec3};
use crate::node::MAX_DEPTH;

fn cube(center: Vec3, half: f32) -> Aabb {
    Aabb { min: center - half, max: center + half }
}

/// Returns sets of difficult boxes, each with a name for test messages.
fn collections() -> Vec<(&'static str, Vec<Aabb>)> {
    let mut random = Random(1);
    let mut some = |count: usize, half: &dyn Fn(usize) -> f32, place: f32| -> Vec<Aabb> {
        (0..count).map(|i| cube(place * random.point(), half(i))).collect()
    };
    let corner = |i: usize| Vec3::splat(libm::powf(1.9, i as f32 % 180.0 - 90.0));
    vec![
        ("none", Vec::new()),
        ("one", some(1, &|_| 1.0, 1.0)),
        ("five", some(5, &|_| 0.1, 1.0)),
        ("random", some(5_000, &|_| 0.02, 1.0)),
        ("points", some(2_000, &|_| 0.0, 1.0)),
        ("identical", vec![cube(Vec3::ONE, 1.0); 100_000]),
        ("identical points", vec![cube(Vec3::ONE, 0.0); 10_000]),
        ("series around one point", (0..2_000).map(|i| cube(Vec3::ZERO, corner(i).x)).collect()),
        ("series of corners", (0..2_000).map(|i| Aabb { min: Vec3::ZERO, max: corner(i) }).collect()),
        ("series of places", (0..2_000).map(|i| cube(corner(i), 0.0)).collect()),
        (
            "flat",
            (0..1_000).map(|i| Aabb { min: Vec3::X * i as f32, max: Vec3::new(i as f32 + 1.0, 0.0, 1.0) }).collect(),
        ),
        ("huge", some(500, &|_| 1e38, 1e38)),
        ("larger than numbers", vec![Aabb { min: Vec3::MIN, max: Vec3::MAX }; 100]),
        ("denormal", some(500, &|_| 1e-42, 1e-40)),
        (
            "empty ones between",
            (0..100).map(|i| if i % 3 == 0 { Aabb::EMPTY } else { cube(Vec3::X * i as f32, 0.4) }).collect(),
        ),
    ]
}

/// Returns the depth of a subtree in nodes.
fn depth(nodes: &[node::WideNode], number: usize) -> usize {
    let inner = nodes[number].children().filter(|(_, _, child)| child & node::LEAF == 0);
    1 + inner.map(|(_, _, child)| depth(nodes, node::node_index(child))).max().unwrap_or(0)
}

/// Returns true if the tags of a node's children agree with their codes.
pub fn codes_are_right(node: &node::WideNode) -> bool {
    node.children().all(|(place, _, child)| {
        let code = u32::from(node.child_tags[place]);
        let is_there = match child & node::LEAF {
            0 => code & node::IS_LEAF == 0 && node.first + (code & node::OFFSET_BITS) == child,
            _ => code & node::IS_LEAF != 0,
        };
        is_there && code & node::SLOT_BITS == place as u32
    })
}

#[test]
fn every_box_on_a_ray_is_visited() {
    let (mut random, mut fast) = (Random(2), 0);
    for (name, boxes) in collections() {
        let bvh = Bvh::build(&boxes);
        let mut order = bvh.primitive_indices().to_vec();
        order.sort_unstable();
        let full: Vec<u32> = (0..boxes.len() as u32).filter(|&i| !boxes[i as usize].is_empty()).collect();
        assert_eq!(order, full, "{name}");
        if full.is_empty() {
            bvh.traverse(&Ray::new(Vec3::ZERO, Vec3::X), &mut (), |_, _, _| panic!("nothing is there"));
            continue;
        }
        assert!(depth(&bvh.nodes, 0) <= MAX_DEPTH, "{name}: {}", depth(&bvh.nodes, 0));
        assert!(bvh.nodes.iter().all(codes_are_right), "{name}");
        for round in 0..200 {
            let i = full[random.below(full.len())];
            let b = boxes[i as usize];
            // Returns a point of the box, which is on its boundary in two of three rounds, and a
            // ray to it from near or far.
            let mix = |random: &mut Random| [random.unit(), 0.0, 1.0][random.below(3)];
            let w = Vec3::new(mix(&mut random), mix(&mut random), mix(&mut random));
            let target = b.min * (Vec3::ONE - w) + b.max * w;
            let reach = (0.5 * b.size()).max_element().max(1e-37);
            let axis = Vec3::AXES[random.below(3)];
            let step = if round % 2 == 0 { reach * random.point() } else { reach * axis };
            // The ray reaches the point at t = 1.
            let (t_min, t_max) = [
                (f32::NEG_INFINITY, f32::INFINITY),
                (0.0, f32::INFINITY),
                (0.0, 1.0),
                (1f32.next_down(), 1f32.next_up()),
            ][random.below(4)];
            let ray = Ray { t_min, t_max, ..Ray::new(target - step, step) };
            if !is_valid(&ray) {
                continue;
            }
            fast += u32::from(TraversalRay::new(&ray, bvh.bounds().max_abs_coordinate()).is_some());
            let mut offered = false;
            bvh.traverse(&ray, &mut (), |item, t_max, _| {
                offered |= bvh.primitive_indices()[item] == i;
                t_max
            });
            assert!(offered, "{name}: {b:?} {ray:?}");
        }
    }
    assert!(fast > 500, "{fast}");
}

#[test]
#[cfg_attr(target_family = "wasm", ignore = "no threads there")]
fn tree_is_independent_of_the_number_of_threads() {
    let mut random = Random(3);
    let boxes: Vec<Aabb> = (0..30_000).map(|_| cube(random.point(), 0.01 * random.unit())).collect();
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        format!("{:?}", pool.install(|| Bvh::build(&boxes)))
    };
    assert!(build(1) == build(2));
}

#[test]
fn boxes_at_the_ray_end_are_offered_and_traversal_stops_on_request() {
    let boxes: Vec<Aabb> = (0..100).map(|i| cube(Vec3::X * i as f32, 0.5)).collect();
    let bvh = Bvh::build(&boxes);
    let ray = Ray::new(Vec3::X * -1.5, Vec3::X);
    let mut last = 0;
    bvh.traverse(&ray, &mut (), |item, t_max, _| {
        last = last.max(bvh.primitive_indices()[item]);
        t_max.min(11.0)
    });
    // t = 11 is x = 9.5, which is the last face of box 9 and the first face of box 10.
    assert!(last >= 10, "{last}");
    let mut offered = 0;
    bvh.traverse(&ray, &mut (), |_, _, _| {
        offered += 1;
        f32::NEG_INFINITY
    });
    assert!(offered <= node::LEAF_SIZE, "{offered}");
}

#[test]
fn slab_is_clipped_by_the_sign_of_the_direction() {
    let b = cube(Vec3::ZERO, 1.0);
    assert_eq!(b.clip(Vec3::new(-3.0, 0.0, 0.0), Vec3::X), Some((2.0, 4.0)));
    assert_eq!(b.clip(Vec3::new(3.0, 0.0, 0.0), Vec3::X * -2.0), Some((1.0, 2.0)));
    // The rays lie in a face, along an edge, and just outside them.
    assert_eq!(b.clip(Vec3::new(-3.0, 1.0, 0.0), Vec3::X), Some((2.0, 4.0)));
    assert_eq!(b.clip(Vec3::new(-3.0, 1.0, -1.0), Vec3::X), Some((2.0, 4.0)));
    assert_eq!(b.clip(Vec3::new(-3.0, 1.0f32.next_up(), 0.0), Vec3::X), None);
    assert_eq!(b.clip(Vec3::ZERO, Vec3::ZERO), Some((f32::NEG_INFINITY, f32::INFINITY)));
}

#[test]
fn grids_contain_everything_or_are_refused() {
    let unit = cube(Vec3::ZERO, 1.0);
    for counts in [[0, 1, 1], [1, 0, 5], [u32::MAX, u32::MAX, u32::MAX], [1 << 13, 1 << 13, 2]] {
        assert!(Grid::build(unit, counts, &[unit], |_, _| true).is_none(), "{counts:?}");
    }
    // Large primitives that overlap many cells are rejected before memory is allocated.
    assert!(Grid::build(unit, [256, 256, 256], &vec![unit; 1000], |_, _| true).is_none());
    let one = Grid::build(unit, [1, 1, 1], &[unit], |_, _| true).unwrap();
    assert_eq!(one.occupancy([0, 0, 0]), 1);
    for (name, boxes) in collections() {
        let bounds = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
        if bounds.is_empty() || name == "identical" || name == "larger than numbers" || name == "huge" {
            continue;
        }
        let counts = Grid::suggested_resolution(bounds, boxes.len());
        assert!(counts.iter().all(|n| (1..=256).contains(n)), "{name}: {counts:?}");
        let grid = Grid::build(bounds, counts, &boxes, |_, _| true).unwrap_or_else(|| panic!("{name}"));
        let mut random = Random(4);
        for _ in 0..100 {
            let i = random.below(boxes.len());
            let (target, from) = (boxes[i].center(), bounds.center() + bounds.size() * random.point());
            let ray = Ray { t_min: f32::NEG_INFINITY, ..Ray::new(from, target - from) };
            if boxes[i].is_empty() || !is_valid(&ray) {
                continue;
            }
            let mut offered = false;
            grid.traverse(&ray, &mut (), |item, t_max, _| {
                offered |= item == i;
                t_max
            });
            assert!(offered, "{name}: {:?} {ray:?}", boxes[i]);
        }
    }
}

#[test]
fn grid_cells_are_visited_in_order_and_only_up_to_the_hit() {
    let unit = cube(Vec3::ZERO, 1.0);
    let grid = Grid::build(unit, [4, 4, 4], &[], |_, _| true).unwrap();
    let visited = |ray: Ray, limit: f32| {
        let mut cells = Vec::new();
        grid.traverse_cells(&ray, |_, cell, t_max| {
            cells.push(cell);
            t_max.min(limit)
        });
        cells
    };
    let along = Ray::new(Vec3::new(-5.0, 0.1, 0.1), Vec3::X);
    assert_eq!(visited(along, f32::INFINITY), [[0, 2, 2], [1, 2, 2], [2, 2, 2], [3, 2, 2]]);
    assert_eq!(visited(along, 4.7), [[0, 2, 2], [1, 2, 2]]);
    let back = Ray::new(Vec3::new(5.0, 0.1, 0.1), Vec3::NEG_X);
    assert_eq!(visited(back, f32::INFINITY), [[3, 2, 2], [2, 2, 2], [1, 2, 2], [0, 2, 2]]);
    let steep = Ray::new(Vec3::new(-0.1, -0.1, 0.1), Vec3::new(1.0, 0.5, 0.0));
    assert_eq!(visited(steep, f32::INFINITY), [[1, 1, 2], [2, 1, 2], [2, 2, 2], [3, 2, 2]]);
    assert_eq!(visited(Ray::new(Vec3::splat(3.0), Vec3::X), f32::INFINITY), [[0; 3]; 0]);
}

/// Directions with zero components are common, for example with orthographic cameras, voxels, or a
/// sun straight overhead.
#[test]
fn rays_with_zero_components_are_fast() {
    let is_fast = |origin, dir| TraversalRay::new(&Ray::new(origin, dir), 3.0).is_some();
    for (axis, least) in
        [0.0, -0.0, 1e-45, -1e-42, f32::MIN_POSITIVE, 1e-20].into_iter().flat_map(|x| (0..3).map(move |axis| (axis, x)))
    {
        for length in [1e-6, 1.0, -1.0, 1e14] {
            let mut dir = Vec3::splat(least);
            dir[axis] = length;
            assert!(is_fast(Vec3::ONE, dir), "{dir}");
            dir[(axis + 1) % 3] = length;
            assert!(is_fast(Vec3::ZERO, dir), "{dir}");
        }
    }
    assert!(is_fast(Vec3::ONE, Vec3::splat(1e-9)));
    assert!(!is_fast(Vec3::ONE, Vec3::new(1e-9, 1e-9, 1e-20)));
    for extreme in [0.0, 1e-20, 1e20, f32::INFINITY, f32::NAN] {
        assert!(!is_fast(Vec3::ONE, extreme * Vec3::X), "{extreme}");
        assert_eq!(is_fast(Vec3::ONE, Vec3::new(0.0, extreme, 1.0)), extreme < 1.0, "{extreme}");
        assert_eq!(is_fast(extreme * Vec3::ONE, Vec3::X), extreme < 1.0, "{extreme}");
    }
}

#[test]
fn distant_ray_is_offered_few_boxes_and_every_hit() {
    let at = |i: usize| (i % 20) as f32 / 10.0 - 0.95;
    let boxes: Vec<Aabb> = (0..8000).map(|i| cube(Vec3::new(at(i), at(i / 20), at(i / 400)), 0.04)).collect();
    let bounds = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    let grid = Grid::build(bounds, Grid::suggested_resolution(bounds, boxes.len()), &boxes, |_, _| true).unwrap();
    let mut random = Random(9);
    for distance in [1e2, 1e3, 3e3, 1e4, 1e5, 1e6] {
        let mut offered = 0;
        for _ in 0..100 {
            let target = 0.9 * random.point();
            let ray = Ray::new(target + distance * random.direction(), Vec3::ZERO);
            let ray = Ray { dir: target - ray.origin, ..ray };
            let mut visited = vec![false; boxes.len()];
            grid.traverse(&ray, &mut (), |item, t_max, _| {
                offered += 1;
                visited[item] = true;
                t_max
            });
            // If the line hits a box after the box is enlarged by the rounding error, the grid must
            // offer that box.
            let slip = 2.0 * f32::EPSILON * distance;
            for (i, b) in boxes.iter().enumerate() {
                let near = Aabb { min: b.min - slip, max: b.max + slip };
                let line = ray.line();
                let enters = (0..3).map(|a| {
                    let [t, u] =
                        [near.min[a], near.max[a]].map(|wall| (f64::from(wall) - line.origin[a]) / line.dir[a]);
                    (t.min(u), t.max(u))
                });
                let (enter, leave) = enters.fold((f64::MIN, f64::MAX), |(e, l), (t, u)| (e.max(t), l.min(u)));
                assert!(visited[i] || enter > leave, "{distance}: {i} is missed");
            }
        }
        // Even if rounding may move the ray anywhere, each primitive is offered at most once.
        assert!(offered <= 100 * boxes.len(), "{distance}: {offered}");
        assert!(distance > 3e3 || offered < 100 * 400, "{distance}: {offered}");
    }
}
