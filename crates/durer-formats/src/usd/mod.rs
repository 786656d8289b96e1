//! Reader of OpenUSD scenes: text (`.usda`), binary (`.usdc`) and packages (`.usdz`), with
//! sublayers, references, payloads, inheritance and variants. `write/` writes text.
//!
//! Sources: *OpenUSD specification* and *OpenUSD documentation* (UsdGeom, UsdLux, UsdShade);
//! *UsdPreviewSurface Specification*, version 2.6.

mod binary;
mod binary_values;
mod camera;
mod codec;
mod curves;
mod files;
mod instancer;
mod layer;
mod lexer;
mod light;
mod material;
mod mesh;
mod primvar;
mod reader;
mod shader;
mod shape;
mod skel;
mod stage;
#[cfg(test)]
mod tests;
mod text;
mod time;
mod transform;
mod traverse;
mod write;

use super::growth::ResourceLimits;
use super::model::{ReadInput, SceneFormat};
use super::shared_report::SharedReport;
use super::too_large;
use durer_diag::{Diagnostic, Diagnostics};
use durer_scene::math::Vec3;
use durer_scene::scene::{Axis, Background, Group, Scene};
use files::LayerFiles;
use layer::{Layer, Value};
use reader::{Inherited, Invisible, Reader};
use stage::Stage;
use time::SampleTime;

/// Entry for USD in the list of scene formats.
pub(super) const FORMAT: SceneFormat = SceneFormat {
    name: "USD",
    extensions: &["usda", "usdc", "usdz", "usd"],
    recognise,
    read,
    write: Some(write::write),
    up: Axis::Y,
    is_complete_scene: false,
    light_hint: Some("add a light, for example `def DomeLight \"Light\" {}`"),
};

/// Returns true for text and binary layers. A package is recognised by its extension, since it is a
/// ZIP archive.
fn recognise(bytes: &[u8]) -> bool {
    bytes.starts_with(binary::MAGIC) || bytes.starts_with(b"#usda")
}

/// Reads a file; see [`read_model`](super::scene::read_model).
fn read(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    if let Some(error) = too_large(input.bytes.len() as u64, input.name) {
        diagnostics.push(error);
        return None;
    }
    let report = SharedReport::default();
    let limits = ResourceLimits::of_file(input.bytes.len(), input.memory);
    let scene = scene(input, &report, &limits);
    let is_sound = !report.has_errors() && !diagnostics.has_errors();
    diagnostics.extend(report.finish());
    if !input.bytes.starts_with(b"#") {
        // Positions in binary data cannot be shown.
        input.files.borrow_mut().truncate(input.file, 0, diagnostics);
    }
    scene.filter(|_| is_sound)
}

fn scene(input: &ReadInput, report: &SharedReport, limits: &ResourceLimits) -> Option<Scene> {
    let (files, root) = LayerFiles::open(input, report, limits)?;
    files.time.set(time_of(input, &root));
    // A binary layer holds only the samples for the time that was known when it was read.
    let root = match (files.time.get(), root.is_binary) {
        (SampleTime::At(_), true) => files.root_again(&root.name)?,
        _ => root,
    };
    let stage = Stage::open(&files, root, input.scene_defaults.variant.as_deref());
    let mut reader = Reader::new(&stage);
    reader.scene.up = match stage.root_layer.field("upAxis").and_then(Value::text) {
        Some("Z") => Some(Axis::Z),
        _ => Some(Axis::Y),
    };
    let mut objects = Vec::new();
    for prim in stage.children(&stage.root()) {
        reader.visit(&prim, &Inherited::default(), &mut objects, 0);
    }
    stage.check_variant();
    reader.set_camera();
    let (mut scene, has_dome, invisible) = (reader.scene, reader.has_dome, reader.invisible);
    if !has_dome && scene.is_lit {
        scene.background = Background { color: Vec3::ZERO, ..scene.background };
    }
    if objects.is_empty() && !report.has_errors() {
        report.push(no_surfaces(&invisible));
    }
    if let (Some((first, ..)), false) = (invisible.first(), objects.is_empty()) {
        let message = match invisible.len() {
            1 => "this prim is left out: it is not visible in renders".to_string(),
            count => format!("this prim and {} others are left out: they are not visible in renders", count - 1),
        };
        report.push(Diagnostic::note(message).code("left-out").at(*first));
    }
    scene.root = Some(Group { objects }).filter(|root| !root.objects.is_empty());
    Some(scene)
}

/// Returns the warning about a scene without surfaces, at the first of the invisible prims.
fn no_surfaces(invisible: &[Invisible]) -> Diagnostic {
    let message = "the scene has no visible surfaces";
    let Some((first, attribute, value)) = invisible.first() else {
        return Diagnostic::warning(message).code("no-objects");
    };
    let same = invisible.iter().filter(|(_, other, _)| other == attribute).count();
    let message = match same {
        1 => format!("{message}: the `{attribute}` of this prim is `{value}`"),
        count => format!("{message}: the `{attribute}` of this prim and of {} more is `{value}`", count - 1),
    };
    let help = match *attribute {
        "purpose" => "prims with this purpose are not rendered: remove `purpose`, or write `default`",
        _ => "remove `visibility`, or write `inherited`",
    };
    Diagnostic::warning(message).code("no-objects").at(*first).help(help)
}

/// Returns the time at which attributes are read: the requested time in seconds, or the start of
/// the animation.
fn time_of(input: &ReadInput, root: &Layer) -> SampleTime {
    let number = |name: &str| root.field(name).and_then(Value::number);
    let start = number("startTimeCode");
    match (input.scene_defaults.animation_time, start) {
        (Some(seconds), _) => SampleTime::At(start.unwrap_or(0.0) + f64::from(seconds) * root.time_codes_per_second()),
        (None, Some(start)) => SampleTime::At(start),
        (None, None) => SampleTime::First,
    }
}
