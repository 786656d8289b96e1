//! Tests of photon mapping against path tracing and closed-form solutions.

use super::*;

/// Returns the mean radiance along a ray with photon mapping, and the standard error of the mean.
pub(super) fn by_photons(world: &World, ray: Ray, (count, radius): (u32, f32), samples: u32) -> (f64, f64) {
    let settings = RenderSettings { bounces: 12, ..Job::default().settings };
    let photons = Some(Arc::new(PhotonTracer::new(world, 3, count, Some(radius))));
    let path = Path { photons, ..Path::new(world, settings, PathOptions::default()) };
    let values: Vec<f64> = (0..samples)
        .map(|sample| f64::from(path.radiance(&ray, SampleId::new(7, (3, 5), sample), &mut ()).x))
        .collect();
    let mean = values.iter().sum::<f64>() / f64::from(samples);
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / f64::from(samples);
    (mean, (variance / f64::from(samples)).sqrt())
}

const GLASS: &str = "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 }";

#[test]
fn slab_transmits_light_by_fresnel() {
    // If all interreflections are included, T = (1 - F) / (1 + F), where F = 0.04. Paths find this
    // light only by way of the floor.
    let world = scene(
        &format!("{MATTE} {GLASS}"),
        "DirectionalLight { direction 0 -1 0 color 2 2 2 }",
        "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Box { min -3 1 -3 max 3 1.2 3 }",
    );
    let below = Ray::new(Vec3::new(2.0, 0.9, 0.0), Vec3::new(-2.0, -0.9, 0.0).normalize());
    let (mean, error) = by_photons(&world, below, (20_000, 0.3), 24);
    // Some of the light comes from the surrounding floor.
    let expected = 0.5 * 2.0 * (1.0 - 0.04) / (1.0 + 0.04) + light(&world, below, 12, 1 << 14).0;
    assert!((mean - expected).abs() < 3.0 * error + 0.003 * expected, "{mean} ± {error}, expected {expected}");
    let (without, _) = light(&world, below, 12, 256);
    assert!(without < 0.1 * expected, "{without}");
}

#[test]
fn photons_and_paths_agree_if_both_find_the_light() {
    let emitter = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 6 }";
    let world = scene(
        &format!("{MATTE} {GLASS} {emitter}"),
        "",
        "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Sphere { center 0 1 0 radius 0.7 } \
         MaterialIndex 2 Rectangle { corner -1 4 -1 edge0 2 0 0 edge1 0 0 2 }",
    );
    for place in [0.0, 0.25, 0.9] {
        let ray = Ray::new(Vec3::new(place + 3.0, 0.4, 0.0), Vec3::new(-3.0, -0.4, 0.0).normalize());
        let (a, ea) = light(&world, ray, 12, 1 << 16);
        let (b, eb) = by_photons(&world, ray, (20_000, 0.1), 48);
        // The light varies within the search radius, so allow an error of one percent.
        assert!((a - b).abs() < 3.5 * (ea * ea + eb * eb).sqrt() + 0.01 * a, "at {place}: {a} ± {ea}, {b} ± {eb}");
    }
}

#[test]
fn fog_and_rough_glass_scatter_equal_light_with_and_without_photons() {
    // All light comes from inside a glass sphere. Photons account for the light that delta lobes
    // send to surfaces, and paths account for the light that fog or rough glass scatters
    // afterwards. No light may be lost or counted twice.
    let emitter = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 6 }";
    let rough = "PrincipledMaterial { transmissionWeight 1 specularRoughness 0.4 }";
    let objects = "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Sphere { center 0 1 0 radius 0.6 } \
        MaterialIndex 2 Sphere { center 0 1 0 radius 0.35 }";
    let ball = "MaterialIndex 3 Sphere { center 1 0.45 0 radius 0.4 }";
    let fog = "Fog { extinction 0.4 color 0.95 0.95 0.95 min -3 0 -3 max 3 4 3 }";
    // Look at the floor below the sphere and through the air.
    let floor = (Vec3::new(3.0, 0.5, 3.0), Vec3::new(0.7, 0.0, 0.2));
    let above = (Vec3::new(1.2, 0.6, 4.0), Vec3::new(1.2, 0.6, -4.0));
    let (few, many) = (((100, 0.2), 1 << 13), ((8_000, 0.1), 1 << 10));
    for (air, more, (from, to), (photons, samples)) in
        [(fog, "", floor, few), (fog, "", above, many), ("", ball, floor, few), (fog, ball, floor, few)]
    {
        let world = read(&format!(
            "{air} PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }} Background {{ color 0 0 0 }}
             Materials {{ {MATTE} {GLASS} {emitter} {rough} }} Group {{ {objects} {more} }}"
        ));
        let ray = Ray::new(from, (to - from).normalize());
        let (a, ea) = light(&world, ray, 12, 1 << 15);
        let (b, eb) = by_photons(&world, ray, photons, samples);
        let error = (ea * ea + eb * eb).sqrt();
        // Allow an error of one percent because of the search radius. The standard errors are small
        // enough to reveal light that is lost or counted twice.
        let near = (a - b).abs() < 3.5 * error + 0.01 * a && error < 0.15 * a;
        assert!(near, "{air} {more}: {a} ± {ea}, {b} ± {eb}");
    }
}

#[test]
fn photon_beams_in_fog_match_their_integral() {
    // Light from the zenith passes through a slab and then continues downwards through fog. The
    // light scattered once along a horizontal ray to a black surface is (1 - F)^2 E / (4 pi) e^(-s
    // h) a (1 - e^(-s l)).
    let fog = "Fog { extinction 1 color 0.8 0.8 0.8 min -1 -2 -1 max 1 0.9 1 }";
    let black = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 }";
    let objects = "MaterialIndex 0 Box { min -1.5 1 -1.5 max 1.5 1.2 1.5 }
        MaterialIndex 1 Rectangle { corner 0.5 -0.1 -0.1 edge0 0 0.2 0 edge1 0 0 0.2 }";
    let world = read(&format!(
        "{fog} PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }} Background {{ color 0 0 0 }}
         Lights {{ DirectionalLight {{ direction 0 -1 0 color 2 2 2 }} }} Materials {{ {GLASS} {black} }} Group {{ {objects} }}"
    ));
    let ray = Ray::new(Vec3::new(-0.5, 0.0, 0.0), Vec3::X);
    // This depth is enough for two refractions, but not for another scattering event after them.
    let settings = RenderSettings { bounces: 2, ..Job::default().settings };
    let photons = Some(Arc::new(PhotonTracer::new(&world, 3, 1_000, Some(0.2))));
    let path = Path { photons, ..Path::new(&world, settings, PathOptions::default()) };
    let n = 1 << 12;
    let values: Vec<f64> =
        (0..n).map(|i| f64::from(path.radiance(&ray, SampleId::new(7, (3, 5), i), &mut ()).x)).collect();
    let mean = values.iter().sum::<f64>() / f64::from(n);
    let error = (values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>()).sqrt() / f64::from(n);
    let expected = 0.96 * 0.96 * 2.0 / 4.0 * libm::exp(-0.9) * 0.8 * (1.0 - libm::exp(-1.0));
    assert!((mean - expected).abs() < 3.0 * error + 0.005 * expected, "{mean} ± {error}, expected {expected}");
    assert!(error < 0.04 * expected, "{mean} ± {error}, expected {expected}");
}

#[test]
fn photons_and_paths_start_in_the_surrounding_medium() {
    // A light, a glass sphere and the floor below it are inside a box of fog whose surface is
    // index-matched.
    let fog = "PrincipledMaterial { transmissionWeight 1 specularIor 1 specularWeight 0 transmissionDepth 1 transmissionColor 0.6 0.6 0.6 specularRoughness 0 }";
    let emitter = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 6 }";
    let objects = "MaterialIndex 0 Rectangle { corner -2 0 2 edge0 4 0 0 edge1 0 0 -4 } MaterialIndex 1 Sphere { center 0 1 0 radius 0.7 }
        MaterialIndex 2 Rectangle { corner -1 3 -1 edge0 2 0 0 edge1 0 0 2 } MaterialIndex 3 Box { min -4 -1 -4 max 4 5 4 }";
    let world = scene(&format!("{MATTE} {GLASS} {emitter} {fog}"), "", objects);
    let ray = Ray::new(Vec3::new(3.0, 0.4, 0.0), Vec3::new(-3.0, -0.4, 0.0).normalize());
    let (a, ea) = light(&world, ray, 12, 1 << 15);
    let (b, eb) = by_photons(&world, ray, (20_000, 0.1), 48);
    assert!((a - b).abs() < 3.5 * (ea * ea + eb * eb).sqrt() + 0.01 * a, "{a} ± {ea}, {b} ± {eb}");
    // The fog attenuates a light that is seen from inside.
    let emitter = Ray::new(Vec3::new(-0.9, 0.5, 0.9), Vec3::Y);
    let (seen, _) = light(&world, emitter, 12, 64);
    let expected = 6.0 * libm::pow(0.6, 2.5);
    assert!((seen - expected).abs() < 1e-3 * expected, "{seen}, expected {expected}");
}

#[test]
fn photon_maps_do_not_depend_on_how_they_are_built() {
    let world = scene(
        &format!("{MATTE} {GLASS}"),
        "PointLight { position 0.5 4 0 color 9 9 9 falloff 1 }",
        "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Sphere { center 0 1 0 radius 0.7 }",
    );
    let settings = Job::default().settings;
    let ray = Ray::new(Vec3::new(3.0, 0.4, 0.0), Vec3::new(-3.0, -0.4, 0.0).normalize());
    let made = |prepared: bool| {
        let photons = Arc::new(PhotonTracer::new(&world, 3, 5_000, None));
        let path = Path { photons: Some(photons.clone()), ..Path::new(&world, settings, PathOptions::default()) };
        if prepared {
            photons.prepare(&path, 2);
        }
        path.radiance(&ray, SampleId::new(7, (3, 5), 2), &mut ())
    };
    let (a, b) = (made(true), made(false));
    assert!(a.x > 0.0);
    assert_eq!(a, b);
}
