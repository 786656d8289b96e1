//! Writer that formats scenes as JSON text.

use super::schema::word;
use durer_scene::describe::{DescribedKind, Value};
use durer_scene::dialect::Dialect;
use durer_scene::math::Vec3;
use durer_scene::scene::{Material, MatrixOp, Object, ObjectKind, Scene};

/// Maximum width of a line in columns; only a line whose value cannot be split may be longer.
const WIDTH: usize = 120;

/// JSON value to be written: text that is already formatted, or a list or object of such values.
enum Json {
    /// A number or a string that is already formatted as JSON.
    Plain(String),
    List(Vec<Json>),
    Object(Vec<(&'static str, Json)>),
}

/// Formats a scene as JSON text; `dialect` defines the meaning of the scene's keywords.
pub fn write(scene: &Scene, dialect: Dialect) -> String {
    let mut members = vec![("type", string("Scene"))];
    if dialect != Dialect::Durer {
        members.push(("dialect", string(dialect.name())));
    }
    members.extend(scene.camera.as_ref().map(|camera| ("camera", item(camera))));
    members.push(("background", Json::Object(fields(&scene.background))));
    members.extend(scene.fog.as_ref().map(|fog| ("fog", Json::Object(fields(&fog.value)))));
    let lights = |lights: &Vec<_>| {
        Json::List(lights.iter().map(|light: &durer_scene::scene::Spanned<_>| item(&light.value)).collect())
    };
    members.extend(scene.lights.as_ref().map(|list| ("lights", lights(list))));
    let textures: Vec<Json> = scene.assets.textures().map(|texture| Json::Object(fields(&texture))).collect();
    if !textures.is_empty() {
        members.push(("textures", Json::List(textures)));
    }
    if !scene.materials.is_empty() {
        members.push(("materials", Json::List(scene.materials.iter().map(|m| material(&m.value)).collect())));
    }
    members.extend(scene.root.as_ref().map(|root| ("objects", objects(&root.objects))));
    let mut out = String::new();
    Json::Object(members).write(&mut out, 0);
    out.push('\n');
    out
}

fn string(text: &str) -> Json {
    // Serializing a string never fails.
    Json::Plain(serde_json::to_string(text).unwrap_or_default())
}

fn number(x: f32) -> Json {
    Json::Plain(x.to_string())
}

fn numbers(list: &[f32]) -> Json {
    Json::List(list.iter().copied().map(number).collect())
}

fn vector(v: Vec3) -> Json {
    numbers(&v.to_array())
}

/// JSON members for those fields that have values.
fn fields<T: DescribedKind>(item: &T) -> Vec<(&'static str, Json)> {
    let value = |value: Value| match value {
        Value::Float(x) => number(x),
        Value::Int(i) => Json::Plain(i.to_string()),
        Value::Vec3(v) => vector(v),
        Value::Path(file) => string(&file.path),
        Value::Word(word) => string(&word),
        Value::Rows(rows) => Json::List(rows.iter().map(|row| numbers(row)).collect()),
    };
    item.fields().iter().enumerate().filter_map(|(i, f)| Some((f.name, value(item.get(i)?)))).collect()
}

fn typed(word: &str, more: Vec<(&'static str, Json)>) -> Vec<(&'static str, Json)> {
    [("type", string(word))].into_iter().chain(more).collect()
}

fn item<T: DescribedKind>(entry: &T) -> Json {
    Json::Object(typed(word(entry), fields(entry)))
}

fn material(material: &Material) -> Json {
    Json::Object(match material {
        Material::Phong(phong, noise) => {
            let noise = noise.as_ref().map(|noise| ("noise", Json::Object(fields(noise))));
            typed(word(&**phong), fields(&**phong).into_iter().chain(noise).collect())
        }
        Material::Principled(principled) => typed(word(&**principled), fields(&**principled)),
        Material::Hair(hair) => typed(word(hair), fields(hair)),
        Material::Solid(solid, transform) => {
            let transform = (!transform.is_empty()).then(|| ("transform", matrices(transform)));
            typed(word(solid), transform.into_iter().chain(fields(solid)).collect())
        }
    })
}

fn matrices(ops: &[MatrixOp]) -> Json {
    let matrix = |op: &MatrixOp| {
        Json::Object(vec![match *op {
            MatrixOp::Translate(v) => ("Translate", vector(v)),
            MatrixOp::Scale(v) => ("Scale", vector(v)),
            MatrixOp::UniformScale(s) => ("UniformScale", number(s)),
            MatrixOp::XRotate(a) => ("XRotate", number(a)),
            MatrixOp::YRotate(a) => ("YRotate", number(a)),
            MatrixOp::ZRotate(a) => ("ZRotate", number(a)),
            MatrixOp::Rotate(axis, a) => ("Rotate", numbers(&[axis.x, axis.y, axis.z, a])),
            MatrixOp::Matrix(rows) => ("Matrix", Json::List(rows.chunks_exact(4).map(numbers).collect())),
        }])
    };
    Json::List(ops.iter().map(matrix).collect())
}

fn objects(list: &[Object]) -> Json {
    Json::List(list.iter().map(object).collect())
}

fn object(object: &Object) -> Json {
    let (word, mut members) = match &object.node {
        ObjectKind::Group(group) => ("Group", vec![("objects", objects(&group.objects))]),
        ObjectKind::Solid(operation, parts) => (operation.keyword(), vec![("objects", objects(parts))]),
        ObjectKind::Transform(ops, inner) => {
            ("Transform", vec![("matrices", matrices(ops)), ("object", self::object(inner))])
        }
        ObjectKind::Primitive(shape) => (word(shape), fields(shape)),
        ObjectKind::Mesh(mesh) => (word(mesh), fields(mesh)),
        ObjectKind::HeightField(field) => (word(field), fields(field)),
        ObjectKind::Voxels(grid, balls) => {
            let balls = balls.iter().map(|ball| Json::Object(fields(ball))).collect();
            (word(grid), fields(grid).into_iter().chain([("balls", Json::List(balls))]).collect())
        }
    };
    if let Some(index) = object.material {
        members.insert(0, ("material", Json::Plain(index.to_string())));
    }
    Json::Object(typed(word, members))
}

impl Json {
    /// Writes the value on one line if it fits, and otherwise writes one item per line.
    fn write(&self, out: &mut String, depth: usize) {
        let mut line = String::new();
        if self.fits(&mut line, WIDTH.saturating_sub(4 * depth)) {
            out.push_str(&line);
            return;
        }
        let indent = |out: &mut String, depth: usize| out.push_str(&"    ".repeat(depth));
        match self {
            Json::Plain(text) => out.push_str(text),
            Json::List(items) => {
                out.push_str("[\n");
                for (i, item) in items.iter().enumerate() {
                    indent(out, depth + 1);
                    item.write(out, depth + 1);
                    out.push_str(if i + 1 < items.len() { ",\n" } else { "\n" });
                }
                indent(out, depth);
                out.push(']');
            }
            Json::Object(members) => {
                out.push_str("{\n");
                for (i, (name, value)) in members.iter().enumerate() {
                    indent(out, depth + 1);
                    out.push_str(&format!("\"{name}\": "));
                    value.write(out, depth + 1);
                    out.push_str(if i + 1 < members.len() { ",\n" } else { "\n" });
                }
                indent(out, depth);
                out.push('}');
            }
        }
    }

    /// Appends the value on one line; returns false if it is longer than `width` bytes.
    fn fits(&self, line: &mut String, width: usize) -> bool {
        match self {
            Json::Plain(text) => line.push_str(text),
            Json::List(items) => {
                line.push('[');
                for (i, item) in items.iter().enumerate() {
                    line.push_str(if i > 0 { ", " } else { "" });
                    if !item.fits(line, width) {
                        return false;
                    }
                }
                line.push(']');
            }
            Json::Object(members) => {
                line.push('{');
                for (i, (name, value)) in members.iter().enumerate() {
                    line.push_str(&format!("{}\"{name}\": ", if i > 0 { ", " } else { "" }));
                    if !value.fits(line, width) {
                        return false;
                    }
                }
                line.push('}');
            }
        }
        line.len() <= width
    }
}
