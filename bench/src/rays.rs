//! Meshes and rays, which are identical for all tracers.

use anyhow::{Context, Result};
use durer::bvh::TriangleHit;
use durer::diag::Diagnostics;
use durer::format::read_mesh;
use durer::math::{Aabb, Ray, Vec3};
use durer::sampler::random_2d;
use std::path::Path;

/// Distance and triangle of a hit, as compared between tracers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchHit {
    pub t: f32,
    pub triangle: u32,
}

impl From<Option<TriangleHit>> for BenchHit {
    fn from(hit: Option<TriangleHit>) -> BenchHit {
        hit.map_or(BenchHit::NONE, |TriangleHit { t, triangle, .. }| BenchHit { t, triangle })
    }
}

impl BenchHit {
    /// A miss.
    pub const NONE: BenchHit = BenchHit { t: f32::INFINITY, triangle: u32::MAX };
}

/// Triangle mesh that every tracer builds its BVH from.
pub struct Mesh {
    pub name: String,
    pub vertices: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Reads a mesh file.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
        let mut diagnostics = Diagnostics::default();
        let data = read_mesh(&bytes, 0, &path.to_string_lossy(), &mut diagnostics);
        let data = data.with_context(|| format!("{} is not a mesh", path.display()))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Mesh { name, vertices: data.positions, triangles: data.triangles })
    }

    /// Returns the bounds of the triangles.
    pub fn bounds(&self) -> Aabb {
        Aabb::around(self.triangles.iter().flatten().map(|&i| self.vertices[i as usize]))
    }

    /// Returns the vertices of a triangle.
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|i| self.vertices[i as usize])
    }
}

/// Rays of one kind to be timed; `any` is true if they need any hit instead of the closest.
pub struct RayCase {
    pub name: &'static str,
    pub any: bool,
    /// True if consecutive rays are close to each other in space.
    pub coherent: bool,
    pub rays: Vec<Ray>,
}

/// Returns true if the mesh is a room that is seen from inside.
fn is_interior(mesh: &Mesh) -> bool {
    ["hall", "kitchen"].contains(&mesh.name.as_str())
}

/// Returns camera rays: from outside for objects, from the middle for rooms.
fn primary(mesh: &Mesh, side: u32) -> Vec<Ray> {
    let bounds = mesh.bounds();
    let hall = is_interior(mesh);
    let radius = 0.5 * bounds.size().length();
    let (eye, forward, spread) = if hall {
        let forward = Vec3::new(0.8, -0.1, 0.59).normalize();
        (bounds.center() - 0.15 * bounds.size() * forward, forward, 0.7)
    } else {
        let eye = bounds.center() + radius * Vec3::new(0.6, 0.35, 1.6);
        (eye, (bounds.center() - eye).normalize(), 0.42)
    };
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    // Use tiles of 8 x 8 pixels, as renderers do. Sixteen consecutive rays are a block of 4 x 4.
    let order = |i: u32| {
        let (tile, within) = (i / 64, i % 64);
        let (block, pixel) = (within / 16, within % 16);
        let tiles = side / 8;
        let x = tile % tiles * 8 + block % 2 * 4 + pixel % 4;
        let y = tile / tiles * 8 + block / 2 * 4 + pixel / 4;
        (x, y)
    };
    (0..side * side)
        .map(|i| {
            let (x, y) = order(i);
            let jitter = random_2d(1, x, y, 0, 0);
            let [u, v] = [x as f32 + jitter.x, y as f32 + jitter.y].map(|c| (c / side as f32 * 2.0 - 1.0) * spread);
            Ray::new(eye, (forward + u * right - v * up).normalize())
        })
        .collect()
}

/// Returns a direction around a normal, with a pdf proportional to the cosine.
pub fn cosine(n: Vec3, i: u32, dimension: u32) -> Vec3 {
    let u = random_2d(2, i, 0, 0, dimension);
    let z = 2.0 * u.x - 1.0;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = durer::math::fp::sin_cos_degrees(360.0 * f64::from(u.y));
    let on_sphere = Vec3::new(r * cos as f32, r * sin as f32, z);
    (n + 0.999 * on_sphere).normalize()
}

/// Generates rays of every kind for a mesh, with `side`^2 primary rays. `closest` returns their
/// hits.
pub fn cases(mesh: &Mesh, side: u32, closest: impl Fn(&Ray) -> BenchHit) -> Vec<RayCase> {
    let size = mesh.bounds().size().length();
    let first = primary(mesh, side);
    let (mut bounces, mut shadows, mut occlusions) = (Vec::new(), Vec::new(), Vec::new());
    // The light is above objects, or between floor and ceiling in rooms.
    let hall = is_interior(mesh);
    let away = if hall { 0.3 * mesh.bounds().size() } else { Vec3::splat(size) };
    let light = mesh.bounds().center() + away * Vec3::new(0.32, 0.81, 0.47);
    for (i, ray) in first.iter().enumerate() {
        let i = i as u32;
        let found = closest(ray);
        if found == BenchHit::NONE {
            continue;
        }
        let [a, b, c] = mesh.corners(found.triangle);
        let n = (b - a).cross(c - a).normalize_or(Vec3::Y);
        let n = if n.dot(ray.dir) > 0.0 { -n } else { n };
        let origin = ray.at(found.t) + 1e-4 * size * n;
        bounces.push(Ray::new(origin, cosine(n, i, 1)));
        shadows.push(Ray { t_max: 1.0, ..Ray::new(origin, light - origin) });
        occlusions.push(Ray { t_max: 0.2 * size, ..Ray::new(origin, cosine(n, i, 2)) });
    }
    let mut shuffled = bounces.clone();
    for i in (1..shuffled.len()).rev() {
        let at = durer::sampler::hash(3, i as u32, 0, 0, 0) as usize % (i + 1);
        shuffled.swap(i, at);
    }
    vec![
        RayCase { name: "primary", any: false, coherent: true, rays: first },
        RayCase { name: "bounce", any: false, coherent: false, rays: bounces },
        RayCase { name: "shuffled", any: false, coherent: false, rays: shuffled },
        RayCase { name: "shadow", any: true, coherent: true, rays: shadows },
        RayCase { name: "ambient", any: true, coherent: false, rays: occlusions },
    ]
}
