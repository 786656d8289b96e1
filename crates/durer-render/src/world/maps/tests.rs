//! Tests that each texture changes its parameter, and that bump and normal maps match closed-form
//! solutions.

use crate::compile::{AccelKind, testing};
use crate::world::{Material, Principled, SurfaceInteraction, World};
use durer_image as image;
use durer_scene::describe::{Describe, Value};
use durer_scene::dialect::Dialect;
use durer_scene::material::{Parameters, PrincipledMaterial};
use durer_scene::math::{Ray, Vec3};
use durer_scene::spectrum::Lanes;
use std::path::Path;

const FOLDER: &str = "maps";

/// Name, side length and texels of a picture, where texels are given by column and row.
type FaceCase<'a> = (&'a str, u32, &'a dyn Fn(u32, u32) -> [u8; 3]);

/// Writes pictures to a folder in PPM format.
fn folder(name: &str, pictures: &[FaceCase]) -> tempfile::TempDir {
    let folder = tempfile::Builder::new().prefix(&format!("{FOLDER}-{name}")).tempdir().unwrap();
    for (name, side, texel) in pictures {
        let mut bytes = format!("P6 {side} {side} 255\n").into_bytes();
        let texels = (0..*side).flat_map(|y| (0..*side).map(move |x| (x, y)));
        bytes.extend(texels.flat_map(|(x, y)| texel(x, y)));
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// Compiles a scene that contains one object with one material.
fn world(material: &str, object: &str, folder: &Path) -> World {
    compiled(&[material.to_string()], object, folder)
}

fn compiled(materials: &[String], objects: &str, folder: &Path) -> World {
    let materials: String = materials.iter().map(|words| format!("PrincipledMaterial {{ {words} }}\n")).collect();
    let text = format!(
        "PerspectiveCamera {{ center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }} Background {{ color 1 1 1 }}\n\
         Materials {{ {materials} }}\nGroup {{ MaterialIndex 0 {objects} }}\n"
    );
    let (world, diagnostics) = testing::try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, folder);
    assert_eq!(diagnostics.iter().count(), 0, "{diagnostics:?}");
    world.unwrap()
}

fn material(world: &World, number: usize) -> &Principled {
    let Material::Phong(phong) = &world.materials()[number] else { panic!() };
    phong.principled.as_ref().unwrap()
}

fn hit(world: &World, origin: Vec3, dir: Vec3) -> SurfaceInteraction {
    world.intersect(Ray::new(origin, dir), &mut ()).expect("a hit")
}

/// Returns the material's parameters at the point where a ray along -z hits the object.
fn parameters(world: &World) -> Parameters {
    *world.parameters_at(material(world, 0), &hit(world, Vec3::new(0.2, 0.1, 5.0), Vec3::NEG_Z))
}

const BALL: &str = "Sphere { center 0 0 0 radius 1 }";

#[test]
fn every_texture_changes_its_parameter() {
    let grey = |_, _| [100, 150, 200];
    let folder = folder("grey", &[("grey.ppm", 2, &grey)]);
    // Use one sphere per parameter, so that tables are built only once.
    let (mut seen, mut materials, mut expectations) = (0, Vec::new(), Vec::new());
    for (number, field) in PrincipledMaterial::FIELDS.iter().enumerate() {
        let Some(stem) = field.name.strip_suffix("_texture") else { continue };
        if ["normal", "bump", "emission", "opacity", "metallic_roughness"].contains(&stem) {
            continue;
        }
        seen += 1;
        // Enable all layers, so that every change has an effect.
        let mut written =
            PrincipledMaterial { walls: durer_scene::material::principled::Walls::Thin, ..Default::default() };
        for (i, other) in PrincipledMaterial::FIELDS.iter().enumerate() {
            match written.get(i) {
                Some(Value::Float(_)) if !other.name.contains("ior") && other.name != "emission_luminance" => {
                    written.set(i, Value::Float(0.6));
                }
                Some(Value::Vec3(_)) if other.name != "emission_color" => {
                    written.set(i, Value::Vec3(Vec3::new(0.9, 0.7, 0.5)));
                }
                _ => {}
            }
        }
        let words: Vec<String> = PrincipledMaterial::FIELDS
            .iter()
            .enumerate()
            .filter_map(|(i, field)| {
                let word = field.keyword(Dialect::Durer)?;
                match written.get(i)? {
                    Value::Float(x) => Some(format!("{word} {x:?}")),
                    Value::Vec3(v) => Some(format!("{word} {:?} {:?} {:?}", v.x, v.y, v.z)),
                    Value::Word(text) => Some(format!("{word} {text}")),
                    _ => None,
                }
            })
            .collect();
        let word = PrincipledMaterial::FIELDS[number].keyword(Dialect::Durer).unwrap();
        let color = matches!(written.get(number_of(stem)), Some(Value::Vec3(_)));
        for (suffix, channel) in [("", 0), (":g", 1), (":b", 2)] {
            if color && !suffix.is_empty() {
                continue;
            }
            materials.push(format!("{} {word} grey.ppm{suffix}", words.join(" ")));
            let mut expected = written.clone();
            let linear = f32::from([100u8, 150, 200][channel]) / 255.0;
            let tint = Vec3::from([100, 150, 200].map(image::decode_srgb));
            let changed = match written.get(number_of(stem)).unwrap() {
                Value::Float(x) if stem == "specular_rotation" => Value::Float(x + linear),
                Value::Float(x) => Value::Float(x * linear),
                Value::Vec3(v) => Value::Vec3(v * tint),
                other => panic!("{other:?}"),
            };
            expected.set(number_of(stem), changed);
            let mut expected = Parameters::of(&expected);
            match stem {
                "specular_weight" => (expected.specular_weight, expected.reflection) = (0.6, linear),
                "subsurface_color" => expected.entry_tint = tint,
                _ => {}
            }
            expectations.push((format!("{word}{suffix}"), expected));
        }
    }
    assert_eq!(seen, durer_scene::material::parameters::TEXTURE_FIELDS.len());
    let ball = |i: usize| format!("MaterialIndex {i} Sphere {{ center {} 0 0 radius 1 }}\n", 3 * i);
    let world = compiled(&materials, &(0..materials.len()).map(ball).collect::<String>(), folder.path());
    for (i, (word, expected)) in expectations.iter().enumerate() {
        let at = hit(&world, Vec3::new(3.0 * i as f32 + 0.2, 0.1, 5.0), Vec3::NEG_Z);
        let found = world.parameters_at(material(&world, i), &at);
        // The order of factors can change the last bit.
        assert_eq!(format!("{found:.5?}"), format!("{expected:.5?}"), "{word}");
    }
}

fn number_of(name: &str) -> usize {
    PrincipledMaterial::FIELDS.iter().position(|field| field.name == name).unwrap_or_else(|| panic!("{name}"))
}

#[test]
fn direction_in_red_and_green_gives_an_angle() {
    let up = |_, _| [128, 255, 0];
    let folder = folder("angle", &[("up.ppm", 1, &up)]);
    let text = "specularAnisotropy 0.5 specularRotation 0.1 specularRotationTexture up.ppm:angle";
    let turn = parameters(&world(text, BALL, folder.path())).specular_rotation;
    assert!((turn - 0.35).abs() < 1e-3, "{turn}");
}

#[test]
fn opacity_comes_from_a_picture() {
    let half = |_, _| [51, 102, 0];
    let folder = folder("opacity", &[("half.ppm", 1, &half)]);
    for (name, expected) in [("half.ppm", 0.5 * 0.2), ("half.ppm:g", 0.5 * 0.4)] {
        let world = world(&format!("opacity 0.5 opacityTexture {name}"), BALL, folder.path());
        let share = world.opacity(&hit(&world, Vec3::new(0.2, 0.1, 5.0), Vec3::NEG_Z));
        assert!((share - expected).abs() < 1e-6, "{name}: {share}");
    }
}

/// Returns the bumped and the original shading normal at the point where a ray hits the object.
fn normal(world: &World, origin: Vec3, dir: Vec3) -> [Vec3; 2] {
    let at = hit(world, origin, dir);
    [world.mapped_normal(&material(world, 0).maps, &at).expect("a bent normal"), at.surface.n_shade]
}

#[test]
fn bump_ramp_tilts_the_normals_of_a_wall() {
    // One picture goes from black on the left to white on the right, and the other from black at
    // the bottom to white at the top.
    let (right, up) = (|x, _| [x as u8; 3], |_, y| [255 - y as u8; 3]);
    let folder = folder("ramp", &[("right.ppm", 256, &right), ("up.ppm", 256, &up)]);
    // The picture is mapped to a wall of size 2 x 4, which is scaled and moved.
    let mesh = "v 0 0 0\nv 2 0 0\nv 2 4 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    std::fs::write(folder.path().join("wall.obj"), mesh).unwrap();
    let object = "Transform { Translate 1 0 0 UniformScale 2 TriangleMesh { obj_file wall.obj } }";
    for (name, slope) in [("right.ppm", Vec3::new(0.25, 0.0, 0.0)), ("up.ppm", Vec3::new(0.0, 0.125, 0.0))] {
        let text = format!("bumpTexture {name} bumpHeight 1");
        let world = world(&text, object, folder.path());
        let [bent, _] = normal(&world, Vec3::new(3.0, 4.0, 9.0), Vec3::NEG_Z);
        // Brightness rises by 1/255 per texel, which amounts to 256/255 over the full picture.
        let expected = (Vec3::Z - slope * (256.0 / 255.0)).normalize();
        assert!((bent - expected).length() < 1e-3, "{name}: {bent} {expected}");
    }
}

#[test]
fn bump_ramp_tilts_the_normals_of_a_sphere() {
    // Brightness increases by 1 over a full turn around the sphere towards the east. The slope
    // along a circle of latitude is therefore h / (2 pi r cos latitude).
    let folder = folder("ball", &[("east.ppm", 256, &|x, _| [x as u8; 3])]);
    let world = world(
        "bumpTexture east.ppm bumpHeight 0.5",
        "Transform { Translate 1 2 3 UniformScale 2 Sphere { center 0 0 0 radius 1 } }",
        folder.path(),
    );
    for (latitude, longitude) in [(0.0, 0.3), (0.7, 1.0), (-0.5, 2.0), (0.2, -1.2), (1.2, -2.0)] {
        let (latitude, longitude): (f32, f32) = (latitude, longitude);
        // Longitude is measured from -z towards +x.
        let out = Vec3::new(
            libm::sinf(longitude) * libm::cosf(latitude),
            libm::sinf(latitude),
            -libm::cosf(longitude) * libm::cosf(latitude),
        );
        let east = Vec3::new(libm::cosf(longitude), 0.0, libm::sinf(longitude));
        let [bent, plain] = normal(&world, Vec3::new(1.0, 2.0, 3.0) + 5.0 * out, -out);
        let rise = 0.5 * (256.0 / 255.0) / (2.0 * std::f32::consts::PI * 2.0 * libm::cosf(latitude));
        let expected = (plain - rise * east).normalize();
        assert!((bent - expected).length() < 2e-3, "{latitude} {longitude}: {bent} {expected}");
    }
}

#[test]
fn flat_maps_keep_the_normals_of_every_shape() {
    let folder = folder("flat", &[("flat.ppm", 4, &|_, _| [128, 128, 255]), ("grey.ppm", 4, &|_, _| [77; 3])]);
    for shape in [
        "Sphere { center 0 0 0 radius 1 }",
        "Plane { normal 0 0.3 1 offset 0 }",
        "Cylinder { base 0 -1 0 top 0 1 0 radius 0.7 }",
        "Disc { center 0 0 0 normal 0 0.2 1 radius 1 }",
        "Triangle { vertex0 -1 -1 0 vertex1 1 -1 0 vertex2 0 1 0 }",
        "Transform { XRotate 30 Scale 1 2 0.5 Sphere { center 0 0 0 radius 1 } }",
    ] {
        for text in ["normalTexture flat.ppm", "bumpTexture grey.ppm bumpHeight 3"] {
            let world = world(text, shape, folder.path());
            let [bent, plain] = normal(&world, Vec3::new(0.21, -0.13, 9.0), Vec3::NEG_Z);
            assert!((bent - plain).length() < 0.01, "{shape}, {text}: {bent} {plain}");
        }
    }
}

#[test]
fn mapped_normals_that_face_away_are_black_or_turned() {
    // The map tilts normals by 53 degrees towards increasing u, which is +x, and v, which is +y.
    let folder = folder("tilt", &[("u.ppm", 4, &|_, _| [230, 128, 204]), ("v.ppm", 4, &|_, _| [128, 230, 204])]);
    let mesh = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    std::fs::write(folder.path().join("wall.obj"), mesh).unwrap();
    // Wall on which the picture is upside down.
    std::fs::write(
        folder.path().join("down.obj"),
        mesh.replace("vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1", "vt 0 1\nvt 1 1\nvt 1 0\nvt 0 0"),
    )
    .unwrap();
    let seen = |words: &str, wall: &str, wo: Vec3| {
        let world = world(words, &format!("TriangleMesh {{ obj_file {wall}.obj }}"), folder.path());
        let at = hit(&world, 5.0 * wo + Vec3::new(0.3, 0.2, 0.0), -wo);
        let shading = world.shading(&at, 1.5, &Lanes::Rgb);
        let share = shading.lit_share(Vec3::new(-0.6, 0.0, 0.8));
        (shading.frame.normal, shading.bsdf.is_black(), share)
    };
    let from_left = Vec3::new(-0.96, 0.0, 0.28);
    let (tilted, turned) = (Vec3::new(0.8, 0.0, 0.6), Vec3::new(-0.8, 0.0, 0.6));
    let check = |(normal, black, share): (Vec3, bool, f32), wanted: Vec3, is_black: bool, lit: f32| {
        assert!((normal - wanted).length() < 0.01 && black == is_black, "{normal} {black}");
        assert!((share - lit).abs() < 2e-3, "{share} and not {lit}");
    };
    check(seen("normalTexture u.ppm normalBending off", "wall", Vec3::Z), tilted, false, 1.0);
    assert!(seen("normalTexture u.ppm normalBending off", "wall", from_left).1);
    check(seen("normalTexture u.ppm normalBending turned", "wall", Vec3::Z), tilted, false, 1.0);
    check(seen("normalTexture u.ppm normalBending turned", "wall", from_left), turned, false, 1.0);
    // The facets have an alpha squared of tan^2(53 degrees) / 8 = 2/9, and the squared tangent of
    // the light's angle is 9/16.
    let lit = 2.0 / (1.0 + (1.0_f32 + 0.125).sqrt());
    check(seen("normalTexture u.ppm normalBending off normalShadowing on", "wall", Vec3::Z), tilted, false, lit);
    // Green follows v, or the cross product of the normal and the direction of u.
    let up = Vec3::new(0.0, 0.8, 0.6);
    for (green, wall, wanted) in [("v", "wall", up), ("v", "down", -up), ("cross", "wall", up), ("cross", "down", up)] {
        let (normal, ..) = seen(&format!("normalTexture v.ppm normalBending off normalGreen {green}"), wall, Vec3::Z);
        assert!((normal - Vec3::new(0.0, wanted.y, 0.6)).length() < 0.01, "{green} {wall}: {normal}");
    }
}

/// `texelRange` applies to the opacity and to the emission, like to all other parameters.
#[test]
fn ranges_of_texels_apply_to_opacity_and_emission() {
    let quarter = |_, _| [64, 64, 64];
    let folder = folder("ranges", &[("quarter.ppm", 2, &quarter)]);
    for (range, factor, shift) in [("0 1", 1.0, 0.0), ("0 2", 2.0, 0.0), ("0.25 0.75", 0.5, 0.25), ("1 3", 2.0, 1.0)] {
        let text = format!(
            "PerspectiveCamera {{ center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }} Background {{ color 1 1 1 }}
             Textures {{ Texture {{ name ranged picture quarter.ppm channel r texelRange {{ {range} }} }} }}
             Materials {{ PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 1
               opacityTexture ranged emissionTexture ranged }} }}
             Group {{ MaterialIndex 0 {BALL} }}"
        );
        let (world, diagnostics) = testing::try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, folder.path());
        assert_eq!(diagnostics.iter().count(), 0, "{diagnostics:?}");
        let world = world.unwrap();
        let at = hit(&world, Vec3::new(0.2, 0.1, 5.0), Vec3::NEG_Z);
        // Numbers are the bytes of the picture, and colours are converted from sRGB.
        let number: f32 = factor * 64.0 / 255.0 + shift;
        assert!((world.opacity(&at) - number.min(1.0)).abs() < 1e-5, "{range}: {}", world.opacity(&at));
        let color = factor * 0.051_269 + shift;
        let emission = world.emission_at(material(&world, 0), &at);
        assert!((emission - Vec3::splat(color)).abs().max_element() < 1e-4, "{range}: {emission}");
    }
}
