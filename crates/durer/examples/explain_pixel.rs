//! Explains a pixel by listing its samples and the terms that add up to each sample.

use durer::prelude::*;
use durer::render::explain::explain;

pub(crate) fn main() -> Result<(), Error> {
    let mut scene = Scene::builder();
    scene.camera(PerspectiveCamera::look_at(vec3(0.0, 0.0, 5.0), Vec3::ZERO, 40.0));
    scene.light(DirectionalLight { direction: vec3(0.0, 0.0, -1.0), ..Default::default() });
    let red = scene.material(PhongMaterial { diffuse_color: Some(rgb(0.8, 0.2, 0.1)), ..Default::default() });
    scene.add(Sphere::default()).material(red);
    let world = scene.build()?.compile()?;

    let options = RenderJob::for_scene(&world).size((32, 24)).samples(1_u32);
    let found = explain(&world, &world.job(&options)?, 16, 12)?;
    println!("pixel {},{} is {}", found.x, found.y, found.color);
    for sample in &found.samples {
        println!("{sample:?}");
    }
    assert_eq!(found.samples.len(), 1);

    // The colour is bit-identical to the colour in the picture.
    let picture = Renderer::new(&world, options)?.finish()?;
    assert_eq!(picture.pixel(16, 12), Some(found.color));
    Ok(())
}
