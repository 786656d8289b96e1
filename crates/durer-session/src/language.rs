//! Keywords of the scene language for completion and hints.

use crate::protocol::{Keyword, KeywordField};
use durer::dialect::Dialect;
use durer::format::course::reference::{Entry, FieldEntry, Spelling, entries};

/// Returns the keywords of Dürer's own dialect.
pub(crate) fn words() -> Vec<Keyword> {
    entries().iter().filter_map(word).collect()
}

fn own(words: &[Spelling]) -> Option<&'static str> {
    words.iter().find(|(_, dialects)| Dialect::Durer.is_in(*dialects)).map(|(word, _)| *word)
}

fn word(entry: &Entry) -> Option<Keyword> {
    Some(Keyword {
        word: own(&entry.keywords)?.into(),
        chapter: entry.chapter.title().into(),
        doc: entry.doc.trim().into(),
        fields: entry.fields.iter().filter_map(field).collect(),
        example: entry.example.clone(),
    })
}

fn field(field: &FieldEntry) -> Option<KeywordField> {
    Some(KeywordField {
        word: own(&field.words)?.into(),
        value: field.value.replace('`', ""),
        default: field.default.clone(),
        required: field.required,
        doc: field.doc.trim().into(),
    })
}
