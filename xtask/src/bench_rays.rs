//! `cargo xtask bench-rays`: runs a separate workspace, so that the crates we compare with are only
//! compiled for it.

use crate::root;
use std::process::{Command, ExitCode};

pub fn run(arguments: &[String]) -> anyhow::Result<ExitCode> {
    let mut command = Command::new(crate::cargo());
    command.args(["run", "--release", "--quiet", "--manifest-path"]).arg(root()?.join("bench/Cargo.toml")).arg("--");
    let status = command.args(arguments).status()?;
    Ok(ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)))
}
