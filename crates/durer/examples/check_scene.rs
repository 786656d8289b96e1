//! Checks a scene for likely mistakes. In this example, the camera looks away from all objects.

use durer::check::{CheckInput, check};
use durer::prelude::*;

pub(crate) fn main() -> Result<(), Error> {
    let mut scene = Scene::builder();
    scene.camera(PerspectiveCamera::look_at(vec3(0.0, 0.0, 5.0), vec3(0.0, 0.0, 9.0), 40.0));
    scene.light(DirectionalLight::default());
    let grey = scene.material(PhongMaterial::default());
    scene.add(Sphere::default()).material(grey);
    let world = scene.build()?.compile()?;

    let job = world.job(&RenderJob::for_scene(&world).size((64, 48)))?;
    let input = CheckInput {
        scene: world.scene(),
        world: world.world(),
        dialect: world.dialect(),
        files: world.files(),
        job: &job,
        exposure: 1.0,
        rejected: None,
    };
    let findings = check(&input, world.diagnostics());
    for finding in &findings {
        println!("{}: {}", finding.diagnostic.code, finding.diagnostic.message);
    }
    assert!(!findings.is_empty());
    Ok(())
}
