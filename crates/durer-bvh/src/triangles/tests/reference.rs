//! Tests the trees against an independent triangle test in double precision.

use super::*;
use crate::math::random::rounds;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::AddAssign;

/// Result of the double-precision reference test of a ray against a triangle.
enum Verdict {
    /// The ray crosses the triangle at `t`, with a tolerance for `t`.
    Crossed(f64, f64),
    Missed,
    /// The ray passes or starts too close to an edge for single precision to decide.
    Unsure,
}

/// Computes the reference result from the signs of the volumes that the ray spans with each edge.
/// The rounding error of a corner's coordinates is proportional to its distance from the origin of
/// the ray. The error of a volume is that error times the area spanned by the ray and the other
/// corner.
fn verdict(corners: [Vec3; 3], ray: &Ray) -> Verdict {
    let (o, d) = (ray.origin.as_dvec3(), ray.dir.as_dvec3());
    let [a, b, c] = corners.map(|p| p.as_dvec3() - o);
    let reach = [a, b, c].map(|p| p.abs().max_element()).into_iter().fold(0.0, f64::max);
    let off = 16.0 * f64::from(f32::EPSILON) * reach;
    let [ra, rb, rc] = [a, b, c].map(|p| d.cross(p).length());
    let side = |p: DVec3, q: DVec3, rp: f64, rq: f64| {
        let volume = d.dot(p.cross(q));
        match volume.abs() > off * (rp + rq + off * d.length()) {
            true => volume.signum(),
            false => 0.0,
        }
    };
    let sides = [side(b, c, rb, rc), side(c, a, rc, ra), side(a, b, ra, rb)];
    if sides.contains(&1.0) && sides.contains(&-1.0) {
        return Verdict::Missed;
    }
    let n = (b - a).cross(c - a);
    let (above, volume) = (n.dot(a), n.dot(d));
    let t = above / volume;
    if sides.contains(&0.0) || !t.is_finite() || (t * d.length()).abs() < 1e-3 * reach {
        return Verdict::Unsure;
    }
    // The tolerance covers one rounding to single precision, plus the loss of accuracy in double
    // precision for a grazing ray.
    let loss = 1e-14 * n.length() * (reach + t.abs() * d.length()) / volume.abs();
    match t > 0.0 {
        true => Verdict::Crossed(t, t * f64::from(f32::EPSILON) + loss),
        false => Verdict::Missed,
    }
}

/// Twelve meshes with a few hundred triangles each.
fn dozen() -> Vec<(&'static str, Mesh)> {
    let mut random = Random(21);
    let apart = |vertices: Vec<Vec3>| {
        let triangles = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        (vertices, triangles)
    };
    let slivers = (0..300).flat_map(|_| {
        let (p, along) = (random.point(), random.direction());
        [p, p + along, p + 0.5 * along + 0.01 * random.point()]
    });
    let slivers = apart(slivers.collect());
    let layers = (0..150).flat_map(|i| {
        let y = (i / 2) as f32 / 75.0 - 0.5;
        [Vec3::new(-1.0, y, -1.0), Vec3::new(1.0, y, -1.0), Vec3::new(0.0, y + 0.1, 1.0)]
    });
    let layers = apart(layers.collect());
    let sizes = (0..200).flat_map(|i| {
        let size = libm::pow(1.03, f64::from(i) - 150.0) as f32;
        [size * random.point(), size * random.point(), size * random.point()]
    });
    let sizes = apart(sizes.collect());
    let rim = (0..300).map(|_| random.direction());
    let fan = (rim.chain([Vec3::ZERO]).collect(), (0..300).map(|i| [300, i, (i + 1) % 300]).collect());
    let (hills, bumps) = (torus(20, 16), random.point());
    let hills = (hills.0.iter().map(|p| *p + 0.05 * (9.0 * *p + bumps).fract()).collect(), hills.1);
    let stretch = |mesh: Mesh, by: Vec3| (mesh.0.iter().map(|p| *p * by).collect(), mesh.1);
    vec![
        ("torus", torus(20, 10)),
        ("cube", cube(5)),
        ("bars", bars(&mut random, 400, 100)),
        ("large soup", soup(&mut random, 300, 3.0)),
        ("slivers", slivers),
        ("layers, each twice", layers),
        ("sizes", sizes),
        ("fan", fan),
        ("hills", hills),
        ("needle", stretch(torus(20, 10), Vec3::new(1.0, 1e-3, 1e-2))),
        ("far away", scaled(&torus(20, 10), 1.0, Vec3::new(900.0, -700.0, 300.0))),
        ("small", scaled(&cube(4), 1e-6, Vec3::ZERO)),
    ]
}

/// Number of crossed triangles, and number of triangles that are too close to an edge to decide.
#[derive(Default, Debug)]
struct EdgeCounts {
    crossed: usize,
    unsure: usize,
}

impl AddAssign for EdgeCounts {
    fn add_assign(&mut self, other: Self) {
        self.crossed += other.crossed;
        self.unsure += other.unsure;
    }
}

/// Tests random rays around a mesh, both for all hits and for the closest hit.
fn try_rays(name: &str, mesh: &Mesh, seed: u64, rays: usize) -> EdgeCounts {
    let (vertices, triangles) = mesh;
    let tree = TriangleBvh::build(vertices, triangles, BuildQuality::Best);
    let bounds = tree.bounds();
    let (center, size) = (bounds.center(), bounds.size().max_element());
    let (mut random, mut tried) = (Random(seed), EdgeCounts::default());
    for _ in 0..rays {
        let origin = center + size * random.between(0.1, 2.0) * random.point();
        let goal = center + 0.5 * bounds.size() * random.point();
        let ray = Ray::new(origin, random.between(0.01, 100.0) * (goal - origin));
        let hits = tree.all_hits(&ray);
        assert_eq!(tree.closest(&ray).as_ref().map(bits), hits.first().map(bits), "{name} {ray:?}");
        for (i, triangle) in triangles.iter().enumerate() {
            let hit = || hits.iter().find(|hit| hit.triangle == i as u32);
            match verdict(triangle.map(|i| vertices[i as usize]), &ray) {
                Verdict::Missed => assert!(hits.is_empty() || hit().is_none(), "{name} {i} {ray:?}"),
                Verdict::Unsure => tried.unsure += 1,
                Verdict::Crossed(t, off) => {
                    let hit = hit().unwrap_or_else(|| panic!("{name}: {i} is missed by {ray:?}"));
                    assert!((f64::from(hit.t) - t).abs() <= off, "{name} {i} {ray:?}: {} {t}", hit.t);
                    tried.crossed += 1;
                }
            }
        }
    }
    tried
}

/// Tests 10^5 rays per mesh, or 10^7 in the long run.
#[test]
fn double_precision_reference_agrees() {
    const AT_ONCE: usize = 10_000;
    let all = rounds(100_000);
    let mut cut = 0;
    for (number, (name, mesh)) in dozen().into_iter().enumerate() {
        cut += usize::from(TriangleBvh::build(&mesh.0, &mesh.1, BuildQuality::Best).items() > mesh.1.len());
        let part = |i: usize| try_rays(name, &mesh, (number as u64) << 32 | i as u64, AT_ONCE);
        let tried = (0..all.div_ceil(AT_ONCE)).into_par_iter().map(part).reduce(EdgeCounts::default, |mut a, b| {
            a += b;
            a
        });
        println!("{name}: {all} rays, {} crossings, {} too close to an edge to decide", tried.crossed, tried.unsure);
        assert!(tried.crossed > all / 50 && tried.unsure < tried.crossed / 10, "{name} {tried:?}");
    }
    assert!(cut > 0, "no tree has split triangles");
}
