//! Counts the rays that miss a closed mesh at its edges and vertices.

use crate::Options;
use crate::embree::{Embree, Quality};
use crate::peers::{BvhCrate, Obvhs, Parry};
use crate::rays::{BenchHit, Mesh, cosine};
use anyhow::Result;
use durer::bvh::{BuildQuality, TriangleBvh};
use durer::math::{Ray, Vec3};
use durer::sampler::random_2d;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// Points of the triangles at which the rays are aimed.
const TARGETS: [&str; 4] = ["vertices", "edge midpoints", "points on edges", "centroids"];

/// Returns a sphere with 10,242 vertices: an icosahedron that is subdivided five times.
fn sphere(center: Vec3, radius: f32) -> Mesh {
    let golden = 0.5 * (1.0 + 5.0_f32.sqrt());
    let mut vertices: Vec<Vec3> = Vec::new();
    for i in 0..3 {
        for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            let mut p = [0.0; 3];
            (p[i], p[(i + 1) % 3]) = (a, b);
            vertices.push(Vec3::from(p).normalize());
        }
    }
    // The faces are the triples of vertices at the minimum distance from each other.
    let near = |i: usize, j: usize| vertices[i].distance(vertices[j]) < 1.2;
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(k, i) {
                    let outward = (vertices[j] - vertices[i]).cross(vertices[k] - vertices[i]).dot(vertices[i]) > 0.0;
                    let [j, k] = if outward { [j, k] } else { [k, j] };
                    triangles.push([i, j, k].map(|i| i as u32));
                }
            }
        }
    }
    for _ in 0..5 {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
                vertices.len() as u32 - 1
            })
        };
        let divide = |[a, b, c]: [u32; 3]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(divide).collect();
    }
    let vertices = vertices.into_iter().map(|p| center + radius * p).collect();
    Mesh { name: "sphere".into(), vertices, triangles }
}

/// Returns ray `i`, which is aimed at one of the triangles, and true if it starts inside the
/// sphere. Otherwise it starts on the triangle's front side.
fn ray(mesh: &Mesh, center: Vec3, radius: f32, target: usize, i: u32) -> (Ray, bool) {
    let [a, b, c] = mesh.corners(i % mesh.triangles.len() as u32);
    let unit = random_2d(4, i, target as u32, 0, 0).x;
    let goal = [a, 0.5 * (a + b), a + unit * (b - a), (a + b + c) / 3.0][target];
    let normal = (goal - center).normalize();
    let inside = (i / mesh.triangles.len() as u32).is_multiple_of(2);
    let origin = match inside {
        true => center + 0.5 * radius * cosine(normal, i, 8),
        // Keep the ray steep enough that it cannot pass the sphere if the target is rounded.
        false => {
            let back = (normal + cosine(normal, i, 9)).normalize();
            goal + radius * (0.5 + 100.0 * random_2d(4, i, target as u32, 0, 1).x) * back
        }
    };
    (Ray::new(origin, goal - origin), inside)
}

/// Returns the number of rays, out of `count`, that miss the mesh, for each kind of target.
fn lost(mesh: &Mesh, place: (Vec3, f32), count: u32, closest: impl Fn(&Ray) -> BenchHit + Sync) -> [usize; 4] {
    [0, 1, 2, 3].map(|target| {
        let is_lost = |i: &u32| closest(&ray(mesh, place.0, place.1, target, *i).0) == BenchHit::NONE;
        (0..count).into_par_iter().filter(is_lost).count()
    })
}

/// Prints the number of rays that each tracer loses.
pub fn run(options: &Options, count: u32) -> Result<()> {
    let embree = match &options.embree {
        Some(path) => Some(Arc::new(Embree::load(path, options.threads)?)),
        None => None,
    };
    println!(
        "Rays that miss a closed sphere of 10,242 vertices, out of {count} for each target, half of them from inside."
    );
    for (center, radius) in [(Vec3::ZERO, 1.0), (Vec3::new(1e6, -1e6, 1e6), 64.0)] {
        let mesh = sphere(center, radius);
        println!("\nsphere of radius {radius} at {center}: {}", TARGETS.join(", "));
        let show = |name: &str, lost: [usize; 4]| println!("  {name:<22}{:?}", lost);
        let tree = TriangleBvh::build(&mesh.vertices, &mesh.triangles, BuildQuality::Best);
        let ours = |ray: &Ray| BenchHit::from(tree.closest(ray));
        show("Dürer", lost(&mesh, (center, radius), count, ours));
        let wrong = [0, 1, 2, 3].map(|target| {
            let is_wrong = |i: &u32| {
                let (ray, inside) = ray(&mesh, center, radius, target, *i);
                tree.hit_count(&ray) % 2 != usize::from(inside)
            };
            (0..count).into_par_iter().filter(is_wrong).count()
        });
        show("Dürer, wrong counts", wrong);
        if let Some(embree) = &embree {
            for (name, robust) in [("Embree", false), ("Embree, robust", true)] {
                let (scene, _) = embree.build(&mesh, Quality::High, robust);
                show(name, lost(&mesh, (center, radius), count, |ray| scene.closest(ray)));
            }
        }
        if options.peers {
            let (obvhs, bvh, parry) = (Obvhs::build(&mesh), BvhCrate::build(&mesh), Parry::build(&mesh));
            show("obvhs", lost(&mesh, (center, radius), count, |ray| obvhs.closest(ray)));
            show("bvh", lost(&mesh, (center, radius), count, |ray| bvh.closest(ray)));
            show("parry3d", lost(&mesh, (center, radius), count, |ray| parry.closest(ray)));
        }
    }
    Ok(())
}
