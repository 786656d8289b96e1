//! The grammar of 2003 to 2019: sections, groups, objects.

use super::ReadOptions;
use super::fields::Order;
use super::lexer::{Token, TokenKind, tokens};
use crate::camera::Camera;
use crate::describe::DescribedList;
use crate::diag::{Diagnostic, Diagnostics, Span, did_you_mean};
use crate::dialect::{DialectSet, set};
use crate::light::Light;
use crate::material::{ColorNoise, PhongMaterial, Solid};
use crate::scene::{Background, Group, Material, Node, Object, Scene, Spanned};
use crate::shape::{Primitive, TriangleMesh};
use std::borrow::Cow;
use std::collections::HashSet;

/// Groups and transforms may be nested this deep.
const DEEPEST: usize = 200;

/// A file being read.
pub(super) struct Reader<'a, 'd> {
    bytes: &'a [u8],
    tokens: Vec<Token>,
    at: usize,
    file: u32,
    pub options: ReadOptions,
    pub diagnostics: &'d mut Diagnostics,
    pub scene: Scene,
    pub foreign_seen: HashSet<String>,
    pub depth: usize,
    /// The current material, for all objects that follow.
    pub material: Option<u32>,
    /// Every `MaterialIndex`, to be checked when all materials are known.
    pub material_uses: Vec<(u32, Span)>,
}

impl<'a, 'd> Reader<'a, 'd> {
    pub(super) fn new(bytes: &'a [u8], file: u32, options: ReadOptions, diagnostics: &'d mut Diagnostics) -> Self {
        let mut all = tokens(bytes, file);
        if options.strict {
            for token in all.iter().filter(|t| t.kind == TokenKind::Comment).take(1) {
                diagnostics.push(Diagnostic::error("the course's language has no comments").at(token.span));
            }
            let glued = |t: &&Token| t.touches && t.kind == TokenKind::Open;
            for token in all.iter().filter(glued) {
                diagnostics.push(Diagnostic::error("there must be a blank before `{`").at(token.span));
            }
        }
        all.retain(|t| t.kind != TokenKind::Comment);
        Reader {
            bytes,
            tokens: all,
            at: 0,
            file,
            options,
            diagnostics,
            scene: Scene::default(),
            foreign_seen: HashSet::new(),
            depth: 0,
            material: None,
            material_uses: Vec::new(),
        }
    }

    /// What was read, with the checks that need the whole file.
    pub(super) fn finish(self) -> Scene {
        let count = self.scene.materials.len();
        for (index, span) in self.material_uses.iter().filter(|(index, _)| *index as usize >= count) {
            let has = match count {
                0 => "there are no materials".to_string(),
                1 => "there is only material 0".to_string(),
                n => format!("there are materials 0 to {}", n - 1),
            };
            let message = format!("material {index} does not exist: {has}");
            let help = "objects that use it are drawn in plain grey";
            self.diagnostics.push(Diagnostic::warning(message).at(*span).help(help));
        }
        self.scene
    }

    pub(super) fn peek(&self) -> Option<Token> {
        self.tokens.get(self.at).copied()
    }

    /// The token so many further on.
    pub(super) fn ahead(&self, count: usize) -> Option<Token> {
        self.tokens.get(self.at + count).copied()
    }

    /// Goes to the next token and gives the place of this one.
    pub(super) fn advance(&mut self) -> Span {
        let span = self.peek().map_or(self.end_span(), |t| t.span);
        self.at += 1;
        span
    }

    pub(super) fn last_span(&self) -> Span {
        self.tokens.get(self.at.wrapping_sub(1)).map_or(self.end_span(), |t| t.span)
    }

    pub(super) fn end_span(&self) -> Span {
        let end = self.bytes.len() as u32;
        Span { file: self.file, start: end, end }
    }

    pub(super) fn text(&self, span: Span) -> String {
        let text: Cow<str> = String::from_utf8_lossy(&self.bytes[span.start as usize..span.end as usize]);
        text.into_owned()
    }

    /// Reports an error; after too many, the rest of the file is passed over.
    pub(super) fn error(&mut self, error: Diagnostic) {
        self.diagnostics.push(error);
        if self.diagnostics.is_full() {
            self.at = self.tokens.len();
        }
    }

    /// Expects `{`.
    pub(super) fn open(&mut self, after: &str) -> bool {
        let open = self.peek().is_some_and(|t| t.kind == TokenKind::Open);
        if open {
            self.advance();
        } else {
            self.expected("`{`", after);
        }
        open
    }

    /// The next word inside a block; `None` after its end.
    pub(super) fn word_before_close(&mut self, block: &str) -> Option<(String, Span)> {
        loop {
            let Some(token) = self.peek() else {
                if !self.diagnostics.is_full() {
                    let message = format!("the file ends inside `{block}`");
                    let end = self.end_span();
                    self.error(Diagnostic::error(message).at(end).label("`}` expected"));
                }
                return None;
            };
            self.advance();
            match token.kind {
                TokenKind::Close => return None,
                TokenKind::Open => {
                    self.error(Diagnostic::error(format!("`{{` without a keyword in `{block}`")).at(token.span));
                    self.at -= 1;
                    self.skip_block();
                }
                _ => return Some((self.text(token.span), token.span)),
            }
        }
    }

    /// Passes over `{ ... }` with all that is nested in it.
    pub(super) fn skip_block(&mut self) {
        let mut depth = 0usize;
        while let Some(token) = self.peek() {
            match token.kind {
                TokenKind::Open => depth += 1,
                TokenKind::Close => depth = depth.saturating_sub(1),
                _ => {}
            }
            self.advance();
            if depth == 0 {
                return;
            }
        }
    }

    /// Reports a word that means nothing here, and passes over it, its values and its block.
    pub(super) fn unknown(&mut self, word: &str, span: Span, place: &str, known: &[&str]) {
        let error = Diagnostic::error(format!("`{word}` means nothing {place}")).at(span).label("not known here");
        let error = match did_you_mean(word, known.iter().copied()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(format!("known here: {}", known.join(", "))),
        };
        self.error(error);
        while let Some(token) = self.peek() {
            match token.kind {
                TokenKind::Close => return,
                TokenKind::Open => return self.skip_block(),
                _ if known.contains(&self.text(token.span).as_str()) => return,
                _ => {
                    self.advance();
                }
            }
        }
    }

    /// The whole file.
    pub(super) fn scene_file(&mut self) {
        const SECTIONS: [&str; 6] =
            ["PerspectiveCamera", "OrthographicCamera", "Background", "Lights", "Materials", "Group"];
        while let Some(token) = self.peek() {
            self.advance();
            let (word, span) = (self.text(token.span), token.span);
            match word.as_str() {
                "Background" => self.background(span),
                "Lights" => self.lights(span),
                "Materials" => self.materials(span),
                "Group" => self.scene.root = Some(self.group(span)),
                _ => match Camera::from_keyword(&word).filter(|_| word != "Camera") {
                    Some(camera) => self.camera(camera, span),
                    None if token.kind != TokenKind::Word => {
                        self.error(Diagnostic::error(format!("`{word}` without a keyword")).at(span));
                        if token.kind == TokenKind::Open {
                            self.at -= 1;
                            self.skip_block();
                        }
                    }
                    None => self.unknown(&word, span, "at the top of a scene", &SECTIONS),
                },
            }
        }
    }

    pub(super) fn camera(&mut self, mut camera: Camera, keyword: Span) {
        self.check_keyword(&camera, keyword);
        self.fields(&mut camera, keyword, Order::Listed, |_, _, _| false);
        self.scene.camera = Some(camera);
        self.scene.camera_span = keyword;
    }

    pub(super) fn background(&mut self, keyword: Span) {
        let mut background = Background::default();
        self.fields(&mut background, keyword, Order::Any, |_, _, _| false);
        self.scene.background = background;
    }

    /// Warns of a keyword that this dialect does not have.
    pub(super) fn check_keyword<T: DescribedList>(&mut self, thing: &T, keyword: Span) {
        let word = self.text(keyword);
        let set = thing.keywords().iter().find(|(w, _)| *w == word).map_or(0, |k| k.1);
        self.foreign(&word, keyword, set);
    }

    /// Reads `{ count n element ... }`: the elements and their number, which must agree.
    fn counted(&mut self, keyword: Span, count_words: &[&str], mut element: impl FnMut(&mut Self, &str, Span) -> bool) {
        let name = self.text(keyword);
        if !self.open(&name) {
            return;
        }
        let (mut count, mut found) = (None, 0u32);
        while let Some((word, span)) = self.word_before_close(&name) {
            if count_words.contains(&word.as_str()) {
                count = self.whole(&word).map(|n| (n, span.to(self.last_span())));
            } else if element(self, &word, span) {
                found += 1;
            }
        }
        match count {
            Some((n, span)) if n != found && !self.diagnostics.has_errors() => {
                let message = format!("`{}` says {n}, but {found} follow", count_words[0]);
                self.error(Diagnostic::error(message).at(span).help(format!("write `{} {found}`", count_words[0])));
            }
            None if self.options.strict => {
                self.error(Diagnostic::error(format!("`{name}` has no `{}`", count_words[0])).at(keyword));
            }
            _ => {}
        }
    }

    fn lights(&mut self, keyword: Span) {
        let mut lights = Vec::new();
        self.counted(keyword, &["numLights"], |reader, word, span| {
            let light = Light::from_keyword(word).filter(|_| word.ends_with("Light"));
            let Some(mut light) = light else {
                reader.unknown(word, span, "among lights", &["DirectionalLight", "PointLight"]);
                return false;
            };
            reader.check_keyword(&light, span);
            reader.fields(&mut light, span, Order::Any, |_, _, _| false);
            lights.push(Spanned { value: light, span });
            true
        });
        self.scene.lights = Some(lights);
    }

    fn materials(&mut self, keyword: Span) {
        if let (Some(_), true) = (&self.scene.root, self.options.strict) {
            self.error(Diagnostic::error("`Materials` must come before `Group`").at(keyword));
        }
        self.scene.materials.clear();
        self.counted(keyword, &["numMaterials"], |reader, word, span| {
            let Some(value) = reader.material(word, span) else { return false };
            reader.scene.materials.push(Spanned { value, span });
            true
        });
    }

    /// One material, if the word begins one.
    pub(super) fn material(&mut self, word: &str, span: Span) -> Option<Material> {
        if let Some(mut solid) = Solid::from_keyword(word) {
            self.check_keyword(&solid, span);
            let mut transform = Vec::new();
            self.fields(&mut solid, span, Order::Listed, |reader, word, _| {
                let known = word == "Transform";
                if known && reader.open(word) {
                    transform = reader.matrices(word);
                }
                known
            });
            self.check_solid(&solid, span);
            return Some(Material::Solid(solid, transform));
        }
        let Some(mut phong) = PhongMaterial::from_keyword(word) else {
            let known = ["PhongMaterial", "Material", "Checkerboard", "Noise", "Marble", "Wood"];
            self.unknown(word, span, "among materials", &known);
            return None;
        };
        let mut noise = None;
        self.fields(&mut phong, span, Order::Any, |reader, word, span| {
            let known = word == "Noise";
            if known {
                let mut colors = ColorNoise::default();
                reader.check_keyword(&colors, span);
                reader.fields(&mut colors, span, Order::Any, |_, _, _| false);
                noise = Some(colors);
            }
            known
        });
        Some(Material::Phong(Box::new(phong), noise))
    }

    /// A solid may only be made of earlier materials, so that there is no circle.
    fn check_solid(&mut self, solid: &Solid, span: Span) {
        let own = self.scene.materials.len() as u32;
        for index in crate::material::Pattern::materials(solid) {
            if index >= own {
                let message = format!("a solid material is made of earlier ones, but {index} is not before {own}");
                self.error(Diagnostic::error(message).at(span));
            }
        }
    }

    pub(super) fn group(&mut self, keyword: Span) -> Group {
        let mut objects = Vec::new();
        self.counted(keyword, &["numObjects", "num_objects"], |reader, word, span| {
            match word {
                "MaterialIndex" => {
                    let index = reader.whole(word);
                    if let Some(index) = index {
                        reader.material = Some(index);
                        reader.material_uses.push((index, span.to(reader.last_span())));
                    }
                    return false;
                }
                // 2003 writes materials where they are used.
                "Material" | "PhongMaterial" => {
                    reader.foreign("Material in Group", span, set::F03);
                    if let Some(value) = reader.material(word, span) {
                        reader.material = Some(reader.scene.materials.len() as u32);
                        reader.scene.materials.push(Spanned { value, span });
                    }
                    return false;
                }
                _ => {}
            }
            match reader.object(word, span) {
                Some(object) => objects.push(object),
                None => return false,
            }
            true
        });
        Group { objects }
    }

    /// One object, if the word begins one.
    pub(super) fn object(&mut self, word: &str, span: Span) -> Option<Object> {
        const KNOWN: [&str; 6] = ["Group", "Transform", "Sphere", "Plane", "Triangle", "TriangleMesh"];
        if self.depth >= DEEPEST {
            self.error(Diagnostic::error(format!("objects are nested deeper than {DEEPEST}")).at(span));
            self.at = self.tokens.len();
            return None;
        }
        self.depth += 1;
        // What is current now belongs to the object; inside a group it may change.
        let material = self.material;
        let classic = |words: &[(&str, DialectSet)]| words.iter().any(|(w, s)| *w == word && s & set::CLASSIC != 0);
        let node = if word == "Group" {
            Some(Node::Group(self.group(span)))
        } else if word == "Transform" {
            self.transform(span)
        } else if let Some(mut shape) = Primitive::from_keyword(word).filter(|s| classic(s.keywords())) {
            self.fields(&mut shape, span, Order::Listed, |_, _, _| false);
            Some(Node::Primitive(shape))
        } else if word == "TriangleMesh" {
            let mut mesh = TriangleMesh::default();
            self.fields(&mut mesh, span, Order::Listed, |_, _, _| false);
            Some(Node::Mesh(mesh))
        } else {
            self.unknown(word, span, "among objects", &KNOWN);
            None
        };
        self.depth -= 1;
        node.map(|node| Object { node, material, span })
    }
}
