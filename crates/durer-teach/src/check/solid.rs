//! Checks for parts of solids that have no effect.

use super::finding::{Finding, MAX_FINDINGS};
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_scene::math::Aabb;
use durer_scene::scene::{CsgOperation, ObjectKind, extent};

/// Reports subtracted parts whose bounds do not overlap the bounds of the first part.
pub(super) fn part_without_effect(scene_probe: &SceneProbe) -> Vec<Finding> {
    let scene = scene_probe.input.scene;
    let mut findings = Vec::new();
    let mut all: Vec<&durer_scene::scene::Object> = scene.root.iter().flat_map(|root| &root.objects).collect();
    while let Some(object) = all.pop().filter(|_| findings.len() < MAX_FINDINGS) {
        match &object.node {
            ObjectKind::Group(group) => all.extend(&group.objects),
            ObjectKind::Transform(_, inner) => all.push(inner),
            ObjectKind::Solid(operation, parts) => {
                all.extend(parts);
                let bounds = |part: &durer_scene::scene::Object| {
                    let mut bounds = Aabb::EMPTY;
                    extent::object_points(scene, part, &mut |p| bounds = bounds.union_point(p.as_vec3()));
                    Some(bounds).filter(|bounds| !bounds.is_empty())
                };
                let Some(first) = parts.first().and_then(bounds).filter(|_| *operation == CsgOperation::Difference)
                else {
                    continue;
                };
                let apart = |b: &Aabb| b.min.cmpgt(first.max).any() || b.max.cmplt(first.min).any();
                for part in parts[1..].iter().filter(|part| bounds(part).is_some_and(|b| apart(&b))) {
                    let diagnostic = Diagnostic::warning("this part is subtracted from empty space")
                        .at(part.span)
                        .related(parts[0].span, "subtracted from this part")
                        .effect("the part has no effect: it cuts no hole")
                        .help(
                            "move the part into the first part: check its position and the transforms that enclose it",
                        );
                    findings.push(Finding::from(diagnostic));
                }
            }
            _ => {}
        }
    }
    findings
}
