//! Writer of OpenUSD scenes as text, with pictures in a folder beside the scene. It is the inverse
//! of the reader.
//!
//! Sources: *OpenUSD documentation* (UsdGeom, UsdLux, UsdShade); *UsdPreviewSurface Specification*,
//! version 2.6. Content without a counterpart is reported once for each message, and the report has
//! no span.

mod light;
mod material;
mod prim;
mod shape;
mod view;

#[cfg(test)]
mod tests;

use crate::export::Export;
use crate::model::{WriteContext, Written};
use durer_diag::Diagnostics;
use durer_scene::scene::{Axis, Scene};
use material::Bound;
use prim::Prim;
use std::collections::BTreeMap;

/// Name of the format, for messages.
const PROGRAM: &str = "USD";

/// Writer that converts one scene.
struct Writer<'a> {
    export: Export<'a>,
    /// Materials by number, of which the prims are in `material_prims`. The key is `None` for
    /// objects without a material.
    materials: BTreeMap<Option<u32>, Bound>,
    material_prims: Vec<Prim>,
    /// Meshes that occur several times.
    prototypes: Vec<Prim>,
    /// True once a light is written.
    has_light: bool,
}

/// Encodes a scene as text.
pub(crate) fn write(scene: &Scene, context: &WriteContext, diagnostics: &mut Diagnostics) -> Written {
    let mut export = Export::new(scene, context, diagnostics);
    export.has_sun_size = true;
    let mut writer = Writer {
        export,
        materials: BTreeMap::new(),
        material_prims: Vec::new(),
        prototypes: Vec::new(),
        has_light: false,
    };
    let shapes = writer.shapes();
    let lights = writer.lights();
    let camera = writer.camera();
    if scene.fog.is_some() {
        writer.export.warn_lost("fog cannot be written to USD: it is left out");
    }
    let mut world = Prim::new("Xform", "World");
    world.children.extend(camera);
    if !writer.material_prims.is_empty() {
        let mut scope = Prim::new("Scope", "Materials");
        scope.children = std::mem::take(&mut writer.material_prims);
        world.children.push(scope);
    }
    world.children.extend(shapes);
    world.children.extend(lights);
    let up = if scene.up == Some(Axis::Z) { "Z" } else { "Y" };
    let mut text =
        format!("#usda 1.0\n(\n    defaultPrim = \"World\"\n    metersPerUnit = 1\n    upAxis = \"{up}\"\n)\n");
    for prim in writer.prototypes.iter().chain([&world]) {
        text.push('\n');
        prim.write(0, &mut text);
    }
    Written { bytes: text.into_bytes(), files: writer.export.finish() }
}
