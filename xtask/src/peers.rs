//! `cargo xtask peers`: compares Dürer with Mitsuba 3 on equal scenes. In the folder `peers`,
//! `compare.py` compares pictures, `speed.py` render times, and `direct.py` the cost of direct
//! light, also with Blender's Cycles. The scenes are in `peers/kinds`, one file per kind.
//! `daylight.py` compares the daylight of a year with Radiance.

use crate::section::Section;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Part of docs/validation.md that this command writes.
pub const SECTION: Section = Section { page: "docs/validation.md", command: "peers" };

/// Part of docs/daylight.md that this command writes with `--daylight`.
const DAYLIGHT: Section = Section { page: "docs/daylight.md", command: "peers --daylight" };

/// Versions with which the figures in docs/validation.md and docs/daylight.md were measured.
const MITSUBA: &str = "mitsuba==3.9.1";
const BLENDER: &str = "bpy==5.0.1";
const RADIANCE: &str = "pyradiance==1.3.1";

/// Runs `cargo xtask peers`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let (mut python, mut script, mut rest) = (None, "compare.py", Vec::new());
    let mut given = arguments.iter();
    while let Some(argument) = given.next() {
        match argument.as_str() {
            "--time" => script = "speed.py",
            "--direct" => script = "direct.py",
            "--daylight" => script = "daylight.py",
            "--python" => python = Some(PathBuf::from(given.next().context("--python PROGRAM")?)),
            _ => rest.push(argument),
        }
    }
    let root = crate::root()?;
    let python = match python {
        Some(python) => python,
        None => environment(&root.join("target/peers"), script)?,
    };
    let mut command = Command::new(python);
    command.arg(root.join("xtask/src/peers").join(script)).arg(crate::build::build_durer()?);
    let section = match script {
        "compare.py" => Some(&SECTION),
        "daylight.py" => Some(&DAYLIGHT),
        _ => None,
    };
    let table = section.filter(|_| rest.is_empty()).map(|section| (section, root.join("target/peers-table.md")));
    match (&table, section) {
        (Some((_, table)), _) => command.arg("--table").arg(table),
        (None, Some(_)) => &mut command,
        (None, None) => command.arg(crate::corpus().join("meshes")),
    };
    let status = command.args(rest).status()?;
    if let Some((section, table)) = table {
        section.write(&std::fs::read_to_string(table)?)?;
    }
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Creates a Python environment with the packages of a script: Mitsuba and, if it supports this
/// Python version, Blender, or Radiance.
fn environment(folder: &Path, script: &str) -> Result<PathBuf> {
    let python = folder.join("bin/python");
    if !python.exists() {
        did(Command::new("python3").args(["-m", "venv"]).arg(folder))?;
    }
    let peer = if script == "daylight.py" { RADIANCE } else { MITSUBA };
    did(Command::new(&python).args(["-m", "pip", "install", "--quiet", peer, "numpy"]))?;
    if script == "direct.py" && did(Command::new(&python).args(["-m", "pip", "install", "--quiet", BLENDER])).is_err() {
        eprintln!("{BLENDER} does not support this Python: skipping Cycles");
    }
    Ok(python)
}

fn did(command: &mut Command) -> Result<()> {
    match command.status().with_context(|| format!("{command:?}"))?.success() {
        true => Ok(()),
        false => bail!("{command:?} failed"),
    }
}
