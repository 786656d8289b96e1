//! Checks that the terms of an explanation add up to the pixel that it explains.

use super::{Explanation, explain};
use crate::film::Filter;
use crate::film::course::CourseFilter;
use crate::integrator::TraceNode;
use crate::render::{Control, Job, RenderError, Sampling, render};
use crate::world::World;
use durer_scene::math::Color;
use durer_scene::sampler::{Sampler, hash};

/// Sampling method, noise threshold and adaptive flag of a picture that is checked.
type SamplingCase = (Sampling, Option<f32>, bool);

const fn kept(sampler: Sampler, samples: u32, filter: Option<CourseFilter>) -> SamplingCase {
    (Sampling::Course2004 { sampler, samples, filter }, None, false)
}

const fn filtered(samples: u32, noise: Option<f32>, adaptive: bool) -> SamplingCase {
    (Sampling::Filtered { samples, filter: Filter::BlackmanHarris { radius: 1.5 } }, noise, adaptive)
}

const fn sub_pixels(jitter: bool, blur: bool) -> SamplingCase {
    (Sampling::Course2012 { jitter, blur }, None, false)
}

/// Sampling methods to check. They include all ways of combining samples. One filter is so narrow
/// that all weights are often zero.
pub const SAMPLINGS: [SamplingCase; 12] = [
    (Sampling::Center, None, false),
    filtered(3, None, false),
    filtered(40, Some(0.02), false),
    filtered(18, None, true),
    kept(Sampler::Random, 3, None),
    kept(Sampler::Uniform, 4, Some(CourseFilter::Box { radius: 1.0 })),
    kept(Sampler::Jittered, 4, Some(CourseFilter::Gaussian { sigma: 0.5 })),
    kept(Sampler::Random, 2, Some(CourseFilter::Tent { radius: 0.3 })),
    sub_pixels(true, true),
    sub_pixels(true, false),
    sub_pixels(false, true),
    sub_pixels(false, false),
];

/// Explains random pixels of a job's picture. `pixels` is their number for each entry of
/// [`SAMPLINGS`]. Returns a message for each pixel whose explanation differs from the picture.
///
/// # Errors
/// Returns [`RenderError`].
pub fn check(world: &World, job: &Job, pixels: u32, seed: u64) -> Result<Vec<String>, RenderError> {
    let mut differences = Vec::new();
    let control = Control { threads: Some(1), ..Control::default() };
    for (way, (sampling, noise, adaptive)) in (0..).zip(SAMPLINGS) {
        let job = Job { sampling, noise, adaptive, color: true, aovs: Vec::new(), ..job.clone() };
        let picture = render(world, &job, &control)?;
        for number in 0..pixels {
            let below = |end: u32, axis| (hash(seed, number, way, 0, axis) % u64::from(end)) as u32;
            let (x, y) = (below(job.width, 0), below(job.height, 1));
            let explanation = explain(world, &job, x, y)?;
            let stored = picture.layers[0].image.get(x, y).unwrap_or_default();
            if let Some(what) = difference(&explanation, stored) {
                differences.push(format!("{sampling:?}, pixel {x},{y}: {what}"));
            }
        }
    }
    Ok(differences)
}

/// Compares an explanation with the sum of its terms and with the pixel in the picture.
fn difference(explanation: &Explanation, stored: Color) -> Option<String> {
    let bits = |color: Color| color.to_array().map(f32::to_bits);
    let (color, coverage) = explanation.sum();
    if bits(color) != bits(stored) {
        return Some(format!("the terms sum to {color}, but the picture has {stored}"));
    }
    if bits(color) != bits(explanation.color) || coverage != explanation.coverage {
        return Some(format!("the terms sum to {color}, but the explanation has {}", explanation.color));
    }
    let trees = explanation.samples.iter().filter_map(|sample| sample.light.as_ref().map(|light| &light.root));
    let odd = trees.filter_map(uneven).next()?;
    Some(format!("the terms below sum to {:?}: {odd:?}", odd.sum()))
}

/// Returns the first node in a tree whose value differs from the sum of its terms.
fn uneven(node: &TraceNode) -> Option<&TraceNode> {
    if node.sum() != node.value { Some(node) } else { node.terms.iter().find_map(uneven) }
}
