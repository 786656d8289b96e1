//! Tests `durer check` cause by cause. Each test uses a small change of a valid scene that triggers
//! a finding and a similar change that does not.

use crate::common::TestFolder;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const CAUSES: &str = include_str!("causes.txt");

/// Expected result of `durer check` for a case in causes.txt.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// There is no warning because this is a base scene or a near miss.
    Sound,
    /// The first finding has the expected code.
    Broken,
}

/// A scene of causes.txt, with its options and the expected result of `durer check`.
struct Case {
    line: String,
    kind: Kind,
    code: String,
    options: Vec<String>,
    text: String,
}

/// Joins options. If an option is given twice, only the last one is kept.
fn joined(options: &str, more: &str) -> Vec<String> {
    let mut all: Vec<String> = options.split_whitespace().map(String::from).collect();
    for word in more.split_whitespace().filter(|word| word.starts_with("--")) {
        if let Some(at) = all.iter().position(|old| old == word) {
            all.drain(at..at + 2);
        }
    }
    all.extend(more.split_whitespace().map(String::from));
    all
}

fn cases() -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    let (mut options, mut text, mut base) = ("", String::new(), "");
    let mut is_told = true;
    for line in CAUSES.lines() {
        let kind = if line.starts_with("near ") { Kind::Sound } else { Kind::Broken };
        if let Some(rest) = line.strip_prefix("base ") {
            (base, options) = rest.split_once(' ').unwrap_or((rest, ""));
            (text, is_told) = (String::new(), false);
        } else if let Some(rest) = line.strip_prefix("case ").or(line.strip_prefix("near ")) {
            if !std::mem::replace(&mut is_told, true) {
                let (line, code, options) = (format!("base {base}"), String::new(), joined(options, ""));
                cases.push(Case { line, kind: Kind::Sound, code, options, text: text.clone() });
            }
            let mut parts = rest.split(" | ");
            let code = parts.next().unwrap().to_string();
            let (mut changed, mut more) = (text.clone(), "");
            for part in parts {
                if let Some(options) = part.strip_prefix('+') {
                    more = options;
                    continue;
                }
                let (old, new) = part.split_once(" =>").unwrap_or_else(|| panic!("{line}"));
                assert!(changed.contains(old), "`{old}` is not in the scene `{base}`");
                changed = changed.replacen(old, &new.trim_start().replace("\\n", "\n"), 1);
            }
            cases.push(Case { line: line.into(), kind, code, options: joined(options, more), text: changed });
        } else if !line.starts_with('#') && !base.is_empty() {
            text += line;
            text += "\n";
        }
    }
    cases
}

/// Writes a cube of quads, a cube of triangles, and a height map of hills.
fn put_files(folder: &TestFolder) {
    let corners = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";
    let faces = [[1, 4, 3, 2], [5, 6, 7, 8], [1, 2, 6, 5], [2, 3, 7, 6], [3, 4, 8, 7], [4, 1, 5, 8]];
    let quads: String = faces.iter().map(|[a, b, c, d]| format!("f {a} {b} {c} {d}\n")).collect();
    let halves: String = faces.iter().map(|[a, b, c, d]| format!("f {a} {b} {c}\nf {a} {c} {d}\n")).collect();
    folder.write("quads.obj", format!("{corners}{quads}"));
    folder.write("box.obj", format!("{corners}{halves}"));
    let with_normals: String = halves.replace(" ", "//1 ").replace("f//1", "f").replace('\n', "//1\n");
    folder.write("smooth.obj", format!("{corners}vn 0 1 0\n{with_normals}"));
    // This is the cube without its top face.
    let cup: String =
        halves.lines().enumerate().filter(|(i, _)| i / 2 != 4).map(|(_, face)| format!("{face}\n")).collect();
    folder.write("cup.obj", format!("{corners}{cup}"));
    folder.write("stray.obj", format!("{corners}v 5000 1 1\nv 5000 2 1\n{halves}f 1 9 10\n"));
    folder.write("bad.obj", format!("{corners}f 1 2 19\n"));
    let sheet =
        |uvs: &str| format!("v -2 0.2 0\nv -0.4 0.2 0\nv -0.4 1.8 0\nv -2 1.8 0\n{uvs}f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
    folder.write("sheet.obj", sheet("vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"));
    folder.write("point.obj", sheet(&"vt 0 0\n".repeat(4)));
    folder.write("grey.ppm", "P3\n2 1\n255\n99 99 99 99 99 99\n");
    folder.write("black.ppm", "P3\n2 1\n255\n0 0 0 0 0 0\n");
    folder.write("two.ppm", "P3\n2 1\n255\n99 99 99 200 20 20\n");
    folder.write("blue.ppm", "P3\n2 1\n255\n0 0 220 0 0 40\n");
    folder.write("normals.ppm", "P3\n2 1\n255\n128 128 255 140 120 250\n");
    // Red, green, blue and opacity.
    let pam = |texels: &[u8; 8]| {
        let head = "P7\nWIDTH 2\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n";
        [head.as_bytes(), texels].concat()
    };
    folder.write("clear.pam", pam(&[99, 99, 99, 0, 200, 20, 20, 0]));
    folder.write("leaf.pam", pam(&[60, 130, 40, 0, 60, 130, 40, 255]));
    folder.write("down.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 30\n0 45 90\n0\n1300 900 0\n");
    let relief: Vec<String> = (0..64).map(|i| format!("{0} {0} {0}", (i * 37) % 200)).collect();
    folder.write("relief.ppm", format!("P3\n8 8\n255\n{}\n", relief.join("\n")));
    folder.write(
        "uplight.ies",
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 4 1 1 2 0 0 0\n1 1 30\n100 120 150 180\n0\n0 900 1300 1400\n",
    );
    folder.write("off.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 0 3 1 1 2 0 0 0\n1 1 30\n0 45 90\n0\n1300 900 0\n");
    folder.write("level.pgm", format!("P2\n4 4\n255\n{}\n", "180\n".repeat(16)));
    let hills: Vec<String> = (0..256).map(|i| ((i % 16) * (i / 16) % 50 * 5).to_string()).collect();
    folder.write("hills.pgm", format!("P2\n16 16\n255\n{}\n", hills.join("\n")));
}

#[test]
fn each_cause_is_reported_first_and_its_near_miss_is_not() {
    let folder = TestFolder::new();
    put_files(&folder);
    let cases = cases();
    let (mut wrong, mut text) = (Vec::new(), BTreeSet::new());
    // Scenes with the same options are checked in one run.
    let mut of_options: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (number, case) in cases.iter().enumerate() {
        folder.write(&format!("{number}.txt"), &case.text);
        of_options.entry(case.options.join(" ")).or_default().push(number);
    }
    let mut found: BTreeMap<usize, Value> = BTreeMap::new();
    for (options, numbers) in of_options {
        let names: String = numbers.iter().map(|number| format!("{number}.txt ")).collect();
        let output = folder.run(&format!("check {names} --json {options}"));
        let json: Value =
            serde_json::from_str(&output.out).unwrap_or_else(|error| panic!("{options}: {error}\n{}", output.err));
        found.extend(numbers.into_iter().zip(json["scenes"].as_array().unwrap().iter().cloned()));
    }
    for (number, case) in cases.iter().enumerate() {
        let findings = found[&number]["findings"].as_array().unwrap();
        let codes: Vec<&str> = findings.iter().map(|finding| finding["code"].as_str().unwrap()).collect();
        let is_right = match case.kind {
            Kind::Sound => findings.iter().all(|finding| finding["severity"] == "note"),
            Kind::Broken => codes.first() == Some(&case.code.as_str()),
        };
        if !is_right {
            wrong.push(format!("{}: {codes:?}", case.line));
        }
        text.extend((case.kind == Kind::Broken).then_some(case.code.as_str()));
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
    assert!(cases.len() > 100 && text.len() > 50, "{} cases of {} causes", cases.len(), text.len());
}

/// Checks that every code has a scene, either here or in a file of its own.
#[test]
fn every_cause_has_a_scene() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/command/broken");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let of_files = files.filter_map(|name| Some(name.split_once('.')?.0.to_string()));
    let shown: BTreeSet<String> = cases().into_iter().map(|case| case.code).chain(of_files).collect();
    let list = TestFolder::new().expect_exit(0, "check --codes").out;
    let listed = list.lines().map(|line| line.split(' ').next().unwrap());
    let without: Vec<&str> = listed.filter(|code| !shown.contains(*code)).collect();
    assert_eq!(without, WITHOUT.map(|(code, _)| code));
}

/// Codes that no scene can trigger, or that commands other than `check` report.
const WITHOUT: [(&str, &str); 7] = [
    ("bad-place", "the readers of models report it"),
    ("metal-default", "only glTF files can have it"),
    ("not-finite", "values that give NaN have their own findings"),
    ("all-missed", "another finding explains every known case"),
    ("one-color", "another finding explains every known case"),
    ("dialect", "it accompanies other findings"),
    ("mesh-file", "the readers of models report it"),
];
