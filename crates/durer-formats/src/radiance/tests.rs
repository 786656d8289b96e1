//! Tests of the Radiance reader: its parser, its conventions compared with analytic results, and
//! errors with their positions.

mod conventions;
mod gensky;
mod lights;
mod measured;

use crate::testing::{folder, read_in};
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Walls;
use durer_scene::math::Vec3;
use durer_scene::scene::{Material, ObjectKind, Scene};
use std::path::Path;

fn read(text: &str) -> (Option<Scene>, Vec<String>) {
    read_in(&std::env::temp_dir(), "scene.rad", text)
}

/// Reads a text, which must not cause any diagnostics.
fn clean(text: &str) -> Scene {
    let (scene, messages) = read(text);
    assert_eq!(messages, [""; 0], "{text}");
    scene.unwrap()
}

/// Returns the layers of the material with the given index.
fn layers(scene: &Scene, number: u32) -> &PrincipledMaterial {
    let Material::Principled(layers) = &scene.materials[number as usize].value else { panic!("no layers") };
    layers
}

/// Returns the vertices of all meshes in a scene.
fn corners(scene: &Scene) -> Vec<Vec3> {
    scene.assets.meshes.values().flat_map(|mesh| mesh.positions.iter().copied()).collect()
}

const MATTE: &str = "void plastic white 0 0 5 .7 .6 .5 0 0\n";

fn sphere(material: &str) -> (PrincipledMaterial, Vec<String>) {
    let (scene, messages) = read(&format!("{material} m sphere s 0 0 4 1 2 3 .5"));
    let scene = scene.unwrap_or_else(|| panic!("{material}: {messages:?}")); // prose: keep
    let number = scene.root.as_ref().unwrap().objects[0].material.unwrap();
    (layers(&scene, number).clone(), messages)
}

#[test]
fn names_comments_quotes_and_aliases() {
    let scene = clean(
        "# a comment\nvoid plastic \"the wall\" 0 0 5 .1 .2 .3 0 0\n  # another\nvoid alias 'other wall' \"the wall\"\n\
         \"other wall\" sphere ball\n0\n0\n4 1 2 3 .5",
    );
    let object = &scene.root.as_ref().unwrap().objects[0];
    let ObjectKind::Primitive(durer_scene::shape::Primitive::Sphere(sphere)) = &object.node else {
        panic!("{object:?}")
    };
    assert_eq!((sphere.center, sphere.radius), (Vec3::new(1.0, 2.0, 3.0), 0.5));
    assert_eq!(layers(&scene, object.material.unwrap()).base_color, Vec3::new(0.1, 0.2, 0.3));
    // If a name is defined twice, the second definition applies to everything after it. An alias
    // with the modifier `inherit` keeps the pattern.
    let text = "void brightfunc half 1 .5 0 0 half plastic m 0 0 5 .8 .8 .8 0 0\n";
    for (modifier, expected) in [("inherit", 0.4), ("void", 0.8), ("half", 0.4)] {
        let scene = clean(&format!("{text}{modifier} alias n m n sphere s 0 0 4 0 0 0 1"));
        let number = scene.root.as_ref().unwrap().objects[0].material.unwrap();
        assert_eq!(layers(&scene, number).base_color, Vec3::splat(expected));
    }
}

#[test]
fn commands_are_emulated() {
    let scene = clean(&format!("{MATTE}!genbox white box 1 2 3 | xform -t 10 0 0 -a 3 -t 0 10 0"));
    let all = corners(&scene);
    assert_eq!(all.len(), 3 * 24);
    assert_eq!(all.iter().copied().reduce(Vec3::min), Some(Vec3::new(10.0, 0.0, 0.0)));
    assert_eq!(all.iter().copied().reduce(Vec3::max), Some(Vec3::new(11.0, 22.0, 3.0)));
    // All faces point outwards, including those of mirror images and of a prism with a hole.
    let prism = "!genprism white p 10 0 0 0 4 4 4 4 0 0 0 1 1 3 1 3 3 1 3 1 1 -l 0 0 2 -c";
    for (command, volume) in [
        ("!genbox white box 1 2 3 | xform -rx 20 -t 5 6 7", 6.0),
        ("!genbox white box 1 2 3 | xform -mx -s 2", 48.0),
        ("!genbox white box 1 2 3 -i", -6.0),
        ("!genbox white box 1 2 3 | xform -I", -6.0),
        ("!genprism white p 3 0 0 1 0 0 1", 0.5),
        ("!genprism white p 3 0 0 0 1 1 0 -l 0 0 -2", 1.0),
        (prism, 24.0),
    ] {
        let scene = clean(&format!("{MATTE}{command}"));
        let mesh = scene.assets.meshes.values().next().unwrap();
        let corner = |i: u32| mesh.positions[i as usize].as_dvec3();
        let six: f64 = mesh.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum();
        assert!((six / 6.0 - volume).abs() < 1e-4, "{command}: {}", six / 6.0);
    }
    // The option `-i` repeats a part, and `-m` sets a material. File names in included files are
    // relative to the scene.
    let files = folder(&[
        ("part.rad", b"white sphere s 0 0 4 1 0 0 .25\n"),
        ("red.rad", b"void plastic red 0 0 5 1 0 0 0 0\n!xform -m red part.rad"),
    ]);
    let (scene, messages) =
        read_in(files.path(), "scene.rad", &format!("{MATTE}!xform -i 3 -t 1 0 0 -i 1 -rz 90 red.rad\n"));
    assert_eq!(messages, [""; 0]);
    let scene = scene.unwrap();
    let object = &scene.root.as_ref().unwrap().objects[0];
    let ObjectKind::Primitive(durer_scene::shape::Primitive::Sphere(sphere)) = &object.node else { panic!() };
    assert!((sphere.center - Vec3::new(0.0, 4.0, 0.0)).length() < 1e-6, "{}", sphere.center);
    assert_eq!(layers(&scene, object.material.unwrap()).base_color, Vec3::X);
}

#[test]
fn materials_become_layers() {
    let (m, messages) = sphere("void plastic m 0 0 5 .8 .4 .2 .04 0");
    assert_eq!((m.base_color, messages.len()), (Vec3::new(0.8, 0.4, 0.2), 0));
    // An index of refraction of 1.5 gives a reflectance of 4 %.
    assert!((m.specular_ior - 1.5).abs() < 1e-5 && m.specular_roughness == 0.0);
    // The specular part of rough plastic is white at all angles. The roughness of OpenPBR is the
    // square root of the slope.
    let scene = clean("void plastic m 0 0 5 .8 .4 .2 .04 .09 m sphere s 0 0 4 1 2 3 .5");
    let Material::Solid(durer_scene::material::PatternMaterial::Mix(mix), _) = &scene.materials[2].value else {
        panic!("no mixture")
    };
    assert_eq!((mix.material1, mix.material2, mix.share), (0, 1, 0.04));
    let (glossy, matte) = (layers(&scene, 0), layers(&scene, 1));
    assert!((glossy.specular_roughness - 0.3).abs() < 1e-6 && glossy.base_metalness == 1.0);
    assert_eq!((matte.base_color, matte.specular_weight), (Vec3::new(0.8, 0.4, 0.2), 0.0));
    assert_eq!(sphere("void plastic m 0 0 5 .8 .4 .2 0 0").0.specular_weight, 0.0);
    let (m, _) = sphere("void metal m 0 0 5 .9 .5 .1 .95 .04");
    assert!(m.base_metalness == 0.95 && (m.specular_roughness - 0.2).abs() < 1e-6);
    let (m, _) = sphere("void glass m 0 0 3 .9 .8 .7");
    assert_eq!((m.walls, m.specular_ior, m.transmission_color), (Walls::Thin, 1.52, Vec3::new(0.9, 0.8, 0.7)));
    // The inside absorbs light, including light that is reflected inside.
    assert_eq!(m.transmission_depth, 1.0);
    let (m, _) = sphere("void dielectric m 0 0 5 .5 .25 1 1.33 0");
    assert_eq!((m.walls, m.specular_ior, m.transmission_depth), (Walls::Solid, 1.33, 1.0));
    assert_eq!(m.transmission_color, Vec3::new(0.5, 0.25, 1.0));
    let (m, _) = sphere("void trans m 0 0 7 .9 .9 .5 0 0 .5 .7");
    assert!((m.transmission_weight - 0.35).abs() < 1e-6);
    // A fraction of 0.5 is scattered backwards, and 0.15 forwards.
    assert!((m.subsurface_scatter_anisotropy + 0.35 / 0.65).abs() < 1e-6);
    let (m, _) = sphere("void light m 0 0 3 4 2 1");
    assert_eq!((m.emission_luminance, m.emission_color, m.base_color), (4.0, Vec3::new(1.0, 0.5, 0.25), Vec3::ZERO));
    // For a bubble in glass, the interior is the side that the material calls the outside.
    let text = "void interface m 0 0 8 1 1 1 1.5 1 1 1 1.33\n";
    for (kind, index) in [("sphere", 1.5), ("bubble", 1.33)] {
        let scene = clean(&format!("{text}m {kind} s 0 0 4 0 0 0 1"));
        assert_eq!(layers(&scene, scene.root.as_ref().unwrap().objects[0].material.unwrap()).specular_ior, index);
    }
}

#[test]
fn missing_counterpart_gives_one_warning_with_position() {
    for (text, expected) in [
        (
            "void antimatter m 1 void 0 0",
            "1:6 warning `antimatter` has no counterpart: the `antimatter` is left out and removes nothing",
        ),
        (
            "void colortext t 2 helvet.fnt x 0 15 0 0 0 1 0 0 0 1 0 1 1 1 .5 .5 .5 t plastic m 0 0 5 .8 .8 .8 0 0",
            "1:6 warning text has no counterpart: its background is used",
        ),
        (
            "void brightfunc f 2 noise(Px) . 0 0\nf plastic m 0 0 5 .8 .8 .8 0 0",
            "1:6 warning function patterns (`brightfunc`) have no counterpart: the pattern is left out",
        ),
        ("void BSDF m 6 0 minimal 0 0 1 . 0 0", "1:6 warning `BSDF` has no counterpart: diffuse grey is used"),
    ] {
        let (scene, found) = read(&format!("{text}\nm sphere a 0 0 4 0 0 0 1\nm sphere b 0 0 4 3 0 0 1"));
        assert!(scene.is_some());
        assert_eq!(found, [format!("scene.rad:{expected}")], "{text}");
    }
    // Materials that are not used are not reported.
    clean("void BSDF m 1 a.xml 0 0");
}

#[test]
fn errors_have_positions() {
    let cycle = folder(&[("a.rad", b"\n!xform a.rad"), ("far.rad", b"!cat ../a.rad")]);
    for (text, expected) in [
        ("void plastik m 0 0 5 1 1 1 0 0", "1:6 error unknown type `plastik` (did you mean `plastic`?)"),
        (
            "void plastic m 0 0 4 1 1 1 0\nm sphere s 0 0 4 0 0 0 1",
            "1:6 error a plastic needs 5 numbers, but this one has 4",
        ),
        ("void plastic m 0 0 5 1 x 1 0 0", "1:24 error expected a number, found `x`"),
        ("void plastic m 0 0 5 1 1\nm sphere s 0 0 4 0 0 0 1", "1:20 error `5` declares 5 numbers, but 2 follow"),
        ("void plastic m 0 0 5 1 1e99 1 0 0", "1:24 error expected a number, found `1e99`"),
        ("void plastic m 0 0 5 1 1", "1:1 error the file ends within this primitive"),
        ("void plastic m 0 0 99999999999 1", "1:1 error the file ends within this primitive"),
        ("void plastic m 0 0 -1", "1:20 error expected a whole number of 0 or more, found `-1`"),
        ("void plastic m 0 2 1 2 0", "1:18 error the number of integer arguments of a primitive must be 0"),
        (
            "m sphere s 0 0 4 0 0 0 1",
            "1:1 error no modifier `m` is defined before this point (name files with materials before the files that \
             use them)",
        ),
        (
            "void polygon p 0 0 6 0 0 0 1 1 1",
            "1:6 error a polygon needs at least 3 vertices with 3 numbers each, but this polygon has 6 numbers",
        ),
        ("!xform -t 1 2 missing.rad", "1:15 error expected a number, found `missing.rad`"),
        ("!xform missing.rad", "1:8 error the file `missing.rad` does not exist"),
        ("!xform -q far.rad", "1:8 error `xform` has no option `-q`"),
        ("!genbox m b 1 1", "1:2 error `genbox` needs a material, a name and three sizes"),
        (
            "!cat far.rad | grep x",
            "1:16 error the command `grep` is not supported (supported commands are `xform`, `cat`, `genbox`, `genprism` and `gensky`. Run Radiance's own `grep`, save its output in a file beside the scene, and write `!cat FILE` here)",
        ),
        ("!| xform", "1:4 error a command is missing beside `|`"),
        ("!", "1:2 error a command is missing after `!`"),
        ("!xform -a 1000000 -t 1 0 0 -a 1000000 far.rad", "1:8 error these arrays make too many copies"),
    ] {
        let (scene, found) = read_in(cycle.path(), "scene.rad", text);
        assert!(scene.is_none(), "{text}");
        assert_eq!(found[0], format!("scene.rad:{expected}"), "{text}");
    }
    let (_, found) = read_in(cycle.path(), "scene.rad", "!cat a.rad");
    assert_eq!(found, ["a.rad:2:8 error files are nested more than 32 levels deep, or a file includes itself"]);
    let (_, found) = read_in(cycle.path(), "scene.rad", "!cat far.rad");
    let help = "a scene can only use files in or below its own folder, unless `--allow-outside` is given";
    assert!(found[0].starts_with("far.rad:1:6 error ") && !found[0].contains("missing"), "{found:?} {help}");
    let many = "void plastic".to_string() + &"\nvoid plastik m 0 0 0".repeat(100);
    assert!(read(&many).1.len() <= 21);
}

/// Builds a tree of mixtures that is used many times, in partly transparent mixtures or with
/// patterns applied to it.
#[test]
fn number_of_materials_is_limited() {
    let depth = 9;
    let mut tree: String =
        (0..1 << depth).map(|i| format!("void plastic p{depth}_{i} 0 0 5 .5 .{i} .5 0 0\n")).collect();
    for (d, i) in (0..depth).rev().flat_map(|d| (0..1 << d).map(move |i| (d, i))) {
        let [a, b] = [2 * i, 2 * i + 1].map(|k| format!("p{}_{k}", d + 1));
        tree += &format!("void mixfunc p{d}_{i} 4 {a} {b} .5 . 0 0\n");
    }
    let all = |copy: &dyn Fn(u32) -> String| tree.clone() + &(0..100).map(copy).collect::<String>();
    let seen_through = |i| format!("void mixfunc v{i} 4 p0_0 void .5 . 0 0 v{i} sphere s 0 0 4 {i} 0 0 .4\n");
    let tinted = |i| format!("p0_0 brightfunc v{i} 2 .{i} . 0 0 v{i} sphere s 0 0 4 {i} 0 0 .4\n");
    for text in [all(&seen_through), all(&tinted)] {
        let (scene, messages) = read(&text);
        let errors: Vec<&String> = messages.iter().filter(|line| line.contains("error")).collect();
        assert!(scene.is_none() && errors.len() == 1 && errors[0].contains("more than 65536 materials"), "{errors:?}");
    }
}

#[test]
fn rif_reads_files_and_views() {
    let files = folder(&[
        ("m.rad", MATTE.as_bytes()),
        ("s.rad", b"white sphere s 0 0 4 0 9 0 1"),
        ("a.vf", b"# comment\nVIEW= -vtl -vp 0 0 0 -vd 0 1 0 -vh 4 -vv 2\n"),
    ]);
    let text = "# rad\nmat = m.rad\nscene = s.rad \\\n \"!xform -t 2 0 0 s.rad\"\nRES = 100\nEXP = +2\nview = one -vf a.vf\nview= two -vp 1 2 3 -vh 90 -vv 90\n";
    let (scene, expected) = read_in(files.path(), "x.rif", text);
    assert_eq!(expected, ["x.rif:6:7 note the file sets an exposure: use `--exposure 2.00`"]);
    let scene = scene.unwrap();
    assert_eq!(scene.render_defaults.size, Some((100, 50)));
    assert_eq!(scene.root.as_ref().unwrap().objects.len(), 2);
    let Some(durer_scene::camera::Camera::Orthographic(camera)) = &scene.camera else { panic!() };
    assert_eq!((camera.size, camera.direction, camera.up), (4.0, Vec3::Y, Vec3::Z));
    for (line, expected) in [
        ("scene = s.rad", "x.rif:1:9 error the file `s.rad` does not exist"),
        ("view = a -vp 1 2", "x.rif:1:10 error `-vp` needs 3 numbers"),
        ("banana = 1", "x.rif:1:1 error `rad` has no variable `banana`"),
        ("scene s.rad", "x.rif:1:1 error a line must have the form `VARIABLE = values`"),
        (
            "OCTREE = a.oct",
            "x.rif:1:1 error this file names no scene (octrees are not supported: name the source file of the octree \
             with `scene = FILE.rad`)",
        ),
    ] {
        let (scene, found) = read_in(Path::new("/nonexistent"), "x.rif", line);
        assert!(scene.is_none());
        assert!(found.iter().any(|found| found.starts_with(expected)), "{line}: {found:?}");
    }
}
