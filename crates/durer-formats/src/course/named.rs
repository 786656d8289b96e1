//! Handles names of materials, and names of objects that are defined once and used several times.

use super::lexer::TokenKind;
use super::nodes::set_material;
use super::reader::Reader;
use super::words::is_reserved;
use crate::growth::MAX_OBJECTS;
use durer_diag::{Diagnostic, Span, did_you_mean};
use durer_scene::dialect::set;
use durer_scene::scene::{Group, Object, ObjectKind};

impl Reader<'_, '_> {
    /// Reads the name of a material, which can come before the block of the material.
    pub(super) fn material_name(&mut self) -> Option<(String, Span)> {
        let named = self.peek_word().filter(|_| self.ahead(1).is_some_and(|next| next.kind == TokenKind::Open));
        let name = named.filter(|name| !is_reserved(name))?;
        let span = self.advance();
        self.report_foreign_word("names of materials", span, set::DURER);
        Some((name, span))
    }

    /// Gives a name to the next material.
    pub(super) fn name_material(&mut self, (name, span): (String, Span)) {
        if !self.is_name(&name, span) {
            return;
        }
        let number = self.scene.materials.len() as u32;
        if self.named.materials.insert(name.clone(), number).is_some() {
            self.error(Diagnostic::error(format!("a material `{name}` already exists")).code("repeated").at(span));
        }
    }

    /// Reads the number or the name of a material, and returns the number.
    pub(super) fn material_number(&mut self, word: &str) -> Option<u32> {
        let name = self.peek_word().filter(|text| !text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)));
        // If a word of the language comes next, the number is missing.
        let Some(name) = name.filter(|name| self.named.materials.contains_key(name) || !is_reserved(name)) else {
            return self.integer(word);
        };
        let span = self.advance();
        let number = self.named.materials.get(&name).copied();
        if number.is_none() {
            let near = did_you_mean(&name, self.named.materials.keys().map(String::as_str)).map(str::to_string);
            let error = Diagnostic::error(format!("no material `{name}` is defined before this point"))
                .code("unknown-word")
                .at(span);
            let later = self.named_later(&name);
            self.error_once(match (near, later) {
                (_, Some(later)) => error
                    .related(later, "the material has its name here, which is too late")
                    .help("move that material before this point"),
                (Some(near), None) => error.help(format!("did you mean `{near}`?")).fix(span, near),
                (None, None) => {
                    error.help("write the name before the material's block, for example `PhongMaterial gold { ... }`")
                }
            });
            return None;
        }
        self.report_foreign_word("names of materials", span, set::DURER);
        number
    }

    /// Returns the place after the current one where a block has a name.
    fn named_later(&self, name: &str) -> Option<Span> {
        let tokens = (0..).map_while(|i| Some((self.ahead(i)?, self.ahead(i + 1)?)));
        let mut named = tokens.filter(|(word, next)| word.kind == TokenKind::Word && next.kind == TokenKind::Open);
        named.find(|(word, _)| self.text(word.span) == name).map(|(word, _)| word.span)
    }

    /// Returns true if a word can be used as a name, and otherwise reports an error.
    fn is_name(&mut self, name: &str, span: Span) -> bool {
        let taken = is_reserved(name);
        let number = name.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        if taken || number {
            let why = if taken { "a word of the language" } else { "a number" };
            let error = Diagnostic::error(format!("`{name}` cannot be a name: it is {why}")).code("bad-value");
            self.error(error.at(span));
        }
        !taken && !number
    }

    /// Reads the name that follows a keyword.
    fn name_after(&mut self, word: &str) -> Option<(String, Span)> {
        let Some(name) = self.peek_word() else {
            self.expected("a name", word);
            return None;
        };
        let span = self.advance();
        Some((name, span))
    }

    /// Reads `define NAME object`, without adding the object to the scene. Parts that have no
    /// material get the material that is current at each use.
    pub(super) fn define(&mut self, keyword: Span) {
        self.report_foreign_word("define", keyword, set::DURER);
        let Some((name, span)) = self.name_after("define") else { return };
        let sound = self.is_name(&name, span);
        let Some(word) = self.peek_word() else { return self.expected("an object", "define") };
        let at = self.advance();
        let (outer, used) = (self.material.take(), self.named.used_objects);
        let object = self.object(&word, at);
        self.material = outer;
        // If a definition uses other objects, they are counted every time the definition is used.
        self.named.used_objects = used;
        let Some(object) = object.filter(|_| sound) else {
            self.named.invalid_objects.insert(name);
            return;
        };
        if let Some((_, _, first)) = self.named.objects.get(&name) {
            let error = Diagnostic::error(format!("`{name}` is defined already")).code("repeated").at(span);
            let error = error.related(*first, "the first definition is here");
            return self.error(error);
        }
        let count = count(&object);
        self.named.objects.insert(name, (object, count, span));
    }

    /// Reads `use NAME`, and returns a copy of the object that has been defined.
    pub(super) fn use_object(&mut self, keyword: Span) -> Option<ObjectKind> {
        self.report_foreign_word("use", keyword, set::DURER);
        let (name, span) = self.name_after("use")?;
        if self.named.invalid_objects.contains(&name) {
            self.repeated += 1;
            return None;
        }
        let Some((object, count, _)) = self.named.objects.get(&name) else {
            let near = did_you_mean(&name, self.named.objects.keys().map(String::as_str)).map(str::to_string);
            let error = Diagnostic::error(format!("nothing is defined as `{name}` before this point"))
                .code("unknown-word")
                .at(span);
            self.error_once(match near {
                Some(near) => error.help(format!("did you mean `{near}`?")).fix(span, near),
                None => error.help("write `define NAME` and an object first, outside the object that uses it"),
            });
            return None;
        };
        self.named.used_objects = self.named.used_objects.saturating_add(*count);
        if self.named.used_objects > MAX_OBJECTS {
            let message = format!("the scene has more than {MAX_OBJECTS} objects, counting each use");
            self.error(Diagnostic::error(message).code("limit").at(keyword.join(span)));
            self.stop();
            return None;
        }
        let mut object = object.clone();
        if let Some(material) = self.material {
            set_material(&mut object, material);
        }
        // A group that contains a single object cannot have a material.
        Some(ObjectKind::Group(Group { objects: vec![object] }))
    }
}

/// Returns the number of objects of which an object consists, including the object itself.
fn count(object: &Object) -> usize {
    object.node.children().iter().map(count).fold(1, usize::saturating_add)
}
