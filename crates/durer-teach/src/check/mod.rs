//! Diagnoses scenes whose picture is black, white, empty or unusual, and suggests fixes.
//!
//! A [`SceneProbe`] traces a coarse grid of camera rays through the world and records what they
//! hit. The checks in the table [`CHECKS`] examine these probes, the meshes and the scene
//! description. Every finding has a stable code, a location in the scene file, an effect on the
//! picture, and a suggested change. If the change is mechanical, the finding also has an edit of
//! the scene's text.

mod aim;
mod area_lights;
mod attenuation;
mod beams;
mod brightness;
mod clipping;
mod colors;
mod completion;
mod containment;
mod depth;
mod emission;
mod exposure;
mod extent;
mod faces;
mod facing;
mod finding;
mod fine_textures;
mod fog;
mod ground;
mod hidden;
mod idle_layers;
mod integrator;
mod invisible;
mod layers;
mod lens;
mod lights;
mod lines;
mod mesh;
mod mesh_files;
mod metals;
mod names;
mod neutral;
mod numbers;
mod objects;
mod optics;
mod options;
mod overwhelmed;
mod pattern_border;
mod patterns;
mod physical;
pub mod picture;
mod placement;
mod probes;
mod quadrics;
mod quirks;
mod reach;
mod repair;
mod room;
mod scene_probe;
mod secondary;
mod shapes;
mod solid;
mod strays;
mod table;
#[cfg(test)]
mod tests;
mod textures;
mod transforms;
mod uses;
mod verdict;
mod view;
mod visibility;
mod world_scale;
mod written;

use durer_diag::{Diagnostic, Diagnostics, Severity};
pub use finding::Finding;
use finding::MAX_PER_KIND;
pub use probes::CheckInput;
pub use repair::{RepairedText, apply};
pub use scene_probe::SceneProbe;
pub use table::{CHECKS, Check, rank};

/// Codes of findings that explain why nothing is visible, or only a single object.
const EMPTY_PICTURE_CODES: [&str; 7] =
    ["camera-inside", "camera-away", "too-small", "too-narrow", "all-missed", "hidden-behind", "below-plane"];

/// Causes, each with the codes of the findings that follow from it and are therefore suppressed.
const CONSEQUENCES: &[(&str, &[&str])] = &[
    ("wrong-integrator", &["no-light", "no-emitter", "too-dark", "same-color", "one-color", "nothing-mirrored"]),
    ("black-sky", &["no-emitter", "too-dark", "one-color"]),
    (
        "bad-place",
        &[
            "camera-away",
            "camera-inside",
            "all-missed",
            "unseen",
            "light-blocked",
            "lamp-blocked",
            "lamp-turned",
            "too-dark",
            "too-bright",
            "mostly-black",
            "no-emitter",
        ],
    ),
    ("ALPHA_CUTOFF", &["not-there"]),
    ("CAMERA_YFOV_GEQUAL_PI", &["too-small", "too-narrow", "camera-away", "all-missed"]),
    ("dark-colors", &["too-dark", "black-material"]),
    ("NODE_NO_SCENE", &["unused-material"]),
    ("repeated", &["light-behind", "light-blocked", "light-faint", "too-dark", "unused-material"]),
    ("black-light", &["same-color", "too-dark", "one-color", "no-emitter", "mostly-black", "unseen"]),
    ("flat-transform", &["unseen"]),
    ("missing-field", &["light-blocked", "camera-away", "all-missed"]),
    ("sun-below", &["no-emitter"]),
    ("nothing-mirrored", &["same-color", "too-dark", "one-color", "light-cancelled"]),
    ("tiny-highlight", &["light-cancelled", "same-color", "too-dark"]),
    ("light-blocked", &["mostly-black", "too-dark"]),
    ("mostly-black", &["too-dark", "lamp-blocked", "light-behind"]),
    ("color-range", &["too-bright"]),
    ("full-ambient", &["too-bright"]),
    ("negative-color", &["too-dark", "light-cancelled"]),
    ("pow-zero", &["too-bright"]),
    ("light-twice", &["too-bright"]),
    ("light-divides", &["not-finite"]),
    ("not-finite", &["too-bright"]),
    ("no-falloff", &["not-finite", "light-divides"]),
    ("stray-points", &["too-small", "all-missed", "one-color", "out-of-scale", "too-dark", "holes"]),
    ("below-plane", &["unseen", "seen-from-behind", "light-cancelled", "light-behind", "light-blocked", "upside-down"]),
    ("hidden-behind", &["upside-down", "light-behind", "light-blocked", "lamp-blocked"]),
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
    (
        "out-of-scale",
        &[
            "unseen",
            "light-blocked",
            "lamp-blocked",
            "lamp-turned",
            "too-dark",
            "tiny",
            "camera-inside",
            "seen-from-behind",
            "light-divides",
        ],
    ),
    (
        "camera-inside",
        &["seen-from-behind", "light-inside", "light-behind", "light-blocked", "lamp-blocked", "lamp-turned", "unseen"],
    ),
    ("degenerate-mesh", &["out-of-scale"]),
    ("camera-away", &["light-cancelled", "light-behind", "light-blocked", "light-faint", "pattern-scale", "edge-on"]),
    ("thick-fog", &["too-dark", "lamp-turned", "lamp-blocked"]),
    ("wide-aperture", &["out-of-focus"]),
    ("eyes-apart", &["unseen", "camera-away"]),
    ("clipped", &["camera-away", "all-missed", "unseen", "too-small", "too-narrow", "upside-down"]),
    ("no-surface", &["far-origin", "too-small", "tiny", "out-of-scale", "all-missed"]),
    ("lamp-turned", &["too-dark", "lamp-blocked"]),
    ("lamp-blocked", &["unseen"]),
    ("light-near", &["too-dark", "too-bright", "light-faint", "light-behind"]),
    ("unused-define", &["unused-material", "no-objects"]),
    ("plane-normal", &["plane-through", "too-bright"]),
    ("same-parts", &["pattern-scale"]),
    ("empty-solid", &["one-color"]),
    ("same-place", &["unseen"]),
    ("too-small", &["tiny", "pattern-scale", "light-behind", "light-cancelled"]),
    ("tiny", &["unseen"]),
    ("epsilon", &["tiny"]),
    ("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", &["normal-map", "no-coordinates", "flat-texture"]),
    ("no-emitter", &["flat-texture", "too-dark", "one-color"]),
    ("not-there", &["black-material", "no-coordinates", "flat-texture", "normal-map"]),
    ("thick-fog", &["black-fog"]),
    ("black-fog", &["too-dark", "mostly-black", "one-color"]),
    ("lamp-in-glass", &["too-bright", "mostly-black", "too-dark", "one-color"]),
    ("scaled-move", &["unseen", "squashed", "plane-through"]),
    ("angle-first", &["radians"]),
    ("radians", &["lamp-turned", "lamp-blocked"]),
    ("metal-default", &["nothing-mirrored", "mostly-black", "too-dark"]),
    ("mirrored-wall", &["upside-down"]),
    ("too-dark", &["one-color"]),
];

/// Returns all findings about a compiled scene, with causes first. They include the diagnostics of
/// the reader and the compiler.
pub fn check(input: &CheckInput, diagnostics: &Diagnostics) -> Vec<Finding> {
    let scene_probe = SceneProbe::new(input);
    let applies = |diagnostic: &&Diagnostic| !physical::does_not_apply(&scene_probe, diagnostic.code);
    let mut findings: Vec<Finding> = diagnostics.iter().filter(applies).cloned().map(Finding::from).collect();
    findings.iter_mut().for_each(|finding| completion::complete(&scene_probe, finding));
    for check in CHECKS.iter().filter(|check| !physical::does_not_apply(&scene_probe, check.code)) {
        let of_kind = (check.find)(&scene_probe).into_iter();
        let coded = of_kind.map(|finding| Finding { diagnostic: finding.diagnostic.code(check.code), ..finding });
        match scene_probe.model_format() {
            Some(_) => findings.extend(coded.map(neutral::neutral)),
            None => findings.extend(coded),
        }
    }
    // The reader of a model knows why there are no objects.
    let mut is_known = false;
    findings.retain(|finding| finding.diagnostic.code != "no-objects" || !std::mem::replace(&mut is_known, true));
    // Drop findings that only describe the picture if another finding explains it.
    if findings.iter().any(|finding| finding.affects_whole_picture && !finding.only_describes) {
        findings.retain(|finding| !finding.only_describes);
    }
    // If an attenuation keyword of another dialect was ignored, this explains why the light does
    // not fade.
    let fades = |finding: &Finding| {
        let word = finding.diagnostic.span.map(|span| scene_probe.text(span)).unwrap_or_default();
        finding.diagnostic.code == "foreign-word" && ["attenuation", "falloff"].contains(&word.as_str())
    };
    if findings.iter().any(fades) && findings.iter().any(|f| f.diagnostic.code == "no-falloff") {
        findings.retain(|finding| !["no-falloff", "light-divides", "not-finite"].contains(&finding.diagnostic.code));
        for finding in findings.iter_mut().filter(|finding| fades(finding)) {
            (finding.diagnostic.severity, finding.affects_whole_picture) = (Severity::Warning, true);
        }
    }
    let ignored = |finding: &Finding| finding.diagnostic.code == "foreign-word" && finding.affects_whole_picture;
    if findings.iter().any(ignored) {
        findings.retain(|finding| !["light-faint", "too-bright", "too-dark"].contains(&finding.diagnostic.code));
    }
    // An invalid value comes before the NaN values that it causes.
    if findings.iter().any(|finding| finding.diagnostic.code == "not-finite" && finding.affects_whole_picture) {
        let invalid = findings.iter_mut().filter(|finding| finding.diagnostic.code == "bad-value");
        invalid.for_each(|finding| finding.affects_whole_picture = true);
    }
    // Drop findings that follow from a reported cause.
    for (cause, consequences) in CONSEQUENCES {
        if findings.iter().any(|finding| finding.diagnostic.code == *cause && finding.is_serious()) {
            findings.retain(|finding| !consequences.contains(&finding.diagnostic.code));
        }
    }
    // If nothing is visible, individual invisible objects are not reported.
    if findings
        .iter()
        .any(|finding| EMPTY_PICTURE_CODES.contains(&finding.diagnostic.code) && finding.affects_whole_picture)
    {
        findings.retain(|finding| finding.diagnostic.code != "unseen");
    }
    options::blame_options(&scene_probe, &mut findings);
    world_scale::blame_world_scale(&scene_probe, &mut findings);
    let named = findings.into_iter().map(|finding| names::name_materials(&scene_probe, finding));
    ordered(named.collect())
}

/// Returns the diagnostics of the reader and the compiler as findings, for a scene that cannot be
/// rendered.
pub fn reader_findings(diagnostics: &Diagnostics) -> Vec<Finding> {
    ordered(diagnostics.iter().cloned().map(Finding::from).collect())
}

/// Sorts findings by level: first errors, then warnings about the whole picture, other warnings,
/// and notes. Within a level, findings follow the order of the table (causes before consequences),
/// and each kind appears once before any kind is repeated. If there are many findings of one kind,
/// the last one shown states how many others there are.
fn ordered(mut findings: Vec<Finding>) -> Vec<Finding> {
    let level = |finding: &Finding| match finding.diagnostic.severity {
        Severity::Error => 0,
        Severity::Warning if finding.only_describes => 3,
        Severity::Warning if finding.affects_whole_picture => 1,
        Severity::Warning => 2,
        Severity::Note => 4,
    };
    // Errors keep their order because the first one may cause the others.
    // An element that is not closed contains those after it.
    let rank = |finding: &Finding| match level(finding) {
        0 => usize::from(finding.diagnostic.code != "unclosed"),
        _ => table::rank(finding.diagnostic.code),
    };
    findings.sort_by_key(|finding| (level(finding), rank(finding)));
    let mut reported: Vec<(u8, &str)> = Vec::new();
    findings.sort_by_cached_key(|finding| {
        let kind = (level(finding), finding.diagnostic.code);
        let again = kind.0 > 0 && reported.contains(&kind);
        reported.push(kind);
        (level(finding), again, rank(finding))
    });
    let mut result: Vec<Finding> = Vec::with_capacity(findings.len());
    let mut more = 0;
    for finding in findings {
        // Several lights or objects can use the same faulty file.
        if result.iter().any(|other| is_repeated(&other.diagnostic, &finding.diagnostic)) {
            continue;
        }
        let alike = |other: &&Finding| {
            let (a, b) = (&finding.diagnostic, &other.diagnostic);
            a.code == b.code && a.severity == b.severity && a.severity != Severity::Error
        };
        let known = result.iter().rev().take_while(alike).count();
        if known >= MAX_PER_KIND && !finding.diagnostic.code.is_empty() {
            more += 1;
            finding::count_more(result.last_mut(), more, &finding);
        } else {
            more = 0;
            result.push(finding);
        }
    }
    result
}

/// Returns true if two diagnostics have the same message and the same place in a file.
fn is_repeated(a: &Diagnostic, b: &Diagnostic) -> bool {
    let place = |diagnostic: &Diagnostic| diagnostic.span.map(|span| (span.file, span.start, span.end));
    a.severity == b.severity && a.message == b.message && place(a).is_some() && place(a) == place(b)
}
