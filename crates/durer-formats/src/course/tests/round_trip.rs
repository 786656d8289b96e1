//! Tests that a scene is unchanged after it is written as text and read back.

use super::corpus::scenes;
use super::*;
use crate::course::random::SceneGenerator;

/// Compares all values bit for bit except for spans, because `PartialEq` treats 0 and -0 as equal.
#[track_caller]
fn same(a: &Scene, b: &Scene, context: &str) {
    assert_eq!(a, b, "{context}");
    let json = |scene: &Scene| serde_json::to_string(scene).unwrap();
    assert_eq!(json(a), json(b), "{context}");
}

#[test]
fn course_scenes_round_trip_in_every_dialect() {
    for (path, dialect) in scenes() {
        let scene = read_as(&std::fs::read(&path).unwrap(), dialect, false).0.unwrap();
        for target in Dialect::ALL {
            let text = write(&scene, target);
            let (again, findings) = read_as(text.as_bytes(), target, false);
            let context = format!("{} as {}: {findings:?}", path.display(), target.name());
            let mut again = again.expect(&context);
            // A scene with nodes cannot express that there is no section for lights.
            if target == Dialect::F23 && scene.lights.is_none() {
                assert_eq!(again.lights.take(), Some(Vec::new()));
            }
            same(&scene, &again, &context);
            // Text in the dialect of the scene causes no diagnostics, even in strict mode.
            if target == dialect {
                assert_eq!(read_as(text.as_bytes(), target, true).1, [""; 0], "{context}\n{text}");
            }
        }
        let json = serde_json::to_string(&scene).unwrap();
        same(&scene, &serde_json::from_str(&json).unwrap(), "JSON");
    }
}

#[test]
fn random_scenes_round_trip_in_every_dialect() {
    let mut random = SceneGenerator::seeded(1);
    for i in 0..2000 {
        for dialect in Dialect::ALL {
            let scene = random.scene(dialect);
            let text = write(&scene, dialect);
            let (again, findings) = read_as(text.as_bytes(), dialect, false);
            let context = format!("{i} {}: {findings:?}\n{text}", dialect.name());
            same(&scene, &again.expect(&context), &context);
        }
    }
}

#[test]
fn random_scenes_round_trip_as_json() {
    let mut random = SceneGenerator::seeded(2);
    for _ in 0..3000 {
        // JSON contains only hashes of meshes and pictures, so reading it back cannot restore them.
        let scene = Scene { assets: Default::default(), ..random.scene(Dialect::Durer) };
        let json = serde_json::to_string(&scene).unwrap();
        let again: Scene = serde_json::from_str(&json).unwrap();
        same(&scene, &again, &json);
    }
}

#[test]
fn scene_is_written_in_another_dialect_without_defaults() {
    let scene = clean(SMALL[3].1, Dialect::F23);
    let text = write(&scene, Dialect::F12a5);
    // Default values for which the dialect of 2012 has no word are omitted.
    assert!(!text.contains("reflectiveColor") && !text.contains("bump"), "{text}");
    assert_eq!(read_as(text.as_bytes(), Dialect::F12a5, true).1, [""; 0], "{text}");
    let text = write(&clean(SMALL[0].1, Dialect::F04), Dialect::F23);
    // The grammar of nodes has no word for Blinn's exponent, so a word of other years is used.
    assert!(text.contains("exponent 20"), "{text}");
}
