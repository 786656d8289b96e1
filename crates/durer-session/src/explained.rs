//! Explanations of a pixel or ray for a page without a session, which cannot ask for more.

use crate::document::NamedScene;
use crate::protocol::{CameraState, CastResult, LightMarker, Outline, PixelExplanation, Term};
use crate::{intersection_tests, motion, outlines, terms};
use durer::dialect::Dialect;
use durer::image::Transfer;
use durer::math::{Ray, Vec3};
use durer::render::Job;
use durer::render::explain::SceneNames;
use durer::report::Explained;
use serde::{Deserialize, Serialize};
#[cfg(test)]
use ts_rs::TS;

/// Maximum number of intersection tests in all samples together. More would make a page heavy.
const MAX_TESTS: usize = 2000;

/// The line drawing of a scene and its camera.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct DrawnScene {
    /// Outlines of the objects.
    pub outlines: Vec<Outline>,
    /// Marks for the lights.
    pub lights: Vec<LightMarker>,
    /// The camera.
    pub camera: CameraState,
}

/// A ray of a term with its intersection tests.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct TermCast {
    /// Path of the term in the tree, such as `0.2.1`.
    pub path: String,
    /// The tests.
    pub cast: CastResult,
}

/// A sample of a pixel with the tests of its rays.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct ExplainedSample {
    /// The pixel, and the tree of this sample.
    pub explanation: PixelExplanation,
    /// Pixel to which the sample belongs.
    pub of: [u32; 2],
    /// Tests of the rays in the tree; empty if the page has no room for those of this sample.
    pub casts: Vec<TermCast>,
}

/// Returns the line drawing of a scene.
pub fn drawn_scene(names: SceneNames, dialect: Dialect) -> DrawnScene {
    let camera = motion::state(names.world, names.world.camera(), dialect, motion::distance(names.world));
    DrawnScene { outlines: outlines::outlines(&names), lights: outlines::light_markers(NamedScene(names)), camera }
}

/// Explains all samples of a pixel, or a ray as the single sample of pixel 0, 0. The sample with
/// the index `chosen` has the tests of its rays, and others have them while there is room.
pub fn explained_samples(
    names: SceneNames,
    job: &Job,
    subject: &Explained,
    chosen: usize,
    transfer: Transfer,
) -> Vec<ExplainedSample> {
    let scene = NamedScene(names);
    let mut samples = match subject {
        Explained::Ray(tree) => {
            let color = tree.sum();
            let explanation = PixelExplanation {
                x: 0,
                y: 0,
                color: color.into(),
                bytes: transfer.encode_pixel(color),
                samples: 1,
                sample: 0,
                at: [0.0; 2],
                weight: 1.0,
                tree: Some(terms::tree_terms(scene, tree, transfer)),
            };
            vec![ExplainedSample { explanation, of: [0; 2], casts: Vec::new() }]
        }
        Explained::Pixel(pixel) => (0..)
            .zip(&pixel.samples)
            .map(|(i, sample)| ExplainedSample {
                explanation: terms::explain(scene, job, pixel, Some(i), transfer),
                of: [sample.of.0, sample.of.1],
                casts: Vec::new(),
            })
            .collect(),
    };
    let order = std::iter::once(chosen).chain((0..samples.len()).filter(|&i| i != chosen));
    let mut room = MAX_TESTS;
    for i in order {
        let Some(ExplainedSample { explanation: PixelExplanation { tree: Some(tree), .. }, casts, .. }) =
            samples.get_mut(i)
        else {
            continue;
        };
        let mut rays = Vec::new();
        collect_rays(tree, "0".into(), &mut rays);
        let needed = rays.len() * names.world.objects().len().clamp(1, intersection_tests::MAX_TESTS);
        if needed > room && i != chosen {
            continue;
        }
        room = room.saturating_sub(needed);
        casts.extend(
            rays.into_iter()
                .take(MAX_TESTS)
                .map(|(path, ray)| TermCast { path, cast: intersection_tests::cast(scene, &ray) }),
        );
    }
    samples
}

/// Appends the rays of a tree with the paths of their terms.
fn collect_rays(term: &Term, path: String, rays: &mut Vec<(String, Ray)>) {
    if let Some([origin, direction]) = term.ray {
        let ray = Ray::new(Vec3::from(origin), Vec3::from(direction));
        rays.push((path.clone(), Ray { t_max: term.t_max.unwrap_or(ray.t_max), ..ray }));
    }
    for (i, below) in term.terms.iter().enumerate() {
        collect_rays(below, format!("{path}.{i}"), rays);
    }
}
