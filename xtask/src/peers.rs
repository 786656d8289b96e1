//! `cargo xtask peers`: compares Dürer with Mitsuba 3 on equal scenes. In the folder `peers`,
//! `compare.py` compares pictures, `speed.py` render times, and `direct.py` the cost of direct
//! light, also with Blender's Cycles. The scenes are in `peers/kinds`, one file per kind.

use crate::section::Section;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Part of docs/validation.md that this command writes.
pub const SECTION: Section = Section { page: "docs/validation.md", command: "peers" };

/// Versions with which the figures in docs/validation.md were measured.
const MITSUBA: &str = "mitsuba==3.9.1";
const BLENDER: &str = "bpy==5.0.1";

/// Runs `cargo xtask peers`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let (mut python, mut script, mut rest) = (None, "compare.py", Vec::new());
    let mut given = arguments.iter();
    while let Some(argument) = given.next() {
        match argument.as_str() {
            "--time" => script = "speed.py",
            "--direct" => script = "direct.py",
            "--python" => python = Some(PathBuf::from(given.next().context("--python PROGRAM")?)),
            _ => rest.push(argument),
        }
    }
    let root = crate::root()?;
    let python = match python {
        Some(python) => python,
        None => environment(&root.join("target/peers"), script == "direct.py")?,
    };
    let mut command = Command::new(python);
    command.arg(root.join("xtask/src/peers").join(script)).arg(crate::build::build_durer()?);
    let table = (script == "compare.py" && rest.is_empty()).then(|| root.join("target/peers-table.md"));
    match &table {
        Some(table) => command.arg("--table").arg(table),
        None if script == "compare.py" => &mut command,
        None => command.arg(crate::corpus().join("meshes")),
    };
    let status = command.args(rest).status()?;
    if let Some(table) = table {
        SECTION.write(&std::fs::read_to_string(table)?)?;
    }
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Creates a Python environment with Mitsuba and, if it supports this Python version, Blender.
fn environment(folder: &Path, blender: bool) -> Result<PathBuf> {
    let python = folder.join("bin/python");
    if !python.exists() {
        did(Command::new("python3").args(["-m", "venv"]).arg(folder))?;
    }
    did(Command::new(&python).args(["-m", "pip", "install", "--quiet", MITSUBA, "numpy"]))?;
    if blender && did(Command::new(&python).args(["-m", "pip", "install", "--quiet", BLENDER])).is_err() {
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
