//! What pages for a browser have in common: pictures and data within the one file, no network.

use crate::failure::Failure;
use crate::output::{encode, format};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use durer::image::{Layer, Transfer};
use serde_json::Value;
use std::path::Path;

/// A picture as PNG.
pub fn png(layer: Layer, transfer: Transfer) -> Result<Vec<u8>, Failure> {
    encode(format(Path::new("picture.png"))?, &[layer], transfer, &[])
}

/// A PNG as an address that holds it.
pub fn uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}

/// What all pages share: looks, and the beginning of their scripts.
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// A page with what all share, where `@STYLE@` and `@SCRIPT@` stand in it, and its data.
pub fn with_data(page: &str, data: &Value) -> String {
    let page = page.replacen("@STYLE@", STYLE, 1).replacen("@SCRIPT@", SCRIPT, 1);
    // Nothing in the data can end the script that holds them.
    page.replacen("@DATA@", &data.to_string().replace('<', "\\u003c"), 1)
}
