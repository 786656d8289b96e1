//! XML elements, which are built as a tree and then written as text.

use durer_scene::math::Vec3;
use glam::DAffine3;
use std::fmt::Display;

/// XML element with attributes and children.
pub(super) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
}

impl Element {
    pub fn new(name: &'static str) -> Self {
        Element { name, attributes: Vec::new(), children: Vec::new() }
    }

    /// Returns the element of a plugin, such as `<shape type="sphere">`.
    pub fn plugin(element: &'static str, kind: &str) -> Self {
        Element::new(element).with("type", kind)
    }

    /// Adds an attribute.
    pub fn with(mut self, name: &'static str, value: impl Display) -> Self {
        self.attributes.push((name, value.to_string()));
        self
    }

    /// Adds a child.
    pub fn and(mut self, child: Element) -> Self {
        self.children.push(child);
        self
    }

    /// Adds children.
    pub fn and_all(mut self, children: impl IntoIterator<Item = Element>) -> Self {
        self.children.extend(children);
        self
    }

    /// Adds a named property of type `element`, such as `<float name="radius" value="1"/>`.
    pub fn property(self, element: &'static str, name: &'static str, value: impl Display) -> Self {
        self.and(Element::new(element).with("name", name).with("value", value))
    }

    pub fn float(self, name: &'static str, value: impl Display) -> Self {
        self.property("float", name, value)
    }

    pub fn integer(self, name: &'static str, value: u32) -> Self {
        self.property("integer", name, value)
    }

    pub fn text(self, name: &'static str, value: &str) -> Self {
        self.property("string", name, value)
    }

    /// Adds a named property with coordinates; `element` is `point` or `vector`.
    pub fn vector(self, element: &'static str, name: &'static str, [x, y, z]: [impl Display; 3]) -> Self {
        self.and(Element::new(element).with("name", name).with("x", x).with("y", y).with("z", z))
    }

    pub fn boolean(self, name: &'static str, value: bool) -> Self {
        self.property("boolean", name, value)
    }

    /// Adds a colour.
    pub fn rgb(self, name: &'static str, color: Vec3) -> Self {
        self.property("rgb", name, format!("{} {} {}", color.x, color.y, color.z))
    }

    /// Adds a transform as a matrix, unless it is the identity.
    pub fn transform(self, name: &'static str, map: &DAffine3) -> Self {
        if *map == DAffine3::IDENTITY {
            return self;
        }
        let (m, t) = (map.matrix3, map.translation);
        let rows = [0, 1, 2].map(|i| format!("{} {} {} {}", m.x_axis[i], m.y_axis[i], m.z_axis[i], t[i]));
        let matrix = Element::new("matrix").with("value", format!("{} 0 0 0 1", rows.join(" ")));
        self.and(Element::new("transform").with("name", name).and(matrix))
    }

    /// Appends the element as text, indented by `depth` levels.
    pub fn write(&self, depth: usize, out: &mut String) {
        let indent = "    ".repeat(depth);
        *out += &format!("{indent}<{}", self.name);
        for (name, value) in &self.attributes {
            *out += &format!(" {name}=\"{}\"", escaped(value));
        }
        if self.children.is_empty() {
            *out += "/>\n";
            return;
        }
        *out += ">\n";
        self.children.iter().for_each(|child| child.write(depth + 1, out));
        *out += &format!("{indent}</{}>\n", self.name);
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
