//! Checks for samples that are NaN or infinite, and for the term that causes this.

use super::finding::Finding;
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Span};
use durer_render::integrator::TraceNode;
use durer_render::integrator::trace::{TermKind, TermValue};
use durer_render::render::explain::{explain, explain_ray};
use durer_scene::sampler::SampleId;

/// Reports the first sample that is not finite, and the chain of terms that leads to its cause.
pub(super) fn not_finite(scene_probe: &SceneProbe) -> Vec<Finding> {
    let (world, job) = (scene_probe.world(), scene_probe.input.job);
    let (name, tree) = match scene_probe.input.rejected {
        Some((x, y, sample)) => {
            let light = explain(world, job, x, y).ok().and_then(|pixel| {
                let own = pixel.samples.into_iter().find(|own| own.sample == sample)?;
                own.light
            });
            (format!("pixel {x},{y} (sample {sample})"), light)
        }
        None => match scene_probe.probes.iter().find(|probe| !probe.color.is_finite()) {
            Some(probe) => (
                format!("pixel {},{}", probe.pixel.0, probe.pixel.1),
                explain_ray(world, job, &probe.ray, SampleId::default()),
            ),
            None => return Vec::new(),
        },
    };
    let bad = scene_probe.probes.iter().filter(|probe| !probe.color.is_finite()).count();
    let mut steps = Vec::new();
    let mut place = None;
    if let Some(tree) = &tree {
        path(scene_probe, &tree.root, &mut steps, &mut place);
    }
    let share = match bad {
        0 => "such samples are left out, which leaves specks or black pixels".to_string(),
        n => format!(
            "{} of the picture is left out and stays black",
            super::finding::percent(n, scene_probe.probes.len())
        ),
    };
    let mut diagnostic = Diagnostic::warning(format!("the light of {name} is NaN or infinite")).effect(share);
    if !steps.is_empty() {
        diagnostic = diagnostic.help(format!("the cause: {}", steps.join(" -> ")));
    }
    diagnostic.span = place;
    vec![Finding::from(diagnostic).affecting_whole_picture(bad * 4 > scene_probe.probes.len())]
}

/// Follows the trace tree from a term down to the first term that is not finite.
fn path(scene_probe: &SceneProbe, node: &TraceNode, steps: &mut Vec<String>, place: &mut Option<Span>) {
    let names = scene_probe.names();
    match &node.kind {
        TermKind::Ray { hit: Some(hit), .. } => {
            steps.push(format!("a ray that hits {}", names.object(hit.object)));
            *place = Some(scene_probe.object_span(hit.object));
        }
        TermKind::Ray { hit: None, .. } => steps.push("a ray that hits nothing".into()),
        TermKind::Light { light, distance, .. } => {
            *place = super::lights::span(scene_probe, *light).or(*place);
            let arrives = if finite(node.scale) {
                String::new()
            } else {
                format!(", {} of it arrives", format_value(node.scale))
            };
            steps.push(format!("{}, {distance} away{arrives}", names.light(*light)));
        }
        TermKind::Ambient { .. } => {
            steps.push(format!("ambient light {} times colour {}", format_value(node.factor), format_value(node.value)))
        }
        TermKind::Highlight { base, exponent, .. } => {
            steps.push(format!("highlight {base} to the power of {exponent}"))
        }
        TermKind::Diffuse { cosine } => {
            steps.push(format!("diffuse light, N·L = {cosine}, colour {}", format_value(node.value)))
        }
        TermKind::Secondary { here, there, .. } => {
            steps.push(format!("mirrored or transmitted light, from index {here} to {there}"))
        }
        _ => {}
    }
    if let Some(next) = node.terms.iter().find(|term| !finite(term.contribution())) {
        path(scene_probe, next, steps, place);
    }
}

fn finite(value: TermValue) -> bool {
    value.numbers().iter().all(|x| x.is_finite())
}

fn format_value(value: TermValue) -> String {
    value.numbers().iter().map(f32::to_string).collect::<Vec<_>>().join(" ")
}
