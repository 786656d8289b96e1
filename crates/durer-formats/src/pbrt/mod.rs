//! Reader of pbrt-v4 and pbrt-v3 scenes. Every directive is parsed, and features without a
//! counterpart in Dürer are reported.
//!
//! Sources: *Input File Format*, pbrt.org/fileformat-v4 and pbrt.org/fileformat-v3; Pharr, Jakob
//! and Humphreys, *Physically Based Rendering*, 4th edition, 2023, and 3rd edition, 2016.
//! Directives change a graphics state, and each shape or light uses the state that is current when
//! it is created.

mod camera;
mod curve;
pub(super) mod defs;
mod directives;
pub(super) mod environment;
mod image_lights;
mod language;
mod lexer;
mod light;
mod material;
pub(super) mod medium;
pub(super) mod mesh;
mod named;
mod params;
mod quadrics;
pub(super) mod shape;
mod spectra;
pub(super) mod state;
mod surfaces;
mod texture;
mod transform;
mod write;

#[cfg(test)]
mod tests;

use super::model::{ReadInput, SceneFormat};
use super::shared_report::SharedReport;
use super::too_large;
use directives::DIRECTIVES;
use durer_diag::{Diagnostic, Diagnostics};
use durer_scene::scene::{Axis, Scene};
use lexer::{Lexer, Token};
use state::Reader;

/// Entry for pbrt in the list of scene formats.
pub(super) const FORMAT: SceneFormat = SceneFormat {
    name: "pbrt",
    extensions: &["pbrt"],
    recognise,
    read,
    write: Some(write::write),
    up: Axis::Y,
    is_complete_scene: true,
    light_hint: Some(
        "write `AreaLightSource \"diffuse\"` before a shape, or `LightSource \"infinite\"`: an environment is a light too",
    ),
};

/// Returns true if a file begins with a directive that exists only in pbrt. The directives
/// `Transform` and `Material` do not count, because files in the course's format can begin with
/// them too.
fn recognise(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(1 << 12)];
    let (mut text, report) = (Lexer::new(head.into(), 0), SharedReport::default());
    let is_text = |token: Option<&Token>| matches!(token, Some(Token::Text(_)));
    let Some(first) = text.next(&report).filter(|next| next.token == Token::Word) else { return false };
    let word = text.word(first.at).to_string();
    match DIRECTIVES.iter().find(|row| row.0 == word) {
        Some((_, true)) => is_text(text.peek(&report).map(|next| &next.token)),
        Some(_) => matches!(word.as_str(), "LookAt" | "WorldBegin" | "AttributeBegin" | "ReverseOrientation"),
        None => false,
    }
}

/// Reads a file; see [`read_model`](super::scene::read_model).
fn read(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    if let Some(error) = too_large(input.bytes.len() as u64, input.name) {
        diagnostics.push(Diagnostic { message: error.message.replace("mesh file", "scene"), help: None, ..error });
        return None;
    }
    let report = SharedReport::default();
    let scene = Reader::new(input, language::decide(input), &report).read();
    let sound = !report.has_errors() && !diagnostics.has_errors();
    diagnostics.extend(report.finish());
    sound.then_some(scene)
}
