//! Errors for options of models that are given with a file to which they do not apply.

use durer_diag::{Diagnostic, Diagnostics};
use durer_formats::scene::scene_format_for;
use durer_scene::scene::SceneDefaults;

const PLACE: &str = "place the camera with `--eye X,Y,Z`, `--target X,Y,Z` and `--fov DEGREES`";

/// Reports each option of models that is given with a file in the scene language, which has its own
/// camera and lights.
pub(super) fn refuse_for_scene(options: &SceneDefaults, diagnostics: &mut Diagnostics) {
    let rows = [
        (options.view.is_some(), "--view", PLACE),
        (options.fit, "--fit", PLACE),
        (options.camera.is_some(), "--camera", PLACE),
        (options.view_file.is_some(), "--view-file", PLACE),
        (options.up.is_some(), "--up", "a scene file has no up axis; turn its objects with `Transform`, or the camera"),
        (options.lighting.is_some(), "--studio", "change `Lights` and `Background` in the scene file"),
        (options.environment.is_some(), "--environment", "write `environment FILE` in the scene's `Background`"),
        (options.ground, "--add-ground", "add a `Plane` to the scene file"),
        (options.variant.is_some(), "--variant", "a scene file has no variants; change `Materials` in the file"),
        (options.animation.is_some(), "--animation", "a scene file has no animation; write one file for each frame"),
        (options.animation_time.is_some(), "--at", "a scene file has no animation; write one file for each frame"),
    ];
    for (_, name, help) in rows.iter().filter(|(is_given, ..)| *is_given) {
        let message = format!("`{name}` applies to models, not to files in the scene language");
        diagnostics.push(Diagnostic::error(message).code(CODE).help(*help));
    }
}

/// Reports each option that is given with a model in whose format it has no meaning.
pub(super) fn refuse_for_model(format: &str, options: &SceneDefaults, diagnostics: &mut Diagnostics) {
    let rows = [
        (options.camera.is_some(), "--camera", "cameras to choose from", HAVE_CAMERAS),
        (options.variant.is_some(), "--variant", "variants", &["gltf", "usd"]),
        (options.animation.is_some(), "--animation", "animations to choose from", &["gltf"]),
        (options.animation_time.is_some(), "--at", "animations", &["gltf", "usd"]),
    ];
    for (_, name, what, having) in rows.iter().filter(|(is_given, ..)| *is_given) {
        let has = |ending: &&str| scene_format_for(&format!("model.{ending}")).is_some_and(|row| row.name == format);
        if !having.iter().any(has) {
            let help = if *name == "--camera" { PLACE } else { "leave the option out" };
            let message = format!("`{name}` has no effect, because {format} files have no {what}");
            diagnostics.push(Diagnostic::error(message).code(CODE).help(help));
        }
    }
}

/// Code of the errors.
const CODE: &str = "model-option";

/// Extensions of the formats in which a file can have several cameras.
const HAVE_CAMERAS: &[&str] = &["gltf", "usd", "dae", "xml", "rif"];

#[cfg(test)]
mod tests {
    use crate::{LoadOptions, load_text};
    use durer_diag::{Diagnostics, Files};
    use durer_scene::scene::{Axis, DefaultLighting, PresetView, SceneDefaults};
    use std::path::Path;

    fn errors(name: &str, text: &str, scene_defaults: SceneDefaults) -> Vec<(String, String)> {
        let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
        let options = LoadOptions { scene_defaults, ..LoadOptions::default() };
        let loaded = load_text(Path::new(name), text.as_bytes().into(), &options, &mut files, &mut diagnostics);
        assert_eq!(loaded.is_some(), !diagnostics.has_errors());
        diagnostics.iter().map(|d| (d.message.clone(), d.help.clone().unwrap_or_default())).collect()
    }

    #[test]
    fn model_options_are_errors_for_scene_files() {
        let scene = "Background { color 0 0 0 } Group { Sphere { radius 1 } }";
        let none = SceneDefaults::default;
        for (options, option, help) in [
            (SceneDefaults { view: Some(PresetView::Top), ..none() }, "`--view`", "--eye"),
            (SceneDefaults { fit: true, ..none() }, "`--fit`", "--eye"),
            (SceneDefaults { camera: Some("3".into()), ..none() }, "`--camera`", "--target"),
            (SceneDefaults { view_file: Some("a.vf".into()), ..none() }, "`--view-file`", "--eye"),
            (SceneDefaults { up: Some(Axis::Z), ..none() }, "`--up`", "Transform"),
            (SceneDefaults { lighting: Some(DefaultLighting::Sun), ..none() }, "`--studio`", "`Lights`"),
            (SceneDefaults { environment: Some("a.hdr".into()), ..none() }, "`--environment`", "`environment FILE`"),
            (SceneDefaults { variant: Some("x".into()), ..none() }, "`--variant`", "Materials"),
            (SceneDefaults { animation_time: Some(3.0), ..none() }, "`--at`", "animation"),
            (SceneDefaults { animation: Some("x".into()), ..none() }, "`--animation`", "one file for each"),
        ] {
            let found = errors("scene.txt", scene, options);
            let [(message, hint)] = &found[..] else { panic!("{option}: {found:?}") };
            assert!(message.contains(option) && hint.contains(help), "{message}: {hint}");
        }
        assert!(errors("scene.txt", scene, none()).iter().all(|(message, _)| !message.contains("to models")));
    }

    #[test]
    fn models_refuse_options_that_their_format_does_not_have() {
        let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let none = SceneDefaults::default;
        for (options, message) in [
            (SceneDefaults { camera: Some("3".into()), ..none() }, "have no cameras"),
            (SceneDefaults { variant: Some("x".into()), ..none() }, "have no variants"),
            (SceneDefaults { animation_time: Some(1.0), ..none() }, "have no animations"),
        ] {
            let found = errors("mesh.obj", mesh, options);
            assert!(found.len() == 1 && found[0].0.contains(message), "{found:?}");
        }
        assert!(errors("mesh.obj", mesh, SceneDefaults { view: Some(PresetView::Top), ..none() }).is_empty());
    }
}
