//! Tests of animations, skins and morph targets.

use super::{corpus, read, staged};
use durer_scene::math::Vec3;
use durer_scene::scene::{Scene, SceneDefaults};

#[test]
fn joints_morph_targets_and_key_frames_move_vertices() {
    let Some(root) = corpus("khronos") else { return };
    let at = |name: &str, moment| {
        let path = root.join(name);
        let file = path.file_name().unwrap().to_string_lossy().into_owned();
        let (scene, findings) = read(&std::fs::read(&path).unwrap(), path.parent().unwrap(), &file, moment);
        scene.unwrap_or_else(|| panic!("{findings:?}"))
    };
    let positions = |scene: &Scene| scene.assets.meshes.values().next().unwrap().positions.clone();
    // The morph targets move the tip of the triangle by (-1, 1, 0) and by (1, 1, 0). At rest and at
    // the start of the animation, both weights are 0.
    let rest = positions(&at("SimpleMorph/glTF/SimpleMorph.gltf", Some(0.0)));
    let moved = positions(&at("SimpleMorph/glTF/SimpleMorph.gltf", Some(2.0)));
    assert_eq!(rest, [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 0.5, 0.0)]);
    assert!(moved[2].y > 1.0 && moved[..2] == rest[..2], "{moved:?}");
    // The animation makes one turn around z in one second. After a quarter of the turn, the
    // triangle has rotated by 90 degrees.
    let turned = at("AnimatedTriangle/glTF/AnimatedTriangle.gltf", Some(0.25));
    let mut reached = Vec::new();
    durer_scene::scene::extent::points(&turned, &mut |p| reached.push(p.as_vec3()));
    assert!(reached.iter().any(|p| p.abs_diff_eq(Vec3::new(0.0, 1.0, 0.0), 1e-5)), "{reached:?}");
    assert!(reached.iter().any(|p| p.abs_diff_eq(Vec3::new(-1.0, 0.0, 0.0), 1e-5)), "{reached:?}");
    // A rotating joint moves the upper end of the strip, but not the lower end.
    let bent = positions(&at("SimpleSkin/glTF/SimpleSkin.gltf", Some(1.0)));
    let straight = positions(&at("SimpleSkin/glTF/SimpleSkin.gltf", Some(0.0)));
    assert!(bent[0].abs_diff_eq(straight[0], 1e-6) && !bent[9].abs_diff_eq(straight[9], 0.1), "{bent:?} {straight:?}");
}

#[test]
fn animations_are_chosen_by_name_or_number() {
    let Some(root) = corpus("khronos") else { return };
    let folder = root.join("Fox/glTF-Binary");
    let bytes = std::fs::read(folder.join("Fox.glb")).unwrap();
    let fox = |animation: Option<&str>, animation_time: Option<f32>| {
        let animation = animation.map(String::from);
        let defaults = SceneDefaults { animation, animation_time, ..SceneDefaults::default() };
        let (scene, findings) = staged(&bytes, &folder, "Fox.glb", &defaults);
        let message = findings.into_iter().map(|found| found.1).collect::<Vec<_>>().join("\n");
        scene
            .map(|scene| (scene.assets.meshes.values().next().unwrap().positions.clone(), scene.animations))
            .ok_or(message)
    };
    let (first, all) = fox(None, Some(0.3)).unwrap();
    let names: Vec<&str> = all.iter().map(|(name, _)| &**name).collect();
    assert_eq!(names, ["Survey", "Walk", "Run"]);
    assert!(all.iter().all(|(_, seconds)| *seconds > 0.5 && *seconds < 4.0), "{all:?}");
    let run = fox(Some("Run"), Some(0.3)).unwrap().0;
    assert!(run != first && fox(Some("2"), Some(0.3)).unwrap().0 == run);
    assert_eq!(fox(Some("Survey"), Some(0.3)).unwrap().0, first);
    assert!(fox(Some("Run"), None).unwrap().0 != run);
    assert!(fox(Some("Runn"), None).unwrap_err().contains("did you mean `Run`?"));
}
