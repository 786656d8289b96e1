//! JSON of an explained pixel or ray.

use durer_render::integrator::trace::TermKind;
use durer_render::integrator::{TraceNode, Tree};
use durer_render::render::explain::{Explanation, Names};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// Version of the document.
const VERSION: u32 = 2;

/// Subject of an explanation.
pub enum Subject {
    /// A pixel with all its samples.
    Pixel(Explanation),
    /// A single ray.
    Ray(Box<Tree>),
}

/// Makes the document of `durer explain --json`: the tree of terms, and the names of the objects,
/// materials and lights that it numbers.
pub fn explanation(subject: &Subject, names: &Names) -> Value {
    let (mut objects, mut lights, mut materials) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    let mut note = |node: &TraceNode| match &node.what {
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
        Subject::Ray(light) => visit(&light.root, &mut note),
        Subject::Pixel(pixel) => {
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
        Subject::Ray(light) => json["ray"] = json!(light),
        Subject::Pixel(pixel) => json["pixel"] = json!(pixel),
    }
    json
}

fn visit(node: &TraceNode, note: &mut impl FnMut(&TraceNode)) {
    note(node);
    node.terms.iter().for_each(|term| visit(term, note));
}
