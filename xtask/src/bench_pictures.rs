//! `cargo xtask bench-pictures`: compares complete renders with POV-Ray, using `bench_pictures.py`.

use anyhow::Result;
use std::process::{Command, ExitCode};

/// Runs `cargo xtask bench-pictures`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let program = crate::build::build_durer()?;
    let script = crate::root()?.join("xtask/src/bench_pictures.py");
    let dragon = crate::corpus().join("meshes/dragon.ply");
    let status = Command::new("python3").arg(script).arg(program).arg(dragon).args(arguments).status()?;
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
