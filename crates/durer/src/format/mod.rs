//! Readers of mesh files: one file a format, one row of [`MESH_FORMATS`] each.
//!
//! The files come from anywhere. Readers allocate in proportion to the bytes that are there, never to what a file
//! promises, refuse numbers that are not finite and indices that lead nowhere, and collect errors with their places.

pub mod course;
mod number;
mod obj;
mod ply;
mod polygon;
mod report;

use crate::diag::{Diagnostic, Diagnostics, did_you_mean};
use crate::shape::mesh::MeshData;

/// A format of mesh files.
pub struct MeshFormat {
    /// Its name for people.
    pub name: &'static str,
    /// Endings of its files' names, in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Whether a file that begins with these bytes seems to be of this format.
    pub recognise: fn(&[u8]) -> bool,
    /// Reads a file; the number goes into the spans. Errors go into the collection, and then there is no mesh.
    pub read: fn(&[u8], u32, &mut Diagnostics) -> Option<MeshData>,
}

/// The formats of mesh files, in the order in which they are tried on a file of unknown ending.
pub const MESH_FORMATS: &[MeshFormat] = &[
    MeshFormat { name: "PLY", extensions: &["ply"], recognise: ply::recognise, read: ply::read },
    MeshFormat { name: "Wavefront OBJ", extensions: &["obj"], recognise: obj::recognise, read: obj::read },
];

/// Reads a mesh file in the format that its name's ending says or, where that is unknown, its content.
///
/// `file` is the number of the file in [`Files`](crate::diag::Files), for spans; `name` its name with ending.
///
/// # Errors
///
/// All errors are added to `diagnostics`, with the place of the offending bytes, and then the result is `None`. It is
/// `None` too where `diagnostics` was full already. Warnings and notes are added likewise and leave the mesh usable.
pub fn read_mesh(bytes: &[u8], file: u32, name: &str, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    if let Err(error) = check_size(bytes.len() as u64, name) {
        diagnostics.push(error);
        return None;
    }
    match find_format(bytes, name) {
        Ok(format) => (format.read)(bytes, file, diagnostics),
        Err(error) => {
            diagnostics.push(error);
            None
        }
    }
}

/// Spans count bytes in 32 bits.
fn check_size(size: u64, name: &str) -> Result<(), Diagnostic> {
    if size < u32::MAX as u64 {
        return Ok(());
    }
    Err(Diagnostic::error(format!("`{name}` is too large for a mesh file: {size} bytes, at most {}", u32::MAX - 1))
        .help("cut the mesh into several files"))
}

fn find_format(bytes: &[u8], name: &str) -> Result<&'static MeshFormat, Diagnostic> {
    let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let extension = base.rsplit_once('.').map_or(String::new(), |(_, extension)| extension.to_lowercase());
    let by_name = MESH_FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()));
    if let Some(format) = by_name.or_else(|| MESH_FORMATS.iter().find(|format| (format.recognise)(bytes))) {
        return Ok(format);
    }
    let all = || MESH_FORMATS.iter().flat_map(|format| format.extensions.iter().copied());
    let list: Vec<String> =
        MESH_FORMATS.iter().map(|f| format!("{} (.{})", f.name, f.extensions.join(", ."))).collect();
    let meant = did_you_mean(&extension, all()).filter(|_| !extension.is_empty());
    Err(Diagnostic::error(format!("`{name}` is no mesh file of a known format")).help(match meant {
        Some(meant) => format!("did you mean `.{meant}`? Known are {}", list.join(", ")),
        None => format!("known are {}", list.join(", ")),
    }))
}

#[cfg(test)]
mod tests;
