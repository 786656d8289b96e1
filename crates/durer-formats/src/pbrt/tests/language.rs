use super::*;
use durer_scene::math::Vec3;
use durer_scene::scene::ObjectKind;
use durer_scene::shape::Primitive;
use std::io::Write;

#[test]
fn words_strings_brackets_and_comments() {
    let text = "\u{feff}# a comment with \"quotes\" and [\nCamera\"perspective\"\"float fov\"[60]#glued\nWorldBegin\r\n\t\
                Material \"diffuse\" \"rgb reflectance\" [ .5 5e-1 +0.25 ] # [ ignored\n\
                AttributeBegin Translate 1 2 3 Shape \"sphere\" \"float radius\" 2 AttributeEnd";
    let scene = clean(text);
    let object = &scene.root.as_ref().unwrap().objects[0];
    let ObjectKind::Primitive(Primitive::Sphere(sphere)) = &object.node else { panic!("{object:?}") };
    assert_eq!((sphere.center, sphere.radius), (Vec3::new(1.0, 2.0, 3.0), 2.0));
    let (m, _) = material("Material \"diffuse\" \"rgb reflectance\" [ .5 5e-1 +0.25 ]");
    assert_eq!((m.base_color, m.specular_weight), (Vec3::new(0.5, 0.5, 0.25), 0.0));
}

#[test]
fn errors_have_place_and_suggestion() {
    for (text, wanted) in [
        ("WorldBegin\n Shpae \"sphere\"", "scene.pbrt:2:2 error unknown directive `Shpae` (did you mean `Shape`?)"),
        ("WorldBegin\nShape \"sfere\"", "scene.pbrt:2:8 error unknown shape `sfere` (did you mean `sphere`?)"),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" \"two\"",
            "scene.pbrt:1:43 error `radius` needs numbers, found 1 string",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" [ 1,5 ]",
            "scene.pbrt:1:44 error expected a number, found `1,5` (write decimals with a point: `1.5`)",
        ),
        (
            "WorldBegin Shape \"sphere\" \"flaot radius\" 1",
            "error `flaot` is not a parameter type (did you mean `float`?)",
        ),
        ("WorldBegin Shape \"sphere\" \"float radius\" 1 \"float radius\" 2", "error `radius` is given twice"),
        ("WorldBegin Shape \"sphere\" \"string radius\" \"a\"", "error `radius` must be a float"),
        ("WorldBegin Shape \"sphere\" \"float radius\" [ ]", "error `radius` has no value"),
        ("WorldBegin Shape \"sphere\" \"float radius\" -1", "error `radius` must be more than 0"),
        ("WorldBegin Shape \"sphere\" \"float radius\" 1e39", "error expected a finite number, found `1e39`"),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" [ 1",
            "error these brackets are not closed (add the missing `]`)",
        ),
        ("WorldBegin Shape \"sphere\" \"float radius\" [ 1 [ 2 ] ]", "error brackets cannot be nested"),
        ("WorldBegin Shape \"sphere\" \"float radius", "scene.pbrt:1:27 error this string is not closed"),
        ("WorldBegin Shape \"sphere\n\"", "scene.pbrt:1:18 error this string is not closed"),
        ("WorldBegin Shape", "error `Shape` needs a string in quotes after it"),
        ("WorldBegin ]", "error unexpected bracket"),
        ("Translate 1 2", "scene.pbrt:1:1 error `Translate` needs 3 numbers, found 2"),
        ("Scale 0 1 1", "error this transform flattens space"),
        ("Rotate 30 0 0 0", "error the axis of a rotation must not be 0 0 0"),
        ("LookAt 0 0 0 0 0 0 0 1 0", "error the eye and the target of `LookAt` are equal"),
        ("Transform [ 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1 ]", "error this matrix is not affine"),
        ("WorldBegin AttributeEnd", "error `AttributeEnd` without a scope to close"),
        (
            "WorldBegin AttributeBegin",
            "scene.pbrt:1:12 error this scope is not closed (add the missing `AttributeEnd`)",
        ),
        (
            "WorldBegin AttributeBegin TransformEnd AttributeEnd",
            "error `TransformEnd` does not match the scope that is open",
        ),
        ("Shape \"sphere\" WorldBegin", "scene.pbrt:1:1 error this directive must come after `WorldBegin`"),
        ("WorldBegin Camera \"perspective\"", "error `Camera` must come before `WorldBegin`"),
        ("WorldBegin NamedMaterial \"gold\"", "error unknown material `gold`"),
        (
            "WorldBegin MakeNamedMaterial \"gold\" \"string type\" \"diffuse\" NamedMaterial \"glod\"",
            "error unknown material `glod` (did you mean `gold`?)",
        ),
        (
            "WorldBegin Material \"diffuse\" Material \"matte\"",
            "error unknown material `matte` in pbrt-v4 (`matte` is a pbrt-v3 material; the nearest material in \
             pbrt-v4 is `diffuse`",
        ),
        (
            "WorldBegin Material \"diffuse\" \"texture reflectance\" \"wood\"",
            "error unknown texture `wood` of type `spectrum`",
        ),
        ("WorldBegin LightSource \"pont\"", "error unknown light `pont` (did you mean `point`?)"),
        ("WorldBegin CoordSysTransform \"here\"", "error unknown coordinate system `here`"),
        ("WorldBegin MediumInterface \"\" \"fog\"", "error unknown medium `fog`"),
        ("WorldBegin ObjectInstance \"tree\"", "error unknown object `tree`"),
        (
            "WorldBegin ObjectBegin \"a\" ObjectBegin \"b\" ObjectEnd ObjectEnd",
            "error objects cannot be defined inside objects",
        ),
        ("Film \"rgb\" \"integer xresolution\" 0", "error `xresolution` must be from 1"),
        ("Film \"rgb\" \"integer xresolution\" 1000000 \"integer yresolution\" 1000000", "too many pixels"),
        ("Film \"rgb\" \"integer xresolution\" 1.5", "error `xresolution` needs 32-bit integers"),
        ("ColorSpace \"adobe\"", "error unknown colour space `adobe`"),
        ("WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 ]", "error `P` needs triples of numbers"),
        (
            "WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]",
            "error `indices` contains 3, but the points are numbered from 0 to 2",
        ),
        (
            "WorldBegin Shape \"plymesh\" \"string filename\" \"none.ply\"",
            "error the mesh cannot be read: the file `none.ply` does not exist",
        ),
        (
            "WorldBegin Shape \"plymesh\" \"string filename\" \"../../../../../../etc/passwd\"",
            "error the mesh cannot be read",
        ),
        (
            "WorldBegin LightSource \"point\" \"spectrum I\" [ 400 1 300 2 ]",
            "error the wavelengths of a spectrum must increase",
        ),
        (
            "WorldBegin Material \"conductor\" \"spectrum eta\" \"metal-Ag-eto\"",
            "error pbrt has no spectrum with the name `metal-Ag-eto`, and the file `metal-Ag-eto` does not exist (did \
             you mean `metal-Ag-eta`?)",
        ),
    ] {
        let camera = if text.starts_with("WorldBegin") { "" } else { "Camera \"perspective\" " };
        let film = text.starts_with("Film") || text.starts_with("ColorSpace");
        let text = if film { format!("{text} {camera} WorldBegin") } else { text.to_string() };
        let (scene, messages) = read(&text);
        assert!(scene.is_none(), "{text}");
        assert!(messages.iter().any(|message| message.contains(wanted)), "{text}\n{wanted}\n{messages:#?}");
    }
}

#[test]
fn parameters_of_an_unknown_material_are_not_reported() {
    for (material, other) in [("difuse", "rgb reflectance"), ("mattte", "rgb Kd")] {
        let (_, messages) = read(&format!("WorldBegin Material \"{material}\" \"{other}\" [ 1 1 1 ] Shape \"sphere\""));
        assert!(messages.len() == 1 && messages[0].contains("error unknown material"), "{messages:#?}");
    }
}

#[test]
fn unsupported_features_are_reported_once_with_substitute() {
    let text = "Integrator \"bdpt\" Camera \"perspective\"\nWorldBegin\n\
                MakeNamedMedium \"fog\" \"string type\" \"cloud\" MediumInterface \"\" \"fog\"\n\
                LightSource \"infinite\" \"point3 portal\" [ 0 0 0 ] Shape \"sphere\" \"float radiu\" 2\n\
                Material \"measured\" Shape \"sphere\"";
    let (scene, messages) = read(text);
    assert_eq!(scene.unwrap().root.unwrap().objects.len(), 2);
    assert_eq!(
        messages,
        [
            "scene.pbrt:1:13 note the integrator `bdpt` has no counterpart: path tracing is used",
            "scene.pbrt:3:18 warning media of type `cloud` have no counterpart: they are ignored",
            "scene.pbrt:4:25 warning `portal` has no counterpart: the whole environment is sampled",
            "scene.pbrt:4:66 warning the shape `sphere` has no parameter `radiu`: it is ignored (did you mean `radius`?)",
            "scene.pbrt:5:11 warning measured materials have no counterpart: diffuse grey is used",
        ]
    );
}

#[test]
fn included_files_are_read_and_errors_name_their_file() {
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    packed.write_all(b"Shape \"disk\"").unwrap();
    let packed = packed.finish().unwrap();
    let folder = folder(&[
        ("a.pbrt", b"AttributeBegin\nMaterial \"dielectric\"\nAttributeEnd\nShape \"sphere\""),
        (
            "state.pbrt",
            b"AttributeBegin Translate 5 0 0 Material \"dielectric\" Shape \"sphere\" AttributeEnd Translate 9 0 0",
        ),
        ("packed.pbrt.gz", &packed),
        ("bad.pbrt", b"\n  Shape \"sfere\""),
        ("open.pbrt", b"AttributeBegin"),
        ("circle.pbrt", b"Include \"round.pbrt\""),
        ("round.pbrt", b"\nInclude \"circle.pbrt\""),
    ]);
    let head = "Camera \"perspective\" WorldBegin ";
    let (scene, messages) = read_in(
        folder.path(),
        &format!("{head} Include \"a.pbrt\" Import \"state.pbrt\" Include \"packed.pbrt.gz\" Shape \"sphere\""),
    );
    assert_eq!(messages, [""; 0]);
    let objects = scene.unwrap().root.unwrap().objects;
    assert_eq!(objects.len(), 4);
    // `Import` restores the state that was current before it.
    assert!(objects[0].material == objects[3].material && matches!(objects[3].node, ObjectKind::Primitive(_)));
    for (name, wanted) in [
        ("bad.pbrt", "bad.pbrt:2:10 error unknown shape `sfere`"),
        ("circle.pbrt", "round.pbrt:2:10 error `circle.pbrt` includes itself"),
        ("scene.pbrt", "error `scene.pbrt` includes itself"),
        ("open.pbrt", "open.pbrt:1:1 error this scope is not closed"),
        ("bda.pbrt", "scene.pbrt:1:43 error the file `bda.pbrt` does not exist (did you mean `bad.pbrt`?)"),
        ("../a.pbrt", "error the file"),
    ] {
        let (scene, messages) = read_in(folder.path(), &format!("{head} Include \"{name}\""));
        assert!(scene.is_none() && messages.iter().any(|message| message.contains(wanted)), "{name}: {messages:#?}"); // prose: keep
    }
}

#[test]
fn hostile_files_never_panic() {
    let world = "Camera \"perspective\" WorldBegin ";
    let deep = format!("{world}{}", "AttributeBegin ".repeat(100_000));
    let many = format!(
        "{world} ObjectBegin \"a\" {} ObjectEnd {}",
        "Shape \"sphere\" ".repeat(1050),
        "ObjectInstance \"a\" ".repeat(1000)
    );
    let mixes = (1..200).fold(format!("{world} MakeNamedMaterial \"m0\" \"string type\" \"diffuse\""), |text, i| {
        let before = i - 1;
        text + &format!(
            " MakeNamedMaterial \"m{i}\" \"string type\" \"mix\" \"string materials\" [ \"m{before}\" \"m{before}\" ]"
        )
    });
    for (text, wanted) in [
        (deep, "scopes are nested more than 4096 levels deep"),
        (many, "the scene has more than"),
        (mixes + " NamedMaterial \"m199\" Shape \"sphere\"", "mixes of materials are nested more than 32 levels deep"),
        (format!("{world} Shape \"sphere\" {}", "\"float a\" ".repeat(100_000)), "expected"),
    ] {
        let (scene, messages) = read(&text);
        let end: String = text.chars().take(80).collect();
        assert!(scene.is_none() || wanted == "expected", "{end}");
        assert!(
            wanted == "expected" || messages.iter().any(|message| message.contains(wanted)),
            "{end}: {messages:#?}"
        ); // prose: keep
    }
    // Every prefix of a file is read, and then the file with each of its bytes changed.
    let text = "Film \"rgb\" \"integer xresolution\" [8] Camera \"perspective\" \"float fov\" 40 WorldBegin\n\
                Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 0 1]\n\
                AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] Material \"diffuse\" \"texture reflectance\" \"t\"\n\
                Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1] AttributeEnd Shape \"cylinder\" \"float zmin\" 0";
    clean(text);
    for end in 0..text.len() {
        read(&text[..end]);
    }
    for i in 0..text.len() {
        for byte in [b'"', b'[', b'#', b'0', 0] {
            let mut bytes = text.as_bytes().to_vec();
            bytes[i] = byte;
            read(std::str::from_utf8(&bytes).unwrap());
        }
    }
}

#[test]
fn attributes_are_restored_and_defaults_apply_by_kind() {
    let scene = clean(
        "Camera \"perspective\" WorldBegin\nAttribute \"shape\" \"float radius\" 3\n\
         CoordinateSystem \"here\"\nAttributeBegin Translate 1 0 0 Rotate 90 0 0 1 Scale 2 2 2\nShape \"sphere\" AttributeEnd\n\
         TransformBegin Translate 7 0 0 TransformEnd Shape \"sphere\" \"float radius\" 4\n\
         Translate 1 1 1 CoordSysTransform \"here\" Shape \"sphere\" Identity ActiveTransform All",
    );
    let objects = scene.root.unwrap().objects;
    let sphere = |i: usize| match &objects[i].node {
        ObjectKind::Primitive(Primitive::Sphere(sphere)) => (sphere.center, sphere.radius),
        other => panic!("{other:?}"),
    };
    assert_eq!((sphere(1), sphere(2)), ((Vec3::ZERO, 4.0), (Vec3::ZERO, 3.0)));
    let ObjectKind::Transform(ops, inner) = &objects[0].node else { panic!("{:?}", objects[0]) };
    let map = ops[0].matrix();
    assert!((map.transform_point3(glam::DVec3::X) - glam::DVec3::new(1.0, 2.0, 0.0)).length() < 1e-6);
    assert!(matches!(&inner.node, ObjectKind::Primitive(Primitive::Sphere(sphere)) if sphere.radius == 3.0));
}

#[test]
fn file_without_camera_is_a_model() {
    let scene = clean("Shape \"sphere\" \"float radius\" 2");
    assert!(scene.camera.is_some() && !scene.lights.unwrap().is_empty());
    // A file with a camera gets no extra lights.
    assert_eq!(clean("Camera \"perspective\" WorldBegin Shape \"sphere\"").lights, None);
}

#[test]
fn settings_come_from_film_sampler_and_integrator() {
    let scene = clean(
        "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20 Sampler \"stratified\" \"integer xsamples\" 3\n\
         Integrator \"path\" \"integer maxdepth\" 7 Camera \"perspective\" WorldBegin Shape \"sphere\"",
    );
    let render_defaults = scene.render_defaults;
    assert_eq!(
        (render_defaults.size, render_defaults.samples, render_defaults.bounces),
        (Some((30, 20)), Some(12), Some(6))
    );
    // The bounds in pixels are listed as first and last x, then first and last y. Fractions are
    // rounded up.
    let film = |more: &str| {
        format!(
            "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20 {more}\n\
             Camera \"perspective\" WorldBegin Shape \"sphere\""
        )
    };
    let crop = |more: &str| clean(&film(more)).render_defaults.crop;
    assert_eq!(crop(""), None);
    assert_eq!(crop("\"float cropwindow\" [.25 .75 .5 1]"), Some((8, 10, 15, 10)));
    assert_eq!(crop("\"integer pixelbounds\" [3 40 0 7]"), Some((3, 0, 27, 7)));
    let (scene, messages) = read(&film("\"float cropwindow\" [.5 .5 0 1]"));
    assert!(scene.is_none() && messages[0].contains("contains no pixels"), "{messages:?}");
}

#[test]
fn corpus_scenes_are_read() {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let root = std::env::var_os("DURER_CORPUS").map_or_else(default, Into::into).join("samples/pbrt");
    if !root.is_dir() {
        return println!("skipped: {} does not exist", root.display());
    }
    let mut count = 0;
    for set in std::fs::read_dir(root).unwrap().flatten().filter(|entry| entry.path().is_dir()) {
        for folder in std::fs::read_dir(set.path()).unwrap().flatten().filter(|entry| entry.path().is_dir()) {
            for file in std::fs::read_dir(folder.path()).unwrap().flatten().map(|entry| entry.path()) {
                if file.extension().is_some_and(|extension| extension == "pbrt") {
                    let (scene, messages) = read_in(&folder.path(), &std::fs::read_to_string(&file).unwrap());
                    assert!(scene.is_some(), "{}: {messages:#?}", file.display()); // prose: keep
                    count += 1;
                }
            }
        }
    }
    assert!(count > 8, "{count}");
}
