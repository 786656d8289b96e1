//! `cargo xtask teach`: tests `durer compare` with wrong pictures and `durer check` with broken
//! scenes. Both come from independent tracers, the judge, that share only the scene language with
//! the library.

mod broken;
#[allow(clippy::disallowed_methods, reason = "the judge shares no arithmetic with the library")]
mod paths;
#[allow(clippy::disallowed_methods, reason = "the judge shares no arithmetic with the library")]
mod scene;
#[allow(clippy::disallowed_methods, reason = "the judge shares no arithmetic with the library")]
mod tracer;
mod vector;
mod wrong;

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use tracer::{Picture, Tracer};

/// Result of `durer compare` for a wrong picture, given the mistakes it was rendered with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// The mistakes were named, alone or with others that give the same picture.
    Identified,
    /// No mistake was named.
    NotIdentified,
    /// Only other mistakes were named.
    Wrong,
    /// The picture equals the reference, because the mistake is invisible in this scene.
    Invisible,
}

/// Runs `cargo xtask teach`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let only = crate::value(arguments, "--only");
    let durer = crate::build::build_durer()?;
    let keep = crate::value(arguments, "--keep").map(PathBuf::from);
    let folder =
        keep.clone().unwrap_or_else(|| std::env::temp_dir().join(format!("durer-teach-{}", std::process::id())));
    std::fs::create_dir_all(&folder)?;
    let wanted = |name: &str| only.is_none_or(|text| name.contains(text.as_str()));
    let mut good = true;
    if !arguments.iter().any(|a| a == "--check") {
        good &= pictures(&durer, &folder, &wanted)?;
        good &= paths::pictures(&durer, &folder, &wanted)?;
    }
    if !arguments.iter().any(|a| a == "--compare") {
        good &= broken::test_check(&durer, &folder, &wanted)?;
    }
    if keep.is_none() {
        std::fs::remove_dir_all(&folder)?;
    }
    Ok(if good { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Tests `durer compare` on all wrong pictures. Returns true if the goals are met.
fn pictures(durer: &Path, folder: &Path, wanted: &dyn Fn(&str) -> bool) -> Result<bool> {
    let scenes = wrong::scenes();
    let cases: Vec<wrong::Case> = wrong::cases();
    let cases: Vec<&wrong::Case> = cases
        .iter()
        .filter(|case| wanted(&format!("{} {}", scenes[case.scene].name, case.mistakes.join(" "))))
        .collect();
    if cases.is_empty() {
        return Ok(true);
    }
    for scene in &scenes {
        let own = folder.join(scene.name);
        std::fs::create_dir_all(&own)?;
        std::fs::write(own.join("scene.txt"), scene.text())?;
        if scene.sky {
            std::fs::create_dir_all(own.join("sky"))?;
        }
        scene.files().into_iter().try_for_each(|(name, text)| std::fs::write(own.join(name), text))?;
        let mut render = Command::new(durer);
        render.current_dir(&own).args(["render", "scene.txt", "-o", "right.ppm", "-q"]).args(scene.options());
        output(&mut render)?;
        let ours = Tracer::new(scene, &[]).picture();
        let right = std::fs::read(own.join("right.ppm"))?;
        let theirs = &right[right.len() - 3 * ours.len()..];
        let far = |(a, b): (&[u8; 3], &[u8])| (0..3).any(|c| a[c].abs_diff(b[c]) > 2);
        let off = ours.iter().zip(theirs.chunks(3)).filter(|pair| far(*pair)).count();
        println!(
            "scene {:<13} the two tracers differ in {:.2} % of the pixels",
            scene.name,
            100.0 * off as f64 / ours.len() as f64
        );
        std::fs::write(own.join("own.ppm"), ppm(scene.size, &ours))?;
    }
    let results: Vec<Result<(String, Outcome)>> = cases
        .iter()
        .map(|case| {
            let scene = &scenes[case.scene];
            let own = folder.join(scene.name);
            let name = format!("{}.ppm", case.mistakes.join("+"));
            let picture = Tracer::new(scene, &case.mistakes).picture();
            let unseen = ppm(scene.size, &picture) == std::fs::read(own.join("own.ppm"))?;
            std::fs::write(own.join(&name), ppm(scene.size, &picture))?;
            let mut compare = Command::new(durer);
            compare.current_dir(&own).args(["compare", "right.ppm", &name, "--scene", "scene.txt", "--json"]);
            compare.args(scene.options().iter().take_while(|o| *o != "--size")).args(&scene.options()[4..]);
            let started = std::time::Instant::now();
            let text = output(&mut compare)?;
            let seconds = started.elapsed().as_secs_f64();
            let (outcome, words) =
                if unseen { (Outcome::Invisible, String::new()) } else { judged(&text, &case.mistakes) };
            let line =
                format!("{outcome:<8?} {seconds:5.1} s  {:<13} {:<38} {words}", scene.name, case.mistakes.join(" + "));
            println!("{line}");
            Ok((line, outcome))
        })
        .collect();
    let results: Vec<(String, Outcome)> = results.into_iter().collect::<Result<_>>()?;
    Ok(summary("", &results, 0.9))
}

/// Prints a table of the outcomes. Returns true if none is wrong and at least a fraction `goal` of
/// the visible mistakes was identified.
fn summary(kind: &str, results: &[(String, Outcome)], goal: f64) -> bool {
    let count = |outcome| results.iter().filter(|r| r.1 == outcome).count();
    let [right, not_told, wrong, unseen] =
        [Outcome::Identified, Outcome::NotIdentified, Outcome::Wrong, Outcome::Invisible].map(count);
    let seen = results.len() - unseen;
    println!(
        "\n| | identified | not identified | **misidentified** | invisible in this scene |\n| --- | --- | --- | --- | --- |"
    );
    println!("| `compare`, {seen} wrong {kind}pictures | {right} | {not_told} | **{wrong}** | {unseen} |");
    println!("identified: {:.1} %\n", 100.0 * right as f64 / seen.max(1) as f64);
    wrong == 0 && right as f64 >= goal * seen as f64
}

/// Compares the mistakes in the JSON output of `durer compare` with the actual ones. Only their
/// names count.
fn judged(json: &str, made: &[&str]) -> (Outcome, String) {
    let verdict = |name: &str| json.contains(&format!("\"verdict\": \"{name}\""));
    if verdict("identical") || verdict("same") {
        return (Outcome::Invisible, String::new());
    }
    let named = match json.split("\"named\": [").nth(1) {
        Some(rest) => rest.split("\"reference_off\"").next().unwrap_or(""),
        None => "",
    };
    // One entry for each set of mistakes that gives the picture.
    let sets: Vec<Vec<&str>> = named
        .split("\"mistakes\": [")
        .skip(1)
        .map(|set| set.split("\"name\": \"").skip(1).filter_map(|rest| rest.split('"').next()).collect())
        .collect();
    // A mistake that is not in the table cannot be named.
    if made.iter().any(|made| made.starts_with("x-")) && sets.is_empty() {
        return (Outcome::Identified, "not identified".into());
    }
    if sets.is_empty() {
        return (Outcome::NotIdentified, String::new());
    }
    let wanted: Vec<&str> = made.iter().map(|made| wrong::description(made)).collect();
    let right = sets.iter().any(|set| set.len() == wanted.len() && wanted.iter().all(|name| set.contains(name)));
    let words = sets.iter().map(|set| set.join(" + ")).collect::<Vec<_>>().join(" = ");
    (if right { Outcome::Identified } else { Outcome::Wrong }, words)
}

fn ppm((width, height): (usize, usize), picture: &Picture) -> Vec<u8> {
    let mut bytes = format!("P6\n{width} {height}\n255\n").into_bytes();
    bytes.extend(picture.iter().flatten());
    bytes
}

/// Returns what a program prints. Fails if its exit code is above 1.
fn output(command: &mut Command) -> Result<String> {
    let output = command.stdin(Stdio::null()).output().context("cannot start the program")?;
    if output.status.code().is_none_or(|code| code > 1) {
        bail!("{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
