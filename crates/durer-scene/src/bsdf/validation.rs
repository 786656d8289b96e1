//! Numerical checks that samples agree with their pdf, and that lossless materials are white in a
//! furnace. Tests run these checks with few samples, and `cargo xtask validate` runs them with
//! many.

use super::lobe::blinn::Blinn;
use super::lobe::diffuse::{Diffuse, DiffuseTransmission};
use super::lobe::disney::{DisneyCoat, DisneyDiffuse};
use super::lobe::fuzz::Fuzz;
use super::lobe::hair::Fibre;
use super::lobe::rough::{Facet, RoughReflection};
use super::lobe::rough_glass::RoughGlass;
use super::microfacet::Ggx;
use super::{Bsdf, BsdfSample, Lobe, Scatter, Tables, fresnel, layers, view, warp};
use crate::material::principled::Walls;
use crate::material::{HairMaterial, Parameters, PrincipledMaterial};
use crate::math::{Vec2, Vec3, fp};
use crate::sampler;
use crate::spectrum::{Lanes, Spectrum};
use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

/// Grid of cells on the sphere that have equal solid angles. Samples are counted in these cells to
/// compare them with a pdf.
#[derive(Clone, Copy, Debug)]
pub struct DirectionGrid {
    /// Number of bands from pole to pole.
    pub rows: usize,
    /// Number of cells around each band.
    pub columns: usize,
    /// Number of samples.
    pub samples: u32,
    /// Number of points along each side of a cell at which the pdf is evaluated.
    pub fine: usize,
}

/// Result of comparing samples with their pdf, which consists of a chi-square test and the integral
/// of the pdf.
#[derive(Clone, Copy, Debug)]
pub struct PdfComparison {
    /// Chi-square statistic, converted to a standard normal deviate.
    pub deviate: f64,
    /// Integral of the pdf over all directions, which is 1 minus the probability of failed samples.
    pub density: f64,
}

impl DirectionGrid {
    fn cell(&self, wi: Vec3) -> usize {
        let turn = (fp::atan2_f64(f64::from(wi.y), f64::from(wi.x)) / TAU).rem_euclid(1.0);
        let row = ((0.5 * (1.0 - f64::from(wi.z)) * self.rows as f64) as usize).min(self.rows - 1);
        row * self.columns + ((turn * self.columns as f64) as usize).min(self.columns - 1)
    }

    /// Returns the expected number of samples in a cell.
    fn expected(&self, cell: usize, pdf: &impl Fn(Vec3) -> f32) -> f64 {
        let fine = self.fine;
        let point = |i: usize| {
            let row = (cell / self.columns) as f64 + ((i / fine) as f64 + 0.5) / fine as f64;
            let column = (cell % self.columns) as f64 + ((i % fine) as f64 + 0.5) / fine as f64;
            warp::polar((1.0 - 2.0 * row / self.rows as f64) as f32, (column / self.columns as f64) as f32)
        };
        let mean = (0..fine * fine).map(|i| f64::from(pdf(point(i)))).sum::<f64>() / (fine * fine) as f64;
        mean * 4.0 * PI / (self.rows * self.columns) as f64 * f64::from(self.samples)
    }

    /// Compares samples with their pdf. `sample` draws a sample from three numbers in [0, 1], and
    /// `seed` selects these numbers.
    pub fn compare(
        &self,
        seed: u64,
        sample: impl Fn(f32, Vec2) -> Option<Vec3>,
        pdf: impl Fn(Vec3) -> f32,
    ) -> PdfComparison {
        let all = self.rows * self.columns;
        let mut counts = vec![0.0_f64; all + 1];
        for i in 0..self.samples {
            let [choice, u] = [0, 1].map(|dimension| sampler::random_2d(seed, 0, 0, i, dimension));
            counts[sample(choice.x, u).map_or(all, |wi| self.cell(wi))] += 1.0;
        }
        let mut expected: Vec<f64> = (0..all).map(|cell| self.expected(cell, &pdf)).collect();
        let density = expected.iter().sum::<f64>() / f64::from(self.samples);
        // Failed samples account for the probability that is missing.
        expected.push((f64::from(self.samples) * (1.0 - density)).max(0.0));
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
        PdfComparison { deviate: deviate(chi2, freedom), density }
    }

    /// Compares the samples of a lobe with its pdf, for one view direction.
    pub fn lobe(&self, seed: u64, lobe: Lobe, wo: Vec3) -> PdfComparison {
        let sample = |choice, u| lobe.sample(wo, choice, u).map(|scattered| scattered.wi);
        self.compare(seed, sample, |wi| lobe.eval(wo, wi).1)
    }
}

/// Returns the upper tail of a chi-square distribution as a normal deviate.
///
/// Source: Wilson and Hilferty, *The Distribution of Chi-Square*, 1931.
fn deviate(chi2: f64, freedom: f64) -> f64 {
    // A lobe whose samples all fail, as by total internal reflection, leaves nothing to compare.
    if freedom < 1.0 {
        return 0.0;
    }
    let spread = 2.0 / (9.0 * freedom);
    let third = f64::from(fp::pow((chi2 / freedom) as f32, 1.0 / 3.0));
    (third - (1.0 - spread)) / spread.sqrt()
}

/// Returns named examples of every kind of lobe that is not a delta lobe.
pub fn non_delta_lobes() -> Vec<(&'static str, Lobe<'static>)> {
    let rough = |roughness, anisotropy, facet, transmits| {
        Lobe::from(RoughReflection { ggx: Ggx::new(roughness, anisotropy).clamped(), facet, transmits })
    };
    let glass = |roughness, eta| {
        Lobe::from(RoughGlass {
            ggx: Ggx::new(roughness, 0.0).clamped(),
            eta,
            reflected: Spectrum::ONE,
            transmitted: Spectrum::ONE,
        })
    };
    static FIBRES: LazyLock<[Fibre; 2]> = LazyLock::new(|| {
        [(0.3, 0.4, 0.3), (0.8, 0.9, 0.0)].map(|(longitudinal_roughness, azimuthal_roughness, eumelanin)| {
            Fibre::new(&HairMaterial { eumelanin, longitudinal_roughness, azimuthal_roughness, ..Default::default() })
        })
    });
    let hair = |i: usize| Lobe::from(FIBRES[i].lobe(&Lanes::Rgb));
    let (leaning, white) = (Vec3::new(0.6, 0.0, 0.8), fresnel::MetalCurve::F82(fresnel::F82::WHITE));
    vec![
        ("Lambert", Diffuse::lambert(Spectrum::ONE).into()),
        ("rough matte", Diffuse { roughness: 1.0, ..Diffuse::lambert(Spectrum::ONE) }.into()),
        (
            "matte with bent normal",
            Diffuse { normal: leaning, roughness: 0.5, ..Diffuse::lambert(Spectrum::ONE) }.into(),
        ),
        ("diffuse transmission", DiffuseTransmission { color: Spectrum::ONE }.into()),
        ("Blinn", Blinn { color: Spectrum::ONE, exponent: 30.0, phong: false }.into()),
        ("Phong", Blinn { color: Spectrum::ONE, exponent: 12.0, phong: true }.into()),
        ("fuzz", Fuzz { roughness: 0.4 }.into()),
        ("rough metal", rough(0.5, 0.0, Facet::Metal(white), false)),
        ("brushed metal", rough(0.7, 0.6, Facet::Metal(white), false)),
        ("very rough plastic", rough(1.0, 0.0, Facet::Dielectric(1.5), false)),
        ("rough pane, front", rough(0.6, 0.0, Facet::Sheet(fresnel::Sheet { eta: 1.5, inside: None }), false)),
        (
            "rough pane, back",
            rough(
                0.6,
                0.0,
                Facet::SheetTransmission(fresnel::Sheet { eta: 1.5, inside: Some(Spectrum::splat(0.5)) }),
                true,
            ),
        ),
        ("rough glass", glass(0.5, 1.5)),
        ("rough glass from inside", glass(0.6, 1.0 / 1.5)),
        (
            "Disney's base",
            DisneyDiffuse { color: Spectrum::ONE, sheen: Spectrum::ONE, roughness: 0.5, flatness: 0.5 }.into(),
        ),
        ("Disney's coat", DisneyCoat { alpha: 0.1, eta: 1.5 }.into()),
        ("hair", hair(0)),
        ("fur", hair(1)),
    ]
}

/// Returns named examples of lossless materials.
pub fn lossless() -> Vec<(&'static str, PrincipledMaterial)> {
    let white = || PrincipledMaterial { base_color: Vec3::ONE, ..Default::default() };
    vec![
        ("matte under a dielectric", white()),
        ("rough matte", PrincipledMaterial { base_diffuse_roughness: 1.0, ..white() }),
        ("moderately rough matte", PrincipledMaterial { base_diffuse_roughness: 0.4, specular_ior: 2.0, ..white() }),
        ("metal", PrincipledMaterial { base_metalness: 1.0, ..white() }),
        ("glass", PrincipledMaterial { transmission_weight: 1.0, ..white() }),
        ("thin glass", PrincipledMaterial { transmission_weight: 1.0, walls: Walls::Thin, ..white() }),
        ("coat on matte", PrincipledMaterial { coat_weight: 1.0, coat_roughness: 0.3, ..white() }),
        ("coat on metal", PrincipledMaterial { coat_weight: 0.7, base_metalness: 1.0, ..white() }),
        ("fuzz", PrincipledMaterial { fuzz_weight: 1.0, ..white() }),
        ("half metallic", PrincipledMaterial { base_metalness: 0.5, ..white() }),
        ("matte under a dielectric of index 4", PrincipledMaterial { specular_ior: 4.0, ..white() }),
        ("matte under a dielectric of index 1.05", PrincipledMaterial { specular_ior: 1.05, ..white() }),
        ("rough coat on matte", PrincipledMaterial { coat_weight: 1.0, coat_roughness: 0.8, coat_ior: 2.5, ..white() }),
        ("smooth coat on glass", PrincipledMaterial { coat_weight: 1.0, transmission_weight: 1.0, ..white() }),
        (
            "sharp fuzz on metal",
            PrincipledMaterial { fuzz_weight: 1.0, fuzz_roughness: 0.1, base_metalness: 1.0, ..white() },
        ),
        ("dense glass", PrincipledMaterial { transmission_weight: 1.0, specular_ior: 2.5, ..white() }),
    ]
}

/// Returns named examples of lossless glossy materials, for tests of anisotropy.
pub fn brushed() -> Vec<(String, PrincipledMaterial)> {
    let white = || PrincipledMaterial { base_color: Vec3::ONE, ..Default::default() };
    let glass = |ior| PrincipledMaterial { transmission_weight: 1.0, specular_ior: ior, ..white() };
    let mut all = vec![
        ("brushed metal".to_string(), PrincipledMaterial { base_metalness: 1.0, ..white() }),
        ("brushed thin glass".to_string(), PrincipledMaterial { walls: Walls::Thin, ..glass(1.5) }),
    ];
    all.extend([1.1, 1.5, 2.5, 10.0].map(|ior| (format!("brushed glass of index {ior}"), glass(ior))));
    all
}

/// Returns named examples of lossless materials with films. The albedo of rough materials with
/// films is approximate.
pub fn with_films() -> Vec<(&'static str, PrincipledMaterial)> {
    let film = || PrincipledMaterial { base_color: Vec3::ONE, thin_film_weight: 1.0, ..Default::default() };
    let bubble = PrincipledMaterial { specular_ior: 1.0, transmission_weight: 1.0, walls: Walls::Thin, ..film() };
    let glass = PrincipledMaterial { thin_film_weight: 0.8, thin_film_ior: 1.9, transmission_weight: 1.0, ..film() };
    vec![("film on a matte base", film()), ("soap film", bubble), ("film on glass", glass)]
}

/// White furnace, in which a material is lit uniformly from all directions to measure its albedo.
pub struct Furnace<'a> {
    material: &'a PrincipledMaterial,
    tables: Tables,
}

impl<'a> Furnace<'a> {
    /// Creates a furnace for a material.
    pub fn new(material: &'a PrincipledMaterial) -> Self {
        Furnace { material, tables: Tables::new(material, None, &mut Vec::new()) }
    }

    /// Returns the albedo for a roughness and a view cosine, and the standard error of the albedo.
    /// Light that enters glass is measured as flux, since its radiance grows with the square of the
    /// index.
    pub fn albedo(&self, roughness: f32, cosine: f32, samples: u32) -> (f64, f64) {
        self.albedo_for(FurnaceView { roughness, cosine, ..FurnaceView::default() }, samples)
    }

    /// Returns the albedo for any view, and the standard error of the albedo.
    pub fn albedo_for(&self, from: FurnaceView, samples: u32) -> (f64, f64) {
        let here = Parameters {
            specular_roughness: from.roughness,
            specular_anisotropy: from.anisotropy,
            ..Parameters::of(self.material)
        };
        let wo = warp::polar(from.cosine, from.turn);
        let eta = from.eta.unwrap_or(if from.inside { 1.0 / here.specular_ior } else { here.specular_ior });
        reflectance(&bsdf_for(&here, &self.tables, wo, from.inside, eta), wo, samples)
    }
}

/// Input of a furnace test: viewing direction, roughness, anisotropy and index of refraction.
#[derive(Clone, Copy, Debug, Default)]
pub struct FurnaceView {
    /// Roughness.
    pub roughness: f32,
    /// Anisotropy.
    pub anisotropy: f32,
    /// Cosine of the angle between the view direction and the normal.
    pub cosine: f32,
    /// Azimuth of the view direction, in turns.
    pub turn: f32,
    /// True if the material is seen from inside.
    pub inside: bool,
    /// Index behind the boundary, relative to the index in front of it, or `None` if the material
    /// is in air.
    pub eta: Option<f32>,
}

/// Returns the BSDF of a material seen from outside.
#[cfg(test)]
pub(super) fn bsdf_from_outside<'a>(here: &Parameters, tables: &'a Tables, wo: Vec3) -> Bsdf<'a> {
    bsdf_for(here, tables, wo, false, here.specular_ior)
}

fn bsdf_for<'a>(here: &Parameters, tables: &'a Tables, wo: Vec3, inside: bool, eta: f32) -> Bsdf<'a> {
    let view = view::View { lanes: &Lanes::Rgb, wo, normal: Vec3::Z, inside, eta };
    let mut bsdf = Bsdf::default();
    layers::push_lobes(&mut bsdf, 1.0, here, tables, view);
    bsdf
}

/// Estimates the albedo of a BSDF by sampling. Returns the albedo and its standard error.
pub(super) fn reflectance(bsdf: &Bsdf, wo: Vec3, samples: u32) -> (f64, f64) {
    let eta = bsdf.lobes().find_map(|part| part.lobe.kind().eta);
    let denser = eta.map_or(1.0, |eta| eta * eta);
    let flux = |s: BsdfSample| f64::from(s.weight.x * if s.wi.z < 0.0 { denser } else { 1.0 });
    let mut sums = (0.0, 0.0);
    for i in 0..samples {
        let u = sampler::sample_2d(1, 0, 0, i, 3);
        let choice = sampler::sample_2d(1, 0, 0, i, 2).x;
        let weight = bsdf.sample(wo, choice, u).map_or(0.0, flux);
        sums = (sums.0 + weight, sums.1 + weight * weight);
    }
    let n = f64::from(samples);
    let mean = sums.0 / n;
    // The points are stratified, so the true error is smaller than this estimate, or only slightly
    // larger.
    (mean, ((sums.1 / n - mean * mean).max(0.0) / n).sqrt())
}
