//! From a file's path to a world: format, dialect, rules, files.

use crate::job::JobContext;
use durer_diag::{Diagnostic, Diagnostics, Files, Severity};
use durer_formats::Decoder;
use durer_formats::beside::{Beside, put_beside};
use durer_formats::course::{self, Guess, Hint, ReadOptions};
use durer_formats::folder::FolderSource;
use durer_formats::json;
use durer_formats::scene::{Input, Output, find_scene_format, other_format, read_model, scene_format_for};
use durer_render::compile::{AccelKind, Kept, Resources, compile};
use durer_render::threads;
use durer_render::world::World;
use durer_scene::dialect::{Compat, Dialect, PathBase, Rules};
use durer_scene::scene::{Scene, Staging};
use durer_scene::source::{AssetSource, SourceError, is_packed, unpacked};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How a scene file is to be understood.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Its dialect, with the bugs of that year's program. `None`: it is guessed, and sane rules
    /// hold.
    pub dialect: Option<Dialect>,
    /// Whether a guessed dialect is taken with its bugs, and files are also read below the current
    /// directory: what the course's command line does.
    pub course: bool,
    /// What else is known of the dialect.
    pub hints: Vec<Hint>,
    /// Compatibilities to turn on or off.
    pub compat: Vec<(Compat, bool)>,
    /// Whether only the words of the dialect are allowed.
    pub strict: bool,
    /// Whether files may lie anywhere.
    pub allow_outside: bool,
    /// Folders in which missing files are looked for.
    pub assets: Vec<PathBuf>,
    /// Files that are in no folder, by the names that the scene gives them.
    pub given: Vec<(String, Arc<[u8]>)>,
    /// How a model that is no scene becomes one.
    pub staging: Staging,
    /// The structure that finds objects.
    pub accel: AccelKind,
    /// Threads that build the world; `None`: as many as the machine has.
    pub threads: Option<usize>,
    /// Bytes that the world may take; `None`: any number.
    pub memory: Option<u64>,
    /// About how many camera rays the world is for; `None`: many. Trees are built faster for few.
    pub rays: Option<u64>,
    /// Meshes and pictures of the same scene as it was before: what did not change is neither read
    /// nor built again.
    pub kept: Option<Arc<Kept>>,
}

/// A scene that was read.
#[derive(Debug)]
pub struct Loaded {
    /// The description.
    pub scene: Scene,
    /// What its words mean.
    pub rules: Rules,
    /// Its dialect.
    pub dialect: Dialect,
    /// How the dialect was found, where it was not asked for.
    pub guess: Option<Guess>,
    /// Where its files are.
    source: FolderSource,
    /// Bytes that one of its pictures may take while it is decoded.
    memory: u64,
}

/// Reads a scene file. What is wrong with it goes into `diagnostics`, and the text into `files`.
///
/// # Errors
///
/// The file itself cannot be read. `Ok(None)` means that it was read and has errors.
pub fn load(
    path: &Path,
    options: &LoadOptions,
    files: &mut Files,
    diagnostics: &mut Diagnostics,
) -> Result<Option<Loaded>, SourceError> {
    let name = path.display().to_string();
    let bytes = FolderSource::new(folder_of(path)).allow_outside().read_path(path, &name)?;
    Ok(load_text(path, bytes, options, files, diagnostics))
}

/// The folder in which a file lies.
fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// The same for a text that is, or is to be, in the file of a path. `None` after errors.
pub fn load_text(
    path: &Path,
    bytes: Arc<[u8]>,
    options: &LoadOptions,
    files: &mut Files,
    diagnostics: &mut Diagnostics,
) -> Option<Loaded> {
    let mut source = FolderSource::new(folder_of(path));
    if options.allow_outside {
        source = source.allow_outside();
    }
    for assets in &options.assets {
        source = source.assets(assets);
    }
    for (name, bytes) in &options.given {
        source = source.give(name, bytes.clone());
    }
    // Where the scene lies does not matter for what it is.
    source.record().add("", &bytes);
    let mut name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut bytes = bytes;
    if is_packed(&bytes) {
        let refuse = |problem| diagnostics.push(Diagnostic::error(problem).code("bad-file"));
        bytes = unpacked(&bytes, budget(options)).map_err(refuse).ok()?;
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
        let dialect = Dialect::Durer;
        let source = source.budget(budget(options));
        let known = RefCell::new(std::mem::take(files));
        let staging = &options.staging;
        let input = Input { bytes: &bytes, file, files: &known, name: &name, source: &source, staging, memory };
        let scene = read_model(format, &input, diagnostics);
        *files = known.into_inner();
        let scene = scene?;
        return Some(Loaded { scene, rules: dialect.rules().clone(), dialect, guess: None, source, memory });
    }
    if options.staging.turned.is_some() {
        let error = Diagnostic::error("nothing goes around this scene: it is seen by the camera that is written in it");
        let help = "`durer convert` makes a glTF file of it, which is a model that `--turntable` goes around";
        diagnostics.push(error.help(help));
        return None;
    }
    let mut guess = None;
    let dialect = options.dialect.unwrap_or_else(|| {
        let found = match &json {
            // Nobody asked for it; the scene says it.
            Some(json) => Guess { dialect: json.dialect(), reasons: Vec::new(), others: Vec::new() },
            None => course::guess(&bytes, file, &options.hints, &|name| source.contains(name)),
        };
        guess.insert(found).dialect
    });
    let mut rules = dialect.rules().clone();
    if options.dialect.is_none() && !options.course {
        rules = rules.sane();
    }
    // The two versions of one program: neither had both quirks.
    if options.compat.contains(&(Compat::ExitR0, true)) {
        rules.compat &= !Compat::ShadowFronts.bit();
    }
    for (compat, on) in &options.compat {
        rules.compat = if *on { rules.compat | compat.bit() } else { rules.compat & !compat.bit() };
    }
    source = match rules.paths {
        PathBase::SceneFile => source,
        PathBase::Current => source.look_in(".", true),
        PathBase::Assets(assets) => source.look_in(assets, true),
    };
    if options.course {
        source = source.allow(".");
    }
    source = source.budget(budget(options));
    let read = ReadOptions { dialect, strict: options.strict, compat: rules.compat };
    if let Some(json) = json {
        return json.scene(diagnostics).map(|scene| Loaded { scene, rules, dialect, guess, source, memory });
    }
    let known = RefCell::new(std::mem::take(files));
    let scene = course::read_with(&bytes, file, read, &course::below(&source, &known), diagnostics);
    *files = known.into_inner();
    if let (Some(_), Some(dialect), false, false) = (&scene, options.dialect, options.strict, options.course) {
        diagnostics.extend(portability(&bytes, file, dialect, diagnostics));
    }
    if let (None, Some(guess)) = (&scene, &guess) {
        // What is wrong in one dialect may be right in another.
        diagnostics.push(guess.note());
    }
    scene.map(|scene| Loaded { scene, rules, dialect, guess, source, memory })
}

/// Bytes that may be read.
fn budget(options: &LoadOptions) -> u64 {
    FolderSource::DEFAULT_BUDGET.min(options.memory.unwrap_or(u64::MAX))
}

/// What the year's own program would refuse in a file that is read here: the first of it, as a
/// note, unless it was said.
fn portability(bytes: &[u8], file: u32, dialect: Dialect, said: &Diagnostics) -> Diagnostics {
    let (mut strict, mut notes) = (Diagnostics::default(), Diagnostics::default());
    if dialect != Dialect::Durer {
        course::read(bytes, file, ReadOptions { dialect, strict: true, compat: dialect.rules().compat }, &mut strict);
    }
    let first = strict.iter().find(|d| d.severity == Severity::Error);
    if let Some(first) = first.filter(|first| !said.iter().any(|known| known.span == first.span)) {
        let message = format!("the program of {} would refuse this file: {}", dialect.name(), first.message);
        let note = Diagnostic::note(message)
            .code("portability")
            .help("it is read here all the same; `--strict` refuses it too");
        notes.push(Diagnostic { span: first.span, ..note });
    }
    notes
}

impl Loaded {
    /// What the defaults of a job follow from. `timed`: a time limit decides when there are enough samples.
    pub fn job_context(&self, timed: bool) -> JobContext<'_> {
        // Our own dialect is one to ask for, but not an old program.
        let emulates = self.guess.is_none() && self.dialect != Dialect::Durer;
        JobContext { scene: &self.scene, rules: &self.rules, emulates, timed }
    }

    /// Where the files are that were read for it, the scene's own not among them. All are known
    /// when it is compiled.
    pub fn files(&self) -> Vec<PathBuf> {
        self.source.paths()
    }

    /// The files that it names, as far as they are there, whether they were read or not.
    pub fn named_files(&self) -> Vec<PathBuf> {
        // In JSON names stand in quotes, and nothing else there is a file.
        let text = json::write(&self.scene, self.dialect);
        let quoted: BTreeSet<&str> = text.split('"').collect();
        // `picture.png:g` is a channel of a file.
        let names = quoted.iter().flat_map(|text| [Some(*text), text.rsplit_once(':').map(|parted| parted.0)]);
        let mut found = self.source.paths();
        found.extend(names.flatten().filter_map(|name| self.source.place(name)));
        found
    }

    /// Writes the scene as a model in another format, if that format is written; what it has no
    /// words for is warned of.
    pub fn write(&self, name: &str, diagnostics: &mut Diagnostics) -> Option<Vec<u8>> {
        let write = scene_format_for(name)?.write?;
        let output = Output { name, source: &self.source, normals: self.rules.mesh_normals, memory: self.memory };
        Some(write(&self.scene, &output, diagnostics))
    }

    /// The same scene with all that is in no file of its own in files of a folder beside it.
    pub fn put_beside(&self, folder: &str) -> (Scene, Vec<Beside>) {
        put_beside(&self.scene, folder, &self.source)
    }

    /// Compiles the scene. `None` after errors, which are in `diagnostics`.
    pub fn compile(&self, options: &LoadOptions, files: &mut Files, diagnostics: &mut Diagnostics) -> Option<World> {
        let memory = options.memory.unwrap_or(u64::MAX);
        let resources = Resources {
            source: &self.source,
            decoder: &Decoder,
            files,
            sky_optional: options.course,
            memory,
            rays: options.rays.unwrap_or(u64::MAX),
            kept: options.kept.as_deref(),
        };
        let work = || compile(&self.scene, &self.rules, options.accel, resources, diagnostics);
        match options.threads {
            Some(_) => threads::install(options.threads, work),
            None => work(),
        }
    }
}

#[cfg(test)]
mod kept_tests;
#[cfg(test)]
mod model_tests;
#[cfg(test)]
mod picture_tests;
#[cfg(test)]
mod tests;
