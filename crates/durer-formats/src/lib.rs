//! Readers and writers of file formats. Each format has its own file or folder and one entry in
//! [`MESH_FORMATS`] or [`SCENE_FORMATS`].
//!
//! Files that are read may be malicious. Therefore, readers allocate memory in proportion to the
//! number of bytes in the file, never according to a count that the file states. Readers also
//! reject non-finite numbers and indices that are out of range, and they report errors with spans.

// If a format is disabled at compile time, code shared by several formats may be unused.
#![cfg_attr(not(feature = "all"), allow(dead_code))]

pub mod asset_export;
#[cfg(feature = "collada")]
mod collada;
pub mod course;
pub mod curve;
mod decoder;
mod disney;
mod emitters_only;
mod export;
mod face_colors;
mod files;
#[cfg(feature = "fs")]
pub mod folder;
mod glass_bodies;
#[cfg(feature = "gltf")]
mod gltf;
mod growth;
pub mod gzip;
pub mod json;
mod medium;
#[cfg(feature = "mitsuba")]
mod mitsuba;
mod model;
mod named_choice;
mod number;
pub mod obj;
mod off;
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
#[cfg(feature = "usd")]
mod usd;
pub mod vol;
pub mod weather;
#[cfg(any(feature = "collada", feature = "mitsuba", feature = "threemf"))]
mod xml;
#[cfg(any(feature = "threemf", feature = "usd"))]
mod zip;

pub use decoder::Decoder;
use durer_diag::{Diagnostic, Diagnostics, did_you_mean};
use durer_scene::dialect::QuirkSet;
use durer_scene::scene::Axis;
use durer_scene::shape::mesh::MeshData;
pub use model::SceneFormat;
pub use scene::{SCENE_FORMATS, scene_format_for, scene_writer_for};
use signature::wrong_format_error;
use std::borrow::Cow;

/// File format for a single mesh, with its name, extensions, reader, and writer.
pub struct MeshFormat {
    /// Name of the format for display.
    pub name: &'static str,
    /// File name extensions in lower case, without the leading dot.
    pub extensions: &'static [&'static str],
    /// Returns true if a file that begins with these bytes appears to be in this format.
    pub recognise: fn(&[u8]) -> bool,
    /// Reads a file; the number is the index of the file, for spans. If there are errors, adds them
    /// to the diagnostics and returns `None`.
    pub read: fn(&[u8], u32, &mut Diagnostics) -> Option<MeshData>,
    /// Returns the file as legacy programs with these quirks read it: the parts that they ignore
    /// are cut off or overwritten so that byte offsets stay valid.
    pub apply_quirks: fn(&[u8], QuirkSet) -> Cow<'_, [u8]>,
    /// Writes a mesh.
    pub write: fn(&MeshData) -> Vec<u8>,
    /// Up axis that most models in this format use.
    pub up: Axis,
}

/// Mesh formats, in the order in which they are tried for a file with an unknown extension.
pub const MESH_FORMATS: &[MeshFormat] = &[ply::FORMAT, obj::FORMAT, stl::FORMAT, off::FORMAT];

/// Returns the bytes unchanged, for formats that no legacy program reads.
fn without_quirks(bytes: &[u8], _: QuirkSet) -> Cow<'_, [u8]> {
    Cow::Borrowed(bytes)
}

/// Returns the mesh format that a file name indicates by its extension.
pub fn mesh_format_for(name: &str) -> Option<&'static MeshFormat> {
    let extension = extension(name);
    MESH_FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
}

/// Reads a mesh file. The extension of the file name determines the format; if the extension is
/// unknown, the content of the file does.
///
/// `file` is the index of the file in [`Files`](durer_diag::Files), for spans; `name` is its name
/// with the extension.
///
/// If there are errors, adds them all to `diagnostics`, with the spans of the bytes that caused
/// them, and returns `None`. Also returns `None` if `diagnostics` was already full. Warnings and
/// notes are also added, but the mesh can still be used.
pub fn read_mesh(bytes: &[u8], file: u32, name: &str, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    read_mesh_as(bytes, file, name, 0, diagnostics)
}

/// Reads a mesh file as [`read_mesh`] does, but in the way that legacy programs with these quirks
/// would.
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
    if let Some(error) = wrong_format_error(bytes, file, name, format.map_or(&[], |format| format.extensions)) {
        diagnostics.push(error);
        return None;
    }
    match format {
        Some(format) => (format.read)(&(format.apply_quirks)(bytes, quirks), file, diagnostics),
        None => {
            diagnostics.push(unknown_format(name));
            None
        }
    }
}

/// Returns an error if a file of this size is too large for spans, which have 32-bit offsets.
fn too_large(size: u64, name: &str) -> Option<Diagnostic> {
    const MAX_SIZE: u64 = u32::MAX as u64 - 1;
    let message = || format!("`{name}` has {size} bytes, but a mesh file can have at most {MAX_SIZE} bytes");
    (size > MAX_SIZE).then(|| Diagnostic::error(message()).help("split the mesh into several files"))
}

/// Returns the extension of a file name in lower case, without the leading dot, or an empty string
/// if there is none.
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
    let is_model = scene::scene_format_for(name).is_some();
    Diagnostic::error(format!("`{name}` is not a mesh file of a known format")).help(match suggestion {
        _ if is_model => format!(
            "convert the model first, with `durer convert {name} -o {}` for its triangles",
            std::path::Path::new(name).with_extension("ply").display()
        ),
        Some(suggestion) => format!("did you mean `.{suggestion}`? Known formats are {known}"),
        None => format!("known formats are {known}"),
    })
}

#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
