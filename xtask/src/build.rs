//! The program that is tried.

use anyhow::{Result, bail};
use std::path::PathBuf;
use std::process::Command;

/// Builds `durer`; where it is. `DURER_EXE` names one that is built already.
pub fn durer() -> Result<PathBuf> {
    built("release")
}

/// The same as it is given to others: some percent faster, and twice as long to build.
pub fn given_away() -> Result<PathBuf> {
    built("dist")
}

fn built(profile: &str) -> Result<PathBuf> {
    if let Some(built) = std::env::var_os("DURER_EXE") {
        return Ok(PathBuf::from(built).canonicalize()?);
    }
    let build = ["build", "--profile", profile, "--quiet", "--package", "durer-cli"];
    if !Command::new(crate::cargo()).args(build).status()?.success() {
        bail!("the program does not build");
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    Ok(target.join(profile).join("durer").canonicalize()?)
}
