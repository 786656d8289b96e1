//! Tests of light that passes through thin sheets, such as window panes.

use super::caustics::by_photons;
use super::*;

const LIGHTS: [(&str, f64); 3] = [
    // A light of colour c causes an irradiance of pi c at distance 1, and a directional light does
    // so at any distance.
    ("PointLight { position 0 2 0 color 1 1 1 attenuation 0 0 1 }", 0.25),
    ("DirectionalLight { direction 0 -1 0 color 1 1 1 }", 1.0),
    ("SpotLight { position 0 2 0 direction 0 -1 0 color 1 1 1 angle 60 }", 0.25),
];

/// Builds a pane of the given material above a floor.
fn under(pane: &str, light: &str) -> World {
    scene(
        &format!("{MATTE} PrincipledMaterial {{ {pane} }}"),
        light,
        "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Rectangle { corner -1 1 -1 edge0 2 0 0 edge1 0 0 2 }",
    )
}

/// Returns a ray that starts below the pane and hits the floor at the origin.
fn below() -> Ray {
    Ray::new(Vec3::new(2.0, 0.9, 0.0), Vec3::new(-2.0, -0.9, 0.0).normalize())
}

#[test]
fn pane_transmits_light_by_fresnel_and_its_colour() {
    // If all interreflections are included, T = (1 - F) / (1 + F), where F = 0.04.
    let clear = 0.96 / 1.04;
    for (emitter, distance) in LIGHTS {
        for (pane, share) in [
            ("transmissionWeight 1 specularRoughness 0 walls thin", clear),
            ("transmissionWeight 1 specularRoughness 0 transmissionColor 0.5 0.5 0.5 walls thin", 0.5 * clear),
            // Each pass through the pane absorbs half of the light, so T = (1 - F)² / 2 / (1 - F² /
            // 4).
            (
                "transmissionWeight 1 specularRoughness 0 transmissionColor 0.5 0.5 0.5 transmissionDepth 1 walls thin",
                0.96 * 0.96 * 0.5 / (1.0 - 0.0016 * 0.25),
            ),
            ("transmissionWeight 1 specularRoughness 0 opacity 0.25 walls thin", 0.75 + 0.25 * clear),
            ("baseColor 0 0 0 transmissionWeight 0.5 specularRoughness 0 walls thin", 0.5 * clear),
            // Light that is scattered or refracted is found by other means.
            ("transmissionWeight 1 specularRoughness 0.5 walls thin", 0.0),
            ("transmissionWeight 1 specularRoughness 0", 0.0),
        ] {
            let (mean, error) = light(&under(pane, emitter), below(), 0, 256);
            let expected = 0.5 * distance * share;
            assert!(
                (mean - expected).abs() <= 3.0 * error + 1e-3 * expected,
                "{pane} {emitter}: {mean}, expected {expected}"
            );
        }
    }
}

#[test]
fn transmittances_of_two_panes_multiply() {
    let glass =
        "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 transmissionColor 0.8 0.8 0.8 walls thin }";
    let panes = "MaterialIndex 1 Rectangle { corner -1 1 -1 edge0 2 0 0 edge1 0 0 2 } Rectangle { corner -1 1.5 -1 edge0 0 0 2 edge1 2 0 0 }";
    let floor = "MaterialIndex 0 Plane { normal 0 1 0 offset 0 }";
    let world = scene(&format!("{MATTE} {glass}"), LIGHTS[1].0, &format!("{floor} {panes}"));
    let share = 0.8 * 0.96 / 1.04;
    assert_light("two panes", &world, below(), 0, 0.5 * share * share);
}

#[test]
fn photons_do_not_count_light_through_a_pane_twice() {
    let world = under("transmissionWeight 1 specularRoughness 0 walls thin", LIGHTS[1].0);
    let (a, _) = light(&world, below(), 12, 256);
    let (b, error) = by_photons(&world, below(), (20_000, 0.3), 24);
    assert!((a - b).abs() < 3.5 * error + 0.005 * a, "{a}, {b} ± {error}");
}

/// Builds a floor below an infinite pane, with a disc of radiance 3 above the pane.
fn below_disc(pane: &str) -> World {
    let emissive = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 3 }";
    scene(
        &format!("{MATTE} PrincipledMaterial {{ {pane} }} {emissive}"),
        "",
        "MaterialIndex 0 Plane { normal 0 1 0 offset 0 } MaterialIndex 1 Plane { normal 0 1 0 offset 1 }
         MaterialIndex 2 Disc { center 0 2 0 normal 0 -1 0 radius 0.2 }",
    )
}

#[test]
fn pane_transmits_the_light_of_a_small_disc() {
    // A disc of angular radius t around the normal causes an irradiance of pi L sin(t)^2. Over such
    // a small angle, the pane's transmittance varies by no more than 1e-6.
    let irradiance = 3.0 * std::f64::consts::PI * 0.04 / 4.04;
    for (pane, share) in [
        ("transmissionWeight 1 specularRoughness 0 walls thin", 0.96 / 1.04),
        ("transmissionWeight 1 specularRoughness 0 opacity 0.25 walls thin", 0.75 + 0.25 * 0.96 / 1.04),
        ("baseColor 0 0 0 transmissionWeight 0.5 specularRoughness 0 walls thin", 0.5 * 0.96 / 1.04),
    ] {
        // Without bounces, paths end at the pane. With one bounce, MIS combines paths and light
        // samples.
        for bounces in [0, 1] {
            let (world, expected) = (below_disc(pane), shown(share * irradiance));
            let (mean, error) = light(&world, below(), bounces, 1 << 13);
            assert!((mean - expected).abs() <= 3.0 * error + 1e-3 * expected, "{pane}: {mean}, expected {expected}");
            // A BSDF sample finds the light once in a hundred times, which would give an error of
            // 0.11.
            assert!(error < 0.02 * expected, "{pane}, {bounces} bounces: {mean} ± {error}");
        }
    }
}

#[test]
fn light_and_bsdf_sampling_agree_through_panes() {
    let settings = RenderSettings { bounces: 4, ..Job::default().settings };
    let glossy = "PrincipledMaterial { baseColor 0.5 0.4 0.3 specularRoughness 0.3 }";
    let glass =
        "PrincipledMaterial { transmissionWeight 1 specularRoughness 0 transmissionColor 0.9 0.8 0.7 walls thin }";
    let emissive = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 3 }";
    let panes =
        "MaterialIndex 1 Rectangle { corner -2 1 -2 edge0 4 0 0 edge1 0 0 4 } Sphere { center 0.8 0.5 0 radius 0.4 }";
    let floor = "MaterialIndex 0 Plane { normal 0 1 0 offset 0 }";
    let lights = "MaterialIndex 2 Sphere { center 0 2 0.5 radius 0.5 } Rectangle { corner 0.6 0.4 -0.2 edge0 0.3 0 0 edge1 0 0.3 0 }";
    for (background, lights) in [("color 0.1 0.1 0.1", lights), ("sun 0.3 0.9 0.2 turbidity 4", "")] {
        let world = read(&format!(
            "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }} Background {{ {background} }}
             Materials {{ {glossy} {glass} {emissive} }} Group {{ {floor} {panes} {lights} }}"
        ));
        for color in [ColorMode::Rgb, ColorMode::Spectral] {
            let ways = by_ways(&world, below(), settings, color);
            for other in &ways[1..] {
                for ((a, va), (b, vb)) in ways[0].iter().zip(other) {
                    assert!((a - b).abs() < 3.6 * (va + vb).sqrt(), "{background}, {color:?}: {ways:?}");
                }
            }
            assert!(ways[2][1].1 > ways[0][1].1, "{background}, {color:?}: {ways:?}");
        }
    }
}

#[test]
fn photons_count_the_light_of_a_disc_through_a_pane_once() {
    let world = below_disc("transmissionWeight 1 specularRoughness 0 walls thin");
    let (a, _) = light(&world, below(), 12, 1 << 13);
    let (b, error) = by_photons(&world, below(), (20_000, 0.3), 24);
    assert!((a - b).abs() < 3.5 * error + 0.01 * a, "{a}, {b} ± {error}");
}
