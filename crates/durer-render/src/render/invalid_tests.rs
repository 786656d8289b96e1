//! Tests that scenes and jobs with invalid values are rejected with a message and are never
//! rendered.

use super::{Control, Job, PartialRender, RenderError, Sampling, Shard, explain, render};
use crate::compile::testing::read;
use crate::compile::{AccelKind, Resources, compile};
use crate::film::Filter;
use crate::film::course::CourseFilter;
use crate::film::false_color::FalseColorScale;
use crate::integrator::{IntegratorKind, RenderSettings};
use durer_diag::{Diagnostics, Files};
use durer_formats::Decoder;
use durer_formats::folder::FolderSource;
use durer_scene::camera::PerspectiveCamera;
use durer_scene::describe::{DescribedKind, Value};
use durer_scene::dialect::Dialect;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::Vec3;
use durer_scene::sampler::Sampler;
use durer_scene::scene::{Group, Material, Object, ObjectKind, Scene, Spanned};
use durer_scene::shape::Sphere;

/// Compiles a scene with a red sphere after applying a change, and returns the messages.
fn compiled(change: impl FnOnce(&mut Scene, &mut Sphere, &mut PrincipledMaterial)) -> Vec<String> {
    let (mut ball, mut layers) = (Sphere::default(), PrincipledMaterial::default());
    let camera = PerspectiveCamera { center: Vec3::new(0.0, 0.0, 5.0), ..PerspectiveCamera::default() };
    let mut scene = Scene { camera: Some(camera.into()), ..Scene::default() };
    let object = Object { node: ObjectKind::Group(Group::default()), material: Some(0), span: Default::default() };
    scene.root = Some(Group { objects: vec![object] });
    change(&mut scene, &mut ball, &mut layers);
    for object in scene.root.iter_mut().flat_map(|root| &mut root.objects) {
        object.node = ObjectKind::Primitive(ball.clone().into());
    }
    scene.materials.push(Spanned { value: Material::Principled(Box::new(layers)), span: Default::default() });
    let (mut files, source, mut found) = (Files::default(), FolderSource::new("."), Diagnostics::default());
    let resources = Resources::new(&source, &Decoder, &mut files);
    let world = compile(&scene, Dialect::Durer.rules(), AccelKind::Bvh, resources, &mut found);
    assert_eq!(world.is_none(), found.has_errors());
    found.iter().map(|finding| finding.message.clone()).collect()
}

#[test]
fn invalid_values_of_scenes_are_rejected() {
    assert_eq!(compiled(|_, _, _| {}), [""; 0]);
    assert_eq!(compiled(|_, ball, _| ball.radius = -1.0), ["Sphere: radius -1 must be more than 0"]);
    assert_eq!(compiled(|_, ball, _| ball.radius = f32::NAN), ["Sphere: radius NaN must be finite"]);
    let rough = "PrincipledMaterial: specular_roughness -3 must be from 0 to 1";
    let found = compiled(|_, _, layers| (layers.specular_roughness, layers.base_color) = (-3.0, Vec3::splat(9.0)));
    assert_eq!(found, [rough]);
    let found = compiled(|scene, _, _| {
        scene.root.iter_mut().flat_map(|root| &mut root.objects).for_each(|object| object.material = Some(7));
    });
    assert_eq!(found, ["an object has material 7, but the scene has only material 0"]);
    let found =
        compiled(|scene, _, _| scene.camera = Some(PerspectiveCamera { angle: f32::NAN, ..Default::default() }.into()));
    assert_eq!(found, ["PerspectiveCamera: angle NaN must be finite"]);
}

/// Returns the error for an invalid job that renders a world of mirrors.
fn refused(job: Job) -> String {
    let mirrors = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }
        Lights { DirectionalLight { direction 0 0 -1 color 1 1 1 } }
        Materials { Material { reflectiveColor 1 1 1 } }
        Group { MaterialIndex 0 Plane { normal 0 0 1 offset 0 } Plane { normal 0 0 -1 offset -10 } }";
    let world = read(mirrors);
    let causes = |error| match error {
        RenderError::Job(message) => message,
        other => panic!("{other}"),
    };
    // All entry points report this error.
    assert!(matches!(PartialRender::new(&world, &job, Shard::WHOLE), Err(RenderError::Job(_))));
    assert!(matches!(explain::explain(&world, &job, 0, 0), Err(RenderError::Job(_))));
    causes(render(&world, &job, &Control::default()).map(|_| ()).unwrap_err())
}

#[test]
fn invalid_jobs_are_rejected() {
    let small = || Job { width: 8, height: 8, ..Job::default() };
    assert!(small().validate().is_ok());
    assert_eq!(refused(Job { width: 0, ..small() }), "the size 0 x 8 must be at least 1 x 1");
    let filtered = |samples, filter| Job { sampling: Sampling::Filtered { samples, filter }, ..small() };
    assert_eq!(refused(filtered(0, Filter::default())), "samples 0 must be from 1 to 1048576");
    for radius in [-1.0, 0.0, f32::NAN, 65.0] {
        let found = refused(filtered(1, Filter::default().with_radius(radius)));
        assert_eq!(found, format!("the filter's radius {radius} must be more than 0 and at most 64"));
    }
    let found = refused(filtered(1, Filter::Gaussian { sigma: 0.0, radius: 1.0 }));
    assert_eq!(found, "the filter's sigma 0 must be more than 0");
    let course = |filter| Job {
        sampling: Sampling::Course2004 { sampler: Sampler::Uniform, samples: 4, filter: Some(filter) },
        ..small()
    };
    assert!(course(CourseFilter::Tent { radius: 0.0 }).validate().is_ok());
    let found = refused(course(CourseFilter::Box { radius: -1.0 }));
    assert_eq!(found, "the filter's radius -1 must be from 0 to 64");
    let settings = |change: fn(&mut RenderSettings)| {
        let mut job = small();
        change(&mut job.settings);
        job
    };
    assert_eq!(refused(settings(|it| it.bounces = 1_000_000)), "bounces 1000000 must be at most 256");
    assert!(refused(settings(|it| it.min_weight = f32::NAN)).contains("throughput NaN"));
    assert_eq!(refused(Job { noise: Some(0.0), ..small() }), "the noise threshold 0 must be more than 0");
    assert!(refused(Job { depth_range: Some((1.0, 1.0)), ..small() }).contains("two different"));
    let light_scale = Some(FalseColorScale { low: 0.0, high: 1.0, logarithmic: true });
    assert!(refused(Job { light_scale, ..small() }).contains("from 0 to 1"));
    let mut method = IntegratorKind::PATH;
    let clamp = method.fields().iter().position(|field| field.name == "clamp").expect("path tracing has `clamp`");
    method.set(clamp, Value::Float(-1.0));
    assert_eq!(refused(Job { method, ..small() }), "clamp of path must be more than 0");
}
