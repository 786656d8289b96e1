//! Implements `durer convert`, which writes scenes and meshes in other formats.

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::open::load_options;
use crate::options::SceneArgs;
use crate::report::counted;
use crate::{output, report};
use anyhow::Context;
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::diag::{Diagnostic, Diagnostics, Files};
use durer::dialect::Dialect;
use durer::format::asset_export::{AssetFile, sanitize_name};
use durer::format::course::{self, ReadOptions, write};
use durer::format::scene::Written;
use durer::format::{json, mesh_format_for, scene_format_for, scene_writer_for};
use durer::image::Destination;
use durer::scene::{RenderDefaults, Scene};
use durer::{LoadedScene, load};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Convert a scene to a dialect, JSON, glTF, pbrt, Mitsuba or USD, or its meshes to PLY, OBJ or STL
#[derive(Args)]
#[command(
    after_help = "Examples:\n  durer convert scene.txt -o scene_durer.txt --to durer\n  durer convert scene.txt -o scene.json\n  durer convert model.glb -o model.stl\n  durer convert scene.pbrt -o scene.glb\n  durer convert scene.txt -o scene.xml\n  durer convert model.glb -o scene.txt"
)]
pub struct ConvertArgs {
    /// Scene or model file
    pub scene: PathBuf,
    /// File to write
    #[arg(short, long)]
    pub output: PathBuf,
    #[command(flatten)]
    pub reading: SceneArgs,
    /// Dialect to write [default: the scene's]
    #[arg(long, value_parser = PossibleValuesParser::new(Dialect::ALL.map(Dialect::name)))]
    pub to: Option<String>,
}

/// Runs `durer convert`.
pub fn run(args: &ConvertArgs) -> Result<(), Failure> {
    let mut registry = FileRegistry::default();
    registry.register_input(&args.scene)?;
    let destination = registry.register_output("--output", &args.output)?;
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let mut options = load_options(&args.reading);
    let name = args.output.to_string_lossy();
    let as_json = name.to_lowercase().ends_with(".json");
    let as_mesh = mesh_format_for(&name).filter(|_| args.to.is_none());
    if as_mesh.is_some() {
        options.scene_defaults.meshes_only();
    }
    let ending = args.output.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let has_words = args.to.is_none() && (mesh_format_for(&name).is_some() || scene_format_for(&name).is_some());
    if !["", "txt", "json"].contains(&&*ending) && !has_words || has_words && is_only_read(&name) {
        let message = format!("`.{ending}` files cannot be written: use .txt or .json for a scene");
        let message = format!(
            "{message}, .pbrt, .xml or .usda for pbrt, Mitsuba and USD, .gltf or .glb for a model, and .ply, .obj, .stl or .off for meshes"
        );
        return Err(invalid_input(message));
    }
    let as_scene = scene_format_for(&name).filter(|_| scene_writer_for(&name).is_some() && args.to.is_none());
    // Write only the model, because the renderer adds a missing camera and lights later. Other
    // programs do not.
    options.scene_defaults.convert_only = as_scene.is_some_and(|format| !format.is_complete_scene);
    // A camera in a file has no image size, so the model is framed for a square picture.
    options.scene_defaults.aspect = Some(1.0);
    let loaded = load(&args.scene, &options, &mut files, &mut diagnostics).map_err(report::unreadable)?;
    report::print(&files, &diagnostics, false);
    let loaded = loaded.ok_or(Failure::Input(None))?;
    // Do not overwrite the files that the converted scene refers to.
    loaded.named_files().iter().try_for_each(|path| registry.register_input(path))?;
    if as_scene.is_some() {
        let mut warnings = Diagnostics::default();
        let written = loaded.write(&name, &mut warnings).unwrap_or_default();
        report::print(&files, &warnings, false);
        return save_with_files(args, destination, written, &mut registry);
    }
    if let Some(format) = as_mesh {
        let mut warnings = Diagnostics::default();
        let world = loaded.compile(&options, &mut files, &mut warnings);
        report::print(&files, &warnings, true);
        let (mesh, left_out) = world.ok_or(Failure::Input(None))?.merged_mesh();
        if left_out > 0 {
            let objects = counted(left_out, "object");
            let why = format!("planes and solids have no triangles, and {} stores only triangles", format.name);
            if mesh.triangles.is_empty() {
                return Err(invalid_input(format!("there is nothing to write: {why}")));
            }
            report::note(&Diagnostic::warning(format!("left out {objects}: {why}")));
        }
        note_up_axis(&loaded, &args.scene, &name);
        return output::save(&[(&destination, (format.write)(&mesh))], false);
    }
    let dialect = args.to.as_deref().and_then(Dialect::from_name).unwrap_or(loaded.dialect);
    let mut warnings = Diagnostics::default();
    // A text scene refers to other files, so the files of a model are written to a folder named
    // after the output.
    let is_model = loaded.scene.assets.has_in_memory();
    let (scene, files) = if is_model {
        let (scene, files) = loaded.export_assets(&model_folder(args, &name)?);
        (Cow::Owned(scene), files)
    } else {
        warn_of_files_left_behind(args, &loaded, &mut warnings);
        (Cow::Borrowed(&loaded.scene), Vec::new())
    };
    let text = match as_json {
        true => json::write(&scene, dialect),
        false => text_in(dialect, &scene, args, &mut warnings),
    };
    report::print(&Files::default(), &warnings, false);
    if is_model && let Some(options) = requested_picture(&loaded.scene.render_defaults) {
        let message = "the input file also sets the size and quality of the picture, but a scene file cannot store \
                       these settings";
        report::note(&Diagnostic::note(message).help(format!("render it with `{options}`")));
    }
    save_with_files(args, destination, Written { bytes: text.into_bytes(), files }, &mut registry)
}

/// Notes that a mesh keeps its coordinates although readers of the written format expect another
/// axis to point up.
fn note_up_axis(loaded: &LoadedScene, from: &Path, to: &str) {
    let (Some(up), Some(format)) = (loaded.scene.up, scene_format_for(to)) else { return };
    if up != format.up {
        let [up, other] = [up, format.up].map(|axis| format!("{axis:?}").to_lowercase());
        let message = format!(
            "the coordinates are those of {}, with {up} up, but programs read {} files with {other} up",
            from.display(),
            format.name
        );
        report::note(&Diagnostic::note(message).help(format!("render it with `--up {up}`")));
    }
}

/// Returns the name of the folder for the files of a model, which is that of the output without its
/// extension.
fn model_folder(args: &ConvertArgs, name: &str) -> Result<String, Failure> {
    let folder = sanitize_name(&args.output.file_stem().unwrap_or_default().to_string_lossy());
    if folder != name {
        return Ok(folder);
    }
    Err(invalid_input(
        "the output needs an extension, for example `scene.txt`: the name without the extension is the folder \
         for the model's files",
    ))
}

/// Returns the text of a scene. Warns of words that the dialect lacks, and of a text that would be
/// read in another dialect.
fn text_in(dialect: Dialect, scene: &Scene, args: &ConvertArgs, warnings: &mut Diagnostics) -> String {
    let text = write(scene, dialect);
    warn_of_foreign_words(text.as_bytes(), dialect, warnings);
    let base = args.output.parent().unwrap_or(Path::new(""));
    let read = course::guess(text.as_bytes(), 0, &[], &|name| base.join(name).exists()).dialect;
    if read == dialect {
        return text;
    }
    if dialect == Dialect::Durer {
        // Only this dialect has comments.
        return format!("# A scene in the dialect of Dürer.\n{text}");
    }
    let message = format!("without `--dialect`, the words of this file are read as {}", read.name());
    let help = format!("render it with `--dialect {}`", dialect.name());
    warnings.push(Diagnostic::warning(message).code("dialect").help(help));
    text
}

/// Warns of words in a written scene that its dialect lacks.
fn warn_of_foreign_words(text: &[u8], dialect: Dialect, warnings: &mut Diagnostics) {
    let (compat, mut found) = (dialect.rules().quirks, Diagnostics::default());
    course::read(text, 0, ReadOptions { dialect, strict: false, compat }, &mut found);
    let foreign = found.iter().filter(|diagnostic| diagnostic.code == "foreign-word");
    let warn = |found: &Diagnostic| Diagnostic::warning(found.message.clone()).code("no-counterpart");
    foreign.map(warn).for_each(|warning| warnings.push(warning));
}

/// Warns if a scene is written to another folder than that of the files to which it refers.
fn warn_of_files_left_behind(args: &ConvertArgs, loaded: &LoadedScene, warnings: &mut Diagnostics) {
    let folder = |path: &Path| {
        let parent = path.parent().filter(|parent| *parent != Path::new("")).unwrap_or(Path::new("."));
        parent.canonicalize().unwrap_or(parent.into())
    };
    let (from, to) = (folder(&args.scene), folder(&args.output));
    let first = loaded.named_files().into_iter().find(|path| path.exists());
    if let (Some(first), true) = (first, from != to) {
        let message = format!("the scene refers to `{}` and other files of its folder", first.display());
        let help = format!("copy them to the new folder, or render the scene with `--assets {}`", from.display());
        warnings.push(Diagnostic::warning(message).code("missing-file").help(help));
    }
}

/// Saves a scene and the files beside it: all of them or none.
fn save_with_files(
    args: &ConvertArgs,
    destination: Destination,
    written: Written,
    registry: &mut FileRegistry,
) -> Result<(), Failure> {
    let base = args.output.parent().unwrap_or(Path::new(""));
    let folder = written.files.first().and_then(|(path, _)| Path::new(path).parent()).map(|folder| base.join(folder));
    let is_new = folder.as_ref().is_some_and(|folder| !folder.exists());
    refuse_to_overwrite(args, base, &written)?;
    if let Some(folder) = &folder {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot create the folder `{}`", folder.display()))?;
    }
    let saved = save_all(base, destination, written, registry);
    if let (Err(_), true, Some(folder)) = (&saved, is_new, &folder) {
        // The folder is empty, because nothing was saved.
        std::fs::remove_dir(folder).ok();
    }
    saved
}

/// Returns an error if a file of the model would replace a file that belongs to another scene.
fn refuse_to_overwrite(args: &ConvertArgs, base: &Path, written: &Written) -> Result<(), Failure> {
    let differs = |(path, bytes): &&AssetFile| std::fs::read(base.join(path)).is_ok_and(|old| old != bytes[..]);
    let Some((path, _)) = written.files.iter().find(differs) else { return Ok(()) };
    let extension = |name: &Path| name.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let shares_folder = |name: &Path| {
        let is_scene = extension(name).is_some_and(|it| ["txt", "json", "pbrt", "xml", "usda", "gltf"].contains(&&*it));
        is_scene && name.file_stem() == args.output.file_stem() && name.file_name() != args.output.file_name()
    };
    let around = if base == Path::new("") { Path::new(".") } else { base };
    let others = std::fs::read_dir(around).into_iter().flatten().flatten().map(|entry| entry.path());
    if args.output.exists() && !others.into_iter().any(|other| shares_folder(&other)) {
        return Ok(());
    }
    Err(invalid_input(format!(
        "`{}` exists and has other contents, so it may belong to another scene: choose another name for the output, or \
         delete that file",
        base.join(path).display()
    )))
}

fn save_all(
    base: &Path,
    destination: Destination,
    written: Written,
    registry: &mut FileRegistry,
) -> Result<(), Failure> {
    let writes =
        |(path, bytes): AssetFile| Ok((registry.register_output("a file of the model", &base.join(path))?, bytes));
    let mut all = written.files.into_iter().map(writes).collect::<Result<Vec<_>, Failure>>()?;
    all.push((destination, written.bytes));
    let (places, contents): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    output::save(&places.iter().zip(contents).collect::<Vec<_>>(), false)
}

/// Returns true if files with this name can be read but not written.
fn is_only_read(name: &str) -> bool {
    mesh_format_for(name).is_none() && scene_format_for(name).is_some() && scene_writer_for(name).is_none()
}

/// Returns the render options stored in a file, if there are any.
fn requested_picture(render_defaults: &RenderDefaults) -> Option<String> {
    let size = render_defaults.size.map(|(width, height)| format!("--size {width}x{height}"));
    let crop = render_defaults.crop.map(|(left, top, width, height)| format!("--crop {left},{top},{width}x{height}"));
    let samples = render_defaults.samples.map(|samples| format!("--samples {samples}"));
    let bounces = render_defaults.bounces.map(|bounces| format!("--bounces {bounces}"));
    let all: Vec<String> = [size, crop, samples, bounces].into_iter().flatten().collect();
    (!all.is_empty()).then(|| all.join(" "))
}
