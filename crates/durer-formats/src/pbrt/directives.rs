//! Executes directives in file order.

use super::language::Language;
use super::lexer::{Lexer, Token};
use super::params::read as read_params;
use super::state::{DeferredDirective, OpenFile, Reader, Scope};
use super::transform::{invertible, look_at, matrix, numbers, rotation};
use crate::gzip::read_decompressed;
use crate::shared_report::suggest;
use durer_diag::{Diagnostic, Span};
use durer_scene::scene::{Object, ObjectKind, Scene};
use durer_scene::source::SourceError;
use durer_scene::spectrum::space::RgbSpace;
use glam::{DAffine3, DVec3};
use std::rc::Rc;

/// Names of all directives. The flag is true if a string follows the directive.
pub(super) const DIRECTIVES: [(&str, bool); 44] = [
    ("Accelerator", true),
    ("ActiveTransform", false),
    ("AreaLightSource", true),
    ("Attribute", true),
    ("AttributeBegin", false),
    ("AttributeEnd", false),
    ("Camera", true),
    ("ColorSpace", true),
    ("ConcatTransform", false),
    ("CoordSysTransform", true),
    ("CoordinateSystem", true),
    ("Film", true),
    ("Identity", false),
    ("Import", true),
    ("Include", true),
    ("Integrator", true),
    ("LightSource", true),
    ("LookAt", false),
    ("MakeNamedMaterial", true),
    ("MakeNamedMedium", true),
    ("Material", true),
    ("MediumInterface", true),
    ("NamedMaterial", true),
    ("ObjectBegin", true),
    ("ObjectEnd", false),
    ("ObjectInstance", true),
    ("Option", true),
    ("PixelFilter", true),
    ("ReverseOrientation", false),
    ("Rotate", false),
    ("Sampler", true),
    ("Scale", false),
    ("Shape", true),
    ("Texture", true),
    ("Transform", false),
    ("TransformBegin", false),
    ("TransformEnd", false),
    ("TransformTimes", false),
    ("Translate", false),
    ("WorldBegin", false),
    // Only in pbrt-v3 and earlier.
    ("WorldEnd", false),
    ("SurfaceIntegrator", true),
    ("VolumeIntegrator", true),
    ("Renderer", true),
];

/// Directives that are allowed only after `WorldBegin`, then those that are allowed only before it.
const WORLD_DIRECTIVES: [&str; 10] = [
    "AreaLightSource",
    "LightSource",
    "MakeNamedMaterial",
    "Material",
    "NamedMaterial",
    "ObjectBegin",
    "ObjectInstance",
    "ReverseOrientation",
    "Shape",
    "Texture",
];
const BEFORE_WORLD: [&str; 8] =
    ["Accelerator", "Camera", "Film", "Integrator", "Option", "PixelFilter", "Sampler", "TransformTimes"];

/// Targets of the `Attribute` directive, in the order of
/// [`State::attributes`](super::state::State).
const TARGETS: [&str; 5] = ["shape", "light", "material", "medium", "texture"];

/// Limits on the number of included files, the depth of nested includes and the depth of nested
/// scopes.
const MAX_FILES: usize = 1 << 16;
const MAX_INCLUDE_DEPTH: usize = 64;
const MAX_SCOPE_DEPTH: usize = 1 << 12;

impl Reader<'_> {
    /// Reads the whole file and returns its scene. Errors are added to the reader's report.
    pub fn read(mut self) -> Scene {
        while !self.report.is_full() {
            let report = self.report;
            let Some(open) = self.texts.last_mut() else { break };
            let Some(token) = open.text.next(report) else {
                self.end_of_file();
                continue;
            };
            if token.token != Token::Word {
                let message = match token.token {
                    Token::Open | Token::Close => "unexpected bracket: no parameter comes before it".to_string(),
                    _ => "unexpected string: no directive comes before it".to_string(),
                };
                report.error(token.at, message);
                self.skip();
                continue;
            }
            let word = open.text.word(token.at).to_string();
            if !DIRECTIVES.iter().any(|row| row.0 == word) {
                let shown = open.text.quoted(token.at);
                let help = suggest(&word, DIRECTIVES.iter().map(|row| row.0));
                let error = Diagnostic::error(format!("unknown directive {shown}")).code("unknown-word").at(token.at);
                report.push(Diagnostic { help, ..error });
                self.skip();
                continue;
            }
            if self.directive(&word, token.at).is_none() {
                self.skip();
            }
        }
        if let (Some(early), Some(camera), false) = (self.too_early, &self.camera, self.in_world) {
            let message = "`WorldBegin` is missing: the transforms of the camera also apply to the objects";
            let warning = Diagnostic::warning(message).code("bad-place").at(early).related(camera.at, "the camera");
            self.report.push(warning.help("write `WorldBegin` before this directive"));
        }
        self.report_open_lights();
        if !self.report.is_full() {
            self.finish();
        }
        self.scene
    }

    fn text(&mut self) -> &mut Lexer {
        // There is always an open file while a directive is executed.
        let last = self.texts.len() - 1;
        &mut self.texts[last].text
    }

    /// Skips all tokens up to the next directive.
    fn skip(&mut self) {
        let report = self.report;
        let text = self.text();
        while let Some(token) = text.peek(report) {
            let at = token.at;
            if token.token == Token::Word && DIRECTIVES.iter().any(|row| row.0 == text.word(at)) {
                break;
            }
            text.next(report);
        }
    }

    /// Reads the string after a directive, and returns the string and its span.
    fn name(&mut self, directive: Span) -> Option<(String, Span)> {
        let report = self.report;
        let text = self.text();
        if let Some(token) = text.peek(report)
            && let Token::Text(name) = &token.token
        {
            let named = (name.clone(), token.at);
            text.next(report);
            return Some(named);
        }
        let message = format!("{} needs a string in quotes after it", text.quoted(directive));
        report.error(directive, message);
        None
    }

    fn numbers<const N: usize>(&mut self, directive: Span) -> Option<[f64; N]> {
        let report = self.report;
        numbers(self.text(), directive, report)
    }

    /// Executes a directive. Returns `None` if its arguments cannot be read.
    fn directive(&mut self, word: &str, at: Span) -> Option<()> {
        let report = self.report;
        if !self.in_world && WORLD_DIRECTIVES.contains(&word) {
            self.too_early.get_or_insert(at);
        }
        if self.in_world && BEFORE_WORLD.contains(&word) {
            report.error(at, format!("`{word}` must come before `WorldBegin`"));
        }
        match word {
            "Identity" => self.state.transforms.change(|_| DAffine3::IDENTITY),
            "Translate" => {
                let [x, y, z] = self.numbers(at)?;
                self.state.transforms.apply(DAffine3::from_translation(DVec3::new(x, y, z)));
            }
            "Scale" => {
                let [x, y, z] = self.numbers(at)?;
                let map = invertible(DAffine3::from_scale(DVec3::new(x, y, z)), at, report);
                map.into_iter().for_each(|map| self.state.transforms.apply(map));
            }
            "Rotate" => match rotation(self.numbers(at)?) {
                Some(map) => self.state.transforms.apply(map),
                None => report.error(at, "the axis of a rotation must not be 0 0 0"),
            },
            "LookAt" => match self.numbers::<9>(at).map(|numbers| (look_at(numbers), numbers))? {
                (Some(map), _) => {
                    if let Some(camera) = self.camera.as_ref().filter(|_| !self.in_world) {
                        let warning = Diagnostic::warning("`LookAt` after `Camera` does not move the camera");
                        let warning = warning.code("bad-place").at(at).related(camera.at, "the camera");
                        report.push(warning.help("write `LookAt` before `Camera`"));
                    }
                    self.state.transforms.apply(map);
                }
                (None, [x, y, z, to_x, to_y, to_z, ..]) => report.error(
                    at,
                    match [x, y, z] == [to_x, to_y, to_z] {
                        true => "the eye and the target of `LookAt` are equal",
                        false => "the `up` of `LookAt` is parallel to the viewing direction, or has no length",
                    },
                ),
            },
            "Transform" | "ConcatTransform" => {
                let map = matrix(self.numbers(at)?, at, report);
                match (map, word) {
                    (Some(map), "Transform") => self.state.transforms.change(|_| map),
                    (Some(map), _) => self.state.transforms.apply(map),
                    (None, _) => {}
                }
            }
            "TransformBegin" => self.open(Scope::Transform, at),
            "TransformEnd" => self.close(Scope::Transform, at),
            "AttributeBegin" => self.open(Scope::Attribute, at),
            "AttributeEnd" => self.close(Scope::Attribute, at),
            "ActiveTransform" => self.active(at)?,
            "TransformTimes" => _ = self.numbers::<2>(at)?,
            "ReverseOrientation" => self.state.reversed = !self.state.reversed,
            "WorldBegin" => self.world_begin(at),
            "WorldEnd" if self.language == Language::V3 => {}
            "WorldEnd" => report.unsupported_once(at, "`WorldEnd` belongs to pbrt-v3 and is ignored"),
            "ObjectEnd" => self.close(Scope::Object, at),
            _ => return self.named(word, at),
        }
        Some(())
    }

    /// Executes a directive that is followed by a string.
    fn named(&mut self, word: &str, at: Span) -> Option<()> {
        let (report, language) = (self.report, self.language);
        let (name, name_at) = self.name(at)?;
        match word {
            "CoordinateSystem" => _ = self.coordinate_systems.insert(name, self.state.transforms.maps),
            "CoordSysTransform" => match self.coordinate_systems.get(&name) {
                Some(maps) => self.state.transforms.maps = *maps,
                None => {
                    let help = suggest(&name, self.coordinate_systems.keys().map(String::as_str));
                    report.error_with_help(name_at, format!("unknown coordinate system `{name}`"), help);
                }
            },
            "ColorSpace" => match RgbSpace::named(&name) {
                Some(space) => self.state.space = space,
                None => {
                    let help = suggest(&name, RgbSpace::names());
                    report.error_with_help(name_at, format!("unknown colour space `{name}`"), help);
                }
            },
            "Include" | "Import" => self.include(name, name_at, word == "Import"),
            "ObjectBegin" => self.object_begin(name, at),
            "ObjectInstance" => {
                self.used_materials.extend(self.state.material_at.map(|at| (at.file, at.start)));
                self.instance(&name, name_at);
            }
            "NamedMaterial" => {
                self.state.material_at = Some(at.join(name_at));
                self.named_material(&name, name_at);
            }
            "MediumInterface" => {
                let second = matches!(self.text().peek(report).map(|next| &next.token), Some(Token::Text(_)));
                let outside = if second { self.name(at)?.0 } else { name.clone() };
                self.medium_interface(&[name, outside], name_at);
            }
            "Option" => self.skip_value(),
            "Texture" => {
                let (kind, kind_at) = self.name(at)?;
                let (class, class_at) = self.name(at)?;
                let list = read_params(self.text(), language, report);
                self.texture(name, (&kind, kind_at), (&class, class_at), list);
            }
            _ => {
                let list = read_params(self.text(), language, report);
                self.with_params(word, name, name_at, list);
            }
        }
        Some(())
    }

    /// Executes a directive that is followed by a string and parameters.
    fn with_params(&mut self, word: &str, name: String, at: Span, list: Vec<Rc<super::params::Param>>) {
        let keep = |reader: &Self, list| {
            let (transforms, space) = (reader.state.transforms, reader.state.space);
            DeferredDirective { kind: name.clone(), list, at, transforms, space }
        };
        match word {
            "Attribute" => match TARGETS.iter().position(|target| *target == name) {
                Some(target) => {
                    // If a parameter is set twice, the later value replaces the earlier one.
                    let attributes = &mut self.state.attributes[target];
                    attributes.retain(|old| list.iter().all(|new| new.name != old.name));
                    attributes.extend(list);
                }
                None => {
                    let help = suggest(&name, TARGETS);
                    self.report.error_with_help(at, format!("unknown target `{name}` of `Attribute`"), help);
                }
            },
            "Camera" => {
                let maps = self.state.transforms.maps.map(|map| map.inverse());
                self.coordinate_systems.insert("camera".into(), maps);
                self.camera = Some(keep(self, list));
                self.fog(at);
            }
            "Film" => self.film = Some(keep(self, list)),
            "Integrator" | "SurfaceIntegrator" => self.integrator(&keep(self, list)),
            "Sampler" => self.sampler(&keep(self, list)),
            "LightSource" => self.light(&name, at, list),
            "AreaLightSource" => self.area_light(&name, at, list),
            "Material" => {
                self.state.material_at = Some(at);
                self.state.material = self.material(&name, at, list);
            }
            "MakeNamedMaterial" => self.make_named_material(name, at, list),
            "MakeNamedMedium" => self.make_named_medium(name, at, list),
            "Shape" => self.shape(&name, at, list),
            // Ignore accelerators and pixel filters because Dürer has no counterpart for them.
            _ => {}
        }
    }

    /// Skips the value of an `Option` directive, whose string has the form of a parameter. Options
    /// have no effect in Dürer.
    fn skip_value(&mut self) {
        let report = self.report;
        let text = self.text();
        if text.next(report).is_some_and(|token| token.token == Token::Open) {
            while text.next(report).is_some_and(|token| token.token != Token::Close) {}
        }
    }

    fn active(&mut self, at: Span) -> Option<()> {
        let report = self.report;
        let text = self.text();
        let token = text.peek(report).filter(|token| token.token == Token::Word).cloned();
        let active = token.as_ref().and_then(|token| match text.word(token.at) {
            "All" => Some([true, true]),
            "StartTime" => Some([true, false]),
            "EndTime" => Some([false, true]),
            _ => None,
        });
        if active.is_none() {
            report.error(at, "`ActiveTransform` needs `All`, `StartTime` or `EndTime` after it");
            return None;
        }
        text.next(report);
        self.state.transforms.active = active?;
        Some(())
    }

    fn world_begin(&mut self, at: Span) {
        if self.in_world {
            self.report.error(at, "`WorldBegin` is given twice");
        }
        if let Some(early) = self.too_early {
            let error = Diagnostic::error("this directive must come after `WorldBegin`").code("bad-place").at(early);
            self.report.push(error.related(at, "`WorldBegin` is here"));
        }
        self.in_world = true;
        self.state.transforms = super::transform::Transforms::default();
        self.coordinate_systems.insert("world".into(), self.state.transforms.maps);
    }

    fn open(&mut self, scope: Scope, at: Span) {
        if self.stack.len() >= MAX_SCOPE_DEPTH {
            self.report.error(at, format!("scopes are nested more than {MAX_SCOPE_DEPTH} levels deep"));
            return;
        }
        self.stack.push((scope, self.state.clone(), at));
    }

    fn close(&mut self, scope: Scope, at: Span) {
        let end = match scope {
            Scope::Attribute => "AttributeEnd",
            Scope::Transform => "TransformEnd",
            Scope::Object | Scope::Import => "ObjectEnd",
        };
        match self.stack.last() {
            Some((open, ..)) if *open == scope => {}
            Some((open, _, begun)) if *open != Scope::Import => {
                let error = Diagnostic::error(format!("`{end}` does not match the scope that is open"));
                self.report.push(error.code("unclosed").at(at).related(*begun, "this scope is still open"));
                return;
            }
            _ => {
                let error = Diagnostic::error(format!("`{end}` without a scope to close"));
                return self.report.push(error.code("unclosed").at(at));
            }
        }
        let Some((_, state, _)) = self.stack.pop() else { return };
        if scope != Scope::Transform {
            self.check_area_light(state.area_light.as_ref(), Some((end, at)));
            self.check_material(&state, (end, at));
        }
        match scope {
            Scope::Transform => self.state.transforms = state.transforms,
            _ => self.state = state,
        }
        if scope == Scope::Object
            && let Some((name, group)) = self.defining.take()
        {
            self.objects.insert(name, Rc::new(group));
        }
    }

    fn object_begin(&mut self, name: String, at: Span) {
        if self.defining.is_some() {
            return self.report.error(at, "objects cannot be defined inside objects");
        }
        self.open(Scope::Object, at);
        self.defining = Some((name, Default::default()));
    }

    fn instance(&mut self, name: &str, at: Span) {
        if self.defining.is_some() {
            return self.report.error(at, "objects cannot be instanced inside objects: add an `ObjectEnd` before");
        }
        let Some(group) = self.objects.get(name).cloned() else {
            let help = suggest(name, self.objects.keys().map(String::as_str));
            return self.report.error_with_help(at, format!("unknown object `{name}`"), help);
        };
        if !self.limits.count_objects_or_report(group.objects.len() + 1, self.report, at) {
            return;
        }
        let inner = Object { node: ObjectKind::Group((*group).clone()), material: None, span: at };
        let object = inner.transformed(self.map(at));
        self.add(object);
    }

    /// Opens an included or imported file.
    fn include(&mut self, name: String, at: Span, imported: bool) {
        if let Some(open) = self.texts.iter().find(|open| open.name == name) {
            let error = Diagnostic::error(format!("`{name}` includes itself")).code("bad-value").at(at);
            let own = open.at.start == 0 && open.at.end == 0;
            return self.report.push(if own {
                error
            } else {
                error.related(open.at, format!("`{name}` is first included here"))
            });
        }
        self.included += 1;
        if self.included > MAX_FILES {
            return self.report.error(at, format!("more than {MAX_FILES} files are included"));
        }
        if self.texts.len() >= MAX_INCLUDE_DEPTH {
            return self.report.error(at, format!("includes are nested more than {MAX_INCLUDE_DEPTH} levels deep"));
        }
        let bytes = match read_decompressed(self.input.source, &name) {
            Ok(bytes) => bytes,
            Err(error) => {
                let near = match &error {
                    SourceError::Missing { similar: Some(near), .. } => Some(format!("did you mean `{near}`?")),
                    _ => None,
                };
                let missing = Diagnostic::error(format!("{error}")).code("missing-file").at(at);
                return self.report.push(Diagnostic { help: near, ..missing });
            }
        };
        if bytes.len() >= u32::MAX as usize {
            return self.report.error(at, format!("`{name}` is too large"));
        }
        let file = self.input.files.borrow_mut().add(name.clone(), bytes.clone());
        if imported {
            self.open(Scope::Import, at);
        }
        self.texts.push(OpenFile { text: Lexer::new(bytes, file), name, at, imported });
    }

    fn end_of_file(&mut self) {
        let Some(open) = self.texts.pop() else { return };
        if !open.imported {
            return;
        }
        // Restore the state that was current before the import.
        while let Some((scope, state, at)) = self.stack.pop() {
            if scope == Scope::Import {
                self.state = state;
                return;
            }
            self.report.push(Diagnostic::error("this scope is not closed").code("unclosed").at(at));
        }
    }

    fn finish(&mut self) {
        // After an error, the rest of the file may not have been read.
        if !self.report.has_errors() {
            self.check_area_light(None, None);
        }
        for (scope, _, at) in self.stack.drain(..) {
            let end = match scope {
                Scope::Attribute => "AttributeEnd",
                Scope::Transform => "TransformEnd",
                Scope::Object | Scope::Import => "ObjectEnd",
            };
            let error = Diagnostic::error("this scope is not closed").code("unclosed").at(at);
            self.report.push(error.help(format!("add the missing `{end}`")));
        }
        crate::glass_bodies::join_bodies(&mut self.scene, self.input.name);
        if self.scene.render_defaults.no_scattering.is_some() {
            crate::emitters_only::blacken(&mut self.scene);
        }
        self.make_camera();
        self.set_environment();
        if self.scene.root.is_none() && !self.report.has_errors() {
            let warning = Diagnostic::warning("the file has no visible shapes");
            self.report.push(warning.code("no-objects"));
        }
    }
}
