//! Lobes and layers: what they give back, and whether they sample what they say.

use super::lobe::blinn::Blinn;
use super::lobe::diffuse::{Diffuse, DiffuseTransmission};
use super::lobe::fuzz::Fuzz;
use super::lobe::rough::{Facet, Rough};
use super::lobe::rough_glass::RoughGlass;
use super::microfacet::Ggx;
use super::*;
use crate::material::PrincipledMaterial;
use crate::material::principled::Walls;
use crate::math::random::Random;
use crate::sampler;
use crate::spectrum::Lanes;
use std::f64::consts::TAU;

/// A direction seen from above, at a cosine.
fn seen(cosine: f32, turn: f32) -> Vec3 {
    warp::polar(cosine, turn)
}

/// One of each lobe that scatters into many directions, with names.
fn broad() -> Vec<(&'static str, Lobe)> {
    let rough = |roughness, anisotropy, facet, behind| {
        Lobe::from(Rough { ggx: Ggx::new(roughness, anisotropy).clamped(), facet, behind })
    };
    let glass = |roughness, eta| {
        Lobe::from(RoughGlass {
            ggx: Ggx::new(roughness, 0.0).clamped(),
            eta,
            reflected: Spectrum::ONE,
            transmitted: Spectrum::ONE,
        })
    };
    vec![
        ("Lambert", Diffuse { color: Spectrum::ONE, roughness: 0.0 }.into()),
        ("rough matte", Diffuse { color: Spectrum::ONE, roughness: 1.0 }.into()),
        ("matte, other side", DiffuseTransmission { color: Spectrum::ONE }.into()),
        ("Blinn", Blinn { color: Spectrum::ONE, exponent: 30.0, phong: false }.into()),
        ("Phong", Blinn { color: Spectrum::ONE, exponent: 12.0, phong: true }.into()),
        ("fuzz", Fuzz { roughness: 0.4 }.into()),
        ("rough metal", rough(0.5, 0.0, Facet::Metal(fresnel::F82::WHITE), false)),
        ("brushed metal", rough(0.7, 0.6, Facet::Metal(fresnel::F82::WHITE), false)),
        ("very rough plastic", rough(1.0, 0.0, Facet::Dielectric(1.5), false)),
        ("rough pane, front", rough(0.6, 0.0, Facet::Slab(1.5), false)),
        ("rough pane, back", rough(0.6, 0.0, Facet::BehindSlab(1.5), true)),
        ("rough glass", glass(0.5, 1.5)),
        ("rough glass from inside", glass(0.6, 1.0 / 1.5)),
    ]
}

/// The upper share of a chi-square distribution, as a normal deviate.
///
/// Source: Wilson and Hilferty, *The Distribution of Chi-Square*, 1931.
fn deviate(chi2: f64, freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    (libm::cbrt(chi2 / freedom) - (1.0 - spread)) / spread.sqrt()
}

/// The directions that a lobe samples against its density, in cells of equal solid angle: chi-square as a normal deviate.
fn sampling_error(lobe: Lobe, wo: Vec3, random: &mut Random) -> (f64, f64) {
    const ROWS: usize = 60;
    const COLUMNS: usize = 80;
    const SAMPLES: u32 = 200_000;
    const FINE: usize = 12;
    let mut counts = vec![0.0_f64; ROWS * COLUMNS + 1];
    for _ in 0..SAMPLES {
        let (choice, u) = (random.between(0.0, 1.0), Vec2::new(random.between(0.0, 1.0), random.between(0.0, 1.0)));
        let cell = lobe.sample(wo, choice, u).map_or(ROWS * COLUMNS, |scattered| {
            let wi = scattered.wi;
            let turn = (libm::atan2(f64::from(wi.y), f64::from(wi.x)) / TAU).rem_euclid(1.0);
            let row = ((0.5 * (1.0 - f64::from(wi.z)) * ROWS as f64) as usize).min(ROWS - 1);
            row * COLUMNS + ((turn * COLUMNS as f64) as usize).min(COLUMNS - 1)
        });
        counts[cell] += 1.0;
    }
    let solid = 2.0 * TAU / (ROWS * COLUMNS) as f64;
    let mut expected: Vec<f64> = (0..ROWS * COLUMNS)
        .map(|cell| {
            let fine = (0..FINE * FINE).map(|i| {
                let row = (cell / COLUMNS) as f64 + ((i / FINE) as f64 + 0.5) / FINE as f64;
                let column = (cell % COLUMNS) as f64 + ((i % FINE) as f64 + 0.5) / FINE as f64;
                let wi = warp::polar((1.0 - 2.0 * row / ROWS as f64) as f32, (column / COLUMNS as f64) as f32);
                f64::from(lobe.pdf(wo, wi))
            });
            fine.sum::<f64>() / (FINE * FINE) as f64 * solid * f64::from(SAMPLES)
        })
        .collect();
    let all: f64 = expected.iter().sum();
    // What was not sampled is what is left of 1.
    expected.push((f64::from(SAMPLES) - all).max(0.0));
    let mut cells: Vec<(f64, f64)> = expected.into_iter().zip(counts).collect();
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut chi2, mut freedom, mut pooled) = (0.0, -1.0, (0.0, 0.0));
    for (expected, count) in cells {
        pooled = (pooled.0 + expected, pooled.1 + count);
        if pooled.0 >= 20.0 {
            chi2 += (pooled.1 - pooled.0) * (pooled.1 - pooled.0) / pooled.0;
            freedom += 1.0;
            pooled = (0.0, 0.0);
        }
    }
    (deviate(chi2, freedom), all / f64::from(SAMPLES))
}

#[test]
fn lobes_sample_what_their_density_says() {
    let mut random = Random(11);
    let mut worst: (f64, String) = (0.0, String::new());
    for (name, lobe) in broad() {
        for (cosine, turn) in [(0.95, 0.1), (0.6, 0.7), (0.25, 0.35)] {
            let (error, all) = sampling_error(lobe, seen(cosine, turn), &mut random);
            assert!(all < 1.005, "{name} at {cosine}: the density integrates to {all}");
            if error > worst.0 {
                worst = (error, format!("{name} at {cosine}: density in all {all}"));
            }
        }
    }
    // 36 tests at a significance of 0.01 in all, by Sidak: 2.8e-4 each.
    assert!(worst.0 < 3.45, "{worst:?}");
}

#[test]
fn reflecting_lobes_are_the_same_both_ways() {
    let mut random = Random(12);
    for (name, lobe) in broad() {
        for _ in 0..500 {
            let wo = seen(random.between(0.05, 1.0), random.between(0.0, 1.0));
            let wi = seen(random.between(0.05, 1.0), random.between(0.0, 1.0));
            let there = lobe.eval(wo, wi) / wi.z;
            let back = lobe.eval(wi, wo) / wo.z;
            assert!((there - back).abs().max_element() <= 1e-4 * (1.0 + there.max_element()), "{name}: {there} {back}");
        }
    }
}

/// What a material gives back of even light from all around, and the standard error of that.
fn given(bsdf: &Bsdf, wo: Vec3, samples: u32) -> (f64, f64) {
    let mut sums = (0.0, 0.0);
    for i in 0..samples {
        let u = sampler::sample_2d(1, 0, 0, i, 3);
        let choice = sampler::sample_2d(1, 0, 0, i, 2).x;
        let weight = bsdf.sample(wo, choice, u).map_or(0.0, |s| f64::from(s.weight.x));
        sums = (sums.0 + weight, sums.1 + weight * weight);
    }
    let mean = sums.0 / f64::from(samples);
    // Points that are even have less error than this, and never more by much.
    (mean, ((sums.1 / f64::from(samples) - mean * mean).max(0.0) / f64::from(samples)).sqrt())
}

fn white() -> PrincipledMaterial {
    PrincipledMaterial { base_color: Vec3::ONE, ..Default::default() }
}

#[test]
fn what_absorbs_nothing_is_white_in_even_light() {
    let lossless = [
        ("matte under a boundary", white()),
        ("rough matte", PrincipledMaterial { base_diffuse_roughness: 1.0, ..white() }),
        ("metal", PrincipledMaterial { base_metalness: 1.0, ..white() }),
        ("glass", PrincipledMaterial { transmission_weight: 1.0, ..white() }),
        ("thin glass", PrincipledMaterial { transmission_weight: 1.0, walls: Walls::Thin, ..white() }),
        ("coat on matte", PrincipledMaterial { coat_weight: 1.0, coat_roughness: 0.3, ..white() }),
        ("coat on metal", PrincipledMaterial { coat_weight: 0.7, base_metalness: 1.0, ..white() }),
        ("fuzz", PrincipledMaterial { fuzz_weight: 1.0, ..white() }),
        ("half metal", PrincipledMaterial { base_metalness: 0.5, ..white() }),
    ];
    for (name, material) in lossless {
        let mut known = Vec::new();
        let tables = Tables::new(&material, &mut known);
        for roughness in [0.0, 0.1, 0.3, 0.5, 0.8, 1.0] {
            let layers = Layers { roughness, ..Layers::of(&material) };
            for cosine in [0.999, 0.7, 0.4, 0.2] {
                let wo = seen(cosine, 0.0);
                let bsdf = scattering_of(&material, &layers, &tables, wo);
                let (mean, error) = given(&bsdf, wo, 1 << 14);
                // Rough glass carries light of other densities: weighed by the square of its index it is 1 too, so that
                // only its own side is compared.
                let mean = if material.transmission_weight > 0.0 { through(&bsdf, wo, mean) } else { mean };
                assert!((mean - 1.0).abs() < 0.004 + 3.0 * error, "{name}, {roughness}, {cosine}: {mean} ± {error}");
            }
        }
    }
}

fn scattering_of(material: &PrincipledMaterial, layers: &Layers, tables: &Tables, wo: Vec3) -> Bsdf {
    let view = layers::View { lanes: &Lanes::Rgb, wo, inside: false, eta: material.specular_ior };
    layers::scattering(material, layers, tables, view)
}

/// The same where what went into glass counts by flux and not by radiance.
fn through(bsdf: &Bsdf, wo: Vec3, plain: f64) -> f64 {
    let eta = bsdf.lobes().find_map(|part| match part.lobe {
        Lobe::RoughGlass(glass) => Some(glass.eta),
        Lobe::Refraction(glass) => Some(glass.eta),
        _ => None,
    });
    let Some(eta) = eta else { return plain };
    let samples = 1 << 14;
    let one = |i: u32| {
        let (choice, u) = (sampler::sample_2d(1, 0, 0, i, 2).x, sampler::sample_2d(1, 0, 0, i, 3));
        let flux = |s: BsdfSample| f64::from(s.weight.x * if s.wi.z < 0.0 { eta * eta } else { 1.0 });
        bsdf.sample(wo, choice, u).map_or(0.0, flux)
    };
    (0..samples).map(one).sum::<f64>() / f64::from(samples)
}

#[test]
fn nothing_gives_back_more_than_it_gets() {
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
        let tables = TABLES.get_or_init(|| Tables::new(&material, &mut Vec::new()));
        let wo = seen(share().max(0.02), share());
        let bsdf = scattering_of(&material, &Layers::of(&material), tables, wo);
        let (mean, error) = given(&bsdf, wo, 1 << 12);
        assert!(mean < 1.01 + 4.0 * error, "{round}: {mean} ± {error} from {material:?} at {wo}");
    }
}

static TABLES: std::sync::OnceLock<Tables> = std::sync::OnceLock::new();

#[test]
fn fresnel_and_its_mean_agree() {
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
    // At 82 degrees a metal of tint t reflects t of Schlick's curve.
    let f0 = Spectrum::new(0.9, 0.6, 0.3, 0.6);
    let (plain, tinted) = (fresnel::F82::new(f0, Spectrum::ONE), fresnel::F82::new(f0, Spectrum::splat(0.8)));
    assert!((tinted.at(1.0 / 7.0) - 0.8 * plain.at(1.0 / 7.0)).abs().max_element() < 1e-5);
    assert!((tinted.at(1.0) - f0).abs().max_element() < 1e-6);
}

#[test]
fn highlights_of_the_course_give_back_less_than_their_bound() {
    for (exponent, phong) in [(1.0, false), (5.0, false), (40.0, false), (1.0, true), (25.0, true)] {
        for cosine in [1.0, 0.7, 0.3, 0.05] {
            let mut bsdf = Bsdf::default();
            bsdf.push(Blinn { color: Spectrum::ONE, exponent, phong }, Spectrum::ONE, 1.0);
            let (mean, _) = given(&bsdf, seen(cosine, 0.0), 1 << 14);
            assert!(mean <= f64::from(Blinn::bound(exponent)), "{exponent} {phong} {cosine}: {mean}");
        }
    }
}

#[test]
fn a_frame_turns_there_and_back() {
    let mut random = Random(14);
    for _ in 0..1_000 {
        let (n, v) = (random.direction(), random.direction());
        for frame in [Frame::around(n), Frame::along(n, v)] {
            assert!((frame.to_world(frame.to_local(v)) - v).length() < 1e-5);
            assert!((frame.to_local(n) - Vec3::Z).length() < 1e-5);
        }
    }
}
