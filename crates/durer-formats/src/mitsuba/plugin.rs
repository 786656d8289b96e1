//! Represents Mitsuba plugins, which have a type and named properties.

use crate::shared_report::{SharedReport, suggest};
use durer_diag::Span;
use durer_scene::math::Vec3;
use glam::{DAffine3, DVec3};
use std::cell::{Cell, RefCell};
use std::rc::Rc;

/// Position that identifies a plugin: the file index and the byte offset.
pub(super) type Key = (u32, u32);

/// Mitsuba plugin: an element that has a `type`, such as `<shape type="sphere">`, with its
/// properties.
pub(super) struct Plugin {
    /// Name of the element, such as `shape`.
    pub element: String,
    /// Value of the attribute `type`, which is empty for the scene.
    pub kind: String,
    /// Span of the type, or of the whole tag if it has no type.
    pub at: Span,
    pub properties: Vec<Property>,
    /// Property names that the reader has asked for. All other properties are reported as unknown.
    known_names: RefCell<Vec<&'static str>>,
}

/// Property of a Mitsuba plugin, with a name and a value. The name can be empty if the value is a
/// nested plugin.
pub(super) struct Property {
    pub name: String,
    pub value: Value,
    /// Span of the value.
    pub at: Span,
    /// Name as the file writes it, and its span, if the property is a plain value.
    pub written: Option<(String, Span)>,
    pub used: Cell<bool>,
}

/// Value of a Mitsuba property: a number, text, vector, spectrum, transform or plugin.
#[derive(Clone)]
pub(super) enum Value {
    Number(f64),
    Bool(bool),
    Text(String),
    Vector(DVec3),
    Rgb(Vec3),
    /// Spectrum with the same value at all wavelengths.
    ConstantSpectrum(f32),
    /// Pairs of a wavelength in nanometres and a value, in ascending order of wavelength.
    Spectrum(Vec<[f32; 2]>),
    Transform(DAffine3),
    Plugin(Rc<Plugin>),
    /// Reference to another plugin by its `id`.
    Ref(String),
}

impl Value {
    fn kind(&self) -> &'static str {
        match self {
            Value::Number(_) => "a number",
            Value::Bool(_) => "`true` or `false`",
            Value::Text(_) => "a string",
            Value::Vector(_) => "a vector",
            Value::Rgb(_) => "a colour",
            Value::ConstantSpectrum(_) | Value::Spectrum(_) => "a spectrum",
            Value::Transform(_) => "a transform",
            Value::Plugin(_) | Value::Ref(_) => "a plugin",
        }
    }
}

impl Plugin {
    pub fn new(class: &str, kind: String, at: Span) -> Plugin {
        let known_names = RefCell::default();
        Plugin { element: class.into(), kind, at, properties: Vec::new(), known_names }
    }

    /// Returns a key that identifies the plugin.
    pub fn key(&self) -> Key {
        (self.at.file, self.at.start)
    }

    /// Marks properties as known, so that no warning is reported for them.
    pub fn mark_known(&self, names: &[&'static str]) {
        self.known_names.borrow_mut().extend(names);
    }

    /// Finds a property by name, marks it as used and returns it.
    pub fn get(&self, name: &'static str) -> Option<&Property> {
        self.mark_known(&[name]);
        let found = self.properties.iter().find(|property| property.name == name);
        found.inspect(|property| property.used.set(true))
    }

    /// Returns the span of a property's value, or the span of the plugin if the property is
    /// missing.
    pub fn span(&self, name: &'static str) -> Span {
        self.get(name).map_or(self.at, |property| property.at)
    }

    /// Returns the value of a property if it has the expected type, and otherwise reports an error.
    fn typed<T>(
        &self,
        report: &SharedReport,
        name: &'static str,
        what: &str,
        get: impl Fn(&Value) -> Option<T>,
    ) -> Option<T> {
        let property = self.get(name)?;
        let value = get(&property.value);
        if value.is_none() {
            report.error(property.at, format!("`{name}` must be {what}, not {}", property.value.kind()));
        }
        value
    }

    /// Returns a number, and reports an error if the value has another type.
    pub fn number(&self, report: &SharedReport, name: &'static str) -> Option<f32> {
        self.typed(report, name, "a number", |value| match value {
            Value::Number(number) => Some(*number as f32),
            Value::ConstantSpectrum(number) => Some(*number),
            _ => None,
        })
    }

    /// Returns a number, which must be greater than 0.
    pub fn positive(&self, report: &SharedReport, name: &'static str) -> Option<f32> {
        let number = self.number(report, name)?;
        if number <= 0.0 {
            report.error(self.span(name), format!("`{name}` must be more than 0"));
        }
        Some(number).filter(|number| *number > 0.0)
    }

    /// Returns a boolean, and reports an error if the value has another type.
    pub fn boolean(&self, report: &SharedReport, name: &'static str) -> Option<bool> {
        self.typed(report, name, "`true` or `false`", |value| match value {
            Value::Bool(truth) => Some(*truth),
            _ => None,
        })
    }

    /// Returns a string, and reports an error if the value has another type.
    pub fn text(&self, report: &SharedReport, name: &'static str) -> Option<String> {
        self.typed(report, name, "a string", |value| match value {
            Value::Text(text) => Some(text.clone()),
            _ => None,
        })
    }

    /// Returns a vector or point, and reports an error if the value has another type.
    pub fn vector(&self, report: &SharedReport, name: &'static str) -> Option<DVec3> {
        self.typed(report, name, "a vector or point", |value| match value {
            Value::Vector(vector) => Some(*vector),
            _ => None,
        })
    }

    /// Returns a transform, which is the identity if the property is missing.
    pub fn transform(&self, report: &SharedReport, name: &'static str) -> DAffine3 {
        let transform = self.typed(report, name, "a transform", |value| match value {
            Value::Transform(transform) => Some(*transform),
            _ => None,
        });
        transform.unwrap_or(DAffine3::IDENTITY)
    }

    /// Warns about properties that have no counterpart in Dürer. `instead` says what is used
    /// instead.
    pub fn warn_unsupported(&self, report: &SharedReport, names: &[&'static str], instead: &str) {
        for name in names {
            if let Some(property) = self.get(name) {
                report.unsupported_once(property.at, format!("`{name}` has no counterpart: {instead}"));
            }
        }
    }

    /// Warns about properties that are unknown or unused.
    pub fn warn_unused(&self, report: &SharedReport) {
        let known_names = self.known_names.borrow();
        for property in &self.properties {
            let nested = matches!(property.value, Value::Plugin(_) | Value::Ref(_));
            if property.used.get() || known_names.contains(&property.name.as_str()) {
                continue;
            }
            let message = match (nested, property.name.as_str()) {
                (true, "") => {
                    format!("this nested plugin is ignored: the {} `{}` does not use it", self.element, self.kind)
                }
                (_, name) => {
                    let name = property.written.as_ref().map_or(name, |(written, _)| written);
                    format!("the {} `{}` has no property `{name}`: it is ignored", self.element, self.kind)
                }
            };
            let spelt_out = known_names.iter().find(|known| **known == initials(&property.name));
            let help = match spelt_out {
                Some(known) => Some(format!("did you mean `{known}`?")),
                None => suggest(&property.name, known_names.iter().copied()),
            };
            let at = property.written.as_ref().map_or(property.at, |(_, at)| *at);
            let warning = durer_diag::Diagnostic::warning(message).code("unknown-property").at(at);
            report.push(durer_diag::Diagnostic { help, ..warning });
        }
    }
}

/// Returns the first letters of the words of a name: `fov` for `field_of_view`.
fn initials(name: &str) -> String {
    name.split('_').filter_map(|word| word.chars().next()).collect()
}

/// Returns true if a shape is a sphere whose normals point inwards because of `flip_normals` or a
/// mirroring transform.
pub(super) fn is_inside_out(plugin: &Plugin, report: &SharedReport) -> bool {
    let flipped = || plugin.boolean(report, "flip_normals").unwrap_or(false);
    plugin.kind == "sphere" && flipped() != (plugin.transform(report, "to_world").matrix3.determinant() < 0.0)
}
