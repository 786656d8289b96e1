//! Tests of lights as each dialect interprets them.

use durer_scene::dialect::Dialect;
use durer_scene::light::{Illuminate as _, PointLight};
use durer_scene::math::Vec3;
use glam::DVec3;

/// Returns the light that arrives at a distance of 2 from a point light of colour 1.
fn arriving(dialect: Dialect, attenuation: Option<Vec3>, falloff: Option<f32>) -> f32 {
    let light = PointLight { position: Vec3::Z * 2.0, color: Vec3::ONE, attenuation, falloff, ..PointLight::default() };
    let seen = super::light(&light.into(), dialect.rules()).illuminate(DVec3::ZERO);
    assert_eq!((seen.to_light, seen.distance), (Vec3::Z, 2.0));
    seen.color.x
}

#[test]
fn point_lights_attenuate_by_their_dialect() {
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
    // In these dialects, the divisor has no constant term of 1.
    assert_eq!(arriving(Dialect::F16, None, Some(0.5)), 0.5);
    assert_eq!(arriving(Dialect::F23, None, Some(0.5)), 0.5);
    assert_eq!(arriving(Dialect::F23, None, None), 1.0 / 80.0);
    // The official program of 2016 divides by zero. Without its bugs, there is no attenuation.
    assert!(!arriving(Dialect::F16, None, None).is_finite());
    let light = super::light(&PointLight::default().into(), &Dialect::F16.rules().without_quirks());
    assert_eq!(light.illuminate((Vec3::X * 7.0).as_dvec3()).color, Vec3::ONE);
}
