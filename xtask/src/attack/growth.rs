//! Attack `growth`: small files that describe huge data, read with a limit of address space.

use super::{Attack, Outcome, failure_reason, inputs, name};
use anyhow::Result;
use std::fmt::Write;

/// Limits of a run: address space in KiB, and time in seconds.
const SPACE: u64 = 900_000;
const SECONDS: u64 = 20;

/// Function that returns the text of a file for a number of levels and of copies per level.
type Generator = fn(usize, usize) -> String;

/// Names of the files, and the functions that generate them.
const KINDS: [(&str, Generator); 6] = [
    ("variables.xml", |levels, copies| {
        let value = |i: usize| format!("$a{}_", i).repeat(copies);
        let all = (1..=levels).map(|i| format!("<default name=\"a{i}_\" value=\"{}\"/>\n", value(i - 1)));
        mitsuba(
            &(String::from("<default name=\"a0_\" value=\"x\"/>") + &all.collect::<String>()),
            &format!("<shape type=\"sphere\"><string name=\"x\" value=\"$a{levels}_\"/></shape>"),
        )
    }),
    ("groups.xml", |levels, copies| {
        let instance = |i: usize| format!("<shape type=\"instance\"><ref id=\"g{i}\"/></shape>");
        let group =
            |i: usize| format!("<shape type=\"shapegroup\" id=\"g{i}\">{}</shape>\n", instance(i - 1).repeat(copies));
        let first = "<shape type=\"shapegroup\" id=\"g0\"><shape type=\"sphere\"/></shape>\n";
        mitsuba(&(first.to_string() + &(1..=levels).map(group).collect::<String>()), &instance(levels))
    }),
    ("blends.xml", |levels, _| {
        let part = |i: usize| format!("<ref id=\"b{i}\"/>");
        let blend = |i: usize| format!("<bsdf type=\"blendbsdf\" id=\"b{i}\">{0}{0}</bsdf>\n", part(i - 1));
        let first = "<bsdf type=\"diffuse\" id=\"b0\"/>\n".to_string();
        mitsuba(
            &(first + &(1..=levels).map(blend).collect::<String>()),
            &format!("<shape type=\"sphere\">{}</shape>", part(levels)),
        )
    }),
    ("names.txt", |levels, copies| {
        let mut text = String::from("define a0 Sphere { center 0 0 0 radius 1 }\n");
        (1..=levels).for_each(|i| {
            let _ = writeln!(text, "define a{i} Group {{ {} }}", format!("use a{} ", i - 1).repeat(copies));
        });
        format!(
            "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }} Materials {{ PhongMaterial {{ diffuseColor 1 1 1 }} }} {text} Group {{ MaterialIndex 0 use a{levels} }}"
        )
    }),
    ("rows.gltf", |levels, copies| {
        let count = (copies as u64).saturating_pow(levels as u32).clamp(3, u64::from(u32::MAX));
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{{"componentType":5126,"type":"VEC3","count":{count},"min":[0,0,0],"max":[1,1,1]}}]}}"#
        )
    }),
    ("arrays.rad", |levels, copies| {
        let array = format!("-a {copies} -t 1 0 0 ").repeat(levels.min(8));
        format!("void plastic m\n0\n0\n5 .5 .5 .5 0 0\n!genbox m b 1 1 1 | xform {array}\n")
    }),
];

fn mitsuba(first: &str, last: &str) -> String {
    format!(
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>\n{first}{last}</scene>\n"
    )
}

/// Runs the attack.
pub fn run(attack: &Attack) -> Result<Outcome> {
    let (mut failures, mut tried) = (Vec::new(), 0);
    let mut check = |path: &str, what: String, options: &[&str]| -> Result<()> {
        let arguments = ["render", path, "--samples", "1", "-q", "--restart", "-o", "o.png", "--threads", "2"];
        let output = attack.limited(&[&arguments, options].concat(), SPACE, SECONDS)?;
        tried += 1;
        failures.extend(failure_reason(&output).map(|why| format!("{what}: {why}")));
        Ok(())
    };
    for path in inputs() {
        if path.extension().is_some_and(|end| end != "txt") {
            check(&path.to_string_lossy(), name(&path), &["--size", "8x8", "--memory", "256M"])?;
        }
    }
    for number in 0..attack.count {
        let (file, make) = KINDS[attack.random(number, 0, KINDS.len() as u64)];
        let (levels, copies) = (1 + attack.random(number, 1, 40), 2 + attack.random(number, 2, 6));
        attack.put(file, make(levels, copies))?;
        let memory = ["--memory", ["64M", "256M", "1G", "64G"][attack.random(number, 3, 4)]];
        // Half of the trials omit `--memory`, whose default depends on the limit of address space.
        let options = if attack.random(number, 4, 2) == 0 { &memory[..] } else { &[] };
        check(
            file,
            format!("{file} of {levels} levels of {copies} {options:?}"),
            &[&["--size", "8x8"], options].concat(),
        )?;
    }
    Ok(Outcome { tried, failures, note: String::new() })
}
