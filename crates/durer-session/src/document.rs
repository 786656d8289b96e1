//! The text of a scene and its compiled form.

use crate::protocol::{Change, Finding, Place, Severity};
use durer::camera::Camera;
use durer::check::{Subject, check};
use durer::compile::Kept;
use durer::describe::DescribedList;
use durer::diag::{self, Diagnostic, Diagnostics, Files, Span};
use durer::dialect::Dialect;
use durer::job::JobContext;
use durer::render::Job;
use durer::render::explain::Names;
use durer::scene::Scene;
use durer::world::World;
use durer::{LoadOptions, Loaded, load_text};
use std::path::PathBuf;
use std::sync::Arc;

/// File number of the scene's own file.
const OWN: u32 = 0;

/// An editable scene file.
pub(crate) struct Document {
    pub path: PathBuf,
    pub bytes: Arc<[u8]>,
    pub options: LoadOptions,
    /// Compiled form of the last text without errors.
    pub compiled: Option<Compiled>,
}

/// A text without errors, and its compiled world.
pub(crate) struct Compiled {
    loaded: Loaded,
    pub world: World,
    /// The camera as written in the text.
    pub written: Camera,
    pub files: Files,
    diagnostics: Diagnostics,
}

impl Document {
    pub fn new(path: PathBuf, bytes: Arc<[u8]>) -> Self {
        let options = LoadOptions { kept: Some(Arc::new(Kept::default())), ..LoadOptions::default() };
        Document { path, bytes, options, compiled: None }
    }

    /// The text; `None` if the file is not UTF-8.
    pub fn text(&self) -> Option<&str> {
        std::str::from_utf8(&self.bytes).ok()
    }

    /// Reads and compiles the text. Returns true on success, and the findings. After errors, the
    /// previous compiled scene remains.
    pub fn compile(&mut self) -> (bool, Vec<Finding>) {
        let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
        let loaded = load_text(&self.path, self.bytes.clone(), &self.options, &mut files, &mut diagnostics);
        let world = loaded.as_ref().and_then(|loaded| loaded.compile(&self.options, &mut files, &mut diagnostics));
        let findings = diagnostics.iter().map(|diagnostic| finding(diagnostic, &files)).collect();
        let Some((loaded, world)) = loaded.zip(world) else { return (false, findings) };
        let written = world.camera().clone();
        self.compiled = Some(Compiled { loaded, world, written, files, diagnostics });
        (true, findings)
    }

    /// Byte range of the camera's statement in the text, from its keyword to its closing brace.
    pub fn camera_statement(&self) -> Option<(usize, usize)> {
        let compiled = self.compiled.as_ref()?;
        let span = compiled.loaded.scene.camera_span;
        (span.is_place() && span.file == OWN).then_some(())?;
        let rest = self.text()?.get(span.start as usize..)?;
        let mut depth = 0;
        let mut in_comment = false;
        for (at, letter) in rest.char_indices() {
            match letter {
                '\n' => in_comment = false,
                '#' => in_comment = true,
                '{' if !in_comment => depth += 1,
                '}' if !in_comment => {
                    depth -= 1;
                    if depth == 0 {
                        return Some((span.start as usize, span.start as usize + at + 1));
                    }
                }
                _ => {}
            }
        }
        None
    }
}

impl Compiled {
    pub fn scene(&self) -> &Scene {
        &self.loaded.scene
    }

    pub fn dialect(&self) -> Dialect {
        self.loaded.dialect
    }

    pub fn job_context(&self) -> JobContext<'_> {
        JobContext { scene: &self.loaded.scene, rules: &self.loaded.rules, emulates: false, timed: false }
    }

    pub fn names(&self) -> Names<'_> {
        Names { files: &self.files, scene: &self.loaded.scene, world: &self.world }
    }

    /// Returns the findings of `durer check`.
    pub fn check(&self, job: &Job) -> Vec<Finding> {
        let subject = Subject {
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

    /// Keyword and line of a light.
    pub fn light(&self, number: usize) -> String {
        let light = self.loaded.scene.lights.iter().flatten().nth(number);
        match light.and_then(|light| Some((light.value.own_keyword(), self.place(light.span)?.line))) {
            Some((keyword, line)) => format!("{keyword} of line {line}"),
            None => self.names().light(number),
        }
    }

    /// Returns the place of a span if it lies in the scene's own text.
    pub fn place(&self, span: Span) -> Option<Place> {
        place(&self.files, span)
    }
}

fn place(files: &Files, span: Span) -> Option<Place> {
    (span.is_place() && span.file == OWN).then_some(())?;
    let (line, column) = files.position(span)?;
    Some(Place { line: line as u32, column: column as u32, start: span.start, end: span.end })
}

fn finding(diagnostic: &Diagnostic, files: &Files) -> Finding {
    let other = diagnostic.span.filter(|span| span.file != OWN).and_then(|span| files.name(span.file));
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
        place: diagnostic.span.and_then(|span| place(files, span)),
        fix: diagnostic
            .fix
            .iter()
            .filter(|edit| edit.span.file == OWN)
            .map(|edit| Change { start: edit.span.start, end: edit.span.end, text: edit.text.clone() })
            .collect(),
    }
}
