//! Parses the XML of a model part, which contains resources and build items.

use super::model::{Model, Object, ObjectRef, PropertyKind};
use super::package::Package;
use crate::shared_report::{SharedReport, suggest};
use crate::xml::{Event, Tag, Xml};
use durer_diag::{Diagnostic, Span};
use glam::DAffine3;
use std::sync::Arc;

/// Units of length, and their sizes in millimetres.
const UNITS: [(&str, f64); 6] =
    [("micron", 1e-3), ("millimeter", 1.0), ("centimeter", 10.0), ("inch", 25.4), ("foot", 304.8), ("meter", 1000.0)];
const TYPES: [&str; 5] = ["model", "solidsupport", "support", "surface", "other"];

/// Parser for the XML of one model part.
pub(super) struct Parser<'a, 'x> {
    pub xml: Xml<'x>,
    pub report: &'a SharedReport,
    pub model: Model,
}

/// Error type of the 3MF parser, which means that parsing cannot continue and that the error has
/// already been reported.
pub(super) struct ErrorReported;

/// Reads a model part from an archive and parses it.
pub fn read(package: &mut Package, name: &str, at: Span, report: &SharedReport) -> Option<Model> {
    let Some((bytes, file)) = package.part(name, at) else {
        if !report.has_errors() {
            report.error(at, format!("the archive has no part `{name}`"));
        }
        return None;
    };
    let bytes: Arc<[u8]> = bytes;
    let xml = match Xml::new(&bytes, file) {
        Ok(xml) => xml,
        Err(error) => {
            report.push(*error);
            return None;
        }
    };
    let mut parser = Parser { xml, report, model: Model { unit: 1.0, ..Model::default() } };
    parser.read_package_model().ok()?;
    Some(parser.model)
}

impl<'x> Parser<'_, 'x> {
    /// Returns the next child of the open element, or `None` at the end of the element.
    pub fn next(&mut self) -> Result<Option<Tag<'x>>, ErrorReported> {
        match self.xml.next() {
            _ if self.report.is_full() => Err(ErrorReported),
            Ok(Event::Open(tag)) => Ok(Some(tag)),
            Ok(_) => Ok(None),
            Err(error) => {
                self.report.push(*error);
                Err(ErrorReported)
            }
        }
    }

    /// Skips everything up to the end of the open element.
    pub fn skip(&mut self) -> Result<(), ErrorReported> {
        let mut depth = 1;
        while depth > 0 {
            match self.next()? {
                Some(_) => depth += 1,
                None => depth -= 1,
            }
        }
        Ok(())
    }

    fn read_package_model(&mut self) -> Result<(), ErrorReported> {
        let Some(tag) = self.next()? else { return Err(ErrorReported) };
        if tag.name != "model" {
            self.report.error(tag.at, format!("expected `<model>`, found `<{}>`", tag.name));
            return Err(ErrorReported);
        }
        if let Some(unit) = tag.get("unit") {
            match UNITS.iter().find(|row| row.0 == unit.value) {
                Some(row) => self.model.unit = row.1,
                None => {
                    let help = suggest(&unit.value, UNITS.map(|row| row.0));
                    self.report.error_with_help(unit.at, format!("unknown unit `{}`", unit.value), help);
                }
            }
        }
        let mut built = None;
        while let Some(part) = self.next()? {
            match part.name {
                "resources" => self.resources()?,
                "build" => {
                    built = Some(part.at);
                    self.build()?;
                }
                "model" => {
                    self.report.error(part.at, "a file can have only one `<model>` element, and this is the second");
                    return Err(ErrorReported);
                }
                _ => self.skip()?,
            }
        }
        // No other element may follow `<model>`.
        self.next()?;
        if built.is_none() {
            self.report.error(tag.at, "a model needs a `<build>` that lists the objects to show");
        }
        Ok(())
    }

    fn resources(&mut self) -> Result<(), ErrorReported> {
        while let Some(tag) = self.next()? {
            match tag.name {
                "object" => self.object(&tag)?,
                name if PropertyKind::NAMES.contains(&name) => self.properties(&tag)?,
                _ => self.skip()?,
            }
        }
        Ok(())
    }

    /// Reads the id of a resource; no other resource may have the same id.
    pub fn new_id(&self, tag: &Tag) -> Option<u32> {
        let id = self.integer(tag, "id")?;
        let earlier = self.model.objects.get(&id).map(|earlier| earlier.1);
        if let Some(first) = earlier.or(self.model.properties.get(&id).map(|earlier| earlier.at)) {
            let error = Diagnostic::error(format!("two resources have the id {id}")).code("bad-value").at(tag.at);
            self.report.push(error.related(first, "the first one is here"));
            return None;
        }
        Some(id)
    }

    /// Reads a required integer.
    pub fn integer(&self, tag: &Tag, name: &str) -> Option<u32> {
        let Some(attribute) = tag.get(name) else {
            self.report.error(tag.at, format!("`<{}>` needs `{name}=\"...\"`", tag.name));
            return None;
        };
        let number = attribute.value.trim().parse::<u32>().ok();
        if number.is_none() {
            self.report.error(attribute.at, format!("expected a whole number, found `{}`", attribute.value));
        }
        number
    }

    /// Reads an optional integer.
    pub fn optional_number(&self, tag: &Tag, name: &str) -> Option<u32> {
        tag.get(name)?;
        self.integer(tag, name)
    }

    /// Reads an optional number.
    pub fn number(&self, tag: &Tag, name: &str) -> Option<f32> {
        let attribute = tag.get(name)?;
        let number = attribute.value.trim().parse::<f32>().ok().filter(|number| number.is_finite());
        if number.is_none() {
            self.report.error(attribute.at, format!("expected a number, found `{}`", attribute.value));
        }
        number
    }

    fn object(&mut self, tag: &Tag) -> Result<(), ErrorReported> {
        let id = self.new_id(tag);
        if let Some(kind) = tag.get("type").filter(|kind| !TYPES.contains(&&*kind.value)) {
            let help = suggest(&kind.value, TYPES);
            self.report.error_with_help(kind.at, format!("unknown object type `{}`", kind.value), help);
        }
        let (pid, pindex) = (self.optional_number(tag, "pid"), self.optional_number(tag, "pindex"));
        if let (None, Some(_), Some(attribute)) = (pid, pindex, tag.get("pindex")) {
            self.report.error(attribute.at, "`pindex` needs a `pid`");
        }
        let mut object = None;
        while let Some(part) = self.next()? {
            match part.name {
                "mesh" => object = Some(Object::Mesh(Box::new(self.mesh(pid.zip(pindex.or(Some(0))))?))),
                "components" => object = Some(Object::Components(self.object_refs("component")?)),
                _ => self.skip()?,
            }
        }
        match (id, object) {
            (Some(id), Some(object)) => {
                self.model.objects.insert(id, (object, tag.at));
            }
            (_, None) => self.report.error(tag.at, "an object needs a `<mesh>` or `<components>`"),
            _ => {}
        }
        Ok(())
    }

    fn build(&mut self) -> Result<(), ErrorReported> {
        self.model.items = self.object_refs("item")?;
        Ok(())
    }

    /// Reads a list of build items or components.
    fn object_refs(&mut self, name: &str) -> Result<Vec<ObjectRef>, ErrorReported> {
        let mut places = Vec::new();
        while let Some(tag) = self.next()? {
            if tag.name == name
                && let Some(id) = self.integer(&tag, "objectid")
            {
                let part = tag.get("path").map(|path| path.value.trim_start_matches('/').to_string());
                places.push(ObjectRef { part, id, transform: self.transform(&tag), at: tag.at });
            }
            self.skip()?;
        }
        Ok(places)
    }

    /// Reads a transform, given as twelve numbers for multiplication with row vectors: three axes,
    /// then the translation.
    fn transform(&self, tag: &Tag) -> DAffine3 {
        let Some(attribute) = tag.get("transform") else { return DAffine3::IDENTITY };
        let words = attribute.value.split_whitespace();
        let numbers: Option<Vec<f64>> =
            words.map(|word| word.parse::<f64>().ok().filter(|x| (*x as f32).is_finite())).collect();
        let transform =
            numbers.and_then(|all| <[f64; 12]>::try_from(all).ok()).map(|all| DAffine3::from_cols_array(&all));
        match transform {
            Some(transform) if transform.matrix3.determinant() != 0.0 => transform,
            found => {
                let what = if found.is_some() { "an invertible transform" } else { "twelve numbers" };
                self.report.error(attribute.at, format!("expected {what}, found `{}`", attribute.value));
                DAffine3::IDENTITY
            }
        }
    }
}
