//! Reads and compiles scenes, and prints their diagnostics.

use crate::failure::Failure;
use crate::file_registry::FileRegistry;
use crate::options::SceneArgs;
use crate::report;
use durer::diag::{Diagnostics, Files};
use durer::dialect::Dialect;
use durer::world::World;
use durer::{LoadOptions, LoadedScene, load, load_text};
use std::io::Read;
use std::path::Path;

/// A scene that was read and compiled for a command line, with the files that it came from.
pub struct CompiledInput {
    pub loaded: LoadedScene,
    pub world: World,
    pub files: Files,
    /// Diagnostics of the reader and the compiler, which have already been printed.
    pub diagnostics: Diagnostics,
}

/// A scene that was read but has not been compiled yet. Its diagnostics are printed when it is
/// compiled.
pub struct ParsedInput {
    pub loaded: LoadedScene,
    files: Files,
    diagnostics: Diagnostics,
    quiet: bool,
}

/// True for the file name that stands for standard input or standard output.
pub fn is_stream(path: &Path) -> bool {
    path == Path::new("-")
}

/// Reads a scene file, or a scene from standard input if `path` is `-`. Files to which the latter
/// refers are in the current folder.
fn load_file(
    path: &Path,
    options: &LoadOptions,
    files: &mut Files,
    diagnostics: &mut Diagnostics,
) -> Result<Option<LoadedScene>, Failure> {
    if !is_stream(path) {
        return load(path, options, files, diagnostics).map_err(report::unreadable);
    }
    let limit = options.memory.unwrap_or(u64::MAX);
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().take(limit.saturating_add(1)).read_to_end(&mut bytes);
    read.map_err(|error| anyhow::anyhow!("cannot read standard input: {error}"))?;
    if bytes.len() as u64 > limit {
        return Err(anyhow::anyhow!("the scene on standard input does not fit into memory; see `--memory`").into());
    }
    Ok(load_text(Path::new("standard-input"), bytes.into(), options, files, diagnostics))
}

/// Reads a scene without compiling it.
pub fn read(
    path: &Path,
    options: &LoadOptions,
    quiet: bool,
    registry: &mut FileRegistry,
) -> Result<ParsedInput, Failure> {
    if !is_stream(path) {
        registry.register_input(path)?;
    }
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    match load_file(path, options, &mut files, &mut diagnostics)? {
        Some(loaded) => Ok(ParsedInput { loaded, files, diagnostics, quiet }),
        None => {
            report::print(&files, &diagnostics, quiet);
            Err(Failure::Input(None))
        }
    }
}

impl ParsedInput {
    /// Suppresses all diagnostics that are not errors.
    pub fn quiet(self) -> Self {
        ParsedInput { quiet: true, ..self }
    }

    /// Compiles the scene and prints the diagnostics.
    pub fn compile(mut self, options: &LoadOptions, registry: &mut FileRegistry) -> Result<CompiledInput, Failure> {
        let world = self.loaded.compile(options, &mut self.files, &mut self.diagnostics);
        report::print(&self.files, &self.diagnostics, self.quiet);
        let world = world.ok_or(Failure::Input(None))?;
        self.loaded.files().iter().try_for_each(|path| registry.register_input(path))?;
        Ok(CompiledInput { loaded: self.loaded, world, files: self.files, diagnostics: self.diagnostics })
    }
}

/// Reads and compiles a scene.
pub fn open(
    path: &Path,
    options: &LoadOptions,
    quiet: bool,
    registry: &mut FileRegistry,
) -> Result<CompiledInput, Failure> {
    read(path, options, quiet, registry)?.compile(options, registry)
}

/// Returns true if a scene can be read and compiled. Prints nothing.
pub fn readable(path: &Path, options: &LoadOptions) -> bool {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let loaded = load(path, options, &mut files, &mut diagnostics);
    matches!(loaded, Ok(Some(loaded)) if loaded.compile(options, &mut files, &mut diagnostics).is_some())
}

/// Converts command-line options to load options.
pub fn load_options(args: &SceneArgs) -> LoadOptions {
    LoadOptions {
        dialect: args.dialect.as_deref().and_then(Dialect::from_name),
        compat: args.compat.clone(),
        strict: args.strict,
        allow_outside: args.allow_outside,
        assets: args.assets.clone(),
        memory: args.memory.bytes(),
        placement: args.placement.placement(),
        scene_defaults: args.scene_defaults.scene_defaults(),
        ..LoadOptions::default()
    }
}
