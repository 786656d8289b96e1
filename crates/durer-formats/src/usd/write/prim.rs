//! Prims as text.

use glam::{DAffine3, DVec3};
use std::fmt::Write as _;

/// Prim with its attributes as lines, and its children.
pub(super) struct Prim {
    specifier: &'static str,
    kind: &'static str,
    pub name: String,
    metadata: Vec<String>,
    lines: Vec<String>,
    pub children: Vec<Prim>,
}

impl Prim {
    pub fn new(kind: &'static str, name: impl Into<String>) -> Prim {
        Prim {
            specifier: "def",
            kind,
            name: name.into(),
            metadata: Vec::new(),
            lines: Vec::new(),
            children: Vec::new(),
        }
    }

    /// Creates a prim that is visible only where others refer to it.
    pub fn class(kind: &'static str, name: impl Into<String>) -> Prim {
        Prim { specifier: "class", ..Prim::new(kind, name) }
    }

    pub fn meta(mut self, line: impl Into<String>) -> Prim {
        self.metadata.push(line.into());
        self
    }

    pub fn line(mut self, line: impl Into<String>) -> Prim {
        self.lines.push(line.into());
        self
    }

    pub fn lines(mut self, lines: impl IntoIterator<Item = String>) -> Prim {
        self.lines.extend(lines);
        self
    }

    /// Adds the transform to the space of the parent.
    pub fn transform(self, map: &DAffine3) -> Prim {
        if *map == DAffine3::IDENTITY {
            return self;
        }
        let m = map.matrix3;
        let row = |v: DVec3, w: u8| format!("({}, {}, {}, {w})", v.x, v.y, v.z);
        let rows = [row(m.x_axis, 0), row(m.y_axis, 0), row(m.z_axis, 0), row(map.translation, 1)].join(", ");
        self.line(format!("matrix4d xformOp:transform = ( {rows} )"))
            .line("uniform token[] xformOpOrder = [\"xformOp:transform\"]")
    }

    /// Appends the prim to a text.
    pub fn write(&self, depth: usize, text: &mut String) {
        let indent = "    ".repeat(depth);
        let _ = write!(text, "{indent}{} {} \"{}\"", self.specifier, self.kind, self.name);
        if !self.metadata.is_empty() {
            text.push_str(" (\n");
            self.metadata.iter().for_each(|line| _ = writeln!(text, "{indent}    {line}"));
            let _ = write!(text, "{indent})");
        }
        let _ = write!(text, "\n{indent}{{\n");
        self.lines.iter().for_each(|line| _ = writeln!(text, "{indent}    {line}"));
        self.children.iter().for_each(|child| child.write(depth + 1, text));
        let _ = writeln!(text, "{indent}}}");
    }
}

/// Returns a list of vectors as text.
pub(super) fn vectors<const N: usize>(values: impl IntoIterator<Item = [f32; N]>) -> String {
    let mut text = String::from("[");
    for (i, value) in values.into_iter().enumerate() {
        text.push_str(if i == 0 { "(" } else { ", (" });
        for (k, number) in value.iter().enumerate() {
            let _ = write!(text, "{}{number}", if k == 0 { "" } else { ", " });
        }
        text.push(')');
    }
    text + "]"
}

/// Returns a list of numbers as text.
pub(super) fn numbers(values: impl IntoIterator<Item = u32>) -> String {
    let mut text = String::from("[");
    for (i, value) in values.into_iter().enumerate() {
        let _ = write!(text, "{}{value}", if i == 0 { "" } else { ", " });
    }
    text + "]"
}

/// Returns a vector as text.
pub(super) fn tuple<const N: usize>(value: [f32; N]) -> String {
    format!("({})", value.map(|x| x.to_string()).join(", "))
}
