//! Changes that `durer check --fix` makes to a scene file.

/// A change that `durer check --fix` made to a scene file, with the code of the finding that it
/// fixes.
pub struct Change {
    pub code: &'static str,
    /// Position in the text when the change was made, for JSON.
    pub place: serde_json::Value,
    pub at: String,
    pub old: String,
    pub new: String,
}

impl Change {
    /// Formats the change as one line.
    pub fn line(&self) -> String {
        let Change { at, old, new, code, .. } = self;
        let what = match (old.is_empty(), new.is_empty()) {
            (true, _) => format!("inserted `{}`", new.trim()),
            (_, true) => format!("removed `{old}`"),
            _ => format!("`{old}` is now `{new}`"),
        };
        format!("{at}: {what} [{code}]")
    }
}
