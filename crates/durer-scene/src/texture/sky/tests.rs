use super::*;
use crate::math::LUMINANCE;

/// Direction at an elevation and an azimuth in degrees, where the azimuth 0 is x.
fn direction(elevation: f64, azimuth: f64) -> Vec3 {
    let (sin, cos) = fp::sin_cos_degrees(elevation);
    let (sin_turn, cos_turn) = fp::sin_cos_degrees(azimuth);
    Vec3::new((cos * cos_turn) as f32, sin as f32, (cos * sin_turn) as f32)
}

fn brightness(color: Color) -> f32 {
    color.dot(LUMINANCE)
}

/// Illuminance of level ground, as a sum over equal solid angles.
fn level(at: impl Fn(Vec3) -> Color) -> Color {
    let steps = 400;
    let mut light = Color::ZERO;
    for row in 0..steps {
        let up = (row as f32 + 0.5) / steps as f32;
        for column in 0..steps {
            let (s, c) = fp::sin_cos_degrees((f64::from(column) + 0.5) * 360.0 / f64::from(steps));
            let flat = (1.0 - up * up).sqrt();
            light += at(Vec3::new(flat * s as f32, up, flat * c as f32)) * (2.0 * PI * up / (steps * steps) as f32);
        }
    }
    light
}

fn close(found: Color, expected: Color, tolerance: f32) -> bool {
    ((found - expected) / expected).abs().max_element() < tolerance
}

#[test]
fn ground_reflects_its_share_of_sun_and_sky() {
    let to_sun = Vec3::new(0.3, 0.6, -0.5);
    let perez = Perez::new(to_sun, &Irradiance::new(600.0, 150.0));
    let skies = [Sky::preetham(to_sun, 3.0, Some(0.5)), Sky::hosek(to_sun, 3.0, Some(0.5))];
    for sky in skies.into_iter().chain([Sky::perez(perez, Some(0.5))]) {
        let expected = 0.5 / PI * (level(|dir| sky.at(dir)) + sky.sun() * to_sun.normalize().y);
        let found = sky.at(Vec3::NEG_Y);
        assert!(close(found, expected, 0.01), "{found}, not {expected}");
    }
}

#[test]
fn sky_is_brightest_around_the_sun_and_finite_everywhere() {
    for model in [Sky::preetham, Sky::hosek] {
        for height in [0.0, 1.0, 10.0, 45.0, 90.0] {
            for turbidity in [2.0, 4.0, 9.0] {
                let to_sun = direction(height, 0.0);
                let sky = model(to_sun, turbidity, None);
                let picture = environment_map(64, 32, |dir| sky.at(dir));
                assert!(picture.iter().all(|color| color.is_finite() && color.min_element() >= 0.0));
                let away = sky.at(Vec3::new(-0.8, 0.6, 0.0));
                assert!(brightness(sky.at(to_sun)) > brightness(away), "{height} {turbidity}");
            }
        }
    }
}

/// Radiance of the sky above the horizon at turbidity 3 and an albedo of 0.2.
fn hosek(elevation: f64) -> Hosek {
    Hosek::new(direction(elevation, 0.0), 3.0, Vec3::splat(0.2))
}

#[test]
fn hosek_radiance_agrees_with_mitsuba() {
    // Turbidity, albedo, elevation of the sun, then elevation and azimuth of a direction relative
    // to the sun, and the radiance of `sunsky` in Mitsuba 3.9.1 (`scalar_rgb`, `sun_scale` 0). Its
    // unit is 106.75 times 683 cd/m^2.
    type Row = (f32, [f32; 3], f64, f64, f64, [f32; 3]);
    #[rustfmt::skip]
    let measured: [Row; 12] = [
        (1.5, [0.0, 0.0, 0.0], 2.0, 1.0, 0.0, [0.15417, 0.091005, 0.025325]),
        (1.5, [0.0, 0.0, 0.0], 2.0, 30.0, 90.0, [0.015898, 0.019941, 0.020266]),
        (3.0, [0.3, 0.3, 0.3], 10.0, 0.5, 180.0, [0.130005, 0.128805, 0.084363]),
        (3.0, [0.3, 0.3, 0.3], 10.0, 60.0, 20.0, [0.01481, 0.025446, 0.039798]),
        (2.0, [0.1, 0.5, 1.0], 45.0, 45.0, 3.0, [0.081223, 0.126785, 0.210346]),
        (2.0, [0.1, 0.5, 1.0], 45.0, 90.0, 0.0, [0.01726, 0.04137, 0.111376]),
        (8.0, [1.0, 1.0, 1.0], 60.0, 5.0, 40.0, [0.378489, 0.410232, 0.425021]),
        (8.0, [1.0, 1.0, 1.0], 60.0, 20.0, 170.0, [0.146986, 0.191031, 0.262761]),
        (5.5, [0.2, 0.2, 0.2], 90.0, 10.0, 0.0, [0.115382, 0.147221, 0.195951]),
        (5.5, [0.2, 0.2, 0.2], 90.0, 85.0, 0.0, [0.3239, 0.354159, 0.310737]),
        (10.0, [0.5, 0.5, 0.5], 25.0, 24.0, 1.0, [1.610987, 1.361223, 0.934263]),
        (10.0, [0.5, 0.5, 0.5], 25.0, 3.0, 100.0, [0.097335, 0.08501, 0.070804]),
    ];
    for (turbidity, albedo, height, elevation, azimuth, expected) in measured {
        let sky = Hosek::new(direction(height, 0.0), turbidity, albedo.into());
        let found = sky.at(direction(elevation, azimuth)) / (683.0 * 106.750_26);
        assert!(close(found, expected.into(), 1e-3), "{turbidity} {height} {elevation}: {found}, not {expected:?}");
    }
}

#[test]
fn hosek_sun_agrees_with_the_integral_over_its_disc_and_spectrum() {
    // `sunsky` of Mitsuba 3.9.1 (`scalar_spectral`, `complex_sun`, `sky_scale` 0), at 48 points of
    // the disc and every 4 nm, times 683 lm/W, the CIE functions, and the solid angle of a disc of
    // 0.2665 degrees.
    for (turbidity, height, expected) in [
        (2.0, 12.0, [80_164.4, 51_115.3, 21_412.0]),
        (3.0, 30.0, [95_669.0, 73_650.8, 48_755.5]),
        (3.0, 90.0, [104_767.3, 86_793.1, 67_970.6]),
        (4.5, 50.0, [96_824.1, 78_027.9, 58_190.6]),
        (7.0, 10.0, [37_348.7, 21_101.7, 7_829.3]),
    ] {
        let found = Hosek::new(direction(height, 0.0), turbidity, Vec3::splat(0.2)).sun();
        assert!(close(found, expected.into(), 0.005), "{turbidity} {height}: {found}, not {expected:?}");
    }
}

#[test]
fn hosek_sky_changes_gradually_with_its_parameters() {
    let dir = direction(20.0, 30.0);
    let mut last: Option<[Color; 2]> = None;
    for step in 1..=3600 {
        let sky = hosek(f64::from(step) / 40.0);
        let now = [sky.at(dir), sky.sun()];
        // A fortieth of a degree changes the sky by little, also between the segments of the sun,
        // which is dim at the horizon.
        for (last, now) in last.unwrap_or(now).into_iter().zip(now) {
            let limit = if step < 200 { 0.25 } else { 0.02 };
            let change = (now - last).abs().max_element() / now.max_element();
            assert!(change < limit, "{}: {change}", f64::from(step) / 40.0);
        }
        last = Some(now);
    }
    let at = |turbidity: f32| Hosek::new(direction(40.0, 0.0), turbidity, Vec3::splat(0.2)).at(dir);
    for turbidity in 1..10 {
        let (low, high) = (turbidity as f32, (turbidity + 1) as f32);
        assert!(close(at(low + 1e-4), at(low), 1e-3) && close(at(high - 1e-4), at(high), 1e-3), "{turbidity}");
    }
    // Values outside the range are moved into it.
    assert_eq!((at(0.0), at(11.0)), (at(1.0), at(10.0)));
    assert_eq!(hosek(-5.0), hosek(0.0));
}

#[test]
fn bright_ground_and_a_high_sun_brighten_the_sky_of_hosek() {
    // The IES states 0.8 + 15.5 sqrt(sin h) klx for a clear sky with the sun at the elevation h. An
    // independent program gives these illuminances for the data at turbidity 3 and albedo 0.2.
    for (height, lux) in [(20.0, 12_680.0), (40.0, 16_319.0), (60.0, 17_688.0)] {
        let sky = hosek(height);
        let found = brightness(level(|dir| sky.at(dir)));
        assert!((found / lux - 1.0).abs() < 0.005, "{height}: {found}");
        let ies = 800.0 + 15_500.0 * (fp::sin_cos_degrees(height).0 as f32).sqrt();
        assert!((1.1..1.4).contains(&(found / ies)), "{height}: {found}");
    }
    let bright = |albedo: f32| brightness(Hosek::new(direction(45.0, 0.0), 3.0, Vec3::splat(albedo)).at(Vec3::Y));
    assert!(bright(0.0) < bright(0.5) && bright(0.5) < bright(1.0));
}
