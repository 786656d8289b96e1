//! Scenes as JSON: the same description as the scene language's, for programs. Things have the
//! keywords of our own dialect, and fields the names that their statements give them.

mod read;
pub mod schema;
#[cfg(test)]
mod tests;
mod tree;
mod values;
mod write;

use crate::scene::MatrixOp;
pub use read::Document;
pub use write::write;

/// Ending of the names of such files.
pub const EXTENSION: &str = "json";

/// Objects may be nested this deep, as in the language.
const DEEPEST: usize = 200;

/// Matrices of a transform, by keyword, each with a value to tell what it takes.
const MATRICES: [(&str, MatrixOp); 8] = {
    use crate::math::Vec3;
    [
        ("Translate", MatrixOp::Translate(Vec3::ZERO)),
        ("Scale", MatrixOp::Scale(Vec3::ONE)),
        ("UniformScale", MatrixOp::UniformScale(1.0)),
        ("XRotate", MatrixOp::XRotate(0.0)),
        ("YRotate", MatrixOp::YRotate(0.0)),
        ("ZRotate", MatrixOp::ZRotate(0.0)),
        ("Rotate", MatrixOp::Rotate(Vec3::Y, 0.0)),
        ("Matrix", MatrixOp::Matrix([1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.])),
    ]
};

/// Whether a file is a scene as JSON, by its name or its beginning, which no text of the language
/// has. glTF is JSON too, and is none.
pub fn recognise(bytes: &[u8], name: &str) -> bool {
    let head = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let is_json = super::extension(name) == EXTENSION || head.starts_with(b"{");
    is_json && super::scene::find_scene_format(bytes, name).is_none()
}
