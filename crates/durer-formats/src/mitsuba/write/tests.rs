//! Tests that what the writer writes is what the reader reads, for each kind of material, light,
//! shape and camera.

use crate::testing::{assert_losses_are_reported_once, assert_near, folder, read_in, write_in, written_again};
use durer_scene::scene::Scene;
use durer_scene::shape::{Shape as _, Sphere};

/// Puts elements into a scene with a camera.
fn scene(elements: &str) -> String {
    format!(
        "<scene version=\"3.0.0\"><integrator type=\"path\"><integer name=\"max_depth\" value=\"7\"/></integrator>
         <sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"y\"/>
         <transform name=\"to_world\"><lookat origin=\"1, 2, 9\" target=\"1, 2, 0\" up=\"0, 1, 0\"/></transform>
         <film type=\"hdrfilm\"><integer name=\"width\" value=\"60\"/><integer name=\"height\" value=\"40\"/></film>
         <sampler type=\"independent\"><integer name=\"sample_count\" value=\"9\"/></sampler></sensor>{elements}</scene>"
    )
}

/// A sphere with a material.
fn sphere(bsdf: &str) -> String {
    scene(&format!("<shape type=\"sphere\">{bsdf}</shape>"))
}

/// Writes a scene and reads it again, which must not lose anything.
fn again(text: &str) -> [Scene; 2] {
    written_again("a.xml", text)
}

#[test]
fn materials_round_trip() {
    let plain = "<rgb name=\"NAME\" value=\"0.2 0.4 0.6\"/>";
    let rgb = |name: &str| plain.replace("NAME", name);
    let rough = |kind: &str, more: &str| {
        format!(
            "<bsdf type=\"{kind}\"><string name=\"distribution\" value=\"ggx\"/><float name=\"alpha\" value=\"0.1\"/>{more}</bsdf>"
        )
    };
    let diffuse = format!("<bsdf type=\"diffuse\">{}</bsdf>", rgb("reflectance"));
    let gold = "<string name=\"material\" value=\"Au\"/>";
    let glass = "<float name=\"int_ior\" value=\"1.6\"/><float name=\"ext_ior\" value=\"1\"/>";
    let materials = [
        diffuse.clone(),
        format!("<bsdf type=\"twosided\">{diffuse}</bsdf>"),
        format!("<bsdf type=\"twosided\">{diffuse}<bsdf type=\"conductor\"/></bsdf>"),
        format!("<bsdf type=\"conductor\">{gold}</bsdf>"),
        format!("<bsdf type=\"conductor\">{}</bsdf>", rgb("specular_reflectance")),
        rough("roughconductor", gold),
        format!(
            "<bsdf type=\"roughconductor\"><string name=\"distribution\" value=\"ggx\"/><float name=\"alpha_u\" \
             value=\"0.05\"/><float name=\"alpha_v\" value=\"0.2\"/>{gold}</bsdf>"
        ),
        format!("<bsdf type=\"dielectric\">{glass}{}</bsdf>", rgb("specular_transmittance")),
        rough("roughdielectric", glass),
        format!("<bsdf type=\"thindielectric\">{glass}{}</bsdf>", rgb("specular_reflectance")),
        format!("<bsdf type=\"plastic\">{glass}{}</bsdf>", rgb("diffuse_reflectance")),
        format!("<bsdf type=\"plastic\">{glass}<boolean name=\"nonlinear\" value=\"true\"/></bsdf>"),
        rough("roughplastic", &format!("{glass}{}", rgb("diffuse_reflectance"))),
        rough("roughplastic", &format!("{glass}<boolean name=\"nonlinear\" value=\"true\"/>")),
        format!(
            "<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.3\"/>{diffuse}<bsdf type=\"conductor\"/></bsdf>"
        ),
        format!("<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.3\"/>{diffuse}</bsdf>"),
        format!("<bsdf type=\"principledthin\"><float name=\"diff_trans\" value=\"1.4\"/>{}</bsdf>", rgb("base_color")),
    ];
    for material in materials {
        let [before, after] = again(&sphere(&material));
        let values = |scene: &Scene| scene.materials.iter().map(|m| m.value.clone()).collect::<Vec<_>>();
        assert_near(&material, &values(&before), &values(&after), 2e-3);
    }
}

#[test]
fn lights_round_trip() {
    let lights = "<emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"2\" z=\"3\"/><rgb name=\"intensity\" value=\"3 2 1\"/></emitter>
        <emitter type=\"directional\"><vector name=\"direction\" x=\"1\" y=\"-2\" z=\"0\"/><rgb name=\"irradiance\" value=\"1 2 3\"/></emitter>
        <emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"1, 2, 3\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform>
        <float name=\"cutoff_angle\" value=\"30\"/><float name=\"beam_width\" value=\"30\"/><rgb name=\"intensity\" value=\"5 5 5\"/></emitter>
        <emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.1 0.2 0.3\"/></emitter>";
    let [before, after] = again(&scene(&format!("{lights}<shape type=\"sphere\"/>")));
    let values = |scene: &Scene| scene.lights.iter().flatten().map(|light| light.value.clone()).collect::<Vec<_>>();
    assert_eq!(values(&before).len(), 3);
    assert_near("lights", &values(&before), &values(&after), 1e-5);
    assert_near("background", &before.background, &after.background, 1e-6);
    let area =
        "<shape type=\"rectangle\"><emitter type=\"area\"><rgb name=\"radiance\" value=\"4 2 8\"/></emitter></shape>";
    let [before, after] = again(&scene(area));
    let emission = |scene: &Scene| match &scene.materials[0].value {
        durer_scene::scene::Material::Principled(m) => {
            (m.emission_color, m.emission_luminance, m.base_color, m.specular_weight)
        }
        other => panic!("{other:?}"),
    };
    assert_near("area", &emission(&before), &emission(&after), 1e-5);
}

#[test]
fn shapes_round_trip() {
    let turned = "<transform name=\"to_world\"><rotate x=\"1\" angle=\"30\"/><translate x=\"3\" y=\"1\"/></transform>";
    for shape in [
        format!("<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"2\" z=\"3\"/>{turned}</shape>"),
        format!("<shape type=\"disk\">{turned}</shape>"),
        format!("<shape type=\"rectangle\">{turned}</shape>"),
        format!("<shape type=\"cube\">{turned}</shape>"),
        format!("<shape type=\"cylinder\">{turned}</shape>"),
        // A mirrored mesh keeps its front sides.
        "<shape type=\"cube\"><transform name=\"to_world\"><scale x=\"-1\"/></transform></shape>".into(),
    ] {
        let [before, after] = again(&scene(&shape));
        let surface = |scene: &Scene| {
            let (mut area, mut moment) = (glam::DVec3::ZERO, 0.0);
            for [a, b, c] in crate::testing::triangles(scene) {
                let normal = (b - a).cross(c - a);
                // The sum of a closed surface is its volume.
                moment += normal.dot(a + b + c) / 18.0;
                area += normal.abs();
            }
            (area, moment)
        };
        assert_near(&shape, &surface(&before), &surface(&after), 2e-2);
    }
}

#[test]
fn camera_film_and_integrator_round_trip() {
    let lens = "<scene version=\"3.0.0\"><sensor type=\"thinlens\"><float name=\"fov\" value=\"30\"/>
        <float name=\"aperture_radius\" value=\"0.2\"/><float name=\"focus_distance\" value=\"5\"/>
        <float name=\"principal_point_offset_x\" value=\"0.1\"/><float name=\"near_clip\" value=\"0.5\"/>
        <film type=\"hdrfilm\"><integer name=\"width\" value=\"40\"/><integer name=\"height\" value=\"60\"/>
        <integer name=\"crop_offset_x\" value=\"4\"/><integer name=\"crop_width\" value=\"8\"/></film></sensor>
        <shape type=\"sphere\"/></scene>";
    let flat = "<scene version=\"3.0.0\"><sensor type=\"orthographic\"><transform name=\"to_world\"><scale x=\"3\" y=\"3\"/>
        <lookat origin=\"1, 2, 3\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform></sensor><shape type=\"sphere\"/></scene>";
    for text in [sphere(""), lens.into(), flat.into()] {
        let [before, after] = again(&text);
        assert_near(&text, &before.camera, &after.camera, 1e-4);
        assert_eq!(before.render_defaults.size, after.render_defaults.size);
        assert_eq!(before.render_defaults.crop, after.render_defaults.crop);
    }
    let [before, after] = again(&sphere(""));
    assert_eq!(before.render_defaults, after.render_defaults);
}

#[test]
fn media_round_trip() {
    let medium = "<medium type=\"homogeneous\" name=\"NAME\"><rgb name=\"sigma_t\" value=\"0.5 1.5 2\"/>
        <rgb name=\"albedo\" value=\"0.2 0.9 0.4\"/><phase type=\"hg\"><float name=\"g\" value=\"0.3\"/></phase></medium>";
    let inside = medium.replace("NAME", "interior");
    for bsdf in ["<bsdf type=\"dielectric\"/>", "<bsdf type=\"null\"/>"] {
        let [before, after] = again(&sphere(&format!("{bsdf}{inside}")));
        assert_near(bsdf, &before.materials[0].value, &after.materials[0].value, 1e-4);
    }
    let around =
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"30\"/>MEDIUM</sensor>
        <shape type=\"sphere\"/></scene>";
    let grey = medium.replace("NAME", "medium").replace("0.5 1.5 2", "0.3 0.3 0.3");
    let [before, after] = again(&around.replace("MEDIUM", &grey));
    assert_near("fog", &before.fog, &after.fog, 1e-5);
}

#[test]
fn large_mesh_that_occurs_twice_is_written_once() {
    let ball = "TriangleMesh { obj_file ball.ply }";
    let text = format!(
        "PerspectiveCamera {{ center 0 0 9 direction 0 0 -1 up 0 1 0 angle 30 }}
         Materials {{ numMaterials 1 PrincipledMaterial {{ specularWeight 0 }} }}
         Group {{ numObjects 2 MaterialIndex 0 {ball} Transform {{ Translate 2 0 0 {ball} }} }}"
    );
    let mesh = crate::ply::write_all_attributes(&Sphere::default().to_mesh().unwrap());
    let folder = folder(&[("ball.ply", &mesh)]);
    let (before, messages) = read_in(folder.path(), "a.txt", &text);
    let messages = write_in(folder.path(), "b.xml", &before.unwrap_or_else(|| panic!("{messages:?}")));
    assert_eq!(messages, [""; 0]);
    let text = std::fs::read_to_string(folder.path().join("b.xml")).unwrap();
    assert_eq!(text.matches("ball.ply").count(), 1, "{text}");
    assert_eq!(text.matches("type=\"instance\"").count(), 2, "{text}");
}

#[test]
fn each_loss_is_reported_once() {
    assert_losses_are_reported_once("b.xml");
}
