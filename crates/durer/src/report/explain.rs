//! Conversion of explanations of a pixel or ray to JSON.

use durer_render::integrator::trace::TermKind;
use durer_render::integrator::{TraceNode, Tree};
use durer_render::render::explain::{Explanation, SceneNames};
use durer_scene::math::Vec3;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// Version of the document format.
const VERSION: u32 = 2;

/// A traced pixel or ray from which [`explanation`] creates a JSON document.
pub enum Explained {
    /// A pixel with all of its samples.
    Pixel(Explanation),
    /// A single ray.
    Ray(Box<Tree>),
}

/// Returns the output of `durer explain --json`. It contains the tree of terms and the names of the
/// objects, materials and lights to which the tree refers by index.
pub fn explanation(subject: &Explained, names: &SceneNames) -> Value {
    let (mut objects, mut lights, mut materials) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    let mut note = |node: &TraceNode| match &node.kind {
        TermKind::Ray { hit: Some(hit), .. } => {
            objects.insert(hit.object);
            materials.insert(hit.material);
        }
        TermKind::Light { light, shadow, .. } => {
            lights.insert(*light);
            objects.extend(shadow.as_ref().and_then(|shadow| shadow.blocker).map(|blocker| blocker.0));
        }
        _ => {}
    };
    match subject {
        Explained::Ray(light) => visit(&light.root, &mut note),
        Explained::Pixel(pixel) => {
            pixel.samples.iter().filter_map(|s| s.light.as_ref()).for_each(|light| visit(&light.root, &mut note));
        }
    }
    let objects: Map<_, _> = objects.into_iter().map(|i| (i.to_string(), names.object(i).into())).collect();
    let materials: Map<_, _> = materials.into_iter().map(|i| (i.to_string(), names.material(i).into())).collect();
    let lights: Map<_, _> = lights.into_iter().map(|i| (i.to_string(), names.light(i).into())).collect();
    let mut json = json!({
        "version": VERSION,
        "objects": objects,
        "materials": materials,
        "lights": lights,
    });
    match subject {
        Explained::Ray(light) => {
            json["ray"] = json!(light);
            annotate(&light.root, &mut json["ray"], (Vec3::ZERO, Vec3::ZERO), names);
        }
        Explained::Pixel(pixel) => {
            json["pixel"] = json!(pixel);
            for (i, sample) in pixel.samples.iter().enumerate() {
                if let Some(light) = &sample.light {
                    let value = &mut json["pixel"]["samples"][i]["light"];
                    annotate(&light.root, value, (Vec3::ZERO, Vec3::ZERO), names);
                }
            }
        }
    }
    json
}

/// Adds to each term the lines that derive its numbers. `at` contains the direction of the ray and
/// the normal at its hit.
fn annotate(node: &TraceNode, json: &mut Value, at: (Vec3, Vec3), names: &SceneNames) {
    let lines = names.origins(node, at.0, at.1);
    if !lines.is_empty() {
        json["origins"] = lines.into();
    }
    let at = match &node.kind {
        TermKind::Ray { ray, hit, .. } => (ray.dir, hit.as_ref().map_or(Vec3::ZERO, |hit| hit.n)),
        _ => at,
    };
    for (i, term) in node.terms.iter().enumerate() {
        annotate(term, &mut json["terms"][i], at, names);
    }
}

fn visit(node: &TraceNode, note: &mut impl FnMut(&TraceNode)) {
    note(node);
    node.terms.iter().for_each(|term| visit(term, note));
}
