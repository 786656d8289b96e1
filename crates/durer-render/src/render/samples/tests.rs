//! Tests that taking samples does not allocate memory and that tiles rarely take locks. Otherwise,
//! threads would wait for each other.

use super::*;
use crate::compile::{AccelKind, testing};
use crate::film::Filter;
use crate::integrator::IntegratorKind;
use crate::render::{Control, PartialRender, Shard};
use durer_scene::dialect::Dialect;

/// A scene of mirrors, glass and principled materials under a point light and an area light.
const TEXT: &str = "PerspectiveCamera { center 0 1 8 direction 0 -0.1 -1 up 0 1 0 angle 40 }
Lights { PointLight { position 3 6 4 color 0.9 0.9 0.8 } }
Background { color 0.2 0.1 0.5 ambientLight 0.2 0.2 0.2 }
Materials {
  PhongMaterial { diffuseColor 0.8 0.3 0.2 specularColor 1 1 1 exponent 30 reflectiveColor 0.5 0.5 0.5 }
  PhongMaterial { diffuseColor 0.1 0.1 0.1 transparentColor 0.9 0.9 0.9 refractionIndex 1.5 }
  PrincipledMaterial { baseColor 0.9 0.6 0.3 specularRoughness 0.4 coatWeight 0.5 }
  PrincipledMaterial { baseColor 0 0 0 emissionLuminance 1000 } }
Group {
  MaterialIndex 0 Plane { normal 0 1 0 offset -0.5 }
  MaterialIndex 1 Sphere { center -1 0.5 0 radius 0.9 }
  MaterialIndex 2 Transform { YRotate 30 Box { min 0.4 -0.5 -1 max 1.6 0.7 0.2 } }
  MaterialIndex 3 Rectangle { corner -1 4 -1 edge0 2 0 0 edge1 0 0 2 } }";

/// Returns a job with `width` columns and `samples` samples per pixel.
fn job(width: u32, samples: u32, method: IntegratorKind) -> Job {
    let sampling = Sampling::Filtered { samples, filter: Filter::default() };
    Job { width, height: 32, sampling, method, ..Job::default() }
}

#[test]
fn samples_do_not_allocate() {
    let folder = tempfile::tempdir().unwrap();
    let ball = include_str!("../../../../../scenes/meshes/ball80-smooth.obj");
    std::fs::write(folder.path().join("ball.obj"), ball).unwrap();
    let mesh =
        "Group { MaterialIndex 0 TriangleMesh { obj_file ball.obj } MaterialIndex 1 Plane { normal 0 1 0 offset -1 } }";
    let of_mesh = format!("{}{mesh}", &TEXT[..TEXT.find("Group").unwrap()]);
    let read = |text: &str| testing::try_read(text, Dialect::Durer.rules(), AccelKind::Bvh, folder.path()).0.unwrap();
    let (stop, at) = (AtomicBool::new(false), Cell::new((0, 0, None)));
    let [world, of_mesh] = [read(TEXT), read(&of_mesh)];
    for (world, method) in
        [(&world, IntegratorKind::WHITTED), (&of_mesh, IntegratorKind::WHITTED), (&world, IntegratorKind::PATH)]
    {
        let job = job(32, 64, method);
        let part = job.whole();
        let samples = SampleSource::new(world, &job, &stop);
        let mut film = Film::window(0, 0, 32, 32);
        let mut take = |range: std::ops::Range<u32>| {
            samples.add(&mut film, part, |_| range.clone(), &at, &mut RayCount::default()).unwrap()
        };
        // Fill the thread-local buffers first. They grow to the size that a block needs.
        take(0..16);
        let made = allocation_counter::measure(|| take(16..32));
        assert_eq!(made.count_total, 0, "{method:?}");
    }
}

#[test]
fn tile_locks_twice_per_pass() {
    let world = testing::read(TEXT);
    let locks = |width: u32| {
        let part = PartialRender::new(&world, &job(width, 1, IntegratorKind::WHITTED), Shard::WHOLE).unwrap();
        let control = Control { tile_size: Some(16), threads: Some(2), ..Control::default() };
        part.render(&world, &control, &mut |_, _| {}).unwrap();
        part.locked.load(Relaxed)
    };
    // One sample is one pass, so four additional tiles take the lock eight more times.
    assert_eq!(locks(96) - locks(64), 8);
}
