//! Writes the keywords of the language as Python classes of the package `durer`.

use super::GENERATED;
use durer::describe::FieldKind;
use durer::dialect::{Dialect, DialectSet};
use durer::format::course::reference::{Chapter, Entry, FieldEntry, entries};
use std::fmt::Write;

/// Returns the Python base class for the keywords of a chapter.
fn base(chapter: Chapter) -> Option<&'static str> {
    match chapter {
        Chapter::Structure => Some("Thing"),
        Chapter::Cameras => Some("Camera"),
        Chapter::Lights => Some("Light"),
        Chapter::Materials => Some("Material"),
        Chapter::Shapes => Some("Shape"),
        Chapter::Solids | Chapter::Transforms => None,
    }
}

/// Returns the text of the module `durer.words`.
pub fn words() -> String {
    let mut classes = String::new();
    let mut names = Vec::new();
    for entry in entries() {
        let Some(base) = base(entry.chapter) else { continue };
        // These keywords appear only inside others: a grid contains spheres, and colour noise is
        // part of another material.
        let nested = entry.name() == "Grid" || entry.doc.contains("which replace the diffuse");
        if entry.fields.is_empty() || nested {
            continue;
        }
        if let Some(word) = spelled(&entry.keywords) {
            names.push(format!("\"{word}\""));
            classes += &class(&entry, word, base);
        }
    }
    names.sort();
    format!(
        "\"\"\"The words of the scene language as classes. {GENERATED}\"\"\"\n\n# fmt: off\nfrom __future__ import annotations\n\n\
         from typing import Literal, Optional, Union\n\nimport numpy.typing as npt\n\n\
         from .things import Camera, Light, Material, Shape, Thing\n\n__all__ = [{}]\n{classes}",
        names.join(", ")
    )
}

/// Returns the keyword in Dürer's own dialect, if it has one.
fn spelled(words: &[(&'static str, DialectSet)]) -> Option<&'static str> {
    words.iter().find(|word| Dialect::Durer.is_in(word.1)).map(|word| word.0)
}

fn class(entry: &Entry, word: &str, base: &str) -> String {
    let fields: Vec<(&FieldEntry, &str)> =
        entry.fields.iter().filter_map(|field| Some((field, spelled(&field.words)?))).collect();
    let (mut out, mut rows, mut given) = (String::new(), String::new(), String::new());
    // Required fields come first. Writing to a String cannot fail.
    for (field, spelling) in &fields {
        let name = name(field);
        let kind = kind(field.kind);
        let parameter =
            if field.required { format!("{name}: {kind}") } else { format!("{name}: Optional[{kind}] = None") };
        let _ = writeln!(given, "        {parameter},");
        let _ = writeln!(rows, "            (\"{spelling}\", {name}),");
    }
    let _ = write!(out, "\n\nclass {word}({base}):\n    \"\"\"{}\n", entry.doc.replace('\\', "\\\\"));
    for (field, _) in &fields {
        let default = match (&field.default, field.required) {
            (Some(default), _) => format!("; default {default}"),
            (None, true) => "; required".into(),
            (None, false) => String::new(),
        };
        let _ = write!(out, "\n    {}: {}{default}. {}\n", name(field), field.value, field.doc);
    }
    let _ = write!(
        out,
        "    \"\"\"\n\n    def __init__(\n        self,\n        *,\n{given}    ) -> None:\n        super().__init__(\"{word}\", \
         [\n{rows}        ])\n"
    );
    out
}

/// Returns a field's name, changed if it is a Python keyword.
fn name(field: &FieldEntry) -> String {
    match field.name {
        name @ ("from" | "in" | "is" | "as" | "not" | "with") => format!("{name}_"),
        name => name.to_string(),
    }
}

fn kind(kind: FieldKind) -> String {
    match kind {
        FieldKind::Float => "float".into(),
        FieldKind::Int => "Union[int, Material]".into(),
        FieldKind::Vec3 | FieldKind::Rows(_) => "npt.ArrayLike".into(),
        FieldKind::Path => "str".into(),
        FieldKind::Word(words) => {
            format!("Literal[{}]", words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", "))
        }
    }
}
