//! Commands for the development of Dürer.

mod additions;
mod attack;
mod bench_files;
mod bench_pictures;
mod bench_rays;
mod bitterli;
mod blender;
mod build;
mod cost;
mod course;
mod explain;
mod fuzz;
mod hashes;
mod long;
mod manual;
mod many_lights;
mod page;
mod peers;
mod prose;
mod section;
mod sheet;
mod site;
mod soak;
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
      Render all rows of the course's reference pictures with `durer course`, and compare.
      --guess: do not name the program, so that the dialect is guessed. --only: rows that contain TEXT.
      --keep: save our pictures and the differences in FOLDER.
  cargo xtask verify [--trials 500] [--only TEXT]
      Run `durer verify` on all scenes of the repository, with various samplers.
  cargo xtask explain [--pixels 100000] [--only TEXT]
      Explain random pixels of all scenes of the repository and the course with all samplers. Checks that the terms sum
      to the pixel bit for bit, and measures the time.
  cargo xtask hashes [--program PATH] [--against FILE] [--only WORD] [-o FILE]
      Hashes of the pictures and messages of all scenes, the course and the sample files. --against: print only
      differences from the hashes in FILE.
  cargo xtask torture [--kills 100] [--offsets 50] [--seed 1]
      Kill the program at random times while it renders and saves, and resume; run it on full and read-only disks.
  cargo xtask attack [KIND] [--count N] [--seed N] [--only EXTENSION]
      Hostile inputs by kind, or of all kinds: names, templates, growth, signals, far, kills, mutated. Prints what was
      tried and what failed. --only: mutate only files with this extension. Mutated files that failed are in
      target/attack.
  cargo xtask cost
      Cost of exact sums, speedup of a second thread, latency of cancelling a render.
  cargo xtask soak [--minutes 2] [--seed N]
      Random scenes and files of all formats with all integrators, in one process and by the command: the same hash
      when a job repeats, no memory growth, no leaked handles.
  cargo xtask solids
      Compare a million random points in random solids with the Boolean of the parts, and measure the cost of rays at
      solids of a thousand parts against the same parts as plain objects.
  cargo xtask bench-rays [--quick] [--mesh NAME] [--threads N] ...
      Trace equal rays with Dürer, Embree 4, obvhs, bvh and parry3d; see --help.
  cargo xtask bench-rays --edges N [--threads N]
      Count how many of N rays each of them misses at the vertices and edges of a closed mesh.
  cargo xtask bench-pictures [--runs 3] [--threads 2] [--side 512] [--only TEXT]
      Compare time, memory and mean colour of Dürer and POV-Ray 3.7 (Debian's `povray`) on equal scenes, in turns.
  cargo xtask bench-files [--triangles 8] [--runs 3]
      Compare the speed of reading meshes with tobj, ply-rs-bw and gltf on equal files. --triangles: in millions; a tenth
      of it in text formats.
  cargo xtask additions [--only TEXT]
      Add a new primitive, camera, light, material, lobe, integrator, scene format, mesh format, picture format and AOV to
      a copy of the sources, build and use them, and count the places that each must be listed in.
  cargo xtask long [--only TEXT] [--times N]
      Run tests of the suite with many more iterations: rays against a double-precision reference, rays at edges, rays
      that leave surfaces, equal bits at all SIMD levels.
  cargo xtask fuzz [--minutes 10] [--only TEXT] [--jobs N]
      Fuzz the readers of scenes, meshes, pictures and parts, and compare random scenes by tree, grid and brute force.
      --minutes: for each target. --jobs: targets at a time. Needs a nightly compiler and cargo-fuzz.
  cargo xtask teach [--compare | --check] [--only TEXT] [--keep FOLDER]
      Count the mistakes that `durer compare` identifies in wrong pictures by an independent tracer and an independent
      path tracer (--only paths), and the causes that `durer check` identifies in broken scenes.
  cargo xtask peers [--python PROGRAM] [--only TEXT] [--keep FOLDER]
      Render about 260 scenes with Dürer and Mitsuba 3, compare means and blocks of pixels, and write the table in
      docs/validation.md. Without --python, installs Mitsuba from the package index into target/peers. --keep: save scenes
      and pictures in FOLDER.
  cargo xtask peers --time [--python PROGRAM] [--side 256] [--samples 64] [--runs 5] [--threads 2] [--only TEXT]
      CPU time to equal noise, Dürer and Mitsuba (llvm_ad_rgb), in turns.
  cargo xtask peers --direct [--python PROGRAM] [--side 512] [--samples 16] [--runs 3] [--threads 2] [--only TEXT]
      Cost of direct light from point lights: Dürer, Mitsuba 3's `direct`, and Blender's Cycles if the package index has it.
  cargo xtask peers --daylight [--python PROGRAM] [--fast]
      Compare the daylight of a year in a room with Radiance's tools, and write the table in docs/daylight.md. Without
      --python, installs pyradiance from the package index into target/peers. --fast: fewer samples, and no table.
  cargo xtask blender [--wheel FILE ...]
      Pack the add-on for Blender as target/durer_blender-VERSION.zip. --wheel: a wheel of the package `durer` to include,
      one for each platform.
  cargo xtask blender --test [--python PROGRAM] [--only TEXT] [--samples 256] [--keep FOLDER]
      Install the packed add-on in Blender (`bpy` from the package index), render ten scenes beside Cycles, and write the
      table in docs/blender.md. --python: an interpreter that has bpy and durer. --keep: save the pictures in FOLDER.
  cargo xtask validate [--samples N]
      Compare light with known answers, test white furnaces, and test sampled directions against their pdf. Writes
      docs/validation.md.
  cargo xtask many-lights
      Cost of a hundred thousand lights relative to ten, at equal error.
  cargo xtask bitterli [--samples 256] [--only TEXT] [--keep FOLDER]
      Compare Bitterli's scenes, read from pbrt files, with their pictures by Tungsten, and write the table in
      docs/models.md. --keep: save both pictures in FOLDER.
  cargo xtask sheet [--samples 32] [--front] [--only TEXT] [--keep FOLDER]
      Contact sheets of the sample models, rendered with default options (or --front), beside their reference pictures.
  cargo xtask page [--check | --measure]
      Build the page of `durer live` and the reports from web/ (Node and npm) into web/dist and web/dist-report, which are
      committed. --check: fail if they are stale. --measure: frames per second, random edits, memory, hostile clients
      (needs Chromium).
  cargo xtask playground -o FOLDER
      Build the page of `durer live` as static files, over WebAssembly. Needs the target wasm32-unknown-unknown, and
      wasm-bindgen in the version of crates/durer-wasm/Cargo.toml.
  cargo xtask site -o FOLDER
      Build the playground, the book (needs mdBook) and the documentation of the library as one web site, in which each
      scene of the language reference and of the gallery opens in the playground.
  cargo xtask manual [--pages]
      Write the language reference in docs/language with its pictures, and the grammar for editors.
  cargo xtask prose [--count] [PATH ...]
      Find words and patterns of xtask/prose.txt in comments, messages and documents, and comments over 100 columns.
      --count: print only the counts. PATH: only files whose path contains it.
The course is in ../shared, or in the folder that DURER_CORPUS names.";

fn main() -> anyhow::Result<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let help = arguments.iter().any(|argument| argument == "--help");
    match arguments.first().map(String::as_str) {
        // This command has its own help.
        Some("bench-rays") => bench_rays::run(&arguments[1..]),
        Some(_) if help => {
            println!("{USAGE}");
            Ok(ExitCode::SUCCESS)
        }
        Some("additions") => additions::run(&arguments[1..]),
        Some("attack") => attack::run(&arguments[1..]),
        Some("bench-files") => bench_files::run(&arguments[1..]),
        Some("bench-pictures") => bench_pictures::run(&arguments[1..]),
        Some("course") => course::run(&arguments[1..]),
        Some("verify") => verify::run(&arguments[1..]),
        Some("explain") => explain::run(&arguments[1..]),
        Some("hashes") => hashes::run(&arguments[1..]),
        Some("torture") => torture::run(&arguments[1..]),
        Some("blender") => blender::run(&arguments[1..]),
        Some("bitterli") => bitterli::run(&arguments[1..]),
        Some("sheet") => sheet::run(&arguments[1..]),
        Some("cost") => cost::run(&arguments[1..]),
        Some("soak") => soak::run(&arguments[1..]),
        Some("solids") => solids::run(),
        Some("teach") => teach::run(&arguments[1..]),
        Some("long") => long::run(&arguments[1..]),
        Some("fuzz") => fuzz::run(&arguments[1..]),
        Some("validate") => validate::run(&arguments[1..]),
        Some("many-lights") => many_lights::run(),
        Some("peers") => peers::run(&arguments[1..]),
        Some("manual") => manual::run(&arguments[1..]),
        Some("page") => page::run(&arguments[1..]),
        Some("playground") => page::playground(&arguments[1..]),
        Some("site") => site::run(&arguments[1..]),
        Some("prose") => prose::run(&arguments[1..]),
        _ => {
            println!("{USAGE}");
            Ok(ExitCode::from(2))
        }
    }
}

/// Compiles a scene in Dürer's own dialect.
fn world(name: &str, text: &str) -> anyhow::Result<World> {
    let options = LoadOptions::default();
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let loaded = load_text(Path::new(name), text.as_bytes().into(), &options, &mut files, &mut diagnostics);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    world.with_context(|| format!("{name}: {diagnostics:?}"))
}

/// Returns the value of an option on the command line.
fn value<'a>(arguments: &'a [String], name: &str) -> Option<&'a String> {
    arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1))
}

/// Returns the folder with data outside the repository.
fn corpus() -> PathBuf {
    std::env::var_os("DURER_CORPUS").map_or_else(|| PathBuf::from("../shared"), PathBuf::from)
}

/// Returns the path of the `cargo` that runs this program.
fn cargo() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Returns the root of the repository: `DURER_ROOT`, or the folder from which this program was
/// built.
fn root() -> anyhow::Result<PathBuf> {
    let built = || Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    std::env::var_os("DURER_ROOT")
        .map_or_else(built, PathBuf::from)
        .canonicalize()
        .context("the repository was not found")
}
