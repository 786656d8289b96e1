//! Reader and writer of Stanford `.ply` meshes, which can be text or binary in either byte order,
//! with any elements and properties.

mod body;
mod fixed;
mod header;
mod lines;
mod order;
mod rows;
mod values;
mod write;

use super::report::Report;
use super::{MeshFormat, without_quirks};
use body::RowReader;
use durer_diag::Diagnostics;
use durer_image::decode_srgb;
use durer_scene::scene::Axis;
use durer_scene::shape::mesh::MeshData;
use header::{Encoding, Header, read_header};
use lines::{report_text_body, report_wrong_row};
use order::report_wrong_order;
use values::{AsciiValues, BinaryValues};
use write::write;
pub(super) use write::write_all_attributes;

/// Entry for PLY in the list of mesh formats.
pub(super) const FORMAT: MeshFormat =
    MeshFormat { name: "PLY", extensions: &["ply"], recognise, read, apply_quirks: without_quirks, write, up: Axis::Y };

/// Returns true if a file begins like a PLY file.
fn recognise(bytes: &[u8]) -> bool {
    matches!(bytes, [b'p', b'l', b'y', b'\n' | b'\r', ..])
}

/// Reads a PLY file; see [`read_mesh`](super::read_mesh).
fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<MeshData> {
    let mut report = Report::new(file, diagnostics);
    let mesh = read_reporting(bytes, &mut report).unwrap_or_default();
    if mesh.triangles.is_empty() && !report.has_errors() {
        let warning = report.warning(0..0, "the mesh has no triangles");
        if is_point_cloud(bytes) {
            warning.code = POINT_CLOUD;
        }
    }
    report.finish(diagnostics, mesh)
}

/// Code of the warning about a mesh without triangles if its file is a point cloud.
pub(super) const POINT_CLOUD: &str = "point-cloud";

/// Returns true if the header of a file declares vertices only.
fn is_point_cloud(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(1 << 16)];
    let lines = head.split(|byte| *byte == b'\n').take_while(|line| !line.starts_with(b"end_header"));
    let mut elements = lines.filter_map(|line| line.strip_prefix(b"element "));
    elements.next().is_some_and(|first| first.starts_with(b"vertex ")) && elements.next().is_none()
}

fn read_reporting(bytes: &[u8], report: &mut Report) -> Option<MeshData> {
    let header = read_header(bytes, report)?;
    let (start, elements) = (header.body, &header.elements);
    if report_wrong_order(bytes, &header, report) || report_text_body(bytes, &header, report) {
        return None;
    }
    let mesh = match header.encoding {
        Encoding::Ascii => {
            let mut found = report.part();
            let mesh = RowReader::new(bytes, AsciiValues::new(bytes, start), &mut found).read(elements);
            // A wrong number of rows causes many errors, or a single error far from the cause.
            if !found.begins_at_or_after(start) || !report_wrong_row(bytes, &header, report) {
                report.join(found);
            }
            mesh
        }
        Encoding::LittleEndian => {
            RowReader::new(bytes, BinaryValues::<false>::new(bytes, start), report).read(elements)
        }
        Encoding::BigEndian => RowReader::new(bytes, BinaryValues::<true>::new(bytes, start), report).read(elements),
    };
    let mesh = MeshData { flat: header.flat, ..mesh? };
    warn_about_dark_colors(&mesh, bytes, &header, report);
    Some(mesh)
}

/// Warns if all colours are stored as bytes of 0 and 1, which are nearly black.
fn warn_about_dark_colors(mesh: &MeshData, bytes: &[u8], header: &Header, report: &mut Report) {
    let channels = || mesh.colors.iter().flat_map(|color| &color[..3]);
    let is_dark = channels().all(|value| *value <= decode_srgb(1)) && channels().any(|value| *value > 0.0);
    let mut properties = header.elements.iter().flat_map(|element| &element.properties);
    let Some(red) = properties.find(|property| bytes[property.name.clone()].ends_with(b"red")).filter(|_| is_dark)
    else {
        return;
    };
    let warning = report.warning(red.name.clone(), "all colours are 0 or 1, but bytes range from 0 to 255");
    warning.code = "dark-colors";
    warning.help = Some("if the colours range from 0 to 1, declare them as `float`".into());
}

#[cfg(test)]
mod tests;
