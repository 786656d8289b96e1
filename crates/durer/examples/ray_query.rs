//! Tests rays against a scene without rendering a picture.

use durer::prelude::*;

pub(crate) fn main() -> Result<(), Error> {
    let mut scene = Scene::builder();
    scene.camera(PerspectiveCamera::default());
    scene.add(Sphere { center: vec3(0.0, 0.0, -5.0), radius: 1.0 });
    scene.add(Cuboid { min: vec3(-1.0, -3.0, -6.0), max: vec3(1.0, -2.0, -4.0) });
    let world = scene.build()?.compile()?;

    // Find the closest hit. `t` is in units of the length of the ray's direction.
    let ray = Ray::new(Vec3::ZERO, vec3(0.0, 0.0, -2.0));
    let hit = world.intersect(&ray, &mut ());
    let found = hit.as_ref().map(|hit| (hit.hit.object, hit.hit.t, hit.surface.n_geo));
    println!("object, t, normal: {found:?}");
    assert_eq!(found, Some((0, 2.0, Vec3::Z)));

    // Test whether the ray is blocked within a maximum distance.
    let down = Ray { t_max: 3.0, ..Ray::new(vec3(0.0, 1.5, -5.0), Vec3::NEG_Y) };
    assert!(world.occluded(&down, &mut ()));
    let up = Ray { dir: Vec3::Y, ..down };
    assert!(!world.occluded(&up, &mut ()));
    Ok(())
}
