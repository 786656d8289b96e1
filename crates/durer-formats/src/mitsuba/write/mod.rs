//! Writer of Mitsuba 3 scenes in XML, with meshes as PLY and pictures in a folder beside the scene.
//! It is the inverse of the reader.
//!
//! Source: *Mitsuba 3 documentation*, "Plugin reference", version 3.9. Content without a
//! counterpart is reported once for each message, and the report has no span.

mod bsdf;
mod element;
mod emitter;
mod sensor;
mod shape;

#[cfg(test)]
mod tests;

use crate::export::Export;
use crate::export::surface::Look;
use crate::model::{WriteContext, Written};
use durer_diag::Diagnostics;
use durer_scene::scene::Scene;
use element::Element;
use std::collections::BTreeMap;

/// Name of the program, for messages.
const PROGRAM: &str = "Mitsuba";

/// Writer that converts one scene.
struct Writer<'a> {
    export: Export<'a>,
    /// Materials by number. The key is `None` for objects without a material.
    looks: BTreeMap<Option<u32>, Look>,
    /// Elements that shapes refer to by their id.
    shared: Vec<Element>,
    /// True if the scene contains a participating medium.
    has_medium: bool,
}

/// Encodes a scene as XML.
pub(crate) fn write(scene: &Scene, context: &WriteContext, diagnostics: &mut Diagnostics) -> Written {
    let mut writer = Writer {
        export: Export::new(scene, context, diagnostics),
        looks: BTreeMap::new(),
        shared: Vec::new(),
        has_medium: false,
    };
    let shapes = writer.shapes();
    let emitters = writer.emitters();
    let sensor = writer.sensor();
    let root = Element::new("scene")
        .with("version", "3.0.0")
        .and(writer.integrator())
        .and_all(sensor)
        .and_all(std::mem::take(&mut writer.shared))
        .and_all(shapes)
        .and_all(emitters);
    let mut text = String::new();
    root.write(0, &mut text);
    Written { bytes: text.into_bytes(), files: writer.export.finish() }
}
