//! Equal scenes by Dürer and Mitsuba 3: `peers.py` says which and how they are compared,
//! `peers_time.py` how their times are.

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// The version that the figures of docs/validation.md are of.
const MITSUBA: &str = "mitsuba==3.9.1";

pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let (mut python, mut time, mut rest) = (None, false, Vec::new());
    let mut given = arguments.iter();
    while let Some(argument) = given.next() {
        match argument.as_str() {
            "--time" => time = true,
            "--python" => python = Some(PathBuf::from(given.next().context("--python PROGRAM")?)),
            _ => rest.push(argument),
        }
    }
    let root = crate::root()?;
    let python = match python {
        Some(python) => python,
        None => environment(&root.join("target/peers"))?,
    };
    let program = crate::build::durer()?;
    let mut command = Command::new(python);
    match time {
        true => command.arg(root.join("xtask/src/peers_time.py")).arg(program).arg(crate::corpus().join("meshes")),
        false => command.arg(root.join("xtask/src/peers.py")).arg(program),
    };
    let status = command.args(rest).status()?;
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A Python with Mitsuba, made once from the package index.
fn environment(folder: &Path) -> Result<PathBuf> {
    let python = folder.join("bin/python");
    if !python.exists() {
        did(Command::new("python3").args(["-m", "venv"]).arg(folder))?;
    }
    did(Command::new(&python).args(["-m", "pip", "install", "--quiet", MITSUBA, "numpy"]))?;
    Ok(python)
}

fn did(command: &mut Command) -> Result<()> {
    match command.status().with_context(|| format!("{command:?}"))?.success() {
        true => Ok(()),
        false => bail!("{command:?} failed"),
    }
}
