//! Reader and writer of all dialects of the course's scene language.

mod fields;
pub mod guess;
mod include;
mod lexer;
mod named;
mod nodes;
pub mod place;
#[cfg(any(test, feature = "testing"))]
#[doc(hidden)]
pub mod random;
mod reader;
mod recover;
pub mod reference;
mod sections;
mod suggestions;
mod transform;
mod words;
pub mod write;

use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_scene::dialect::{Dialect, QuirkSet};
use durer_scene::scene::Scene;
pub use guess::{Guess, Hint, guess};
pub use include::{IncludedFile, open_below};
pub(super) use lexer::is_word;
pub(super) use transform::{flat_matrix_error, invalid_matrix_error};
pub use write::write;

/// Options for reading a scene file, which are its dialect and how closely the reader follows the
/// course's programs.
#[derive(Clone, Copy, Debug)]
pub struct ReadOptions {
    /// Dialect of the file.
    pub dialect: Dialect,
    /// True to allow only what the course's parsers for that dialect accept. In this mode, comments
    /// and words of other years are not allowed, and fields and counts must be in the required
    /// order.
    pub strict: bool,
    /// Quirks of the course's programs that the reader imitates.
    pub compat: QuirkSet,
}

/// Reads a scene that does not include other files. Collects all errors, and returns `None` if
/// there are any.
pub fn read(bytes: &[u8], file: u32, options: ReadOptions, diagnostics: &mut Diagnostics) -> Option<Scene> {
    read_with(bytes, file, options, &|_| IncludedFile::NoFolder, diagnostics)
}

/// Reads a scene. The function `open` is called to open the files that the scene includes.
pub fn read_with(
    bytes: &[u8],
    file: u32,
    options: ReadOptions,
    open: &dyn Fn(&str) -> IncludedFile,
    diagnostics: &mut Diagnostics,
) -> Option<Scene> {
    if bytes.len() >= u32::MAX as usize {
        diagnostics.push(Diagnostic::error("a scene file must be smaller than 4 GiB"));
        return None;
    }
    if let Some(problem) = not_text_reason(bytes) {
        diagnostics.push(Diagnostic::error(problem).code("syntax").at(Span { file, start: 0, end: 0 }));
        return None;
    }
    let mut own = Diagnostics::default();
    let mut reader = reader::Reader::new(bytes, file, options, open, &mut own);
    match options.dialect {
        Dialect::F23 => reader.nodes_file(),
        _ => reader.scene_file(),
    }
    let scene = reader.finish();
    let failed = own.has_errors();
    diagnostics.extend(own);
    (!failed).then_some(scene)
}

/// Returns the reason why a file cannot be a scene, or `None` if it can be a scene.
fn not_text_reason(bytes: &[u8]) -> Option<&'static str> {
    let head = &bytes[..bytes.len().min(1 << 16)];
    let zeros = |from: usize| head.iter().skip(from).step_by(2).filter(|b| **b == 0).count() * 4 > head.len();
    if head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff") || head.len() > 3 && (zeros(0) != zeros(1)) {
        return Some("this file is UTF-16: save the file as UTF-8 or ASCII text");
    }
    // Text that was copied from a terminal can contain escape characters for colours.
    let odd = |b: &&u8| **b < 9 || (14..32).contains(*b) && **b != 27;
    let count = head.iter().filter(odd).count();
    let binary = head.contains(&0) || count * 20 > head.len();
    binary.then_some("this file is not a scene, because it contains binary data instead of text")
}

#[cfg(test)]
mod tests;
