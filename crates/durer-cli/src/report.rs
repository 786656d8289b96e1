//! Prints diagnostics on the terminal.

mod excerpt;

use crate::failure::Failure;
use crate::terminal::{controls_terminal, print_error_line, printable, printable_line};
use codespan_reporting::diagnostic::{Diagnostic as Shown, Label, Severity as Level};
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term::termcolor::{ColorChoice, StandardStream};
use codespan_reporting::term::{Config, emit_to_write_style};
use durer::diag::{Diagnostic, Diagnostics, ERROR_LIMIT, Files, Severity, Span};
use durer::light::{Illuminate as _, Light};
use durer::math::Vec3;
use durer::render::Statistics;
use durer::source::SourceError;
use durer::world::{Material, World};
use excerpt::Excerpt;
use std::io::IsTerminal;

/// Prints either all diagnostics or only errors to standard error.
pub fn print(files: &Files, diagnostics: &Diagnostics, errors_only: bool) {
    let selected: Vec<&Diagnostic> =
        diagnostics.iter().filter(|d| !errors_only || d.severity == Severity::Error).collect();
    print_to(StandardStream::stderr(colors(&std::io::stderr())), files, &selected);
    if diagnostics.error_count() > ERROR_LIMIT {
        print_error_line(&format!("and {} more errors", diagnostics.error_count() - ERROR_LIMIT));
    }
}

/// Formats a count together with its noun.
pub fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// Returns true if colours should be printed to a stream, which is the case only for a terminal.
pub fn colors(stream: &impl IsTerminal) -> ColorChoice {
    if stream.is_terminal() { ColorChoice::Auto } else { ColorChoice::Never }
}

/// Prints diagnostics to a stream.
pub fn print_to(stream: StandardStream, files: &Files, diagnostics: &[&Diagnostic]) {
    if diagnostics.is_empty() {
        return;
    }
    let mut shown = SimpleFiles::new();
    for file in 0.. {
        let (Some(name), Some(bytes)) = (files.name(file), files.bytes(file)) else { break };
        // Leave out the text of files that have no diagnostic.
        let used = diagnostics.iter().any(|d| spans(d).any(|span| span.file == file));
        shown.add(printable(name).into_owned(), if used { text(bytes) } else { String::new() });
    }
    for diagnostic in diagnostics {
        // Ignore errors because a closed stream cannot show a message.
        let excerpt = Excerpt::new(&shown, diagnostic.span, diagnostic.related.as_ref().map(|related| related.0));
        let _ = emit_to_write_style(&mut stream.lock(), &Config::default(), &excerpt, &show(diagnostic, &excerpt));
    }
}

/// Prints a note and its help on a single line.
pub fn note(diagnostic: &Diagnostic) {
    let help = diagnostic.help.as_ref().map(|help| format!("; {help}")).unwrap_or_default();
    print_error_line(&printable_line(&format!("note: {}{help}", diagnostic.message)));
}

/// Prints the number of rejected samples, the first of them and, if the world is given, the cause.
pub fn rejected(statistics: &Statistics, world: Option<&World>, quiet: bool) {
    if let (Some(first), false) = (statistics.first_rejected.first(), quiet) {
        let count = statistics.rejected;
        let cause = world.and_then(cause).map(|cause| format!(": {cause}")).unwrap_or_default();
        note(&Diagnostic::warning(format!(
            "left out {count} samples that were not finite, the first in pixel {},{} (sample {}){cause}",
            first.x, first.y, first.sample
        )));
    }
}

/// Describes the light or material that gives infinite or NaN radiance under the rules of the
/// course's programs.
fn cause(world: &World) -> Option<String> {
    let divides = |light: &Light| match light {
        Light::Point(emitter) => emitter.attenuation == Some(Vec3::ZERO),
        light => light.color().is_nan(),
    };
    if let Some(number) = world.lights().iter().position(divides) {
        let why = match &world.lights()[number] {
            Light::Point(_) => "the intensity of light {} is divided by its falloff, which is missing or 0",
            _ => "the intensity of light {} is divided by the length of its direction, which is 0",
        };
        return Some(why.replace("{}", &number.to_string()));
    }
    let below = |material: &Material| match material {
        Material::Phong(phong) => phong.highlight.is_some_and(|highlight| highlight.1 < 0.0),
        Material::Mix(..) => false,
    };
    if let Some(number) = world.materials().iter().position(below) {
        return Some(format!("the shininess of material {number} is below 0, so its highlight has no upper bound"));
    }
    let highlights = |material: &Material| matches!(material, Material::Phong(phong) if phong.highlight.is_some());
    let has_highlight = |number: u32| world.materials().get(number as usize).is_some_and(highlights);
    let is_long = world.objects().iter().any(|object| object.normal_length > 1.0 && has_highlight(object.material));
    is_long.then(|| "the normal of a plane is longer than 1, so the highlight on the plane overflows".into())
}

/// Returns the failure for a scene file that cannot be read.
pub fn unreadable(error: SourceError) -> Failure {
    Failure::Input(Some(error.to_string()))
}

fn spans(diagnostic: &Diagnostic) -> impl Iterator<Item = Span> {
    diagnostic.span.into_iter().chain(diagnostic.related.iter().map(|r| r.0))
}

/// Returns a file's bytes as text of the same length, so that offsets remain valid. Control
/// characters are replaced because they could control the terminal.
fn text(bytes: &[u8]) -> String {
    let harmless = |c: char| match c {
        '\n' | '\t' => c.to_string(),
        '\r' => " ".into(),
        _ if controls_terminal(c) => "?".repeat(c.len_utf8()),
        _ => c.to_string(),
    };
    if bytes.contains(&0) {
        return bytes.split_inclusive(|b| *b == b'\n').map(text_of_line).collect();
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => text.chars().map(harmless).collect(),
        Err(_) => bytes.iter().map(|&b| harmless(if b.is_ascii() { char::from(b) } else { '?' })).collect(),
    }
}

/// Returns a line of a binary file, which is blank unless it is part of a header of plain text.
fn text_of_line(line: &[u8]) -> String {
    let is_text = line.iter().all(|b| (b' '..0x7f).contains(b) || b.is_ascii_whitespace());
    let shown = |&b: &u8| if b == b'\n' || is_text && b != b'\r' { char::from(b) } else { ' ' };
    line.iter().map(shown).collect()
}

fn show(diagnostic: &Diagnostic, excerpt: &Excerpt) -> Shown<usize> {
    let level = match diagnostic.severity {
        Severity::Error => Level::Error,
        Severity::Warning => Level::Warning,
        Severity::Note => Level::Note,
    };
    let mut labels = Vec::new();
    if let Some((file, range)) = &excerpt.main {
        labels.push(Label::primary(*file, range.clone()).with_message(printable_line(&diagnostic.label)));
    }
    if let (Some((file, range)), Some((_, what))) = (&excerpt.related, &diagnostic.related) {
        labels.push(Label::secondary(*file, range.clone()).with_message(printable_line(what)));
    }
    let effect = diagnostic.effect.iter().map(|effect| format!("effect: {}", printable(effect)));
    let notes = effect.chain(diagnostic.help.iter().map(|help| format!("help: {}", printable(help)))).collect();
    let shown =
        Shown::new(level).with_message(printable_line(&diagnostic.message)).with_labels(labels).with_notes(notes);
    if diagnostic.code.is_empty() { shown } else { shown.with_code(diagnostic.code) }
}
