//! `cargo xtask blender`: packs the add-on for Blender as a zip file, and compares it with Cycles
//! in ten scenes (`packaging/blender/compare.py`).

use crate::section::Section;
use anyhow::{Context, Result, bail, ensure};
use rawzip::time::UtcDateTime;
use rawzip::{CompressionMethod, ZipArchiveWriter};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Part of docs/blender.md that `--test` writes.
const SECTION: Section = Section { page: "docs/blender.md", command: "blender" };

/// Version with which the figures in docs/blender.md were measured, and its version of Python.
const BLENDER: &str = "bpy==5.0.1";
const PYTHON: &str = "python3.11";

const ADDON: &str = "packaging/blender/durer_blender";
const MANIFEST: &str = "blender_manifest.toml";

/// Runs `cargo xtask blender`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let (mut wheels, mut python, mut is_test, mut rest) = (Vec::new(), None, false, Vec::new());
    let mut given = arguments.iter();
    while let Some(argument) = given.next() {
        match argument.as_str() {
            "--test" => is_test = true,
            "--wheel" => wheels.push(PathBuf::from(given.next().context("--wheel FILE")?)),
            "--python" => python = Some(PathBuf::from(given.next().context("--python PROGRAM")?)),
            _ => rest.push(argument),
        }
    }
    ensure!(is_test || rest.is_empty(), "{} is unknown: see `cargo xtask --help`", rest[0]);
    let root = crate::root()?;
    let file = root.join(format!("target/durer_blender-{}.zip", env!("CARGO_PKG_VERSION")));
    std::fs::create_dir_all(root.join("target"))?;
    std::fs::write(&file, zip(&files(&root, &wheels)?)?)?;
    println!("{}", file.display());
    if !is_test {
        return Ok(ExitCode::SUCCESS);
    }
    let python = match python {
        Some(python) => python,
        None => environment(&root)?,
    };
    let table = rest.is_empty().then(|| root.join("target/blender-table.md"));
    let mut command = Command::new(python);
    command.arg(root.join("packaging/blender/compare.py")).arg(&file).args(rest);
    if let Some(table) = &table {
        command.arg("--table").arg(table);
    }
    let status = command.status()?;
    if let Some(table) = table.filter(|table| table.exists()) {
        SECTION.write(&std::fs::read_to_string(table)?)?;
    }
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Creates a Python environment with Blender and the package `durer` of this repository.
fn environment(root: &Path) -> Result<PathBuf> {
    let folder = root.join("target/blender");
    let python = folder.join("bin/python");
    if !python.exists() {
        succeed(Command::new(PYTHON).args(["-m", "venv"]).arg(&folder))
            .with_context(|| format!("{BLENDER} needs {PYTHON}: name another with --python"))?;
    }
    succeed(Command::new(&python).args(["-m", "pip", "install", "--quiet", BLENDER]).arg(root))?;
    Ok(python)
}

fn succeed(command: &mut Command) -> Result<()> {
    match command.status().with_context(|| format!("{command:?}"))?.success() {
        true => Ok(()),
        false => bail!("{command:?} failed"),
    }
}

/// Returns the names and contents of the files of the add-on, sorted by name. Wheels go into the
/// folder `wheels` and are listed in the manifest, so that Blender installs them.
fn files(root: &Path, wheels: &[PathBuf]) -> Result<Vec<(String, Vec<u8>)>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(root.join(ADDON))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name == MANIFEST || name.ends_with(".py") {
            files.push((name, std::fs::read(&path)?));
        }
    }
    for license in ["LICENSE-MIT", "LICENSE-APACHE"] {
        files.push((license.into(), std::fs::read(root.join(license))?));
    }
    let mut listed = Vec::new();
    for wheel in wheels {
        let name = wheel.file_name().unwrap_or_default().to_string_lossy().into_owned();
        ensure!(name.ends_with(".whl"), "{} is not a wheel", wheel.display());
        listed.push(format!("\"./wheels/{name}\""));
        files.push((format!("wheels/{name}"), std::fs::read(wheel).with_context(|| wheel.display().to_string())?));
    }
    let manifest = files.iter_mut().find(|file| file.0 == MANIFEST).context(MANIFEST)?;
    let version = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
    let text = String::from_utf8(manifest.1.clone())?;
    ensure!(text.lines().any(|line| line == version), "{ADDON}/{MANIFEST} must have `{version}`");
    if !listed.is_empty() {
        manifest.1.extend(format!("\nwheels = [{}]\n", listed.join(", ")).into_bytes());
    }
    files.sort();
    Ok(files)
}

/// Returns a zip file without compression, whose bytes depend only on the files. The time of each
/// file is that at which zip files begin, 1 January 1980.
fn zip(files: &[(String, Vec<u8>)]) -> Result<Vec<u8>> {
    let start = UtcDateTime::from_components(1980, 1, 1, 0, 0, 0, 0).context("1980-01-01")?;
    let mut archive = ZipArchiveWriter::new(Vec::new());
    for (name, content) in files {
        let file = archive.new_file(name.as_str()).compression_method(CompressionMethod::STORE);
        let (mut entry, config) = file.last_modified(start).unix_permissions(0o644).start()?;
        let mut writer = config.wrap(&mut entry);
        writer.write_all(content)?;
        let (_, sums) = writer.finish()?;
        entry.finish(sums)?;
    }
    Ok(archive.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zip_file_is_read_by_python() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.zip");
        std::fs::write(&path, zip(&files(&crate::root().unwrap(), &[]).unwrap()).unwrap()).unwrap();
        let program =
            "import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); assert z.testzip() is None; print(z.namelist())";
        let Ok(output) = Command::new("python3").args(["-c", program]).arg(&path).output() else { return };
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(String::from_utf8_lossy(&output.stdout).contains("'__init__.py'"));
    }
}
