//! `cargo xtask verify`: runs `durer verify` on all scenes.

use crate::build::build_durer;
use anyhow::{Context, Result};
use std::path::PathBuf;
use std::process::{Command, ExitCode};

/// Options with different samplers and stopping rules, which the scenes use in turn.
const JOBS: [&str; 6] = [
    "--show color,depth,normals,albedo,sample-count,variance",
    "--samples 40 --noise-threshold 0.03",
    "--samples 20 --adaptive --show color,sample-count",
    "--sampler random --samples 9 --filter gaussian",
    "--jitter --blur --crop 9,3,31x29 --show color,position",
    "--filter mitchell --samples 13",
];

/// Runs `cargo xtask verify`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let value = |name| crate::value(arguments, name);
    let (trials, only) = (value("--trials").map_or("500", String::as_str), value("--only"));
    let mut scenes: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(crate::root()?.join("scenes"))? {
        scenes.push(entry?.path());
    }
    scenes.retain(|path| path.extension().is_some_and(|e| e == "txt"));
    scenes.retain(|path| only.is_none_or(|only| path.to_string_lossy().contains(only.as_str())));
    scenes.sort();
    let (durer, mut failed) = (build_durer()?, 0);
    for (scene, job) in scenes.iter().zip(JOBS.iter().cycle()) {
        let mut command = Command::new(&durer);
        command.arg("verify").arg(scene).args(["--trials", trials]).args(job.split_whitespace());
        let output = command.output()?;
        let messages = [output.stdout, output.stderr].concat();
        let messages = String::from_utf8(messages)?;
        let name = scene.file_stem().context("a name")?.to_string_lossy();
        println!(
            "{name:<16}{job}\n  {}",
            messages.lines().filter(|l| !l.starts_with("note")).collect::<Vec<_>>().join("\n  ")
        );
        failed += usize::from(!output.status.success());
    }
    println!("\n{} scenes, {failed} failed", scenes.len());
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
