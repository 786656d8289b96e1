//! Loading of scenes from files. The loader detects the format and the dialect, applies the rules
//! of the dialect, and finds assets.

mod model_options;

use crate::camera_placement::{CameraPlacement, orbit};
use crate::job::JobContext;
use durer_diag::{Diagnostic, Diagnostics, Files};
use durer_formats::Decoder;
use durer_formats::asset_export::{AssetFile, export_assets};
use durer_formats::course::{self, Guess, Hint, ReadOptions};
use durer_formats::folder::FolderSource;
use durer_formats::gzip::{decompress, is_gzip};
use durer_formats::json;
use durer_formats::scene::{
    ReadInput, WriteContext, Written, find_scene_format, other_format, read_model, scene_writer_for,
};
use durer_render::compile::{AccelKind, AssetCache, Resources, compile};
use durer_render::threads;
use durer_render::world::World;
use durer_scene::dialect::{Dialect, DialectRules, PathBase, Quirk};
use durer_scene::scene::{Scene, SceneDefaults};
use durer_scene::source::{AssetSource, SourceError};
use model_options::{refuse_for_model, refuse_for_scene};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Options for loading and compiling a scene file, such as the dialect, quirks, assets and limits.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Dialect to use, including the bugs of its program. `None` means that the dialect is detected
    /// and its bugs are not emulated.
    pub dialect: Option<Dialect>,
    /// True to behave like the command line of the course. The bugs of a detected dialect are then
    /// emulated, and files are also looked for in the current directory and the folders below it.
    pub course: bool,
    /// Additional hints that help to detect the dialect.
    pub hints: Vec<Hint>,
    /// Quirks with a flag that turns them on or off.
    pub compat: Vec<(Quirk, bool)>,
    /// True to reject words of other dialects.
    pub strict: bool,
    /// True to allow files outside the folder of the scene.
    pub allow_outside: bool,
    /// Folders in which missing files are searched for.
    pub assets: Vec<PathBuf>,
    /// Contents of files in memory, by the names that the scene uses.
    pub in_memory: Vec<(String, Arc<[u8]>)>,
    /// Camera, light and ground for models that have none.
    pub scene_defaults: SceneDefaults,
    /// Placement of the camera, in place of that of the scene.
    pub placement: CameraPlacement,
    /// Acceleration structure for the objects.
    pub accel: AccelKind,
    /// Number of threads that build the world, or `None` for one thread per processor.
    pub threads: Option<usize>,
    /// Memory limit for the world in bytes, or `None` for no limit.
    pub memory: Option<u64>,
    /// Expected number of camera rays, or `None` for many rays. If there are few rays, the BVH is
    /// built faster.
    pub rays: Option<u64>,
    /// Cache with the meshes and pictures of the previous version of the scene. Items that have not
    /// changed are not read or built again.
    pub cache: Option<Arc<AssetCache>>,
}

/// A scene that has been read from a file but not compiled yet, with its dialect and the source of
/// its files.
#[derive(Debug)]
pub struct LoadedScene {
    /// Description of the scene.
    pub scene: Scene,
    /// Rules of the dialect.
    pub rules: DialectRules,
    /// Dialect of the file.
    pub dialect: Dialect,
    /// The detected dialect with the reasons for it, or `None` if the dialect was requested.
    pub guess: Option<Guess>,
    /// Source of the files of the scene.
    source: FolderSource,
    /// Memory limit for decoding a picture, in bytes.
    memory: u64,
}

/// Reads a scene file. Adds diagnostics to `diagnostics` and the text of the file to `files`.
///
/// # Errors
///
/// Returns an error if the file itself cannot be read. The result `Ok(None)` means that the file
/// was read but contains errors.
pub fn load(
    path: &Path,
    options: &LoadOptions,
    files: &mut Files,
    diagnostics: &mut Diagnostics,
) -> Result<Option<LoadedScene>, SourceError> {
    let name = path.display().to_string();
    let source = FolderSource::new(folder_of(path)).allow_outside().budget(budget(options));
    let bytes = source.read_path(path, &name)?;
    Ok(load_text(path, bytes, options, files, diagnostics))
}

/// Returns the folder that contains a file.
fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// Reads a scene from text as if it were in the file at `path`. Returns `None` if there are errors.
pub fn load_text(
    path: &Path,
    bytes: Arc<[u8]>,
    options: &LoadOptions,
    files: &mut Files,
    diagnostics: &mut Diagnostics,
) -> Option<LoadedScene> {
    let mut source = FolderSource::new(folder_of(path));
    if options.allow_outside {
        source = source.allow_outside();
    }
    for assets in &options.assets {
        source = source.assets(assets);
    }
    for (name, bytes) in &options.in_memory {
        source = source.add_in_memory(name, bytes.clone());
    }
    // Record the scene file without a name, because the digest must not depend on the path of the
    // file.
    source.record().add("", &bytes);
    let mut name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut bytes = bytes;
    if is_gzip(&bytes) {
        let refuse = |problem| diagnostics.push(Diagnostic::error(problem).code("bad-file"));
        bytes = decompress(&bytes, budget(options)).map_err(refuse).ok()?;
        name.truncate(name.strip_suffix(".gz").map_or(name.len(), str::len));
    }
    let memory = options.memory.unwrap_or(u64::MAX);
    let file = files.add(path.display().to_string(), bytes.clone());
    let json = json::recognise(&bytes, &name).then(|| json::Document::open(&bytes, file, diagnostics));
    let is_model = json.is_none() && options.dialect.is_none() && !options.course;
    let format = find_scene_format(&bytes, &name).filter(|_| is_model);
    if let Some(error) = other_format(&bytes, file, &name, format) {
        diagnostics.push(error);
        return None;
    }
    if let Some(format) = format {
        refuse_for_model(format.name, &options.scene_defaults, diagnostics);
        if diagnostics.has_errors() {
            return None;
        }
        let dialect = Dialect::Durer;
        let source = source.budget(budget(options));
        let known = RefCell::new(std::mem::take(files));
        let scene_defaults = &options.scene_defaults;
        let input =
            ReadInput { bytes: &bytes, file, files: &known, name: &name, source: &source, scene_defaults, memory };
        let scene = read_model(format, &input, diagnostics);
        *files = known.into_inner();
        let scene = scene?;
        return Some(LoadedScene { scene, rules: dialect.rules().clone(), dialect, guess: None, source, memory });
    }
    refuse_for_scene(&options.scene_defaults, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let mut guess = None;
    let dialect = options.dialect.unwrap_or_else(|| {
        let detected = match &json {
            // A JSON scene names its dialect, so no dialect needs to be detected.
            Some(json) => Guess::certain(json.dialect()),
            None => course::guess(&bytes, file, &options.hints, &|name| source.contains(name)),
        };
        guess.insert(detected).dialect
    });
    let mut rules = dialect.rules().clone();
    if options.dialect.is_none() && !options.course {
        rules = rules.without_quirks();
    }
    // No version of the program has both quirks.
    if options.compat.contains(&(Quirk::ExitR0, true)) {
        rules.quirks &= !Quirk::ShadowFronts.bit();
    }
    for (compat, on) in &options.compat {
        rules.quirks = if *on { rules.quirks | compat.bit() } else { rules.quirks & !compat.bit() };
    }
    source = match rules.paths {
        PathBase::SceneFile => source,
        PathBase::Current => source.search_in(".", true),
        PathBase::Assets(assets) => source.search_in(assets, true),
    };
    if options.course {
        source = source.allow(".");
    }
    source = source.budget(budget(options));
    let read = ReadOptions { dialect, strict: options.strict, compat: rules.quirks };
    if let Some(json) = json {
        return json.scene(diagnostics).map(|scene| LoadedScene { scene, rules, dialect, guess, source, memory });
    }
    let known = RefCell::new(std::mem::take(files));
    let scene = course::read_with(&bytes, file, read, &course::open_below(&source, &known), diagnostics);
    *files = known.into_inner();
    if let (Some(_), Some(dialect), false, false) = (&scene, options.dialect, options.strict, options.course) {
        diagnostics.extend(portability(&bytes, file, dialect, diagnostics));
    }
    if let (None, Some(guess)) = (&scene, &guess) {
        // A construct that is an error in this dialect may be valid in another dialect.
        diagnostics.push(guess.note());
    }
    scene.map(|scene| LoadedScene { scene, rules, dialect, guess, source, memory })
}

/// Returns the maximum number of bytes that are read from all files.
fn budget(options: &LoadOptions) -> u64 {
    FolderSource::DEFAULT_BUDGET.min(options.memory.unwrap_or(u64::MAX))
}

/// Returns a note about the first construct that the official program of the dialect would reject,
/// unless the construct has already been reported.
fn portability(bytes: &[u8], file: u32, dialect: Dialect, messages: &Diagnostics) -> Diagnostics {
    let (mut strict, mut notes) = (Diagnostics::default(), Diagnostics::default());
    if dialect != Dialect::Durer {
        course::read(bytes, file, ReadOptions { dialect, strict: true, compat: dialect.rules().quirks }, &mut strict);
    }
    let first = strict.errors().next();
    if let Some(first) = first.filter(|first| !messages.iter().any(|known| known.span == first.span)) {
        let message = format!("the program of {} would refuse this file: {}", dialect.name(), first.message);
        let note = Diagnostic::note(message)
            .code("portability")
            .help("Dürer reads the file anyway, unless `--strict` is given");
        notes.push(Diagnostic { span: first.span, ..note });
    }
    notes
}

impl LoadedScene {
    /// Returns the context that determines the defaults of a job. `timed` must be true if a time
    /// limit ends the sampling.
    pub fn job_context(&self, timed: bool) -> JobContext<'_> {
        // Dürer's own dialect does not emulate a program.
        let emulates = self.guess.is_none() && self.dialect != Dialect::Durer;
        JobContext { scene: &self.scene, rules: &self.rules, emulates, timed }
    }

    /// Returns the paths of the files that have been read so far, except the scene file. The list
    /// is complete after compilation.
    pub fn files(&self) -> Vec<PathBuf> {
        self.source.paths()
    }

    /// Returns the paths of the existing files that the scene names, including those that have not
    /// been read yet.
    pub fn named_files(&self) -> Vec<PathBuf> {
        // In JSON, all names are quoted, and no other string is the name of a file.
        let text = json::write(&self.scene, self.dialect);
        let quoted: BTreeSet<&str> = text.split('"').collect();
        // A name such as `picture.png:g` refers to a channel of a file.
        let names = quoted.iter().flat_map(|text| [Some(*text), text.rsplit_once(':').map(|parted| parted.0)]);
        let mut paths = self.source.paths();
        paths.extend(names.flatten().filter_map(|name| self.source.find_path(name)));
        paths
    }

    /// Converts the scene to the format that the extension of `name` selects. Returns `None` if the
    /// scene cannot be written. Adds a warning for everything that the format cannot express.
    pub fn write(&self, name: &str, diagnostics: &mut Diagnostics) -> Option<Written> {
        let write = scene_writer_for(name)?;
        let output = WriteContext {
            name,
            source: &self.source,
            normals: self.rules.mesh_normals,
            srgb_textures: self.rules.srgb_textures,
            memory: self.memory,
        };
        Some(write(&self.scene, &output, diagnostics))
    }

    /// Returns a copy of the scene in which embedded data is replaced by files in `folder`. Also
    /// returns these files.
    pub fn export_assets(&self, folder: &str) -> (Scene, Vec<AssetFile>) {
        export_assets(&self.scene, folder, &self.source)
    }

    /// Compiles the scene. If there are errors, adds them to `diagnostics` and returns `None`.
    pub fn compile(&self, options: &LoadOptions, files: &mut Files, diagnostics: &mut Diagnostics) -> Option<World> {
        let memory = options.memory.unwrap_or(u64::MAX);
        let resources = Resources {
            source: &self.source,
            decoder: &Decoder,
            files,
            sky_optional: options.course,
            memory,
            rays: options.rays.unwrap_or(u64::MAX),
            cache: options.cache.as_deref(),
        };
        let work = || compile(&self.scene, &self.rules, options.accel, resources, diagnostics);
        let mut world = match options.threads {
            Some(_) => threads::install(options.threads, work),
            None => work(),
        }?;
        let refuse = |problem| diagnostics.push(Diagnostic::error(problem).code("bad-value"));
        let place = |world: &mut World| {
            options.placement.apply(world, self.scene.up)?;
            // The camera of a model has been rotated, unless an option has moved it since.
            let is_still = self.scene.up.is_none() || options.placement.eye.is_some();
            let degrees = options.scene_defaults.orbit_degrees.filter(|_| is_still);
            degrees.map_or(Ok(()), |degrees| orbit(world, self.scene.up, degrees))
        };
        place(&mut world).map_err(refuse).ok()?;
        Some(world)
    }
}

#[cfg(test)]
mod cache_tests;
#[cfg(test)]
mod model_tests;
#[cfg(test)]
mod picture_tests;
#[cfg(test)]
mod tests;
