//! Builds the page of `durer live`, also as static files over WebAssembly.

use crate::{cargo, root, value};
use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Builds the page into `web/dist`; with `--check`, compares the result with `web/dist` instead.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let web = root()?.join("web");
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

fn build(web: &Path, into: &Path) -> Result<()> {
    if !web.join("node_modules/vite").exists() {
        call(Command::new("npm").arg("ci").current_dir(web))?;
    }
    call(Command::new("npx").args(["tsc", "--noEmit"]).current_dir(web))?;
    call(Command::new("npx").args(["vite", "build", "--emptyOutDir", "--outDir"]).arg(into).current_dir(web))
}

/// Names and bytes of the files in a folder.
fn files(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let entry = entry?;
        all.insert(entry.file_name().to_string_lossy().into_owned(), fs::read(entry.path())?);
    }
    Ok(all)
}

/// Writes the page, the WebAssembly library, and the service worker that caches both for offline
/// use.
pub fn playground(arguments: &[String]) -> Result<ExitCode> {
    let root = root()?;
    let folder = PathBuf::from(value(arguments, "-o").context("missing -o FOLDER")?);
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from).join("playground");
    let flags = format!("{} -C target-feature=+simd128", std::env::var("RUSTFLAGS").unwrap_or_default());
    let manifest = root.join("crates/durer-wasm/Cargo.toml");
    let wasm = "wasm32-unknown-unknown";
    call(
        Command::new(cargo())
            .args(["build", "--release", "--target", wasm, "--manifest-path"])
            .arg(&manifest)
            .arg("--target-dir")
            .arg(&target)
            .env("RUSTFLAGS", flags.trim()),
    )?;
    fs::create_dir_all(folder.join("wasm"))?;
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
            .arg(folder.join("wasm"))
            .arg(target.join(wasm).join("release/durer_wasm.wasm")),
    )?;
    for (name, bytes) in files(&root.join("web/dist"))? {
        fs::write(folder.join(name), bytes)?;
    }
    fs::copy(root.join("web/playground/offline.js"), folder.join("offline.js"))?;
    let size = fs::metadata(folder.join("wasm/durer_wasm_bg.wasm"))?.len();
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
