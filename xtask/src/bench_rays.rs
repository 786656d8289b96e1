//! `cargo xtask bench-rays`: runs the separate workspace `bench`, so that the crates for comparison
//! are compiled only for it.

use crate::root;
use std::process::{Command, ExitCode};

/// Runs `cargo xtask bench-rays`.
pub fn run(arguments: &[String]) -> anyhow::Result<ExitCode> {
    let mut command = Command::new(crate::cargo());
    command.args(["run", "--release", "--quiet", "--manifest-path"]).arg(root()?.join("bench/Cargo.toml")).arg("--");
    let status = command.args(arguments).status()?;
    Ok(ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)))
}
