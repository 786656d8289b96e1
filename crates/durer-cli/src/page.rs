//! The HTML reports. A report is one file, built from `web/src/report`, with its data. It needs no
//! network access.

mod types;

use crate::failure::Failure;
use crate::output::{encode, format};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use durer::image::{Layer, Transfer};
use std::path::Path;
pub use types::*;

/// The report without data.
const PAGE: &str = include_str!("../../../web/dist-report/report.html");
/// Marks the place of the data in the report.
const PLACE: &str = "@DATA@";

/// Encodes a picture as PNG.
pub fn png(layer: Layer, transfer: Transfer) -> Result<Vec<u8>, Failure> {
    encode(format(Path::new("picture.png"))?, &[layer], transfer, &[])
}

/// Returns a PNG as a data URI.
pub fn uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}

/// Returns a report with its data.
pub fn with_data(report: &Report) -> Result<String, Failure> {
    // Escape `<` so that the data cannot end its element.
    let data = serde_json::to_string(report)?.replace('<', "\\u003c");
    Ok(PAGE.replacen(PLACE, &data, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn report_has_one_place_for_data_and_loads_nothing() {
        assert_eq!(PAGE.matches(PLACE).count(), 1);
        assert!(PAGE.contains("default-src 'none'") && !PAGE.contains("src=\"") && !PAGE.contains("<link"));
    }
}
