//! Reads the files that a scene refers to, for all scene formats.

use super::model::ReadInput;
use super::read_mesh;
use super::shared_report::SharedReport;
use crate::gzip::read_decompressed;
use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_scene::shape::MeshData;
use std::sync::Arc;

/// Reads a file that the scene refers to and registers it, so that spans can point into it. `what`
/// describes the purpose of the file in the error message if it cannot be read.
pub(super) fn read_named(
    input: &ReadInput,
    report: &SharedReport,
    what: &str,
    name: &str,
    at: Span,
) -> Option<(Arc<[u8]>, u32)> {
    match read_decompressed(input.source, name) {
        Ok(bytes) => {
            let file = input.files.borrow_mut().add(name, bytes.clone());
            Some((bytes, file))
        }
        Err(error) => {
            let help = error.help();
            let missing = Diagnostic::error(format!("{what} cannot be read: {error}")).code("missing-file").at(at);
            report.push(Diagnostic { help, ..missing });
            None
        }
    }
}

/// Reads a mesh file of any format, compressed or not, without changing the mesh.
pub(super) fn mesh_file(input: &ReadInput, report: &SharedReport, name: &str, at: Span) -> Option<MeshData> {
    let (bytes, file) = read_named(input, report, "the mesh", name, at)?;
    let plain = name.strip_suffix(".gz").unwrap_or(name);
    let mut own = Diagnostics::default();
    let data = read_mesh(&bytes, file, plain, &mut own);
    if own.has_errors() {
        let message = format!("the mesh `{name}` cannot be used");
        report.push(Diagnostic::error(message).code("bad-file").at(at).label("used here"));
    }
    report.extend(own);
    data
}

/// Decodes percent-encoding; returns `None` if an escape is malformed or the result is not UTF-8.
pub(super) fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digits = [rest.next()?, rest.next()?];
                u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
            }
            other => other,
        });
    }
    String::from_utf8(bytes).ok()
}
