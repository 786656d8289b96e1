//! Interface for decoding the mesh files, photometric files, spectra and density grids that a scene
//! refers to.

use crate::dialect::QuirkSet;
use crate::light::PhotometricProfile;
use crate::math::Aabb;
use crate::medium::DensityGrid;
use crate::shape::MeshData;
use durer_diag::Diagnostics;

/// Decoder for a scene's asset files other than images, implemented by `durer-formats`.
///
/// `file` is the index by which source spans refer to the file. If a file is invalid, a method
/// pushes a diagnostic and returns `None`.
pub trait AssetDecoder: Sync {
    /// Decodes a mesh. The format is determined from the extension of `name`, or otherwise from the
    /// content.
    fn mesh(
        &self,
        bytes: &[u8],
        file: u32,
        name: &str,
        quirks: QuirkSet,
        diagnostics: &mut Diagnostics,
    ) -> Option<MeshData>;

    /// Decodes a photometric file (IES, EULUMDAT).
    fn profile(&self, bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<PhotometricProfile>;

    /// Decodes a measured spectrum into rows of wavelength (nm) and value, in ascending order of
    /// wavelength. `column` selects one of several spectra by name; `None` selects the first.
    fn spectrum(
        &self,
        bytes: &[u8],
        column: Option<&str>,
        file: u32,
        diagnostics: &mut Diagnostics,
    ) -> Option<Vec<[f32; 2]>>;

    /// Decodes a density grid and its bounds, using at most `memory` bytes.
    fn density(
        &self,
        bytes: &[u8],
        file: u32,
        memory: u64,
        diagnostics: &mut Diagnostics,
    ) -> Option<(Aabb, DensityGrid)>;
}
