//! Builds the web page of `durer live`, also as static files over WebAssembly, and the reports.

use crate::{cargo, root, value};
use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// The bundles: the folder in `web` that contains each, and the configuration that builds it.
const BUNDLES: [(&str, &str); 2] = [("dist", "vite.config.ts"), ("dist-report", "vite.report.config.ts")];

/// Builds the page into `web/dist` and the reports into `web/dist-report`. With `--check`, only
/// checks that they are up to date.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let web = root()?.join("web");
    if arguments.iter().any(|argument| argument == "--measure") {
        return measure(&web);
    }
    install(&web)?;
    call(Command::new("npx").args(["tsc", "--noEmit"]).current_dir(&web))?;
    let check = arguments.iter().any(|argument| argument == "--check");
    let mut code = ExitCode::SUCCESS;
    for (folder, config) in BUNDLES {
        if !check {
            build(&web, config, &web.join(folder))?;
        } else if !is_fresh(&web, folder, config)? {
            code = ExitCode::FAILURE;
        }
    }
    Ok(code)
}

/// Returns true if a bundle is what the sources build. Otherwise, prints the stale files.
fn is_fresh(web: &Path, folder: &str, config: &str) -> Result<bool> {
    let fresh = web.join("node_modules/.durer-check").join(folder);
    build(web, config, &fresh)?;
    let (there, wanted) = (files(&web.join(folder))?, files(&fresh)?);
    let stale: Vec<&String> = wanted
        .keys()
        .chain(there.keys().filter(|name| !wanted.contains_key(*name)))
        .filter(|name| there.get(*name) != wanted.get(*name))
        .collect();
    if stale.is_empty() {
        println!("web/{folder} matches the sources: {} files", wanted.len());
        return Ok(true);
    }
    stale.iter().for_each(|name| println!("web/{folder}/{name} is stale"));
    println!("run `cargo xtask page`");
    Ok(false)
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
        let arguments = ["test", "--release", "-p", package, "--test", file, "--", "--nocapture"];
        command.args(arguments).env("DURER_EDITS", "3334");
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

fn build(web: &Path, config: &str, into: &Path) -> Result<()> {
    let arguments = ["vite", "build", "--config", config, "--emptyOutDir", "--outDir"];
    call(Command::new("npx").args(arguments).arg(into).current_dir(web))
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

/// Runs a program and waits for it.
pub fn call(command: &mut Command) -> Result<()> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.status().with_context(|| format!("cannot start `{name}`"))?;
    if !status.success() {
        bail!("`{name}` failed");
    }
    Ok(())
}
