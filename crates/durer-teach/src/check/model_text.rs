//! Searches the text of model files for words that the readers do not keep.

use super::scene_probe::SceneProbe;
use durer_diag::Span;

/// Returns the last place of a text in the scene file that is not in a comment.
pub(super) fn find(scene_probe: &SceneProbe, wanted: &str) -> Option<Span> {
    let bytes = scene_probe.input.files.bytes(0)?;
    let wanted = wanted.as_bytes();
    let mut found = bytes.windows(wanted.len()).enumerate().filter(|(_, text)| *text == wanted).map(|(at, _)| at);
    let place = found.rfind(|at| !is_comment(&bytes[..*at]))?;
    Some(Span { file: 0, start: place as u32, end: (place + wanted.len()) as u32 })
}

/// Returns true if a comment begins in the text and does not end in it. Comments begin with `#` and
/// end with the line, or they are comments of XML.
fn is_comment(before: &[u8]) -> bool {
    let line = before.rsplit(|b| *b == b'\n').next().unwrap_or_default();
    let last = |wanted: &[u8]| before.windows(wanted.len()).rposition(|text| text == wanted);
    line.contains(&b'#') || last(b"<!--").is_some_and(|start| last(b"-->").is_none_or(|end| end < start))
}

/// Returns the first number after a place in the scene file, with its span. Quotes, brackets and
/// the words in `skipped` may precede the number.
pub(super) fn number_after(scene_probe: &SceneProbe, place: Span, skipped: &str) -> Option<(f32, Span)> {
    let bytes = scene_probe.input.files.bytes(place.file)?;
    let mut start = place.end as usize;
    let mut is_skipped = false;
    loop {
        let rest = bytes.get(start..)?;
        match rest.first()? {
            b'"' | b'\'' | b'[' => start += 1,
            byte if byte.is_ascii_whitespace() => start += 1,
            _ if !is_skipped && !skipped.is_empty() && rest.starts_with(skipped.as_bytes()) => {
                (start, is_skipped) = (start + skipped.len(), true);
            }
            _ => break,
        }
    }
    let rest = &bytes[start..];
    let length = rest.iter().take_while(|byte| byte.is_ascii_digit() || b"+-.eE".contains(byte)).count();
    let value = std::str::from_utf8(&rest[..length]).ok()?.parse().ok()?;
    Some((value, Span { file: place.file, start: start as u32, end: (start + length) as u32 }))
}
