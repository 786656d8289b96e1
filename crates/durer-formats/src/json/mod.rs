//! Scenes as JSON: the same description as the scene language's, for programs. Things have the
//! keywords of our own dialect, and fields the names that their statements give them.

mod read;
pub mod schema;
#[cfg(test)]
mod tests;
mod tree;
mod values;
mod write;

pub use read::Document;
pub use write::write;

/// Ending of the names of such files.
pub const EXTENSION: &str = "json";

/// Objects may be nested this deep, as in the language.
const DEEPEST: usize = 200;

/// Whether a file is a scene as JSON, by its name or its beginning, which no text of the language
/// has. glTF is JSON too, and is none.
pub fn recognise(bytes: &[u8], name: &str) -> bool {
    let head = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let is_json = super::extension(name) == EXTENSION || head.starts_with(b"{");
    is_json && super::scene::find_scene_format(bytes, name).is_none()
}
