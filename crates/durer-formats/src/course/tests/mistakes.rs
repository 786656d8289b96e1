//! Tests of typical mistakes made by students. Each mistake causes one error at the position of the
//! mistake.

use super::*;

const SCENE: &str = "PerspectiveCamera {
    center 0 0 10
    direction 0 0 -1
    up 0 1 0
    angle 30
}
Lights {
    numLights 2
    DirectionalLight {
        direction -1 -1 -1
        color 1 1 1
    }
    PointLight {
        position 0 5 0
        color .5 .5 .5
    }
}
Background {
    color 0 0 0
    ambientLight .1 .1 .1
}
Materials {
    numMaterials 2
    PhongMaterial {
        diffuseColor 1 0 0
        specularColor 1 1 1
        texture wood.bmp
    }
    PhongMaterial {
        diffuseColor 0 1 0
    }
}
Group {
    numObjects 4
    MaterialIndex 0
    Sphere {
        center 0 0 0
        radius 1
    }
    MaterialIndex 1
    Transform {
        Translate 1 0 0
        YRotate 45
        TriangleMesh {
            obj_file cube.obj
        }
    }
    Group {
        numObjects 1
        Plane {
            normal 0 1 0
            offset -1
        }
    }
    Triangle {
        vertex0 0 0 0
        vertex1 1 0 0
        vertex2 0 1 0
    }
}
";

#[test]
fn one_mistake_gives_one_error() {
    clean(SCENE, Dialect::F12a4);
    let mut wrong = Vec::new();
    for (from, to, place) in [
        // Misspelt words.
        ("PerspectiveCamera", "PerspectivCamera", "1:1"),
        ("direction 0", "dirction 0", "3:5"),
        ("numLights", "NumLight", "8:5"),
        ("DirectionalLight", "DirectionLight", "9:5"),
        ("ambientLight", "ambient", "20:5"),
        ("diffuseColor 1 0 0", "diffuse_Colour 1 0 0", "25:9"),
        ("texture", "textur", "27:9"),
        ("numObjects 4", "numObject 4", "34:5"),
        ("MaterialIndex 1", "materialIndex 1", "40:5"),
        ("Sphere", "Ball", "36:5"),
        ("Translate", "Translation", "42:9"),
        ("YRotate", "RotateY", "43:9"),
        ("TriangleMesh", "Mesh", "44:9"),
        ("obj_file", "file", "45:13"),
        ("vertex1", "vertex4", "57:9"),
        // Wrong values.
        ("radius 1", "radius one", "38:16"),
        ("radius 1", "radius", "39:5"),
        ("radius 1", "radius 0", "38:16"),
        ("radius 1", "radius 1cm", "38:16"),
        ("center 0 0 0", "center 0 0", "38:9"),
        ("center 0 0 0", "center 0,0,0", "37:16"),
        ("center 0 0 0", "center 0, 0, 0", "37:16"),
        ("center 0 0 0", "center (0, 0, 0)", "37:16"),
        ("center 0 0 0", "center 0 0 0 0", "37:22"),
        ("Translate 1 0 0", "Translate 1 0", "43:9"),
        ("Translate 1 0 0", "Translate (1 0 0)", "42:19"),
        ("Translate 1 0 0", "Translate 1 0 0 0", "42:25"),
        ("MaterialIndex 1", "MaterialIndex one", "40:19"),
        ("numObjects 4", "numObjects four", "34:16"),
        ("numObjects 4", "numObjects 4.0", "34:16"),
        ("numObjects 4", "numObjects 5", "34:5"),
        ("numObjects 4", "numObjects 3", "34:5"),
        ("numObjects 1", "numObjects 2", "49:9"),
        ("numLights 2", "numLights 1", "8:5"),
        ("numMaterials 2", "numMaterials 3", "23:5"),
        ("texture wood.bmp", "texture my wood.bmp", "27:20"),
        ("obj_file cube.obj", "obj_file", "46:9"),
        // Missing and superfluous braces.
        ("Sphere {", "Sphere", "37:9"),
        ("Lights {", "Lights", "8:5"),
        ("Group {\n    numObjects 4", "Group\n    numObjects 4", "34:5"),
        ("Transform {", "Transform", "42:9"),
        ("angle 30\n}", "angle 30", "6:1"),
        ("color 1 1 1\n    }", "color 1 1 1", "12:5"),
        ("radius 1\n    }", "radius 1", "39:5"),
        ("vertex2 0 1 0\n    }", "vertex2 0 1 0", "60:1"),
        ("cube.obj\n        }\n", "cube.obj\n", "47:5"),
        ("color 1 1 1\n    }", "color 1 1 1\n    } }", "12:7"),
        ("radius 1\n    }", "radius 1\n    } }", "39:7"),
        ("angle 30\n}", "angle 30\n} }", "6:3"),
        ("vertex2 0 1 0\n    }", "vertex2 0 1 0\n    } }", "60:1"),
        // Words that are in the wrong place.
        ("Transform {", "Transform {\n MaterialIndex 0", "42:2"),
        ("radius 1", "radius 1 MaterialIndex 0", "38:18"),
        ("    Triangle {", "}\n    Triangle {", "55:1"),
        ("Sphere {", "Translate 1 2 3\n    Sphere {", "36:5"),
        ("YRotate 45", "Rotate 0 1 0 45", "43:9"),
        ("YRotate 45", "Rotate { 0 1 0 }", "43:24"),
        ("YRotate 45", "Rotate { 0 1 0 45", "44:9"),
        ("YRotate 45", "Scale 1 0 1", "43:9"),
    ] {
        let text = SCENE.replacen(from, to, 1);
        assert_ne!(text, SCENE, "{from}");
        let (_, findings) = read_as(text.as_bytes(), Dialect::F12a4, false);
        let errors: Vec<String> = findings.into_iter().filter(|f| f.contains(" error: ")).collect();
        println!("{from} -> {to}: {errors:?}");
        if errors.len() != 1 || !errors[0].starts_with(&format!("{place} ")) {
            wrong.push((from, to, place, errors));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn two_mistakes_give_two_errors() {
    let text = SCENE.replace("ambientLight", "ambient").replace("radius 1", "radius -1");
    assert_eq!(read_as(text.as_bytes(), Dialect::F12a4, false).1.len(), 2);
    let text = SCENE.replace("numLights 2", "numLights 3").replace("numObjects 4", "numObjects 5");
    assert_eq!(read_as(text.as_bytes(), Dialect::F12a4, false).1.len(), 2);
    let text = SCENE.replace("specularColor 1", "specColour 1").replace("diffuseColor 0", "diffColour 0");
    assert_eq!(read_as(text.as_bytes(), Dialect::F12a4, false).1.len(), 2);
}

#[test]
fn superfluous_brace_gives_an_error_at_its_effect_and_at_the_end() {
    let text = SCENE.replacen("diffuseColor 1 0 0", "diffuseColor 1 0 0 }", 1);
    let (_, findings) = read_as(text.as_bytes(), Dialect::F12a4, false);
    assert!(
        findings.len() == 2 && findings[0].starts_with("26:9 ") && findings[1].starts_with("28:5 "),
        "{findings:#?}"
    );
}

/// Returns the error codes of a text, and the text after all fixes have been applied.
fn fixed(text: &str) -> (Vec<&'static str>, String) {
    let mut diagnostics = Diagnostics::default();
    let options = ReadOptions { dialect: Dialect::F12a4, strict: false, compat: 0 };
    read(text.as_bytes(), 0, options, &mut diagnostics);
    let mut text = text.to_string();
    for edit in diagnostics.iter().flat_map(|diagnostic| &diagnostic.fix) {
        text.replace_range(edit.span.start as usize..edit.span.end as usize, &edit.text);
    }
    (diagnostics.iter().map(|diagnostic| diagnostic.code).collect(), text)
}

#[test]
fn missing_brace_of_a_transform_is_added_before_the_next_object() {
    for from in ["            obj_file cube.obj\n        }\n    }\n", "            obj_file cube.obj\n        }\n"] {
        let text = SCENE.replacen(from, from.strip_suffix("    }\n").unwrap(), 1);
        assert_ne!(text, SCENE);
        let (codes, text) = fixed(&text);
        assert_eq!(codes, ["unclosed-block"], "{text}");
        clean(&text, Dialect::F12a4);
    }
}

#[test]
fn braces_are_added_at_the_end_only_if_there_is_no_other_error() {
    let cut = SCENE.strip_suffix("    }\n}\n").unwrap();
    let (codes, text) = fixed(cut);
    assert_eq!(codes, ["unclosed-block"]);
    clean(&text, Dialect::F12a4);
    let wrong = cut.replace("radius 1", "radius -1");
    let (codes, text) = fixed(&wrong);
    assert_eq!((codes.len(), text.as_str()), (2, cut));
}
