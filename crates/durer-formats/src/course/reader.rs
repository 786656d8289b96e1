//! State of the reader of the scene language, which consists of the tokens of a file and of what is
//! needed to recover from errors.

use super::ReadOptions;
use super::include::{IncludePreprocessor, IncludedFile, Texts};
use super::lexer::{Token, TokenKind, tokens};
use super::words::{begins_block, block_of, dialects_of, is_section};
use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_scene::dialect::{Dialect, DialectSet};
use durer_scene::scene::{Object, Scene};
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// Maximum depth of nested groups, transforms and nodes.
const MAX_DEPTH: usize = 200;

/// Named materials and objects of a scene file that is being read.
#[derive(Default)]
pub(super) struct NamedItems {
    pub materials: BTreeMap<String, u32>,
    pub objects: BTreeMap<String, (Object, usize, Span)>,
    /// Names of objects that contain errors. The errors have already been reported.
    pub invalid_objects: BTreeSet<String>,
    /// Number of objects that `use` has added so far.
    pub used_objects: usize,
}

impl NamedItems {
    /// Removes all names of materials.
    pub fn clear_materials(&mut self) {
        self.materials.clear();
    }
}

/// Recursive-descent parser for a file in the scene language.
pub(super) struct Reader<'a, 'd> {
    texts: Texts<'a>,
    tokens: Vec<Token>,
    pub at: usize,
    pub options: ReadOptions,
    pub diagnostics: &'d mut Diagnostics,
    pub scene: Scene,
    pub reported_words: HashSet<String>,
    pub depth: usize,
    /// Keywords of the blocks that are open, starting with the outermost one.
    pub blocks: Vec<Span>,
    /// Index of the token in front of which a missing `}` was reported. Only one error is reported
    /// per token, even if several blocks end there.
    pub unclosed_at: Option<usize>,
    /// True if reading has been abandoned. Errors after that point are dropped.
    stopped: bool,
    /// Material that is current for the objects that follow.
    pub material: Option<u32>,
    /// Uses of `MaterialIndex`, which are checked when the number of materials is known.
    pub material_uses: Vec<(u32, Span)>,
    /// Numbers of materials in the current solid texture, with their spans.
    pub index_spans: Vec<(u32, Span)>,
    /// Materials that solid textures use but that do not precede them: the number of the texture,
    /// the number of the material, and its span.
    pub solid_uses: Vec<(u32, u32, Span)>,
    /// Named materials and objects.
    pub named: NamedItems,
    /// Number of errors that were merged into an earlier error report.
    pub repeated: usize,
}

impl<'a, 'd> Reader<'a, 'd> {
    pub(super) fn new(
        bytes: &'a [u8],
        file: u32,
        options: ReadOptions,
        open: &dyn Fn(&str) -> IncludedFile,
        diagnostics: &'d mut Diagnostics,
    ) -> Self {
        let (mut all, mut texts) = (tokens(bytes, file), Texts::new(bytes, file));
        if options.dialect == Dialect::Durer {
            let stack = Vec::new();
            let mut splicer = IncludePreprocessor { open, texts: &mut texts, diagnostics, stack, files: 0, words: 0 };
            all = splicer.expand_includes(all);
        }
        let (comments, tokens): (Vec<Token>, Vec<Token>) = all.into_iter().partition(|t| t.kind == TokenKind::Comment);
        let mut reader = Reader {
            texts,
            tokens,
            at: 0,
            options,
            diagnostics,
            scene: Scene::default(),
            reported_words: HashSet::new(),
            depth: 0,
            blocks: Vec::new(),
            unclosed_at: None,
            stopped: false,
            material: None,
            material_uses: Vec::new(),
            index_spans: Vec::new(),
            solid_uses: Vec::new(),
            named: NamedItems::default(),
            repeated: 0,
        };
        reader.check_form(&comments);
        reader
    }

    /// Reports comments, and missing spaces, that the course's parsers reject.
    fn check_form(&mut self, comments: &[Token]) {
        if !self.options.strict {
            let slashes = comments.iter().find(|c| self.texts.at(c.span).starts_with(b"/"));
            if let Some(comment) = slashes {
                let message = "comments begin with `#`, but this comment with `//` is ignored too";
                let slashes = Span { end: comment.span.start + 2, ..comment.span };
                let warning = Diagnostic::warning(message).code("comment").at(comment.span);
                self.diagnostics.push(warning.fix(slashes, "#"));
            }
            return;
        }
        if let Some(comment) = comments.first() {
            self.error(Diagnostic::error("the course's language has no comments").at(comment.span));
        }
        // The course's parsers read a word up to the next space, but they read a number only up to
        // the first character that cannot belong to it.
        for i in 1..self.tokens.len() {
            let (before, token) = (self.tokens[i - 1], self.tokens[i]);
            let ends_number = token.kind == TokenKind::Close && self.text(before.span).parse::<f32>().is_ok();
            if token.touches && !ends_number {
                let place = if token.kind == TokenKind::Word { before } else { token };
                let side = if token.kind == TokenKind::Word { "after" } else { "before" };
                let message = format!("there must be a space {side} `{}`", self.text(place.span));
                self.error(Diagnostic::error(message).at(place.span));
            }
            if self.stopped {
                return;
            }
        }
    }

    /// Returns the scene after performing the checks that need the complete file.
    pub(super) fn finish(self) -> Scene {
        let count = self.scene.materials.len();
        let has = match count {
            0 => "the scene has no materials".to_string(),
            1 => "there is only material 0".to_string(),
            n => format!("there are materials 0 to {}", n - 1),
        };
        for (own, index, span) in &self.solid_uses {
            let error = match (*index as usize) < count {
                true => {
                    Diagnostic::error(format!("material {own} may use only earlier materials, not material {index}"))
                }
                false => Diagnostic::error(format!("material {index} does not exist: {has}")).code("material-index"),
            };
            self.diagnostics.push(error.at(*span).help("materials are numbered from 0, in file order"));
        }
        for (index, span) in self.material_uses.iter().filter(|(index, _)| *index as usize >= count) {
            let message = format!("material {index} does not exist: {has}");
            let help = "objects that use it are drawn in plain grey";
            self.diagnostics.push(Diagnostic::warning(message).code("material-index").at(*span).help(help));
        }
        self.scene
    }

    /// Returns the next token without moving past it.
    pub(super) fn peek(&self) -> Option<Token> {
        self.tokens.get(self.at).copied()
    }

    /// Returns the token that is `count` positions ahead.
    pub(super) fn ahead(&self, count: usize) -> Option<Token> {
        self.tokens.get(self.at + count).copied()
    }

    /// Returns true if the next token is `{`.
    pub(super) fn at_open(&self) -> bool {
        self.peek().is_some_and(|t| t.kind == TokenKind::Open)
    }

    /// Returns the text of the next token, if it is a word.
    pub(super) fn peek_word(&self) -> Option<String> {
        self.peek().filter(|t| t.kind == TokenKind::Word).map(|t| self.text(t.span))
    }

    /// Moves past the next token and returns its span.
    pub(super) fn advance(&mut self) -> Span {
        let span = self.peek().map_or(self.end_span(), |t| t.span);
        self.at = (self.at + 1).min(self.tokens.len());
        span
    }

    /// Moves back by one token, unless reading has been abandoned.
    pub(super) fn step_back(&mut self) {
        if !self.stopped {
            self.at -= 1;
        }
    }

    /// Returns the span of the token that was read last.
    pub(super) fn last_span(&self) -> Span {
        self.tokens.get(self.at.wrapping_sub(1)).map_or(self.end_span(), |t| t.span)
    }

    /// Returns the span of the position at the end of the file.
    pub(super) fn end_span(&self) -> Span {
        self.texts.end()
    }

    /// Returns the text that a span covers.
    pub(super) fn text(&self, span: Span) -> String {
        String::from_utf8_lossy(self.texts.at(span)).into_owned()
    }

    /// Returns the number of errors that have occurred so far. A block is checked as a whole only
    /// if it did not cause any errors.
    pub(super) fn errors(&self) -> usize {
        self.diagnostics.error_count() + self.repeated
    }

    /// Reports an error about a name only once, even if the name appears in many places.
    pub(super) fn error_once(&mut self, error: Diagnostic) {
        let known = self.diagnostics.error_count();
        if !self.stopped && !self.diagnostics.push_once(error) {
            self.repeated += 1;
        }
        if self.diagnostics.error_count() > known && self.diagnostics.is_full() {
            self.stop();
        }
    }

    /// Reports an error, unless reading has been abandoned. Abandons reading if there are too many
    /// errors.
    pub(super) fn error(&mut self, error: Diagnostic) {
        if self.stopped {
            return;
        }
        self.diagnostics.push(error);
        if self.diagnostics.is_full() {
            self.stop();
        }
    }

    /// Abandons reading the rest of the file.
    pub(super) fn stop(&mut self) {
        self.stopped = true;
        self.at = self.tokens.len();
    }

    /// Enters another level of nesting, and reports an error if the limit has been reached.
    pub(super) fn descend(&mut self, what: &str, span: Span) -> bool {
        if self.depth >= MAX_DEPTH {
            self.error(Diagnostic::error(format!("{what} are nested more than {MAX_DEPTH} levels deep")).at(span));
            self.stop();
            return false;
        }
        self.depth += 1;
        true
    }

    /// Requires the `{` of a block as the next token. If it is missing, but the next word belongs
    /// in the block, reading continues inside the block.
    pub(super) fn open(&mut self, keyword: Span) -> bool {
        let opens = self.at_open();
        let name = self.text(keyword);
        if opens {
            self.advance();
        } else {
            self.expected("`{`", &name);
        }
        let is_inside = |word: &str| !begins_block(word) || block_of(word) == Some(&name);
        let inside = self.peek_word().is_some_and(|word| dialects_of(&word).is_some() && is_inside(&word));
        if opens || inside {
            self.blocks.push(keyword);
        }
        opens || inside
    }

    /// Returns the next word inside the innermost block, or `None` at the end of the block.
    pub(super) fn word_before_close(&mut self) -> Option<(String, Span)> {
        let name = self.blocks.last().map(|&block| self.text(block)).unwrap_or_default();
        loop {
            let Some(token) = self.peek() else {
                let message = format!("the file ends inside `{name}`");
                let braces = format!("\n{}\n", "}".repeat(self.blocks.len()));
                let error = Diagnostic::error(message).code("unclosed-block").at(self.end_span());
                // After other errors, it is not known where the braces are missing.
                let error = error.fix_at((self.errors() == 0).then(|| self.end_span()), braces);
                let error = self.blocks.iter().rev().take(1).fold(error, |e, &b| e.related(b, "opened here"));
                self.error(error.label("`}` expected"));
                self.stop();
                self.blocks.pop();
                return None;
            };
            if self.at_section() {
                self.unclosed();
                return None;
            }
            self.advance();
            match token.kind {
                TokenKind::Close => {
                    self.blocks.pop();
                    return None;
                }
                TokenKind::Open => {
                    self.step_back();
                    self.skip_block();
                    self.error(Diagnostic::error(format!("`{{` without a keyword in `{name}`")).at(token.span));
                }
                _ => return Some((self.text(token.span), token.span)),
            }
        }
    }

    /// Returns true if a section begins with the next tokens. Sections are allowed only at the top
    /// level of a file.
    fn at_section(&self) -> bool {
        let block = self.ahead(1).is_some_and(|t| t.kind == TokenKind::Open);
        let word = self.peek_word().filter(|_| block).unwrap_or_default();
        match self.options.dialect {
            Dialect::F23 => matches!(word.as_str(), "Camera" | "Background" | "Materials" | "Scene"),
            // Groups are also allowed within groups, but not within the other sections.
            _ if word == "Group" => self.blocks.first().is_some_and(|&top| {
                let top = self.text(top);
                is_section(&top) && top != "Group"
            }),
            _ => is_section(&word),
        }
    }
}

/// Returns the names of the dialects that are in a set.
pub(super) fn names(set: DialectSet) -> String {
    let years: Vec<&str> = Dialect::ALL.iter().filter(|d| d.is_in(set)).map(|d| d.name()).collect();
    if years.is_empty() { "no dialect".to_string() } else { years.join(", ") }
}
