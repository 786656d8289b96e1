//! Builds the web page of `durer live`, also as static files over WebAssembly.

use crate::{cargo, root, value};
use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// Builds the page into `web/dist`. With `--check`, only checks that `web/dist` is up to date.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let web = root()?.join("web");
    if arguments.iter().any(|argument| argument == "--measure") {
        return measure(&web);
    }
    if !arguments.iter().any(|argument| argument == "--check") {
        build(&web, &web.join("dist"))?;
        return Ok(ExitCode::SUCCESS);
    }
    let fresh = web.join("node_modules/.durer-check");
    build(&web, &fresh)?;
    let (there, wanted) = (files(&web.join("dist"))?, files(&fresh)?);
    let stale: Vec<&String> = wanted
        .keys()
        .chain(there.keys().filter(|name| !wanted.contains_key(*name)))
        .filter(|name| there.get(*name) != wanted.get(*name))
        .collect();
    if stale.is_empty() {
        println!("web/dist matches the sources: {} files", wanted.len());
        return Ok(ExitCode::SUCCESS);
    }
    stale.iter().for_each(|name| println!("web/dist/{name} is stale"));
    println!("run `cargo xtask page`");
    Ok(ExitCode::FAILURE)
}

/// Tests the page in Chromium with a small and a large scene. Measures frames per second and the
/// time to the first picture, then tests 10,000 random edits, memory over 1,000 edits, and hostile
/// clients.
fn measure(web: &Path) -> Result<ExitCode> {
    let root = root()?;
    let durer = crate::build::build_durer()?;
    install(web)?;
    for scene in [root.join("scenes/whitted.txt"), crate::corpus().join("meshes/dragon.ply")] {
        if !scene.exists() {
            println!("skipped: there is no {}", scene.display());
            continue;
        }
        let mut live = Command::new(&durer).arg("live").arg(&scene).stdout(Stdio::piped()).spawn()?;
        let mut address = String::new();
        let mut output = BufReader::new(live.stdout.take().context("the server prints nothing")?);
        output.read_line(&mut address)?;
        println!("{}", scene.display());
        let measured = call(Command::new("node").args(["tests/measure.mjs", address.trim()]).current_dir(web));
        live.kill()?;
        live.wait()?;
        measured?;
    }
    let test = |package: &str, file: &str| {
        let mut command = Command::new(cargo());
        command.args(["test", "--release", "-p", package, "--test", file]).env("DURER_EDITS", "3334");
        call(&mut command)
    };
    test("durer-session", "edits")?;
    test("durer-session", "memory")?;
    test("durer-live", "clients")?;
    Ok(ExitCode::SUCCESS)
}

fn install(web: &Path) -> Result<()> {
    if web.join("node_modules/vite").exists() {
        return Ok(());
    }
    // `npm ci` does not work: the lock file lists an optional Windows package that some registries
    // lack.
    call(Command::new("npm").args(["install", "--no-audit", "--no-fund"]).current_dir(web))
}

fn build(web: &Path, into: &Path) -> Result<()> {
    install(web)?;
    call(Command::new("npx").args(["tsc", "--noEmit"]).current_dir(web))?;
    call(Command::new("npx").args(["vite", "build", "--emptyOutDir", "--outDir"]).arg(into).current_dir(web))
}

/// Returns the names and contents of the files in a folder.
fn files(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let entry = entry?;
        all.insert(entry.file_name().to_string_lossy().into_owned(), fs::read(entry.path())?);
    }
    Ok(all)
}

/// SIMD levels of the WebAssembly library, with their target features. The worker loads the first
/// level that the browser supports.
const LEVELS: [(&str, &str); 2] = [("simd128", "+simd128"), ("scalar", "-simd128")];

/// Builds the WebAssembly library for a SIMD level.
fn module(root: &Path, level: &str, feature: &str, folder: &Path) -> Result<()> {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let target = target.join("playground").join(level);
    let flags = format!("{} -C target-feature={feature}", std::env::var("RUSTFLAGS").unwrap_or_default());
    let wasm = "wasm32-unknown-unknown";
    call(
        Command::new(cargo())
            .args(["build", "--release", "--target", wasm, "--manifest-path"])
            .arg(root.join("crates/durer-wasm/Cargo.toml"))
            .arg("--target-dir")
            .arg(&target)
            .env("RUSTFLAGS", flags.trim()),
    )?;
    fs::create_dir_all(folder)?;
    let bindgen = std::env::var_os("WASM_BINDGEN").unwrap_or_else(|| "wasm-bindgen".into());
    call(
        Command::new(bindgen)
            .args([
                "--target",
                "web",
                "--no-typescript",
                "--remove-name-section",
                "--remove-producers-section",
                "--out-dir",
            ])
            .arg(folder)
            .arg(target.join(wasm).join("release/durer_wasm.wasm")),
    )
}

/// Writes the page, the WebAssembly library, and the script that caches them for offline use.
pub fn playground(arguments: &[String]) -> Result<ExitCode> {
    let root = root()?;
    let folder = PathBuf::from(value(arguments, "-o").context("the output folder is missing: pass -o FOLDER")?);
    for (level, feature) in LEVELS {
        module(&root, level, feature, &folder.join("wasm").join(level))?;
    }
    for (name, bytes) in files(&root.join("web/dist"))? {
        fs::write(folder.join(name), bytes)?;
    }
    fs::copy(root.join("web/playground/offline.js"), folder.join("offline.js"))?;
    let size = fs::metadata(folder.join("wasm").join(LEVELS[0].0).join("durer_wasm_bg.wasm"))?.len();
    println!("{}: any web server can serve it; the library takes {} KiB", folder.display(), size / 1024);
    Ok(ExitCode::SUCCESS)
}

fn call(command: &mut Command) -> Result<()> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.status().with_context(|| format!("cannot start `{name}`"))?;
    if !status.success() {
        bail!("`{name}` failed");
    }
    Ok(())
}
