//! Finds values in the text of a model, whose fields have other words than the scene language.

use super::scene_probe::SceneProbe;
use durer_diag::Span;
use durer_scene::math::Vec3;

/// Number of bytes after the start of a block in which its values are searched.
const REACH: usize = 4096;

/// Returns the span of the first three consecutive numbers after the start of a block that are the
/// components of a colour.
pub(super) fn place_of_color(scene_probe: &SceneProbe, block: Span, color: Vec3) -> Option<Span> {
    let numbers = numbers(scene_probe, block);
    // Readers can split a colour into a strength and a colour, whose product is rounded.
    let fits = |own: f32, part: f32| (own - part).abs() <= 1e-5 * part.abs();
    let is_it = |three: &&[(Span, f32)]| three.iter().zip(color.to_array()).all(|(own, part)| fits(own.1, part));
    let found = numbers.windows(3).find(is_it)?;
    Some(Span { end: found[2].0.end, ..found[0].0 })
}

/// Returns the numbers after the start of a block, with their spans.
fn numbers(scene_probe: &SceneProbe, block: Span) -> Vec<(Span, f32)> {
    let start = block.start as usize;
    let bytes = scene_probe.input.files.bytes(block.file).and_then(|bytes| bytes.get(start..)).unwrap_or_default();
    let bytes = &bytes[..bytes.len().min(REACH)];
    let is_part = |byte: &u8| byte.is_ascii_alphanumeric() || b"+-._".contains(byte);
    let mut at = 0;
    let words = bytes.chunk_by(|a, b| is_part(a) == is_part(b));
    let spans = words.map(|word| {
        at += word.len();
        (Span { file: block.file, start: (start + at - word.len()) as u32, end: (start + at) as u32 }, word)
    });
    let number = |word: &[u8]| std::str::from_utf8(word).ok()?.parse::<f32>().ok();
    spans.filter_map(|(span, word)| Some((span, number(word)?))).collect()
}

/// Returns the span of a word that occurs exactly once in the scene's file.
pub(super) fn place_of_word(scene_probe: &SceneProbe, word: &str) -> Option<Span> {
    let bytes = scene_probe.input.files.bytes(0)?;
    let mut places = bytes.windows(word.len()).enumerate().filter(|(_, part)| *part == word.as_bytes());
    let (start, _) = places.next()?;
    let span = Span { file: 0, start: start as u32, end: (start + word.len()) as u32 };
    places.next().is_none().then_some(span)
}
