//! Tests of behaviour that the manual does not specify and that was measured with Radiance's own
//! programs. The tests cover chains of patterns, skies, folders, standard views, and the
//! reflectance and transmittance of a sheet.

use super::*;
use crate::radiance::args::RadPrimitive;
use crate::radiance::sky::Sky;
use crate::radiance::words::Words;
use crate::shared_report::SharedReport;
use durer::{LoadOptions, load_text};
use durer_diag::{Diagnostics, Files};
use durer_render::integrator::{Integrate, Path as Paths, PathOptions};
use durer_render::render::Job;
use durer_scene::camera::Projection;
use durer_scene::light::Light;
use durer_scene::math::Ray;
use durer_scene::sampler::SampleId;
use glam::{DMat3, DVec3};

/// Sun that is appended to texts so that they do not get default lighting.
const SUN: &str = "\nvoid light sun 0 0 3 1 1 1 sun source s 0 0 4 0 0 1 .5";

/// Material of the first object.
fn first(scene: &Scene) -> &PrincipledMaterial {
    let root = scene.root.as_ref().unwrap();
    layers(scene, root.objects.first().expect("an object").material.unwrap())
}

#[test]
fn surface_with_a_pattern_has_the_material_below_it() {
    let base = "void plastic m 0 0 5 .6 .4 .2 0 0\n";
    for (patterns, share) in [
        ("m brightfunc t 2 1 . 0 0", 1.0),
        ("m brightfunc t 2 .5 . 0 0", 0.5),
        ("m brightfunc s 2 .5 . 0 0 s brightfunc t 2 .5 . 0 0", 0.25),
        ("void brightfunc s 2 .5 . 0 0 s plastic n 0 0 5 .6 .4 .2 0 0 n brightfunc t 2 .5 . 0 0", 0.25),
        ("void mixfunc x 4 m m .5 . 0 0 x brightfunc t 2 .5 . 0 0 m alias u m t alias t t", f32::NAN),
    ] {
        let scene = clean(&format!("{base}{patterns} t sphere p 0 0 4 0 0 0 1{SUN}"));
        if share.is_finite() {
            assert!((first(&scene).base_color - share * Vec3::new(0.6, 0.4, 0.2)).length() < 1e-6, "{patterns}");
        } else {
            assert!(scene.root.unwrap().objects.len() == 1);
        }
    }
    // A texture that has no effect does not add a second material.
    let text = format!("{base}m texfunc t 4 0 0 0 . 0 0 t sphere p 0 0 4 0 0 0 1 m sphere q 0 0 4 3 0 0 1{SUN}");
    assert_eq!(read(&text).0.unwrap().materials.len(), 1);
    // Patterns that are applied to `void` have no effect.
    assert!(
        clean(&format!("void brightfunc t 2 1 . 0 0 t sphere p 0 0 4 0 0 0 1{SUN}")).root.unwrap().objects.is_empty()
    );
}

/// Returns the radiance of a sky in four directions.
fn skies(numbers: &str, turn: DMat3) -> [f32; 4] {
    let text = format!("void brightfunc f 2 skybr skybright.cal 0 {numbers}");
    let report = SharedReport::default();
    let mut words = Words::new(text.as_bytes(), 0, 0..text.len());
    let primitive = RadPrimitive::read(words.next().unwrap(), &mut words, &report).unwrap();
    let sky = Sky::of(&primitive, turn, &report).unwrap();
    let ways = [[0.0, 0.0, 1.0], [0.6, 0.772, 0.1736], [0.8, 0.0, -0.05], [0.3, -0.9, -0.3]];
    ways.map(|way| sky.at(DVec3::from_array(way).normalize()))
}

#[test]
fn skies_match_rtrace() {
    let about = DMat3::from_rotation_x(20f64.to_radians()) * DMat3::from_rotation_z(70f64.to_radians());
    let sun = "-0.058393 -0.321824 0.944997";
    for (numbers, still, turned) in [
        (
            format!("7 1 30 7 1.1 {sun}"),
            [37.28357, 21.9188, 12.0113, 7.020478],
            [23.06689, 9.544202, 13.30356, 23.21662],
        ),
        ("3 2 30 7".into(), [29.99998, 13.28487, 7.445581, 6.996926], [28.79382, 7.123537, 7.492702, 9.358907]),
        ("3 3 30 7".into(), [29.99998, 29.25127, 12.84807, 7.023332], [29.99996, 9.93627, 13.20032, 22.40973]),
        (
            format!("7 4 30 7 1.1 {sun}"),
            [30.20548, 4.548315, 6.802182, 7.00245],
            [18.83694, 7.004692, 7.606111, 8.195106],
        ),
    ] {
        for (turn, expected) in [(DMat3::IDENTITY, still), (2.0 * about, turned)] {
            let found = skies(&numbers, turn);
            let near = |(a, b): (f32, f32)| (a / b - 1.0).abs() < 1e-4;
            assert!(found.into_iter().zip(expected).all(near), "{numbers}: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn skies_are_rotated_by_xform_and_by_their_arguments() {
    // The bright side of a clear sky is at y and is rotated to x. The rotation is given in the
    // text, in a pipe or in a file.
    let numbers = "0 7 1 30 7 1.1 0 .7 .714143";
    let rest = "f glow g 0 0 4 1 1 1 0 g source s 0 0 4 0 0 1 180";
    let sky = format!("void brightfunc f 2 skybr skybright.cal {numbers} {rest}");
    let files = folder(&[("sky.rad", sky.as_bytes())]);
    let lit = |text: &str| {
        let (mut files_read, mut diagnostics) = (Files::default(), Diagnostics::default());
        let options = LoadOptions::default();
        let path = files.path().join("scene.rad");
        let scene = load_text(&path, text.as_bytes().into(), &options, &mut files_read, &mut diagnostics).unwrap();
        let world = scene.compile(&options, &mut files_read, &mut diagnostics).unwrap();
        let settings = Job::default().settings;
        let paths =
            Paths { world: &world, settings, options: PathOptions::default(), photons: None, cone: None, cancel: None };
        let at = |x: f32, y: f32| {
            let ray = Ray::new(Vec3::ZERO, Vec3::new(x, y, 1.0).normalize());
            paths.radiance(&ray, SampleId::new(0, (0, 0), 0), &mut ()).x
        };
        [at(1.0, 0.0), at(0.0, 1.0)]
    };
    let [dark, bright] = lit("!cat sky.rad");
    assert!(bright > 2.0 * dark);
    let own = sky.replace("2 skybr skybright.cal", "4 skybr skybright.cal -rz -90");
    for text in ["!xform -rz -90 sky.rad", "!cat sky.rad | xform -rz -90", &own] {
        let found = lit(text);
        assert!((found[0] / bright - 1.0).abs() < 0.02 && found[1] < 0.5 * bright, "{text}: {found:?}");
    }
}

#[test]
fn commands_run_in_the_folder_of_the_file_of_xform() {
    let files = folder(&[
        ("fur/desk.rad", b"!xform -t .5 0 0 leg.rad\n!cat parts/foot.rad"),
        ("fur/leg.rad", b"white sphere s 0 0 4 0 0 0 1"),
        ("fur/parts/foot.rad", b"!genprism white p base.txt"),
        ("fur/base.txt", b"0 0 0 1 1 0"),
        ("far.rad", b"!cat fur/leg.rad"),
    ]);
    for (command, objects) in [
        ("!xform -t 0 0 1 fur/desk.rad", Ok(2)),
        ("!xform fur/desk.rad | xform -t 1 0 0", Ok(2)),
        ("!cat far.rad", Ok(1)),
        ("!cat fur/desk.rad", Err("leg.rad")),
        ("!xform -c fur/desk.rad", Err("leg.rad")),
        ("!xform -e -c -e fur/desk.rad", Ok(2)),
    ] {
        let (scene, messages) = read_in(files.path(), "scene.rad", format!("{MATTE}{command}{SUN}"));
        match objects {
            Ok(count) => {
                let scene = scene.unwrap_or_else(|| panic!("{command}: {messages:?}")); // prose: keep
                assert_eq!((scene.root.unwrap().objects.len(), messages.len()), (count, 0), "{command}: {messages:?}"); // prose: keep
            }
            Err(name) => {
                assert!(messages[0].contains(&format!("the file `{name}` does not exist")), "{command}: {messages:?}")
            } // prose: keep
        }
    }
}

#[test]
fn picture_header_is_a_view() {
    let text = b"#?RADIANCE\noconv scene.rad\n/usr/bin/rpict -vf v.vf -vp 9 9 9 -x 32 -y 32\n\
                 VIEW= -vtv -vp 1 2 3 -vd 0 1 0 -vu 0 0 1 -vh 40 -vv 40\n\nVIEW= -vp \x80 x y\n";
    let files = folder(&[("s.rad", b"void plastic w 0 0 5 1 1 1 0 0 w sphere s 0 0 4 0 0 0 1"), ("a.hdr", text)]);
    let (scene, messages) = read_in(files.path(), "x.rif", "scene = s.rad\nview = -vf a.hdr\n");
    let scene = scene.unwrap_or_else(|| panic!("{messages:?}"));
    assert_eq!((scene.camera.unwrap().pose().center, messages.len()), (Vec3::new(1.0, 2.0, 3.0), 0));
}

#[test]
fn standard_views_match_rad() {
    let files = folder(&[("s.rad", b"void plastic w 0 0 5 1 1 1 0 0 w polygon p 0 0 9 -4 -4 0 4 -4 0 4 4 4")]);
    for (lines, center, direction, up) in [
        ("view= XYZ\nZONE= E -4 4 -4 4 0 6", [16.0, 16.0, 15.0], [-8.0, -8.0, -6.0], Vec3::Z),
        ("view= XYZ\nZONE= I -4 4 -4 4 0 6\nUP= -Z", [3.6, 3.6, 5.7], [-8.0, -8.0, -6.0], Vec3::NEG_Z),
        ("view= x -vh 20\nZONE= E -4 4 -4 4 0 6\nUP= X", [-16.0, 0.0, 3.0], [8.0, 0.0, 0.0], Vec3::Z),
        ("view= yl\nZONE= E -4 4 -4 4 0 6\nUP= Y", [0.0, -16.0, 3.0], [0.0, 8.0, 0.0], Vec3::X),
        ("view= z\nZONE= I -4 4 -4 4 0 6", [0.0, 0.0, 0.3], [0.0, 0.0, 6.0], Vec3::Y),
        // If there is no zone, the box is the bounding cube of all surfaces.
        ("view= XYZ", [16.0, 16.0, 18.0], [-8.0, -8.0, -8.0], Vec3::Z),
    ] {
        let (scene, messages) = read_in(files.path(), "x.rif", format!("scene = s.rad\n{lines}\n"));
        let camera = scene.unwrap_or_else(|| panic!("{lines}: {messages:?}")).camera.unwrap(); // prose: keep
        let pose = camera.pose();
        let close = |a: Vec3, b: [f32; 3]| (a - Vec3::from_array(b)).length() < 1e-4;
        assert!(close(pose.center, center) && close(pose.direction, direction) && pose.up == up, "{lines}: {camera:?}");
        if let durer_scene::camera::Camera::Orthographic(camera) = camera {
            assert!((camera.size - 164f32.sqrt()).abs() < 1e-4);
        }
    }
}

#[test]
fn sheet_has_the_given_reflectance_and_transmittance() {
    // Formulas for thin sheets at normal incidence, which are 2 F / (1 + F) for the part that is
    // transmitted specularly and F for the remainder.
    for (numbers, [reflected, straight, matte]) in [
        (".05 0 .9 1", [0.05, 0.95 * 0.9, 0.95 * 0.1]),
        (".2 0 .5 .4", [0.2, 0.8 * 0.2, 0.8 * 0.8]),
        ("0 0 1 1", [0.0, 1.0, 0.0]),
        ("0 .1 .5 1", [0.0, 0.5, 0.5]),
    ] {
        let (m, messages) = sphere(&format!("void trans m 0 0 7 .7 .7 .7 {numbers}"));
        assert_eq!(messages, [""; 0]);
        let root = (m.specular_ior - 1.0) / (m.specular_ior + 1.0);
        let (once, share) = (root * root, m.transmission_weight);
        let twice = 2.0 * once / (1.0 + once);
        let found = [
            share * twice + (1.0 - share) * once * m.specular_weight,
            share * (1.0 - twice),
            (1.0 - share) * (1.0 - once),
        ];
        let near = found.into_iter().zip([reflected, straight, matte]).all(|(a, b): (f32, f32)| (a - b).abs() < 1e-5);
        assert!(near, "{numbers}: {found:?}");
    }
    // Roughness scatters transmitted light even without a reflecting layer.
    assert_eq!(sphere("void trans m 0 0 7 1 1 1 0 0 1 1").0.specular_roughness, 0.0);
    assert!((sphere("void trans m 0 0 7 1 1 1 0 .09 1 1").0.specular_roughness - 0.3).abs() < 1e-6);
}

#[test]
fn rough_plastic_has_the_given_reflectance_in_all_directions() {
    let sky = "void glow g 0 0 4 1 1 1 0 g source s 0 0 4 0 0 1 360\n";
    for (material, expected) in [
        ("plastic m 0 0 5 .2 .2 .2 .04 .05", 0.2 * 0.96 + 0.04),
        ("plastic m 0 0 5 .5 .5 .5 .02 .1", 0.5 * 0.98 + 0.02),
        ("plastic m 0 0 5 .5 .5 .5 0 .1", 0.5),
        ("plastic2 m 0 0 6 .2 .2 .2 .1 .1 .1", 0.2 * 0.9 + 0.1),
    ] {
        let text = format!("{sky}void {material} m ring r 0 0 8 0 0 0 0 0 1 0 5");
        let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
        let options = LoadOptions::default();
        let loaded = load_text(Path::new("a.rad"), text.as_bytes().into(), &options, &mut files, &mut diagnostics);
        let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics)).unwrap();
        let paths = Paths::new(&world, Job::default().settings, PathOptions::default());
        for (x, z) in [(0.0, -1.0), (0.8, -0.6), (0.97, -0.243)] {
            let ray = Ray::new(Vec3::new(-x, 0.0, -z), Vec3::new(x, 0.0, z));
            let seen = (0..4096).map(|i| f64::from(paths.radiance(&ray, SampleId::new(0, (0, 0), i), &mut ()).x));
            let mean = seen.sum::<f64>() / 4096.0;
            assert!((mean / expected - 1.0).abs() < 0.02, "{material} {z}: {mean}, not {expected}");
        }
    }
}

#[test]
fn mirror_uses_its_substitute_and_void_is_transparent() {
    let other = "void plastic blue 0 0 5 0 0 .7 0 0\n";
    let what = "scene.rad:2:6 warning `mirror` has no counterpart: its substitute material is used, which does not \
                mirror lights";
    let (scene, messages) = read(&format!("{other}void mirror m 1 blue 0 3 .8 .8 .8 m sphere s 0 0 4 0 0 0 1"));
    assert_eq!(
        (first(&scene.unwrap()).base_color, messages.as_slice()),
        (0.7 * Vec3::Z, [what.to_string()].as_slice())
    );
    let (scene, messages) = read(&format!("{other}void mirror m 1 void 0 3 .8 .8 .8 m sphere s 0 0 4 0 0 0 1{SUN}"));
    assert_eq!((scene.unwrap().root.unwrap().objects.len(), messages.as_slice()), (0, [what.to_string()].as_slice()));
    for (mixed, opacity) in [("blue void .25", 0.25), ("void blue .25", 0.75), ("void half .5", 0.25)] {
        let text = format!("{other}void mixfunc half 4 blue void .5 . 0 0 void mixfunc m 4 {mixed} . 0 0");
        let scene = clean(&format!("{text} m sphere s 0 0 4 0 0 0 1{SUN}"));
        assert_eq!((first(&scene).opacity, scene.materials.len()), (opacity, 1), "{mixed}");
    }
    // Mixture with an opacity of one half.
    let text = format!("{other}{MATTE}void mixfunc two 4 blue white .5 . 0 0 void mixfunc m 4 two void .5 . 0 0");
    let scene = clean(&format!("{text} m sphere s 0 0 4 0 0 0 1{SUN}"));
    assert_eq!(scene.materials.len(), 3);
    assert!((0..2).all(|i| layers(&scene, i).opacity == 0.5));
}

#[test]
fn degenerate_surfaces_are_left_out() {
    for (primitive, expected) in [
        ("sphere s 0 0 4 0 0 0 0", "a sphere of radius 0 is left out"),
        ("ring s 0 0 8 0 0 0 0 0 0 0 1", "a ring without a direction or a radius is left out"),
        (
            "cylinder s 0 0 7 0 0 0 0 0 0 1",
            "a cylinder without a length, or with radii that are all 0 or differ in sign, is left out",
        ),
        (
            "cone s 0 0 8 0 0 0 0 0 1 -1 1",
            "a cone without a length, or with radii that are all 0 or differ in sign, is left out",
        ),
    ] {
        let (scene, found) =
            read(&format!("{MATTE}white {primitive}\nwhite {primitive}\nwhite sphere b 0 0 4 0 0 0 1{SUN}"));
        assert_eq!(scene.unwrap().root.unwrap().objects.len(), 1);
        assert_eq!(found, [format!("scene.rad:2:7 warning {expected}")]); // prose: keep
    }
}

#[test]
fn unused_materials_are_removed() {
    // The reader removes the materials of a sun and of the outer side of glass.
    let scene = clean(
        "void light l 0 0 3 9 9 9 l source s 0 0 4 0 0 1 .5 void interface g 0 0 8 1 1 1 1.5 1 1 1 1.33 g bubble b 0 0 4 0 0 0 1",
    );
    assert_eq!((scene.materials.len(), first(&scene).specular_ior), (1, 1.33));
    let Light::Directional(_) = scene.lights.unwrap()[0].value else { panic!("no sun") };
}

#[test]
fn missing_files_that_are_not_read_give_a_warning() {
    let files = folder(&[("here.cal", b"")]);
    for (kind, missing) in [
        ("brightfunc f 2 f(Px) gone.cal 0 0 f plastic", Some("1:27 warning missing file `gone.cal`")),
        ("brightfunc f 2 f(Px) here.cal 0 0 f plastic", None),
        ("brightfunc f 2 f(Px) noise.cal 0 0 f plastic", None),
    ] {
        let text = format!("void {kind} m 0 0 5 1 1 1 0 0 m sphere b 0 0 4 0 0 0 1");
        let (scene, messages) = read_in(files.path(), "scene.rad", text);
        assert!(scene.is_some());
        let found: Vec<&String> = messages.iter().filter(|message| message.contains("missing file")).collect();
        assert_eq!(found, missing.map(|missing| format!("scene.rad:{missing}")).iter().collect::<Vec<_>>());
    }
    for primitive in [
        "void BSDF m 6 0 gone.xml 0 0 1 . 0 0 m sphere s 0 0 4 0 0 0 1",
        "void mesh m 1 gone.rtm 0 0",
        "void instance m 1 gone.oct 0 0",
    ] {
        let (_, messages) =
            read_in(files.path(), "scene.rad", format!("{MATTE}white sphere b 0 0 4 0 0 0 1\n{primitive}"));
        assert!(messages.iter().any(|message| message.contains("missing file `gone.")), "{messages:?}");
    }
}
