//! Directives of pbrt with their parameters, as text.

use durer_scene::math::Vec3;
use glam::{DAffine3, DMat4};
use std::fmt::Display;

/// Directive with a type and parameters, such as `Shape "sphere" "float radius" [ 2 ]`.
pub(super) struct Directive {
    text: String,
}

impl Directive {
    pub fn new(name: &str, kind: &str) -> Self {
        Directive { text: format!("{name} {}", quoted(kind)) }
    }

    /// Returns parameters without a directive.
    pub fn empty() -> Self {
        Directive { text: String::new() }
    }

    /// Adds a parameter with numbers.
    pub fn numbers<T: Display>(mut self, kind: &str, name: &str, values: impl IntoIterator<Item = T>) -> Self {
        let values: Vec<String> = values.into_iter().map(|value| value.to_string()).collect();
        self.text += &format!(" \"{kind} {name}\" [ {} ]", values.join(" "));
        self
    }

    pub fn float(self, name: &str, value: impl Display) -> Self {
        self.numbers("float", name, [value])
    }

    pub fn integer(self, name: &str, value: u32) -> Self {
        self.numbers("integer", name, [value])
    }

    pub fn rgb(self, name: &str, color: Vec3) -> Self {
        self.numbers("rgb", name, color.to_array())
    }

    pub fn point(self, name: &str, point: Vec3) -> Self {
        self.numbers("point3", name, point.to_array())
    }

    pub fn boolean(mut self, name: &str, value: bool) -> Self {
        self.text += &format!(" \"bool {name}\" {value}");
        self
    }

    /// Adds a parameter with texts: `kind` is `string` or `texture`.
    pub fn texts(mut self, kind: &str, name: &str, values: &[&str]) -> Self {
        let values: Vec<String> = values.iter().map(|value| quoted(value)).collect();
        self.text += &format!(" \"{kind} {name}\" [ {} ]", values.join(" "));
        self
    }

    pub fn string(self, name: &str, value: &str) -> Self {
        self.texts("string", name, &[value])
    }

    /// Returns the line of the directive.
    pub fn line(self) -> String {
        self.text + "\n"
    }
}

/// Returns a directive that multiplies the current transform by a matrix, or an empty text for the
/// identity.
pub(super) fn transform(map: &DAffine3) -> String {
    if *map == DAffine3::IDENTITY {
        return String::new();
    }
    let columns = DMat4::from(*map).to_cols_array().map(|x| x.to_string());
    format!("ConcatTransform [ {} ]\n", columns.join(" "))
}

/// Returns lines between `AttributeBegin` and `AttributeEnd`.
pub(super) fn scoped(lines: &str) -> String {
    let lines: String = lines.lines().map(|line| format!("    {line}\n")).collect();
    format!("AttributeBegin\n{lines}AttributeEnd\n")
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
