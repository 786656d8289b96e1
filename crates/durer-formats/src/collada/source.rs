//! Lists of numbers, and the accessors that divide them into vectors.

use super::document::Element;
use super::parts::Source;
use super::reader::Reader;
use durer_diag::Diagnostic;
use std::rc::Rc;

impl<'r> Reader<'r> {
    /// Returns the element that an attribute refers to, such as `source="#positions"`. Reports if
    /// there is none with this name.
    pub fn referred(&self, from: &'r Element<'r>, attribute: &str, name: &str) -> Option<&'r Element<'r>> {
        let Some(url) = from.get(attribute) else {
            self.report.error(from.at, format!("`{}` needs the attribute `{attribute}`", from.name));
            return None;
        };
        let at = from.span_of(attribute);
        let Some(id) = url.strip_prefix('#').or((!url.contains('#')).then_some(url)) else {
            let message = "references to other files have no counterpart: what they refer to is left out";
            self.report.unsupported_once(at, message);
            return None;
        };
        match self.ids.get(id) {
            Some(element) if element.name == name => Some(element),
            Some(element) => {
                self.report.error(at, format!("`{id}` must be a `{name}`, but it is a `{}`", element.name));
                None
            }
            None => {
                let similar = self.ids.iter().filter(|(_, element)| element.name == name).map(|(id, _)| *id);
                let help = crate::shared_report::suggest(id, similar);
                let message = format!("the file has no `{name}` with the id `{id}`");
                // A mesh can be shown without these.
                if matches!(name, "camera" | "light" | "material" | "effect") {
                    let warning = Diagnostic::warning(format!("{message}: it is left out")).code("missing-element");
                    self.report.push(Diagnostic { help, ..warning.at(at) });
                } else {
                    self.report.error_with_help(at, message, help);
                }
                None
            }
        }
    }

    /// Returns the list of vectors that an input refers to. `width` is the number of components if
    /// the file does not state it.
    pub fn source(&mut self, input: &'r Element<'r>, width: usize) -> Option<Rc<Source>> {
        let element = self.referred(input, "source", "source")?;
        let key = element.get("id").unwrap_or_default();
        if let Some(known) = self.sources.get(key) {
            return known.clone();
        }
        let source = self.read_source(element, width).map(Rc::new);
        self.sources.insert(key, source.clone());
        source
    }

    fn read_source(&self, element: &'r Element<'r>, width: usize) -> Option<Source> {
        let (report, limits) = (self.report, self.limits);
        let accessor = element.child("technique_common").and_then(|common| common.child("accessor"));
        let own = || element.child("float_array");
        let referred = accessor.and_then(|accessor| self.ids.get(accessor.get("source")?.strip_prefix('#')?).copied());
        let Some(array) = referred.filter(|array| array.name == "float_array").or_else(own) else {
            report.error(element.at, "this `source` has no `float_array`");
            return None;
        };
        let mut values = array.numbers(report, limits);
        let whole = |name: &str, default: usize| -> Option<usize> {
            let Some((text, accessor)) = accessor.and_then(|accessor| Some((accessor.get(name)?, accessor))) else {
                return Some(default);
            };
            let number = text.trim().parse::<u32>().ok();
            if number.is_none() {
                report.error(accessor.span_of(name), format!("`{name}` must be an integer of 0 or more"));
            }
            number.map(|number| number as usize)
        };
        let stride = whole("stride", if accessor.is_some() { 1 } else { width })?;
        if stride == 0 {
            report.error(accessor.map_or(element.at, |accessor| accessor.span_of("stride")), "`stride` must not be 0");
            return None;
        }
        let offset = whole("offset", 0)?.min(values.len());
        values.drain(..offset);
        let there = values.len() / stride;
        let count = whole("count", there)?;
        if count > there && !report.has_errors() {
            let message = format!(
                "this `source` should have {count} vectors of {stride} numbers, but its numbers are enough for {there}"
            );
            report.error(element.at, message);
            return None;
        }
        Some(Source { values, stride, count: count.min(there) })
    }
}
