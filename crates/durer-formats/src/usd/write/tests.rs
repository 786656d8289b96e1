//! Tests that what the writer writes is what the reader reads.

use crate::testing::{assert_losses_are_reported_once, assert_near, folder, read_in, triangles, write_in};
use durer_scene::math::Vec3;
use durer_scene::scene::{Material, Scene};
use std::path::Path;

/// Writes a scene of Dürer's language, which must not lose anything, and reads it again.
fn again(folder: &Path, text: &str) -> [Scene; 2] {
    let (before, messages) = read_in(folder, "a.txt", text);
    let before = before.unwrap_or_else(|| panic!("{messages:?}"));
    let messages = write_in(folder, "b.usda", &before);
    assert_eq!(messages, [""; 0], "{text}");
    let (after, messages) = read_in(folder, "b.usda", std::fs::read(folder.join("b.usda")).unwrap());
    assert_eq!(messages, [""; 0], "{text}");
    [before, after.unwrap()]
}

fn scene(materials: &[&str], objects: &str, rest: &str) -> String {
    let materials = format!("Materials {{ numMaterials {} {} }}", materials.len(), materials.join(" "));
    format!(
        "PerspectiveCamera {{ center 1 2 9 direction 0 0 -1 up 0 1 0 angle 40 }} {rest} {materials}
         Group {{ numObjects 1 MaterialIndex 0 {objects} }}"
    )
}

#[test]
fn materials_round_trip() {
    let folder = folder(&[]);
    for material in [
        "PrincipledMaterial { baseColor 0.2 0.4 0.6 specularRoughness 0.3 }",
        "PrincipledMaterial { baseColor 0.2 0.4 0.6 baseMetalness 1 specularRoughness 0.1 }",
        "PrincipledMaterial { baseColor 0.2 0.4 0.6 specularWeight 0 }",
        "PrincipledMaterial { baseColor 0.2 0.4 0.6 specularWeight 0.5 specularColor 1 0.5 0.25 }",
        "PrincipledMaterial { baseColor 0.2 0.4 0.6 specularIor 1.8 opacity 0.25 }",
        "PrincipledMaterial { baseColor 0.2 0.4 0.6 emissionLuminance 3 emissionColor 1 0.5 0.25 }",
        "PrincipledMaterial { transmissionWeight 0.75 walls thin }",
        "PrincipledMaterial { coatWeight 0.5 coatRoughness 0.2 coatIor 1.5 }",
    ] {
        let [before, after] = again(folder.path(), &scene(&[material], "Sphere { center 0 0 0 radius 1 }", ""));
        let values = |scene: &Scene| {
            scene
                .materials
                .iter()
                .map(|m| match &m.value {
                    Material::Principled(m) => {
                        let mut m = m.clone();
                        m.emission_color *= m.emission_luminance;
                        m.emission_luminance = f32::from(m.emission_luminance > 0.0);
                        // Only coats use this index.
                        m.coat_ior = if m.coat_weight > 0.0 { m.coat_ior } else { 1.5 };
                        m.coat_roughness = if m.coat_weight > 0.0 { m.coat_roughness } else { 0.0 };
                        m
                    }
                    other => panic!("{other:?}"),
                })
                .next_back()
        };
        assert_near(material, &values(&before), &values(&after), 1e-5);
    }
}

#[test]
fn lights_and_the_camera_round_trip() {
    let folder = folder(&[]);
    let lights = "Background { color 0.1 0.2 0.3 } Lights { numLights 3
        PointLight { position 1 2 3 color 3 2 1 attenuation 0 0 1 }
        DirectionalLight { direction 0 -0.6 -0.8 color 1 2 3 spread 2 }
        SpotLight { position 1 2 3 direction 0 -1 0 color 4 4 4 angle 40 innerAngle 10 } }";
    let matte = "PrincipledMaterial { specularWeight 0 }";
    let [before, after] = again(folder.path(), &scene(&[matte], "Sphere { center 0 0 0 radius 1 }", lights));
    let values = |scene: &Scene| scene.lights.iter().flatten().map(|light| light.value.clone()).collect::<Vec<_>>();
    assert_near("lights", &values(&before), &values(&after), 1e-5);
    assert!((before.background.color - after.background.color).length() < 1e-6);
    for camera in [
        "ThinLensCamera { center 1 2 9 direction 0 0 -1 up 0 1 0 angle 50 aperture 0.2 focusDistance 8 near 0.5 far 20 }",
        "ThinLensCamera { center 1 2 9 direction 0 0 -1 up 0 1 0 angle 50 shiftRight 0.1 shiftUp -0.2 near 0.5 far 20 }",
        "OrthographicCamera { center 1 2 9 direction 0 0 -1 up 0 1 0 size 5 near 0 }",
    ] {
        let text = scene(&[matte], "Sphere { center 0 0 0 radius 1 }", "Background { color 0 0 0 }");
        let start = text.find("Background").unwrap();
        let [before, after] = again(folder.path(), &format!("{camera} {}", &text[start..]));
        let pose = |scene: &Scene| {
            let mut value = serde_json::to_value(scene.camera.as_ref().unwrap()).unwrap();
            // Without a lens, the distance in focus has no meaning.
            let fields = value.as_object_mut().unwrap().values_mut().next().unwrap().as_object_mut().unwrap();
            if !camera.contains("aperture") {
                fields.remove("focusDistance");
                fields.remove("focus_distance");
            }
            fields.remove("near");
            value
        };
        assert_near(camera, &pose(&before), &pose(&after), 1e-4);
        // A scene without light stays without light.
        assert!(after.lights.is_none_or(|lights| lights.is_empty()) && after.background.color == Vec3::ZERO);
    }
}

#[test]
fn shapes_and_light_surfaces_keep_their_place() {
    let folder = folder(&[]);
    for (material, shape) in [
        ("PrincipledMaterial { }", "Transform { Translate 1 2 3 YRotate 30 Sphere { center 0 1 0 radius 2 } }"),
        ("PrincipledMaterial { }", "Transform { Scale -1 2 1 Box { min 0 0 0 max 1 2 3 } }"),
        ("PrincipledMaterial { }", "Cone { base 0 0 0 top 0 2 0 baseRadius 1 }"),
        (
            "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 3 }",
            "Transform { ZRotate 30 Rectangle { corner 1 2 3 edge0 0 2 0 edge1 0 0 3 } }",
        ),
        (
            "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 3 }",
            "Disc { center 1 2 3 normal 0 -1 0 radius 2 }",
        ),
    ] {
        let text = scene(&[material], shape, "Background { color 0 0 0 }");
        let [before, after] = again(folder.path(), &text);
        let surface = |scene: &Scene| {
            let (mut area, mut normal, mut moment) = (glam::DVec3::ZERO, glam::DVec3::ZERO, 0.0);
            for [a, b, c] in triangles(scene) {
                let own = (b - a).cross(c - a);
                area += own.abs();
                normal += own;
                moment += own.dot(a + b + c) / 18.0;
            }
            (area, normal, moment)
        };
        assert_near(shape, &surface(&before), &surface(&after), 3e-2);
        assert_eq!(after.emits_light(), material.contains("emission"), "{shape}");
    }
}

#[test]
fn pictures_keep_their_mapping() {
    let png = crate::pictures::as_png(
        durer_image::Image::from_pixels(2, 1, vec![Vec3::ONE, Vec3::ZERO]).unwrap(),
        durer_image::Transfer::Srgb,
    );
    let folder = folder(&[("a.png", &png.unwrap())]);
    let material = "PrincipledMaterial { baseColor 0.5 0.25 1 baseColorTexture a.png specularRoughness 0.5 \
                    specularRoughnessTexture a.png:g normalTexture a.png }";
    let text = scene(&[material], "Rectangle { corner 0 0 0 edge0 1 0 0 edge1 0 1 0 }", "Background { color 1 1 1 }");
    let [_, after] = again(folder.path(), &text);
    let Some(Material::Principled(m)) = after.materials.last().map(|m| &m.value) else { panic!() };
    assert_eq!((m.base_color, m.specular_roughness), (Vec3::new(0.5, 0.25, 1.0), 1.0));
    let rough = &after.assets.pictures[&m.specular_roughness_texture.as_ref().unwrap().path];
    assert_eq!(rough.mapping.range, [0.0, 0.5]);
    assert_eq!(rough.mapping.channel, Some(durer_scene::texture::Channel::Green));
    assert!(m.normal_texture.is_some());
    let data = after.assets.meshes.values().next().unwrap();
    assert_eq!(data.uvs.len(), 4);
    // The transform of coordinates is written and read alike.
    let transform = [[1.732_050_8, 1.5, 0.25], [-1.0, 2.598_076, -0.5]];
    let [scale, turn, translation] = super::material::parts(transform);
    let (sin, cos) = durer_scene::math::fp::sin_cos_degrees(f64::from(turn[0]));
    let (sin, cos) = (sin as f32, cos as f32);
    let [sx, sy] = scale;
    let rows =
        [[cos * sx, sin * sy, translation[0] - sin * sy], [-sin * sx, cos * sy, 1.0 - cos * sy - translation[1]]];
    for (row, wanted) in rows.iter().flatten().zip(transform.iter().flatten()) {
        assert!((row - wanted).abs() < 1e-5, "{rows:?}");
    }
}

#[test]
fn large_mesh_that_occurs_twice_is_written_once() {
    use durer_scene::shape::{Shape as _, Sphere};
    let ball = "TriangleMesh { obj_file ball.ply }";
    let text = format!(
        "PerspectiveCamera {{ center 0 0 9 direction 0 0 -1 up 0 1 0 angle 30 }} Background {{ color 1 1 1 }}
         Materials {{ numMaterials 1 PrincipledMaterial {{ specularWeight 0 }} }}
         Group {{ numObjects 2 MaterialIndex 0 {ball} Transform {{ Translate 2 0 0 {ball} }} }}"
    );
    let mesh = crate::ply::write_all_attributes(&Sphere::default().to_mesh().unwrap());
    let folder = folder(&[("ball.ply", &mesh)]);
    let [_, after] = again(folder.path(), &text);
    let text = std::fs::read_to_string(folder.path().join("b.usda")).unwrap();
    assert_eq!((text.matches("def Mesh").count(), text.matches("references").count()), (1, 2));
    assert_eq!(after.root.as_ref().unwrap().objects.len(), 2);
    assert_eq!(after.assets.meshes.len(), 1);
}

#[test]
fn each_loss_is_reported_once() {
    assert_losses_are_reported_once("b.usda");
}
