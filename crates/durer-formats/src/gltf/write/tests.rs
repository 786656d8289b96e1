//! Tests that reading a written file gives the same scene.

use crate::folder::FolderSource;
use crate::scene::{SCENE_FORMATS, WriteContext};
use crate::testing::{folder, read_in};
use durer::{LoadOptions, load_text};
use durer_diag::{Diagnostics, Files};
use durer_scene::dialect::MeshNormals;
use durer_scene::light::Light;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::{Backs, Walls};
use durer_scene::math::Vec3;
use durer_scene::scene::{Material, Scene, SceneDefaults};

/// Reads a scene in the scene language, which must be valid.
fn scene(text: &str) -> Scene {
    let (scene, messages) = read_in(&std::env::temp_dir(), "a.txt", text);
    scene.unwrap_or_else(|| panic!("{messages:?}"))
}

/// Writes a scene and reads it back. Returns the resulting scene and the diagnostics of the writer.
fn again(scene: &Scene, name: &str) -> (Scene, Vec<String>) {
    let folder = folder(&[]);
    let source = FolderSource::new(folder.path());
    let mut messages = Diagnostics::default();
    let output =
        WriteContext { name, source: &source, normals: MeshNormals::Flat, srgb_textures: false, memory: u64::MAX };
    let write = SCENE_FORMATS.iter().find(|format| format.extensions.contains(&"glb")).unwrap().write.unwrap();
    let bytes = write(scene, &output, &mut messages).bytes;
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let scene_defaults = SceneDefaults { convert_only: true, ..SceneDefaults::default() };
    let options = LoadOptions { scene_defaults, ..LoadOptions::default() };
    let loaded = load_text(&folder.path().join(name), bytes.as_slice().into(), &options, &mut files, &mut diagnostics);
    assert_eq!(diagnostics.iter().map(|d| d.message.clone()).collect::<Vec<_>>(), [""; 0]);
    (loaded.unwrap().scene, messages.iter().map(|d| d.message.clone()).collect())
}

const HEAD: &str = "PerspectiveCamera { center 1 2 9 direction 0 0 -1 up 0 1 0 angle 30 } ";

#[test]
fn materials_round_trip() {
    let words = "PrincipledMaterial { baseColor 0.1 0.2 0.3 specularRoughness 0.5 specularIor 1.7 specularWeight 0.5
        coatWeight 0.75 coatRoughness 0.1 coatIor 1.5 coatDarkening 0 fuzzWeight 0.5 fuzzColor 1 0.5 0.25 fuzzRoughness 0.3 specularAnisotropy 0.4
        specularRotation 0.125 emissionLuminance 8 emissionColor 1 0.5 0 opacity 0.5 walls thin }
      PrincipledMaterial { baseColor 1 1 1 specularRoughness 0 transmissionWeight 1 transmissionDepth 2 transmissionColor 0.9 0.5 0.1 }
      PrincipledMaterial { baseColor 0.5 1 0.5 specularRoughness 0 transmissionWeight 1 transmissionColor 0.5 1 0.5 walls thin }
      PrincipledMaterial { baseColor 0.9 0.6 0.3 baseMetalness 0.25 specularRoughness 0.5 }";
    let balls: String = (0..4).map(|i| format!("MaterialIndex {i} Sphere {{ center {i} 0 0 radius 0.4 }} ")).collect();
    let before = scene(&format!("{HEAD} Materials {{ numMaterials 4 {words} }} Group {{ numObjects 4 {balls} }}"));
    for name in ["a.glb", "a.gltf"] {
        let (after, messages) = again(&before, name);
        assert_eq!(messages, [""; 0]);
        for (i, (old, new)) in before.materials.iter().zip(&after.materials).enumerate() {
            let layers = |material: &Material| -> PrincipledMaterial {
                let Material::Principled(layers) = material else { panic!() };
                (**layers).clone()
            };
            let (old, mut new) = (layers(&old.value), layers(&new.value));
            // Roughness and anisotropy are converted to glTF's parameters and back, which causes
            // rounding errors.
            for (old, new) in [
                (old.specular_roughness, &mut new.specular_roughness),
                (old.specular_anisotropy, &mut new.specular_anisotropy),
            ] {
                assert!((old - *new).abs() < 1e-6, "{name} {i}: {old} and {new}");
                *new = old;
            }
            assert_eq!(old, new, "{name} {i}");
        }
        assert_eq!(after.assets.meshes.len(), 4);
    }
}

#[test]
fn one_sided_emitter_loses_its_back_side() {
    let materials = "numMaterials 2 PrincipledMaterial { emissionLuminance 8 } PrincipledMaterial { emissionLuminance 8 walls thin }";
    let lights: String = (0..2)
        .map(|i| format!("MaterialIndex {i} Rectangle {{ corner {i} 0 0 edge0 0.5 0 0 edge1 0 0.5 0 }} "))
        .collect();
    let before = scene(&format!("{HEAD} Materials {{ {materials} }} Group {{ numObjects 2 {lights} }}")); // prose: keep
    let (after, messages) = again(&before, "a.glb");
    assert_eq!(messages, ["glTF has no one-sided emitters: the back side is left out"]);
    let sides = after.materials.iter().map(|material| match &material.value {
        Material::Principled(m) => (m.walls, m.backs),
        other => panic!("{other:?}"),
    });
    assert_eq!(sides.collect::<Vec<_>>(), [(Walls::Solid, Backs::Hidden), (Walls::Thin, Backs::Shown)]);
}

#[test]
fn cameras_and_lights_round_trip() {
    let lights = "Lights { numLights 3 PointLight { position 1 2 3 color 1 0.5 0.25 attenuation 0 0 1 }
        DirectionalLight { direction 0 -1 0 color 2 2 1 } SpotLight { position 0 5 0 direction 1 -1 0 color 3 3 3 angle 40 innerAngle 20 } }";
    let before = scene(&format!(
        "{HEAD} {lights} Materials {{ numMaterials 1 PrincipledMaterial {{ }} }} Group {{ numObjects 1 MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}"
    ));
    let (after, messages) = again(&before, "a.glb");
    assert_eq!(messages, [""; 0]);
    assert_eq!(format!("{:?}", before.camera), format!("{:?}", after.camera));
    let [a, b] = [&before, &after]
        .map(|scene| scene.lights.as_ref().unwrap().iter().map(|l| l.value.clone()).collect::<Vec<Light>>());
    assert_eq!(a.len(), b.len());
    for (old, new) in a.iter().zip(&b) {
        match (old, new) {
            (Light::Point(old), Light::Point(new)) => {
                assert!(old.position == new.position && (old.color - new.color).length() < 1e-6);
            }
            (Light::Directional(old), Light::Directional(new)) => {
                assert!((old.direction - new.direction).length() < 1e-6 && (old.color - new.color).length() < 1e-6);
            }
            (Light::Spot(old), Light::Spot(new)) => {
                assert!((old.direction.normalize() - new.direction).length() < 1e-6);
                assert!((old.angle - new.angle).abs() + (old.inner_angle - new.inner_angle).abs() < 1e-4);
            }
            other => panic!("{other:?}"),
        }
    }
}

const SOLID: &str = "Difference { Sphere { center 0 0 0 radius 1 } Sphere { center 1 0 0 radius 1 } }";

#[test]
fn each_loss_is_reported_once() {
    let before = scene(&format!(
        "{HEAD} Background {{ sun 0 1 1 }} Materials {{ numMaterials 1 PrincipledMaterial {{ subsurfaceWeight 1 }} }}
         Group {{ numObjects 3 MaterialIndex 0 {SOLID} {SOLID}
         Sphere {{ center 0 0 0 radius 1 }} }}"
    ));
    let (after, messages) = again(&before, "a.gltf");
    assert_eq!(messages.len(), 3, "{messages:?}");
    assert!(messages.iter().any(|line| line.contains("solids, grids and height fields")));
    assert_eq!(after.assets.meshes.len(), 1);
}

#[test]
fn mesh_round_trips() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0.25 1\nvn 0 0 1\nvn 0.6 0 0.8\nf 1/1/1 2/2/2 3/3/1\nf 2/2/2 4/3/1 3/3/1\n";
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let scene_defaults = SceneDefaults { convert_only: true, ..SceneDefaults::default() };
    let options = LoadOptions { scene_defaults, ..LoadOptions::default() };
    let path = std::env::temp_dir().join("a.obj");
    let loaded = load_text(&path, text.as_bytes().into(), &options, &mut files, &mut diagnostics).unwrap();
    assert!(loaded.scene.camera.is_none());
    let (after, messages) = again(&loaded.scene, "a.glb");
    assert_eq!(messages, [""; 0]);
    let [old, new] = [&loaded.scene, &after].map(|scene| scene.assets.meshes.values().next().unwrap().clone());
    let corners = |data: &durer_scene::shape::MeshData| -> Vec<(Vec3, durer_scene::math::Vec2, Vec3)> {
        let at = |i: usize, k: usize| {
            let [p, t, n] =
                [&data.triangles, &data.triangle_uvs, &data.triangle_normals].map(|list| list[i][k] as usize);
            (data.positions[p], data.uvs[t], data.normals[n])
        };
        (0..6).map(|c| at(c / 3, c % 3)).collect()
    };
    assert_eq!(corners(&old), corners(&new));
}
