//! Tests lobes and layers for their albedo, for reciprocity, and for the agreement of samples with
//! the pdf.

use super::lobe::blinn::Blinn;
use super::validation::{
    DirectionGrid, Furnace, FurnaceView, brushed, bsdf_from_outside, lossless, non_delta_lobes, reflectance, with_films,
};
use super::*;
use crate::material::{Parameters, PrincipledMaterial};
use crate::math::fp;
use crate::math::random::Random;

#[test]
fn every_lobe_has_a_case() {
    // Delta lobes have no pdf to compare with.
    let delta = ["Mirror", "Refraction", "Through"];
    let cases: Vec<&str> = non_delta_lobes().iter().map(|(_, lobe)| lobe.name()).collect();
    for name in Lobe::NAMES {
        assert_ne!(cases.contains(name), delta.contains(name), "add a case for `{name}` to `non_delta_lobes`");
    }
}

#[test]
fn lobe_samples_agree_with_pdf() {
    // `cargo xtask validate` runs this test with a million samples for each lobe.
    let cells = DirectionGrid { rows: 60, columns: 80, samples: 200_000, fine: 12 };
    for (name, lobe) in non_delta_lobes() {
        for (cosine, turn) in [(0.95, 0.1), (0.6, 0.7), (0.25, 0.35)] {
            let verdict = cells.lobe(11, lobe, warp::polar(cosine, turn));
            // The 48 tests have a total significance of 0.01. By Šidák's correction, the
            // significance of each test is 2.1e-4.
            assert!(verdict.density < 1.005 && verdict.deviate < 3.53, "{name} at {cosine}: {verdict:?}");
        }
    }
}

#[test]
fn reflecting_lobes_are_reciprocal() {
    let mut random = Random(12);
    // Exclude the bent normal, which affects the cosine on one side only. Also exclude fibres,
    // whose offset depends on the view.
    let others = ["matte with bent normal", "hair", "fur"];
    for (name, lobe) in non_delta_lobes().into_iter().filter(|(name, _)| !others.contains(name)) {
        for _ in 0..500 {
            let wo = warp::polar(random.between(0.05, 1.0), random.between(0.0, 1.0));
            let wi = warp::polar(random.between(0.05, 1.0), random.between(0.0, 1.0));
            let there = lobe.eval(wo, wi).0 / wi.z;
            let back = lobe.eval(wi, wo).0 / wo.z;
            assert!((there - back).abs().max_element() <= 1e-4 * (1.0 + there.max_element()), "{name}: {there} {back}");
        }
    }
}

#[test]
fn plastic_is_reciprocal() {
    let mut random = Random(15);
    let material = PrincipledMaterial { base_color: Vec3::new(0.9, 0.5, 0.1), ..Default::default() };
    for (ior, reflection) in [(1.1, 1.0), (1.5, 1.0), (1.5, 0.3), (2.5, 1.0)] {
        let material = PrincipledMaterial { specular_ior: ior, specular_roughness: 0.0, ..material.clone() };
        let tables = Tables::new(&material, None, &mut Vec::new());
        let here = Parameters { reflection, ..Parameters::of(&material) };
        for _ in 0..500 {
            let mut direction = || warp::polar(random.between(0.02, 1.0), random.between(0.0, 1.0));
            let (wo, wi) = (direction(), direction());
            let there = bsdf_from_outside(&here, &tables, wo).eval(wo, wi).0 / wi.z;
            let back = bsdf_from_outside(&here, &tables, wi).eval(wi, wo).0 / wo.z;
            assert!((there - back).abs().max_element() <= 1e-5, "{ior}, {reflection}: {there} {back}");
        }
    }
}

#[test]
fn lobes_are_finite_at_grazing_angles() {
    let heights = [0.0, -0.0, 1e-38, -1e-38, 1e-30, -1e-30, 1e-12, -1e-12, 1e-6, -1e-6];
    let nearly_flat = |z: f32, turn: f32| warp::polar(0.0, turn).with_z(z);
    for (name, lobe) in non_delta_lobes() {
        for wo in [nearly_flat(1e-6, 0.0), warp::polar(0.3, 0.0), Vec3::Z] {
            for (z, turn) in heights.iter().flat_map(|&z| [0.0, 0.2, 0.5].map(|turn| (z, turn))) {
                let wi = nearly_flat(z, turn);
                let (value, density) = lobe.eval(wo, wi);
                assert!(value.is_finite() && density.is_finite(), "{name}, {wo} {wi}: {value} {density}");
            }
        }
    }
}

/// Asserts that the albedo of each material differs from 1 by at most `most` plus three standard
/// errors, for several roughnesses and angles.
fn assert_white(materials: Vec<(&str, PrincipledMaterial)>, roughnesses: &[f32], most: f64) {
    for (name, material) in materials {
        let furnace = Furnace::new(&material);
        for (roughness, cosine) in roughnesses.iter().flat_map(|&r| [0.999, 0.7, 0.4, 0.2].map(|cosine| (r, cosine))) {
            let (mean, error) = furnace.albedo(roughness, cosine, 1 << 14);
            assert!((mean - 1.0).abs() < most + 3.0 * error, "{name}, {roughness}, {cosine}: {mean} ± {error}");
        }
    }
}

#[test]
fn lossless_materials_are_white_in_a_furnace() {
    // `cargo xtask validate` runs this test with more samples.
    assert_white(lossless(), &[0.0, 0.1, 0.3, 0.5, 0.8, 1.0], 0.002);
    assert_white(with_films(), &[0.0], 0.002);
}

#[test]
fn lossless_anisotropic_materials_are_white_in_a_furnace() {
    for (name, material) in brushed() {
        let furnace = Furnace::new(&material);
        let sides = if material.base_metalness > 0.0 { &[false][..] } else { &[false, true] };
        for (&inside, roughness) in sides.iter().flat_map(|side| [0.2, 0.5, 1.0].map(|roughness| (side, roughness))) {
            for (anisotropy, cosine) in [0.3, 0.9, 1.0].into_iter().flat_map(|a| [0.999, 0.6, 0.2].map(|c| (a, c))) {
                for turn in [0.0, 0.07, 0.2, 0.25] {
                    let from = FurnaceView { roughness, anisotropy, cosine, turn, inside, eta: None };
                    let (mean, error) = furnace.albedo_for(from, 1 << 12);
                    assert!((mean - 1.0).abs() < 0.002 + 3.0 * error, "{name}, {from:?}: {mean} ± {error}");
                }
            }
        }
    }
}

#[test]
fn rough_glass_in_another_medium_is_nearly_white() {
    let material = PrincipledMaterial { transmission_weight: 1.0, base_color: Vec3::ONE, ..Default::default() };
    let furnace = Furnace::new(&material);
    for (eta, inside) in [(1.5 / 1.33, false), (1.33 / 1.5, true), (1.0 / 1.8, false), (2.4, true)] {
        for (roughness, cosine) in [0.3, 0.6, 1.0].into_iter().flat_map(|r| [0.999, 0.6, 0.2].map(|c| (r, c))) {
            let from = FurnaceView { roughness, cosine, inside, eta: Some(eta), ..FurnaceView::default() };
            let (mean, error) = furnace.albedo_for(from, 1 << 13);
            assert!((mean - 1.0).abs() < 0.01 + 3.0 * error, "{from:?}: {mean} ± {error}");
        }
    }
}

#[test]
fn rough_films_are_nearly_white() {
    assert_white(with_films(), &[0.1, 0.3, 0.6], 0.02);
}

#[test]
fn materials_reflect_no_more_light_than_arrives() {
    let mut random = Random(13);
    for round in 0..300 {
        let mut share = || random.between(0.0, 1.0);
        let material = PrincipledMaterial {
            base_color: Vec3::new(share(), share(), share()),
            base_metalness: share(),
            base_diffuse_roughness: share(),
            specular_roughness: share(),
            specular_anisotropy: share(),
            coat_weight: share(),
            coat_roughness: share(),
            fuzz_weight: share(),
            fuzz_roughness: share(),
            ..Default::default()
        };
        let tables = TABLES.get_or_init(|| Tables::new(&material, None, &mut Vec::new()));
        let wo = warp::polar(share().max(0.02), share());
        let bsdf = bsdf_from_outside(&Parameters::of(&material), tables, wo);
        let (mean, error) = reflectance(&bsdf, wo, 1 << 12);
        assert!(mean < 1.01 + 4.0 * error, "{round}: {mean} ± {error} from {material:?} at {wo}");
    }
}

static TABLES: std::sync::OnceLock<Tables> = std::sync::OnceLock::new();

#[test]
fn sheet_agrees_with_sum_over_internal_reflections() {
    for (eta, left, cosine) in [(1.5, 1.0, 1.0), (1.52, 0.5, 0.7), (1.3, 0.9, 0.1), (2.0, 0.0, 0.5), (0.8, 0.3, 0.9)] {
        let (sine2, c) = ((1.0 - cosine * cosine) / (eta * eta), cosine);
        let inside = f64::sqrt(1.0 - sine2);
        let once = f64::from(fp::pow(left as f32, (1.0 / inside) as f32));
        let faces = [(eta * c - inside) / (eta * c + inside), (c - eta * inside) / (c + eta * inside)];
        let (mut reflected, mut through) = (0.0, 0.0);
        for face in faces.map(|amplitude| amplitude * amplitude) {
            reflected += 0.5 * face;
            let mut light = 0.5 * (1.0 - face) * once;
            for way in 0..200 {
                *(if way % 2 == 0 { &mut through } else { &mut reflected }) += light * (1.0 - face);
                light *= face * once;
            }
        }
        let sheet = fresnel::Sheet { eta: eta as f32, inside: Some(Spectrum::splat(left as f32)) };
        let (up, down) = sheet.at(cosine as f32);
        let near = |a: Spectrum, b: f64| (f64::from(a[0]) - b).abs() < 1e-5;
        assert!(
            near(up, reflected) && near(down, through),
            "{eta} {left} {cosine}: {up} {down}, {reflected} {through}"
        );
    }
    // Without a depth, unpolarised light is assumed at each face. `with_front_face` replaces the
    // reflectance of one face.
    let plain = fresnel::Sheet { eta: 1.5, inside: None };
    for (up, down) in [plain.at(1.0), plain.with_front_face(Spectrum::splat(0.04), 1.0)] {
        assert!((up[0] - 0.08 / 1.04).abs() < 1e-6 && (down[0] - 0.96 / 1.04).abs() < 1e-6, "{up} {down}");
    }
}

#[test]
fn diffuse_fresnel_is_the_mean_of_fresnel() {
    for eta in [1.1_f32, 1.33, 1.5, 2.0, 1.0 / 1.33, 1.0 / 1.5] {
        let steps = 20_000;
        let sum: f64 = (0..steps)
            .map(|i| (f64::from(i) + 0.5) / f64::from(steps))
            .map(|mu| 2.0 * mu * f64::from(fresnel::dielectric(mu as f32, eta)))
            .sum();
        let mean = sum / f64::from(steps);
        assert!((mean - f64::from(fresnel::diffuse(eta))).abs() < 0.006, "{eta}: {mean} {}", fresnel::diffuse(eta));
    }
    assert!((fresnel::dielectric(1.0, 1.5) - 0.04).abs() < 1e-6);
    assert_eq!(fresnel::dielectric(0.1, 1.0 / 1.5), 1.0);
    // At 82 degrees, a metal with tint t reflects t times the value of Schlick's curve.
    let f0 = Spectrum::new(0.9, 0.6, 0.3, 0.6);
    let (plain, tinted) = (fresnel::F82::new(f0, Spectrum::ONE), fresnel::F82::new(f0, Spectrum::splat(0.8)));
    assert!((tinted.at(1.0 / 7.0) - 0.8 * plain.at(1.0 / 7.0)).abs().max_element() < 1e-5);
    assert!((tinted.at(1.0) - f0).abs().max_element() < 1e-6);
}

#[test]
fn highlights_of_the_course_stay_below_their_bound() {
    for (exponent, phong) in [(1.0, false), (5.0, false), (40.0, false), (1.0, true), (25.0, true)] {
        for cosine in [1.0, 0.7, 0.3, 0.05] {
            let mut bsdf = Bsdf::default();
            bsdf.push(Blinn { color: Spectrum::ONE, exponent, phong }, Spectrum::ONE, 1.0);
            let (mean, _) = reflectance(&bsdf, warp::polar(cosine, 0.0), 1 << 14);
            assert!(mean <= f64::from(Blinn::bound(exponent)), "{exponent} {phong} {cosine}: {mean}");
        }
    }
}

#[test]
fn frame_round_trips_directions() {
    let mut random = Random(14);
    for _ in 0..1_000 {
        let (n, v) = (random.direction(), random.direction());
        for frame in [Frame::around(n), Frame::along(n, v)] {
            assert!((frame.to_world(frame.to_local(v)) - v).length() < 1e-5);
            assert!((frame.to_local(n) - Vec3::Z).length() < 1e-5);
        }
    }
}
