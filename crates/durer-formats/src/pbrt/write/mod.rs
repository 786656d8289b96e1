//! Writer of pbrt-v4 scenes, with meshes as PLY and pictures in a folder beside the scene. It is
//! the inverse of the reader.
//!
//! Source: *Input File Format*, pbrt.org/fileformat-v4. Content without a counterpart is reported
//! once for each message, and the report has no span.

mod light;
mod material;
mod shape;
mod text;
mod view;

#[cfg(test)]
mod tests;

use crate::export::Export;
use crate::export::surface::Look;
use crate::model::{WriteContext, Written};
use durer_diag::Diagnostics;
use durer_scene::scene::Scene;
use std::collections::BTreeMap;

/// Name of the program, for messages.
const PROGRAM: &str = "pbrt";

/// Writer that converts one scene.
struct Writer<'a> {
    export: Export<'a>,
    /// Materials by number. The key is `None` for objects without a material.
    looks: BTreeMap<Option<u32>, Look>,
    /// Textures, materials and media, which precede the shapes that name them.
    named: String,
    /// Numbers of the textures that have been written, by their parameters.
    textures: BTreeMap<String, usize>,
}

/// Encodes a scene as text.
pub(crate) fn write(scene: &Scene, context: &WriteContext, diagnostics: &mut Diagnostics) -> Written {
    let mut writer = Writer {
        export: Export::new(scene, context, diagnostics),
        looks: BTreeMap::new(),
        named: String::new(),
        textures: BTreeMap::new(),
    };
    let mut text = format!("# Written by Dürer {}\n", env!("CARGO_PKG_VERSION"));
    text += &writer.view();
    text += "WorldBegin\n\n";
    let lights = writer.lights();
    let shapes = writer.shapes();
    text += &format!("{}\n{lights}\n{shapes}", writer.named);
    Written { bytes: text.into_bytes(), files: writer.export.finish() }
}
