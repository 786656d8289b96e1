//! Tests of pbrt-v3 scenes, which cover the detection of the language and its conventions.

use super::*;
use durer_image::{Image, Layer, WriteOptions, format_for};
use durer_scene::light::{Fade, Light};
use durer_scene::material::PatternMaterial;
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::PictureBytes;

const HEAD: &str = "Film \"image\" Camera \"perspective\" WorldBegin ";

fn third(text: &str) -> Scene {
    clean(&format!("{HEAD}{text}"))
}

pub(super) fn close(a: Vec3, b: Vec3) {
    assert!((a - b).length() < 1e-4 * (1.0 + b.length()), "{a} is not {b}");
}

fn lights(text: &str) -> Vec<Light> {
    third(&format!("{text} Shape \"sphere\"")).lights.unwrap().into_iter().map(|light| light.value).collect()
}

/// Returns the layers of a sphere's material and their shares, with one entry for each part of a
/// mix.
pub(super) fn parts(text: &str) -> Vec<(f32, PrincipledMaterial)> {
    let (scene, messages) = read(&format!("{HEAD}{text} Shape \"sphere\""));
    let scene = scene.unwrap_or_else(|| panic!("{text}: {messages:?}")); // prose: keep
    let first = scene.root.as_ref().unwrap().objects[0].material.unwrap();
    let (mut open, mut found) = (vec![(1.0, first)], Vec::new());
    while let Some((share, number)) = open.pop() {
        match &scene.materials[number as usize].value {
            Material::Principled(layers) => found.push((share, (**layers).clone())),
            Material::Solid(PatternMaterial::Mix(mix), _) => {
                open.push((share * (1.0 - mix.share), mix.material2));
                open.push((share * mix.share, mix.material1));
            }
            other => panic!("{other:?}"),
        }
    }
    found
}

/// Encodes a picture as PFM.
fn pfm(width: u32, height: u32, pixel: impl Fn(u32, u32) -> Color) -> Vec<u8> {
    let pixels = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
    let image = Image::from_pixels(width, height, pixels).unwrap();
    let mut bytes = Vec::new();
    let format = format_for("a.pfm").unwrap();
    format.write(&[Layer::data("", image)], &WriteOptions::default(), &mut bytes).unwrap();
    bytes
}

#[test]
fn first_unambiguous_word_decides_language() {
    // In pbrt-v3, values are absolute. In pbrt-v4, a spectrum is scaled to a luminance of 1.
    let light = "LightSource \"point\" \"spectrum I\" [ 300 5 900 5 ] Shape \"sphere\"";
    let is_third = |text: &str| {
        let (scene, messages) = read(&format!("{text} {light}"));
        let scene = scene.unwrap_or_else(|| panic!("{text}: {messages:?}")); // prose: keep
        let lights = scene.lights.unwrap();
        let point =
            lights.iter().find_map(|light| if let Light::Point(point) = &light.value { Some(point) } else { None });
        point.unwrap().color.y > 1.0
    };
    let camera = "Camera \"perspective\" WorldBegin ";
    for text in [
        &format!("Film \"image\" {camera}")[..],
        &format!("Sampler \"lowdiscrepancy\" {camera}"),
        &format!("SurfaceIntegrator \"path\" {camera}"),
        &format!("{camera} Material \"matte\""),
        &format!("{camera} Material \"none\" MakeNamedMaterial \"diffuse\" \"string type\" \"uber\""),
        &format!("{camera} Texture \"t\" \"color\" \"constant\""),
        &format!("{camera} Shape \"cone\""),
        &format!("{camera} LightSource \"distant\" \"rgb scale\" [ 1 1 1 ]"),
        &format!("{camera} AreaLightSource \"diffuse\" \"integer nsamples\" 4"),
        &format!("{camera} MakeNamedMedium \"a\" \"string type\" \"heterogeneous\" \"float density\" 1"),
        // The first keyword that exists in only one version decides the language.
        &format!("{camera} Material \"matte\" ColorSpace \"srgb\""),
    ] {
        assert!(is_third(text), "{text}");
    }
    for text in [
        &format!("Film \"rgb\" {camera}")[..],
        camera,
        &format!("{camera} MakeNamedMaterial \"matte\" \"string type\" \"diffuse\""),
        &format!("{camera} LightSource \"distant\" \"float scale\" 1"),
        &format!("Film \"rgb\" {camera} LightSource \"point\" \"rgb I\" [ 1 1 1 ]"),
        &format!(
            "{camera} Texture \"mirror\" \"spectrum\" \"constant\" MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \
             \"texture reflectance\" \"mirror\""
        ),
    ] {
        assert!(!is_third(text), "{text}");
    }
    // An included file can decide the language.
    let folder = folder(&[("a.pbrt", b"Material \"matte\"")]);
    let text = format!("{camera} {light} Include \"a.pbrt\"");
    let (scene, messages) = read_in(folder.path(), &text);
    let Light::Point(point) = &scene.unwrap_or_else(|| panic!("{messages:?}")).lights.unwrap()[0].value else {
        panic!()
    };
    assert!(point.color.y > 1.0);
}

#[test]
fn light_values_are_absolute() {
    let pi = std::f32::consts::PI;
    let point = |text: &str| match &lights(&format!("LightSource \"point\" {text}"))[0] {
        Light::Point(point) => (point.position, point.color),
        other => panic!("{other:?}"),
    };
    let (place, color) = point("\"color I\" [ 2 4 6 ] \"rgb scale\" [ 0.5 1 2 ] \"point from\" [ 1 2 3 ]");
    close(color, Vec3::new(1.0, 4.0, 12.0) / pi);
    assert_eq!(place, Vec3::new(1.0, 2.0, 3.0));
    // A constant spectrum of 1 has the RGB colour of X = Y = Z = 1.
    let white = Vec3::new(1.2048, 0.9483, 0.9087);
    assert!((point("\"spectrum I\" [ 500 3 600 3 ]").1 * pi / 3.0 - white).abs().max_element() < 0.01);
    assert!((point("\"xyz I\" [ 3 3 3 ]").1 * pi / 3.0 - white).abs().max_element() < 0.001);
    // A blackbody is scaled so that its peak, which is at 500 nm here, is 1.
    let body = |text: &str| point(&format!("\"blackbody I\" [ {text} ]")).1;
    let warm = body("5795.5 1");
    assert!(warm.y * pi > 0.9 && warm.y * pi < 1.0, "{warm}");
    close(body("5795.5 4"), 4.0 * warm);
    let head = "Film \"image\" \"float scale\" 3 Camera \"perspective\" \"float shutterclose\" 7 WorldBegin ";
    let scene = clean(&format!("{head} LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] Shape \"sphere\""));
    // The film's scale has an effect, but the shutter time does not.
    assert_eq!(scene.background.color, Vec3::new(3.0, 6.0, 9.0));
    let Light::Spot(spot) = lights("LightSource \"spot\" \"float coneangle\" 40")[0].clone() else { panic!() };
    assert_eq!((spot.angle, spot.inner_angle, spot.fade), (40.0, 35.0, Fade::Fourth));
    let text = "AreaLightSource \"area\" \"rgb L\" [ 1 2 3 ] \"rgb scale\" [ 2 2 2 ] \"integer nsamples\" 8";
    let (_, emissive) = parts(text)[0].clone();
    close(emissive.emission_luminance * emissive.emission_color, Vec3::new(2.0, 4.0, 6.0));
}

#[test]
fn environment_has_z_up_and_x_at_left_edge() {
    // Rows go down from +z, and columns go from +x through +y.
    let bytes = pfm(8, 4, |x, y| Vec3::new(x as f32, y as f32, 1.0));
    let folder = folder(&[("sky.pfm", &bytes)]);
    let text =
        format!("{HEAD} LightSource \"infinite\" \"string mapname\" \"sky.pfm\" \"rgb L\" [ 2 1 1 ] Shape \"sphere\"");
    let (scene, messages) = read_in(folder.path(), &text);
    let scene = scene.unwrap_or_else(|| panic!("{messages:?}"));
    let PictureBytes::Memory(name, bytes) = &scene.assets.pictures["sky.pfm#environment.pfm"].bytes else { panic!() };
    let encoded = durer_image::Encoded::open(bytes, name).unwrap();
    let sky = encoded.read(u64::MAX, durer_image::decode_linear).unwrap();
    let at = |dir: [f64; 3]| crate::panorama::nearest(&sky, dir.into());
    // The direction +y is between the texels at 67.5 and 112.5 degrees, both in longitude and in
    // the angle from the pole.
    let y = at([0.0, 1.0, 0.001]);
    assert!((y.x / 2.0 - 1.5).abs() < 0.6 && (y.y - 1.5).abs() < 0.6, "{y}");
    let west = at([-1.0, 0.0, 0.001]);
    assert!((west.x / 2.0 - 3.5).abs() < 0.6, "{west}");
    assert!(at([0.0, 0.1, 1.0]).y < 0.6 && at([0.0, 0.1, -1.0]).y > 2.4);
}

#[test]
fn pictured_lights_follow_their_pictures() {
    let gonio = pfm(8, 4, |x, y| Vec3::splat(if y == 0 { 5.0 } else { (x + 1) as f32 }));
    let slide = pfm(4, 2, |x, y| Vec3::new(x as f32, y as f32, 0.0));
    let folder = folder(&[("gonio.pfm", &gonio), ("slide.pfm", &slide)]);
    let lights = |text: &str| {
        let (scene, messages) = read_in(folder.path(), &format!("{HEAD}{text} Shape \"sphere\""));
        let scene = scene.unwrap_or_else(|| panic!("{messages:?}"));
        assert_eq!(messages, [""; 0]);
        move |dir: [f32; 3]| -> Color {
            let each = scene.lights.iter().flatten().map(|light| {
                use durer_scene::light::Illuminate;
                let profile = &scene.assets.profiles[&light.value.profile().unwrap().path];
                light.value.color() * profile.at(light.value.to_profile(Vec3::from_array(dir).normalize()))
            });
            each.sum()
        }
    };
    let gonio = "LightSource \"goniometric\" \"rgb I\" [ 1 2 3 ] \"string mapname\" \"gonio.pfm\"";
    let emissive = lights(gonio);
    // As in pbrt-v3, the pole is +y, where the first row meets the last one. Columns go from +x
    // through +z.
    close(emissive([0.0, 1.0, 0.0]), 0.5 * (5.0 + 4.5) * Vec3::new(1.0, 2.0, 3.0));
    close(emissive([0.0, 0.0, 1.0]), 2.5 * Vec3::new(1.0, 2.0, 3.0));
    close(emissive([-1.0, 0.0, 0.0]), 4.5 * Vec3::new(1.0, 2.0, 3.0));
    close(emissive([0.0, 0.0, -1.0]), 6.5 * Vec3::new(1.0, 2.0, 3.0));
    // The light is rotated so that its pole is +x and z is unchanged.
    let turned = lights(&format!("Rotate -90 0 0 1 {gonio}"));
    close(turned([1.0, 0.0, 0.0]), 4.75 * Vec3::new(1.0, 2.0, 3.0));
    close(turned([0.0, 0.0, 1.0]), 2.5 * Vec3::new(1.0, 2.0, 3.0));
    // The light is mirrored.
    let mirrored = lights(&format!("Scale 1 1 -1 {gonio}"));
    close(mirrored([0.0, 0.0, -1.0]), 2.5 * Vec3::new(1.0, 2.0, 3.0));
    // The field of view is 90 degrees across the shorter side, so the picture covers -2 to 2 by -1
    // to 1.
    let slide = lights("LightSource \"projection\" \"float fov\" 90 \"string mapname\" \"slide.pfm\"");
    let at = |x: f32, y: f32| slide([x, y, 1.0]);
    for (place, wanted) in [((0.5, 0.5), [2.0, 1.0, 0.0]), ((-1.5, -0.5), [0.0; 3]), ((1.5, 0.0), [3.0, 0.5, 0.0])] {
        assert!(
            (at(place.0, place.1) - Vec3::from_array(wanted)).length() < 0.05,
            "{place:?} {}",
            at(place.0, place.1)
        );
    }
    assert_eq!((at(2.1, 0.0), at(0.0, 1.1), slide([0.0, 0.0, -1.0])), (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO));
}

#[test]
fn errors_and_warnings_of_pbrt_v3() {
    for (text, wanted) in [
        ("\nMaterial \"mattte\"", "scene.pbrt:2:11 error unknown material `mattte` in pbrt-v3 (did you mean `matte`?)"),
        ("Material \"conductor\"", "error unknown material `conductor` in pbrt-v3 (`conductor` is a pbrt-v4 material"),
        ("Material \"mix\" \"string namedmaterial1\" \"a\"", "error no material `a` is defined before this point"),
        ("Material \"mix\"", "error a mix needs `\"string namedmaterial1\"`"),
        ("LightSource \"infinite\" \"string mapname\" \"no.exr\"", "error the file `no.exr` does not exist"),
        ("LightSource \"projection\" \"float fov\" 180", "error a field of view must be more than 0 and less than 180"),
        (
            "Texture \"t\" \"colour\" \"constant\"",
            "error a texture must be of type `float` or `spectrum`, not `colour`",
        ),
        (
            "Material \"matte\" \"spectrum Kd\" \"no.spd\"",
            "error cannot read the spectrum: the file `no.spd` does not exist",
        ),
        ("Shape \"curve\"", "error a curve needs points"),
        ("Shape \"curve\" \"point P\" [ 0 0 0 1 0 0 ]", "error a Bézier curve of degree 3 cannot have 2 points"),
        (
            "Shape \"curve\" \"string type\" \"ribbon\" \"point P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]",
            "error a ribbon of 1 segments needs 2 normals `N`, found 0",
        ),
        ("Shape \"sphere\" \"float zmin\" 0.5 \"float zmax\" 0.5", "error no part of this sphere is between"),
        ("Shape \"cone\" \"float height\" 0", "error `height` must be more than 0"),
        ("Shape \"paraboloid\" \"float zmin\" -1", "error a paraboloid needs 0 <= `zmin`"),
        ("Shape \"hyperboloid\" \"point p2\" [ 0 0 1 ]", "error a hyperboloid needs two different points"),
        ("Shape \"disk\" \"float phimax\" 0", "error `phimax` must be more than 0 degrees"),
        (
            "Shape \"heightfield\" \"integer nu\" 2 \"integer nv\" 2 \"float Pz\" [ 1 2 3 ]",
            "error `Pz` has 3 values, but needs one for each of 2 x 2 points",
        ),
        ("Shape \"heightfield\" \"integer nu\" 1", "error `nu` and `nv` must be 2 or more"),
        ("Shape \"nurbs\" \"integer nu\" 2 \"integer nv\" 2", "error `uorder` must be from 2"),
        (
            "Shape \"loopsubdiv\" \"integer levels\" 99 \"point P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]",
            "error `levels` must be from 0 to 16",
        ),
    ] {
        let (scene, messages) = read(&format!("{HEAD}{text}"));
        assert!(scene.is_none(), "{text}");
        assert!(messages.iter().any(|message| message.contains(wanted)), "{text}\n{wanted}\n{messages:#?}");
    }
    for (text, wanted) in [
        (
            "Material \"plastic\" \"float uroughness\" 1",
            "warning the material `plastic` has no parameter `uroughness`: it is ignored (did you mean `roughness`?)",
        ),
        (
            "LightSource \"point\" \"float scale\" 3",
            "warning the `scale` of a light must be a colour in pbrt-v3: this number",
        ),
        ("LightSource \"point\" \"float power\" 3", "warning this light has no parameter `power`"),
        ("Material \"fourier\" \"string bsdffile\" \"a.bsdf\"", "warning measured materials have no counterpart"),
        ("Material \"disney\" \"float flatness\" 1", "warning `flatness` has no counterpart"),
        ("Material \"uber\" \"rgb opacity\" [ 1 0 0 ]", "warning a coloured `opacity` has no counterpart"),
        ("Material \"translucent\"", "warning refraction by the glossy transmission of `translucent`"),
        (
            "Shape \"curve\" \"point P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]",
            "warning curves of type `flat` have no counterpart",
        ),
        (
            "Material \"substrate\" \"float uroughness\" 0.3",
            "warning an anisotropic coat over a matte base has no counterpart",
        ),
        (
            "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"string preset\" \"Skin7\"",
            "warning unknown medium preset `Skin7`",
        ),
    ] {
        let (scene, messages) = read(&format!("{HEAD}{text} Shape \"sphere\""));
        assert!(scene.is_some() && messages.len() == 1, "{text}\n{messages:#?}");
        assert!(messages[0].contains(wanted), "{text}\n{wanted}\n{messages:#?}");
    }
}
