use super::super::environment::{equal_area, equal_area_direction};
use super::super::named;
use super::*;
use durer_diag::Diagnostic;
use durer_render::compile::testing;
use durer_render::integrator::{Integrate, Path as Paths, PathOptions, RenderSettings};
use durer_render::render::Job;
use durer_render::world::World;
use durer_scene::bsdf::fresnel::conductor_colors;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::camera::{CameraBasis, CameraRules, CameraSample, Projection};
use durer_scene::light::Light;
use durer_scene::math::random::Random;
use durer_scene::math::{Vec2, Vec3, fp};
use durer_scene::sampler::SampleId;
use durer_scene::spectrum::Lanes;
use durer_scene::spectrum::SpectrumSource;

/// Returns the camera ray through a point of the picture. Coordinates range from -1 to 1 across the
/// larger side.
fn ray(scene: &Scene, x: f32, y: f32) -> (Vec3, Vec3) {
    let camera = scene.camera.as_ref().unwrap();
    let frame = CameraBasis::of(camera, CameraRules::default());
    let sample = CameraSample { lens: Vec2::splat(0.5), ..CameraSample::at(Vec2::new(x, y)) };
    let ray = camera.ray(&frame, &sample).unwrap();
    let mut found = Vec::new();
    camera.project(&frame, ray.at(7.0), Vec2::splat(0.5), &mut |point| found.push(point));
    assert!(found.iter().any(|point| (*point - Vec2::new(x, y)).length() < 1e-4), "{found:?} for {x} {y}");
    (ray.origin, ray.dir)
}

fn close(a: Vec3, b: Vec3) {
    assert!((a - b).length() < 1e-5, "{a} is not {b}");
}

fn camera(text: &str, size: [u32; 2]) -> Scene {
    let [w, h] = size;
    clean(&format!(
        "Film \"rgb\" \"integer xresolution\" {w} \"integer yresolution\" {h} {text} WorldBegin Shape \"sphere\""
    ))
}

#[test]
fn cameras_match_pbrt_coordinates() {
    // Without a transform, a pbrt camera looks along +z with +x to the right, which is a
    // left-handed system.
    let scene = camera("Camera \"perspective\" \"float fov\" 90", [200, 100]);
    close(ray(&scene, 0.0, 0.0).1, Vec3::Z);
    // The field of view is measured across the shorter side, so half a unit of the larger side is
    // 45 degrees upwards.
    close(ray(&scene, 0.0, 0.5).1, Vec3::new(0.0, 1.0, 1.0).normalize());
    close(ray(&scene, 1.0, 0.0).1, Vec3::new(2.0, 0.0, 1.0).normalize());
    let tall = camera("Camera \"perspective\" \"float fov\" 90", [100, 200]);
    close(ray(&tall, 0.5, 1.0).1, Vec3::new(1.0, 2.0, 1.0).normalize());
    // Mirroring the view makes its coordinate system right-handed.
    let flipped = camera("Scale -1 1 1 LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 90", [100, 100]);
    close(ray(&flipped, 1.0, 0.0).1, Vec3::new(1.0, 0.0, -1.0).normalize());
    let plain = camera("LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 90", [100, 100]);
    close(ray(&plain, 1.0, 0.0).1, Vec3::new(-1.0, 0.0, -1.0).normalize());
    close(ray(&plain, 0.3, 0.0).0, Vec3::new(0.0, 0.0, 5.0));
    // Screen window that covers a quarter of the picture and whose centre is off the axis.
    let part = camera("Camera \"perspective\" \"float fov\" 90 \"float screenwindow\" [ 0 1 0 1 ]", [100, 100]);
    close(ray(&part, -1.0, -1.0).1, Vec3::Z);
    close(ray(&part, 1.0, 0.0).1, Vec3::new(1.0, 0.5, 1.0).normalize());
}

#[test]
fn orthographic_spherical_and_lens_cameras_match_closed_forms() {
    let text = "LookAt 0 0 5 0 0 0 0 1 0 Camera \"orthographic\" \"float screenwindow\" [ -2 2 -1 1 ]";
    let flat = camera(text, [200, 100]);
    let (origin, dir) = ray(&flat, 1.0, 0.25);
    close(origin, Vec3::new(-2.0, 0.5, 5.0));
    close(dir, Vec3::NEG_Z);
    // u = 0 is +x, u = 1/4 is +z, the upper edge is +y, and the centre is -x.
    let around = camera("Camera \"spherical\" \"string mapping\" \"equirectangular\"", [200, 100]);
    close(ray(&around, 0.0, 0.0).1, Vec3::NEG_X);
    close(ray(&around, -0.5, 0.0).1, Vec3::Z);
    close(ray(&around, 0.5, 0.0).1, Vec3::NEG_Z);
    // All rays through one point of the picture meet at the focus distance.
    let text = "Camera \"perspective\" \"float fov\" 90 \"float lensradius\" 0.5 \"float focaldistance\" 4";
    let scene = camera(text, [100, 100]);
    let lens = scene.camera.unwrap();
    let frame = CameraBasis::of(&lens, CameraRules::default());
    for place in [Vec2::new(0.1, 0.9), Vec2::new(0.99, 0.5)] {
        let sample = CameraSample { lens: place, ..CameraSample::at(Vec2::new(0.5, 0.25)) };
        let ray = lens.ray(&frame, &sample).unwrap();
        close(ray.at((4.0 - ray.origin.z) / ray.dir.z), Vec3::new(2.0, 1.0, 4.0));
        assert!(ray.origin.length() > 0.1 && ray.origin.length() < 0.5);
    }
}

/// Returns the irradiance at a point on a surface that faces up, estimated with one sample.
fn irradiance(world: &World, point: Vec3) -> Vec3 {
    let settings = RenderSettings { bounces: 0, ..Job::default().settings };
    let paths = Paths::new(world, settings, PathOptions::default());
    paths.irradiance(point.as_dvec3(), Vec3::Y, SampleId::new(0, (3, 5), 7), &mut ())
}

fn world(name: &str, text: &str) -> World {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let options = LoadOptions::default();
    let loaded = load_text(Path::new(name), text.as_bytes().into(), &options, &mut files, &mut diagnostics);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    world.unwrap_or_else(|| panic!("{:?}", diagnostics.iter().collect::<Vec<&Diagnostic>>()))
}

#[test]
fn area_light_equals_course_format_bit_for_bit() {
    let ours = |lights: &str, group: &str| {
        testing::read(&format!(
            "PerspectiveCamera {{ center 0 0 0 direction 0 0 1 up 0 1 0 angle 90 }} Background {{ color 0 0 0 }}\n\
             Lights {{ {lights} }} Materials {{ PrincipledMaterial {{ baseColor 0.5 0.5 0.5 specularWeight 0 specularRoughness 1\n\
             emissionLuminance 8 emissionColor 1 0.5 0.25 }} }} Group {{ {group} }}"
        ))
    };
    let pbrt = |text: &str| world("a.pbrt", &format!("Camera \"perspective\" WorldBegin {text}"));
    let point = Vec3::new(0.25, 0.0, -0.5);
    let sphere = "AreaLightSource \"diffuse\" \"rgb L\" [ 4 2 1 ] \"float scale\" 2 Translate 1 3 0.5 Shape \"sphere\" \"float radius\" 0.75";
    let twin = ours("", "MaterialIndex 0 Sphere { center 1 3 0.5 radius 0.75 }");
    let (a, b) = (irradiance(&pbrt(sphere), point), irradiance(&twin, point));
    assert!(a == b && a.x > 0.1, "{a} {b}");
    // Twice the shutter time, and four times the ISO value.
    let text = "Film \"rgb\" \"float iso\" 400 Camera \"perspective\" \"float shutterclose\" 2 WorldBegin ";
    let longer = irradiance(&world("a.pbrt", &format!("{text}{sphere}")), point);
    assert!((longer - 8.0 * a).length() < 1e-5 * longer.length(), "{longer} {a}");
}

#[test]
fn lights_have_pbrt_units() {
    let light = |text: &str| {
        let scene = clean(&format!("Camera \"perspective\" WorldBegin LightSource {text} Shape \"sphere\""));
        scene.lights.unwrap()[0].value.clone()
    };
    let pi = std::f32::consts::PI;
    let Light::Point(point) = light("\"point\" \"rgb I\" [ 2 4 6 ] \"float scale\" 0.5 \"point3 from\" [ 1 2 3 ]")
    else {
        panic!()
    };
    // Radiance of a white diffuse surface at distance 1, which is the intensity divided by pi.
    close(point.color, Vec3::new(1.0, 2.0, 3.0) / pi);
    assert_eq!((point.position, point.attenuation), (Vec3::new(1.0, 2.0, 3.0), Some(Vec3::Z)));
    // A flux of 4 pi corresponds to an intensity of 1.
    let Light::Point(point) = light("\"point\" \"float power\" 12.566371") else { panic!() };
    close(point.color, Vec3::splat(1.0 / pi));
    let Light::Directional(distant) =
        light("\"distant\" \"float illuminance\" 10 \"point3 from\" [ 0 5 0 ] \"point3 to\" [ 0 0 0 ]")
    else {
        panic!()
    };
    close(distant.color, Vec3::splat(10.0 / pi));
    close(distant.direction.normalize(), Vec3::NEG_Y);
    let Light::Spot(spot) = light("\"spot\" \"float coneangle\" 40 \"float conedeltaangle\" 15") else { panic!() };
    assert_eq!((spot.angle, spot.inner_angle, spot.direction), (40.0, 25.0, Vec3::Z));
    // The power applies to each triangle. There are two triangles of area 1/2, and each emits 3
    // lumens.
    let (scene, _) = read(
        "Camera \"perspective\" WorldBegin AreaLightSource \"diffuse\" \"float power\" 3 Shape \"trianglemesh\"\n\
         \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]",
    );
    let Material::Principled(layers) = &scene.unwrap().materials[0].value else { panic!() };
    assert!((layers.emission_luminance - 3.0 / (pi * 0.5)).abs() < 1e-5, "{}", layers.emission_luminance);
    let sky = clean("Camera \"perspective\" WorldBegin LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] Shape \"sphere\"");
    assert_eq!((sky.background.color, sky.background.ambient_light), (Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO));
}

#[test]
fn area_lights_emit_on_pbrt_side() {
    let lit = |text: &str, point: Vec3| {
        let head = "Camera \"perspective\" WorldBegin AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]";
        irradiance(&world("a.pbrt", &format!("{head} {text}")), point) != Vec3::ZERO
    };
    let below = Vec3::new(0.2, -1.0, 0.3);
    // The corners are counter-clockwise when seen from below, because (1, 0, 0) x (0, 0, 1) = -y.
    let down = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 0 1 ]";
    assert!(lit(down, below));
    assert!(!lit(&format!("ReverseOrientation {down}"), below));
    assert!(lit(&format!("Scale 1 -1 1 ReverseOrientation {down}"), below));
    assert!(!lit(&format!("Scale 1 -1 1 {down}"), below));
    // Vertex normals determine the front side, regardless of the order of the corners.
    let normals = |y: i32| format!("{down} \"normal N\" [ 0 {y} 0 0 {y} 0 0 {y} 0 ]");
    assert!(lit(&normals(-1), below) && !lit(&normals(1), below));
    assert!(lit(&format!("ReverseOrientation {}", normals(1)), below));
    // A disk emits light along its own z axis. A mirrored disk emits in the opposite direction, as
    // in pbrt.
    let disk = |text: &str| lit(&format!("Rotate 90 1 0 0 {text} Shape \"disk\""), below);
    assert!(disk("") && !disk("ReverseOrientation") && !disk("Scale -1 1 1"));
    let patch = "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 0 1 1 0 1 ]";
    assert!(lit(patch, below) && !lit(&format!("ReverseOrientation {patch}"), below));
    let both = "AreaLightSource \"diffuse\" \"bool twosided\" true ReverseOrientation";
    assert!(lit(&format!("{both} {down}"), below));
}

#[test]
fn materials_become_openpbr_parameters() {
    let (m, _) = material(
        "Material \"coateddiffuse\" \"rgb reflectance\" [ 0.2 0.4 0.6 ] \"float roughness\" 0.16 \"float eta\" 1.4",
    );
    assert_eq!((m.base_color, m.coat_weight, m.coat_ior), (Vec3::new(0.2, 0.4, 0.6), 1.0, 1.4));
    // Alpha is sqrt(0.16), and its square root is Dürer's roughness.
    assert!((m.coat_roughness - 0.4_f32.sqrt()).abs() < 1e-6 && m.coat_darkening == 1.0, "{}", m.coat_roughness);
    let (m, _) = material(
        "Material \"dielectric\" \"float roughness\" 0.04 \"bool remaproughness\" false \"spectrum eta\" \"glass-BK7\"",
    );
    assert_eq!((m.transmission_weight, m.specular_ior), (1.0, 1.5168));
    assert!((m.specular_roughness - 0.2).abs() < 1e-6);
    let (m, _) = material("Material \"conductor\" \"rgb reflectance\" [ 0.9 0.5 0.1 ]");
    assert!((m.base_color - Vec3::new(0.9, 0.5, 0.1)).length() < 1e-5 && m.base_metalness == 1.0, "{}", m.base_color);
    let scene = clean(
        "Camera \"perspective\" WorldBegin MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n\
         MakeNamedMaterial \"b\" \"string type\" \"conductor\"\n\
         Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.25 Shape \"sphere\"",
    );
    assert!(matches!(&scene.materials[2].value, Material::Solid(durer_scene::material::PatternMaterial::Mix(mix), _)
        if (mix.material1, mix.material2, mix.share) == (0, 1, 0.75)));
    // A surface with the `interface` material is not rendered.
    let scene = read("Camera \"perspective\" WorldBegin Material \"interface\" Shape \"sphere\"").0.unwrap();
    assert!(scene.root.is_none());
}

#[test]
fn alphas_round_trip_through_roughness() {
    let mut random = Random(4);
    for _ in 0..200 {
        let [u, v] = [random.between(0.001, 1.0), random.between(0.001, 1.0)];
        let [roughness, anisotropy, turn] = Ggx::parameters([u, v]);
        let rest = 1.0 - anisotropy;
        let along = roughness * roughness * (2.0 / (1.0 + rest * rest)).sqrt();
        let (a, b) = if turn == 0.0 { (along, rest * along) } else { (rest * along, along) };
        assert!((a - u).abs() < 1e-4 && (b - v).abs() < 1e-4, "{u} {v}: {a} {b}");
    }
}

#[test]
fn named_spectra_have_tabulated_colours() {
    let warm = SpectrumSource::Blackbody(2856.0).light();
    assert!((warm - named::spectrum("stdillum-A").unwrap().light()).abs().max_element() < 0.02, "{warm}");
    assert!((named::spectrum("stdillum-D65").unwrap().light() - Vec3::ONE).abs().max_element() < 0.002);
    // Colours of silver, copper and aluminium under D65, computed from tabulated spectra.
    for (name, wanted) in [("Ag", [0.972, 0.96, 0.915]), ("Cu", [0.955, 0.638, 0.538]), ("Al", [0.913, 0.922, 0.924])] {
        let of = |which: &str| named::spectrum(&format!("metal-{name}-{which}")).unwrap();
        let f0 = conductor_colors(&of("eta"), &of("k"), 1.0)[0];
        assert!((f0 - Vec3::from_array(wanted)).abs().max_element() < 0.002, "{name} {f0}");
    }
    assert_eq!(named::names().filter(|name| named::spectrum(name).is_none()).count(), 0);
}

#[test]
fn equal_area_mapping_inverts_and_preserves_area() {
    let mut random = Random(9);
    for _ in 0..2000 {
        let place = Vec2::new(random.between(0.0, 1.0), random.between(0.0, 1.0));
        let dir = equal_area_direction(place);
        assert!((dir.length() - 1.0).abs() < 1e-5);
        assert!((equal_area(dir) - place).length() < 1e-3, "{place} {dir} {}", equal_area(dir));
    }
    // The centre of the picture is +z, and its corners are -z. The mapping preserves areas, so a
    // quarter of all positions have z > 1/2.
    close(equal_area_direction(Vec2::splat(0.5)), Vec3::Z);
    close(equal_area_direction(Vec2::ZERO), Vec3::NEG_Z);
    close(equal_area_direction(Vec2::new(1.0, 0.5)), Vec3::X);
    close(equal_area_direction(Vec2::new(0.5, 1.0)), Vec3::Y);
    let n = 200;
    let up = (0..n * n).filter(|i| {
        let place = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
        equal_area_direction(place).z > 0.5
    });
    assert!((up.count() as f32 / (n * n) as f32 - 0.25).abs() < 2e-3);
}

#[test]
fn environment_picture_has_pbrt_orientation() {
    // Square picture that is bright around +x in the coordinates of the light.
    let n = 32;
    let pixels: Vec<Vec3> = (0..n * n)
        .map(|i| {
            let place = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
            if equal_area_direction(place).x > 0.9 { Vec3::new(3.0, 2.0, 1.0) } else { Vec3::ZERO }
        })
        .collect();
    let image = durer_image::Image::from_pixels(n, n, pixels).unwrap();
    let mut bytes = Vec::new();
    let layers = [durer_image::Layer::data("", image)];
    durer_image::format_for("a.pfm").unwrap().write(&layers, &Default::default(), &mut bytes).unwrap();
    let folder = folder(&[("sky.pfm", &bytes)]);
    let look = |turn: &str, dir: Vec3| {
        let text = format!(
            "Camera \"perspective\" WorldBegin AttributeBegin {turn}\n\
             LightSource \"infinite\" \"string filename\" \"sky.pfm\" \"float scale\" 2 AttributeEnd Shape \"sphere\""
        );
        world(folder.path().join("a.pbrt").to_str().unwrap(), &text).background_radiance(dir)
    };
    close(look("", Vec3::X), Vec3::new(6.0, 4.0, 2.0));
    close(look("", Vec3::NEG_X), Vec3::ZERO);
    close(look("Rotate 90 0 0 1", Vec3::Y), Vec3::new(6.0, 4.0, 2.0));
    close(look("Rotate 90 0 1 0", Vec3::NEG_Z), Vec3::new(6.0, 4.0, 2.0));
    let wide = durer_image::Image::from_pixels(3, 2, vec![Vec3::ONE; 6]).unwrap();
    let mut bytes = Vec::new();
    durer_image::format_for("a.pfm")
        .unwrap()
        .write(&[durer_image::Layer::data("", wide)], &Default::default(), &mut bytes)
        .unwrap();
    std::fs::write(folder.path().join("sky.pfm"), bytes).unwrap();
    let text =
        "Camera \"perspective\" WorldBegin LightSource \"infinite\" \"string filename\" \"sky.pfm\" Shape \"sphere\"";
    let (_, messages) = read_in(folder.path(), text);
    assert!(messages[0].contains("an environment picture must be square, found 3 x 2 pixels"), "{messages:?}");
}

#[test]
fn textures_have_pbrt_orientation() {
    let picture: &[u8] = b"P6 2 2 255\n\xff\x00\x00\x00\xff\x00\x00\x00\xff\xff\xff\xff";
    let folder = folder(&[("t.ppm", picture)]);
    let seen = |texture: &str, uv: Vec2| {
        let text = format!(
            "Camera \"perspective\" WorldBegin Texture \"t\" \"spectrum\" {texture}\n\
             Material \"diffuse\" \"texture reflectance\" \"t\"\n\
             Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [ 0 0 2 1 0 2 1 1 2 0 1 2 ]\n\
             \"point2 uv\" [ 0 0 1 0 1 1 0 1 ]"
        );
        let world = world(folder.path().join("a.pbrt").to_str().unwrap(), &text);
        let ray = durer_scene::math::Ray::new(Vec3::new(uv.x, uv.y, 0.0), Vec3::Z);
        let at = world.intersect(&ray, &mut ()).unwrap();
        world.shading(&at, 1.0, &Lanes::Rgb).eval(Vec3::NEG_Z).0.truncate() * std::f32::consts::PI
    };
    let map = "\"imagemap\" \"string filename\" \"t.ppm\" \"string filter\" \"point\"";
    // The texture coordinate v increases upwards, so the upper left texel is red.
    close(seen(map, Vec2::new(0.2, 0.8)), Vec3::X);
    close(seen(map, Vec2::new(0.8, 0.7)), Vec3::Y);
    close(seen(map, Vec2::new(0.2, 0.3)), Vec3::Z);
    close(seen(&format!("{map} \"float scale\" 0.5"), Vec2::new(0.8, 0.3)), Vec3::splat(0.5));
    close(seen(&format!("{map} \"float uscale\" 2 \"float vdelta\" 0.5"), Vec2::new(0.3, 0.3)), Vec3::Y);
    let check = "\"checkerboard\" \"rgb tex1\" [ 1 0 0 ] \"rgb tex2\" [ 0 0 1 ] \"float uscale\" 4 \"float vscale\" 2";
    // Each square has a width of 1/4 and a height of 1/2 in texture coordinates. `tex1` fills the
    // squares in which both indices are even.
    close(seen(check, Vec2::new(0.1, 0.2)), Vec3::X);
    close(seen(check, Vec2::new(0.3, 0.2)), Vec3::Z);
    close(seen(check, Vec2::new(0.3, 0.8)), Vec3::X);
    close(seen(check, Vec2::new(0.6, 0.8)), Vec3::Z);
}

#[test]
fn pictures_on_spheres_have_pbrt_orientation() {
    // The picture has four columns, one for each quarter of u, which is 0 at +x and increases
    // towards +y. The coordinate v increases from -z to +z.
    let picture: &[u8] =
        b"P6 4 2 255\n\x00\x00\x00\x00\x00\x33\x00\x00\x66\x00\x00\x99\xff\x00\x00\xff\x00\x33\xff\x00\x66\xff\x00\x99";
    let folder = folder(&[("t.ppm", picture)]);
    let text = "Camera \"perspective\" WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.ppm\"\n\
                \"string filter\" \"point\" Material \"diffuse\" \"texture reflectance\" \"t\"\n\
                Translate 1 2 3 Shape \"sphere\" \"float radius\" 2";
    let world = world(folder.path().join("a.pbrt").to_str().unwrap(), text);
    for (x, y, column) in [(1.0, 0.7, 0), (-0.6, 1.0, 1), (-1.0, -0.2, 2), (0.3, -1.0, 3)] {
        for z in [-0.5, 0.5] {
            let dir = Vec3::new(x, y, z).normalize();
            let ray = durer_scene::math::Ray::new(Vec3::new(1.0, 2.0, 3.0) + 5.0 * dir, -dir);
            let at = world.intersect(&ray, &mut ()).unwrap();
            let color = world.shading(&at, 1.0, &Lanes::Rgb).eval(dir).0.truncate() * std::f32::consts::PI;
            let blue = durer_image::decode_srgb(0x33 * column);
            close(color, Vec3::new(if z < 0.0 { 1.0 } else { 0.0 }, 0.0, blue));
        }
    }
}

#[test]
fn roughness_and_heights_come_from_pictures() {
    let folder = folder(&[("t.ppm", b"P6 1 1 255\n\x80\x80\x80")]);
    let text = "Camera \"perspective\" WorldBegin Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"t.ppm\" \"float scale\" 0.5\n\
                Material \"conductor\" \"texture roughness\" \"t\" \"texture displacement\" \"t\"\n\
                Translate 0 0 5 Shape \"sphere\"";
    let world = world(folder.path().join("a.pbrt").to_str().unwrap(), text);
    let ray = durer_scene::math::Ray::new(Vec3::ZERO, Vec3::Z);
    let at = world.intersect(&ray, &mut ()).unwrap();
    let durer_render::world::Material::Phong(phong) = &world.materials()[at.material as usize] else { panic!() };
    let own = phong.principled.as_ref().unwrap();
    // The alpha of pbrt is the square root of the value, and Dürer's roughness is the square root
    // of alpha.
    let expected = (0.5 * durer_image::decode_srgb(128)).sqrt().sqrt();
    let found = world.parameters_at(own, &at).specular_roughness;
    assert!((found - expected).abs() < 2.0 / 255.0, "{found} {expected}");
    assert_eq!((own.maps.bump.is_some(), own.maps.bump_height), (true, 0.5));
}

#[test]
fn touching_meshes_become_one_glass_body() {
    // Cube around the origin, whose lid is a separate, mirrored mesh.
    let side = |turn: &str| {
        format!(
            "AttributeBegin {turn} Translate 0 0 1 Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ]\n\
             \"point3 P\" [ -1 -1 0 1 -1 0 1 1 0 -1 1 0 ] AttributeEnd\n"
        )
    };
    let turns = ["", "Rotate 90 0 1 0", "Rotate 180 0 1 0", "Rotate 270 0 1 0", "Rotate 90 1 0 0"];
    let lid = side("Scale -1 1 1 Rotate -90 1 0 0");
    let sides: String = turns.iter().map(|turn| side(turn)).collect();
    let text = format!("Camera \"perspective\" WorldBegin Material \"dielectric\" {sides}{lid}");
    let scene = clean(&text);
    assert_eq!((scene.root.unwrap().objects.len(), scene.assets.meshes.len()), (1, 1));
    let world = world("a.pbrt", &text);
    let mut random = Random(2);
    for _ in 0..200 {
        let dir = random.direction();
        let ray = durer_scene::math::Ray::new(5.0 * dir, -dir);
        let surface = world.intersect(&ray, &mut ()).unwrap().surface;
        assert!(surface.n_geo.dot(dir) > 0.0, "{dir} {}", surface.n_geo);
    }
}

#[test]
fn density_grids_follow_transform_and_end_in_zero() {
    // Grid with two cells along y in a box from (0, 0, 0) to (2, 4, 2). The y axis of the grid is z
    // in world space.
    let text = |third: bool| {
        let kind = if third { "heterogeneous" } else { "uniformgrid" };
        format!(
            "Camera \"perspective\" WorldBegin AttributeBegin Rotate 90 1 0 0 Scale 2 4 2\n\
             MakeNamedMedium \"smoke\" \"string type\" \"{kind}\" \"integer ny\" 2 \"float density\" [ 1 3 ] \
             \"rgb sigma_a\" [ 0 0 0 ] \"rgb sigma_s\" [ 0.5 0.25 1 ] AttributeEnd\n\
             MediumInterface \"smoke\" \"\" Material \"{}\" Shape \"sphere\" \"float radius\" 9",
            if third { "none" } else { "interface" }
        )
    };
    for third in [false, true] {
        let world = world("smoke.pbrt", &text(third));
        let medium = world.medium(Some(0)).unwrap();
        let at = |x, y, z| medium.scattering(glam::DVec3::new(x, y, z), &durer_scene::spectrum::Lanes::Rgb).truncate();
        let sigma = Vec3::new(0.5, 0.25, 1.0);
        // Densities at cell centres, halfway between them, at the border, and outside the grid.
        for (y, density) in [(1.0, 1.0), (3.0, 3.0), (2.0, 2.0), (4.0, 1.5), (0.0, 0.5), (5.0, 0.0), (7.0, 0.0)] {
            close(at(1.0, -1.0, y), density * sigma);
        }
        close(at(2.0, -1.0, 3.0), 1.5 * sigma);
    }
    for (grid, expected) in [
        ("", "error this medium needs a `density`"),
        (
            "\"float density\" [ 1 2 ]",
            "error `density` needs 1 x 1 x 1 numbers, as given by `nx`, `ny` and `nz`, but has 2",
        ),
        ("\"float density\" [ -1 ]", "error density number 1 is -1, but must be 0 or more"),
        ("\"integer nx\" -1 \"float density\" [ 1 ]", "error `density` needs -1 x 1 x 1 numbers"),
    ] {
        let (_, messages) = read(&format!(
            "Camera \"perspective\" WorldBegin MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" {grid} Shape \"sphere\""
        ));
        assert!(messages.iter().any(|message| message.contains(expected)), "{messages:?}");
    }
}

#[test]
fn media_fill_shapes_and_surround_the_camera() {
    let smoke = "MakeNamedMedium \"smoke\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.5 0.25 1 ] \
                 \"rgb sigma_s\" [ 0 0 0 ] \"float scale\" 0.5";
    // A fraction exp(-2 sigma) of the light passes through the centre of a ball of radius 1 that
    // has no boundary.
    let text = format!(
        "Camera \"perspective\" WorldBegin {smoke} LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n\
         AttributeBegin MediumInterface \"smoke\" \"\" Material \"interface\" Translate 0 0 5 Shape \"sphere\" AttributeEnd\n\
         Translate 9 0 5 Material \"interface\" Shape \"sphere\""
    );
    let inside = world("smoke.pbrt", &text);
    assert_eq!(inside.objects().len(), 1);
    let settings = RenderSettings { bounces: 4, ..Job::default().settings };
    let through = |world: &World| {
        let paths = Paths::new(world, settings, PathOptions::default());
        let ray = durer_scene::math::Ray::new(Vec3::ZERO, Vec3::Z);
        paths.radiance(&ray, SampleId::new(0, (3, 5), 7), &mut ())
    };
    close(through(&inside), Vec3::new(-0.5, -0.25, -1.0).map(fp::exp));
    // A medium around the camera becomes fog that uses the largest of the medium's coefficients.
    let text = format!("{smoke} MediumInterface \"\" \"smoke\" Camera \"perspective\" WorldBegin Shape \"sphere\"");
    let fog = world("fog.pbrt", &text).fog().cloned().unwrap();
    close(fog.extinction, Vec3::splat(0.5));
    assert!(fog.region.is_none() && !fog.scatters());
    // Default coefficients of `subsurface`, and a sheet that scatters light to both sides.
    let text = "Camera \"perspective\" WorldBegin Material \"subsurface\" Shape \"sphere\"\n\
                Material \"diffusetransmission\" \"rgb reflectance\" [ 0.3 0.3 0.3 ] \"rgb transmittance\" [ 0.1 0.1 0.1 ] \
                Shape \"sphere\"";
    let world = world("skin.pbrt", text);
    let medium = |object: u32| world.medium(Some(object)).map(|medium| (medium.extinction, medium.albedo));
    let (extinction, albedo) = medium(0).unwrap();
    close(extinction, Vec3::new(2.5511, 3.2124, 3.784));
    close(albedo * extinction, Vec3::new(2.55, 3.21, 3.77));
    assert!(medium(1).is_none());
    let sheet = world.materials().iter().find_map(|material| match material {
        durer_render::world::Material::Phong(phong) => {
            phong.principled.as_ref().filter(|own| own.definition.subsurface_weight > 0.0)
        }
        durer_render::world::Material::Mix(..) => None,
    });
    let sheet = &sheet.unwrap().definition;
    close(sheet.subsurface_color, Vec3::splat(0.3));
    close(sheet.subsurface_through.unwrap(), Vec3::splat(0.1));
}

/// Values that fresh scenes beside Mitsuba 3.9.1 and closed forms showed.
#[test]
fn materials_and_lights_have_the_values_of_pbrt() {
    let pi = std::f32::consts::PI;
    let power = "AreaLightSource \"diffuse\" \"float power\" 3";
    let luminance = |shape: &str| {
        let (scene, _) = read(&format!("Camera \"perspective\" WorldBegin {power} {shape}"));
        let Material::Principled(layers) = &scene.unwrap().materials[0].value else { panic!("{shape}") };
        layers.emission_luminance
    };
    // A patch and a cylinder are one light each, with the areas 4 and 2 pi.
    let patch = "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ]";
    assert!((luminance(patch) * 4.0 * pi / 3.0 - 1.0).abs() < 1e-5, "{}", luminance(patch));
    let cylinder = "Shape \"cylinder\" \"float zmin\" 0 \"float zmax\" 1";
    assert!((luminance(cylinder) * 2.0 * pi * pi / 3.0 - 1.0).abs() < 1e-3, "{}", luminance(cylinder));
    // With eta = 1, the reflectance at normal incidence is k^2 / (4 + k^2).
    let (metal, _) = material("Material \"conductor\" \"rgb reflectance\" [ 0.3 0.6 0.9 ]");
    let k = metal.metal_extinction;
    close(metal.metal_ior.unwrap(), Vec3::ONE);
    close(k * k / (4.0 + k * k), Vec3::new(0.3, 0.6, 0.9));
    let leaf = "\"rgb reflectance\" [ 0.5 0.1 0.1 ] \"rgb transmittance\" [ 0.1 0.1 0.5 ]";
    let (leaf, _) = material(&format!("Material \"diffusetransmission\" {leaf}"));
    let colors = (leaf.subsurface_color, leaf.subsurface_through);
    assert_eq!(colors, (Vec3::new(0.5, 0.1, 0.1), Some(Vec3::new(0.1, 0.1, 0.5))));
    assert_eq!(leaf.smooth_shadows, durer_scene::material::principled::Switch::Off);
    // Derived textures are not rounded to 8 bits.
    let scene = clean(
        "Camera \"perspective\" WorldBegin Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [ 0.5 0.5 0.5 ] \
         \"rgb v01\" [ 0.1234 0 0 ] \"rgb v10\" [ 0.5 0.5 0.5 ] \"rgb v11\" [ 0.5 0.5 0.5 ]\n\
         Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"",
    );
    let durer_scene::scene::PictureBytes::Memory(path, bytes) = &scene.assets.pictures.values().next().unwrap().bytes
    else {
        panic!()
    };
    let image = durer_image::read(bytes, path).unwrap();
    for value in [0.5, 0.1234] {
        assert!(image.pixels.iter().any(|pixel| pixel.x == value), "{value}: {:?}", image.pixels);
    }
}

/// The poles of pbrt's spheres are on the z axis, which matters where the directions of u and v do.
#[test]
fn spheres_are_turned_where_tangents_matter() {
    let node = |roughness: &str| {
        let scene =
            clean(&format!("Camera \"perspective\" WorldBegin Material \"conductor\" {roughness} Shape \"sphere\""));
        format!("{:?}", scene.root.as_ref().unwrap().objects[0].node).contains("Transform")
    };
    assert!(node("\"float uroughness\" 0.1 \"float vroughness\" 0.3"));
    assert!(!node("\"float roughness\" 0.3"));
}
