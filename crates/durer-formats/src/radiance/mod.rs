//! Reader of Radiance scenes, in `.rad` files (geometry and materials), `.rif` files (lists of
//! files and views) and `.vf` files (views).
//!
//! Sources: *The RADIANCE 5.4 Synthetic Imaging System*, reference manual; the manual pages of
//! xform, genbox, genprism, gensky, rad and rpict. As in Radiance's own pictures, a pixel value of
//! 1 is a radiance of 1 W/(sr m²). Multiplying the pixel value by 179 gives the luminance in cd/m².

mod args;
mod body;
mod chain;
mod command;
mod context;
mod converted;
mod data;
mod directional;
mod distribution;
mod gensky;
mod material;
mod mixture;
mod outline;
mod pattern;
mod rif;
mod sky;
mod source;
mod standard;
mod state;
mod surface;
mod unused_materials;
mod view;
mod words;
mod xform;

#[cfg(test)]
mod tests;

use super::model::{ReadInput, SceneFormat};
use super::shared_report::SharedReport;
use super::too_large;
use context::PrimitiveContext;
use durer_diag::{Diagnostic, Diagnostics};
use durer_scene::math::Vec3;
use durer_scene::scene::{Axis, Scene};
use state::Reader;

/// Entry for Radiance in the list of scene formats.
pub(super) const FORMAT: SceneFormat = SceneFormat {
    name: "Radiance",
    extensions: &["rad", "rif"],
    // The first word of a file is not distinctive, so the format is recognized only by the file
    // extension.
    recognise: |_| false,
    read,
    write: None,
    up: Axis::Z,
    is_complete_scene: true,
    light_hint: Some("give a surface the material `light`, or a `source` with `glow`"),
};

/// Reads a file; see [`read_model`](super::scene::read_model).
fn read(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    if let Some(error) = too_large(input.bytes.len() as u64, input.name) {
        diagnostics.push(Diagnostic { message: error.message.replace("mesh file", "scene"), help: None, ..error });
        return None;
    }
    let report = SharedReport::default();
    let mut reader = Reader::new(input, &report);
    match input.name.to_lowercase().ends_with(".rif") {
        true => reader.rif(),
        false => reader.text(input.bytes, input.file, &PrimitiveContext::default()),
    }
    let mut scene = reader.finish();
    // The value of 179 lm/W and the weights of the three colours are from the manual of rtrace.
    scene.lumens_per_watt = Some(179.0 * Vec3::new(0.265, 0.670, 0.065));
    let sound = !report.has_errors() && !diagnostics.has_errors();
    diagnostics.extend(report.finish());
    sound.then_some(scene)
}

/// Sets the camera of a scene to the last view in a file.
pub(super) fn set_view(
    scene: &mut Scene,
    input: &ReadInput,
    (name, bytes): (&str, &std::sync::Arc<[u8]>),
) -> Diagnostics {
    let report = SharedReport::default();
    let file = input.files.borrow_mut().add(name, bytes.clone());
    if let Some(view) = view::last_view(bytes, file, &report) {
        view.apply(scene, view::DEFAULT_SIZE, &report);
    }
    report.finish()
}
