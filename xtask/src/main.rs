//! Commands for developers of Dürer.

mod additions;
mod bench_files;
mod bench_pictures;
mod bench_rays;
mod bitterli;
mod build;
mod cost;
mod course;
mod explain;
mod fuzz;
mod hashes;
mod lamps;
mod long;
mod manual;
mod page;
mod peers;
mod prose;
mod sheet;
mod solids;
mod teach;
mod torture;
mod validate;
mod verify;

use anyhow::Context;
use durer::diag::{Diagnostics, Files};
use durer::world::World;
use durer::{LoadOptions, load_text};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const USAGE: &str = "Commands:
  cargo xtask course [--guess] [--only TEXT] [--keep FOLDER]
      Render every row of the course's reference pictures through `durer course`, and compare.
      --guess: do not name the program, so that the dialect is guessed. --only: rows that contain TEXT.
      --keep: leave our pictures there, with pictures of the differences.
  cargo xtask verify [--trials 500] [--only TEXT]
      `durer verify` for every scene of the repository, with various samplings.
  cargo xtask explain [--pixels 100000] [--only TEXT]
      Explain random pixels of every scene of the repository and of the course, in every way of sampling: do the terms
      sum to the pixel, to the bit? And how long does an explanation take?
  cargo xtask hashes [--program PATH] [--against FILE] [--only WORD] [-o FILE]
      Hashes of the pictures and messages of all scenes, the course and the sample files. --against: print only what
      differs from the hashes in FILE.
  cargo xtask torture [--kills 100] [--offsets 50] [--seed 1]
      Kill the program at random times while it works and saves, and go on with what it left; give it full disks and
      disks that cannot be written.
  cargo xtask cost
      What exact sums cost, what a second thread brings, how soon a cancelled render ends.
  cargo xtask solids
      A million random points against the Boolean of the parts of random solids, and the cost of rays at solids of a
      thousand parts beside that at the same parts as plain objects.
  cargo xtask bench-rays [--quick] [--mesh NAME] [--threads N] ...
      The very same rays through Dürer, Embree 4, obvhs, bvh and parry3d; --help says more.
  cargo xtask bench-rays --edges N [--threads N]
      How many of N rays each of them loses at the vertices and edges of a closed mesh.
  cargo xtask bench-pictures [--runs 3] [--threads 2] [--side 512] [--only TEXT]
      The same scenes by us and by POV-Ray 3.7 (Debian's `povray`), in turns: time, memory, and whether both show the same.
  cargo xtask bench-files [--triangles 8] [--runs 3]
      How fast meshes are read beside tobj, ply-rs-bw and gltf, on the same files: so many million triangles, in text a tenth.
  cargo xtask additions [--only TEXT]
      Add a new primitive, camera, light, material, lobe, integrator, format of scenes, meshes and pictures, and a kind of picture
      to a copy of the sources, build it, and use them: how many lists does each stand in?
  cargo xtask long [--only TEXT] [--times N]
      Tests of the suite with many more numbers: rays against a reference in double precision, rays at edges, rays that
      leave surfaces, bits of all SIMD levels.
  cargo xtask fuzz [--minutes 10] [--only TEXT] [--jobs N]
      Random bytes as scenes, meshes, pictures and parts, and random scenes by tree, grid and brute force, side by side,
      or N targets at a time, each for so many minutes. It takes a nightly compiler and cargo-fuzz.
  cargo xtask teach [--compare | --check] [--only TEXT] [--keep FOLDER]
      Wrong pictures made by a tracer of its own, for `durer compare`, and broken scenes, for `durer check`: how many are told
      rightly, and how many wrongly?
  cargo xtask peers [--python PROGRAM] [--samples 1024] [--only TEXT]
      Equal scenes by us and by Mitsuba 3, compared pixel by pixel. Without --python, Mitsuba comes from the package index
      into target/peers.
  cargo xtask peers --time [--python PROGRAM] [--side 256] [--samples 64] [--runs 5] [--threads 2] [--only TEXT]
      Time of the processor until the noise is equal, ours and Mitsuba's (llvm_ad_rgb), in turns.
  cargo xtask peers --direct [--python PROGRAM] [--side 512] [--samples 16] [--runs 3] [--threads 2] [--only TEXT]
      What direct light of point lamps costs us, Mitsuba 3's `direct`, and Blender's Cycles where the package index has it.
  cargo xtask validate [--samples N]
      Light against answers in closed form, white furnaces, directions against their densities, and docs/validation.md.
  cargo xtask lamps
      What a hundred thousand lamps cost beside ten, at equal error.
  cargo xtask bitterli [--samples 256] [--only TEXT] [--keep FOLDER]
      Bitterli's scenes from pbrt's files beside Tungsten's pictures of them, and the table in docs/models.md. --keep: leave both
      pictures there.
  cargo xtask sheet [--samples 32] [--front] [--only TEXT] [--keep FOLDER]
      The sample models, rendered without any option, or from the front, beside the pictures that came with them, as sheets.
  cargo xtask page [--check | --measure]
      Build the page of `durer live` from web/ (Node and npm), which is committed in web/dist. --check: is it what the
      sources build? --measure: pictures a second, random edits, memory, hostile clients (Chromium).
  cargo xtask playground -o FOLDER
      The same page as static files, over WebAssembly. It takes the target wasm32-unknown-unknown and the command
      wasm-bindgen, of the version in crates/durer-wasm/Cargo.toml.
  cargo xtask manual
      Write the reference of the language, docs/language and its pictures, and the grammar for editors.
  cargo xtask prose [--count] [PATH ...]
      Words and patterns of xtask/prose.txt in comments, messages and documents, and comments beyond 100 columns. --count: only
      how often. PATH: only files whose name contains it.
The course is found in ../shared, or where DURER_CORPUS says.";

fn main() -> anyhow::Result<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let help = arguments.iter().any(|argument| argument == "--help");
    match arguments.first().map(String::as_str) {
        // It has its own help.
        Some("bench-rays") => bench_rays::run(&arguments[1..]),
        Some(_) if help => {
            println!("{USAGE}");
            Ok(ExitCode::SUCCESS)
        }
        Some("additions") => additions::run(&arguments[1..]),
        Some("bench-files") => bench_files::run(&arguments[1..]),
        Some("bench-pictures") => bench_pictures::run(&arguments[1..]),
        Some("course") => course::run(&arguments[1..]),
        Some("verify") => verify::run(&arguments[1..]),
        Some("explain") => explain::run(&arguments[1..]),
        Some("hashes") => hashes::run(&arguments[1..]),
        Some("torture") => torture::run(&arguments[1..]),
        Some("bitterli") => bitterli::run(&arguments[1..]),
        Some("sheet") => sheet::run(&arguments[1..]),
        Some("cost") => cost::run(&arguments[1..]),
        Some("solids") => solids::run(),
        Some("teach") => teach::run(&arguments[1..]),
        Some("long") => long::run(&arguments[1..]),
        Some("fuzz") => fuzz::run(&arguments[1..]),
        Some("validate") => validate::run(&arguments[1..]),
        Some("lamps") => lamps::run(),
        Some("peers") => peers::run(&arguments[1..]),
        Some("manual") => manual::run(),
        Some("page") => page::run(&arguments[1..]),
        Some("playground") => page::playground(&arguments[1..]),
        Some("prose") => prose::run(&arguments[1..]),
        _ => {
            println!("{USAGE}");
            Ok(ExitCode::from(2))
        }
    }
}

/// Compiles a scene in our language.
fn world(name: &str, text: &str) -> anyhow::Result<World> {
    let options = LoadOptions::default();
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let loaded = load_text(Path::new(name), text.as_bytes().into(), &options, &mut files, &mut diagnostics);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    world.with_context(|| format!("{name}: {diagnostics:?}"))
}

/// Returns the value of an option.
fn value<'a>(arguments: &'a [String], name: &str) -> Option<&'a String> {
    arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1))
}

/// Returns the folder of data outside the repository.
fn corpus() -> PathBuf {
    std::env::var_os("DURER_CORPUS").map_or_else(|| PathBuf::from("../shared"), PathBuf::from)
}

/// Returns the `cargo` that runs this program.
fn cargo() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Returns the repository: `DURER_ROOT`, or the source folder of this build.
fn root() -> anyhow::Result<PathBuf> {
    let built = || Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    std::env::var_os("DURER_ROOT")
        .map_or_else(built, PathBuf::from)
        .canonicalize()
        .context("the repository is not there")
}
