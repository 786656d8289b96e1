//! Contents of one USD layer, which is one `.usda` or `.usdc` file: its prims, their properties and
//! the arcs to other prims and layers. Nothing is composed here.

use durer_diag::Span;
use std::collections::BTreeMap;

/// Value of an attribute or of a metadata field. Numbers of all types are stored in double
/// precision.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// `None` in a text file, which hides weaker values.
    Blocked,
    Bool(bool),
    Number(f64),
    /// Vector, quaternion (real part first) or matrix (row by row).
    Tuple(Vec<f64>),
    /// String, token or path.
    Text(String),
    /// Path of another file.
    Asset(String),
    /// Array of numbers, or of vectors with `width` components each.
    Numbers {
        width: usize,
        values: Vec<f64>,
    },
    Texts(Vec<String>),
    Dictionary(BTreeMap<String, Value>),
}

impl Value {
    /// Returns all numbers of a number, vector or array; empty for other values.
    pub fn numbers(&self) -> &[f64] {
        match self {
            Value::Number(number) => std::slice::from_ref(number),
            Value::Tuple(values) | Value::Numbers { values, .. } => values,
            _ => &[],
        }
    }

    /// Returns a number, or the only number of an array.
    pub fn number(&self) -> Option<f64> {
        match (self, self.numbers()) {
            (Value::Bool(value), _) => Some(f64::from(u8::from(*value))),
            (_, [number]) => Some(*number),
            _ => None,
        }
    }

    /// Returns a string, token, path or file name.
    pub fn text(&self) -> Option<&str> {
        match self {
            Value::Text(text) | Value::Asset(text) => Some(text),
            Value::Texts(texts) => texts.first().map(String::as_str),
            _ => None,
        }
    }

    /// Returns a truth value, which some programs write as a number.
    pub fn boolean(&self) -> Option<bool> {
        match self {
            Value::Bool(value) => Some(*value),
            _ => self.number().map(|number| number != 0.0),
        }
    }

    /// Number of bytes of memory that the value uses, approximately.
    pub fn bytes(&self) -> usize {
        match self {
            Value::Tuple(values) | Value::Numbers { values, .. } => 8 * values.len(),
            Value::Text(text) | Value::Asset(text) => text.len(),
            Value::Texts(texts) => texts.iter().map(|text| 24 + text.len()).sum(),
            Value::Dictionary(entries) => entries.iter().map(|(key, value)| key.len() + value.bytes()).sum(),
            Value::Blocked | Value::Bool(_) | Value::Number(_) => 0,
        }
    }
}

/// Edit of a list. Stronger layers edit the list of weaker ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ListEdit<T> {
    /// List that replaces the weaker one.
    pub explicit: Option<Vec<T>>,
    pub prepended: Vec<T>,
    pub appended: Vec<T>,
    pub deleted: Vec<T>,
}

impl<T: Clone + PartialEq> ListEdit<T> {
    /// Edit that replaces a list.
    pub fn replacing(items: Vec<T>) -> Self {
        ListEdit { explicit: Some(items), prepended: Vec::new(), appended: Vec::new(), deleted: Vec::new() }
    }

    /// Adds an edit of the same list; `operation` is the word before the field in a text file.
    pub fn add(&mut self, operation: &str, items: Vec<T>) {
        match operation {
            "prepend" => self.prepended.extend(items),
            "append" | "add" => self.appended.extend(items),
            "delete" => self.deleted.extend(items),
            "reorder" => {}
            _ => self.explicit = Some(items),
        }
    }

    /// Applies the edit to a list.
    pub fn apply(&self, list: &mut Vec<T>) {
        if let Some(items) = &self.explicit {
            list.clone_from(items);
        }
        list.retain(|item| !self.deleted.contains(item));
        list.retain(|item| !self.prepended.contains(item));
        list.splice(0..0, self.prepended.iter().cloned());
        list.retain(|item| !self.appended.contains(item));
        list.extend(self.appended.iter().cloned());
    }
}

/// Reference or payload, which is a prim of this or of another layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Reference {
    /// Path of the layer; empty for this layer.
    pub asset: String,
    /// Path of the prim; empty for the layer's default prim.
    pub prim: String,
    /// True if the times of the layer are moved or scaled.
    pub is_retimed: bool,
}

/// Field of a layer that is true if the times of a sublayer are moved or scaled.
pub(super) const RETIMED: &str = "durer:retimed";

/// Meaning of a prim in its layer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Specifier {
    /// Edits a prim of a weaker layer, and defines none.
    #[default]
    Over,
    Def,
    /// Template from which other prims inherit.
    Class,
}

/// Opinions of one layer about a prim, or about a variant of a prim.
#[derive(Clone, Debug, Default)]
pub(super) struct PrimSpec {
    pub specifier: Specifier,
    pub type_name: String,
    /// Names of the child prims, in order.
    pub children: Vec<String>,
    pub properties: BTreeMap<String, Property>,
    /// Fields other than those below, such as `active` and `instanceable`.
    pub metadata: BTreeMap<String, Value>,
    pub references: ListEdit<Reference>,
    pub payloads: ListEdit<Reference>,
    pub inherits: ListEdit<String>,
    pub specializes: ListEdit<String>,
    pub api_schemas: ListEdit<String>,
    pub variant_sets: ListEdit<String>,
    /// Selected variant of each variant set.
    pub selections: BTreeMap<String, String>,
    /// Names of the variants of each variant set.
    pub variants: BTreeMap<String, Vec<String>>,
    pub span: Span,
}

/// Opinions of one layer about an attribute or a relationship.
#[derive(Clone, Debug, Default)]
pub(super) struct Property {
    pub value: Option<Value>,
    /// Values at times, sorted by time.
    pub samples: Vec<(f64, Value)>,
    /// Targets of a relationship, or connections of an attribute.
    pub targets: ListEdit<String>,
    /// Fields such as `interpolation`.
    pub metadata: BTreeMap<String, Value>,
    pub span: Span,
}

/// Layer of a scene: one file.
#[derive(Debug, Default)]
pub(super) struct Layer {
    /// Name of the file, relative to the scene's folder or to the root of the package.
    pub name: String,
    /// Prims by path. A variant has a path such as `/A{color=red}`, and its children follow without
    /// a slash: `/A{color=red}B`. The pseudo-root has the path `/`.
    pub prims: BTreeMap<String, PrimSpec>,
    /// True for a binary file, of which only the samples for one time are read.
    pub is_binary: bool,
}

impl Layer {
    /// Returns a field of the layer's own metadata.
    pub fn field(&self, name: &str) -> Option<&Value> {
        self.prims.get("/").and_then(|root| root.metadata.get(name))
    }

    /// Returns the number of time codes per second.
    pub fn time_codes_per_second(&self) -> f64 {
        let rate = |name| self.field(name).and_then(Value::number).filter(|rate| *rate > 0.0);
        rate("timeCodesPerSecond").or_else(|| rate("framesPerSecond")).unwrap_or(24.0)
    }
}

/// Returns the path of a child prim.
pub(super) fn child_path(parent: &str, name: &str) -> String {
    match parent {
        "/" => format!("/{name}"),
        _ if parent.ends_with('}') => format!("{parent}{name}"),
        _ => format!("{parent}/{name}"),
    }
}

/// Returns the path of a variant of a prim.
pub(super) fn variant_path(prim: &str, set: &str, variant: &str) -> String {
    format!("{prim}{{{set}={variant}}}")
}
