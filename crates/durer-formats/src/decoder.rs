//! Decoder of asset files that is used by the renderer.

use crate::{curve, photometry, read_mesh_as, vol};
use durer_diag::Diagnostics;
use durer_scene::asset::AssetDecoder;
use durer_scene::dialect::QuirkSet;
use durer_scene::light::PhotometricProfile;
use durer_scene::math::Aabb;
use durer_scene::medium::DensityGrid;
use durer_scene::shape::MeshData;

/// Decoder of meshes, pictures, and other asset files. The renderer uses it for all formats of this
/// crate.
#[derive(Clone, Copy, Debug, Default)]
pub struct Decoder;

impl AssetDecoder for Decoder {
    fn mesh(
        &self,
        bytes: &[u8],
        file: u32,
        name: &str,
        quirks: QuirkSet,
        diagnostics: &mut Diagnostics,
    ) -> Option<MeshData> {
        read_mesh_as(bytes, file, name, quirks, diagnostics)
    }

    fn profile(&self, bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<PhotometricProfile> {
        photometry::read(bytes, file, diagnostics)
    }

    fn spectrum(
        &self,
        bytes: &[u8],
        column: Option<&str>,
        file: u32,
        diagnostics: &mut Diagnostics,
    ) -> Option<Vec<[f32; 2]>> {
        curve::read(bytes, column, file, diagnostics)
    }

    fn density(
        &self,
        bytes: &[u8],
        file: u32,
        memory: u64,
        diagnostics: &mut Diagnostics,
    ) -> Option<(Aabb, DensityGrid)> {
        vol::read(bytes, file, memory, diagnostics)
    }
}
