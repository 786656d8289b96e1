//! Tests for the light that arrives at a point from light sources.

use super::*;

#[test]
fn directional_light_arrives_against_its_direction_from_infinity() {
    let light = DirectionalLight { direction: Vec3::new(0.0, -3.0, 4.0), color: Vec3::X, ..Default::default() };
    let sample = light.illuminate((Vec3::splat(100.0)).as_dvec3());
    assert!((sample.to_light - Vec3::new(0.0, 0.6, -0.8)).length() < 1e-6);
    assert_eq!((sample.distance, sample.color), (f32::INFINITY, Vec3::X));
}

#[test]
fn illuminate_at_the_light_has_a_unit_direction() {
    let sample = PointLight::default().illuminate((Vec3::ZERO).as_dvec3());
    assert!(sample.to_light.is_normalized() && sample.distance == 0.0 && sample.color.is_finite());
}
