//! The directives, one after the other.

use super::language::Language;
use super::lexer::{Lexer, Token};
use super::params::read as read_params;
use super::state::{Asked, Open, Reader, Scope};
use super::transform::{look_at, matrix, numbers, rotation, sound};
use crate::said::meant;
use durer_diag::{Diagnostic, Span};
use durer_scene::scene::{Node, Object, Scene};
use durer_scene::source::SourceError;
use durer_scene::spectrum::space::RgbSpace;
use glam::{DAffine3, DVec3};
use std::rc::Rc;

/// All directives, and whether a string follows them.
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
    // Of pbrt-v3 and before.
    ("WorldEnd", false),
    ("SurfaceIntegrator", true),
    ("VolumeIntegrator", true),
    ("Renderer", true),
];

/// Directives of the world, and of what comes before it.
const OF_WORLD: [&str; 10] = [
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

/// What `Attribute` may be said of, in the order of [`State::given`](super::state::State).
const TARGETS: [&str; 5] = ["shape", "light", "material", "medium", "texture"];

/// Files that are included, files in files, and scopes in scopes.
const MAX_FILES: usize = 1 << 16;
const DEEPEST_FILES: usize = 64;
const DEEPEST_SCOPES: usize = 1 << 12;

impl Reader<'_> {
    /// The scene, if nothing is wrong with it.
    pub fn read(mut self) -> Scene {
        while !self.said.is_full() {
            let said = self.said;
            let Some(open) = self.texts.last_mut() else { break };
            let Some(found) = open.text.next(said) else {
                self.end_of_file();
                continue;
            };
            if found.token != Token::Word {
                let message = match found.token {
                    Token::Open | Token::Close => "a bracket stands here, and no parameter before it".to_string(),
                    _ => "a string stands here, and no directive before it".to_string(),
                };
                said.bad(found.at, message);
                self.skip();
                continue;
            }
            let word = open.text.word(found.at).to_string();
            if !DIRECTIVES.iter().any(|row| row.0 == word) {
                let shown = open.text.shown(found.at);
                let help = meant(&word, DIRECTIVES.iter().map(|row| row.0));
                let error = Diagnostic::error(format!("unknown directive {shown}")).code("unknown-word").at(found.at);
                said.push(Diagnostic { help, ..error });
                self.skip();
                continue;
            }
            if self.directive(&word, found.at).is_none() {
                self.skip();
            }
        }
        if !self.said.is_full() {
            self.finish();
        }
        self.scene
    }

    fn text(&mut self) -> &mut Lexer {
        // A directive is only read while a file is open.
        let last = self.texts.len() - 1;
        &mut self.texts[last].text
    }

    /// Goes on to the next word that is a directive.
    fn skip(&mut self) {
        let said = self.said;
        let text = self.text();
        while let Some(found) = text.peek(said) {
            let at = found.at;
            if found.token == Token::Word && DIRECTIVES.iter().any(|row| row.0 == text.word(at)) {
                break;
            }
            text.next(said);
        }
    }

    /// The string after a directive.
    fn name(&mut self, directive: Span) -> Option<(String, Span)> {
        let said = self.said;
        let text = self.text();
        if let Some(found) = text.peek(said)
            && let Token::Text(name) = &found.token
        {
            let named = (name.clone(), found.at);
            text.next(said);
            return Some(named);
        }
        let message = format!("{} needs a string in quotes after it", text.shown(directive));
        said.bad(directive, message);
        None
    }

    fn numbers<const N: usize>(&mut self, directive: Span) -> Option<[f64; N]> {
        let said = self.said;
        numbers(self.text(), directive, said)
    }

    /// Does what a directive says; `None` where it cannot be read to its end.
    fn directive(&mut self, word: &str, at: Span) -> Option<()> {
        let said = self.said;
        if !self.in_world && OF_WORLD.contains(&word) {
            self.early.get_or_insert(at);
        }
        if self.in_world && BEFORE_WORLD.contains(&word) {
            said.bad(at, format!("`{word}` must stand before `WorldBegin`"));
        }
        match word {
            "Identity" => self.state.transforms.change(|_| DAffine3::IDENTITY),
            "Translate" => {
                let [x, y, z] = self.numbers(at)?;
                self.state.transforms.apply(DAffine3::from_translation(DVec3::new(x, y, z)));
            }
            "Scale" => {
                let [x, y, z] = self.numbers(at)?;
                let map = sound(DAffine3::from_scale(DVec3::new(x, y, z)), at, said);
                map.into_iter().for_each(|map| self.state.transforms.apply(map));
            }
            "Rotate" => match rotation(self.numbers(at)?) {
                Some(map) => self.state.transforms.apply(map),
                None => said.bad(at, "the axis of a rotation must not be 0 0 0"),
            },
            "LookAt" => match look_at(self.numbers(at)?) {
                Some(map) => self.state.transforms.apply(map),
                None => said.bad(at, "a camera cannot look at where it is, nor along its way up"),
            },
            "Transform" | "ConcatTransform" => {
                let map = matrix(self.numbers(at)?, at, said);
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
            "WorldEnd" if self.language == Language::Third => {}
            "WorldEnd" => said.once(at, "`WorldEnd` is of pbrt-v3 and means nothing"),
            "ObjectEnd" => self.close(Scope::Object, at),
            _ => return self.named(word, at),
        }
        Some(())
    }

    /// A directive after which a string stands.
    fn named(&mut self, word: &str, at: Span) -> Option<()> {
        let (said, language) = (self.said, self.language);
        let (name, name_at) = self.name(at)?;
        match word {
            "CoordinateSystem" => _ = self.systems.insert(name, self.state.transforms.maps),
            "CoordSysTransform" => match self.systems.get(&name) {
                Some(maps) => self.state.transforms.maps = *maps,
                None => {
                    let help = meant(&name, self.systems.keys().map(String::as_str));
                    said.bad_with(name_at, format!("there is no coordinate system `{name}`"), help);
                }
            },
            "ColorSpace" => match RgbSpace::named(&name) {
                Some(space) => self.state.space = space,
                None => {
                    let help = meant(&name, RgbSpace::names());
                    said.bad_with(name_at, format!("there is no space of colours `{name}`"), help);
                }
            },
            "Include" | "Import" => self.include(name, name_at, word == "Import"),
            "ObjectBegin" => self.object_begin(name, at),
            "ObjectInstance" => self.instance(&name, name_at),
            "NamedMaterial" => self.named_material(&name, name_at),
            "MediumInterface" => {
                let second = matches!(self.text().peek(said).map(|next| &next.token), Some(Token::Text(_)));
                let outside = if second { self.name(at)?.0 } else { name.clone() };
                self.medium_interface(&[name, outside], name_at);
            }
            "Option" => self.skip_value(),
            "Texture" => {
                let (kind, kind_at) = self.name(at)?;
                let (class, class_at) = self.name(at)?;
                let list = read_params(self.text(), language, said);
                self.texture(name, (&kind, kind_at), (&class, class_at), list);
            }
            _ => {
                let list = read_params(self.text(), language, said);
                self.with_params(word, name, name_at, list);
            }
        }
        Some(())
    }

    /// A directive with a string and parameters.
    fn with_params(&mut self, word: &str, name: String, at: Span, list: Vec<Rc<super::params::Param>>) {
        let keep = |reader: &Self, list| {
            let (transforms, space) = (reader.state.transforms, reader.state.space);
            Asked { kind: name.clone(), list, at, transforms, space }
        };
        match word {
            "Attribute" => match TARGETS.iter().position(|target| *target == name) {
                Some(target) => {
                    // What is said later counts.
                    let given = &mut self.state.given[target];
                    given.retain(|old| list.iter().all(|new| new.name != old.name));
                    given.extend(list);
                }
                None => {
                    let help = meant(&name, TARGETS);
                    self.said.bad_with(at, format!("`Attribute` knows no `{name}`"), help);
                }
            },
            "Camera" => {
                let maps = self.state.transforms.maps.map(|map| map.inverse());
                self.systems.insert("camera".into(), maps);
                self.camera = Some(keep(self, list));
                self.fog(at);
            }
            "Film" => self.film = Some(keep(self, list)),
            "Integrator" | "SurfaceIntegrator" => self.integrator(&keep(self, list)),
            "Sampler" => self.sampler(&keep(self, list)),
            "LightSource" => self.light(&name, at, list),
            "AreaLightSource" => self.area_light(&name, at, list),
            "Material" => self.state.material = self.material(&name, at, list),
            "MakeNamedMaterial" => self.make_named_material(name, at, list),
            "MakeNamedMedium" => self.make_named_medium(name, at, list),
            "Shape" => self.shape(&name, at, list),
            // What finds hits and how pixels are weighed is ours.
            _ => {}
        }
    }

    /// The value of an `Option`, whose string is the parameter: it says nothing here.
    fn skip_value(&mut self) {
        let said = self.said;
        let text = self.text();
        if text.next(said).is_some_and(|found| found.token == Token::Open) {
            while text.next(said).is_some_and(|found| found.token != Token::Close) {}
        }
    }

    fn active(&mut self, at: Span) -> Option<()> {
        let said = self.said;
        let text = self.text();
        let found = text.peek(said).filter(|found| found.token == Token::Word).cloned();
        let active = found.as_ref().and_then(|found| match text.word(found.at) {
            "All" => Some([true, true]),
            "StartTime" => Some([true, false]),
            "EndTime" => Some([false, true]),
            _ => None,
        });
        if active.is_none() {
            said.bad(at, "`ActiveTransform` needs `All`, `StartTime` or `EndTime` after it");
            return None;
        }
        text.next(said);
        self.state.transforms.active = active?;
        Some(())
    }

    fn world_begin(&mut self, at: Span) {
        if self.in_world {
            self.said.bad(at, "the world begins twice");
        }
        if let Some(early) = self.early {
            let error = Diagnostic::error("this must stand after `WorldBegin`").code("bad-place").at(early);
            self.said.push(error.related(at, "which is here"));
        }
        self.in_world = true;
        self.state.transforms = super::transform::Transforms::default();
        self.systems.insert("world".into(), self.state.transforms.maps);
    }

    fn open(&mut self, scope: Scope, at: Span) {
        if self.stack.len() >= DEEPEST_SCOPES {
            self.said.bad(at, format!("scopes are nested more than {DEEPEST_SCOPES} deep"));
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
                let error =
                    Diagnostic::error(format!("`{end}` closes what is not open: something else was opened last"));
                self.said.push(error.code("unclosed").at(at).related(*begun, "this is still open"));
                return;
            }
            _ => {
                let error = Diagnostic::error(format!("`{end}` closes nothing: nothing is open"));
                return self.said.push(error.code("unclosed").at(at));
            }
        }
        let Some((_, state, _)) = self.stack.pop() else { return };
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
            return self.said.bad(at, "objects cannot be defined inside objects");
        }
        self.open(Scope::Object, at);
        self.defining = Some((name, Default::default()));
    }

    fn instance(&mut self, name: &str, at: Span) {
        if self.defining.is_some() {
            return self.said.bad(at, "objects cannot be shown inside objects: `ObjectEnd` must come first");
        }
        let Some(group) = self.objects.get(name).cloned() else {
            let help = meant(name, self.objects.keys().map(String::as_str));
            return self.said.bad_with(at, format!("there is no object `{name}`"), help);
        };
        if !self.growth.has_objects(group.objects.len() + 1, self.said, at) {
            return;
        }
        let inner = Object { node: Node::Group((*group).clone()), material: None, span: at };
        let object = inner.placed(self.map(at));
        self.add(object);
    }

    /// Begins with a file that is asked for.
    fn include(&mut self, name: String, at: Span, imported: bool) {
        if let Some(open) = self.texts.iter().find(|open| open.name == name) {
            let error = Diagnostic::error(format!("`{name}` includes itself")).code("bad-value").at(at);
            let own = open.at.start == 0 && open.at.end == 0;
            return self.said.push(if own { error } else { error.related(open.at, "it is asked for here first") });
        }
        self.included += 1;
        if self.included > MAX_FILES {
            return self.said.bad(at, format!("more than {MAX_FILES} files are too many"));
        }
        if self.texts.len() >= DEEPEST_FILES {
            return self.said.bad(at, format!("files include each other more than {DEEPEST_FILES} deep"));
        }
        let bytes = match self.input.source.read_unpacked(&name) {
            Ok(bytes) => bytes,
            Err(error) => {
                let near = match &error {
                    SourceError::Missing { near: Some(near), .. } => Some(format!("did you mean `{near}`?")),
                    _ => None,
                };
                let missing = Diagnostic::error(format!("{error}")).code("missing-file").at(at);
                return self.said.push(Diagnostic { help: near, ..missing });
            }
        };
        if bytes.len() >= u32::MAX as usize {
            return self.said.bad(at, format!("`{name}` is too large"));
        }
        let file = self.input.files.borrow_mut().add(name.clone(), bytes.clone());
        if imported {
            self.open(Scope::Import, at);
        }
        self.texts.push(Open { text: Lexer::new(bytes, file), name, at, imported });
    }

    fn end_of_file(&mut self) {
        let Some(open) = self.texts.pop() else { return };
        if !open.imported {
            return;
        }
        // What an imported file changed is forgotten.
        while let Some((scope, state, at)) = self.stack.pop() {
            if scope == Scope::Import {
                self.state = state;
                return;
            }
            self.said.push(Diagnostic::error("this is not closed").code("unclosed").at(at));
        }
    }

    fn finish(&mut self) {
        for (scope, _, at) in self.stack.drain(..) {
            let end = match scope {
                Scope::Attribute => "AttributeEnd",
                Scope::Transform => "TransformEnd",
                Scope::Object | Scope::Import => "ObjectEnd",
            };
            let error = Diagnostic::error("this is not closed").code("unclosed").at(at);
            self.said.push(error.help(format!("a `{end}` is missing")));
        }
        crate::bodies::join_bodies(&mut self.scene, self.input.name);
        if self.emitters_only {
            crate::unscattered::blacken(&mut self.scene);
        }
        self.frame();
        self.surround();
        if self.scene.root.is_none() && !self.said.has_errors() {
            let warning = Diagnostic::warning("the file has no shapes that can be shown");
            self.said.push(warning.code("no-objects"));
        }
    }
}
