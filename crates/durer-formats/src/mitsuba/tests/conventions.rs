//! Tests of Mitsuba's conventions, compared with analytic results. Where Mitsuba's documentation
//! does not specify the values, they were computed with Mitsuba 3.9.1.

use super::{clean, layers, read};
use durer_scene::camera::{Camera, Handedness};
use durer_scene::light::Light;
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::Material;

/// Camera with a film of 200 x 100 pixels.
fn camera(more: &str) -> Camera {
    let film = "<film type='hdrfilm'><integer name='width' value='200'/><integer name='height' value='100'/></film>";
    clean(&format!("<sensor {more}{film}</sensor><shape type='sphere'/>")).camera.unwrap()
}

fn tan(degrees: f32) -> f32 {
    fp::tan_f64(f64::from(degrees).to_radians()) as f32
}

const LOOK: &str = "<transform name='to_world'><lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform>";

#[test]
fn field_of_view_is_across_given_axis() {
    // A view of 90 degrees across x has a half width of 1, and the film is twice as wide as it is
    // high.
    for (axis, fov, half) in [
        ("x", 90.0, 1.0),
        ("larger", 90.0, 1.0),
        ("y", 90.0, 2.0),
        ("smaller", 90.0, 2.0),
        ("diagonal", 90.0, 2.0 / 5f32.sqrt()),
    ] {
        let text = format!(
            "type='perspective'><float name='fov' value='{fov}'/><string name='fov_axis' value='{axis}'/>{LOOK}"
        );
        let Camera::Perspective(camera) = camera(&text) else { panic!() };
        assert!((tan(0.5 * camera.angle) - half).abs() < 1e-5, "{axis}: {}", camera.angle);
        assert_eq!((camera.center, camera.direction, camera.up), (Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z, Vec3::Y));
    }
    // By default, the focal length is 50 mm and the view extends across the diagonal of a 36 x 24
    // mm film, so half of the view is 0.43267.
    let Camera::Perspective(usual) = camera(&format!("type='perspective'>{LOOK}")) else { panic!() };
    let half = (36f32 * 36.0 + 24.0 * 24.0).sqrt() / 100.0 * 2.0 / 5f32.sqrt();
    assert!((tan(0.5 * usual.angle) - half).abs() < 1e-5);
    let mirrored =
        "<transform name='to_world'><scale x='-1'/><lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform>";
    let Camera::ThinLens(lens) = camera(&format!("type='perspective'>{mirrored}")) else { panic!() };
    assert_eq!(lens.handedness, Handedness::Left);
    let flat =
        "<transform name='to_world'><scale x='3' y='3'/><lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform>";
    let Camera::Orthographic(flat) = camera(&format!("type='orthographic'>{flat}")) else { panic!() };
    assert!((flat.size - 6.0).abs() < 1e-6);
}

#[test]
fn default_up_is_that_of_mitsuba() {
    // Mitsuba 3.9.1 uses an axis that is perpendicular to the view direction.
    for (origin, target, up) in [
        ("0,2,6", "0,.6,0", [1.0, 0.0, 0.0]),
        ("1,0,0", "0,3,-2", [0.953452, 0.139643, -0.267261]),
        ("0,-1,0", "1,2,4", [0.978446, -0.064661, -0.196116]),
        ("0,5,0", "0,0,0", [1.0, 0.0, 0.0]),
    ] {
        let look = format!("<transform name='to_world'><lookat origin='{origin}' target='{target}'/></transform>");
        let Camera::Perspective(camera) = camera(&format!("type='perspective'>{look}")) else { panic!() };
        assert!((camera.up - Vec3::from_array(up)).length() < 1e-5, "{origin}: {}", camera.up);
    }
}

#[test]
fn settings_come_from_film_sampler_and_integrator() {
    let scene = clean(
        "<integrator type='path'><integer name='max_depth' value='7'/></integrator><sensor type='perspective'>\
         <sampler type='multijitter'><integer name='sample_count' value='36'/></sampler></sensor><shape type='cube'/>",
    );
    assert_eq!(scene.render_defaults.size, Some((768, 576)));
    assert_eq!((scene.render_defaults.samples, scene.render_defaults.bounces), (Some(36), Some(5)));
    let film = |more: &str| {
        let inner = format!("<film type='hdrfilm'><integer name='width' value='96'/>{more}</film>");
        read(&format!("<scene><sensor type='perspective'>{inner}</sensor><shape type='cube'/></scene>"))
    };
    let number = |name: &str, value: i32| format!("<integer name='crop_{name}' value='{value}'/>");
    let part = number("offset_x", 10) + &number("offset_y", 20) + &number("height", 32);
    let (scene, messages) = film(&(part.clone() + &number("width", 86)));
    assert_eq!((scene.unwrap().render_defaults.crop, messages), (Some((10, 20, 86, 32)), Vec::new()));
    for wrong in [number("width", 87), number("width", 0), number("width", -1), String::new()] {
        let (scene, messages) = film(&(part.clone() + &wrong));
        assert!(
            scene.is_none() && messages[0].contains("the crop window must lie within the picture of 96 x 576"),
            "{messages:?}"
        );
    }
}

#[test]
fn lights_have_mitsuba_units() {
    let of = |text: &str| clean(&format!("{text}<shape type='sphere'/>")).lights.unwrap()[0].value.clone();
    let Light::Point(point) = of("<emitter type='point'><float name='intensity' value='2'/></emitter>") else {
        panic!()
    };
    assert!((point.color.x - 2.0 / std::f32::consts::PI).abs() < 1e-6);
    let spot =
        "<emitter type='spot'><float name='cutoff_angle' value='40'/><float name='beam_width' value='40'/></emitter>";
    let Light::Spot(spot) = of(spot) else { panic!() };
    assert_eq!((spot.angle, spot.inner_angle, spot.direction), (40.0, 40.0, Vec3::Z));
    // A spotlight whose falloff is linear in the angle becomes a measured light of the same
    // intensity.
    let text = "<emitter type='spot'><float name='intensity' value='3'/></emitter><shape type='sphere'/>";
    let scene = clean(text);
    let Light::Photometric(light) = &scene.lights.as_ref().unwrap()[0].value else { panic!() };
    let profile = &scene.assets.profiles[&light.file.path];
    assert_eq!((light.direction, light.color), (Vec3::Z, Vec3::splat(3.0)));
    assert_eq!(profile.vertical, [0.0, 15.0, 20.0]);
    assert!(profile.candela.iter().zip([1.0, 1.0, 0.0]).all(|(found, wanted)| (found - wanted).abs() < 1e-6));
    // A constant emission spectrum is not white, but a constant reflectance spectrum is.
    let lit = |radiance: &str| {
        let emitter = format!("<emitter type='area'>{radiance}</emitter>");
        let m = layers(&emitter);
        m.emission_luminance * m.emission_color
    };
    let expected = Vec3::new(0.843356, 0.663804, 0.636241);
    assert!((lit("<spectrum name='radiance' value='.7'/>") - expected).abs().max_element() < 2e-3);
    assert!((lit("<float name='radiance' value='.7'/>") - 0.7).abs().max_element() < 1e-6);
    let curve = "value='400:0.1, 500:0.2, 600:0.3, 700:0.9'";
    let expected = Vec3::new(0.526613, 0.221827, 0.123121);
    assert!((lit(&format!("<spectrum name='radiance' {curve}/>")) - expected).abs().max_element() < 2e-3);
    let matte = layers(&format!("<bsdf type='diffuse'><spectrum name='reflectance' {curve}/></bsdf>"));
    assert!((matte.base_color - Vec3::new(0.445636, 0.235004, 0.139167)).abs().max_element() < 2e-3);
}

#[test]
fn rotation_axis_not_of_length_1_is_reported() {
    let messages = |version: &str, axis: &str| {
        let rotate = format!("<transform name='to_world'><rotate {axis} angle='40'/></transform>");
        read(&format!("<scene version='{version}'><shape type='sphere'>{rotate}</shape></scene>")).1
    };
    assert!(messages("3.0.0", "x='1' y='2' z='.5'")[0].contains("does not have length 1"));
    assert!(messages("0.6.0", "x='1' y='2' z='.5'").is_empty() && messages("3.0.0", "x='.6' y='.8'").is_empty());
}

#[test]
fn max_depth_1_shows_only_emitters() {
    let scene = clean(
        "<integrator type='path'><integer name='max_depth' value='1'/></integrator>\
         <shape type='sphere'><emitter type='area'/></shape><shape type='cube'/>",
    );
    let shown = scene.materials.iter().map(|material| match &material.value {
        Material::Principled(m) => (m.base_color, m.specular_weight, m.emission_luminance),
        _ => panic!(),
    });
    assert_eq!(shown.collect::<Vec<_>>(), [(Vec3::ZERO, 0.0, 1.0), (Vec3::ZERO, 0.0, 0.0)]);
}

#[test]
fn cameras_clip_at_near_and_far_planes() {
    let clip = "<float name='near_clip' value='2'/><float name='far_clip' value='7'/>";
    let Camera::ThinLens(lens) = camera(&format!("type='perspective'>{LOOK}{clip}")) else { panic!() };
    assert_eq!((lens.near, lens.far), (2.0, Some(7.0)));
    // The default clipping planes have no effect.
    let usual = "<float name='near_clip' value='0.01'/><float name='far_clip' value='10000'/>";
    assert!(matches!(camera(&format!("type='perspective'>{LOOK}{usual}")), Camera::Perspective(_)));
}
