//! Tests that what the writer writes is what the reader reads, for each kind of material, light,
//! shape and camera.

use crate::testing::{assert_near, folder, read_in, triangles, write_in, written_again};
use durer_scene::scene::Scene;
use durer_scene::shape::{Shape as _, Sphere};

/// Puts directives after a camera.
fn scene(world: &str) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 60 \"integer yresolution\" 40
         Sampler \"zsobol\" \"integer pixelsamples\" 9
         Integrator \"volpath\" \"integer maxdepth\" 7
         Scale -1 1 1 LookAt 1 2 9  1 2 0  0 1 0
         Camera \"perspective\" \"float fov\" 26
         WorldBegin\n{world}"
    )
}

/// Writes a scene and reads it again, which must not lose anything.
fn again(text: &str) -> [Scene; 2] {
    written_again("a.pbrt", text)
}

#[test]
fn materials_round_trip() {
    let color = "\"rgb reflectance\" [ 0.2 0.4 0.6 ]";
    for material in [
        format!("Material \"diffuse\" {color}"),
        "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"".into(),
        "Material \"conductor\" \"float uroughness\" 0.1 \"float vroughness\" 0.3".into(),
        format!("Material \"conductor\" {color} \"float roughness\" 0.2"),
        "Material \"dielectric\" \"float eta\" 1.6".into(),
        "Material \"dielectric\" \"float roughness\" 0.2".into(),
        "Material \"thindielectric\" \"float eta\" 1.4".into(),
        format!("Material \"coateddiffuse\" {color} \"float roughness\" 0.1 \"float thickness\" 0.000001"),
        "Material \"diffusetransmission\" \"rgb reflectance\" [ 0.1 0.2 0.3 ] \"rgb transmittance\" [ 0.2 0.4 0.6 ]"
            .into(),
        format!(
            "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" {color} MakeNamedMaterial \"b\" \"string type\" \
             \"dielectric\" Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.3"
        ),
    ] {
        let [before, after] = again(&scene(&format!("{material} Shape \"sphere\"")));
        let values = |scene: &Scene| scene.materials.iter().map(|m| m.value.clone()).collect::<Vec<_>>();
        assert_near(&material, &values(&before), &values(&after), 2e-3);
    }
    let [before, after] = again(&scene("Material \"diffuse\" Shape \"sphere\" \"float alpha\" 0.3"));
    assert_near("alpha", &before.materials[0].value, &after.materials[0].value, 1e-6);
}

#[test]
fn lights_round_trip() {
    let lights = "LightSource \"point\" \"rgb I\" [ 3 2 1 ] \"point3 from\" [ 1 2 3 ]
        LightSource \"distant\" \"rgb L\" [ 1 2 3 ] \"point3 from\" [ 1 2 0 ] \"point3 to\" [ 0 0 0 ]
        LightSource \"spot\" \"rgb I\" [ 5 5 5 ] \"point3 from\" [ 1 2 3 ] \"point3 to\" [ 0 0 0 ] \"float coneangle\" 40 \"float conedeltaangle\" 15
        LightSource \"infinite\" \"rgb L\" [ 0.1 0.2 0.3 ]\n";
    let [before, after] = again(&scene(&format!("{lights} Shape \"sphere\"")));
    let values = |scene: &Scene| scene.lights.iter().flatten().map(|light| light.value.clone()).collect::<Vec<_>>();
    assert_eq!(values(&before).len(), 3);
    assert_near("lights", &values(&before), &values(&after), 1e-4);
    assert_near("background", &before.background, &after.background, 1e-6);
    for sides in ["", "\"bool twosided\" true"] {
        let area =
            format!("Material \"diffuse\" AreaLightSource \"diffuse\" \"rgb L\" [ 4 2 8 ] {sides} Shape \"disk\"");
        let [before, after] = again(&scene(&area));
        assert_near("area", &before.materials[0].value, &after.materials[0].value, 1e-5);
    }
}

#[test]
fn shapes_round_trip() {
    let mesh = "\"point3 P\" [ 0 0 0 1 0 0 0 1 0.5 1 1 0 ] \"integer indices\" [ 0 1 2 1 3 2 ]";
    for shape in [
        "Shape \"sphere\" \"float radius\" 2".to_string(),
        "Shape \"disk\" \"float radius\" 2".into(),
        "Shape \"cylinder\"".into(),
        format!("Shape \"trianglemesh\" {mesh}"),
        format!("Shape \"trianglemesh\" {mesh} \"point2 uv\" [ 0 0 1 0 0 1 1 1 ]"),
        // A mirrored mesh keeps its front sides.
        format!("Scale -1 1 1 Shape \"trianglemesh\" {mesh}"),
    ] {
        let [before, after] = again(&scene(&format!("Translate 1 2 3 Rotate 30 1 0 0 {shape}")));
        let surface = |scene: &Scene| {
            let sum = |value: &dyn Fn([glam::DVec3; 3]) -> glam::DVec3| triangles(scene).into_iter().map(value).sum();
            let normals: glam::DVec3 = sum(&|[a, b, c]| (b - a).cross(c - a));
            let areas: glam::DVec3 = sum(&|[a, b, c]| (b - a).cross(c - a).abs());
            (normals, areas)
        };
        assert_near(&shape, &surface(&before), &surface(&after), 2e-2);
    }
}

#[test]
fn camera_film_and_integrator_round_trip() {
    let film =
        "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 60 \"integer pixelbounds\" [ 4 12 0 60 ]\n";
    let lens = "Camera \"perspective\" \"float fov\" 26 \"float lensradius\" 0.1 \"float focaldistance\" 4 \"float screenwindow\" [ -0.5 1.5 -1 2 ]";
    let flat = "Translate 0 0 5 Camera \"orthographic\" \"float screenwindow\" [ -2 2 -3 3 ]";
    let plain = "Scale -1 1 1 LookAt 1 2 9  1 2 0  0 1 0 Camera \"perspective\" \"float fov\" 26";
    for camera in [lens, flat, plain] {
        let [before, after] = again(&format!("{film}{camera} WorldBegin Shape \"sphere\""));
        assert_near(camera, &before.camera, &after.camera, 1e-4);
        assert_eq!(before.render_defaults.crop, after.render_defaults.crop);
    }
    let [before, after] = again(&scene("Shape \"sphere\""));
    assert_eq!(before.render_defaults, after.render_defaults);
}

#[test]
fn media_round_trip() {
    let medium = "MakeNamedMedium \"NAME\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.3 0.2 0.1 ] \"rgb sigma_s\" [ 0.2 0.9 0.4 ] \"float g\" 0.3\n";
    for material in ["dielectric", "interface"] {
        let text = format!("MediumInterface \"milk\" \"\" Material \"{material}\" Shape \"sphere\"");
        let [before, after] = again(&scene(&(medium.replace("NAME", "milk") + &text)));
        assert_near(material, &before.materials[0].value, &after.materials[0].value, 1e-4);
    }
    let around = "MakeNamedMedium \"dust\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.1 0.1 0.1 ] \"rgb sigma_s\" [ 0.2 0.2 0.2 ]
        MediumInterface \"\" \"dust\" Camera \"perspective\" WorldBegin Shape \"sphere\"";
    let [before, after] = again(around);
    assert_near("fog", &before.fog, &after.fog, 1e-5);
}

#[test]
fn large_mesh_that_occurs_twice_is_written_once() {
    let mesh = crate::ply::write_all_attributes(&Sphere::default().to_mesh().unwrap());
    let folder = folder(&[("ball.ply", &mesh)]);
    let ball = "ObjectBegin \"ball\" Shape \"plymesh\" \"string filename\" \"ball.ply\" ObjectEnd
        ObjectInstance \"ball\" Translate 2 0 0 ObjectInstance \"ball\"";
    let (before, messages) = read_in(folder.path(), "a.pbrt", scene(ball));
    let messages = write_in(folder.path(), "b.pbrt", &before.unwrap_or_else(|| panic!("{messages:?}")));
    assert_eq!(messages, [""; 0]);
    let text = std::fs::read_to_string(folder.path().join("b.pbrt")).unwrap();
    assert_eq!(text.matches("ball.ply").count(), 1, "{text}");
    assert_eq!(text.matches("ObjectInstance").count(), 2, "{text}");
}
