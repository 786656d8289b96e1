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
fn lost_brace_gives_an_error_at_its_effect_and_at_the_end() {
    for (from, to, places) in [
        // The `}` of the transform closes the mesh instead, so the next group is inside the
        // transform.
        ("cube.obj\n        }\n", "cube.obj\n", ["47:5", "60:1"]),
        ("diffuseColor 1 0 0", "diffuseColor 1 0 0 }", ["26:9", "28:5"]),
    ] {
        let text = SCENE.replacen(from, to, 1);
        let (_, findings) = read_as(text.as_bytes(), Dialect::F12a4, false);
        assert_eq!(findings.len(), 2, "{findings:#?}");
        assert!(findings.iter().zip(places).all(|(f, place)| f.starts_with(&format!("{place} "))), "{findings:#?}");
    }
}
