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
    let bytes = read_standard_input(options.memory.unwrap_or(u64::MAX))?;
    Ok(load_text(Path::new(name_of(&bytes)), bytes.into(), options, files, diagnostics))
}

/// Reads standard input to its end, up to `limit` bytes.
pub fn read_standard_input(limit: u64) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().take(limit.saturating_add(1)).read_to_end(&mut bytes);
    read.map_err(|error| anyhow::anyhow!("cannot read standard input: {error}"))?;
    if bytes.len() as u64 > limit {
        return Err(anyhow::anyhow!("the scene on standard input does not fit into memory; see `--memory`").into());
    }
    Ok(bytes)
}

/// Returns the name for a scene on standard input. OBJ files are recognised only by their
/// extension, so a text whose first words are those of an OBJ file gets it.
pub fn name_of(bytes: &[u8]) -> &'static str {
    const WORDS: [&[u8]; 9] = [b"v", b"vn", b"vt", b"o", b"g", b"s", b"f", b"mtllib", b"usemtl"];
    let words = |line: &'_ [u8]| line.split(u8::is_ascii_whitespace).find(|word| !word.is_empty()).map(<[u8]>::to_vec);
    let mut first = bytes.split(|byte| *byte == b'\n').filter_map(words).filter(|word| !word.starts_with(b"#"));
    match first.next() {
        Some(word) if WORDS.contains(&&*word) => "standard-input.obj",
        _ => "standard-input",
    }
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
    pub fn compile(self, options: &LoadOptions, registry: &mut FileRegistry) -> Result<CompiledInput, Failure> {
        self.compile_without(&[], options, registry)
    }

    /// Compiles the scene and prints the diagnostics, except those with the given codes.
    pub fn compile_without(
        mut self,
        codes: &[&str],
        options: &LoadOptions,
        registry: &mut FileRegistry,
    ) -> Result<CompiledInput, Failure> {
        let world = self.loaded.compile(options, &mut self.files, &mut self.diagnostics);
        self.diagnostics.retain(|diagnostic| !codes.contains(&diagnostic.code));
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

#[cfg(test)]
mod tests {
    use super::name_of;

    #[test]
    fn obj_on_standard_input_is_recognised() {
        for text in ["v 0 0 0\n", "# made by hand\r\n\r\no ball\r\nv 0 0 0", "mtllib a.mtl\n"] {
            assert_eq!(name_of(text.as_bytes()), "standard-input.obj", "{text}");
        }
        for text in ["", "# v\n", "Group { Sphere { radius 1 } }", "void plastic", "ply\n", "{\"a\": 1}"] {
            assert_eq!(name_of(text.as_bytes()), "standard-input", "{text}");
        }
    }
}
