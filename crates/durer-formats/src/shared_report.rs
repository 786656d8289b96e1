//! Collector of the diagnostics of a file, shared by the parts of a reader.

use durer_diag::{Diagnostic, Diagnostics, Span};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Diagnostics, and the messages that are reported once only.
#[derive(Default)]
pub(crate) struct SharedReport {
    found: RefCell<Diagnostics>,
    once: RefCell<BTreeSet<String>>,
}

/// Code of warnings about content that cannot be rendered as its format specifies.
pub(crate) const NO_COUNTERPART: &str = "NO_COUNTERPART";

impl SharedReport {
    /// Adds a diagnostic.
    pub fn push(&self, diagnostic: Diagnostic) {
        self.found.borrow_mut().push(diagnostic);
    }

    /// Adds the diagnostics of another file's reader.
    pub fn extend(&self, others: Diagnostics) {
        self.found.borrow_mut().extend(others);
    }

    /// Reports an invalid value.
    pub fn bad(&self, at: Span, message: impl Into<String>) {
        self.push(Diagnostic::error(message).code("bad-value").at(at));
    }

    /// Reports an invalid value with a suggestion.
    pub fn bad_with(&self, at: Span, message: impl Into<String>, help: Option<String>) {
        self.push(Diagnostic { help, ..Diagnostic::error(message).code("bad-value").at(at) });
    }

    /// Warns that something cannot be rendered as the format specifies; the message names the
    /// substitute.
    pub fn other(&self, at: Span, message: impl Into<String>) {
        self.push(Diagnostic::warning(message).code(NO_COUNTERPART).at(at));
    }

    /// Warns as [`SharedReport::other`] does, once per message.
    pub fn once(&self, at: Span, message: impl Into<String>) {
        self.warn_once(NO_COUNTERPART, at, message);
    }

    /// Warns with a code, once per message.
    pub fn warn_once(&self, code: &'static str, at: Span, message: impl Into<String>) {
        let message = message.into();
        if self.once.borrow_mut().insert(message.clone()) {
            self.push(Diagnostic::warning(message).code(code).at(at));
        }
    }

    /// Returns true if no more errors are collected.
    pub fn is_full(&self) -> bool {
        self.found.borrow().is_full()
    }

    /// Returns true if there is an error.
    pub fn has_errors(&self) -> bool {
        self.found.borrow().has_errors()
    }

    /// Returns all diagnostics.
    pub fn finish(self) -> Diagnostics {
        self.found.into_inner()
    }
}

/// Help text that suggests a similar word, if there is one.
pub(crate) fn suggest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    durer_diag::did_you_mean(word, known).map(|suggestion| format!("did you mean `{suggestion}`?"))
}
