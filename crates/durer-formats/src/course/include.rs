//! Handles `include FILE`, which is replaced with the text of another file.

use super::lexer::{Token, TokenKind, tokens};
use durer_diag::{Diagnostic, Diagnostics, Files, Span};
use durer_scene::source::{AssetSource, SourceError};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// Limits on the depth of nested includes, on the number of included files, and on the total number
/// of words in all files.
const MAX_INCLUDE_DEPTH: usize = 32;
const MAX_FILES: usize = 4096;
const MAX_WORDS: usize = 1 << 26;

/// Result of opening a file that a scene file includes.
#[derive(Debug)]
pub enum IncludedFile {
    /// Index of the file for use in spans, and the bytes of the file.
    Text(u32, Arc<[u8]>),
    /// The file cannot be read.
    Failed(SourceError),
    /// The scene is not in a folder, so it cannot include any files.
    NoFolder,
}

/// Returns a function that opens included files in a folder or below it, and registers them.
pub fn open_below<'a>(source: &'a dyn AssetSource, files: &'a RefCell<Files>) -> impl Fn(&str) -> IncludedFile + 'a {
    move |name| match source.read(name) {
        Ok(bytes) => IncludedFile::Text(files.borrow_mut().add_once(name, &bytes), bytes),
        Err(error) => IncludedFile::Failed(error),
    }
}

/// Texts of a scene in which spans can be looked up: the scene's own file and the files that it
/// includes.
pub(super) struct Texts<'a> {
    own: (u32, &'a [u8]),
    others: HashMap<u32, Arc<[u8]>>,
}

impl<'a> Texts<'a> {
    pub fn new(bytes: &'a [u8], file: u32) -> Self {
        Texts { own: (file, bytes), others: HashMap::new() }
    }

    /// Returns the bytes that a span covers.
    pub fn at(&self, span: Span) -> &[u8] {
        let other = self.others.get(&span.file).filter(|_| span.file != self.own.0);
        let bytes = other.map_or(self.own.1, |bytes| bytes);
        &bytes[span.start as usize..span.end as usize]
    }

    /// Returns the position of the end of the scene's own text.
    pub fn end(&self) -> Span {
        let end = self.own.1.len() as u32;
        Span { file: self.own.0, start: end, end }
    }
}

/// Preprocessor that replaces each `include` in a list of tokens with the tokens of the file that
/// it names.
pub(super) struct IncludePreprocessor<'o, 't, 'a> {
    pub open: &'o dyn Fn(&str) -> IncludedFile,
    pub texts: &'t mut Texts<'a>,
    pub diagnostics: &'t mut Diagnostics,
    /// Names of the files that are being read, starting with the outermost one.
    pub stack: Vec<String>,
    pub files: usize,
    pub words: usize,
}

impl IncludePreprocessor<'_, '_, '_> {
    /// Returns the tokens after replacing each `include` with the tokens of its file.
    pub fn expand_includes(&mut self, tokens: Vec<Token>) -> Vec<Token> {
        let is_include =
            |texts: &Texts, token: &Token| token.kind == TokenKind::Word && texts.at(token.span) == b"include";
        if !tokens.iter().any(|token| is_include(self.texts, token)) {
            return tokens;
        }
        let (mut all, mut rest) = (Vec::new(), tokens.into_iter().peekable());
        while let Some(token) = rest.next() {
            if !is_include(self.texts, &token) {
                all.push(token);
                continue;
            }
            // A comment can come before the name.
            while rest.next_if(|next| next.kind == TokenKind::Comment).is_some() {}
            match rest.next_if(|next| next.kind == TokenKind::Word) {
                Some(name) => all.extend(self.file(token.span, name.span)),
                None => {
                    let error = Diagnostic::error("`include` needs the name of a file").code("missing-value");
                    self.diagnostics.push(error.at(token.span).help("for example `include light.txt`"));
                }
            }
        }
        all
    }

    /// Returns the tokens of an included file.
    fn file(&mut self, keyword: Span, at: Span) -> Vec<Token> {
        let name = String::from_utf8_lossy(self.texts.at(at)).into_owned();
        self.files += 1;
        let refused = match () {
            () if self.stack.contains(&name) => Some(format!("`{name}` includes itself")),
            () if self.stack.len() >= MAX_INCLUDE_DEPTH => {
                Some(format!("includes are nested more than {MAX_INCLUDE_DEPTH} levels deep"))
            }
            () if self.files > MAX_FILES => Some(format!("more than {MAX_FILES} files are included")),
            () if self.words > MAX_WORDS => Some("the scene and its included files have too many words".to_string()),
            () => None,
        };
        if let Some(message) = refused {
            // Report only once that there are too many files.
            if self.files <= MAX_FILES + 1 {
                self.diagnostics.push(Diagnostic::error(message).code("include").at(keyword.join(at)));
            }
            return Vec::new();
        }
        let (number, bytes) = match (self.open)(&name) {
            IncludedFile::Text(number, bytes) => (number, bytes),
            IncludedFile::Failed(error) => {
                let help = error.help();
                let error = Diagnostic::error(error.to_string()).code("missing-file").at(at);
                self.diagnostics.push(Diagnostic { help, ..error });
                return Vec::new();
            }
            IncludedFile::NoFolder => {
                let message = "a scene that is not stored in a folder cannot include files";
                self.diagnostics.push(Diagnostic::error(message).code("include").at(keyword.join(at)));
                return Vec::new();
            }
        };
        // The stack does not contain the scene itself because its name is not known here.
        if bytes[..] == *self.texts.own.1 {
            let error = Diagnostic::error(format!("`{name}` includes itself")).code("include");
            self.diagnostics.push(error.at(keyword.join(at)));
            return Vec::new();
        }
        if let Some(problem) = super::not_text_reason(&bytes) {
            let start = Span { file: number, start: 0, end: 0 };
            let error = Diagnostic::error(problem).code("syntax").at(start);
            self.diagnostics.push(error.related(at, "included here"));
            return Vec::new();
        }
        let tokens = tokens(&bytes, number);
        self.words += tokens.len();
        if !self.is_balanced(&tokens, at) {
            return Vec::new();
        }
        self.texts.others.insert(number, bytes);
        self.stack.push(name);
        let all = self.expand_includes(tokens);
        self.stack.pop();
        all
    }

    /// Returns true if the braces of an included file are balanced, and otherwise reports an error.
    fn is_balanced(&mut self, tokens: &[Token], included: Span) -> bool {
        let mut open: Vec<Span> = Vec::new();
        let mut wrong = None;
        for token in tokens {
            match token.kind {
                TokenKind::Open => open.push(token.span),
                TokenKind::Close if open.pop().is_none() => {
                    wrong = Some((token.span, "this `}` has no matching `{` in its file"));
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
