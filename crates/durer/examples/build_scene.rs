//! Builds a scene in code. The scene contains a mesh with two instances, a floor and an area light.

use durer::prelude::*;

pub(crate) fn main() -> Result<(), Error> {
    let mut scene = Scene::builder();
    scene.camera(PerspectiveCamera::look_at(vec3(0.0, 2.0, 8.0), vec3(0.0, 0.5, 0.0), 35.0));

    let white = scene.material(PrincipledMaterial { base_color: rgb(0.8, 0.8, 0.8), ..Default::default() });
    let gold = scene.material(PrincipledMaterial {
        base_color: rgb(1.0, 0.7, 0.3),
        base_metalness: 1.0,
        specular_roughness: 0.2,
        ..Default::default()
    });
    // A surface emits light if its material does. The luminance is in cd/m^2.
    let light = scene.material(PrincipledMaterial { emission_luminance: 40.0, ..Default::default() });

    // A pyramid with five corners. The corners of each face are in counter-clockwise order when
    // seen from outside.
    let corners = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], [0.0, 1.5, 0.0_f32]];
    let sides = [[4, 3, 2], [4, 2, 1], [4, 1, 0], [4, 0, 3], [0, 1, 2], [0, 2, 3]];
    let pyramid = scene.mesh(&corners, &sides);
    scene.add(pyramid).material(gold).translate(vec3(-1.2, 0.0, 0.0));
    scene.add(pyramid).material(white).scale(0.5).rotate(Vec3::Y, 45.0).translate(vec3(1.2, 0.0, 0.5));
    scene.add(Plane { normal: Vec3::Y, ..Default::default() }).material(white);
    scene.add(Disc { center: vec3(0.0, 5.0, 2.0), normal: Vec3::NEG_Y, ..Default::default() }).material(light);

    let world = scene.build()?.compile()?;
    let options = RenderJob::for_scene(&world).size((64, 48)).samples(4_u32);
    let picture = Renderer::new(&world, options)?.finish()?;
    let mean = picture.pixels().iter().copied().sum::<Color>() / picture.pixels().len() as f32;
    println!("{} x {}, mean colour {mean}", picture.width(), picture.height());
    assert!(mean.min_element() > 0.0);

    // Invalid values are reported when the scene is built.
    scene.add(Sphere { radius: -1.0, ..Default::default() });
    let refused = scene.build().map_err(Error::from).unwrap_err();
    assert_eq!(refused.to_string(), "Sphere: radius -1 must be more than 0");
    Ok(())
}
