//! A change that `--fix` made.

/// A change that was made.
pub struct Change {
    pub code: &'static str,
    /// Where, in the text as it was at that time.
    pub place: serde_json::Value,
    pub at: String,
    pub old: String,
    pub new: String,
}

impl Change {
    /// In one line.
    pub fn line(&self) -> String {
        let Change { at, old, new, code, .. } = self;
        let what = match (old.is_empty(), new.is_empty()) {
            (true, _) => format!("put in `{}`", new.trim()),
            (_, true) => format!("took out `{old}`"),
            _ => format!("`{old}` is now `{new}`"),
        };
        format!("{at}: {what} [{code}]")
    }
}
