//! Tests that `durer check` reports nothing for correct scenes. These are the scenes of the
//! repository and those of the course, except course scenes with real faults.

use crate::common::{TestFolder, corpus};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Expected findings for scenes of the course, each with its reason.
const ODD: [(&str, &str, &str); 2] = [
    ("f04/scene2_05_inside_sphere.txt", "camera-inside", "the camera is inside a sphere, as its name says"),
    ("f04/scene8_10_transparent_vase.txt", "open-glass", "the vase is of glass, and open at its rim"),
];

/// Expected notes for scenes of the course, which are correct but harmless.
const NOTES: [(&str, usize, &str); 8] = [
    ("degenerate-mesh", 6, "vases and teapots have triangles without area at their poles"),
    (
        "light-behind",
        2,
        "`scene3_10_exponent_variations_back` and `scene3_12_weird_lighting_specular` are lit as their names say",
    ),
    ("no-exponent", 3, "three scenes of f12a5 mirror with the colour of highlights that they do not have"),
    ("no-light", 7, "the first assignment has no lights yet"),
    ("odd-index", 1, "`scene4_07_transparent_sphere_1.0` has glass of index 1, as its name says"),
    ("seen-from-behind", 1, "a triangle of `scene2_07_sphere_triangles` is turned"),
    ("too-bright", 2, "two scenes are a tenth too bright"),
    ("unused-material", 2, "two scenes have a material too many"),
];

fn scenes(folder: &Path) -> Vec<PathBuf> {
    let mut scenes: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    // Scenes that contain splines use another file format.
    let spline = |path: &Path| path.file_name().unwrap().to_string_lossy().starts_with("spline");
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "txt") && !spline(path));
    scenes.sort();
    scenes
}

/// Returns the findings for some scenes, each with its scene, severity and code.
fn found(scenes: &[PathBuf], options: &str) -> Vec<(String, String, String)> {
    let folder = TestFolder::new();
    let mut command = folder.command(&format!("check --json {options}"));
    let output = command.args(scenes).output().unwrap();
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(!err.contains("panicked"), "{err}");
    let all: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {err}"));
    let listed = all["scenes"].as_array().unwrap();
    assert_eq!(listed.len(), scenes.len());
    let word = |value: &Value| value.as_str().unwrap().to_string();
    let each = |scene: &Value| {
        let path = PathBuf::from(word(&scene["scene"]));
        let name: Vec<_> = path.iter().rev().take(2).map(|part| part.to_string_lossy().into_owned()).collect();
        let name = format!("{}/{}", name[1], name[0]);
        let findings = scene["findings"].as_array().unwrap().iter();
        findings.map(|finding| (name.clone(), word(&finding["severity"]), word(&finding["code"]))).collect::<Vec<_>>()
    };
    listed.iter().flat_map(each).collect()
}

#[test]
fn course_scenes_have_only_expected_findings() {
    let Some(course) = corpus() else { return };
    let (mut serious, mut notes) = (Vec::new(), BTreeMap::<String, usize>::new());
    let mut count = 0;
    for dialect in ["f04", "f12a4", "f12a5", "f16", "f23"] {
        let folder = course.join("scenes").join(dialect);
        let scenes = scenes(&folder);
        count += scenes.len();
        for (scene, severity, code) in found(&scenes, &format!("--allow-outside --assets {}", folder.display())) {
            match severity.as_str() {
                "note" => *notes.entry(code).or_default() += 1,
                _ => serious.push((scene, code)),
            }
        }
    }
    assert!(count > 120, "{count} scenes");
    let expected: Vec<(String, String)> = ODD.iter().map(|row| (row.0.to_string(), row.1.to_string())).collect();
    assert_eq!(serious, expected);
    let expected: BTreeMap<String, usize> = NOTES.iter().map(|row| (row.0.to_string(), row.1)).collect();
    assert_eq!(notes, expected);
}

#[test]
fn repository_scenes_have_no_findings() {
    let own = scenes(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes"));
    assert!(own.len() > 30, "{} scenes", own.len());
    // Daylight is in cd/m^2 and requires an exposure.
    let (sunny, others): (Vec<PathBuf>, Vec<PathBuf>) =
        own.into_iter().partition(|path| path.ends_with("daylight.txt"));
    let found: Vec<_> = found(&others, "").into_iter().chain(found(&sunny, "--exposure -13")).collect();
    let serious: Vec<_> = found.iter().filter(|finding| finding.1 != "note").collect();
    assert!(serious.is_empty(), "{serious:?}");
}
