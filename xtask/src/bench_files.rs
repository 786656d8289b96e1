//! `cargo xtask bench-files`: compares the speed of reading mesh files with other crates, on the
//! same files.

use anyhow::{Context, Result, bail};
use durer::diag::{Diagnostics, Files};
use durer::format::{MESH_FORMATS, read_mesh};
use durer::math::Vec3;
use durer::scene::SceneDefaults;
use durer::shape::MeshData;
use durer::{LoadOptions, load_text};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Runs `cargo xtask bench-files`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let number = |name: &str, usual: u32| crate::value(arguments, name).map_or(Ok(usual), |text| text.parse());
    let (millions, runs) = (number("--triangles", 8)?, number("--runs", 3)?);
    let folder = crate::root()?.join("target/bench-files");
    std::fs::create_dir_all(&folder)?;
    let files = write_files(&folder, millions)?;
    let mut ours = Vec::new();
    for path in &files {
        let bytes: Arc<[u8]> = std::fs::read(path)?.into();
        let (mut least, mut triangles) = (Duration::MAX, 0);
        for _ in 0..runs {
            let start = Instant::now();
            triangles = read(path, &bytes)?;
            least = least.min(start.elapsed());
        }
        ours.push((bytes.len() as f64, least.as_secs_f64(), triangles));
    }
    let manifest = crate::root()?.join("bench/files/Cargo.toml");
    let mut command = Command::new(crate::cargo());
    command.args(["run", "--release", "--quiet", "--manifest-path"]).arg(manifest).arg("--").arg(runs.to_string());
    let output = command.args(&files).output()?;
    if !output.status.success() {
        bail!("{}", String::from_utf8_lossy(&output.stderr));
    }
    let theirs = String::from_utf8(output.stdout)?;
    println!("minimum of {runs} runs, files already in memory");
    println!("| file | MB | GB/s | seconds | other | seconds | times faster |");
    println!("| --- | ---: | ---: | ---: | --- | ---: | ---: |");
    for (path, (bytes, seconds, triangles)) in files.iter().zip(ours) {
        let row = theirs.lines().map(|line| line.split('\t').collect::<Vec<_>>());
        let other = row
            .filter(|row| Path::new(row[0]) == path)
            .find_map(|row| Some((row[1].to_string(), row[2].parse::<f64>().ok()?, row[3].parse::<usize>().ok()?)));
        let name = path.file_name().context("a name")?.to_string_lossy();
        let speed = bytes / seconds / 1e9;
        let own = format!("| {name} | {:.0} | {speed:.2} | {seconds:.3}", bytes / 1e6);
        match other {
            Some((who, theirs, count)) => {
                if count != triangles {
                    bail!("{who} reads {count} triangles from {name}, Dürer reads {triangles}");
                }
                println!("{own} | {who} | {theirs:.3} | {:.1} |", theirs / seconds);
            }
            None => println!("{own} | | | |"),
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Reads a file and counts its triangles.
fn read(path: &Path, bytes: &Arc<[u8]>) -> Result<usize> {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let name = path.to_string_lossy();
    if !name.ends_with(".glb") {
        let mesh = read_mesh(bytes, 0, &name, &mut diagnostics);
        return Ok(mesh.with_context(|| format!("{diagnostics:?}"))?.triangles.len());
    }
    let options = LoadOptions {
        scene_defaults: SceneDefaults { convert_only: true, ..SceneDefaults::default() },
        ..LoadOptions::default()
    };
    let loaded = load_text(path, bytes.clone(), &options, &mut files, &mut diagnostics);
    let loaded = loaded.with_context(|| format!("{diagnostics:?}"))?;
    Ok(loaded.scene.assets.meshes.values().map(|mesh| mesh.triangles.len()).sum())
}

/// Writes a hilly square in all formats and returns the paths. It has `millions` million triangles;
/// in text formats and STL only a tenth of that.
fn write_files(folder: &Path, millions: u32) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for (extension, share) in [("ply", 1.0), ("glb", 1.0), ("stl", 0.1), ("obj", 0.1)] {
        let side = (f64::from(millions) * share * 0.5e6).sqrt() as u32;
        let path = folder.join(format!("hills-{side}.{extension}"));
        if !path.exists() {
            let mesh = hills(side);
            let bytes = match MESH_FORMATS.iter().find(|format| format.extensions.contains(&extension)) {
                Some(format) => (format.write)(&mesh),
                None => as_gltf(&mesh)?,
            };
            std::fs::write(&path, bytes)?;
        }
        files.push(path);
    }
    Ok(files)
}

fn as_gltf(mesh: &MeshData) -> Result<Vec<u8>> {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let options = LoadOptions {
        scene_defaults: SceneDefaults { convert_only: true, ..SceneDefaults::default() },
        ..LoadOptions::default()
    };
    let bytes = (MESH_FORMATS[0].write)(mesh).into();
    let loaded = load_text(Path::new("a.ply"), bytes, &options, &mut files, &mut diagnostics);
    let written = loaded.context("it is read")?.write("a.glb", &mut diagnostics);
    Ok(written.context("glTF is written")?.bytes)
}

fn hills(side: u32) -> MeshData {
    let row = side + 1;
    let place = |i: u32| {
        let (x, y) = ((i % row) as f32 / side as f32, (i / row) as f32 / side as f32);
        Vec3::new(x, y, 0.05 * (x * (1.0 - x) - 7.0 * y * y * (1.0 - y)))
    };
    let square = |i: u32| {
        let first = i / side * row + i % side;
        [[first, first + 1, first + row + 1], [first, first + row + 1, first + row]]
    };
    MeshData {
        positions: (0..row * row).map(place).collect(),
        triangles: (0..side * side).flat_map(square).collect(),
        ..MeshData::default()
    }
}
