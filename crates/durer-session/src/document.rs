//! The text of a scene and the world that was compiled from it.

use crate::protocol::{Finding, Severity, TextEdit, TextPosition};
use durer::camera::Camera;
use durer::check::{CheckInput, check};
use durer::compile::AssetCache;
use durer::describe::DescribedKind;
use durer::diag::{self, Diagnostic, Diagnostics, Files, Span};
use durer::dialect::Dialect;
use durer::format::asset_export::{AssetFile, sanitize_name};
use durer::format::course::write;
use durer::format::scene::find_scene_format;
use durer::format::{SceneFormat, mesh_format_for};
use durer::job::JobContext;
use durer::render::Job;
use durer::render::explain::SceneNames;
use durer::scene::Scene;
use durer::world::World;
use durer::{LoadOptions, LoadedScene, load_text};
use std::path::PathBuf;
use std::sync::Arc;

/// File number of the scene file itself.
const OWN: u32 = 0;

/// The scene file that a session edits, together with its compiled form.
pub(crate) struct Document {
    pub path: PathBuf,
    pub bytes: Arc<[u8]>,
    pub options: LoadOptions,
    /// Compiled form of the latest version of the text that had no errors.
    pub compiled: Option<CompiledDocument>,
}

/// A scene that was read without errors and its compiled world. A session renders from this world.
pub(crate) struct CompiledDocument {
    loaded: LoadedScene,
    pub world: World,
    /// The camera that is defined in the text.
    pub text_camera: Camera,
    pub files: Files,
    diagnostics: Diagnostics,
}

impl Document {
    pub fn new(path: PathBuf, bytes: Arc<[u8]>) -> Self {
        let options = LoadOptions { cache: Some(Arc::new(AssetCache::default())), ..LoadOptions::default() };
        Document { path, bytes, options, compiled: None }
    }

    /// Returns the text of the document, or `None` for a model file.
    pub fn text(&self) -> Option<&str> {
        if self.is_model() { None } else { std::str::from_utf8(&self.bytes).ok() }
    }

    /// Reads and compiles the text. Returns true on success, together with the findings. If there
    /// are errors, the previous compiled scene is kept.
    pub fn compile(&mut self) -> (bool, Vec<Finding>) {
        let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
        let loaded = load_text(&self.path, self.bytes.clone(), &self.options, &mut files, &mut diagnostics);
        let world = loaded.as_ref().and_then(|loaded| loaded.compile(&self.options, &mut files, &mut diagnostics));
        let findings = diagnostics.iter().map(|diagnostic| finding(diagnostic, &files)).collect();
        let Some((loaded, world)) = loaded.zip(world) else { return (false, findings) };
        let written = world.camera().clone();
        self.compiled = Some(CompiledDocument { loaded, world, text_camera: written, files, diagnostics });
        (true, findings)
    }

    /// Returns true if the file is not text in the scene language but, for example, a mesh or a
    /// glTF file.
    pub fn is_model(&self) -> bool {
        let name = self.path.to_string_lossy();
        let is_written = |format: &SceneFormat| format.write.is_some();
        std::str::from_utf8(&self.bytes).is_err()
            || mesh_format_for(&name).is_some()
            || find_scene_format(&self.bytes, &name).is_some_and(is_written)
    }

    /// Changes the scene of a model and compiles it again. If compiling fails, the document does
    /// not change.
    pub fn change(&mut self, change: impl FnOnce(&mut Scene) -> Result<(), String>) -> Result<(), String> {
        let compiled = self.compiled.as_mut().ok_or("the scene has errors")?;
        let before = compiled.loaded.scene.clone();
        let mut diagnostics = Diagnostics::default();
        let changed = change(&mut compiled.loaded.scene).and_then(|()| {
            let world = compiled.loaded.compile(&self.options, &mut compiled.files, &mut diagnostics);
            world.ok_or_else(|| diagnostics.iter().next().map_or_else(String::new, |error| error.message.clone()))
        });
        match changed {
            Ok(mut world) => {
                // The document is no longer the same as the file.
                world.edit().camera = compiled.world.camera().clone();
                world.set_camera(compiled.world.camera().clone());
                compiled.world = world;
                Ok(())
            }
            Err(why) => {
                compiled.loaded.scene = before;
                Err(why)
            }
        }
    }

    /// Converts the scene with the current camera to text in the scene language. Also returns the
    /// files to which the text refers.
    pub fn as_text(&self) -> Result<(String, Vec<AssetFile>), String> {
        let compiled = self.compiled.as_ref().ok_or("the scene has errors")?;
        let stem = sanitize_name(&self.path.file_stem().unwrap_or_default().to_string_lossy());
        let (mut scene, files) = compiled.loaded.export_assets(&stem);
        scene.camera = Some(compiled.world.camera().clone());
        Ok((write(&scene, Dialect::Durer), files))
    }

    /// Returns the byte range of the camera statement in the text, from its keyword to its closing
    /// brace.
    pub fn camera_statement(&self) -> Option<(usize, usize)> {
        let compiled = self.compiled.as_ref()?;
        let span = compiled.loaded.scene.camera_span;
        (span.has_position() && span.file == OWN).then_some(())?;
        let end = block_end(self.text()?.as_bytes(), span.end as usize)?;
        Some((span.start as usize, end))
    }
}

impl CompiledDocument {
    pub fn scene(&self) -> &Scene {
        &self.loaded.scene
    }

    pub fn dialect(&self) -> Dialect {
        self.loaded.dialect
    }

    pub fn job_context(&self) -> JobContext<'_> {
        JobContext { scene: &self.loaded.scene, rules: &self.loaded.rules, emulates: false, timed: false }
    }

    pub fn names(&self) -> SceneNames<'_> {
        SceneNames { files: &self.files, scene: &self.loaded.scene, world: &self.world }
    }

    /// Returns the findings that `durer check` reports.
    pub fn check(&self, job: &Job) -> Vec<Finding> {
        let subject = CheckInput {
            scene: &self.loaded.scene,
            world: &self.world,
            dialect: self.loaded.dialect,
            files: &self.files,
            job,
            exposure: 1.0,
            rejected: None,
        };
        check(&subject, &self.diagnostics).iter().map(|found| finding(&found.diagnostic, &self.files)).collect()
    }

    pub fn named(&self) -> NamedScene<'_> {
        NamedScene(self.names())
    }

    /// Returns the keyword and the line of a light.
    pub fn light(&self, number: usize) -> String {
        self.named().light(number)
    }

    /// Returns the position of a span if it is in the scene file itself.
    pub fn place(&self, span: Span) -> Option<TextPosition> {
        place(&self.files, span)
    }
}

/// The names of a compiled scene, and the positions of its statements in the scene file.
#[derive(Clone, Copy)]
pub(crate) struct NamedScene<'a>(pub SceneNames<'a>);

impl NamedScene<'_> {
    pub fn world(&self) -> &World {
        self.0.world
    }

    /// Returns the keyword and the line of a light.
    pub fn light(&self, number: usize) -> String {
        let light = self.0.scene.lights.iter().flatten().nth(number);
        match light.and_then(|light| Some((light.value.own_keyword(), self.place(light.span)?.line))) {
            Some((keyword, line)) => format!("{keyword} of line {line}"),
            None => self.0.light(number),
        }
    }

    /// Returns the position of a span if it is in the scene file itself.
    pub fn place(&self, span: Span) -> Option<TextPosition> {
        place(self.0.files, span)
    }
}

fn place(files: &Files, span: Span) -> Option<TextPosition> {
    (span.has_position() && span.file == OWN).then_some(())?;
    let (line, column) = files.position(span)?;
    let block_end = files.bytes(OWN).and_then(|text| block_end(text, span.end as usize));
    Some(TextPosition {
        line: line as u32,
        column: column as u32,
        start: span.start,
        end: span.end,
        block_end: block_end.map_or(span.end, |end| end as u32),
    })
}

/// Returns the end of the block in braces that follows the keyword before `start`. Returns `None`
/// if something other than a block follows, or if the block is not closed.
fn block_end(text: &[u8], start: usize) -> Option<usize> {
    let (mut depth, mut in_comment) = (0, false);
    for (at, byte) in text.iter().enumerate().skip(start) {
        match byte {
            b'\n' => in_comment = false,
            b'#' => in_comment = true,
            _ if in_comment => {}
            b'{' => depth += 1,
            b'}' if depth <= 1 => return (depth == 1).then_some(at + 1),
            b'}' => depth -= 1,
            _ if depth == 0 && !byte.is_ascii_whitespace() => return None,
            _ => {}
        }
    }
    None
}

fn finding(diagnostic: &Diagnostic, files: &Files) -> Finding {
    let other = diagnostic.span.filter(|span| span.file != OWN).and_then(|span| files.name(span.file));
    // If the problem is in another file, the place is where the scene names that file.
    let named = diagnostic.related.as_ref().filter(|_| other.is_some()).and_then(|(span, _)| place(files, *span));
    Finding {
        severity: match diagnostic.severity {
            diag::Severity::Note => Severity::Note,
            diag::Severity::Warning => Severity::Warning,
            diag::Severity::Error => Severity::Error,
        },
        code: diagnostic.code.into(),
        message: diagnostic.message.clone(),
        help: diagnostic.help.clone(),
        effect: diagnostic.effect.clone(),
        file: other.map(Into::into),
        place: diagnostic.span.and_then(|span| place(files, span)).or(named),
        fix: diagnostic
            .fix
            .iter()
            .filter(|edit| edit.span.file == OWN)
            .map(|edit| TextEdit { start: edit.span.start, end: edit.span.end, text: edit.text.clone() })
            .collect(),
    }
}
