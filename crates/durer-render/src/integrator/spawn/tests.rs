//! Tests that closed rooms stay dark, even far from the origin.

use super::*;
use crate::compile::{AccelKind, testing};
use crate::integrator::{Integrate, Path as PathTracer, PathOptions, RenderSettings, Whitted};
use crate::world::World;
use durer_scene::dialect::Dialect;
use durer_scene::math::Ray;
use durer_scene::sampler::SampleId;
use std::fmt::Write;
use std::path::Path;

const CORNERS: [[f32; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];
const WALLS: [[usize; 4]; 6] = [[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [3, 2, 6, 7], [0, 3, 7, 4], [1, 5, 6, 2]];

/// Returns an OBJ file with the walls of a room of size 2, centred at a point.
fn room_file(at: Vec3) -> String {
    let mut text = String::new();
    for corner in CORNERS {
        let p = at + Vec3::from(corner);
        writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
    }
    for [a, b, c, d] in WALLS.map(|wall| wall.map(|i| i + 1)) {
        writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
    }
    text
}

/// Returns an OBJ file with a smooth sphere of radius 1, centred at a point.
fn ball_file(at: Vec3) -> String {
    let ball = include_str!("../../../../../scenes/meshes/ball80-smooth.obj");
    let moved = |line: &str| match line.strip_prefix("v ") {
        Some(numbers) => {
            let numbers: Vec<f32> = numbers.split(' ').map(|number| number.parse().unwrap()).collect();
            let p = at + Vec3::from_slice(&numbers);
            format!("v {} {} {}\n", p.x, p.y, p.z)
        }
        None => format!("{line}\n"),
    };
    ball.lines().map(moved).collect()
}

fn triangles(at: Vec3) -> String {
    let corner = |i: usize| {
        let p = at + Vec3::from(CORNERS[i]);
        format!("{} {} {}", p.x, p.y, p.z)
    };
    let triangle = |[a, b, c]: [usize; 3]| {
        format!("Triangle {{ vertex0 {} vertex1 {} vertex2 {} }}\n", corner(a), corner(b), corner(c))
    };
    WALLS.iter().flat_map(|&[a, b, c, d]| [triangle([a, b, c]), triangle([a, c, d])]).collect()
}

/// Builds a room of size 2, centred at a point. A point light and an area light are outside the
/// room, so their light could enter only through cracks.
fn room(walls: &str, at: Vec3, folder: &Path) -> World {
    let (p, light) = (at, at + Vec3::new(3.0, 4.0, 2.5));
    let text = format!(
        "PerspectiveCamera {{ center 0 0 0 direction 0 0 -1 up 0 1 0 angle 60 }}
         Lights {{ PointLight {{ position {} {} {} color 1 1 1 }} }}
         Background {{ color 0 0 0 ambientLight 0 0 0 }}
         Materials {{
             PhongMaterial {{ diffuseColor 1 1 1 }}
             PrincipledMaterial {{ emissionLuminance 1 emissionColor 1 1 1 }}
         }}
         Group {{ MaterialIndex 0 {} MaterialIndex 1 Sphere {{ center {} {} {} radius 0.5 }} }}",
        light.x,
        light.y,
        light.z,
        walls.replace("PLACE", &format!("{} {} {}", p.x, p.y, p.z)),
        light.x,
        light.y + 1.0,
        light.z,
    );
    let (world, found) = testing::try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, folder);
    world.unwrap_or_else(|| panic!("{found:?}"))
}

/// Returns the number of rays, out of `count`^2 rays from inside a room in all directions, that see
/// light with Whitted ray tracing or path tracing.
fn leaks(world: &World, at: Vec3, count: usize) -> usize {
    let settings = RenderSettings {
        bounces: 0,
        shadows: true,
        shade_back: true,
        transparent_shadows: false,
        reflection: false,
        refraction: false,
        min_weight: 0.0,
    };
    let whitted = Whitted { world, settings, cancel: None };
    let path = PathTracer::new(world, RenderSettings { bounces: 5, ..settings }, PathOptions::default());
    let eye = at + Vec3::new(0.25, -0.125, 0.5);
    let sees = |i: usize| {
        let (u, v) = ((i % count) as f32 + 0.5, (i / count) as f32 + 0.5);
        let [x, y] = [u, v].map(|x| 2.0 * x / count as f32 - 1.0);
        // Shoot rays through pictures of 90 degrees in the directions +z, -z, +y and +x.
        let dir = [Vec3::new(x, y, 1.0), Vec3::new(x, y, -1.0), Vec3::new(x, 1.0, y), Vec3::new(1.0, x, y)][i % 4];
        let ray = Ray::new(eye, dir);
        assert!(world.closest(&ray, &mut ()).is_some(), "{ray:?}");
        whitted.radiance(&ray, &mut ()) + path.radiance(&ray, SampleId::new(1, (i as u32, 0), 0), &mut ()) != Vec3::ZERO
    };
    (0..count * count).filter(|&i| sees(i)).count()
}

#[test]
fn closed_rooms_stay_dark_at_any_distance_from_the_origin() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("near.obj"), room_file(Vec3::ZERO)).unwrap();
    std::fs::write(folder.path().join("ball.obj"), ball_file(Vec3::ZERO)).unwrap();
    let mut table = String::new();
    let mut all = 0;
    for distance in [0.0, 1e2, 1e3, 1e4, 1e5, 1e6] {
        let at = distance * Vec3::new(1.0, -0.75, 0.5);
        std::fs::write(folder.path().join("far.obj"), room_file(at)).unwrap();
        std::fs::write(folder.path().join("far-ball.obj"), ball_file(at)).unwrap();
        let box_at = |m: f32| at + Vec3::splat(m);
        let words = |p: Vec3| format!("{} {} {}", p.x, p.y, p.z);
        let [min, max] = [-1.0, 1.0].map(|m| words(box_at(m)));
        let rooms = [
            ("mesh", "Transform { Translate PLACE TriangleMesh { obj_file near.obj } }".into()),
            ("far mesh", "TriangleMesh { obj_file far.obj }".into()),
            ("smooth mesh", "Transform { Translate PLACE TriangleMesh { obj_file ball.obj } }".into()),
            ("far smooth mesh", "TriangleMesh { obj_file far-ball.obj }".into()),
            ("triangles", triangles(at)),
            ("box", format!("Box {{ min {min} max {max} }}")),
            ("moved box", "Transform { Translate PLACE Box { min -1 -1 -1 max 1 1 1 } }".into()),
            ("cylinder", format!("Cylinder {{ base {} top {} radius 1 }}", words(at - Vec3::Y), words(at + Vec3::Y))),
            (
                "cone",
                format!(
                    "Cone {{ base {} top {} baseRadius 1.5 topRadius 1 }}",
                    words(at - Vec3::Y),
                    words(at + Vec3::Y)
                ),
            ),
            ("sphere", "Sphere { center PLACE radius 1 }".into()),
            (
                "solid",
                format!("Intersection {{ Box {{ min {min} max {max} }} Sphere {{ center PLACE radius 1.3 }} }}"),
            ),
            (
                "union",
                format!(
                    "Union {{ Box {{ min {min} max {max} }} Cylinder {{ base {} top {} radius 1.2 }} }}",
                    words(at - 0.8 * Vec3::Y),
                    words(at + 0.9 * Vec3::Y)
                ),
            ),
            (
                "merge",
                format!(
                    "Merge {{ Box {{ min {min} max {max} }} Cylinder {{ base {} top {} radius 1.2 }} }}",
                    words(at - 0.8 * Vec3::Y),
                    words(at + 0.9 * Vec3::Y)
                ),
            ),
            (
                "moved solid",
                "Transform { Translate PLACE Intersection { Box { min -1 -1 -1 max 1 1 1 } Sphere { center 0 0 0 radius 1.3 } } }"
                    .into(),
            ),
            (
                "hollow solid",
                format!("Difference {{ Sphere {{ center PLACE radius 3 }} Box {{ min {min} max {max} }} }}"),
            ),
        ];
        for (name, walls) in rooms {
            let count = leaks(&room(&walls, at, folder.path()), at, 96 * durer_scene::math::random::rounds(1));
            writeln!(table, "{name} at {distance}: {count}").unwrap();
            all += count;
        }
    }
    assert_eq!(all, 0, "leaks:\n{table}");
}

#[test]
fn shadow_rays_of_curved_surfaces_end_at_the_light() {
    let mut surface =
        SurfacePoint::new(glam::DVec3::new(0.1, 0.2, 0.3), glam::DVec3::Y, 1e-7, durer_scene::math::Vec2::ZERO);
    surface.shadow_offsets = [Vec3::new(0.01, 0.05, -0.02), Vec3::ZERO];
    let to = Vec3::new(2.0, 3.0, 1.0);
    let ray = to_point(&surface, to.normalize(), to.length());
    let end = ray.origin() + f64::from(ray.rounded.t_max) * ray.dir().as_dvec3();
    assert!((end - surface.point() - to.as_dvec3()).length() < 1e-5, "{end}");
    // A parallel ray ends at another point. A ray of infinite length stays parallel.
    let parallel = to_light(&surface, to.normalize(), to.length(), None);
    let end = parallel.origin() + f64::from(parallel.rounded.t_max) * parallel.dir().as_dvec3();
    assert!((end - surface.point() - to.as_dvec3()).length() > 0.01);
    assert_eq!(to_point(&surface, Vec3::Y, f32::INFINITY).dir(), Vec3::Y);
}

#[test]
fn materials_choose_where_shadow_rays_of_smooth_meshes_start() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.obj"), include_str!("../../../../../scenes/meshes/ball80-smooth.obj"))
        .unwrap();
    for (word, is_smooth) in [("on", true), ("off", false)] {
        let text = format!(
            "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }}
            Materials {{ PrincipledMaterial {{ smoothShadows {word} }} }}
            Group {{ MaterialIndex 0 TriangleMesh {{ obj_file ball.obj }} }}"
        );
        let (world, found) = testing::try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, folder.path());
        let world = world.unwrap_or_else(|| panic!("{found:?}"));
        let at = world.intersect(Ray::new(Vec3::new(0.1, 0.2, 5.0), Vec3::NEG_Z), &mut ()).unwrap();
        assert_eq!(at.surface.shadow_offsets != [Vec3::ZERO; 2], is_smooth, "{word}");
    }
}
