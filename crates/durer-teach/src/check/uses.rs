//! Finds the uses of defined objects, which share the span of the definition.

use super::lines::is_same_span;
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Span};
use durer_scene::scene::{Object, ObjectKind};

/// Returns a warning about two objects of one definition that coincide, with the places of the two
/// uses.
pub(super) fn at_the_same_place(scene_probe: &SceneProbe, first: usize, second: usize) -> Option<Diagnostic> {
    let [a, b] = [use_of(scene_probe, first)?, use_of(scene_probe, second)?];
    if is_same_span(a, b) {
        return None;
    }
    let line = |span: Span| scene_probe.input.files.position(span).map_or(0, |(line, _)| line);
    let name = name_after(scene_probe, b);
    let message = format!("the `use {name}` of line {} is at the place of the one of line {}", line(b), line(a));
    let diagnostic = Diagnostic::warning(message)
        .at(b)
        .related(a, "the same object at the same place")
        .effect("the object contributes nothing; if it is glass, refraction through it is wrong")
        .help("move or remove one of the two: their transforms are equal");
    Some(diagnostic)
}

/// Returns the word that follows a keyword.
fn name_after(scene_probe: &SceneProbe, keyword: Span) -> String {
    let bytes = scene_probe.input.files.bytes(keyword.file).unwrap_or_default();
    let rest = bytes.get(keyword.end as usize..).unwrap_or_default();
    let words = rest.split(|byte| byte.is_ascii_whitespace() || b"{}".contains(byte));
    words
        .into_iter()
        .find(|word| !word.is_empty())
        .map_or(String::new(), |word| String::from_utf8_lossy(word).into_owned())
}

/// Returns the span of the `use` that an object of the world comes from. Objects are compiled in
/// the order of the scene.
fn use_of(scene_probe: &SceneProbe, number: usize) -> Option<Span> {
    let objects = scene_probe.world().objects();
    let span = objects[number].span;
    let before = objects[..number].iter().filter(|object| is_same_span(object.span, span)).count();
    let mut found = Vec::new();
    let roots = scene_probe.input.scene.root.iter().flat_map(|root| &root.objects);
    roots.for_each(|object| collect(scene_probe, object, span, None, &mut found));
    found.into_iter().nth(before).flatten()
}

/// Collects the innermost `use` around each object with a span.
fn collect(scene_probe: &SceneProbe, object: &Object, span: Span, around: Option<Span>, found: &mut Vec<Option<Span>>) {
    let is_use = matches!(object.node, ObjectKind::Group(_)) && scene_probe.text(object.span) == "use";
    let around = if is_use { Some(object.span) } else { around };
    let children = object.node.children();
    if is_same_span(object.span, span) && !matches!(object.node, ObjectKind::Group(_) | ObjectKind::Transform(..)) {
        found.push(around);
        return;
    }
    children.iter().for_each(|inner| collect(scene_probe, inner, span, around, found));
}
