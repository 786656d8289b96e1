//! pbrt-v3: which files are of it, and what its words mean.

use super::*;
use durer_image::{Image, Layer, WriteOptions, format_for};
use durer_scene::light::{Fade, Light};
use durer_scene::material::Solid;
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

/// The layers of a sphere's material, of a mix each of its parts, with their shares.
pub(super) fn parts(text: &str) -> Vec<(f32, PrincipledMaterial)> {
    let (scene, told) = read(&format!("{HEAD}{text} Shape \"sphere\""));
    let scene = scene.unwrap_or_else(|| panic!("{text}: {told:?}"));
    let first = scene.root.as_ref().unwrap().objects[0].material.unwrap();
    let (mut open, mut found) = (vec![(1.0, first)], Vec::new());
    while let Some((share, number)) = open.pop() {
        match &scene.materials[number as usize].value {
            Material::Principled(layers) => found.push((share, (**layers).clone())),
            Material::Solid(Solid::Mix(mix), _) => {
                open.push((share * (1.0 - mix.share), mix.material2));
                open.push((share * mix.share, mix.material1));
            }
            other => panic!("{other:?}"),
        }
    }
    found
}

/// A picture as a file of PFM.
fn pfm(width: u32, height: u32, pixel: impl Fn(u32, u32) -> Color) -> Vec<u8> {
    let pixels = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
    let image = Image::from_pixels(width, height, pixels).unwrap();
    let mut bytes = Vec::new();
    let format = format_for("a.pfm").unwrap();
    format.write(&[Layer::data("", image)], &WriteOptions::default(), &mut bytes).unwrap();
    bytes
}

#[test]
fn the_first_word_that_one_language_alone_has_decides() {
    // In pbrt-v3 a light is as strong as its numbers; in pbrt-v4 a spectrum has luminance 1.
    let light = "LightSource \"point\" \"spectrum I\" [ 300 5 900 5 ] Shape \"sphere\"";
    let is_third = |text: &str| {
        let (scene, told) = read(&format!("{text} {light}"));
        let scene = scene.unwrap_or_else(|| panic!("{text}: {told:?}"));
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
        // What comes first counts.
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
    // A file that is included may say so first.
    let folder = folder(&[("a.pbrt", b"Material \"matte\"")]);
    let text = format!("{camera} {light} Include \"a.pbrt\"");
    let (scene, told) = read_in(folder.path(), &text);
    let Light::Point(point) = &scene.unwrap_or_else(|| panic!("{told:?}")).lights.unwrap()[0].value else { panic!() };
    assert!(point.color.y > 1.0);
}

#[test]
fn lights_are_as_strong_as_their_numbers() {
    let pi = std::f32::consts::PI;
    let point = |text: &str| match &lights(&format!("LightSource \"point\" {text}"))[0] {
        Light::Point(point) => (point.position, point.color),
        other => panic!("{other:?}"),
    };
    let (place, color) = point("\"color I\" [ 2 4 6 ] \"rgb scale\" [ 0.5 1 2 ] \"point from\" [ 1 2 3 ]");
    close(color, Vec3::new(1.0, 4.0, 12.0) / pi);
    assert_eq!(place, Vec3::new(1.0, 2.0, 3.0));
    // Red, green and blue of a spectrum of 1 are those of X = Y = Z = 1.
    let white = Vec3::new(1.2048, 0.9483, 0.9087);
    assert!((point("\"spectrum I\" [ 500 3 600 3 ]").1 * pi / 3.0 - white).abs().max_element() < 0.01);
    assert!((point("\"xyz I\" [ 3 3 3 ]").1 * pi / 3.0 - white).abs().max_element() < 0.001);
    // A black body is 1 where it is strongest, here at 500 nm; of red light less than of white.
    let body = |text: &str| point(&format!("\"blackbody I\" [ {text} ]")).1;
    let warm = body("5795.5 1");
    assert!(warm.y * pi > 0.9 && warm.y * pi < 1.0, "{warm}");
    close(body("5795.5 4"), 4.0 * warm);
    let head = "Film \"image\" \"float scale\" 3 Camera \"perspective\" \"float shutterclose\" 7 WorldBegin ";
    let scene = clean(&format!("{head} LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] Shape \"sphere\""));
    // The film's scale counts, and how long the shutter is open does not.
    assert_eq!(scene.background.color, Vec3::new(3.0, 6.0, 9.0));
    let Light::Spot(spot) = lights("LightSource \"spot\" \"float coneangle\" 40")[0].clone() else { panic!() };
    assert_eq!((spot.angle, spot.inner_angle, spot.fade), (40.0, 35.0, Fade::Fourth));
    let text = "AreaLightSource \"area\" \"rgb L\" [ 1 2 3 ] \"rgb scale\" [ 2 2 2 ] \"integer nsamples\" 8";
    let (_, shining) = parts(text)[0].clone();
    close(shining.emission_luminance * shining.emission_color, Vec3::new(2.0, 4.0, 6.0));
}

#[test]
fn pictures_of_all_directions_have_z_above_and_x_at_their_left_edge() {
    // Rows go from z down, columns from x over y.
    let bytes = pfm(8, 4, |x, y| Vec3::new(x as f32, y as f32, 1.0));
    let folder = folder(&[("sky.pfm", &bytes)]);
    let text =
        format!("{HEAD} LightSource \"infinite\" \"string mapname\" \"sky.pfm\" \"rgb L\" [ 2 1 1 ] Shape \"sphere\"");
    let (scene, told) = read_in(folder.path(), &text);
    let scene = scene.unwrap_or_else(|| panic!("{told:?}"));
    let PictureBytes::Here(name, bytes) = &scene.assets.pictures["sky.pfm#environment.pfm"].bytes else { panic!() };
    let encoded = durer_image::Encoded::open(bytes, name).unwrap();
    let sky = encoded.read(u64::MAX, durer_image::decode_linear).unwrap();
    let at = |dir: [f64; 3]| crate::panorama::looked_up(&sky, dir.into());
    // Between the texels of 45 and of 135 degrees lies y, between 22.5 and 67.5 down the pole.
    let y = at([0.0, 1.0, 0.001]);
    assert!((y.x / 2.0 - 1.5).abs() < 0.6 && (y.y - 1.5).abs() < 0.6, "{y}");
    let west = at([-1.0, 0.0, 0.001]);
    assert!((west.x / 2.0 - 3.5).abs() < 0.6, "{west}");
    assert!(at([0.0, 0.1, 1.0]).y < 0.6 && at([0.0, 0.1, -1.0]).y > 2.4);
}

#[test]
fn lights_by_pictures_shine_as_those_say() {
    let gonio = pfm(8, 4, |x, y| Vec3::splat(if y == 0 { 5.0 } else { (x + 1) as f32 }));
    let slide = pfm(4, 2, |x, y| Vec3::new(x as f32, y as f32, 0.0));
    let folder = folder(&[("gonio.pfm", &gonio), ("slide.pfm", &slide)]);
    let lamps = |text: &str| {
        let (scene, told) = read_in(folder.path(), &format!("{HEAD}{text} Shape \"sphere\""));
        let scene = scene.unwrap_or_else(|| panic!("{told:?}"));
        assert_eq!(told, [""; 0]);
        move |dir: [f32; 3]| -> Color {
            let each = scene.lights.iter().flatten().map(|light| {
                use durer_scene::light::Emitter;
                let profile = &scene.assets.profiles[&light.value.profile().unwrap().path];
                light.value.color() * profile.at(light.value.in_profile(Vec3::from_array(dir).normalize()))
            });
            each.sum()
        }
    };
    let gonio = "LightSource \"goniometric\" \"rgb I\" [ 1 2 3 ] \"string mapname\" \"gonio.pfm\"";
    let shining = lamps(gonio);
    // Its pole is y, where the first row meets the last, as pbrt-v3 has it; columns go from x over z.
    close(shining([0.0, 1.0, 0.0]), 0.5 * (5.0 + 4.5) * Vec3::new(1.0, 2.0, 3.0));
    close(shining([0.0, 0.0, 1.0]), 2.5 * Vec3::new(1.0, 2.0, 3.0));
    close(shining([-1.0, 0.0, 0.0]), 4.5 * Vec3::new(1.0, 2.0, 3.0));
    close(shining([0.0, 0.0, -1.0]), 6.5 * Vec3::new(1.0, 2.0, 3.0));
    // Turned: its pole is x, and its z stays.
    let turned = lamps(&format!("Rotate -90 0 0 1 {gonio}"));
    close(turned([1.0, 0.0, 0.0]), 4.75 * Vec3::new(1.0, 2.0, 3.0));
    close(turned([0.0, 0.0, 1.0]), 2.5 * Vec3::new(1.0, 2.0, 3.0));
    // A mirrored one.
    let mirrored = lamps(&format!("Scale 1 1 -1 {gonio}"));
    close(mirrored([0.0, 0.0, -1.0]), 2.5 * Vec3::new(1.0, 2.0, 3.0));
    // 90 degrees across the shorter side: the picture reaches from -2 to 2 and from -1 to 1.
    let slide = lamps("LightSource \"projection\" \"float fov\" 90 \"string mapname\" \"slide.pfm\"");
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
        (
            "\nMaterial \"mattte\"",
            "scene.pbrt:2:11 error there is no material `mattte` in pbrt-v3 (did you mean `matte`?)",
        ),
        ("Material \"conductor\"", "error there is no material `conductor` in pbrt-v3 (this is of pbrt-v4"),
        ("Material \"mix\" \"string namedmaterial1\" \"a\"", "error there is no material `a` before this"),
        ("Material \"mix\"", "error a mix needs `\"string namedmaterial1\"`"),
        ("LightSource \"infinite\" \"string mapname\" \"no.exr\"", "error there is no file `no.exr`"),
        ("LightSource \"projection\" \"float fov\" 180", "error a field of view must be more than 0 and less than 180"),
        ("Texture \"t\" \"colour\" \"constant\"", "error textures are `float` or `spectrum`, not `colour`"),
        (
            "Material \"matte\" \"spectrum Kd\" \"no.spd\"",
            "error the spectrum cannot be read: there is no file `no.spd`",
        ),
        ("Shape \"curve\"", "error a curve needs points"),
        ("Shape \"curve\" \"point P\" [ 0 0 0 1 0 0 ]", "error 2 points make no curve of degree 3"),
        (
            "Shape \"curve\" \"string type\" \"ribbon\" \"point P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]",
            "error a ribbon of 1 pieces needs 2 normals `N`, found 0",
        ),
        ("Shape \"sphere\" \"float zmin\" 0.5 \"float zmax\" 0.5", "error nothing of this sphere is between"),
        ("Shape \"cone\" \"float height\" 0", "error `height` must be more than 0"),
        ("Shape \"paraboloid\" \"float zmin\" -1", "error a paraboloid goes from `zmin`"),
        ("Shape \"hyperboloid\" \"point p2\" [ 0 0 1 ]", "error a hyperboloid needs two points"),
        ("Shape \"disk\" \"float phimax\" 0", "error `phimax` must be more than 0 degrees"),
        (
            "Shape \"heightfield\" \"integer nu\" 2 \"integer nv\" 2 \"float Pz\" [ 1 2 3 ]",
            "error `Pz` has 3 values for 2 x 2",
        ),
        ("Shape \"heightfield\" \"integer nu\" 1", "error `nu` and `nv` must be 2 or more"),
        ("Shape \"nurbs\" \"integer nu\" 2 \"integer nv\" 2", "error `uorder` must be from 2"),
        (
            "Shape \"loopsubdiv\" \"integer levels\" 99 \"point P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]",
            "error `levels` must be from 0 to 16",
        ),
    ] {
        let (scene, told) = read(&format!("{HEAD}{text}"));
        assert!(scene.is_none(), "{text}");
        assert!(told.iter().any(|told| told.contains(wanted)), "{text}\n{wanted}\n{told:#?}");
    }
    for (text, wanted) in [
        (
            "Material \"plastic\" \"float uroughness\" 1",
            "warning the material `plastic` has no parameter `uroughness`: it is left out (did you mean `roughness`?)",
        ),
        (
            "LightSource \"point\" \"float scale\" 3",
            "warning `scale` of a light is a colour in pbrt-v3, which passes over",
        ),
        ("LightSource \"point\" \"float power\" 3", "warning this light has no parameter `power`"),
        ("Material \"fourier\" \"string bsdffile\" \"a.bsdf\"", "warning measured materials have no counterpart"),
        ("Material \"disney\" \"float flatness\" 1", "warning `flatness` has no counterpart"),
        ("Material \"uber\" \"rgb opacity\" [ 1 0 0 ]", "warning an `opacity` of a colour has no counterpart"),
        ("Material \"translucent\"", "warning light that facets of `translucent` let through is not refracted"),
        (
            "Shape \"curve\" \"point P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]",
            "warning flat curves turn to where they are seen from",
        ),
        (
            "Material \"substrate\" \"float uroughness\" 0.3",
            "warning what is reflected on a matte base is as rough in both",
        ),
        (
            "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"string preset\" \"Skin7\"",
            "warning the medium `Skin7` is not known",
        ),
    ] {
        let (scene, told) = read(&format!("{HEAD}{text} Shape \"sphere\""));
        assert!(scene.is_some() && told.len() == 1, "{text}\n{told:#?}");
        assert!(told[0].contains(wanted), "{text}\n{wanted}\n{told:#?}");
    }
}
