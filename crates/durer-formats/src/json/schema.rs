//! JSON Schema (version 2020-12) of JSON scenes. The schema is generated from the descriptions of
//! the statements, as the language reference is.

use super::MAX_DEPTH;
use durer_scene::camera::Camera;
use durer_scene::describe::{Constraint, DescribedKind, Field, FieldKind};
use durer_scene::dialect::Dialect;
use durer_scene::light::Light;
use durer_scene::material::{ColorNoise, HairMaterial, PatternMaterial, PhongMaterial, PrincipledMaterial, presets};
use durer_scene::medium::Fog;
use durer_scene::scene::{Background, CsgOperation, MatrixOp, NamedTexture};
use durer_scene::shape::{HeightField, Primitive, Sphere, TriangleMesh, VoxelGrid};
use serde_json::{Map, Value, json};

/// Returns the keywords of all kinds of items in a described list.
pub(super) fn keywords<T: DescribedKind>() -> Vec<&'static str> {
    T::kinds().iter().map(word).collect()
}

/// Returns the keyword that a described item has in the Dürer dialect.
pub(super) fn word<T: DescribedKind>(item: &T) -> &'static str {
    item.keyword(Dialect::Durer)
}

/// Returns the item that a keyword stands for, with default values.
pub(super) fn of_keyword<T: DescribedKind>(keyword: &str) -> Option<T> {
    T::kinds().into_iter().find(|item| word(item) == keyword)
}

/// Returns the keywords of all materials.
pub(super) fn materials() -> Vec<&'static str> {
    let own = [keywords::<PhongMaterial>(), keywords::<PrincipledMaterial>(), keywords::<HairMaterial>()].concat();
    [own, keywords::<PatternMaterial>()].concat()
}

/// Returns the keywords of all objects.
pub(super) fn objects() -> Vec<&'static str> {
    let others = [keywords::<TriangleMesh>(), keywords::<HeightField>(), keywords::<VoxelGrid>()].concat();
    let made = ["Group", "Transform"].into_iter().chain(CsgOperation::ALL.map(|row| row.0));
    keywords::<Primitive>().into_iter().chain(others).chain(made).collect()
}

/// Returns the JSON Schema of an entire scene.
pub fn schema() -> Value {
    let list = |of: &str, about: &str| json!({"type": "array", "items": reference(of), "description": about});
    let members = json!({
        "type": {"const": "Scene"},
        "$schema": {"type": "string", "description": "Location of this schema, for editors."},
        "dialect": {
            "enum": Dialect::ALL.map(Dialect::name),
            "description": "Dialect that defines the meaning of the words; the default is `durer`. See `durer dialects`.",
        },
        "camera": reference("camera"),
        "background": record::<Background>(json!({})),
        "fog": record::<Fog>(json!({})),
        "lights": list("light", "The lights. If missing, the ambient light is 1 1 1."),
        "textures": {
            "type": "array",
            "items": record::<NamedTexture>(json!({})),
            "description": "Named pictures, which materials can use in place of a file.",
        },
        "materials": list("material", "The materials, numbered from 0."),
        "objects": list("object", "The objects."),
    });
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Dürer scene",
        "description": format!(
            "The content of the scene language as JSON. Written by `cargo xtask manual`. Beyond this schema, patterns use \
             earlier materials only, and objects are nested at most {MAX_DEPTH} levels deep."
        ),
        "type": "object",
        "properties": members,
        "required": ["type"],
        "additionalProperties": false,
        "$defs": {
            "number": {"type": "number", "minimum": number(f32::MIN), "maximum": number(f32::MAX)},
            "vector": {"type": "array", "items": reference("number"), "minItems": 3, "maxItems": 3},
            "path": {
                "type": "string",
                "pattern": r"^[^\s{}\u0000]+$",
                "description": "A file, relative to the scene's folder.",
            },
            "camera": one_of(items::<Camera>()),
            "light": one_of(items::<Light>()),
            "material": one_of(material_items()),
            "matrix": one_of(MatrixOp::KINDS.map(|(name, op)| matrix(name, op)).to_vec()),
            "object": one_of(object_items()),
        },
    })
}

fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{name}") })
}

fn one_of(items: Vec<Value>) -> Value {
    json!({ "oneOf": items })
}

/// Converts an `f32` to the JSON number with the fewest digits that still reads back as the same
/// value.
fn number(x: f32) -> Value {
    x.to_string().parse::<f64>().map_or(Value::Null, Value::from)
}

/// Joins the lines of a doc comment into one line.
fn about(doc: &str) -> String {
    doc.lines().map(str::trim).collect::<Vec<_>>().join(" ").trim().to_string()
}

/// Returns the schema of a field's value.
fn field(field: &Field) -> Value {
    let mut value = match field.kind {
        FieldKind::Float => json!({"type": "number"}),
        FieldKind::Int => json!({"type": "integer", "minimum": 0, "maximum": u32::MAX}),
        FieldKind::Vec3 => reference("vector"),
        FieldKind::Path => reference("path"),
        FieldKind::Word(words) => json!({ "enum": words }),
        FieldKind::Rows(width) => json!({
            "type": "array",
            "items": {"type": "array", "items": reference("number"), "minItems": width, "maxItems": width},
        }),
    };
    match field.constraint {
        Constraint::Any if field.kind == FieldKind::Float => value = reference("number"),
        Constraint::Any => {}
        Constraint::Positive => (value["exclusiveMinimum"], value["maximum"]) = (json!(0), number(f32::MAX)),
        Constraint::NonNegative => (value["minimum"], value["maximum"]) = (json!(0), number(f32::MAX)),
        Constraint::NonZero => value["not"] = json!({"const": [0, 0, 0]}),
        Constraint::Between(low, high) => {
            (value["exclusiveMinimum"], value["exclusiveMaximum"]) = (number(low), number(high));
        }
        Constraint::Within(low, high) => (value["minimum"], value["maximum"]) = (number(low), number(high)),
        Constraint::UpTo(high) => (value["exclusiveMinimum"], value["maximum"]) = (json!(0), number(high)),
        Constraint::UnitInterval => (value["minimum"], value["maximum"]) = (json!(0), json!(1)),
        Constraint::AtMost(most) => value["maximum"] = json!(most),
        Constraint::OneTo(last) => (value["minimum"], value["maximum"]) = (json!(1), json!(last)),
        Constraint::Rows(least, most) => (value["minItems"], value["maxItems"]) = (json!(least), json!(most)),
        Constraint::Counts(most) => value["items"] = json!({"type": "integer", "minimum": 1, "maximum": most}),
    }
    value["description"] = about(field.doc).into();
    value
}

/// Returns the schema of an object with these members, of which those in `required` must be
/// present.
fn object(doc: &str, members: Value, required: &[&str]) -> Value {
    json!({
        "type": "object",
        "description": about(doc),
        "properties": members,
        "required": required,
        "additionalProperties": false,
    })
}

/// Returns the schema of a described item that has additional members.
fn described<T: DescribedKind>(item: &T, more: Value, also: &[&'static str]) -> Value {
    let mut members = Map::new();
    if let Value::Object(more) = more {
        members.extend(more);
    }
    members.extend(item.fields().iter().map(|f| (f.name.to_string(), field(f))));
    let fields = item.fields().iter().filter(|field| field.required).map(|field| field.name);
    let required: Vec<&str> = also.iter().copied().chain(fields).collect();
    object(item.doc(), members.into(), &required)
}

/// Returns the schema of an item that has no `type` member.
fn record<T: DescribedKind + Default>(more: Value) -> Value {
    described(&T::default(), more, &[])
}

/// Returns the schema of an item that has a `type` member.
fn named<T: DescribedKind>(item: &T, more: &Value) -> Value {
    described(item, with(more, "type", json!({ "const": word(item) })), &["type"])
}

/// Returns a copy of `members` with one more member added.
///
/// This code is a function because equivalent closures, which changed a `Value` passed to them and
/// returned it, used memory after it was freed (rustc 1.95, opt-level 2, detected by valgrind; a
/// small program of the same form did not show the problem). The code was safe Rust, so this was
/// probably a miscompilation.
fn with(members: &Value, name: &str, value: Value) -> Value {
    let mut all = members.clone();
    all[name] = value;
    all
}

fn items<T: DescribedKind>() -> Vec<Value> {
    T::kinds().iter().map(|item| named(item, &json!({}))).collect()
}

fn material_items() -> Vec<Value> {
    let noise = json!({ "noise": record::<ColorNoise>(json!({})) });
    let presets: Vec<&str> = presets::PRESETS.iter().map(|row| row.0).collect();
    let preset =
        json!({"preset": {"enum": presets, "description": "A real material by name; the other members change it."}});
    let transform = json!({"transform": matrices("From world to pattern space: the product of these matrices.")});
    let mut all = vec![named(&PhongMaterial::default(), &noise), named(&PrincipledMaterial::default(), &preset)];
    all.extend(items::<HairMaterial>());
    all.extend(PatternMaterial::kinds().iter().map(|solid| named(solid, &transform)));
    all
}

fn matrices(about: &str) -> Value {
    json!({"type": "array", "items": reference("matrix"), "description": about})
}

fn matrix(name: &str, op: MatrixOp) -> Value {
    let rows =
        |count: usize, items: Value| json!({"type": "array", "items": items, "minItems": count, "maxItems": count});
    let (value, about) = match op {
        MatrixOp::Translate(_) => (reference("vector"), "Translates."),
        MatrixOp::Scale(_) => (reference("vector"), "Scales along the axes."),
        MatrixOp::UniformScale(_) => (reference("number"), "Scales equally along all axes."),
        MatrixOp::XRotate(_) => (reference("number"), "Rotates about x, in degrees."),
        MatrixOp::YRotate(_) => (reference("number"), "Rotates about y, in degrees."),
        MatrixOp::ZRotate(_) => (reference("number"), "Rotates about z, in degrees."),
        MatrixOp::Rotate(..) => {
            (rows(4, reference("number")), "Rotates about the axis x, y, z by the fourth number, in degrees.")
        }
        MatrixOp::Matrix(_) => {
            (rows(4, rows(4, reference("number"))), "Rows of an affine matrix; the last is 0, 0, 0, 1.")
        }
    };
    object(about, json!({ name: value }), &[name])
}

fn object_items() -> Vec<Value> {
    let material = json!({
        "type": "integer",
        "minimum": 0,
        "maximum": u32::MAX,
        "description": "Index of its material; the default is that of the previous object.",
    });
    let of_material = json!({ "material": &material });
    let inside = json!({"type": "array", "items": reference("object")});
    let made = |word: &str, about: &str, more: &Value, required: &[&str]| {
        let more = with(&with(more, "type", json!({ "const": word })), "material", material.clone());
        object(about, more, required)
    };
    let balls = json!({"balls": {"type": "array", "items": record::<Sphere>(json!({}))}});
    let mut all: Vec<Value> = Primitive::kinds().iter().map(|shape| named(shape, &of_material)).collect();
    all.push(named(&TriangleMesh::default(), &of_material));
    all.push(named(&HeightField::default(), &of_material));
    all.push(named(&VoxelGrid::default(), &with(&balls, "material", material.clone())));
    all.push(made("Group", "Several objects.", &json!({"objects": inside}), &["type", "objects"]));
    let moved = json!({"matrices": matrices("Their product transforms the object; the first is applied last."), "object": reference("object")});
    all.push(made("Transform", "A transformed object.", &moved, &["type", "object"]));
    all.extend(
        CsgOperation::ALL
            .map(|(word, operation)| made(word, operation.doc(), &json!({"objects": inside}), &["type", "objects"])),
    );
    all
}
