//! Parts of documents that commands write, between two comments.

use anyhow::{Context, Result};

const END: &str = "<!-- end -->\n";

/// Part of a document that the command `cargo xtask COMMAND` writes.
pub struct Section {
    /// Path of the document from the root of the repository.
    pub page: &'static str,
    pub command: &'static str,
}

impl Section {
    fn begin(&self) -> String {
        format!("<!-- made by cargo xtask {} -->\n", self.command)
    }

    /// Splits the document into the text before the part, the part, and the text after it.
    fn split(&self) -> Result<[String; 3]> {
        let text = std::fs::read_to_string(crate::root()?.join(self.page))?;
        let missing = || format!("{} lacks the comments around the part by {}", self.page, self.command);
        let (before, rest) = text.split_once(&self.begin()).with_context(missing)?;
        let (part, after) = rest.split_once(END).with_context(missing)?;
        Ok([before, part, after].map(String::from))
    }

    /// Returns the part with its comments.
    pub fn marked(&self) -> Result<String> {
        Ok(format!("{}{}{END}", self.begin(), self.split()?[1]))
    }

    /// Replaces the part.
    pub fn write(&self, part: &str) -> Result<()> {
        let [before, _, after] = self.split()?;
        std::fs::write(crate::root()?.join(self.page), format!("{before}{}\n{part}\n{END}{after}", self.begin()))?;
        println!("wrote {}", self.page);
        Ok(())
    }
}
