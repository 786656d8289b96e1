//! Tests of `include`, named materials, `define` and `use`.

use super::*;
use crate::testing::{folder, read_in};
use durer_scene::material::Pattern;
use durer_scene::scene::{Material, Object, ObjectKind};

const HEAD: &str = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 30 } Background { color 0 0 0 }\n";
const MATERIALS: &str = "Materials { PhongMaterial red { diffuseColor 1 0 0 } PhongMaterial blue { diffuseColor 0 0 1 } Mix both { materialIndex blue materialIndex red } }\n";

fn ours(text: &str) -> Scene {
    clean(&format!("{HEAD}{MATERIALS}{text}"), Dialect::Durer)
}

fn refused(text: &str) -> Vec<String> {
    let (scene, found) = read_as(format!("{HEAD}{MATERIALS}{text}").as_bytes(), Dialect::Durer, false);
    assert!(scene.is_none(), "{text}");
    found
}

/// Collects the materials of all shapes in order.
fn materials(object: &Object, found: &mut Vec<Option<u32>>) {
    match &object.node {
        ObjectKind::Group(group) => group.objects.iter().for_each(|object| materials(object, found)),
        ObjectKind::Transform(_, inner) => materials(inner, found),
        ObjectKind::Solid(_, parts) => parts.iter().for_each(|object| materials(object, found)),
        _ => found.push(object.material),
    }
}

#[test]
fn material_names_are_equivalent_to_numbers() {
    let named = ours(
        "Group { MaterialIndex blue Sphere { center 0 0 0 radius 1 } MaterialIndex both Sphere { center 0 0 0 radius 1 } }",
    );
    let numbered = ours(
        "Group { MaterialIndex 1 Sphere { center 0 0 0 radius 1 } MaterialIndex 2 Sphere { center 0 0 0 radius 1 } }",
    );
    assert_eq!(named, numbered);
    let Material::Solid(mix, _) = &named.materials[2].value else { panic!() };
    assert_eq!(mix.materials(), [1, 0]);
}

#[test]
fn names_of_fields_can_be_names() {
    for name in ["base", "top", "dome", "radius"] {
        let materials = MATERIALS.replace("red", name);
        let text = format!("{HEAD}{materials}Group {{ MaterialIndex {name} Sphere {{ center 0 0 0 radius 1 }} }}");
        let numbered = format!("{HEAD}{MATERIALS}Group {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 1 }} }}");
        assert_eq!(clean(&text, Dialect::Durer), clean(&numbered, Dialect::Durer), "{name}");
        let defined =
            format!("define {name} Sphere {{ center 0 0 0 radius 1 }} Group {{ MaterialIndex 0 use {name} }}");
        assert_eq!(ours(&defined).root.unwrap().objects.len(), 1, "{name}");
    }
}

#[test]
fn each_use_copies_the_defined_object() {
    let ball = "Sphere { center 1 2 3 radius 1 }";
    let scene = ours(&format!(
        "define ball {ball} define two Group {{ use ball MaterialIndex 1 Transform {{ Translate 1 0 0 use ball }} }}\n\
         Group {{ MaterialIndex red use two MaterialIndex both Union {{ use two use ball }} define more use ball use more }}"
    ));
    let mut found = Vec::new();
    scene.root.iter().flat_map(|root| &root.objects).for_each(|object| materials(object, &mut found));
    // A use has the same effect as writing the object out.
    assert_eq!(found, [Some(0), Some(1), Some(2), Some(1), Some(2), Some(2)]);
    // A use gives the same scene as writing the object out.
    let used =
        ours(&format!("define ball {ball} Group {{ MaterialIndex 0 Transform {{ Translate 1 0 0 use ball }} }}"));
    let plain = ours(&format!("Group {{ MaterialIndex 0 Transform {{ Translate 1 0 0 Group {{ {ball} }} }} }}"));
    assert_eq!(used, plain);
}

#[test]
fn wrong_names_are_errors() {
    for (text, expected) in [
        (
            "Group { MaterialIndex rad Sphere { center 0 0 0 radius 1 } }",
            "3:23 error: no material `rad` is defined before this point [rad] (did you mean `red`?)",
        ),
        (
            "Group { use ball }",
            "3:13 error: nothing is defined as `ball` before this point [ball] (write `define NAME` and an object first, outside the object that uses it)",
        ),
        ("define a Sphere { center 0 0 0 radius 1 } define a use a", "3:50 error: `a` is defined already [a]"),
        (
            "define Sphere Sphere { center 0 0 0 radius 1 }",
            "3:8 error: `Sphere` cannot be a name: it is a word of the language [Sphere]",
        ),
        (
            "define use Sphere { center 0 0 0 radius 1 }",
            "3:8 error: `use` cannot be a name: it is a word of the language [use]",
        ),
        ("define 3 Sphere { center 0 0 0 radius 1 }", "3:8 error: `3` cannot be a name: it is a number [3]"),
        // Cycles are impossible because an object cannot be used inside its own definition.
        (
            "define a Group { use a }",
            "3:22 error: nothing is defined as `a` before this point [a] (write `define NAME` and an object first, outside the object that uses it)",
        ),
        (
            "include light.txt",
            "3:1 error: a scene that is not stored in a folder cannot include files [include light.txt]",
        ),
        ("include", "3:1 error: `include` needs the name of a file [include] (for example `include light.txt`)"),
    ] {
        assert_eq!(refused(text)[0], expected, "{text}");
    }
    // Each definition doubles the number of objects. The reader must reject this scene before it
    // allocates memory for it.
    let mut text = "define a0 Sphere { center 0 0 0 radius 1 }\n".to_string();
    for i in 1..64 {
        text += &format!("define a{i} Group {{ use a{} use a{} }}\n", i - 1, i - 1);
    }
    assert!(refused(&text)[0].contains("more than 1048576 objects"), "{:?}", refused(&text));
    // The dialects of other years do not have these words.
    let (_, found) = read_as(b"Group { numObjects 1 use ball }", Dialect::F04, true);
    assert!(!found.is_empty());
}

#[test]
fn included_file_replaces_its_include() {
    let files: [(&str, &[u8]); 9] = [
        ("paints.txt", MATERIALS.as_bytes()),
        ("parts/ball.txt", b"# a ball\nSphere { center 0 0 0 radius 1 }"),
        ("parts/both.txt", b"include parts/ball.txt include parts/ball.txt"),
        ("a.txt", b"include b.txt"),
        ("b.txt", b"\n  include a.txt"),
        ("open.txt", b"Group { MaterialIndex 0"),
        ("close.txt", b"Sphere { center 0 0 0 radius 1 } }"),
        ("wrong.txt", b"Sphere {\n  center 0 0 0 radius x }"),
        ("utf16.txt", b"\xff\xfeS\0p\0"),
    ];
    let files = folder(&files);
    let (scene, expected) = read_in(
        files.path(),
        "s.txt",
        &format!("{HEAD}include paints.txt Group {{ MaterialIndex red include parts/both.txt }}"),
    );
    assert_eq!(expected, [""; 0]);
    assert_eq!(scene.unwrap().root.unwrap().objects.len(), 2);
    for (text, expected) in [
        ("Group { include a.txt }", "b.txt:2:3 error `a.txt` includes itself"),
        ("Group { include open.txt }", "open.txt:1:7 error this block is not closed in its file"),
        ("Group { include close.txt }", "close.txt:1:34 error this `}` has no matching `{` in its file"),
        ("Group { include wrong.txt }", "wrong.txt:2:23 error "),
        ("Group { include missing.txt }", "s.txt:2:17 error the file `missing.txt` does not exist"),
        ("Group { include ../s.txt }", "s.txt:2:17 error "),
        ("Group { include utf16.txt }", "utf16.txt:1:1 error this file is UTF-16"),
    ] {
        let (scene, found) = read_in(files.path(), "s.txt", &format!("{HEAD}{text}"));
        assert!(scene.is_none(), "{text}");
        assert!(found[0].starts_with(expected), "{text}: {found:?}");
    }
    // A scene that includes itself is read only once, so nothing in it is repeated.
    let text = format!("{HEAD}Group {{ include loop.txt }}");
    std::fs::write(files.path().join("s.txt"), &text).unwrap();
    std::fs::write(files.path().join("loop.txt"), "include s.txt").unwrap();
    let (_, found) = read_in(files.path(), "s.txt", &text);
    assert!(!found.iter().any(|found| found.contains("more than one")), "{found:?}");
    assert!(found[0].starts_with("loop.txt:1:1 error `s.txt` includes itself"), "{found:?}");
}
