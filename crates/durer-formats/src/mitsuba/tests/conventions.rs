//! Tests of Mitsuba's conventions, compared with analytic results. Where Mitsuba's documentation
//! does not specify the values, they were computed with Mitsuba 3.9.1.

use super::{clean, folder, material, objects, read, read_in};
use durer_scene::camera::{Camera, Handedness};
use durer_scene::describe::FileName;
use durer_scene::light::Light;
use durer_scene::material::principled::{Backs, Facets, Surroundings, Switch, Walls};
use durer_scene::material::{HairMaterial, PrincipledMaterial};
use durer_scene::math::{Vec2, Vec3, fp};
use durer_scene::scene::{Material, MatrixOp, MatrixRules, ObjectKind, PictureBytes, Scene};

pub(super) fn layers(bsdf: &str) -> PrincipledMaterial {
    let scene = clean(&format!("<shape type='sphere'>{bsdf}</shape>"));
    let Material::Principled(layers) = material(&scene) else { panic!("{bsdf}") };
    (**layers).clone()
}

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
        for more in ["", "up='0,0,0'"] {
            let look =
                format!("<transform name='to_world'><lookat origin='{origin}' target='{target}' {more}/></transform>");
            let Camera::Perspective(camera) = camera(&format!("type='perspective'>{look}")) else { panic!() };
            assert!((camera.up - Vec3::from_array(up)).length() < 1e-5, "{origin}: {}", camera.up);
        }
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
fn materials_have_their_indices_and_alphas() {
    let glass = layers("<bsdf type='dielectric'><string name='int_ior' value='water'/></bsdf>");
    assert!((glass.specular_ior - 1.333 / 1.000277).abs() < 1e-6 && glass.transmission_weight == 1.0);
    let rough = layers(
        "<bsdf type='roughconductor'><float name='alpha' value='.25'/><string name='distribution' value='ggx'/></bsdf>",
    );
    assert_eq!((rough.specular_roughness, rough.base_metalness, rough.base_color), (0.5, 1.0, Vec3::ONE));
    let gold = layers("<bsdf type='conductor'><string name='material' value='Au'/></bsdf>");
    // Fresnel reflectance at normal incidence for red light.
    let (n, k) = (0.143f32, 3.983f32);
    let expected = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
    assert!((gold.base_color.x - expected).abs() < 1e-5);
    let masked = layers("<bsdf type='mask'><float name='opacity' value='.25'/><bsdf type='diffuse'/></bsdf>");
    assert_eq!((masked.opacity, masked.base_color), (0.25, Vec3::splat(0.5)));
    let disney = layers(
        "<bsdf type='principled'><float name='specular' value='.5'/><float name='roughness' value='.3'/></bsdf>",
    );
    // The reflectance at normal incidence is 0.04.
    let root = (disney.specular_ior - 1.0) / (disney.specular_ior + 1.0);
    assert!((root * root - 0.04).abs() < 1e-6 && (disney.specular_roughness - 0.3).abs() < 1e-6);
    let scene = clean(
        "<shape type='sphere'><bsdf type='blendbsdf'><float name='weight' value='.25'/><bsdf type='diffuse'/>\
        <bsdf type='conductor'/></bsdf></shape>",
    );
    assert!(format!("{:?}", material(&scene)).contains("share: 0.75"));
}

#[test]
fn textures_of_numbers_become_linear_pictures() {
    let fields = |name: &str, one: f32, other: f32| {
        format!(
            "<texture name='{name}' type='checkerboard'><rgb name='color0' value='{one}'/>\
             <rgb name='color1' value='{other}'/></texture>"
        )
    };
    // Expected values, which are linear, of the picture that a material uses. Mitsuba swaps the
    // colours of a checkerboard when it is used as a number.
    let check = |bsdf: &str, get: &dyn Fn(&PrincipledMaterial) -> Option<&FileName>, [other, one]: [f32; 2]| {
        let wanted = [one, other];
        let scene = clean(&format!("<shape type='sphere'>{bsdf}</shape>"));
        let Material::Principled(layers) = material(&scene) else { panic!("{bsdf}") };
        let name = get(layers).unwrap_or_else(|| panic!("{bsdf} has a picture"));
        let PictureBytes::Memory(path, bytes) = &scene.assets.pictures[&name.path].bytes else { panic!() };
        let image = durer_image::read(bytes, path).unwrap();
        for (pixel, wanted) in image.pixels.iter().zip(wanted) {
            // The colours have 8 bits, both before and after the change.
            assert!((pixel.x - wanted).abs() < 1.5 / 255.0, "{bsdf}: {} and not {wanted}", pixel.x);
        }
        (**layers).clone()
    };
    // Dürer's roughness is the square root of alpha.
    let (ggx, alpha) = ("<string name='distribution' value='ggx'/>", fields("alpha", 0.04, 0.25));
    let metal = format!("<bsdf type='roughconductor'>{ggx}{alpha}</bsdf>");
    let metal = check(&metal, &|m| m.specular_roughness_texture.as_ref(), [0.2, 0.5]);
    assert_eq!(metal.specular_roughness, 1.0);
    let inner = "<bsdf type='diffuse'/>";
    let mask = format!("<bsdf type='mask'>{}{inner}</bsdf>", fields("opacity", 0.0, 1.0));
    check(&mask, &|m| m.opacity_texture.as_ref(), [0.0, 1.0]);
    // `weight` is the share of the second material.
    let weight = fields("weight", 0.2, 0.7);
    let blend = format!("<bsdf type='blendbsdf'>{weight}{inner}<bsdf type='conductor'/></bsdf>");
    let scene = clean(&format!("<shape type='sphere'>{blend}</shape>"));
    let Material::Solid(durer_scene::material::PatternMaterial::Mix(mix), _) = material(&scene) else { panic!() };
    let PictureBytes::Memory(path, bytes) = &scene.assets.pictures[&mix.share_texture.as_ref().unwrap().path].bytes
    else {
        panic!()
    };
    let image = durer_image::Encoded::open(bytes, path).unwrap();
    let image = image.read(1 << 20, durer_image::decode_linear).unwrap();
    let first: Vec<f32> = image.pixels.iter().map(|pixel| pixel.x).collect();
    assert!(mix.share == 1.0 && first.iter().any(|x| (x - 0.8).abs() < 3e-3), "{first:?}");
    assert!(first.iter().any(|x| (x - 0.3).abs() < 3e-3), "{first:?}");
    let bump =
        format!("<bsdf type='bumpmap'>{}<float name='scale' value='.3'/>{inner}</bsdf>", fields("arbitrary", 0.5, 0.9));
    assert_eq!(check(&bump, &|m| m.bump_texture.as_ref(), [0.5, 0.9]).bump_height, 0.3);
    // The luminance of a colour is used where a number is expected.
    let colors = "<texture name='opacity' type='checkerboard'><rgb name='color0' value='0,1,0'/>\
        <rgb name='color1' value='1,0,0'/></texture>";
    check(&format!("<bsdf type='mask'>{colors}{inner}</bsdf>"), &|m| m.opacity_texture.as_ref(), [0.7152, 0.2126]);
    let parts = fields("roughness", 0.3, 0.6) + &fields("metallic", 0.0, 0.7);
    let disney = format!("<bsdf type='principled'>{parts}</bsdf>");
    check(&disney, &|m| m.base_metalness_texture.as_ref(), [0.0, 0.7]);
    let disney = check(&disney, &|m| m.specular_roughness_texture.as_ref(), [0.3, 0.6]);
    assert!((disney.specular_roughness - 1.0).abs() < 1e-6 && disney.base_metalness == 1.0);
}

/// Returns the only mesh of a scene.
pub(super) fn mesh(scene: &Scene) -> &durer_scene::shape::MeshData {
    scene.assets.meshes.values().next().unwrap()
}

#[test]
fn texture_v_is_flipped() {
    // In Mitsuba, v = 0 is the upper edge of a picture, but the lower left corner of a rectangle
    // has the coordinates (0, 0).
    let scene = clean("<shape type='rectangle'/>");
    let lower_left = mesh(&scene).positions.iter().position(|p| p.x < 0.0 && p.y < 0.0).unwrap();
    assert_eq!(mesh(&scene).uvs[lower_left], Vec2::new(0.0, 1.0));
    let scene = clean("<shape type='rectangle'><boolean name='flip_normals' value='true'/></shape>");
    let data = mesh(&scene);
    let [a, b, c] = data.triangles[0].map(|i| data.positions[i as usize]);
    assert!((b - a).cross(c - a).z < 0.0 && data.normals[0] == Vec3::NEG_Z);
}

#[test]
fn interior_scattering_is_extinction_times_albedo() {
    let scene = clean(
        "<medium type='homogeneous' id='m'><float name='sigma_t' value='2'/><float name='albedo' value='.25'/></medium>\
         <shape type='sphere'><bsdf type='null'/><ref id='m' name='interior'/></shape>",
    );
    let Material::Principled(m) = material(&scene) else { panic!() };
    assert_eq!((m.specular_ior, m.transmission_depth, m.transmission_scatter), (1.0, 0.5, Vec3::splat(0.25)));
    assert!((m.transmission_color.x - fp::exp(-1.0)).abs() < 1e-6);
    assert_eq!(objects(&scene).len(), 1);
    // A `null` surface without a medium is not rendered.
    let (scene, messages) = read("<scene><shape type='sphere'><bsdf type='null'/></shape></scene>");
    assert!(scene.is_some_and(|scene| objects(&scene).is_empty()), "{messages:?}");
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

/// Reads a scene whose files are in a folder. The scene must not cause any diagnostics.
pub(super) fn clean_in(files: &[(&str, &[u8])], inner: &str) -> Scene {
    let folder = folder(files);
    let (scene, messages) = read_in(folder.path(), "scene.xml", &format!("<scene version='3.0.0'>{inner}</scene>"));
    assert_eq!(messages, [""; 0], "{inner}");
    scene.unwrap()
}

/// Returns a PFM file of 2 x 1 pixels.
pub(super) fn picture(pixels: [[f32; 3]; 2]) -> Vec<u8> {
    let mut bytes = b"PF\n2 1\n-1.0\n".to_vec();
    pixels.as_flattened().iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    bytes
}

#[test]
fn emitters_without_material_do_not_scatter() {
    let light = "<emitter type='area'><rgb name='radiance' value='2'/></emitter>";
    let alone = layers(light);
    assert_eq!((alone.base_color, alone.emission_luminance), (Vec3::ZERO, 2.0));
    assert_eq!(layers(&format!("{light}<bsdf type='diffuse'/>")).base_color, Vec3::splat(0.5)); // prose: keep
    assert_eq!(layers("").base_color, Vec3::splat(0.5));
    // An inverted sphere is a dome that emits light into its interior, on that side only.
    let dome = format!("<boolean name='flip_normals' value='true'/>{light}"); // prose: keep
    let scene = clean(&format!("<shape type='sphere'>{dome}</shape>"));
    let Material::Principled(dome) = material(&scene) else { panic!() };
    assert_eq!((dome.emission_luminance, dome.walls), (2.0, Walls::Solid));
    assert_faces_inwards(&scene);
}

/// Asserts that the normals and the faces of a mesh around the origin point inwards.
fn assert_faces_inwards(scene: &Scene) {
    let data = mesh(scene);
    for (corners, normals) in data.triangles.iter().zip(&data.triangle_normals) {
        let [a, b, c] = corners.map(|i| data.positions[i as usize]);
        assert!((b - a).cross(c - a).dot(a + b + c) < 0.0, "{a} {b} {c}");
        assert!(normals.iter().zip([a, b, c]).all(|(&i, p)| data.normals[i as usize].dot(p) < -0.99));
    }
}

#[test]
fn opaque_spheres_that_are_inside_out_show_their_inside() {
    let flip = "<boolean name='flip_normals' value='true'/>"; // prose: keep
    let mirror = "<transform name='to_world'><scale x='-1'/></transform>";
    for more in [flip, mirror] {
        assert_faces_inwards(&clean(&format!("<shape type='sphere'><bsdf type='diffuse'/>{more}</shape>")));
    }
    // Both together are an ordinary sphere.
    let scene = clean(&format!("<shape type='sphere'><bsdf type='diffuse'/>{flip}{mirror}</shape>"));
    assert!(scene.assets.meshes.is_empty());
}

#[test]
fn facets_are_those_of_the_distribution() {
    let of = |more: &str| layers(&format!("<bsdf type='roughconductor'>{more}</bsdf>")).specular_facets;
    assert_eq!(of(""), Facets::Beckmann);
    assert_eq!(of("<string name='distribution' value='beckmann'/>"), Facets::Beckmann);
    assert_eq!(of("<string name='distribution' value='ggx'/>"), Facets::GgxSeparable);
    assert_eq!(layers("<bsdf type='principled'/>").specular_facets, Facets::GgxSeparable);
}

#[test]
fn blend_with_nothing_is_an_opacity() {
    let of = |parts: &str| layers(&format!("<bsdf type='blendbsdf'><float name='weight' value='.3'/>{parts}</bsdf>"));
    let (matte, none) = ("<bsdf type='diffuse'/>", "<bsdf type='null'/>");
    // `weight` is the share of the second material.
    assert!((of(&format!("{matte}{none}")).opacity - 0.7).abs() < 1e-6);
    assert!((of(&format!("{none}{matte}")).opacity - 0.3).abs() < 1e-6);
}

#[test]
fn normal_maps_are_linear_in_every_encoding() {
    // The byte 128 is 0.2158 in sRGB, and a PFM picture is always linear.
    let pfm = [b"PF\n1 1\n-1.0\n".as_slice(), &[0.5f32, 0.25, 1.0].map(f32::to_le_bytes).concat()].concat();
    let ppm = b"P6\n1 1\n255\n\x80\x40\xff";
    for (name, bytes, raw, wanted) in [
        ("n.pfm", pfm.as_slice(), "true", [0.5, 0.25, 1.0]),
        ("n.pfm", &pfm, "false", [0.5, 0.25, 1.0]),
        ("n.ppm", ppm, "false", [0.2158, 0.0513, 1.0]),
    ] {
        let map = format!(
            "<bsdf type='normalmap'><texture name='normalmap' type='bitmap'><boolean name='raw' value='{raw}'/>\
             <string name='filename' value='{name}'/></texture><bsdf type='diffuse'/></bsdf>"
        );
        let scene = clean_in(&[(name, bytes)], &format!("<shape type='rectangle'>{map}</shape>"));
        let Material::Principled(layers) = material(&scene) else { panic!() };
        let picture = &scene.assets.pictures[&layers.normal_texture.as_ref().unwrap().path];
        let PictureBytes::Memory(path, bytes) = &picture.bytes else { panic!("{name}") };
        let image = durer_image::Encoded::open(bytes, path).unwrap();
        let pixel = image.read(1 << 20, durer_image::decode_linear).unwrap().pixels[0].to_array();
        assert!((0..3).all(|k| (pixel[k] - wanted[k]).abs() < 4e-3), "{name} {raw}: {pixel:?}");
    }
}

#[test]
fn pictures_of_emitters_may_exceed_1() {
    let emitter = "<shape type='rectangle'><emitter type='area'><texture name='radiance' type='bitmap'>\
        <string name='filename' value='lamp.pfm'/></texture></emitter></shape>";
    let scene = clean_in(&[("lamp.pfm", &picture([[8.0, 2.0, 0.0], [4.0, 4.0, 4.0]]))], emitter);
    let Material::Principled(emitter) = material(&scene) else { panic!() };
    assert_eq!((emitter.emission_luminance, emitter.emission_color), (8.0, Vec3::ONE));
    let name = &emitter.emission_texture.as_ref().unwrap().path;
    let PictureBytes::Memory(path, bytes) = &scene.assets.pictures[name].bytes else { panic!() };
    let image = durer_image::read(bytes, path).unwrap();
    let wanted = [Vec3::new(1.0, 0.25, 0.0), Vec3::splat(0.5)];
    for (pixel, wanted) in image.pixels.iter().zip(wanted) {
        let light = Vec3::from_array(pixel.to_array().map(srgb));
        assert!((light - wanted).abs().max_element() < 0.01, "{light} and not {wanted}");
    }
}

/// Decodes an 8-bit sRGB value.
fn srgb(number: f32) -> f32 {
    durer_image::decode_srgb((255.0 * number).round() as u8)
}

#[test]
fn picture_colours_are_srgb_unless_raw() {
    let grey = b"P6\n1 1\n255\n\x80\x80\x80";
    let of = |raw: bool| {
        let inner = format!(
            "<shape type='rectangle'><bsdf type='diffuse'><texture name='reflectance' type='bitmap'>\
             <string name='filename' value='grey.ppm'/><boolean name='raw' value='{raw}'/></texture></bsdf></shape>"
        );
        let scene = clean_in(&[("grey.ppm", grey)], &inner);
        let Material::Principled(layers) = material(&scene) else { panic!() };
        let picture = &scene.assets.pictures[&layers.base_color_texture.as_ref().unwrap().path];
        // The alpha channel of a picture does not make the surface transparent.
        assert_eq!(picture.mapping.cutoff, Some(0.0));
        match &picture.bytes {
            PictureBytes::File(_) => srgb(128.0 / 255.0),
            PictureBytes::Memory(path, bytes) => srgb(durer_image::read(bytes, path).unwrap().pixels[0].x),
        }
    };
    assert!((of(false) - 0.2159).abs() < 1e-3 && (of(true) - 128.0 / 255.0).abs() < 4e-3);
}

#[test]
fn nested_glass_has_its_own_index() {
    // The given index is the ratio of the indices on the two sides of the surface, regardless of
    // the surrounding medium.
    let body = |radius: f32, inside: &str, outside: &str| {
        let index = |name: &str, value: &str| match value.parse::<f32>() {
            Ok(value) => format!("<float name='{name}' value='{value}'/>"),
            Err(_) => format!("<string name='{name}' value='{value}'/>"),
        };
        let (inside, outside) = (index("int_ior", inside), index("ext_ior", outside));
        format!(
            "<shape type='sphere'><float name='radius' value='{radius}'/><bsdf type='dielectric'>{inside}{outside}\
             </bsdf></shape>"
        )
    };
    let indices = |text: &str| -> Vec<f32> {
        let scene = clean(text);
        let index =
            |object: &&durer_scene::scene::Object| match &scene.materials[object.material.unwrap() as usize].value {
                Material::Principled(layers) if layers.surroundings == Surroundings::Ignored => layers.specular_ior,
                _ => panic!(),
            };
        objects(&scene).iter().map(index).collect()
    };
    let air = 1.000277;
    let near = |found: Vec<f32>, wanted: &[f32]| {
        assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?} and not {wanted:?}");
    };
    for (glass, name) in [("1.5046", "bk7"), ("1.5", "1.5")] {
        let glass: f32 = glass.parse().unwrap();
        let outer = body(1.0, name, "air");
        near(indices(&(outer.clone() + &body(0.5, "water", name))), &[glass / air, 1.333 / glass]);
        near(indices(&(body(0.5, "air", name) + &outer)), &[air / glass, glass / air]);
    }
    near(indices(&body(1.0, "water", "1.5")), &[1.333 / 1.5]);
}

#[test]
fn sides_and_facets_match_mitsuba() {
    let of = |kind: &str| layers(&format!("<bsdf type='{kind}'/>"));
    // Materials other than glass and thin sheets are black from behind unless they are `twosided`.
    for kind in ["diffuse", "conductor", "plastic", "principled"] {
        assert_eq!(of(kind).backs, Backs::Black, "{kind}");
        assert_eq!(layers(&format!("<bsdf type='twosided'><bsdf type='{kind}'/></bsdf>")).backs, Backs::Shown);
    }
    for kind in ["dielectric", "thindielectric", "principledthin"] {
        assert_eq!(of(kind).backs, Backs::Shown, "{kind}");
    }
    assert!(["conductor", "dielectric", "principled"].iter().all(|kind| of(kind).energy_compensation == Switch::Off));
    let color = |value: &str| format!("<bsdf type='diffuse'><rgb name='reflectance' value='{value}'/></bsdf>");
    let sides = format!("<bsdf type='twosided'>{}{}</bsdf>", color("1,0,0"), color("0,1,0"));
    let scene = clean(&format!("<shape type='rectangle'>{sides}</shape>"));
    let Material::Solid(durer_scene::material::PatternMaterial::TwoSided(two), _) = material(&scene) else { panic!() };
    let base = |number: u32| match &scene.materials[number as usize].value {
        Material::Principled(layers) => layers.base_color,
        _ => panic!(),
    };
    assert_eq!((base(two.material1), base(two.material2)), (Vec3::X, Vec3::Y));
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

#[test]
fn conductor_tint_applies_at_all_angles() {
    let metal =
        |more: &str| layers(&format!("<bsdf type='conductor'><string name='material' value='Au'/>{more}</bsdf>"));
    let (plain, tinted) = (metal(""), metal("<rgb name='specular_reflectance' value='.5,.25,.5'/>"));
    let tint = Vec3::new(0.5, 0.25, 0.5);
    assert!((tinted.base_color - tint * plain.base_color).abs().max_element() < 1e-6);
    assert_eq!((plain.specular_color, tinted.specular_color), (Vec3::ONE, tint));
    assert!(plain.metal_ior.is_some() && plain.metal_ior == tinted.metal_ior);
    // Without a material, all light is reflected: n = 0 and k = 1.
    let white = layers("<bsdf type='conductor'/>");
    assert_eq!((white.metal_ior, white.metal_extinction, white.base_color), (Some(Vec3::ZERO), Vec3::ONE, Vec3::ONE));
}

/// Mesh of two faces with a fold between them, in which only one vertex has a colour.
const FOLDED: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    property float u\nproperty float v\nproperty float r\nproperty float g\nproperty float b\n\
    element face 2\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0 0 0 .5 .2 .8\n1 0 0 1 0 1 1 1\n1 1 0 1 1 1 1 1\n0 1 1 0 1 1 1 1\n3 0 1 2\n3 0 2 3\n";

#[test]
fn mesh_files_are_smooth_and_uncoloured_by_default() {
    let of = |more: &str| {
        let inner = format!("<shape type='ply'><string name='filename' value='folded.ply'/>{more}</shape>");
        mesh(&clean_in(&[("folded.ply", FOLDED.as_bytes())], &inner)).clone()
    };
    let plain = of("");
    assert!(plain.colors.is_empty() && !plain.flat && plain.tangents.is_empty());
    // At the fold, the normal is the mean of the normals of both faces, weighted by their angles of
    // 45 and 60 degrees.
    let a = plain.triangles[0].iter().position(|&i| plain.positions[i as usize] == Vec3::ZERO).unwrap();
    let [face, other] = [Vec3::Z, Vec3::new(1.0, -1.0, 1.0) / 3f32.sqrt()];
    let angles = [45f32.to_radians(), 60f32.to_radians()];
    let wanted = (angles[0] * face + angles[1] * other).normalize();
    let found = plain.normals[plain.triangle_normals[0][a] as usize];
    assert!((found - wanted).length() < 1e-5, "{found} and not {wanted}");
    assert!(of("<boolean name='face_normals' value='true'/>").flat);
    let colored = of("<bsdf type='diffuse'><texture name='reflectance' type='mesh_attribute'>\
        <string name='name' value='vertex_color'/></texture></bsdf>");
    let dimmed = "<shape type='ply'><string name='filename' value='folded.ply'/><bsdf type='diffuse'>\
        <texture name='reflectance' type='mesh_attribute'><string name='name' value='vertex_color'/>\
        <float name='scale' value='.5'/></texture></bsdf></shape>";
    let scene = clean_in(&[("folded.ply", FOLDED.as_bytes())], dimmed);
    let Material::Principled(dimmed) = material(&scene) else { panic!() };
    assert_eq!(dimmed.base_color, Vec3::splat(0.5));
    // Vertex colours of PLY files are linear.
    let wanted = [0.5, 0.2, 0.8];
    let found = colored.colors[0];
    assert!((0..3).all(|k| (found[k] - wanted[k]).abs() < 4e-3) && found[3] == 1.0, "{found:?}");
}

#[test]
fn normal_map_tangents_follow_u() {
    let leaning = "<bsdf type='normalmap'><texture name='normalmap' type='bitmap'><boolean name='raw' value='true'/>\
        <string name='filename' value='n.ppm'/></texture><bsdf type='diffuse'/></bsdf>";
    let files: [(&str, &[u8]); 2] = [("n.ppm", b"P6\n1 1\n255\n\x80\x80\xff"), ("folded.ply", FOLDED.as_bytes())];
    for shape in [
        "<shape type='rectangle'>",
        "<shape type='ply'><string name='filename' value='folded.ply'/>",
        "<shape type='cylinder'>",
    ] {
        let scene = clean_in(&files, &format!("{shape}{leaning}</shape>"));
        let data = mesh(&scene);
        assert_eq!(data.tangents.len(), data.positions.len(), "{shape}");
        for (corners, uvs) in data.triangles.iter().zip(&data.triangle_uvs) {
            for k in 0..3 {
                // The tangent points in the direction of increasing u.
                let tangent = data.tangents[corners[k] as usize];
                let [x, y, z, side] = tangent;
                let along = (0..3).filter(|&l| l != k).map(|l| {
                    let way = data.positions[corners[l] as usize] - data.positions[corners[k] as usize];
                    (way.dot(Vec3::new(x, y, z)), data.uvs[uvs[l] as usize].x - data.uvs[uvs[k] as usize].x)
                });
                for (way, u) in along.filter(|(way, u)| way.abs() > 0.1 && u.abs() > 0.1) {
                    assert!(way * u > 0.0, "{shape}: {tangent:?}");
                }
                assert_eq!(side, 1.0);
            }
        }
    }
}

#[test]
fn cylinder_axes_match_mitsuba() {
    // Point at which u is 0 on cylinders of radius 1 in Mitsuba 3.9.1, as an offset from the axis.
    for (to, start) in [
        ([0.0, 0.0, 2.0], [1.0, 0.0, 0.0]),
        ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]),
        ([1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ([0.5, 1.0, -2.0], [0.97462, -0.05180, 0.21776]),
        ([-1.0, 0.2, 0.3], [0.30987, 0.13836, 0.94066]),
    ] {
        let [x, y, z] = to;
        let scene = clean(&format!(
            "<shape type='cylinder'><point name='p0' x='0' y='0' z='0'/><point name='p1' x='{x}' y='{y}' z='{z}'/></shape>"
        ));
        let (data, mut map) = (mesh(&scene), glam::DAffine3::IDENTITY);
        let mut object = &scene.root.as_ref().unwrap().objects[0];
        while let ObjectKind::Transform(ops, inner) = &object.node {
            (map, object) = (map * MatrixOp::product(ops, MatrixRules::default()), inner);
        }
        let number = data.uvs.iter().position(|uv| uv.x == 0.0).unwrap();
        let corner = data.triangle_uvs.iter().zip(&data.triangles).find_map(|(uvs, corners)| {
            uvs.iter().position(|&uv| uv == number as u32).map(|k| data.positions[corners[k] as usize])
        });
        let found = map.transform_vector3(corner.unwrap().with_z(0.0).as_dvec3()).as_vec3();
        assert!((found - Vec3::from_array(start)).length() < 2e-3, "{to:?}: {found} and not {start:?}");
    }
}

#[test]
fn curve_files_with_hair_become_tubes() {
    let folder = folder(&[
        ("hair.txt", b"0 0 0 0.1\n1 0 0 0.1\n2 0 0 0.1\n3 0 0 0.1\n\n0 1 0 0.2\n1 1 0 0.2\n2 1 0 0.2\n3 1 0 0.2\n"),
        ("short.txt", b"0 0 0 0.1\n1 0 0 0.1\n"),
        ("bad.txt", b"0 0 0 0.1\n1 0 0\n"),
        ("thin.txt", b"0 0 0 0.1\n1 0 0 -1\n"),
    ]);
    let text = |kind: &str, file: &str| {
        format!(
            "<scene version='3.0.0'><shape type='{kind}'><string name='filename' value='{file}'/>\
             <bsdf type='hair'><float name='eumelanin' value='0.5'/><float name='scale_tilt' value='3'/>\
             <float name='int_ior' value='1.6'/><float name='ext_ior' value='1'/></bsdf></shape></scene>"
        )
    };
    // Splines have flat ends, and linear curves end in hemispheres.
    for (kind, from, to, ball) in [("bsplinecurve", 1.0, 2.0, 0.0), ("linearcurve", 0.0, 3.0, 0.2)] {
        let (scene, messages) = read_in(folder.path(), "scene.xml", text(kind, "hair.txt"));
        assert_eq!(messages, [""; 0]);
        let scene = scene.unwrap();
        let Material::Hair(hair) = material(&scene) else { panic!("{kind}") };
        let wanted =
            HairMaterial { eumelanin: 0.5, pheomelanin: 0.2, scale_tilt: 3.0, ior: 1.6, ..HairMaterial::default() };
        assert_eq!(*hair, wanted);
        let data = scene.assets.meshes.values().next().unwrap();
        let ends = data.positions.iter().fold((9.0_f32, -9.0_f32), |(a, b), p| (a.min(p.x), b.max(p.x)));
        assert!((ends.0 - from + ball).abs() < 1e-5 && (ends.1 - to - ball).abs() < 1e-5, "{kind}: {ends:?}");
        // Each of the two tubes has the width that its radius gives, and u increases along them.
        let wide = |y: f32| data.positions.iter().map(|p| (p.y - y).abs()).filter(|d| *d < 0.4).fold(0.0, f32::max);
        assert!((wide(0.0) - 0.1).abs() < 0.004 && (wide(1.0) - 0.2).abs() < 0.008, "{} {}", wide(0.0), wide(1.0));
        let u = |p: &Vec3| ((p.x - from) / (to - from)).clamp(0.0, 1.0);
        assert!(data.positions.iter().zip(&data.uvs).all(|(p, uv)| (u(p) - uv.x).abs() < 1e-4));
    }
    for (file, kind, wanted) in [
        (
            "short.txt",
            "bsplinecurve",
            "short.txt:3:1 error the curve that ends here has 2 points, but needs at least 4 points",
        ),
        (
            "bad.txt",
            "linearcurve",
            "bad.txt:2:1 error a point of a curve must be three numbers and a radius of 0 or more",
        ),
        (
            "thin.txt",
            "linearcurve",
            "thin.txt:2:1 error a point of a curve must be three numbers and a radius of 0 or more",
        ),
        ("none.txt", "linearcurve", "error the curves cannot be read"),
    ] {
        let (scene, messages) = read_in(folder.path(), "scene.xml", text(kind, file));
        assert!(scene.is_none() && messages.iter().any(|message| message.contains(wanted)), "{messages:#?}");
    }
}
