//! Provides the context in which the primitives of a text are read.

use super::words::Word;
use glam::DAffine3;
use std::rc::Rc;

/// Transform and settings that apply to all primitives of a text. The transform and the settings
/// come from the commands that include the text.
#[derive(Clone, Default)]
pub(super) struct PrimitiveContext {
    pub map: DAffine3,
    /// Modifier that replaces the modifiers of all surfaces, if one is given.
    pub modifier: Option<Word>,
    /// True if all surfaces are turned inside out.
    pub inverted: bool,
    pub depth: u32,
    /// Folder in which commands run, relative to the scene's folder and with a `/` at the end. The
    /// path is empty for the scene's folder itself.
    pub folder: Rc<str>,
}

impl PrimitiveContext {
    /// Returns the path of a file that a command names, relative to the scene's folder.
    pub fn resolved(&self, name: &Word) -> Word {
        match self.folder.is_empty() || name.text.starts_with(['/', '\\']) {
            true => name.clone(),
            false => Word { text: format!("{}{}", self.folder, name.text), at: name.at },
        }
    }

    /// Returns this context after changing the folder to the one that contains a file named by a
    /// command.
    pub fn in_folder_of(&self, name: &Word) -> PrimitiveContext {
        let text = self.resolved(name).text;
        let folder = text.rfind(['/', '\\']).map_or("", |slash| &text[..=slash]);
        PrimitiveContext { folder: folder.into(), ..self.clone() }
    }
}
