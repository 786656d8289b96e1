//! Tests that models are fully visible in every view and at every aspect ratio.

use super::super::Assets;
use super::*;
use crate::camera::{CameraBasis, CameraRules, CameraSample, Projection};
use crate::describe::FileName;
use crate::light::SpotLight;
use crate::math::Vec2;
use crate::math::random::Random;
use crate::scene::MatrixOp;
use crate::shape::{MeshData, TriangleMesh};
use std::sync::Arc;

const VIEWS: [PresetView; 10] = [
    PresetView::ThreeQuarter,
    PresetView::Front,
    PresetView::Back,
    PresetView::Left,
    PresetView::Right,
    PresetView::Top,
    PresetView::Bottom,
    PresetView::Iso,
    PresetView::IsoLeft,
    PresetView::IsoBack,
];

/// Returns a scene that consists of one transformed mesh with the given vertices.
fn scene(corners: Vec<Vec3>) -> Scene {
    let triangles = (0..corners.len() as u32).map(|i| [i; 3]).collect();
    let data = MeshData { positions: corners, triangles, ..MeshData::default() };
    let assets = Assets { meshes: [("m".to_string(), Arc::new(data))].into(), ..Assets::default() };
    let mesh = TriangleMesh { obj_file: FileName { path: "m".into(), span: Span::default() } };
    let inner = Object { node: ObjectKind::Mesh(mesh), material: None, span: Span::default() };
    let ops = vec![MatrixOp::Translate(Vec3::new(3.0, -2.0, 1.0)), MatrixOp::Scale(Vec3::new(1.0, 2.0, -0.5))];
    let object = Object { node: ObjectKind::Transform(ops, Box::new(inner)), material: None, span: Span::default() };
    Scene { root: Some(Group { objects: vec![object] }), assets, ..Scene::default() }
}

fn staged(mut scene: Scene, scene_defaults: &SceneDefaults) -> Scene {
    scene_defaults.complete(&mut scene, Axis::Y, false);
    scene
}

#[test]
fn every_view_sees_the_whole_and_fills_the_picture() {
    let mut random = Random(3);
    for round in 0..60 {
        let stretch = Vec3::new(random.between(0.1, 3.0), random.between(0.1, 3.0), random.between(0.1, 3.0));
        let corners = (0..12).map(|_| stretch * random.point() * [1e-3, 0.1, 1.0, 30.0, 1e4][round % 5]).collect();
        let up = [Axis::X, Axis::Y, Axis::Z][round % 3];
        for (view, aspect) in VIEWS.into_iter().flat_map(|view| [1.0, 16.0 / 9.0, 0.4].map(|aspect| (view, aspect))) {
            let scene_defaults =
                SceneDefaults { view: Some(view), up: Some(up), aspect: Some(aspect), ..SceneDefaults::default() };
            let scene = staged(scene(Vec::clone(&corners)), &scene_defaults);
            let camera = scene.camera.as_ref().unwrap();
            let frame = CameraBasis::of(camera, CameraRules::default());
            // The border of the picture, whose larger side runs from -1 to 1.
            let border = Vec2::new(aspect.min(1.0), (1.0 / aspect).min(1.0));
            let (mut most, mut low, mut high) = (0f32, Vec2::INFINITY, Vec2::NEG_INFINITY);
            points(&scene, &mut |p| {
                let mut projected = None;
                camera.project(&frame, p.as_vec3(), Vec2::splat(0.5), &mut |point| projected = Some(point / border));
                let point = projected.unwrap_or_else(|| panic!("{view:?} {aspect}: {p} is not seen"));
                most = most.max(point.abs().max_element());
                (low, high) = (low.min(point), high.max(point));
                // The eye must be outside the model.
                let ray = camera.ray(&frame, &CameraSample::at(point * border)).unwrap();
                assert!((p.as_vec3() - ray.origin).dot(ray.dir) > 0.0, "{view:?}");
            });
            assert!((0.8..0.9).contains(&most), "{view:?} {aspect}: {most}");
            assert!(
                (low + high).abs().max_element() < 0.12 || view == PresetView::ThreeQuarter,
                "{view:?} {low} {high}"
            );
        }
    }
}

#[test]
fn up_in_a_model_is_up_in_its_picture() {
    for (axis, up) in [(Axis::X, Vec3::X), (Axis::Y, Vec3::Y), (Axis::Z, Vec3::Z)] {
        for view in VIEWS.into_iter().filter(|view| !matches!(view, PresetView::Top | PresetView::Bottom)) {
            let scene_defaults = SceneDefaults { view: Some(view), up: Some(axis), ..SceneDefaults::default() };
            let scene = staged(scene(vec![Vec3::ZERO, Vec3::ONE]), &scene_defaults);
            let pose = scene.camera.as_ref().unwrap().pose();
            assert!(pose.up.dot(up) > 0.99 && pose.direction.dot(up) < 1e-6, "{axis:?} {view:?}");
        }
    }
}

#[test]
fn lights_of_a_model_get_dim_surroundings() {
    let lit = |light: Light, dark: bool, scene_defaults: &SceneDefaults| {
        let mut scene = scene(vec![Vec3::ZERO, Vec3::ONE]);
        scene.lights = Some(vec![Spanned { value: light, span: Span::default() }]);
        scene_defaults.complete(&mut scene, Axis::Y, dark);
        assert_eq!(scene.lights.unwrap().len(), 1);
        scene.background.color
    };
    let sun: Light = DirectionalLight { color: Vec3::new(0.2, 0.5, 0.1), ..DirectionalLight::default() }.into();
    let automatic = SceneDefaults::default();
    assert_eq!(lit(sun.clone(), false, &automatic), Vec3::splat(0.15));
    // The light is two units away from the centre of the model, in the direction behind its beam.
    let spot = SpotLight {
        position: Vec3::new(3.5, -1.0, 2.75),
        direction: Vec3::Z,
        candela: Some(std::f32::consts::PI * 8.0),
        ..SpotLight::default()
    };
    let found = lit(spot.into(), false, &automatic);
    assert!((found - Vec3::splat(0.6)).length() < 1e-5, "{found}");
    // Complete scenes, `--studio none` and measurements have only the light of the file.
    let none = SceneDefaults { lighting: Some(DefaultLighting::None), ..SceneDefaults::default() };
    let own = SceneDefaults { own_light: true, ..SceneDefaults::default() };
    for (dark, options) in [(true, &automatic), (false, &none), (false, &own)] {
        assert_eq!(lit(sun.clone(), dark, options), Vec3::ZERO);
    }
}

#[test]
fn ground_is_added_on_request() {
    let environment = Some("sky.hdr".into());
    let surrounded = SceneDefaults { environment, ..SceneDefaults::default() };
    let objects =
        |options: &SceneDefaults| staged(scene(vec![Vec3::ZERO, Vec3::ONE]), options).root.unwrap().objects.len();
    assert_eq!(objects(&surrounded), 1);
    assert_eq!(objects(&SceneDefaults { ground: true, ..surrounded }), 2);
    // The studio has a ground of its own.
    assert_eq!(objects(&SceneDefaults { ground: true, ..SceneDefaults::default() }), 2);
}

#[test]
fn points_flat_and_empty_models_have_cameras() {
    for corners in [vec![], vec![Vec3::splat(5.0)], vec![Vec3::X, -Vec3::X], vec![Vec3::X, Vec3::Z, -Vec3::X]] {
        for view in VIEWS {
            let scene_defaults = SceneDefaults { view: Some(view), ..SceneDefaults::default() };
            let scene = staged(scene(corners.clone()), &scene_defaults);
            let camera = scene.camera.as_ref().unwrap();
            let pose = camera.pose();
            assert!(pose.center.is_finite() && pose.direction.is_finite() && camera.validate().is_ok());
            let frame = CameraBasis::of(camera, CameraRules::default());
            points(&scene, &mut |p| {
                let mut projected = false;
                camera.project(&frame, p.as_vec3(), Vec2::splat(0.5), &mut |at| {
                    projected |= at.abs().max_element() <= 1.0
                });
                assert!(projected, "{view:?} {corners:?} {p}");
            });
        }
    }
}

#[test]
fn staging_adds_only_missing_parts() {
    let plain = staged(scene(vec![Vec3::ZERO, Vec3::ONE]), &SceneDefaults::default());
    assert_eq!((plain.lights.as_ref().unwrap().len(), plain.materials.len()), (2, 2));
    // The ground touches the lowest point, which the transform moves to y = -2.
    let Some(ObjectKind::Primitive(crate::shape::Primitive::Plane(ground))) =
        plain.root.as_ref().map(|root| &root.objects[1].node)
    else {
        panic!("a ground must be added");
    };
    assert_eq!((ground.normal, ground.offset), (Vec3::Y, -2.0));
    let mut complete = scene(vec![Vec3::ZERO, Vec3::ONE]);
    complete.camera = Some(PerspectiveCamera::default().into());
    let light = Light::from(DirectionalLight::default());
    complete.lights = Some(vec![Spanned { value: light, span: Span::default() }]);
    let same = staged(complete.clone(), &SceneDefaults::default());
    assert_eq!((&same.camera, &same.lights), (&complete.camera, &complete.lights));
    assert_eq!(same.root.unwrap().objects.len(), 1);
    // A scene with its own light has dim surroundings. In a scene without any light, the background
    // is brighter, so that something is visible.
    assert_eq!(same.background.color, Vec3::splat(SURROUNDINGS));
    // A background that the file sets stays, even if it has the default colour.
    let mut written = complete.clone();
    written.background_span = Span { file: 0, start: 1, end: 2 };
    assert_eq!(staged(written, &SceneDefaults::default()).background, Background::default());
    let none = SceneDefaults { lighting: Some(DefaultLighting::None), ..SceneDefaults::default() };
    assert_eq!(staged(scene(vec![Vec3::ZERO, Vec3::ONE]), &none).background, Background::default());
    let requested = SceneDefaults {
        view: Some(PresetView::Iso),
        lighting: Some(DefaultLighting::None),
        ..SceneDefaults::default()
    };
    let other = staged(complete.clone(), &requested);
    assert!(other.camera != complete.camera && other.lights == complete.lights);
}

#[test]
fn camera_of_a_model_without_lights_shows_all_of_it() {
    let with_eye = |center: Vec3| {
        let mut scene = scene(vec![Vec3::ZERO, Vec3::ONE]);
        let camera =
            PerspectiveCamera { center, direction: Vec3::new(0.0, -0.2, -1.0), ..PerspectiveCamera::default() };
        scene.camera = Some(camera.into());
        scene
    };
    let plain = SceneDefaults::default();
    let far = with_eye(Vec3::new(9.0, 3.0, 9.0));
    let moved = staged(far.clone(), &plain);
    let (before, after) = (far.camera.as_ref().unwrap().pose(), moved.camera.as_ref().unwrap().pose());
    assert!((before.direction.normalize() - after.direction.normalize()).length() < 1e-6);
    assert_ne!(before.center, after.center);
    // The ground is added too.
    assert_eq!(moved.root.as_ref().unwrap().objects.len(), 2);
    let named = SceneDefaults { camera: Some("Main".into()), ..SceneDefaults::default() };
    assert_eq!(staged(far.clone(), &named).camera, far.camera);
    // A camera inside the model, for example in a room, stays.
    let corner = scene(vec![Vec3::ZERO, Vec3::ONE]);
    let mut middle = Vec3::ZERO;
    crate::scene::extent::points(&corner, &mut |p| middle += 0.5 * p.as_vec3());
    let inside = with_eye(middle);
    assert_eq!(staged(inside.clone(), &plain).camera, inside.camera);
}
