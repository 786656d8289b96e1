//! Export of a picture to a file format.

use durer::image::{Display, Layer, WriteOptions, format_for};

/// Encodes a picture in the format that the extension of `name` selects.
pub(crate) fn export(name: &str, layer: &Layer, display: Display) -> Result<Vec<u8>, String> {
    let format = format_for(name).map_err(|error| error.to_string())?;
    let mut bytes = Vec::new();
    let options = WriteOptions { display, attributes: &[] };
    format.write(std::slice::from_ref(layer), &options, &mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes)
}
