//! `cargo xtask manual`: what the cameras state of themselves, as a page for people.

use durer::camera::Camera;
use durer::describe::{DescribedList, Field, Kind, Rule, Value};
use durer::dialect::{Dialect, set};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const HEAD: &str = "# Cameras

The cameras of Dürer's own dialect of the scene language, with their fields. This page is written by `cargo xtask manual`
from what the code states; a test holds it to that.

A camera is written like `FisheyeCamera { center 0 1 0 direction 0 0 -1 up 0 1 0 angle 180 }`, with its fields in any order.
Lengths are in the units of the scene, angles in degrees. Fields without a default must be given. Only the first two are
words of the course's own years; the others are refused with `--strict`. The mathematics of each, with its sources, is at
the head of its file in `crates/durer/src/camera/`.
";

pub fn run() -> anyhow::Result<ExitCode> {
    std::fs::write(page(), text())?;
    println!("wrote {}", page().display());
    Ok(ExitCode::SUCCESS)
}

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/cameras.md")
}

fn text() -> String {
    let mut out = HEAD.to_string();
    for camera in Camera::kinds() {
        let name = camera.keyword(Dialect::Durer);
        // Writing to a String cannot fail.
        let _ = write!(
            out,
            "\n## {name}\n\n{}\n\n| field | value | default | meaning |\n| --- | --- | --- | --- |\n",
            one_line(camera.doc())
        );
        for (i, field) in camera.fields().iter().enumerate() {
            let Some(word) = field.spelling(Dialect::Durer) else { continue };
            let default = camera.get(i).filter(|_| !field.required).map_or(String::new(), |value| shown(&value));
            let _ = writeln!(out, "| `{word}` | {} | {default} | {} |", value_of(field), one_line(field.doc));
        }
        if camera.keywords().iter().all(|(_, dialects)| *dialects == set::DURER) {
            continue;
        }
        let years: Vec<&str> = Dialect::ALL
            .into_iter()
            .filter(|d| *d != Dialect::Durer)
            .filter(|d| camera.keywords().iter().any(|(_, dialects)| d.is_in(*dialects)))
            .map(Dialect::name)
            .collect();
        let _ = writeln!(out, "\nAlso a camera of {}.", years.join(", "));
    }
    out
}

fn one_line(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What a field's value may be.
fn value_of(field: &Field) -> String {
    let kind = match field.kind {
        Kind::Float => "number".to_string(),
        Kind::Int => "whole number".into(),
        Kind::Vec3 => "three numbers".into(),
        Kind::Path => "path".into(),
        Kind::Word(words) => return words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", "),
        Kind::Rows(width) => format!("`{{ }}` of rows of {width} numbers"),
    };
    let rule = match field.rule {
        Rule::Any => return kind,
        Rule::Positive => "more than 0".to_string(),
        Rule::NonNegative => "0 or more".into(),
        Rule::NonZero => "not 0 0 0".into(),
        Rule::Between(low, high) => format!("more than {low}, less than {high}"),
        Rule::UpTo(high) => format!("more than 0, at most {high}"),
        Rule::AtMost(most) => format!("at most {most}"),
        Rule::Count(least, most) if least == most => format!("{least} of them"),
        Rule::Count(least, most) => format!("{least} to {most} of them"),
        Rule::Counts(most) => format!("whole, 1 to {most}"),
    };
    format!("{kind}, {rule}")
}

fn shown(value: &Value) -> String {
    match value {
        Value::Float(x) => x.to_string(),
        Value::Int(i) => i.to_string(),
        Value::Vec3(v) => format!("{} {} {}", v.x, v.y, v.z),
        Value::Path(name) => name.path.clone(),
        Value::Word(word) => format!("`{word}`"),
        Value::Rows(_) => String::new(),
    }
}

#[test]
fn the_page_says_what_the_code_states() {
    assert!(std::fs::read_to_string(page()).unwrap() == text(), "run `cargo xtask manual`");
}
