//! Pictures by each integrator, rendered by the whole library without files or threads.

use super::Hash;
use durer::prelude::*;

/// Returns a box with a mesh, a glass ball, a mirror and an area light.
fn room() -> CompiledScene {
    let mut scene = Scene::builder();
    scene.camera(PerspectiveCamera::look_at(vec3(0.0, 0.0, 4.5), Vec3::ZERO, 40.0));
    let matte = |color| PrincipledMaterial { base_color: color, specular_weight: 0.0, ..Default::default() };
    let white = scene.material(matte(rgb(0.7, 0.7, 0.7)));
    let red = scene.material(matte(rgb(0.6, 0.1, 0.1)));
    let metal = PrincipledMaterial { base_metalness: 1.0, specular_roughness: 0.2, ..matte(rgb(0.9, 0.8, 0.6)) };
    let metal = scene.material(metal);
    let glass = scene.material(PrincipledMaterial { transmission_weight: 1.0, ..Default::default() });
    let light = PrincipledMaterial { emission_luminance: 8.0, emission_color: rgb(1.0, 0.9, 0.8), ..matte(Vec3::ZERO) };
    let light = scene.material(light);
    let corners = |y: f32| [vec3(-2.0, y, -2.0), vec3(2.0, y, -2.0), vec3(2.0, y, 2.0), vec3(-2.0, y, 2.0)];
    let floor = scene.mesh(&corners(-1.0), &[[0, 2, 1], [0, 3, 2]]);
    scene.add(floor).material(white);
    scene.add(Plane { normal: Vec3::Z, offset: -2.0 }).material(red);
    scene.add(Sphere { center: vec3(-0.8, -0.4, -0.3), radius: 0.6 }).material(metal);
    scene.add(Sphere { center: vec3(0.8, -0.5, 0.3), radius: 0.5 }).material(glass);
    let emitter = Rectangle { corner: vec3(-0.5, 1.5, -0.5), edge0: Vec3::X, edge1: Vec3::Z };
    scene.add(emitter).material(light);
    scene.light(PointLight { position: vec3(1.0, 1.4, 1.0), color: rgb(2.0, 2.0, 2.0), ..Default::default() });
    scene.build().expect("the room is valid").compile().expect("the room compiles")
}

fn picture(integrator: &str, samples: u32) -> u64 {
    let room = room();
    let job = RenderJob::for_scene(&room).size((32, 24)).samples(samples).integrator(integrator);
    let picture = Renderer::new(&room, job).expect("the job is valid").finish().expect("nothing cancels it");
    let mut hash = Hash::new();
    picture.pixels().iter().flat_map(|color| color.to_array()).for_each(|x| hash.add(x.to_bits().into()));
    let lit = picture.pixels().iter().filter(|color| color.max_element() > 0.0).count();
    assert!(lit > picture.pixels().len() / 2, "{integrator}: only {lit} pixels are lit");
    hash.0
}

/// Integrator of the course: local illumination, mirrors and glass.
pub fn whitted() -> u64 {
    picture("whitted", 4)
}

/// Path tracing.
pub fn path() -> u64 {
    picture("path", 8)
}

/// Path tracing with photon maps.
pub fn photons() -> u64 {
    picture("photons", 2)
}
