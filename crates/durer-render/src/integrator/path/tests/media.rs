//! Tests of light in fog and in objects with interior media.

use super::*;
use durer_scene::spectrum::ColorMode;

/// Material of a closed shell of radiance 1 that light sampling can choose.
const SHELL: &str = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 1 walls thin }";

fn inside_shell(material: &str, fog: &str, group: &str) -> World {
    read(&format!(
        "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }}\nBackground {{ color 0 0 0 }}\n{fog}\n\
         Materials {{ {SHELL} {material} }}\nGroup {{ MaterialIndex 0 Sphere {{ center 0 0 0 radius 20 }} MaterialIndex 1 {group} }}"
    ))
}

#[test]
fn media_without_absorption_vanish_in_uniform_light() {
    let ball = "Sphere { center 0 0 0 radius 1 }";
    let ray = Ray::new(Vec3::new(0.3, 0.4, 5.0), Vec3::new(0.02, -0.01, -1.0));
    let fog = "Fog { extinction 0.6 min -2 -2 -2 max 2 2 2 anisotropy 0.4 }";
    let nothing = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 opacity 0 }";
    assert_light("fog in a box", &inside_shell(nothing, fog, ball), ray, 200, 1.0);
    // The transmittance is e^-1 at depth 1, and all of the extinction, which is 1 / depth, is
    // scattering.
    let through = "transmissionWeight 1 transmissionDepth 0.5 transmissionColor 0.36787944 0.36787944 0.36787944 \
                   transmissionScatter 1 1 1";
    for (name, rest) in [("cloud", "specularIor 1"), ("milky glass", "specularIor 1.5 specularRoughness 0")] {
        let material = format!("PrincipledMaterial {{ {through} {rest} }}");
        assert_light(name, &inside_shell(&material, "", ball), ray, 200, 1.0);
    }
    let marble = "PrincipledMaterial { subsurfaceWeight 1 subsurfaceColor 1 1 1 subsurfaceRadius 0.4 \
                  subsurfaceRadiusScale 1 1 1 specularRoughness 0.4 }";
    assert_light("marble", &inside_shell(marble, "", ball), ray, 60, 1.0);
    let paper = "PrincipledMaterial { subsurfaceWeight 1 subsurfaceColor 1 1 1 walls thin specularRoughness 0.4 }";
    assert_light("paper", &inside_shell(paper, "", ball), ray, 400, 1.0);
}

#[test]
fn single_scattering_of_a_beam_matches_its_integral() {
    // Light from above causes the irradiance pi c. For a horizontal ray at depth d that passes
    // through the fog over a length l, L = albedo / (4 pi) · pi c · e^(-s d) (1 - e^(-s l)).
    let (s, albedo, d, l) = (0.7_f64, 0.6, 0.8, 3.0);
    let world = read(
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }\nBackground { color 0 0 0 }\n\
         Fog { extinction 0.7 color 0.6 0.6 0.6 min -1.5 -1 -9 max 1.5 0.8 9 }\n\
         Lights { DirectionalLight { direction 0 -1 0 color 2 2 2 } }\nGroup { }",
    );
    let expected = albedo / 4.0 * 2.0 * libm::exp(-s * d) * (1.0 - libm::exp(-s * l));
    assert_light("beam", &world, Ray::new(Vec3::new(-4.0, 0.0, 0.0), Vec3::X), 0, expected);
    // The fog attenuates the background.
    let world = inside_shell(
        MATTE,
        "Fog { extinction 0.25 color 0 0 0 min 1 -1 -1 max 3 1 1 }",
        "Sphere { center 0 9 0 radius 1 }",
    );
    assert_light("absorbing", &world, Ray::new(Vec3::ZERO, Vec3::X), 4, libm::exp(-0.5));
}

#[test]
fn light_sampling_passes_index_matched_surfaces() {
    // Build a box of smoke, first as fog and then as an object with an index-matched surface.
    let emitter = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 5 }";
    let at = |fog: &str, material: &str, group: &str| {
        read(&format!(
            "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }}\nBackground {{ color 0 0 0 }}\n{fog}\n\
             Materials {{ {emitter} {material} }}\nGroup {{ MaterialIndex 0 Sphere {{ center 0 3 0 radius 0.5 }} {group} }}"
        ))
    };
    let fog = at("Fog { extinction 1 color 0.8 0.8 0.8 anisotropy 0.3 min -1 -1 -1 max 1 1 1 }", "", "");
    let smoke = "PrincipledMaterial { specularIor 1 transmissionWeight 1 transmissionDepth 1 \
                 transmissionColor 0.36787944 0.36787944 0.36787944 transmissionScatter 0.8 0.8 0.8 \
                 transmissionScatterAnisotropy 0.3 }";
    let body = at("", smoke, "MaterialIndex 1 Box { min -1 -1 -1 max 1 1 1 }");
    let ray = Ray::new(Vec3::new(0.2, 0.1, 5.0), Vec3::NEG_Z);
    let ((a, ea), (b, eb)) = (light(&fog, ray, 8, 1 << 14), light(&body, ray, 8, 1 << 14));
    assert!(a > 0.0 && (a - b).abs() < 4.0 * (ea * ea + eb * eb).sqrt(), "{a} ± {ea}, {b} ± {eb}");
}

#[test]
fn spectral_rendering_keeps_grey_and_approximates_colours() {
    let world = over_floor("", "Sphere { center 0 3 0 radius 0.5 }");
    let settings = RenderSettings { bounces: 2, ..Job::default().settings };
    let path = |color| Path::new(&world, settings, PathOptions { color, ..PathOptions::default() });
    let samples = 1 << 14;
    let mean = |color| {
        let path = path(color);
        let all = (0..samples).map(|i| path.radiance(&to_origin(), SampleId::new(7, (3, 5), i), &mut ()).as_dvec3());
        all.sum::<glam::DVec3>() / f64::from(samples)
    };
    let (rgb, spectral) = (mean(ColorMode::Rgb), mean(ColorMode::Spectral));
    assert!((rgb - spectral).abs().max_element() < 4e-3 * rgb.x, "{rgb} {spectral}");
}

#[test]
fn glass_disperses_by_its_abbe_number() {
    let material = durer_scene::material::PrincipledMaterial {
        transmission_weight: 1.0,
        transmission_dispersion_scale: 0.5,
        transmission_dispersion_abbe_number: 32.0,
        ..Default::default()
    };
    let [c, d, f] = [656.3, 587.6, 486.1].map(|nm| material.ior_at(Some(nm)));
    assert_eq!((d, material.ior_at(None)), (1.5, 1.5));
    assert!(((d - 1.0) / (f - c) - 64.0).abs() < 0.05, "{}", (d - 1.0) / (f - c));
}
