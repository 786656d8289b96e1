//! Regression tests: small scenes whose pictures once differed from the official ones.

use super::{ROUNDING, difference, read};
use anyhow::{Context, Result};
use std::path::Path;
use std::process::{Command, Stdio};

/// Maximum percentage of pixels that can differ by more than rounding.
const MAX_DIFFERING: f64 = 0.1;

/// Known pixels of official pictures that are missing: scene, position, colour.
const PIXELS: [(&str, [usize; 2], [u8; 3]); 1] = [("glassplane", [10, 30], [41, 68, 116])];

/// A regression scene and the dialect that its name indicates.
struct Scene {
    name: String,
    dialect: &'static str,
}

impl Scene {
    fn of(name: &str) -> Self {
        let dialects = ["f12a4", "f12a5", "f16", "f23"];
        let named = dialects.into_iter().find(|dialect| name.contains(dialect));
        let dialect = named.unwrap_or(if name.starts_with("a4") { "f12a4" } else { "f12a5" });
        Scene { name: name.into(), dialect }
    }

    /// Returns the official program that rendered the picture.
    fn program(&self) -> &'static str {
        match self.dialect {
            "f12a4" => "a4soln",
            "f12a5" => "a5soln-v2",
            "f16" => "a4",
            _ => "assignment4",
        }
    }

    /// Returns the arguments of the official program, as listed beside the scenes.
    fn arguments(&self, depth: &Path) -> Vec<String> {
        let mut words: Vec<String> = match self.name.as_str() {
            "glassplane" => ["-size", "64", "64", "-bounces", "2"].map(String::from).to_vec(),
            name if name.starts_with("axis_mesh") => ["-size", "33", "33"].map(String::from).to_vec(),
            name if name.starts_with("size1x1") => ["-size", "1", "1"].map(String::from).to_vec(),
            _ => ["-size", "32", "32"].map(String::from).to_vec(),
        };
        if self.name.starts_with("light_on_wall") {
            words.push("-shadows".into());
        }
        let range = match self.name.as_str() {
            "a4_depth_reversed" => Some(["9", "2"]),
            "a4_depth_same" => Some(["5", "5"]),
            _ => None,
        };
        if let Some([min, max]) = range {
            words.extend(["-depth", min, max].map(String::from));
            words.push(depth.display().to_string());
        }
        words
    }
}

/// Renders the scenes in a folder and prints a table. Returns the number of failures.
pub fn run(durer: &Path, folder: &Path, meshes: &Path, out: &Path, only: Option<&str>) -> Result<usize> {
    let mut names: Vec<String> = std::fs::read_dir(folder)?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok()?.strip_suffix(".txt").map(String::from))
        .filter(|name| only.is_none_or(|only| name.contains(only)))
        .collect();
    names.sort();
    let mut wrong = 0;
    for name in &names {
        let scene = Scene::of(name);
        let [ours, depth] = ["bmp", "depth.bmp"].map(|ending| out.join(format!("{name}.{ending}")));
        let output = Command::new(durer)
            .current_dir(folder)
            .args(["course", "--quiet", "--allow-outside", "--program", scene.program(), "--assets"])
            .arg(meshes.join(scene.dialect))
            .arg("-input")
            .arg(format!("{name}.txt"))
            .args(scene.arguments(&depth))
            .arg("-output")
            .arg(&ours)
            .stdin(Stdio::null())
            .output()
            .context("cannot start the program")?;
        let mut messages = Vec::new();
        let mut agrees = output.status.success();
        if agrees {
            for (ending, made) in [("official", &ours), ("officiald", &depth)] {
                let official = folder.join(format!("{name}_{ending}.png"));
                if official.exists() {
                    let (share, largest) = difference(&read(made)?, &read(&official)?);
                    agrees &= share <= MAX_DIFFERING;
                    messages.push(format!("{share:.3} % of the pixels differ, by {largest} at most"));
                }
            }
            for (_, [x, y], official) in PIXELS.iter().filter(|(of, ..)| of == name) {
                let picture = read(&ours)?;
                let own = picture.pixels[y * picture.width as usize + x];
                agrees &= own.iter().zip(official).all(|(a, b)| a.abs_diff(*b) <= ROUNDING);
                messages.push(format!("pixel {x},{y} is {own:?}, officially {official:?}"));
            }
        } else {
            messages.push(String::from_utf8_lossy(&output.stderr).lines().next().unwrap_or("refused").into());
        }
        // These results are undefined: a single pixel has no position between first and last, or a
        // mesh is missing.
        let undefined = name.starts_with("size1x1") || messages.iter().any(|line| line.contains("missing-file"));
        wrong += usize::from(!agrees && !undefined);
        let verdict = if agrees {
            "pass"
        } else if undefined {
            "open"
        } else {
            "FAIL"
        };
        println!("{verdict:<5}{name:<28} {}", if messages.is_empty() { "drawn".into() } else { messages.join("; ") });
    }
    Ok(wrong)
}
