//! Reader of Mitsuba 3 scenes in XML, and of those Mitsuba 0.6 scenes that use the same plugins.
//!
//! Source: *Mitsuba 3 documentation*, "Plugin reference", versions of 2022 to 2025. A scene
//! consists of plugins (shapes, materials, lights), which contain properties and other plugins. A
//! pixel value of 1 is a radiance of 1.

mod camera;
mod color;
mod curve;
mod defs;
mod light;
mod load;
mod material;
mod medium;
mod metals;
mod plugin;
mod principled;
mod rough;
mod serialized;
mod shape;
mod sky;
mod state;
mod tessellate;
mod texture;
mod transform;
mod write;

#[cfg(test)]
mod tests;

use super::model::{ReadInput, SceneFormat};
use super::shared_report::SharedReport;
use super::{too_large, xml};
use durer_diag::{Diagnostic, Diagnostics};
use durer_scene::scene::{Axis, Scene};
use load::Loader;
use state::Reader;

/// Entry for Mitsuba in the list of scene formats.
pub(super) const FORMAT: SceneFormat = SceneFormat {
    name: "Mitsuba",
    extensions: &["xml"],
    recognise,
    read,
    write: Some(write::write),
    up: Axis::Y,
    is_complete_scene: true,
    light_hint: Some(
        "write `<emitter type=\"area\"/>` in a shape, or `<emitter type=\"constant\"/>` in the scene: an environment is a light too",
    ),
};

/// Returns true if a file begins with `<scene>`.
fn recognise(bytes: &[u8]) -> bool {
    xml::has_root(bytes, &["scene"])
}

/// Reads a file; see [`read_model`](super::scene::read_model).
fn read(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    if let Some(error) = too_large(input.bytes.len() as u64, input.name) {
        diagnostics.push(Diagnostic { message: error.message.replace("mesh file", "scene"), help: None, ..error });
        return None;
    }
    let report = SharedReport::default();
    let mut loader = Loader::new(input, &report);
    let scene = match loader.scene() {
        Ok(all) => Some(Reader::new(input, &report, loader).read(&all)),
        Err(_) => None,
    };
    let sound = !report.has_errors() && !diagnostics.has_errors();
    diagnostics.extend(report.finish());
    scene.filter(|_| sound)
}
