//! Decoding of the files that a scene names.

use crate::dialect::QuirkSet;
use crate::light::Profile;
use crate::math::Aabb;
use crate::medium::DensityGrid;
use crate::shape::MeshData;
use durer_diag::Diagnostics;

/// Decodes asset files other than images. `durer-formats` implements it for all its formats.
///
/// `file` is the index of the file, for spans. On an error a method pushes a diagnostic and returns
/// `None`.
pub trait AssetDecoder: Sync {
    /// Decodes a mesh. The format follows from the extension of `name`, else from the bytes.
    fn mesh(
        &self,
        bytes: &[u8],
        file: u32,
        name: &str,
        quirks: QuirkSet,
        diagnostics: &mut Diagnostics,
    ) -> Option<MeshData>;

    /// Decodes a photometric file (IES, EULUMDAT).
    fn profile(&self, bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<Profile>;

    /// Decodes a measured spectrum into ascending rows of wavelength (nm) and value. `column` picks
    /// one of several by name; `None` is the first.
    fn spectrum(
        &self,
        bytes: &[u8],
        column: Option<&str>,
        file: u32,
        diagnostics: &mut Diagnostics,
    ) -> Option<Vec<[f32; 2]>>;

    /// Decodes a grid of densities and its bounds, in at most `memory` bytes.
    fn density(
        &self,
        bytes: &[u8],
        file: u32,
        memory: u64,
        diagnostics: &mut Diagnostics,
    ) -> Option<(Aabb, DensityGrid)>;
}
