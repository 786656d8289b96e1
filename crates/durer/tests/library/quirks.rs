//! Tests of the quirks of the course's programs. Each test renders with one quirk and without it.

use durer::diag::{Diagnostics, Files};
use durer::dialect::{Dialect, Quirk};
use durer::integrator::{RenderSettings, Whitted};
use durer::math::{Color, Ray, Vec3};
use durer::world::World;
use durer::{LoadOptions, load_text};
use std::path::Path;

/// Compiles a world in a dialect, with its quirks if `official` is true. Files are read from
/// `folder`.
fn world_in(folder: &Path, text: &str, dialect: Dialect, official: bool) -> World {
    let compat = if official { Vec::new() } else { off(dialect.rules()) };
    world_with(folder, text, dialect, compat, official)
}

/// Compiles a world with some quirks turned on or off by name.
fn world_with(folder: &Path, text: &str, dialect: Dialect, compat: Vec<(Quirk, bool)>, official: bool) -> World {
    let options = LoadOptions { dialect: Some(dialect), compat, ..LoadOptions::default() };
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = folder.join("scene.txt");
    let mut loaded = load_text(&path, text.as_bytes().into(), &options, &mut files, &mut diagnostics)
        .unwrap_or_else(|| panic!("{diagnostics:?}"));
    if !official {
        loaded.rules = dialect.rules().without_quirks();
    }
    let world = loaded.compile(&options, &mut files, &mut diagnostics);
    world.unwrap_or_else(|| panic!("{diagnostics:?}"))
}

/// Returns a list that turns off all quirks of the rules.
fn off(rules: &durer::dialect::DialectRules) -> Vec<(Quirk, bool)> {
    Quirk::ALL.iter().filter(|row| rules.has(row.0)).map(|row| (row.0, false)).collect()
}

fn world(text: &str, dialect: Dialect, official: bool) -> World {
    world_in(Path::new("."), text, dialect, official)
}

fn traced_color(world: &World, origin: [f32; 3], dir: [f32; 3]) -> Color {
    let rules = world.rules();
    let settings = RenderSettings {
        bounces: 4,
        shadows: false,
        shade_back: rules.shade_back,
        transparent_shadows: false,
        reflection: true,
        refraction: true,
        min_weight: 0.0,
    };
    let ray = Ray::new(origin.into(), Vec3::from(dir).normalize());
    Whitted { world, settings, cancel: None }.radiance(&ray, &mut ())
}

fn close(a: Color, b: [f32; 3]) {
    assert!((a - Vec3::from(b)).abs().max_element() < 1e-4, "{a} differs from {b:?}");
}

const CAMERA: &str = "PerspectiveCamera { center 0 5 0 direction 0 -1 0 up 0 0 1 angle 40 }\n";
const DOWN: [f32; 3] = [0.0, -1.0, 0.0];

#[test]
fn transform_of_2023_drops_shear_and_nested_transforms_keep_it() {
    let node = |transform: &str, inner: &str| {
        format!(
            "Camera {{ center 0 0 9 direction 0 0 -1 up 0 1 0 fov 40 }}
             Materials {{ Material {{ diffuse 1 1 1 }} }}
             Scene {{ Node {{ {transform} {inner} }} }}"
        )
    };
    let ball = "Component<Material> { index 0 } Component<Object> { type sphere radius 1 }";
    let emitter = "Node { Transform { translate 0 1 0 } Component<Light> { type point color 1 1 1 } }";
    let sheared = "Transform { scale 2 1 1 z_rotate 45 }";
    let bounds = |text: &str, official| world(text, Dialect::F23, official).bounds().max;
    let root = |x: f32| x.sqrt();
    // The first axis of the product is (2, 1) / √2. The part of the second axis that is
    // perpendicular to the first is (-2, 4) √2 / 5.
    let image = bounds(&node(sheared, ball), true);
    let [a, b] = [[2.0 / root(2.0), 1.0 / root(2.0)], [-0.4 * root(2.0), 0.8 * root(2.0)]];
    let extent = |i: usize| (a[i] * a[i] + b[i] * b[i]).sqrt();
    // The bounds of the transformed box are larger, because they are sums of the absolute values of
    // the axis components.
    close(image, [a[0] + b[0].abs(), a[1] + b[1].abs(), 1.0]);
    assert!(extent(0) < image.x);
    close(bounds(&node(sheared, ball), false), [4.0 / root(2.0), 2.0 / root(2.0), 1.0]);
    // Put the same two matrices in nested nodes.
    let nested = node("Transform { scale 2 1 1 }", &format!("Node {{ Transform {{ z_rotate 45 }} {ball} }}"));
    close(bounds(&nested, true), [4.0 / root(2.0), 2.0 / root(2.0), 1.0]);
    // A reflection is not a shear.
    let mirrored = node("Transform { translate 1 2 3 scale -2 1 3 }", ball);
    assert_eq!(bounds(&mirrored, true), bounds(&mirrored, false));
    // Lights move together with their nodes.
    let place = |official| match &world(&node(sheared, emitter), Dialect::F23, official).lights()[0] {
        durer::light::Light::Point(light) => light.position,
        light => panic!("{light:?}"),
    };
    close(place(true), [b[0], b[1], 0.0]);
    close(place(false), [-2.0 / root(2.0), 1.0 / root(2.0), 0.0]);
}

#[test]
fn plane_normals_are_not_normalised() {
    let scene = |plane: &str| {
        format!(
            "{CAMERA}Background {{ color 0.5 0.25 1 ambientLight 0 0 0 }}
             Lights {{ numLights 1 DirectionalLight {{ direction 0 -1 0 color 0.25 0.25 0.25 }} }}
             Materials {{ numMaterials 1 Material {{ diffuseColor 1 1 1 }} }}
             Group {{ numObjects 1 MaterialIndex 0 {plane} }}"
        )
    };
    let long = scene("Plane { normal 0 2 0 offset -1 }");
    let moved = scene("Transform { Plane { normal 0 2 0 offset -1 } }");
    for (dialect, light) in [(Dialect::F12a4, 2.0), (Dialect::F16, 2.0), (Dialect::F12a5, 1.0), (Dialect::F04, 1.0)] {
        let light = 0.25 * light;
        close(traced_color(&world(&long, dialect, true), [0.0, 5.0, 0.0], DOWN), [light; 3]);
        close(traced_color(&world(&moved, dialect, true), [0.0, 5.0, 0.0], DOWN), [0.25; 3]);
        close(traced_color(&world(&long, dialect, false), [0.0, 5.0, 0.0], DOWN), [0.25; 3]);
    }
    // A mirror reflects in the direction d - 2 (d·n) n, where n is the normal as written in the
    // scene. Here, n is (0, 1, 1) with length √2, and a downward ray is reflected in the direction
    // (0, 1, 2) / √5.
    let mirror = "Background { color 0 0 0 ambientLight 0 0 0 }
         Lights { numLights 1 DirectionalLight { direction 0 1 2 color 1 1 1 } }
         Materials { numMaterials 2 Material { diffuseColor 0 0 0 specularColor 1 1 1 shininess 1000 } Material { } }
         Group { numObjects 2 MaterialIndex 0 Plane { normal 0 1 1 offset 0 }
           MaterialIndex 1 Sphere { center 0 4 8 radius 0.5 } }";
    for (dialect, raw) in [(Dialect::F12a5, true), (Dialect::F16, true), (Dialect::F12a5, false), (Dialect::F16, false)]
    {
        let world = world(&format!("{CAMERA}{mirror}"), dialect, raw);
        let hit = traced_color(&world, [0.0, 5.0, 0.0], DOWN) != Color::ZERO;
        assert_eq!(hit, raw, "{dialect:?}");
    }
}

#[test]
fn only_meshes_of_2012_have_textures() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("red.ppm"), b"P6 1 1 255\n\xff\0\0").unwrap();
    let square = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nvt 0 0\nf 3/1 2/1 1/1\nf 4/1 3/1 1/1\n";
    std::fs::write(folder.path().join("square.obj"), square).unwrap();
    let scene = |object: &str| {
        format!(
            "{CAMERA}Materials {{ numMaterials 1 Material {{ diffuseColor 0 0 1 texture red.ppm }} }}
             Lights {{ numLights 1 DirectionalLight {{ direction 0 -1 0 color 1 1 1 }} }}
             Group {{ numObjects 1 MaterialIndex 0 {object} }}"
        )
    };
    for (object, textured) in [
        ("Sphere { center 0 0 0 radius 1 }", false),
        ("Plane { normal 0 1 0 offset 0 }", false),
        ("Triangle { vertex0 -3 0 -3 vertex1 0 0 6 vertex2 3 0 -3 }", false),
        ("TriangleMesh { obj_file square.obj }", true),
    ] {
        for dialect in [Dialect::F12a4, Dialect::F12a5] {
            let color = |official| {
                let world = world_in(folder.path(), &scene(object), dialect, official);
                traced_color(&world, [0.1, 5.0, 0.2], DOWN).normalize().round()
            };
            assert_eq!(color(true), if textured { Color::X } else { Color::Z }, "{dialect:?} {object}");
            assert_eq!(color(false), Color::X, "{dialect:?} {object}");
        }
    }
}

#[test]
fn scene_of_2023_without_lights_keeps_its_ambient_light() {
    let text = "Camera { center 0 0 9 direction 0 0 -1 up 0 1 0 fov 40 }
        Background { color 0 0 0 ambient_light 0.25 0.5 0 }
        Materials { Material { diffuse 1 0.5 1 } Material { specular 0 0 0 } }
        Scene { Node { Component<Material> { index 0 } Component<Object> { type sphere radius 1 } }
          Node { Transform { translate 3 0 0 } Component<Material> { index 1 } Component<Object> { type sphere radius 1 } } }";
    for official in [true, false] {
        let world = world(text, Dialect::F23, official);
        close(traced_color(&world, [0.0, 0.0, 9.0], [0.0, 0.0, -1.0]), [0.25, 0.25, 0.0]);
        // If no diffuse colour is given, the program of 2023 uses none for ambient light.
        let bare = if official { [0.0; 3] } else { [0.25, 0.5, 0.0] };
        close(traced_color(&world, [3.0, 0.0, 9.0], [0.0, 0.0, -1.0]), bare);
    }
    let classic = format!(
        "{CAMERA}Materials {{ numMaterials 1 Material {{ }} }}
         Group {{ numObjects 1 MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}"
    );
    for dialect in [Dialect::F04, Dialect::F12a4, Dialect::F12a5, Dialect::F16] {
        close(traced_color(&world(&classic, dialect, true), [0.0, 5.0, 0.0], DOWN), [1.0; 3]);
    }
}

#[test]
fn camera_of_2012_inside_glass_starts_in_air() {
    let text = format!(
        "{CAMERA}Background {{ color 0 0 0 ambientLight 0 0 0 }}
         Lights {{ numLights 1 DirectionalLight {{ direction 0 0 -1 color 1 1 1 }} }}
         Materials {{ numMaterials 2
           Material {{ diffuseColor 0 0 0 specularColor 1 1 1 refractionIndex 1.5 }} Material {{ diffuseColor 1 1 1 }} }}
         Group {{ numObjects 2 MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }}
           MaterialIndex 1 Sphere {{ center 3 0 -4 radius 0.05 }} }}"
    );
    // A straight line from (0, 0, 0.5) hits the target. According to Snell's law, the ray is bent
    // away by far more than the size of the target.
    let (origin, to_target) = ([0.0, 0.0, 0.5], [3.0, 0.0, -4.5]);
    let color = |official| traced_color(&world(&text, Dialect::F12a5, official), origin, to_target).x;
    assert!(color(true) > 0.1 && color(false) < 0.01, "{} {}", color(true), color(false));
}

#[test]
fn r0_is_zero_for_rays_that_leave_glass() {
    for index in [0.7f32, 1.5] {
        let text = format!(
            "{CAMERA}Background {{ color 1 1 1 ambientLight 0 0 0 }}
             Lights {{ numLights 1 DirectionalLight {{ direction 0 -1 0 color 0 0 0 }} }}
             Materials {{ numMaterials 1
               Material {{ diffuseColor 0 0 0 specularColor 1 1 1 refractionIndex {index} }} }}
             Group {{ numObjects 1 MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}"
        );
        // The ray goes straight through the centre. The background for reflected rays is black,
        // because a white background would be attenuated by two passages.
        let mut world = world(&text, Dialect::F12a5, true);
        let settings = RenderSettings {
            bounces: 4,
            shadows: false,
            shade_back: false,
            transparent_shadows: false,
            reflection: true,
            refraction: true,
            min_weight: 0.0,
        };
        world.edit().materials.iter_mut().for_each(|material| {
            if let durer::world::Material::Phong(glass) = material {
                glass.reflective = Color::ZERO;
            }
        });
        let ratio = (index - 1.0) / (index + 1.0);
        let r0 = ratio * ratio;
        let through = |world: &World| {
            let ray = Ray::new(Vec3::new(0.0, 5.0, 0.0), Vec3::NEG_Y);
            Whitted { world, settings, cancel: None }.radiance(&ray, &mut ())
        };
        close(through(&world), [(1.0 - r0) * (1.0 - r0); 3]);
        world.edit().shading.exit_r0 = true;
        close(through(&world), [1.0 - r0; 3]);
    }
}

#[test]
fn meshes_are_read_as_by_each_program() {
    let folder = tempfile::tempdir().unwrap();
    let corners = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\n";
    let put = |name: &str, faces: &str| std::fs::write(folder.path().join(name), format!("{corners}{faces}")).unwrap();
    put("square.obj", "f 3 2 1 4\n");
    put("halves.obj", "f 3 2 1\nf 4 3 1");
    put("tilted.obj", "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 1 0\nf 3//5 2//5 1//5\nf 4//5 3//5 1//5\n");
    let classic = |name: &str| {
        format!(
            "{CAMERA}Materials {{ numMaterials 1 Material {{ }} }}
             Lights {{ numLights 1 DirectionalLight {{ direction 0 -1 0 color 1 1 1 }} }}
             Group {{ numObjects 1 MaterialIndex 0 TriangleMesh {{ obj_file {name} }} }}"
        )
    };
    let nodes = |name: &str| {
        format!(
            "Camera {{ center 0 5 0 direction 0 -1 0 up 0 0 1 fov 40 }} Materials {{ Material {{ diffuse 1 1 1 }} }}
             Scene {{ Node {{ Component<Light> {{ type directional direction 0 -1 0 color 1 1 1 }} }}
               Node {{ Component<Material> {{ index 0 }} Component<Object> {{ type mesh obj_file {name} }} }} }}"
        )
    };
    let triangles = |name: &str, dialect: Dialect, official| {
        let text = if dialect == Dialect::F23 { nodes(name) } else { classic(name) };
        world_in(folder.path(), &text, dialect, official).objects()[0].parts()
    };
    use Dialect::{F04, F12a4, F12a5, F16, F23};
    for (dialect, last) in [(F04, 2), (F12a4, 1), (F12a5, 1), (F16, 1), (F23, 2)] {
        assert_eq!(triangles("halves.obj", dialect, true), last, "{dialect:?}");
        assert_eq!(triangles("halves.obj", dialect, false), 2, "{dialect:?}");
        assert_eq!(triangles("square.obj", dialect, true), 1, "{dialect:?}");
        assert_eq!(triangles("square.obj", dialect, false), 2, "{dialect:?}");
    }
    // The normals that are selected by vertex index point along z. The normals that the faces name
    // point up, towards the light.
    let light = |official| {
        let world = world_in(folder.path(), &nodes("tilted.obj"), F23, official);
        traced_color(&world, [0.5, 5.0, -0.3], DOWN).x
    };
    assert_eq!((light(true), light(false)), (0.0, 1.0));
}
