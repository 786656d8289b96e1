//! Scenes in JSON format, which have the same content as scenes in the scene language and are
//! intended for programs. Objects use the keywords of the Dürer dialect, and members have the names
//! of the fields of their statements.

mod read;
pub mod schema;
#[cfg(test)]
mod tests;
mod tree;
mod values;
mod write;

pub use read::Document;
pub use write::write;

/// File name extension of JSON scenes, without the leading dot.
pub const EXTENSION: &str = "json";

/// Maximum depth of nested objects, which is the same as in the scene language.
const MAX_DEPTH: usize = 200;

/// Returns true if a file is a JSON scene: its extension is `.json`, or it begins with `{`, which
/// no file in the scene language does. glTF files are also JSON, but they are not scenes of this
/// kind.
pub fn recognise(bytes: &[u8], name: &str) -> bool {
    let head = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let is_json = super::extension(name) == EXTENSION || head.starts_with(b"{");
    is_json && super::scene::find_scene_format(bytes, name).is_none()
}
