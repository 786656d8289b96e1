//! Broken scenes for testing `durer check`, stored as edits of correct scenes.

use anyhow::{Context, Result, bail};
use std::path::Path;
use std::process::Command;

const SCENES: &str = include_str!("broken.txt");

/// A scene for testing `durer check`: its options, and the codes that correctly name its fault.
/// Without codes, the scene is correct.
struct Case {
    name: String,
    codes: Vec<String>,
    options: Vec<String>,
    text: String,
}

fn cases() -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    let (mut base, mut options, mut text) = (String::new(), String::new(), String::new());
    let mut sound = false;
    for line in SCENES.lines() {
        if let Some(rest) = line.strip_prefix("base ") {
            let (name, given) = rest.split_once(' ').unwrap_or((rest, ""));
            (base, options, text, sound) = (name.into(), given.into(), String::new(), false);
        } else if let Some(rest) = line.strip_prefix("case ") {
            let words = |options: &str| options.split_whitespace().map(String::from).collect::<Vec<_>>();
            if !std::mem::replace(&mut sound, true) {
                let (name, options) = (format!("{base} unchanged"), words(&options));
                cases.push(Case { name, codes: Vec::new(), options, text: text.clone() });
            }
            let (rest, more) = rest.rsplit_once('+').filter(|(_, more)| more.starts_with("--")).unwrap_or((rest, ""));
            let mut parts = rest.split(" | ");
            let codes = parts.next().unwrap_or("").split(',').map(|code| code.trim().into()).collect();
            let mut broken = text.clone();
            for part in parts {
                let (old, new) = part.split_once("=>").with_context(|| line.to_string())?;
                let [old, new] = [old, new].map(|s| s.trim().replace("\\n", "\n"));
                let end = part.trim_end().ends_with("=>");
                if !broken.contains(&old) {
                    bail!("`{old}` is not in the scene `{base}`");
                }
                broken = broken.replacen(&old, if end { "" } else { &new }, 1);
            }
            cases.push(Case {
                name: format!("{base} {rest}{more}"),
                codes,
                options: words(&format!("{options} {more}")),
                text: broken,
            });
        } else if !line.starts_with('#') && !base.is_empty() {
            text += &line.replace("\\r", "\r");
            text += "\n";
        }
    }
    Ok(cases)
}

/// Tests `durer check` on all cases. Returns true if the goals are met.
pub fn test_check(durer: &Path, folder: &Path, wanted: &dyn Fn(&str) -> bool) -> Result<bool> {
    meshes(folder)?;
    let (mut first, mut second, mut later, mut missed, mut alarms) = (0, 0, 0, 0, 0);
    let cases = cases()?;
    for case in cases.iter().filter(|case| wanted(&case.name)) {
        std::fs::write(folder.join("broken.txt"), &case.text)?;
        // If an option is given several times, keep only the last one.
        let mut options = case.options.clone();
        for name in ["--dialect", "--bounces", "--integrator"] {
            let places: Vec<usize> = (0..options.len()).filter(|&i| options[i] == name).collect();
            if let [first, _] = places[..] {
                options.drain(first..first + 2);
            }
        }
        let mut check = Command::new(durer);
        check.current_dir(folder).args(["check", "broken.txt", "--json"]).args(&options);
        let text = output_of_any(&mut check)?;
        let found: Vec<&str> = text
            .split("\"findings\": [")
            .nth(1)
            .unwrap_or("")
            .split("\"code\": \"")
            .skip(1)
            .filter_map(|rest| rest.split('"').next())
            .collect();
        if case.codes.is_empty() {
            alarms +=
                usize::from(text.contains("\"severity\": \"warning\"") || text.contains("\"severity\": \"error\""));
            println!("sound   {:<60.60} {found:?}", case.name);
            continue;
        }
        let at = found.iter().position(|code| case.codes.iter().any(|wanted| wanted == code));
        let word = match at {
            Some(0) => "first",
            Some(1) => "second",
            Some(_) => "later",
            None => "MISSED",
        };
        *match at {
            Some(0) => &mut first,
            Some(1) => &mut second,
            Some(_) => &mut later,
            None => &mut missed,
        } += 1;
        if at != Some(0) {
            println!("{word:<7} {:<90.90} {found:?}", case.name.replace('\n', " "));
        }
    }
    let all = first + second + later + missed;
    println!(
        "\n| | first | among the first two | later | missed | false alarms |\n| --- | --- | --- | --- | --- | --- |"
    );
    println!("| `check`, {all} broken scenes | {first} | {second} | {later} | {missed} | {alarms} |");
    let percent = |count: usize| 100.0 * count as f64 / all.max(1) as f64;
    println!("first: {:.1} %, among the first two: {:.1} %", percent(first), percent(first + second));
    Ok(first * 10 >= all * 9 && (first + second) * 100 >= all * 97 && alarms == 0)
}

/// Returns what a program prints, whatever its exit code.
fn output_of_any(command: &mut Command) -> Result<String> {
    let output = command.stdin(std::process::Stdio::null()).output()?;
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Writes mesh files of a box, each with a different fault.
fn meshes(folder: &Path) -> Result<()> {
    let corners = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";
    let quads = [[1, 4, 3, 2], [5, 6, 7, 8], [1, 2, 6, 5], [2, 3, 7, 6], [3, 4, 8, 7], [4, 1, 5, 8]];
    let triangles: Vec<[i32; 3]> = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let text = |faces: &[[i32; 3]]| {
        let faces: Vec<String> = faces.iter().map(|[a, b, c]| format!("f {a} {b} {c}\n")).collect();
        format!("{corners}{}", faces.concat())
    };
    let turned = |count: usize| -> Vec<[i32; 3]> {
        let turn = |(i, [a, b, c]): (usize, &[i32; 3])| if i < count { [*a, *c, *b] } else { [*a, *b, *c] };
        triangles.iter().enumerate().map(turn).collect()
    };
    let fours: Vec<String> = quads.iter().map(|[a, b, c, d]| format!("f {a} {b} {c} {d}\n")).collect();
    let mut far = triangles.clone();
    far[3][1] = 19;
    let mut flat = triangles.clone();
    flat.extend([[1, 1, 2], [3, 3, 3]]);
    for (name, text) in [
        ("box.obj", text(&triangles)),
        ("quads.obj", format!("{corners}{}", fours.concat())),
        ("wrong_index.obj", text(&far)),
        ("empty.obj", "# nothing\n".into()),
        ("wound.obj", text(&turned(3))),
        ("inside_out.obj", text(&turned(12))),
        ("degenerate.obj", text(&flat)),
        ("open.obj", text(&triangles[2..])),
    ] {
        std::fs::write(folder.join(name), text)?;
    }
    Ok(())
}
