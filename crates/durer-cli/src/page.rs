//! Common parts of the HTML pages. The pages contain their pictures and data and need no network
//! access.

use crate::failure::Failure;
use crate::output::{encode, format};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use durer::image::{Layer, Transfer};
use serde_json::Value;
use std::path::Path;

/// Encodes a picture as PNG.
pub fn png(layer: Layer, transfer: Transfer) -> Result<Vec<u8>, Failure> {
    encode(format(Path::new("picture.png"))?, &[layer], transfer, &[])
}

/// Returns a PNG as a data URI.
pub fn uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}

/// Style and script shared by all pages.
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Fills in the placeholders `@STYLE@`, `@SCRIPT@` and `@DATA@` of a template.
pub fn with_data(page: &str, data: &Value) -> String {
    let page = page.replacen("@STYLE@", STYLE, 1).replacen("@SCRIPT@", SCRIPT, 1);
    // Escape `<` so that the data cannot end the script element.
    page.replacen("@DATA@", &data.to_string().replace('<', "\\u003c"), 1)
}
