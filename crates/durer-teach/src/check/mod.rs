//! Diagnosis of scenes whose picture is black, white, empty or odd, with fixes.
//!
//! A [`SceneProbe`] traces a coarse grid of camera rays through the world and records their hits.
//! The checks in the table [`CHECKS`] examine these probes, the meshes and the scene description.
//! Every finding has a stable code, a place in the scene file, an effect on the picture, and a
//! suggested change. If the change is mechanical, the finding also has an edit of the scene's text.

mod aim;
mod air;
mod area_lights;
mod beams;
mod brightness;
mod colors;
mod exposure;
mod extent;
mod faces;
mod facing;
mod fading;
mod finding;
mod hidden;
mod layers;
mod lens;
mod lights;
mod mesh;
mod mesh_files;
mod method;
mod names;
mod numbers;
mod objects;
mod optics;
mod patterns;
mod physical;
pub mod picture;
mod places;
mod probes;
mod repair;
mod scene_probe;
mod shapes;
mod solid;
mod table;
#[cfg(test)]
mod tests;
mod unseen;
mod verdict;
mod view;
mod visibility;
mod within;
mod words;
mod year;

use durer_diag::{Diagnostics, Severity};
pub use finding::Finding;
use finding::MAX_ALIKE;
pub use probes::Subject;
pub use repair::{RepairedText, apply};
pub use scene_probe::SceneProbe;
pub use table::{CHECKS, Check, rank};

/// Codes of findings that explain why nothing, or only a single object, is visible.
const EMPTIES: [&str; 7] =
    ["camera-inside", "camera-away", "too-small", "too-narrow", "all-missed", "hidden-behind", "below-plane"];

/// Causes, each with the codes of findings that follow from it and are then suppressed.
const CONSEQUENCES: &[(&str, &[&str])] = &[
    ("wrong-integrator", &["no-light", "no-emitter", "too-dark", "same-color", "one-color", "nothing-mirrored"]),
    ("black-sky", &["no-emitter", "too-dark", "one-color"]),
    ("nothing-mirrored", &["same-color", "too-dark", "one-color", "light-cancelled"]),
    ("tiny-highlight", &["light-cancelled", "same-color", "too-dark"]),
    ("mostly-black", &["too-dark", "lamp-blocked", "light-behind"]),
    ("color-range", &["too-bright"]),
    ("full-ambient", &["too-bright"]),
    ("negative-color", &["too-dark", "light-cancelled"]),
    ("pow-zero", &["too-bright"]),
    ("light-twice", &["too-bright"]),
    ("light-divides", &["not-finite"]),
    ("no-falloff", &["not-finite", "light-divides"]),
    ("below-plane", &["unseen", "seen-from-behind", "light-cancelled", "light-behind", "upside-down"]),
    ("hidden-behind", &["upside-down"]),
    ("degenerate-mesh", &["seen-from-behind"]),
    ("squashed", &["all-missed", "too-small", "tiny", "out-of-scale", "empty-solid"]),
    ("degenerate-triangle", &["all-missed", "unseen", "same-place"]),
    ("dull-glass", &["black-material"]),
    ("black-material", &["too-dark"]),
    (
        "far-origin",
        &[
            "unseen",
            "tiny",
            "hidden-behind",
            "all-missed",
            "degenerate-triangle",
            "squashed",
            "odd-normals",
            "degenerate-mesh",
        ],
    ),
    ("out-of-scale", &["unseen", "light-blocked", "tiny", "camera-inside", "seen-from-behind", "light-divides"]),
    ("camera-inside", &["seen-from-behind", "light-inside", "light-behind", "light-blocked", "unseen"]),
    ("degenerate-mesh", &["out-of-scale"]),
    ("camera-away", &["light-cancelled", "light-behind", "light-blocked", "light-faint", "pattern-scale", "edge-on"]),
    ("thick-fog", &["too-dark", "lamp-turned", "lamp-blocked"]),
    ("wide-aperture", &["out-of-focus"]),
    ("eyes-apart", &["unseen", "camera-away"]),
    ("lamp-turned", &["too-dark", "lamp-blocked"]),
    ("lamp-blocked", &["unseen"]),
    ("light-near", &["too-dark", "too-bright", "light-faint"]),
    ("unused-define", &["unused-material"]),
    ("plane-normal", &["plane-through", "too-bright"]),
    ("same-parts", &["pattern-scale"]),
    ("empty-solid", &["one-color"]),
    ("same-place", &["unseen"]),
    ("too-small", &["tiny", "pattern-scale", "light-behind", "light-cancelled"]),
    ("tiny", &["unseen"]),
    ("epsilon", &["tiny"]),
];

/// Returns all findings about a compiled scene, causes first. They include the diagnostics of the
/// reader and the compiler.
pub fn check(subject: &Subject, diagnostics: &Diagnostics) -> Vec<Finding> {
    let scout = SceneProbe::new(subject);
    let mut found: Vec<Finding> = diagnostics.iter().cloned().map(Finding::from).collect();
    found.iter_mut().for_each(|finding| words::complete(&scout, finding));
    for check in CHECKS.iter().filter(|check| !physical::is_beside_the_point(&scout, check.code)) {
        let of_kind = (check.find)(&scout).into_iter();
        found.extend(of_kind.map(|finding| Finding { diagnostic: finding.diagnostic.code(check.code), ..finding }));
    }
    // Drop findings that only describe the picture if another finding explains it.
    if found.iter().any(|finding| finding.whole && !finding.last) {
        found.retain(|finding| !finding.last);
    }
    // If an attenuation keyword of another dialect was ignored, that is why the light does not
    // fade.
    let fades = |finding: &Finding| {
        let word = finding.diagnostic.span.map(|span| scout.text(span)).unwrap_or_default();
        finding.diagnostic.code == "foreign-word" && ["attenuation", "falloff"].contains(&word.as_str())
    };
    if found.iter().any(fades) && found.iter().any(|f| f.diagnostic.code == "no-falloff") {
        found.retain(|finding| !["no-falloff", "light-divides", "not-finite"].contains(&finding.diagnostic.code));
        for finding in found.iter_mut().filter(|finding| fades(finding)) {
            (finding.diagnostic.severity, finding.whole) = (Severity::Warning, true);
        }
    }
    // Drop findings that follow from a reported cause.
    for (cause, consequences) in CONSEQUENCES {
        if found.iter().any(|finding| finding.diagnostic.code == *cause && finding.is_serious()) {
            found.retain(|finding| !consequences.contains(&finding.diagnostic.code));
        }
    }
    // If nothing is visible, do not report individual invisible objects.
    if found.iter().any(|finding| EMPTIES.contains(&finding.diagnostic.code) && finding.whole) {
        found.retain(|finding| finding.diagnostic.code != "unseen");
    }
    ordered(found)
}

/// Returns the diagnostics of the reader and the compiler as findings, for a scene that cannot be
/// rendered.
pub fn reported(diagnostics: &Diagnostics) -> Vec<Finding> {
    ordered(diagnostics.iter().cloned().map(Finding::from).collect())
}

/// Sorts findings by level: errors, warnings about the whole picture, other warnings, notes. Within
/// a level they follow the order of the table (causes before consequences), and each kind appears
/// once before any kind repeats. If a kind has many findings, the last one shown gives the number
/// of the others.
fn ordered(mut found: Vec<Finding>) -> Vec<Finding> {
    let level = |finding: &Finding| match finding.diagnostic.severity {
        Severity::Error => 0,
        Severity::Warning if finding.last => 3,
        Severity::Warning if finding.whole => 1,
        Severity::Warning => 2,
        Severity::Note => 4,
    };
    // Errors keep their order, because the first may cause the others.
    let rank = |finding: &Finding| if level(finding) == 0 { 0 } else { table::rank(finding.diagnostic.code) };
    found.sort_by_key(|finding| (level(finding), rank(finding)));
    let mut reported: Vec<(u8, &str)> = Vec::new();
    found.sort_by_cached_key(|finding| {
        let kind = (level(finding), finding.diagnostic.code);
        let again = kind.0 > 0 && reported.contains(&kind);
        reported.push(kind);
        (level(finding), again, rank(finding))
    });
    let mut kept: Vec<Finding> = Vec::with_capacity(found.len());
    let mut more = 0;
    for finding in found {
        let alike = |other: &&Finding| {
            let (a, b) = (&finding.diagnostic, &other.diagnostic);
            a.code == b.code && a.severity == b.severity && a.severity != Severity::Error
        };
        let known = kept.iter().rev().take_while(alike).count();
        if known >= MAX_ALIKE && !finding.diagnostic.code.is_empty() {
            more += 1;
            finding::count_more(kept.last_mut(), more, &finding);
        } else {
            more = 0;
            kept.push(finding);
        }
    }
    kept
}
