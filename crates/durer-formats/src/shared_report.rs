//! Collector for the diagnostics of a file that all parts of a reader share.

use durer_diag::{Diagnostic, Diagnostics, Span};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Collector for the diagnostics of a scene file; all parts of the reader hold references to it.
#[derive(Default)]
pub(crate) struct SharedReport {
    diagnostics: RefCell<Diagnostics>,
    reported: RefCell<BTreeSet<String>>,
}

/// Code of warnings about content that cannot be rendered as its format specifies.
pub(crate) const NO_COUNTERPART: &str = "no-counterpart";

impl SharedReport {
    /// Adds a diagnostic.
    pub fn push(&self, diagnostic: Diagnostic) {
        self.diagnostics.borrow_mut().push(diagnostic);
    }

    /// Adds the diagnostics from the reader of another file.
    pub fn extend(&self, others: Diagnostics) {
        self.diagnostics.borrow_mut().extend(others);
    }

    /// Reports an error about an invalid value.
    pub fn error(&self, at: Span, message: impl Into<String>) {
        self.push(Diagnostic::error(message).code("bad-value").at(at));
    }

    /// Reports an error about an invalid value, with a suggestion.
    pub fn error_with_help(&self, at: Span, message: impl Into<String>, help: Option<String>) {
        self.push(Diagnostic { help, ..Diagnostic::error(message).code("bad-value").at(at) });
    }

    /// Warns that something cannot be rendered as the format specifies; the message says what is
    /// used instead.
    pub fn unsupported(&self, at: Span, message: impl Into<String>) {
        self.push(Diagnostic::warning(message).code(NO_COUNTERPART).at(at));
    }

    /// Warns as [`SharedReport::other`] does, but only once for each message.
    pub fn unsupported_once(&self, at: Span, message: impl Into<String>) {
        self.warn_once(NO_COUNTERPART, at, message);
    }

    /// Warns with a code, but only once for each message.
    pub fn warn_once(&self, code: &'static str, at: Span, message: impl Into<String>) {
        let message = message.into();
        if self.reported.borrow_mut().insert(message.clone()) {
            self.push(Diagnostic::warning(message).code(code).at(at));
        }
    }

    /// Returns true if no more errors can be added.
    pub fn is_full(&self) -> bool {
        self.diagnostics.borrow().is_full()
    }

    /// Returns true if at least one error was reported.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.borrow().has_errors()
    }

    /// Returns all diagnostics.
    pub fn finish(self) -> Diagnostics {
        self.diagnostics.into_inner()
    }
}

/// Returns a help text that suggests a similar word, if there is one.
pub(crate) fn suggest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    durer_diag::did_you_mean(word, known).map(|suggestion| format!("did you mean `{suggestion}`?"))
}
