//! Reads mesh files for programs that need triangles and no scene.

use crate::error::{Error, SceneError};
use durer_diag::{Diagnostics, Files};
use durer_formats::folder::FolderSource;
use durer_formats::read_mesh;
use durer_scene::shape::MeshData;
use std::path::Path;

/// Reads a mesh file: PLY, Wavefront OBJ, STL or OFF. The extension of the file name determines the
/// format; if the extension is unknown, the content of the file does.
///
/// # Errors
///
/// Returns [`Error::Source`] if the file cannot be read and [`Error::Scene`] if it contains errors.
pub fn open_mesh(path: impl AsRef<Path>) -> Result<MeshData, Error> {
    let path = path.as_ref();
    let name = path.display().to_string();
    let bytes = FolderSource::new(".").allow_outside().read_path(path, &name)?;
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let file = files.add(&*name, bytes.clone());
    read_mesh(&bytes, file, &name, &mut diagnostics).ok_or_else(|| SceneError::new(diagnostics, files).into())
}
