//! Reads JSON values into the fields of statements, and checks their types, their constraints, and
//! the names of members.

use super::schema;
use super::tree::{Member, Node, Value};
use crate::course::is_word;
use crate::report::{Report, count_text, quoted};
use crate::shared_report::suggest;
use durer_diag::Span;
use durer_scene::describe::{self, Constraint, DescribedKind, FieldKind, FileName};
use durer_scene::math::Vec3;
use durer_scene::scene::Spanned;
use std::ops::Range;

/// Reader that converts the JSON tree of one document into a scene, and collects the errors.
pub(super) struct Reader<'a> {
    pub text: &'a [u8],
    pub report: Report,
    /// Material of the previous object, which is used for objects that name no material.
    pub material: Option<u32>,
    /// Every use of a material index with its byte range; the indices are checked after all
    /// materials have been read.
    pub uses: Vec<(u32, Range<usize>)>,
    pub depth: usize,
    /// Keywords that are allowed as the `type` of an object.
    pub object_types: &'a [&'static str],
}

/// Members of one JSON object that is being read. The struct records which members have been read,
/// so that unknown ones can be reported.
pub(super) struct Members<'n> {
    /// Name of the object that is used in messages.
    pub name: &'n str,
    at: Range<usize>,
    all: &'n [Member],
    taken: Vec<bool>,
    /// Names that were passed to [`Members::take`]. After reading, these are all the member names
    /// that the object may have.
    known: Vec<&'static str>,
}

impl<'n> Members<'n> {
    /// Returns the value of a member and marks the member as read.
    pub fn take(&mut self, name: &'static str) -> Option<&'n Node> {
        self.known.push(name);
        let index = self.all.iter().position(|member| member.name == name)?;
        self.taken[index] = true;
        Some(&self.all[index].node)
    }
}

impl Reader<'_> {
    /// Reports an error at a byte range.
    pub fn error(&mut self, at: Range<usize>, code: &'static str, message: impl Into<String>, help: Option<String>) {
        if !self.report.is_full() {
            let error = self.report.error(at, message);
            (error.code, error.help) = (code, help);
        }
    }

    /// Reports a value that has the wrong type.
    pub fn expected(&mut self, node: &Node, what: &str, name: &str) {
        let message = format!("`{name}` needs {what}, but found {}", node.kind());
        self.error(node.head(), "bad-value", message, None);
    }

    /// Converts a byte range to a span.
    pub fn span(&self, at: &Range<usize>) -> Span {
        self.report.span(at.clone())
    }

    /// Returns the members of an object; reports an error for any other value.
    pub fn members<'n>(&mut self, node: &'n Node, name: &'n str) -> Option<Members<'n>> {
        let Value::Object(all) = &node.value else {
            self.expected(node, "an object", name);
            return None;
        };
        Some(Members { name, at: node.head(), all, taken: vec![false; all.len()], known: Vec::new() })
    }

    /// Reports members that were not read because their names are unknown.
    pub fn finish(&mut self, members: Members) {
        let Members { name, all, taken, known, .. } = members;
        for (member, _) in all.iter().zip(taken).filter(|(_, taken)| !taken) {
            // A list of seventy names would not help the user.
            let few = || (known.len() <= 24).then(|| format!("`{name}` has the members {}", known.join(", ")));
            let help = suggest(&member.name, known.iter().copied()).or_else(few);
            let message = format!("`{name}` has no member {}", quoted(member.name.as_bytes()));
            self.error(member.at.clone(), "unknown-word", message, help);
        }
    }

    /// Returns the items of a list; for any other value, reports an error and returns an empty
    /// slice.
    pub fn items<'n>(&mut self, node: &'n Node, name: &str) -> &'n [Node] {
        match &node.value {
            Value::Array(items) => items,
            _ => {
                self.expected(node, "a list", name);
                &[]
            }
        }
    }

    /// Returns a string; reports an error for any other value.
    pub fn string<'n>(&mut self, node: &'n Node, name: &str) -> Option<&'n str> {
        match &node.value {
            Value::String(text) => Some(text),
            _ => {
                self.expected(node, "a string", name);
                None
            }
        }
    }

    /// Reads a string that must be one of the strings in `words`.
    pub fn one_of<'w>(&mut self, node: &Node, name: &str, words: &[&'w str]) -> Option<&'w str> {
        let text = self.string(node, name)?;
        let word = words.iter().copied().find(|word| *word == text);
        if word.is_none() {
            let help = suggest(text, words.iter().copied())
                .unwrap_or_else(|| format!("`{name}` must be one of {}", words.join(", ")));
            let message = format!("`{name}` cannot be {}", quoted(text.as_bytes()));
            self.error(node.at.clone(), "bad-value", message, Some(help));
        }
        word
    }

    /// Reads a finite `f32`; reports an error for any other value.
    pub fn number(&mut self, node: &Node, name: &str) -> Option<f32> {
        if !matches!(node.value, Value::Number) {
            self.expected(node, "a number", name);
            return None;
        }
        let number = std::str::from_utf8(&self.text[node.at.clone()]).ok()?.parse::<f32>().ok()?;
        if !number.is_finite() {
            let help = "numbers must be within about ±3.4e38".to_string();
            let message = format!("{} is too large a number", quoted(&self.text[node.at.clone()]));
            self.error(node.at.clone(), "bad-value", message, Some(help));
            return None;
        }
        Some(number)
    }

    /// Reads a list of exactly `N` numbers.
    pub fn numbers<const N: usize>(&mut self, node: &Node, name: &str) -> Option<[f32; N]> {
        let items = match &node.value {
            Value::Array(items) if items.len() == N => items,
            Value::Array(items) => {
                let has = count_text(items.len(), "value", "values");
                let message = format!("`{name}` needs a list of {N} numbers, but this list has {has}");
                self.error(node.head(), "bad-value", message, None);
                return None;
            }
            _ => {
                self.expected(node, &format!("a list of {N} numbers"), name);
                return None;
            }
        };
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(items) {
            *number = self.number(item, name)?;
        }
        Some(numbers)
    }

    /// Reads an integer from 0 to `u32::MAX`.
    pub fn integer(&mut self, node: &Node, name: &str) -> Option<u32> {
        let number = match node.value {
            Value::Number => std::str::from_utf8(&self.text[node.at.clone()]).ok()?.parse::<f64>().ok(),
            _ => None,
        };
        // Some programs write integers in the form 3.0.
        let whole = number.filter(|n| n.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(n));
        if whole.is_none() {
            let message = format!(
                "`{name}` needs a whole number, but found {}",
                match node.value {
                    Value::Number => quoted(&self.text[node.at.clone()]),
                    _ => node.kind().to_string(),
                }
            );
            self.error(node.head(), "bad-value", message, None);
        }
        whole.map(|number| number as u32)
    }

    /// Reads a value of the type of a field and checks the constraint of the field.
    fn value(&mut self, node: &Node, name: &str, kind: FieldKind, rule: Constraint) -> Option<describe::Value> {
        let value = match kind {
            FieldKind::Float => describe::Value::Float(self.number(node, name)?),
            FieldKind::Int => describe::Value::Int(self.integer(node, name)?),
            FieldKind::Vec3 => describe::Value::Vec3(Vec3::from(self.numbers::<3>(node, name)?)),
            FieldKind::Path => {
                let path = self.string(node, name)?;
                if !is_word(path) {
                    let help = "a path must not contain spaces or braces, as in the scene language".to_string();
                    let message = format!("`{name}` cannot be {}", quoted(path.as_bytes()));
                    self.error(node.at.clone(), "bad-value", message, Some(help));
                    return None;
                }
                // The range excludes the quotes, so that a path can be replaced in the text.
                let span = self.span(&(node.at.start + 1..node.at.end - 1));
                describe::Value::Path(FileName { path: path.to_string(), span })
            }
            FieldKind::Word(words) => describe::Value::Word(self.one_of(node, name, words)?.to_string()),
            FieldKind::Rows(width) => describe::Value::Rows(self.rows(node, name, width)?),
        };
        if let Err(violation) = rule.validate(&value) {
            self.error(node.head(), "bad-value", format!("`{name}` {violation}"), None);
        }
        Some(value)
    }

    /// Reads a list of rows with `width` numbers each.
    pub fn rows(&mut self, node: &Node, name: &str, width: usize) -> Option<Vec<Vec<f32>>> {
        if !matches!(node.value, Value::Array(_)) {
            self.expected(node, "a list", name);
            return None;
        }
        let mut rows = Vec::new();
        for row in self.items(node, name) {
            let items = self.items(row, name);
            if items.len() != width {
                let message = format!("each row of `{name}` must be a list of {width} numbers");
                self.error(row.head(), "bad-value", message, None);
                return None;
            }
            rows.push(items.iter().map(|item| self.number(item, name)).collect::<Option<_>>()?);
        }
        Some(rows)
    }

    /// Reads the fields of a described item from an object that may also have other members.
    pub fn fields<T: DescribedKind>(&mut self, item: &mut T, members: &mut Members) {
        for (i, field) in item.fields().iter().enumerate() {
            match members.take(field.name) {
                Some(node) => {
                    if let Some(value) = self.value(node, field.name, field.kind, field.constraint) {
                        item.set(i, value);
                    }
                }
                None if field.required => {
                    let message = format!("`{}` has no `{}`", members.name, field.name);
                    self.error(members.at.clone(), "missing-field", message, None);
                }
                None => {}
            }
        }
    }

    /// Reads a described item from an object that may have no other members.
    pub fn item<T: DescribedKind>(&mut self, mut entry: T, node: &Node, name: &str) -> T {
        if let Some(mut members) = self.members(node, name) {
            self.fields(&mut entry, &mut members);
            self.finish(members);
        }
        entry
    }

    /// Returns the members of an object and its `type`, which must be one of the keywords in
    /// `known`.
    pub fn typed<'n>(&mut self, node: &'n Node, what: &'n str, known: &[&str]) -> Option<(&'n str, Members<'n>)> {
        let mut members = self.members(node, what)?;
        let Some(named) = members.take("type") else {
            self.error(node.head(), "missing-field", format!("`{what}` has no `type`"), None);
            return None;
        };
        let Value::String(word) = &named.value else {
            self.expected(named, "a string", "type");
            return None;
        };
        if !known.contains(&word.as_str()) {
            let message = format!("{} is not a type of `{what}`", quoted(word.as_bytes()));
            let near = suggest(word, known.iter().copied());
            let help = near.unwrap_or_else(|| format!("known types are {}", known.join(", ")));
            self.error(named.at.clone(), "unknown-word", message, Some(help));
            return None;
        }
        members.name = word;
        Some((word, members))
    }

    /// Reads an item from a described list; the object's `type` selects the kind of item.
    pub fn choice<T: DescribedKind>(&mut self, node: &Node, what: &str) -> Option<T> {
        let (word, mut members) = self.typed(node, what, &schema::keywords::<T>())?;
        let mut item = schema::of_keyword::<T>(word)?;
        self.fields(&mut item, &mut members);
        self.finish(members);
        Some(item)
    }

    /// Reads an item and stores its span.
    pub fn spanned<T>(&mut self, node: &Node, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<Spanned<T>> {
        Some(Spanned { value: read(self)?, span: self.span(&node.head()) })
    }

    /// Returns a required member, or reports an error if it is missing.
    pub fn required<'n>(&mut self, members: &mut Members<'n>, name: &'static str) -> Option<&'n Node> {
        let node = members.take(name);
        if node.is_none() {
            let message = format!("`{}` has no `{name}`", members.name);
            self.error(members.at.clone(), "missing-field", message, None);
        }
        node
    }
}
