//! What there is to say of a file, collected from everywhere.

use durer_diag::{Diagnostic, Diagnostics, Span};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Findings, and what was said already.
#[derive(Default)]
pub(crate) struct Said {
    found: RefCell<Diagnostics>,
    once: RefCell<BTreeSet<String>>,
}

/// The code of what is not rendered as its format has it.
pub(crate) const NO_COUNTERPART: &str = "NO_COUNTERPART";

impl Said {
    /// Adds a finding.
    pub fn push(&self, diagnostic: Diagnostic) {
        self.found.borrow_mut().push(diagnostic);
    }

    /// Adds all findings of a reader of another file.
    pub fn extend(&self, others: Diagnostics) {
        self.found.borrow_mut().extend(others);
    }

    /// A wrong value.
    pub fn bad(&self, at: Span, message: impl Into<String>) {
        self.push(Diagnostic::error(message).code("bad-value").at(at));
    }

    /// A wrong value, and what would be right.
    pub fn bad_with(&self, at: Span, message: impl Into<String>, help: Option<String>) {
        self.push(Diagnostic { help, ..Diagnostic::error(message).code("bad-value").at(at) });
    }

    /// What is not rendered as the format has it, and what is taken instead.
    pub fn other(&self, at: Span, message: impl Into<String>) {
        self.push(Diagnostic::warning(message).code(NO_COUNTERPART).at(at));
    }

    /// The same, once for all that is told by the same words.
    pub fn once(&self, at: Span, message: impl Into<String>) {
        self.warn_once(NO_COUNTERPART, at, message);
    }

    /// A warning of a code, once for all that is told by the same words.
    pub fn warn_once(&self, code: &'static str, at: Span, message: impl Into<String>) {
        let message = message.into();
        if self.once.borrow_mut().insert(message.clone()) {
            self.push(Diagnostic::warning(message).code(code).at(at));
        }
    }

    /// Whether no more errors are collected.
    pub fn is_full(&self) -> bool {
        self.found.borrow().is_full()
    }

    /// Whether there is an error.
    pub fn has_errors(&self) -> bool {
        self.found.borrow().has_errors()
    }

    /// Everything.
    pub fn finish(self) -> Diagnostics {
        self.found.into_inner()
    }
}

/// Help that names a word like the one that is written.
pub(crate) fn meant<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    durer_diag::did_you_mean(word, known).map(|meant| format!("did you mean `{meant}`?"))
}
