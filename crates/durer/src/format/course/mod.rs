//! The course's scene language, in all its dialects.

mod fields;
pub mod guess;
mod lexer;
mod nodes;
pub mod place;
#[cfg(any(test, fuzzing))]
pub mod random;
mod reader;
mod recover;
pub mod reference;
mod sections;
mod transform;
mod words;
pub mod write;

use crate::diag::{Diagnostic, Diagnostics};
use crate::dialect::{CompatSet, Dialect};
use crate::scene::Scene;
pub use guess::{Guess, Hint, guess};
pub use write::write;

/// How a scene file is to be read.
#[derive(Clone, Copy, Debug)]
pub struct ReadOptions {
    /// Its dialect.
    pub dialect: Dialect,
    /// Whether only the words of that dialect are allowed: no comments, no words of other years, counts and
    /// order as the old programs wanted them.
    pub strict: bool,
    /// Habits of its program.
    pub compat: CompatSet,
}

/// Reads a scene. All errors are collected; with any, there is no scene.
pub fn read(bytes: &[u8], file: u32, options: ReadOptions, diagnostics: &mut Diagnostics) -> Option<Scene> {
    if bytes.len() >= u32::MAX as usize {
        diagnostics.push(Diagnostic::error("a scene file must be smaller than 4 GiB"));
        return None;
    }
    let mut own = Diagnostics::default();
    let mut reader = reader::Reader::new(bytes, file, options, &mut own);
    match options.dialect {
        Dialect::F23 => reader.nodes_file(),
        _ => reader.scene_file(),
    }
    let scene = reader.finish();
    let failed = own.has_errors();
    diagnostics.extend(own);
    (!failed).then_some(scene)
}

#[cfg(test)]
mod tests;
