//! Tests of the parts of the public API that its examples do not cover.

use durer::prelude::*;
use durer::render::{RenderError, render};

#[test]
fn mesh_files_are_read_or_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n").unwrap();
    let error = durer::open_mesh(&path).unwrap_err().to_string();
    assert!(error.contains("bad.obj:3:"), "{error}");
    assert!(matches!(durer::open_mesh(folder.path().join("none.ply")), Err(Error::Source(_))));
    assert!(matches!(durer::open_mesh(folder.path()), Err(Error::Source(_))));
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    assert_eq!(durer::open_mesh(&path).unwrap().triangles, [[0, 1, 2]]);
}

fn spheres() -> CompiledScene {
    let mut scene = Scene::builder();
    scene.camera(PerspectiveCamera::look_at(vec3(0.0, 0.0, 6.0), Vec3::ZERO, 40.0));
    scene.background(Background { color: rgb(0.4, 0.5, 0.6), ..Default::default() });
    let layers = scene.material(PrincipledMaterial::default());
    scene.add(Sphere::default()).material(layers);
    scene.build().map_err(Error::from).and_then(Scene::compile).unwrap()
}

#[test]
fn passes_render_the_same_picture_as_one_render() {
    let world = spheres();
    for options in [
        RenderJob::for_scene(&world).size((40, 24)).samples(37_u32),
        RenderJob::for_scene(&world).size((40, 24)).samples(64_u32).noise_threshold(0.02),
        RenderJob::for_scene(&world).size((40, 24)).samples(64_u32).adaptive(true),
    ] {
        let mut passes = Renderer::new(&world, options.clone()).unwrap();
        let samples: Vec<u32> = passes.by_ref().map(|progress| progress.unwrap().samples).collect();
        assert!(samples.is_sorted() && samples.last() == options.get("samples").and_then(|n| n.parse().ok()).as_ref());
        let whole = render(&world, &world.job(&options).unwrap(), &Control::default()).unwrap();
        assert!(passes.image().unwrap().pixels() == whole.layers[0].image.pixels, "{options:?}");
    }
}

#[test]
fn cancelled_render_keeps_finished_passes() {
    let world = spheres();
    let options = RenderJob::for_scene(&world).size((40, 24)).samples(8_u32);
    let mut passes = Renderer::with_control(&world, options.clone(), Control::default()).unwrap();
    passes.canceller().cancel();
    assert!(matches!(passes.next_pass(), Err(Error::Render(RenderError::Cancelled))));
    assert!(passes.image().unwrap().pixels().iter().all(|pixel| *pixel == Color::ZERO));
    let whole = Renderer::new(&world, options).unwrap().finish().unwrap();
    assert!(whole.pixels().iter().all(|pixel| pixel.min_element() > 0.0));
}

#[test]
fn defaults_of_a_scene_may_be_changed() {
    let world = spheres();
    let options = RenderJob::for_scene(&world);
    let given = ["size", "samples", "bounces"].map(|name| options.get(name).unwrap_or_default());
    assert_eq!(given, ["512x512", "64", "16"]);
    let job = world.job(&options.size((8, 4)).bounces(2_u32)).unwrap();
    assert_eq!((job.width, job.height, job.settings.bounces, job.method.name()), (8, 4, 2, "path"));
    let refused = world.job(&RenderJob::default().bounces(1_000_000_u32)).unwrap_err();
    assert_eq!(refused.to_string(), "bounces 1000000 must be at most 256");
}

#[test]
fn errors_of_scenes_name_their_place() {
    let missing = durer::open("there/is/no/scene.txt").unwrap_err();
    assert!(matches!(missing, Error::Source(_)), "{missing}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.txt");
    std::fs::write(&path, "Group {\n  Sphere { center 0 0 0 radius -1 } }").unwrap();
    let found = durer::open(&path).unwrap_err().to_string();
    assert!(found.contains("scene.txt:2:") && found.contains("must be more than 0"), "{found}");
}
