//! Tests of the light that arrives from light sources.

use super::*;

#[test]
fn directional_light_arrives_against_its_direction_from_infinity() {
    let light = DirectionalLight { direction: Vec3::new(0.0, -3.0, 4.0), color: Vec3::X, ..Default::default() };
    let seen = light.illuminate((Vec3::splat(100.0)).as_dvec3());
    assert!((seen.to_light - Vec3::new(0.0, 0.6, -0.8)).length() < 1e-6);
    assert_eq!((seen.distance, seen.color), (f32::INFINITY, Vec3::X));
}

#[test]
fn illuminate_at_the_light_has_a_unit_direction() {
    let seen = PointLight::default().illuminate((Vec3::ZERO).as_dvec3());
    assert!(seen.to_light.is_normalized() && seen.distance == 0.0 && seen.color.is_finite());
}
