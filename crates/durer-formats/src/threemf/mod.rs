//! Reader of files in the 3MF format for 3D printing, which stores models in a ZIP archive.
//!
//! Sources: *3D Manufacturing Format, Core Specification* 1.3; *Materials and Properties Extension*
//! 1.2; *Production Extension* 1.1; *Beam Lattice Extension* 1.2; 3MF Consortium. All lengths are
//! converted to millimetres.

mod colors;
mod convert;
mod mesh;
mod model;
mod package;
mod parser;

#[cfg(test)]
mod tests;

use super::model::{ReadInput, SceneFormat};
use super::shared_report::SharedReport;
use super::{too_large, zip};
use durer_diag::Diagnostics;
use durer_scene::scene::{Axis, Scene};

/// Entry for 3MF in the list of scene formats.
pub(super) const FORMAT: SceneFormat = SceneFormat {
    name: "3MF",
    extensions: &["3mf"],
    recognise,
    read,
    write: None,
    up: Axis::Z,
    is_complete_scene: false,
    light_hint: None,
};

/// Returns true for ZIP archives, because no other supported format is based on ZIP.
fn recognise(bytes: &[u8]) -> bool {
    zip::recognise(bytes)
}

/// Reads a 3MF file; see [`read_model`](super::scene::read_model).
fn read(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    if let Some(error) = too_large(input.bytes.len() as u64, input.name) {
        diagnostics.push(error);
        return None;
    }
    let report = SharedReport::default();
    let scene = package::Package::open(input, &report).and_then(|package| convert::scene(package, &report));
    let sound = !report.has_errors() && !diagnostics.has_errors();
    diagnostics.extend(report.finish());
    scene.filter(|_| sound)
}
