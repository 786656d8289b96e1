//! Reads the containers of glTF, which are plain JSON and GLB files with JSON and a binary buffer.
//!
//! Source: *glTF 2.0 Specification*, Khronos Group, chapter 4.

use crate::report::{Report, quoted};
use durer_diag::Diagnostic;
use std::ops::Range;

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = 0x4e4f_534a;
const BIN: u32 = 0x004e_4942;

/// Ranges of bytes of the JSON and of the binary buffer in a glTF file.
pub(super) struct Parts {
    pub json: Range<usize>,
    /// Binary buffer of a GLB file, if there is one.
    pub bin: Option<Range<usize>>,
    pub is_glb: bool,
}

/// Returns true if a file begins in the way that a glTF file does.
pub(crate) fn recognise(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(1 << 14)];
    let is_json = head.trim_ascii_start().first() == Some(&b'{');
    bytes.starts_with(MAGIC) || is_json && head.windows(7).any(|part| part == b"\"asset\"")
}

/// Finds the parts of a glTF file. Returns `None` after reporting an error.
pub(super) fn open(bytes: &[u8], name: &str, report: &mut Report) -> Option<Parts> {
    // A file that is named `.glb` but has no magic number must be damaged at its beginning.
    if bytes.starts_with(MAGIC) || name.to_lowercase().ends_with(".glb") {
        return glb(bytes, report);
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        report_error(report, 0..3, "INVALID_JSON", "the file begins with a byte order mark, which JSON must not have");
        return None;
    }
    Some(Parts { json: 0..bytes.len(), bin: None, is_glb: false })
}

fn report_error(report: &mut Report, at: Range<usize>, code: &'static str, message: impl Into<String>) {
    report.add(at, Diagnostic::error(message).code(code));
}

fn glb(bytes: &[u8], report: &mut Report) -> Option<Parts> {
    let word = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
    let end = bytes.len();
    if !bytes.starts_with(MAGIC) {
        let magic = quoted(&bytes[..end.min(4)]);
        let code = if end < 4 { "GLB_UNEXPECTED_END_OF_HEADER" } else { "GLB_INVALID_MAGIC" };
        report_error(
            report,
            0..end.min(4),
            code,
            format!("a GLB file must begin with `glTF`, but this file begins with {magic}"),
        );
        return None;
    }
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        report_error(report, 0..end, "GLB_UNEXPECTED_END_OF_HEADER", "the file ends within its header of 12 bytes");
        return None;
    };
    if version != 2 {
        report_error(
            report,
            4..8,
            "GLB_INVALID_VERSION",
            format!("unsupported GLB version {version}: only version 2 is supported"),
        );
        return None;
    }
    if length < 20 {
        report_error(
            report,
            8..12,
            "GLB_LENGTH_TOO_SMALL",
            format!("the header declares {length} bytes, which is too short for a GLB file"),
        );
        return None;
    }
    if length as usize > end {
        report_error(
            report,
            8..12,
            "GLB_LENGTH_MISMATCH",
            format!("the header declares {length} bytes, but the file has only {end} bytes"),
        );
        return None;
    }
    if (length as usize) < end {
        let message = format!("{} bytes after the declared end are ignored", end - length as usize);
        report.add(length as usize..length as usize + 1, Diagnostic::warning(message).code("GLB_EXTRA_DATA"));
    }
    chunks(bytes, length as usize, report)
}

fn chunks(bytes: &[u8], end: usize, report: &mut Report) -> Option<Parts> {
    let word = |at: usize| Some(u32::from_le_bytes(*bytes[..end].get(at..)?.first_chunk()?));
    let (mut json, mut bin, mut at, mut number) = (None, None, 12, 0);
    while at < end {
        let (Some(length), Some(kind)) = (word(at), word(at + 4)) else {
            report_error(report, at..end, "GLB_UNEXPECTED_END_OF_CHUNK_HEADER", "the file ends within a chunk header");
            return None;
        };
        let chunk = at + 8..at + 8 + length as usize;
        if length % 4 != 0 {
            let message = format!("the length of a chunk must be a multiple of 4, but is {length}");
            report_error(report, at..at + 4, "GLB_CHUNK_LENGTH_UNALIGNED", message);
        }
        if chunk.end > end {
            let message = format!("a chunk of {length} bytes does not fit into the file of {end} bytes");
            report_error(report, at..at + 4, "GLB_CHUNK_TOO_BIG", message);
            return None;
        }
        match (kind, number) {
            (JSON, 0) if length == 0 => {
                report_error(report, at..at + 4, "GLB_EMPTY_CHUNK", "the JSON chunk is empty");
                return None;
            }
            (JSON, 0) => json = Some(chunk.clone()),
            (_, 0) => {
                report_error(report, at + 4..at + 8, "GLB_UNEXPECTED_FIRST_CHUNK", "the first chunk must be JSON");
                return None;
            }
            (JSON, _) => {
                report_error(report, at + 4..at + 8, "GLB_DUPLICATE_CHUNK", "a GLB file can have only one JSON chunk")
            }
            (BIN, _) if bin.is_some() => {
                report_error(report, at + 4..at + 8, "GLB_DUPLICATE_CHUNK", "a GLB file can have only one binary chunk")
            }
            (BIN, _) => bin = Some(chunk.clone()),
            // Ignore all other chunks, which belong to extensions.
            _ => {}
        }
        (at, number) = (chunk.end, number + 1);
    }
    json.map(|json| Parts { json, bin, is_glb: true }).filter(|_| !report.has_errors())
}
