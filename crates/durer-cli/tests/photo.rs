//! `durer photo`: photographs that Dürer takes itself, of which all is known, and what is no photograph.

mod common;

use common::Place;
use durer_photo::format::{projective_camera, read};
use durer_photo::geometry::align::{Similarity, similarity};
use durer_photo::model::axis_angle_of;
use durer_photo::{Lens, Pose, Reconstruction};
use nalgebra::Vector3;

/// Width, height and focal length of the photographs.
const SIZE: [u32; 2] = [400, 300];
const FOCAL: f64 = 410.0;
/// How long the scene is.
const LENGTH: f64 = 8.0;

/// Boxes and walls of noise in even light.
const SCENE: &str = "
Background { color 0.1 0.1 0.1 ambientLight 1 1 1 }
Materials { numMaterials 3
  PhongMaterial { Noise { color 1 0.95 0.8 color 0.05 0.1 0.1 octaves 6 frequency 3 amplitude 12 } }
  PhongMaterial { Noise { color 1 0.4 0.2 color 0.1 0.1 0.3 octaves 6 frequency 4 amplitude 14 } }
  PhongMaterial { Noise { color 0.9 1 0.9 color 0.1 0.3 0.1 octaves 6 frequency 5 amplitude 12 } } }
Group { numObjects 8
  MaterialIndex 0 Rectangle { corner -4 0 4 edge0 8 0 0 edge1 0 0 -8 }
  MaterialIndex 2 Rectangle { corner -4 0 -2.5 edge0 8 0 0 edge1 0 4 0 }
  MaterialIndex 1 Rectangle { corner -4 0 4 edge0 0 0 -8 edge1 0 4 0 }
  MaterialIndex 1 Box { min -1.2 0 -0.8 max 0.1 1.1 0.3 }
  MaterialIndex 2 Box { min 0.4 0 -1.4 max 1.5 1.9 -0.4 }
  MaterialIndex 0 Box { min 0.6 0 0.4 max 1.3 0.6 1.1 }
  MaterialIndex 2 Sphere { center -1.6 0.5 1.2 radius 0.5 }
  MaterialIndex 1 Box { min -2.8 0 -1.9 max -1.8 1.5 -1 } }
";

/// The cameras: twenty in two rows on an arc.
fn cameras() -> Vec<Pose> {
    let camera = |i: usize| {
        let (angle, height) = ((f64::from(i as u32 % 10) - 4.5) * 0.11, if i < 10 { 1.4 } else { 2.6 });
        let center = Vector3::new(6.0 * libm::sin(angle), height, 6.0 * libm::cos(angle) - 0.5);
        Pose::look_at(&center, &Vector3::new(0.05 * height, 0.7, -0.3), &Vector3::y())
    };
    (0..20).map(camera).collect()
}

/// How far a solution is from the truth: the farthest camera's place, its angle in degrees, and the similarity.
fn differences(all: &Reconstruction, truth: &[Pose]) -> (f64, f64, Similarity) {
    let found: Vec<Pose> = all.views.iter().map(|view| view.pose.unwrap()).collect();
    let centers = |poses: &[Pose]| poses.iter().map(|pose| pose.center()).collect::<Vec<_>>();
    let there = similarity(&centers(&found), &centers(truth)).unwrap();
    let (mut place, mut angle) = (0.0_f64, 0.0_f64);
    for (found, truth) in found.iter().zip(truth) {
        place = place.max((there.apply(&found.center()) - truth.center()).norm());
        let turned = found.rotation * there.rotation.transpose() * truth.rotation.transpose();
        angle = angle.max(axis_angle_of(&turned).norm().to_degrees());
    }
    (place, angle, there)
}

#[test]
fn photographs_of_a_known_scene_give_its_cameras() {
    let place = Place::new();
    std::fs::create_dir(place.path("photos")).unwrap();
    let lens = Lens::new(SIZE, FOCAL);
    for (i, pose) in cameras().iter().enumerate() {
        place.put("shot.txt", projective_camera(&lens, pose) + SCENE);
        let [width, height] = SIZE;
        place.gives(0, &format!("render shot.txt -o photos/{i:02}.png --size {width}x{height} --samples 4 -q"));
    }
    place.gives(0, "photo match photos -o matches.json --features 1200 --field 60 -q");
    let solved = place.gives(0, "photo solve matches.json -o solved -o points.ply -o scene.gltf -o bundle.out");
    println!("{}", solved.out);
    let all = read(&place.path("solved")).unwrap();
    assert_eq!(all.registered(), 20);
    let (far, angle, _) = differences(&all, &cameras());
    let focal = (all.lenses[0].focal / FOCAL - 1.0).abs();
    println!("{far} {angle} {focal}");
    assert!(far <= 0.001 * LENGTH, "{far}");
    assert!(angle <= 0.05, "{angle}");
    assert!(focal <= 0.002, "{focal}");
}
