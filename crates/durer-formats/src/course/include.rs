//! `include FILE`: the text of another file in place of these two words.

use super::lexer::{Token, TokenKind, tokens};
use durer_diag::{Diagnostic, Diagnostics, Files, Span};
use durer_scene::source::{AssetSource, SourceError};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// Files in files, files in all, and words of all files.
const DEEPEST: usize = 32;
const MAX_FILES: usize = 4096;
const MAX_WORDS: usize = 1 << 26;

/// What became of a file that is included.
#[derive(Debug)]
pub enum Opened {
    /// Its number for spans, and its bytes.
    Text(u32, Arc<[u8]>),
    /// It cannot be read.
    Failed(SourceError),
    /// The scene is in no folder.
    Nowhere,
}

/// Finds what is included below a folder, and numbers it.
pub fn below<'a>(source: &'a dyn AssetSource, files: &'a RefCell<Files>) -> impl Fn(&str) -> Opened + 'a {
    move |name| match source.read(name) {
        Ok(bytes) => Opened::Text(files.borrow_mut().add_once(name, &bytes), bytes),
        Err(error) => Opened::Failed(error),
    }
}

/// The texts of a scene: its own, and those that it includes.
pub(super) struct Texts<'a> {
    own: (u32, &'a [u8]),
    others: HashMap<u32, Arc<[u8]>>,
}

impl<'a> Texts<'a> {
    pub fn new(bytes: &'a [u8], file: u32) -> Self {
        Texts { own: (file, bytes), others: HashMap::new() }
    }

    /// The bytes at a place.
    pub fn at(&self, span: Span) -> &[u8] {
        let other = self.others.get(&span.file).filter(|_| span.file != self.own.0);
        let bytes = other.map_or(self.own.1, |bytes| bytes);
        &bytes[span.start as usize..span.end as usize]
    }

    /// The end of the scene's own text.
    pub fn end(&self) -> Span {
        let end = self.own.1.len() as u32;
        Span { file: self.own.0, start: end, end }
    }
}

/// Puts the words of files in the place of the words that include them.
pub(super) struct Splicer<'o, 't, 'a> {
    pub open: &'o dyn Fn(&str) -> Opened,
    pub texts: &'t mut Texts<'a>,
    pub diagnostics: &'t mut Diagnostics,
    /// Names of the files that are being read.
    pub stack: Vec<String>,
    pub files: usize,
    pub words: usize,
}

impl Splicer<'_, '_, '_> {
    pub fn splice(&mut self, written: Vec<Token>) -> Vec<Token> {
        let is_include =
            |texts: &Texts, token: &Token| token.kind == TokenKind::Word && texts.at(token.span) == b"include";
        if !written.iter().any(|token| is_include(self.texts, token)) {
            return written;
        }
        let (mut all, mut rest) = (Vec::new(), written.into_iter().peekable());
        while let Some(token) = rest.next() {
            if !is_include(self.texts, &token) {
                all.push(token);
                continue;
            }
            // A comment may stand before the name.
            while rest.next_if(|next| next.kind == TokenKind::Comment).is_some() {}
            match rest.next_if(|next| next.kind == TokenKind::Word) {
                Some(name) => all.extend(self.file(token.span, name.span)),
                None => {
                    let error = Diagnostic::error("`include` needs the name of a file").code("missing-value");
                    self.diagnostics.push(error.at(token.span).help("as in `include lamp.txt`"));
                }
            }
        }
        all
    }

    /// The words of a file.
    fn file(&mut self, keyword: Span, at: Span) -> Vec<Token> {
        let name = String::from_utf8_lossy(self.texts.at(at)).into_owned();
        self.files += 1;
        let refused = match () {
            () if self.stack.contains(&name) => Some(format!("`{name}` includes itself")),
            () if self.stack.len() >= DEEPEST => Some(format!("files include each other more than {DEEPEST} deep")),
            () if self.files > MAX_FILES => Some(format!("more than {MAX_FILES} files are too many")),
            () if self.words > MAX_WORDS => Some("all files together have too many words".to_string()),
            () => None,
        };
        if let Some(message) = refused {
            // One complaint of many files is enough.
            if self.files <= MAX_FILES + 1 {
                self.diagnostics.push(Diagnostic::error(message).code("include").at(keyword.to(at)));
            }
            return Vec::new();
        }
        let (number, bytes) = match (self.open)(&name) {
            Opened::Text(number, bytes) => (number, bytes),
            Opened::Failed(error) => {
                let help = error.help();
                let error = Diagnostic::error(error.to_string()).code("missing-file").at(at);
                self.diagnostics.push(Diagnostic { help, ..error });
                return Vec::new();
            }
            Opened::Nowhere => {
                let message = "this text is in no folder: it includes no files";
                self.diagnostics.push(Diagnostic::error(message).code("include").at(keyword.to(at)));
                return Vec::new();
            }
        };
        if let Some(problem) = super::no_text(&bytes) {
            let start = Span { file: number, start: 0, end: 0 };
            let error = Diagnostic::error(problem).code("syntax").at(start);
            self.diagnostics.push(error.related(at, "included here"));
            return Vec::new();
        }
        let written = tokens(&bytes, number);
        self.words += written.len();
        if !self.is_balanced(&written, at) {
            return Vec::new();
        }
        self.texts.others.insert(number, bytes);
        self.stack.push(name);
        let all = self.splice(written);
        self.stack.pop();
        all
    }

    /// Whether a file closes all blocks that it opens, and no others.
    fn is_balanced(&mut self, written: &[Token], included: Span) -> bool {
        let mut open: Vec<Span> = Vec::new();
        let mut wrong = None;
        for token in written {
            match token.kind {
                TokenKind::Open => open.push(token.span),
                TokenKind::Close if open.pop().is_none() => {
                    wrong = Some((token.span, "this `}` closes nothing in its file"));
                    break;
                }
                _ => {}
            }
        }
        let wrong = wrong.or(open.pop().map(|span| (span, "this block is not closed in its file")));
        if let Some((span, message)) = wrong {
            let error = Diagnostic::error(message).code("unclosed-block").at(span);
            self.diagnostics.push(error.related(included, "included here"));
        }
        wrong.is_none()
    }
}
