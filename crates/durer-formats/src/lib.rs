//! Readers and writers of file formats. Each format has one file or folder, and one row of
//! [`MESH_FORMATS`] or [`SCENE_FORMATS`].
//!
//! Files may be hostile. Readers allocate in proportion to the actual number of bytes, never to a
//! count that a file promises. They reject non-finite numbers and indices out of range, and collect
//! errors with spans.

// Parts that several formats share are not all used if a format is left out.
#![cfg_attr(not(feature = "all"), allow(dead_code))]

pub mod asset_export;
mod bodies;
pub mod course;
pub mod curve;
mod decoder;
mod disney;
mod files;
#[cfg(feature = "fs")]
pub mod folder;
#[cfg(feature = "gltf")]
mod gltf;
mod growth;
pub mod json;
mod medium;
#[cfg(feature = "mitsuba")]
mod mitsuba;
mod model;
mod number;
pub mod obj;
pub mod packed;
mod panorama;
#[cfg(feature = "pbrt")]
mod pbrt;
pub mod photometry;
mod pictures;
mod ply;
mod polygon;
mod profile_lights;
#[cfg(feature = "radiance")]
mod radiance;
mod report;
pub mod scene;
mod shared_report;
mod signature;
mod smooth;
mod sticks;
mod stl;
#[cfg(feature = "threemf")]
mod threemf;
mod unscattered;
pub mod vol;
#[cfg(any(feature = "mitsuba", feature = "threemf"))]
mod xml;
#[cfg(feature = "threemf")]
mod zip;

pub use decoder::Decoder;
use durer_diag::{Diagnostic, Diagnostics, did_you_mean};
use durer_scene::dialect::QuirkSet;
use durer_scene::scene::Axis;
use durer_scene::shape::mesh::MeshData;
pub use model::SceneFormat;
pub use scene::{SCENE_FORMATS, scene_format_for};
use signature::mistaken;
use std::borrow::Cow;

/// A mesh file format.
pub struct MeshFormat {
    /// Display name.
    pub name: &'static str,
    /// File name extensions in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Returns true if a file with these first bytes seems to be of this format.
    pub recognise: fn(&[u8]) -> bool,
    /// Reads a file; the number is its index, for spans. Returns `None` after pushing errors to the
    /// diagnostics.
    pub read: fn(&[u8], u32, &mut Diagnostics) -> Option<MeshData>,
    /// Returns the part of a file that programs with these quirks read, with all bytes in place.
    pub known: fn(&[u8], QuirkSet) -> Cow<'_, [u8]>,
    /// Writes a mesh.
    pub write: fn(&MeshData) -> Vec<u8>,
    /// Up axis of most models of this format.
    pub up: Axis,
}

/// The mesh formats, in the order in which they are tried on a file of unknown extension.
pub const MESH_FORMATS: &[MeshFormat] = &[ply::FORMAT, obj::FORMAT, stl::FORMAT];

/// Returns the bytes unchanged: no legacy program reads the format.
fn as_it_is(bytes: &[u8], _: QuirkSet) -> Cow<'_, [u8]> {
    Cow::Borrowed(bytes)
}

/// Mesh format for the extension of a file name.
pub fn mesh_format_for(name: &str) -> Option<&'static MeshFormat> {
    let extension = extension(name);
    MESH_FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
}

/// Reads a mesh file. The format follows from the extension of its name or, if that is unknown,
/// from its content.
///
/// `file` is the index of the file in [`Files`](durer_diag::Files), for spans; `name` is its name
/// with the extension.
///
/// Adds all errors to `diagnostics`, with the spans of the offending bytes, and returns `None`. It
/// also returns `None` if `diagnostics` was already full. Adds warnings and notes too; they leave
/// the mesh usable.
pub fn read_mesh(bytes: &[u8], file: u32, name: &str, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    read_mesh_as(bytes, file, name, 0, diagnostics)
}

/// Reads a mesh file as [`read_mesh`] does, with quirks of legacy programs.
pub fn read_mesh_as(
    bytes: &[u8],
    file: u32,
    name: &str,
    quirks: QuirkSet,
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

/// Returns an error if a file of this size is too large: spans are 32-bit.
fn too_large(size: u64, name: &str) -> Option<Diagnostic> {
    const MOST: u64 = u32::MAX as u64 - 1;
    let message = || format!("`{name}` is too large for a mesh file: {size} bytes, at most {MOST}");
    (size > MOST).then(|| Diagnostic::error(message()).help("cut the mesh into several files"))
}

/// Extension of a file name in lower case, without the dot; empty if there is none.
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
    let suggestion = did_you_mean(&extension, all).filter(|_| !extension.is_empty());
    let known = MESH_FORMATS.iter().map(|f| format!("{} (.{})", f.name, f.extensions.join(", .")));
    let known = known.collect::<Vec<_>>().join(", ");
    Diagnostic::error(format!("`{name}` is not a mesh file of a known format")).help(match suggestion {
        Some(suggestion) => format!("did you mean `.{suggestion}`? Known are {known}"),
        None => format!("known are {known}"),
    })
}

#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
