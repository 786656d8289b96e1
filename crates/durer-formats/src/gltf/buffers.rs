//! Reads buffers and buffer views, and resolves URIs.

use super::Model;
use super::json::JsonRef;
use crate::files::percent_decoded;
use crate::report::quoted;
use base64::alphabet::STANDARD;
use base64::engine::general_purpose::{GeneralPurpose, NO_PAD};
use base64::engine::{DecodePaddingMode, GeneralPurposeConfig};
use base64::{DecodeError, Engine};
use durer_scene::describe::FileName;
use serde_json::Value;
use std::ops::Range;
use std::sync::Arc;

const MESHOPT: &str = "EXT_meshopt_compression";

/// Range of bytes in a file or in decoded data, which is shared by reference counting.
#[derive(Clone)]
pub(super) struct SharedBytes {
    bytes: Arc<[u8]>,
    range: Range<usize>,
}

impl SharedBytes {
    /// Returns the bytes in the range.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[self.range.clone()]
    }

    /// Returns a slice of all the bytes.
    pub fn whole(bytes: Arc<[u8]>) -> Self {
        SharedBytes { range: 0..bytes.len(), bytes }
    }

    /// Returns a part of these bytes, or `None` if the part extends beyond their end.
    pub fn part(&self, range: Range<usize>) -> Option<SharedBytes> {
        let (start, end) = (self.range.start.checked_add(range.start)?, self.range.start.checked_add(range.end)?);
        (start <= end && end <= self.range.end).then(|| SharedBytes { bytes: self.bytes.clone(), range: start..end })
    }
}

/// Buffer of a glTF file, with its declared length, and with its bytes if they can be read.
pub(super) struct Buffer {
    length: usize,
    pub slice: Option<SharedBytes>,
}

/// Buffer view of a glTF file, which is a part of a buffer with an optional stride.
#[derive(Clone)]
pub(super) struct BufferView {
    /// Offset of the first byte in the buffer.
    pub offset: usize,
    pub length: usize,
    pub slice: Option<SharedBytes>,
    pub stride: Option<usize>,
}

impl BufferView {
    /// Returns the bytes of the view, or no bytes if they cannot be read.
    pub fn bytes(&self) -> &[u8] {
        self.slice.as_ref().map_or(&[], SharedBytes::bytes)
    }
}

/// Target of a URI in a glTF file, which is embedded data or another file.
pub(super) enum UriTarget<'a> {
    /// Embedded data with its media type.
    Data(&'a str, Arc<[u8]>),
    /// Path of a file, relative to the glTF file.
    File(String),
}

/// Resolves a URI, which must be a data URI or a relative path.
///
/// Source: RFC 3986 and RFC 2397. An implementation of [`durer_scene::source::AssetSource`] that
/// reads a folder rejects paths that lead out of that folder.
pub(super) fn resolve_uri<'a>(at: &JsonRef<'a>) -> Option<UriTarget<'a>> {
    let uri = at.string()?;
    if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
        let mut wrong = None;
        let data = uri[5..].split_once(',').and_then(|(kind, data)| {
            let Some(kind) = kind.strip_suffix(";base64") else {
                // Without `;base64`, the data is percent-encoded text.
                return Some((kind.split(';').next()?, percent_decoded(data)?.into_bytes()));
            };
            if kind.ends_with(';') {
                return None;
            }
            let config: GeneralPurposeConfig = NO_PAD.with_decode_padding_mode(DecodePaddingMode::Indifferent);
            let decoded = GeneralPurpose::new(&STANDARD, config).decode(data);
            if let Err(DecodeError::InvalidByte(offset, _)) = &decoded {
                wrong = data.get(*offset..).and_then(|rest| rest.chars().next()).map(|found| (found, offset + 1));
            }
            Some((kind.split(';').next()?, decoded.ok()?))
        });
        if data.is_none() {
            at.error(
                "INVALID_URI",
                match wrong {
                    Some((found, place)) => format!(
                        "the data URI is invalid: character {place} of the data, {}, does not occur in base64",
                        quoted(found.to_string().as_bytes())
                    ),
                    None => "the data URI is invalid".to_string(),
                },
            );
        }
        return data.map(|(kind, bytes)| UriTarget::Data(kind, bytes.into()));
    }
    let scheme = uri.split_once(':').filter(|(scheme, _)| !scheme.contains('/'));
    if let Some((scheme, _)) = scheme {
        at.error(
            "INVALID_URI",
            format!("the URI has the scheme `{scheme}`, but only relative file paths are supported"),
        );
        return None;
    }
    let Some(path) = percent_decoded(uri).filter(|path| !path.is_empty() && !path.contains('\0')) else {
        at.error("INVALID_URI", format!("invalid URI {}", quoted(uri.as_bytes())));
        return None;
    };
    if path.starts_with(['/', '\\']) {
        at.error(
            "INVALID_URI",
            format!("the URI {} is absolute, but only relative file paths are supported", quoted(uri.as_bytes())),
        );
        return None;
    }
    Some(UriTarget::File(path))
}

impl Model<'_> {
    /// Reads the buffers. An unreadable buffer is reported only where its data is used.
    pub(super) fn buffers(&self, root: &JsonRef) -> Vec<Option<Buffer>> {
        let Some(buffers) = root.get("buffers") else { return Vec::new() };
        buffers.items().enumerate().map(|(i, buffer)| self.buffer(i, &buffer)).collect()
    }

    fn buffer(&self, number: usize, at: &JsonRef) -> Option<Buffer> {
        at.object()?;
        let length = at.required("byteLength")?.integer(1..)? as usize;
        // Fallback buffers are only for readers that do not support compressed views.
        let is_fallback = compression(at).is_some_and(|packed| packed["fallback"] == true);
        Some(Buffer { length, slice: if is_fallback { None } else { self.data(number, length, at) } })
    }

    /// Returns the bytes of a buffer.
    fn data(&self, number: usize, length: usize, at: &JsonRef) -> Option<SharedBytes> {
        let bytes = match at.get("uri") {
            Some(uri) => match resolve_uri(&uri)? {
                UriTarget::Data(kind, bytes) => {
                    if !matches!(kind, "application/octet-stream" | "application/gltf-buffer") {
                        uri.error("BUFFER_DATA_URI_MIME_TYPE_INVALID", format!("unexpected media type `{kind}`"));
                    }
                    bytes
                }
                UriTarget::File(path) => self.file(&uri, &path)?,
            },
            None => match (&self.parts.bin, number) {
                (Some(bin), 0) => {
                    let there = bin.len();
                    if there < length {
                        let message =
                            format!("the buffer should have {length} bytes, but the chunk has only {there} bytes");
                        at.error("BUFFER_BYTE_LENGTH_MISMATCH", message);
                        return None;
                    }
                    return Some(SharedBytes { bytes: self.input.bytes.clone(), range: bin.start..bin.start + length });
                }
                _ => {
                    if self.parts.is_glb && number == 0 {
                        at.error("BUFFER_MISSING_GLB_DATA", "the buffer refers to a chunk that the file does not have");
                    }
                    return None;
                }
            },
        };
        if bytes.len() < length {
            let message = format!("the buffer should have {length} bytes, but has only {} bytes", bytes.len());
            at.error("BUFFER_BYTE_LENGTH_MISMATCH", message);
            return None;
        }
        Some(SharedBytes { bytes, range: 0..length })
    }

    /// Reads the file that a URI names.
    pub(super) fn file(&self, uri: &JsonRef, path: &str) -> Option<Arc<[u8]>> {
        let name = FileName { path: path.to_string(), span: uri.span() };
        match self.input.source.read(&name.path) {
            Ok(bytes) => Some(bytes),
            Err(error) => {
                uri.error("IO_ERROR", error.to_string());
                None
            }
        }
    }

    /// Reads all buffer views, and returns `None` in place of each invalid one.
    pub(super) fn views(&self, root: &JsonRef) -> Vec<Option<BufferView>> {
        let Some(views) = root.get("bufferViews") else { return Vec::new() };
        views.items().map(|view| self.view_of(&view)).collect()
    }

    /// Returns the index of a buffer view, and that of another one of which it contains a part.
    /// Views with the same range are not reported.
    pub(super) fn overlapping(&self, view: &BufferView) -> Option<(usize, usize)> {
        let own = view.slice.as_ref()?;
        let range_of = |i: usize| {
            let slice = self.views[i].as_ref()?.slice.as_ref()?;
            Arc::ptr_eq(&slice.bytes, &own.bytes).then_some(&slice.range)
        };
        let index = (0..self.views.len()).find(|&i| range_of(i) == Some(&own.range))?;
        let meets =
            |range: &Range<usize>| *range != own.range && range.start < own.range.end && own.range.start < range.end;
        let other = (0..self.views.len()).find(|&i| range_of(i).is_some_and(meets))?;
        Some((index, other))
    }

    fn view_of(&self, at: &JsonRef) -> Option<BufferView> {
        at.object()?;
        let buffer = at.required("buffer").and_then(|buffer| buffer.index(self.buffers.len()));
        let offset = at.get("byteOffset").map_or(Some(0), |offset| offset.integer(..));
        let length = at.required("byteLength").and_then(|length| length.integer(1..));
        let stride = match at.get("byteStride") {
            None => None,
            Some(stride) => {
                let bytes = stride.integer(4..=252)?;
                if bytes % 4 != 0 {
                    stride.error("VALUE_MULTIPLE_OF", format!("value {bytes} is not a multiple of 4"));
                    return None;
                }
                Some(bytes as usize)
            }
        };
        let (offset, length) = (offset? as usize, length? as usize);
        if stride.is_some_and(|stride| stride > length) {
            at.error("BUFFER_VIEW_TOO_BIG_BYTE_STRIDE", "the stride is longer than the buffer view");
        }
        let buffer = self.buffers[buffer?].as_ref()?;
        let end = offset.checked_add(length).filter(|end| *end <= buffer.length);
        if end.is_none() {
            let bytes = buffer.length;
            let message = format!("{length} bytes from byte {offset} on do not fit into a buffer of {bytes} bytes");
            at.get("byteLength").unwrap_or(*at).error("BUFFER_VIEW_TOO_LONG", message);
        }
        let slice = match compression(at) {
            Some(_) => self.decompress_view(&at.get("extensions")?.get(MESHOPT)?, length),
            None => buffer.slice.as_ref().and_then(|slice| slice.part(offset..end?)),
        };
        end.map(|_| BufferView { offset, length, slice, stride })
    }
}

/// Returns the compression extension of a buffer or buffer view, if there is one.
fn compression<'a>(at: &JsonRef<'a>) -> Option<&'a Value> {
    at.value.get("extensions")?.get(MESHOPT)
}
