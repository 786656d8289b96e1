//! Builds the program under test.

use anyhow::{Result, bail};
use std::path::PathBuf;
use std::process::Command;

/// Builds `durer` in release mode and returns its path. If the variable `DURER_EXE` is set, returns
/// that path instead.
pub fn build_durer() -> Result<PathBuf> {
    if let Some(built) = std::env::var_os("DURER_EXE") {
        return Ok(PathBuf::from(built).canonicalize()?);
    }
    let status =
        Command::new(crate::cargo()).args(["build", "--release", "--quiet", "--package", "durer-cli"]).status()?;
    if !status.success() {
        bail!("cannot build the program");
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    Ok(target.join("release/durer").canonicalize()?)
}
