//! Reader of COLLADA scenes (`.dae`).
//!
//! Source: *COLLADA: Digital Asset Schema Release 1.4.1*, Khronos, 2008, and *1.5.0*. Materials
//! are those of the common profile. Meshes follow their skeletons in the pose that the nodes have;
//! animations and morph targets are left out.

mod camera;
mod document;
mod light;
mod material;
mod mesh;
mod parts;
mod reader;
mod shader;
mod skin;
mod source;
#[cfg(test)]
mod tests;
mod transform;

use super::growth::ResourceLimits;
use super::model::{ReadInput, SceneFormat};
use super::shared_report::SharedReport;
use super::{too_large, xml};
use durer_diag::Diagnostics;
use durer_scene::scene::{Axis, Scene};
use std::sync::Arc;

/// Entry for COLLADA in the list of scene formats.
pub(super) const FORMAT: SceneFormat = SceneFormat {
    name: "COLLADA",
    extensions: &["dae"],
    recognise,
    read,
    write: None,
    up: Axis::Y,
    is_complete_scene: false,
    light_hint: Some("add a light to `library_lights`, and an `instance_light` to a node"),
};

/// Returns true for XML with the root element of COLLADA.
fn recognise(bytes: &[u8]) -> bool {
    xml::has_root(bytes, &["COLLADA"])
}

/// Reads a file; see [`read_model`](super::scene::read_model).
fn read(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    if let Some(error) = too_large(input.bytes.len() as u64, input.name) {
        diagnostics.push(error);
        return None;
    }
    let report = SharedReport::default();
    let limits = ResourceLimits::of_file(input.bytes.len(), input.memory);
    let bytes = xml::utf8(input.bytes.clone());
    let is_changed = !Arc::ptr_eq(&bytes, input.bytes);
    let file = if is_changed { input.files.borrow_mut().add(input.name, bytes.clone()) } else { input.file };
    let scene = match document::parse(&bytes, file, &limits, &report) {
        Ok(root) => reader::scene(&root, input, &report, &limits),
        Err(error) => {
            report.push(*error);
            None
        }
    };
    let is_sound = !report.has_errors() && !diagnostics.has_errors();
    diagnostics.extend(report.finish());
    scene.filter(|_| is_sound)
}
