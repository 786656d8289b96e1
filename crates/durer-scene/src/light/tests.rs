//! What arrives of lights, in each dialect.

use super::*;
use crate::dialect::Dialect;

/// What arrives of a light of strength 1 at distance 2 in a dialect; exactly representable answers
/// only.
fn arriving(dialect: Dialect, attenuation: Option<Vec3>, falloff: Option<f32>) -> f32 {
    let light = PointLight { position: Vec3::Z * 2.0, color: Vec3::ONE, attenuation, falloff, ..PointLight::default() };
    let seen = Light::from(light).with_rules(dialect.rules()).illuminate((Vec3::ZERO).as_dvec3());
    assert_eq!((seen.to_light, seen.distance), (Vec3::Z, 2.0));
    seen.color.x
}

#[test]
fn point_lights_fade_as_their_dialect_says() {
    let a = Some(Vec3::new(0.5, 0.25, 0.75));
    for dialect in [Dialect::F03, Dialect::F04, Dialect::Durer] {
        assert_eq!(arriving(dialect, a, None), 0.25);
        assert_eq!(arriving(dialect, None, None), 1.0);
    }
    for dialect in [Dialect::F12a5, Dialect::Durer] {
        assert_eq!(arriving(dialect, None, Some(0.75)), 0.25);
        assert_eq!(arriving(dialect, None, Some(0.0)), 1.0);
    }
    assert_eq!(arriving(Dialect::F12a4, a, Some(0.75)), 1.0);
    // Without the one.
    assert_eq!(arriving(Dialect::F16, None, Some(0.5)), 0.5);
    assert_eq!(arriving(Dialect::F23, None, Some(0.5)), 0.5);
    assert_eq!(arriving(Dialect::F23, None, None), 1.0 / 80.0);
    // The official program of 2016 divides by zero; sane rules do not fade.
    assert!(!arriving(Dialect::F16, None, None).is_finite());
    let light = PointLight::default().with_rules(&Dialect::F16.rules().sane());
    assert_eq!(light.illuminate((Vec3::X * 7.0).as_dvec3()).color, Vec3::ONE);
}

#[test]
fn directional_lights_come_against_their_direction_from_infinity() {
    let light = DirectionalLight { direction: Vec3::new(0.0, -3.0, 4.0), color: Vec3::X, ..Default::default() };
    let seen = light.illuminate((Vec3::splat(100.0)).as_dvec3());
    assert!((seen.to_light - Vec3::new(0.0, 0.6, -0.8)).length() < 1e-6);
    assert_eq!((seen.distance, seen.color), (f32::INFINITY, Vec3::X));
}

#[test]
fn a_point_at_the_light_itself_has_some_direction_to_it() {
    let seen = PointLight::default().illuminate((Vec3::ZERO).as_dvec3());
    assert!(seen.to_light.is_normalized() && seen.distance == 0.0 && seen.color.is_finite());
}
