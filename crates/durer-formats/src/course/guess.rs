//! Guesses the dialect of a scene and gives reasons for the guess.

use super::lexer::{TokenKind, tokens};
use super::words::{dialects_of, is_reserved};
use durer_diag::{Diagnostic, Span, did_you_mean};
use durer_scene::dialect::{Dialect, DialectSet, set};

/// Evidence for the dialect of a scene that comes from outside the file, such as an option. A hint
/// that contradicts the file is ignored.
#[derive(Clone, Debug)]
pub struct Hint {
    /// Dialects that the hint allows.
    pub set: DialectSet,
    /// Reason that is phrased as the end of a sentence.
    pub reason: String,
    /// True for a hint that is used only if something else also distinguishes the years.
    pub weak: bool,
}

/// Result of guessing the dialect of a scene file, with the reasons for it and the alternatives.
#[derive(Clone, Debug)]
pub struct Guess {
    /// Guessed dialect.
    pub dialect: Dialect,
    /// Reasons that narrowed down the choice, with their spans. Each reason is phrased as the end
    /// of a sentence.
    pub reasons: Vec<(String, Option<Span>)>,
    /// Other dialects that fit the file equally well.
    pub others: Vec<Dialect>,
    /// Dialects that are consistent with the keywords and with the strong hints, with the most
    /// likely one first.
    pub fitting: Vec<Dialect>,
    /// Dialect that the keywords suggest if hints are ignored.
    pub by_keywords: Dialect,
}

impl Guess {
    /// Returns the result for a file that states its own dialect.
    pub fn certain(dialect: Dialect) -> Self {
        Guess { dialect, reasons: Vec::new(), others: Vec::new(), fitting: vec![dialect], by_keywords: dialect }
    }

    /// Returns true if the hints have changed the dialect that the keywords alone suggest.
    pub fn changed_by_hints(&self) -> bool {
        self.dialect != self.by_keywords
    }

    /// Returns a note that explains the guess to the user.
    pub fn note(&self) -> Diagnostic {
        let reasons: Vec<&str> = self.reasons.iter().map(|r| r.0.as_str()).collect();
        let mut message = format!("the scene is read as {}", self.dialect.name());
        if !reasons.is_empty() {
            message += &format!(": {}", reasons.join("; "));
        }
        if !self.others.is_empty() {
            let names: Vec<&str> = self.others.iter().map(|d| d.name()).collect();
            message += &format!(" (it could also be {})", names.join(" or "));
        }
        Diagnostic::note(message).code("dialect")
    }
}

/// Dialects in order of preference, which decides if several of them remain possible.
const PREFERENCE: [Dialect; 6] =
    [Dialect::F12a4, Dialect::F04, Dialect::F12a5, Dialect::F16, Dialect::F23, Dialect::F03];

/// Guesses the dialect of a scene from its keywords. `exists` returns true if a file that the scene
/// names exists.
pub fn guess(bytes: &[u8], file: u32, hints: &[Hint], exists: &dyn Fn(&str) -> bool) -> Guess {
    let mut left = set::ALL & !set::DURER;
    let mut reasons: Vec<(DialectSet, String, Option<Span>)> = Vec::new();
    let tokens = tokens(bytes, file);
    let text = |i: usize| {
        let span = tokens.get(i).map_or(Span::default(), |t| t.span);
        String::from_utf8_lossy(&bytes[span.start as usize..span.end as usize])
    };
    let mut narrow = |keep: DialectSet, why: String, span: Option<Span>| {
        if left & keep != left {
            left &= keep;
            reasons.push((keep, why, span));
        }
    };
    // A file can contain words of the node grammar as well as words of earlier years. The more
    // frequent kind decides the grammar, and words of the other kind are treated as foreign.
    let (mut nodes, mut classic) = (0_usize, 0_usize);
    for (i, token) in tokens.iter().enumerate().filter(|(_, token)| token.kind == TokenKind::Word) {
        let _ = token;
        let word = text(i);
        match dialects_of(&word) {
            Some(set::F23) => nodes += usize::from(is_distinctive(&word)) * 2,
            Some(words) if !Dialect::F23.is_in(words) && words != set::DURER => classic += 1,
            _ => {}
        }
    }
    let majority = if nodes > classic { set::F23 } else { set::ALL };
    let has_section = (0..tokens.len()).any(|i| text(i) == "Materials");
    let mut depth = 0_usize;
    for (i, token) in tokens.iter().enumerate() {
        depth = match token.kind {
            TokenKind::Open => depth + 1,
            TokenKind::Close => depth.saturating_sub(1),
            _ => depth,
        };
        let word = text(i);
        let at = |i: usize| tokens.get(i).map(|token| token.kind);
        let (braced, named) = (at(i + 1) == Some(TokenKind::Open), at(i + 1) == Some(TokenKind::Word));
        let (keep, why) = if token.kind != TokenKind::Word {
            continue;
        } else if braced && matches!(&*word, "Translate" | "Scale" | "XRotate" | "YRotate" | "ZRotate") {
            (set::F03, format!("`{word} {{` with a brace is syntax of 2003"))
        } else if braced && depth > 0 && !has_section && matches!(&*word, "Material" | "PhongMaterial") {
            (set::F03, format!("`{word}` inside a group is syntax of 2003"))
        } else if word == "cubeMap" && exists(&format!("{}/left.png", text(i + 1))) {
            (set::F16, "the cube map has PNG files".into())
        } else if word == "cubeMap" && exists(&format!("{}/left.bmp", text(i + 1))) {
            (set::F12A5, "the cube map has BMP files".into())
        } else if named && matches!(&*word, "include" | "define" | "use") {
            (set::DURER, format!("`{word}` is a Dürer extension"))
        } else if named && at(i + 2) == Some(TokenKind::Open) && is_material(&word) && !is_reserved(&text(i + 1)) {
            (set::DURER, "only the Dürer dialect names materials".into())
        } else if let Some(set) = dialects_of(&word).filter(|set| match *set {
            set::F23 => is_distinctive(&word),
            // A word of the Dürer dialect counts only if a block follows it, because `top` or `min`
            // could also be a file name.
            set::DURER => braced,
            _ => true,
        }) {
            (set, format!("`{word}` is a word of {}", names(set)))
        } else {
            continue;
        };
        // Separate warnings report the words of the less frequent kind.
        if majority == set::F23 && keep & set::F23 == 0 {
            continue;
        }
        narrow(keep, why, Some(token.span));
    }
    if let Some(comment) = tokens.iter().find(|token| token.kind == TokenKind::Comment) {
        // The Dürer dialect does not have nodes, so a file with nodes stays in the dialect that has
        // them.
        let nodes = (0..tokens.len()).any(|i| text(i) == "Scene" || text(i).starts_with("Component<"));
        let keep = if nodes { set::F23 } else { 0 };
        narrow(keep, "the file has comments, which the course's language lacks".into(), Some(comment.span));
    }
    let first = |left: DialectSet| PREFERENCE.into_iter().find(|d| d.is_in(left));
    let by_words = first(left);
    // Apply weak hints last. At that point, `fitting` contains the dialects that remain before
    // them.
    let (weak, strong): (Vec<&Hint>, Vec<&Hint>) = hints.iter().partition(|hint| hint.weak);
    let mut fitting = left;
    for hint in strong.into_iter().chain(weak) {
        // Ignore a hint that contradicts the file or an earlier hint, because an option may be
        // intended for another year.
        let keep = left & hint.set;
        if keep != 0 && keep != left && !(hint.weak && reasons.is_empty()) {
            left = keep;
            reasons.push((hint.set, hint.reason.clone(), None));
        }
        fitting = if hint.weak { fitting } else { left };
    }
    // Remove reasons that later reasons make redundant.
    for i in (0..reasons.len()).rev() {
        let others = reasons.iter().enumerate().filter(|(j, _)| *j != i);
        if others.fold(set::ALL & !set::DURER, |left, (_, reason)| left & reason.0) == left {
            reasons.remove(i);
        }
    }
    let reasons = reasons.into_iter().map(|(_, why, span)| (why, span)).collect();
    let of = |set: DialectSet| PREFERENCE.into_iter().filter(move |d| d.is_in(set));
    let dialect = first(left).unwrap_or(Dialect::Durer);
    Guess {
        dialect,
        reasons,
        others: of(left).filter(|other| *other != dialect).collect(),
        fitting: of(fitting).collect(),
        by_keywords: by_words.unwrap_or(dialect),
    }
}

fn names(set: DialectSet) -> String {
    if set & set::ALL == set::CLASSIC {
        return "the years before 2020".into();
    }
    let names: Vec<&str> =
        Dialect::ALL.iter().filter(|d| d.is_in(set) && **d != Dialect::Durer).map(|d| d.name()).collect();
    if names.is_empty() { Dialect::Durer.name().into() } else { names.join(", ") }
}

/// Returns true if a word of 2020 proves that year on its own. The words `sphere` and `point` are
/// not proof, because they may be file names.
fn is_distinctive(word: &str) -> bool {
    word.contains(['<', '_']) || word.starts_with(char::is_uppercase)
}

/// Returns true if a word begins a material, perhaps with a typing error.
fn is_material(word: &str) -> bool {
    word.ends_with("Material") || did_you_mean(word, ["PhongMaterial", "PrincipledMaterial", "HairMaterial"]).is_some()
}
