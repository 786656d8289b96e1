//! Where what a text says goes.

use super::words::Word;
use glam::DAffine3;
use std::rc::Rc;

/// Where the things of a text go.
#[derive(Clone, Default)]
pub(super) struct Place {
    pub map: DAffine3,
    /// What modifies all surfaces instead of what is written.
    pub modifier: Option<Word>,
    /// Whether all surfaces are turned inside out.
    pub inverted: bool,
    pub depth: u32,
    /// The folder in which commands are run, with its last `/`, from that of the scene.
    pub folder: Rc<str>,
}

impl Place {
    /// The name of a file that a command has, from the folder of the scene.
    pub fn seen(&self, name: &Word) -> Word {
        match self.folder.is_empty() || name.text.starts_with(['/', '\\']) {
            true => name.clone(),
            false => Word { text: format!("{}{}", self.folder, name.text), at: name.at },
        }
    }

    /// The same in the folder of a file that a command has.
    pub fn beside(&self, name: &Word) -> Place {
        let text = self.seen(name).text;
        let folder = text.rfind(['/', '\\']).map_or("", |slash| &text[..=slash]);
        Place { folder: folder.into(), ..self.clone() }
    }
}
