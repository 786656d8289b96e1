//! Readers: one file a format, one row of [`MESH_FORMATS`] or [`SCENE_FORMATS`] each.
//!
//! The files come from anywhere. Readers allocate in proportion to the bytes that are there, never
//! to what a file promises, refuse numbers that are not finite and indices that lead nowhere, and
//! collect errors with their places.

pub mod beside;
mod bodies;
pub mod course;
pub mod curve;
mod decoder;
mod disney;
mod files;
#[cfg(feature = "fs")]
pub mod folder;
mod gltf;
pub mod json;
mod lamps;
mod medium;
mod mitsuba;
mod model;
mod number;
pub mod obj;
mod panorama;
mod pbrt;
pub mod photometry;
mod pictures;
mod ply;
mod polygon;
mod radiance;
mod report;
mod said;
pub mod scene;
mod signature;
mod smooth;
mod sticks;
mod stl;
mod threemf;
mod unscattered;
pub mod vol;
mod xml;
mod zip;

pub use decoder::Decoder;
use durer_diag::{Diagnostic, Diagnostics, did_you_mean};
use durer_scene::dialect::CompatSet;
use durer_scene::scene::Axis;
use durer_scene::shape::mesh::MeshData;
pub use model::SceneFormat;
pub use scene::{SCENE_FORMATS, scene_format_for};
use signature::mistaken;
use std::borrow::Cow;

/// A format of mesh files.
pub struct MeshFormat {
    /// Its name for people.
    pub name: &'static str,
    /// Endings of its files' names, in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Whether a file that begins with these bytes seems to be of this format.
    pub recognise: fn(&[u8]) -> bool,
    /// Reads a file; the number goes into the spans. Errors go into the collection, and then there
    /// is no mesh.
    pub read: fn(&[u8], u32, &mut Diagnostics) -> Option<MeshData>,
    /// The same file as programs with some quirks know it.
    pub known: fn(&[u8], CompatSet) -> Cow<'_, [u8]>,
    /// Writes a mesh.
    pub write: fn(&MeshData) -> Vec<u8>,
    /// What is up in most models of this format.
    pub up: Axis,
}

/// The formats of mesh files, in the order in which they are tried on a file of unknown ending.
pub const MESH_FORMATS: &[MeshFormat] = &[ply::FORMAT, obj::FORMAT, stl::FORMAT];

/// No old program read the format.
fn as_it_is(bytes: &[u8], _: CompatSet) -> Cow<'_, [u8]> {
    Cow::Borrowed(bytes)
}

/// The format of mesh files that the ending of a name says.
pub fn mesh_format_for(name: &str) -> Option<&'static MeshFormat> {
    let extension = extension(name);
    MESH_FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
}

/// Reads a mesh file in the format that its name's ending says or, where that is unknown, its
/// content.
///
/// `file` is the number of the file in [`Files`](durer_diag::Files), for spans; `name` its name
/// with ending.
///
/// # Errors
///
/// All errors are added to `diagnostics`, with the place of the offending bytes, and then the
/// result is `None`. It is `None` too where `diagnostics` was full already. Warnings and notes are
/// added likewise and leave the mesh usable.
pub fn read_mesh(bytes: &[u8], file: u32, name: &str, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    read_mesh_as(bytes, file, name, 0, diagnostics)
}

/// The same, with some quirks of old programs.
pub fn read_mesh_as(
    bytes: &[u8],
    file: u32,
    name: &str,
    quirks: CompatSet,
    diagnostics: &mut Diagnostics,
) -> Option<MeshData> {
    if let Some(error) = too_large(bytes.len() as u64, name) {
        diagnostics.push(error);
        return None;
    }
    let format = find_format(bytes, name);
    if let Some(error) = mistaken(bytes, file, name, format.map_or(&[], |format| format.extensions)) {
        diagnostics.push(error);
        return None;
    }
    match format {
        Some(format) => (format.read)(&(format.known)(bytes, quirks), file, diagnostics),
        None => {
            diagnostics.push(unknown_format(name));
            None
        }
    }
}

/// Spans count bytes in 32 bits: the error about a file of this size, if it is one.
fn too_large(size: u64, name: &str) -> Option<Diagnostic> {
    const MOST: u64 = u32::MAX as u64 - 1;
    let message = || format!("`{name}` is too large for a mesh file: {size} bytes, at most {MOST}");
    (size > MOST).then(|| Diagnostic::error(message()).help("cut the mesh into several files"))
}

/// The ending of a file's name, in lower case, without the dot; empty where there is none.
fn extension(name: &str) -> String {
    let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
    base.rsplit_once('.').map_or(String::new(), |(_, extension)| extension.to_lowercase())
}

fn find_format(bytes: &[u8], name: &str) -> Option<&'static MeshFormat> {
    mesh_format_for(name).or_else(|| MESH_FORMATS.iter().find(|format| (format.recognise)(bytes)))
}

fn unknown_format(name: &str) -> Diagnostic {
    let extension = extension(name);
    let all = MESH_FORMATS.iter().flat_map(|format| format.extensions.iter().copied());
    let meant = did_you_mean(&extension, all).filter(|_| !extension.is_empty());
    let known = MESH_FORMATS.iter().map(|f| format!("{} (.{})", f.name, f.extensions.join(", .")));
    let known = known.collect::<Vec<_>>().join(", ");
    Diagnostic::error(format!("`{name}` is no mesh file of a known format")).help(match meant {
        Some(meant) => format!("did you mean `.{meant}`? Known are {known}"),
        None => format!("known are {known}"),
    })
}

#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
