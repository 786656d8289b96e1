//! Conventions of Mitsuba, in closed form. Where the documents do not tell, Mitsuba 3.9.1 was
//! asked.

use super::{clean, material, objects, read};
use crate::camera::{Camera, Handedness};
use crate::describe::FileName;
use crate::light::Light;
use crate::material::PrincipledMaterial;
use crate::math::{Vec2, Vec3, fp};
use crate::scene::{Material, PictureBytes, Scene};

fn layers(bsdf: &str) -> PrincipledMaterial {
    let scene = clean(&format!("<shape type='sphere'>{bsdf}</shape>"));
    let Material::Principled(layers) = material(&scene) else { panic!("{bsdf}") };
    (**layers).clone()
}

/// The camera of a film of 200 x 100 pixels.
fn camera(more: &str) -> Camera {
    let film = "<film type='hdrfilm'><integer name='width' value='200'/><integer name='height' value='100'/></film>";
    clean(&format!("<sensor {more}{film}</sensor><shape type='sphere'/>")).camera.unwrap()
}

fn tan(degrees: f32) -> f32 {
    fp::tan_f64(f64::from(degrees).to_radians()) as f32
}

const LOOK: &str = "<transform name='to_world'><lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform>";

#[test]
fn views_are_told_across_any_side() {
    // 90 degrees across x: half is 1; the film is twice as wide as high.
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
    // 50 mm on film of 36 x 24 mm, across the diagonal: 0.43267 half.
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
fn what_the_picture_is_to_be() {
    let scene = clean(
        "<integrator type='path'><integer name='max_depth' value='7'/></integrator><sensor type='perspective'>\
         <sampler type='multijitter'><integer name='sample_count' value='36'/></sampler></sensor><shape type='cube'/>",
    );
    assert_eq!(scene.wishes.size, Some((768, 576)));
    assert_eq!((scene.wishes.samples, scene.wishes.bounces), (Some(36), Some(5)));
}

#[test]
fn lights_have_their_units() {
    let of = |text: &str| clean(&format!("{text}<shape type='sphere'/>")).lights.unwrap()[0].value.clone();
    let Light::Point(point) = of("<emitter type='point'><float name='intensity' value='2'/></emitter>") else {
        panic!()
    };
    assert!((point.color.x - 2.0 / std::f32::consts::PI).abs() < 1e-6);
    let spot =
        "<emitter type='spot'><float name='cutoff_angle' value='40'/><float name='beam_width' value='40'/></emitter>";
    let Light::Spot(spot) = of(spot) else { panic!() };
    assert_eq!((spot.angle, spot.inner_angle, spot.direction), (40.0, 40.0, Vec3::Z));
    // An even spectrum that shines is not white, and one that reflects is.
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
fn materials_have_their_indices_and_alphas() {
    let glass = layers("<bsdf type='dielectric'><string name='int_ior' value='water'/></bsdf>");
    assert!((glass.specular_ior - 1.333 / 1.000277).abs() < 1e-6 && glass.transmission_weight == 1.0);
    let rough = layers(
        "<bsdf type='roughconductor'><float name='alpha' value='.25'/><string name='distribution' value='ggx'/></bsdf>",
    );
    assert_eq!((rough.specular_roughness, rough.base_metalness, rough.base_color), (0.5, 1.0, Vec3::ONE));
    let gold = layers("<bsdf type='conductor'><string name='material' value='Au'/></bsdf>");
    // Fresnel's equations at right angles, for red.
    let (n, k) = (0.143f32, 3.983f32);
    let expected = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
    assert!((gold.base_color.x - expected).abs() < 1e-5);
    let masked = layers("<bsdf type='mask'><float name='opacity' value='.25'/><bsdf type='diffuse'/></bsdf>");
    assert_eq!((masked.opacity, masked.base_color), (0.25, Vec3::splat(0.5)));
    let disney = layers(
        "<bsdf type='principled'><float name='specular' value='.5'/><float name='roughness' value='.3'/></bsdf>",
    );
    // A reflectance of 0.04 at right angles.
    let root = (disney.specular_ior - 1.0) / (disney.specular_ior + 1.0);
    assert!((root * root - 0.04).abs() < 1e-6 && (disney.specular_roughness - 0.3).abs() < 1e-6);
    let scene = clean(
        "<shape type='sphere'><bsdf type='blendbsdf'><float name='weight' value='.25'/><bsdf type='diffuse'/>\
        <bsdf type='conductor'/></bsdf></shape>",
    );
    assert!(format!("{:?}", material(&scene)).contains("share: 0.75"));
}

#[test]
fn pictures_say_numbers_too() {
    let fields = |name: &str, one: f32, other: f32| {
        format!(
            "<texture name='{name}' type='checkerboard'><rgb name='color0' value='{one}'/>\
             <rgb name='color1' value='{other}'/></texture>"
        )
    };
    // The values of a picture that a material names: numbers without a curve.
    let check = |bsdf: &str, get: &dyn Fn(&PrincipledMaterial) -> Option<&FileName>, wanted: [f32; 2]| {
        let scene = clean(&format!("<shape type='sphere'>{bsdf}</shape>"));
        let Material::Principled(layers) = material(&scene) else { panic!("{bsdf}") };
        let name = get(layers).unwrap_or_else(|| panic!("{bsdf} has a picture"));
        let PictureBytes::Here(path, bytes) = &scene.assets.pictures[&name.path].bytes else { panic!() };
        let image = crate::image::read(bytes, path).unwrap();
        for (pixel, wanted) in image.pixels.iter().zip(wanted) {
            // Fields have eight bits, and so has what is made of them.
            assert!((pixel.x - wanted).abs() < 1.5 / 255.0, "{bsdf}: {} and not {wanted}", pixel.x);
        }
        (**layers).clone()
    };
    // The root of alpha is our roughness.
    let (ggx, alpha) = ("<string name='distribution' value='ggx'/>", fields("alpha", 0.04, 0.25));
    let metal = format!("<bsdf type='roughconductor'>{ggx}{alpha}</bsdf>");
    let metal = check(&metal, &|m| m.specular_roughness_texture.as_ref(), [0.2, 0.5]);
    assert_eq!(metal.specular_roughness, 1.0);
    let inner = "<bsdf type='diffuse'/>";
    let mask = format!("<bsdf type='mask'>{}{inner}</bsdf>", fields("opacity", 0.0, 1.0));
    check(&mask, &|m| m.opacity_texture.as_ref(), [0.0, 1.0]);
    let bump =
        format!("<bsdf type='bumpmap'>{}<float name='scale' value='.3'/>{inner}</bsdf>", fields("arbitrary", 0.5, 0.9));
    assert_eq!(check(&bump, &|m| m.bump_texture.as_ref(), [0.5, 0.9]).bump_height, 0.3);
    let parts = fields("roughness", 0.3, 0.6) + &fields("metallic", 0.0, 0.7);
    let disney = format!("<bsdf type='principled'>{parts}</bsdf>");
    check(&disney, &|m| m.base_metalness_texture.as_ref(), [0.0, 0.7]);
    let disney = check(&disney, &|m| m.specular_roughness_texture.as_ref(), [0.3, 0.6]);
    assert!((disney.specular_roughness - 1.0).abs() < 1e-6 && disney.base_metalness == 1.0);
}

/// The only mesh of a scene.
fn mesh(scene: &Scene) -> &crate::shape::MeshData {
    scene.assets.meshes.values().next().unwrap()
}

#[test]
fn coordinates_of_textures_are_turned_over() {
    // Mitsuba has v = 0 at the upper border of a picture, and the lower left corner of a rectangle
    // at 0 0.
    let scene = clean("<shape type='rectangle'/>");
    let lower_left = mesh(&scene).positions.iter().position(|p| p.x < 0.0 && p.y < 0.0).unwrap();
    assert_eq!(mesh(&scene).uvs[lower_left], Vec2::new(0.0, 1.0));
    let scene = clean("<shape type='rectangle'><boolean name='flip_normals' value='true'/></shape>");
    let data = mesh(&scene);
    let [a, b, c] = data.triangles[0].map(|i| data.positions[i as usize]);
    assert!((b - a).cross(c - a).z < 0.0 && data.normals[0] == Vec3::NEG_Z);
}

#[test]
fn what_is_inside_is_extinction_times_albedo() {
    let scene = clean(
        "<medium type='homogeneous' id='m'><float name='sigma_t' value='2'/><float name='albedo' value='.25'/></medium>\
         <shape type='sphere'><bsdf type='null'/><ref id='m' name='interior'/></shape>",
    );
    let Material::Principled(m) = material(&scene) else { panic!() };
    assert_eq!((m.specular_ior, m.transmission_depth, m.transmission_scatter), (1.0, 0.5, Vec3::splat(0.25)));
    assert!((m.transmission_color.x - fp::exp(-1.0)).abs() < 1e-6);
    assert_eq!(objects(&scene).len(), 1);
    // Nothing alone is not shown.
    let (scene, told) = read("<scene><shape type='sphere'><bsdf type='null'/></shape></scene>");
    assert!(scene.is_some_and(|scene| objects(&scene).is_empty()), "{told:?}");
}
