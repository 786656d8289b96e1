//! Writer of scenes in the scene language.

use durer_scene::describe::{DescribedKind, Value};
use durer_scene::dialect::Dialect;
use durer_scene::light::{Light, PointLight};
use durer_scene::math::Vec3;
use durer_scene::scene::{Group, Material, MatrixOp, Object, ObjectKind, Scene};
use durer_scene::shape::{Sphere, VoxelGrid};
use std::fmt::Write;

/// Formats a scene in the given dialect. If the dialect does not have a word, a word of another
/// year is used.
pub fn write(scene: &Scene, dialect: Dialect) -> String {
    let mut writer = Writer { out: String::new(), depth: 0, dialect, material: None };
    match dialect {
        Dialect::F23 => writer.node_scene(scene),
        _ => writer.scene(scene),
    }
    writer.out
}

/// Formats a single statement, in the way that [`write`] formats a scene.
pub(super) fn write_item<T: DescribedKind>(item: &T, dialect: Dialect) -> String {
    let mut writer = Writer { out: String::new(), depth: 0, dialect, material: None };
    writer.item(item);
    writer.out
}

/// Writer that appends the text of a scene in a single dialect.
struct Writer {
    out: String,
    depth: usize,
    dialect: Dialect,
    /// Material that is current for the objects that follow.
    material: Option<u32>,
}

impl Writer {
    fn line(&mut self, text: impl AsRef<str>) {
        let indent = "    ".repeat(self.depth);
        // Writing to a `String` cannot fail.
        let _ = writeln!(self.out, "{indent}{}", text.as_ref());
    }

    fn block(&mut self, head: &str, inside: impl FnOnce(&mut Self)) {
        self.line(format!("{head} {{"));
        self.depth += 1;
        inside(self);
        self.depth -= 1;
        self.line("}");
    }

    fn fields<T: DescribedKind>(&mut self, item: &T) {
        let plain = T::from_keyword(item.keywords()[0].0);
        // Statements that exist only in the Dürer dialect use only words of that dialect.
        let ours = item.is_durer_only();
        let dialect = if ours { Dialect::Durer } else { self.dialect };
        for (i, field) in item.fields().iter().enumerate() {
            let Some(value) = item.get(i) else { continue };
            let (word, text) = (field.keyword(dialect), value_text(&value));
            // Omit a default value if the dialect has no word for the field. Compare the values as
            // text, because text distinguishes 0 from -0.
            let plain_text = plain.as_ref().and_then(|plain| plain.get(i)).map(|value| value_text(&value));
            if word.is_none() && plain_text.as_ref() == Some(&text) {
                continue;
            }
            self.line(format!("{} {text}", word.unwrap_or(field.keywords[0].0)));
        }
    }

    fn item<T: DescribedKind>(&mut self, entry: &T) {
        self.block(entry.keyword(self.dialect), |w| w.fields(entry));
    }

    fn scene(&mut self, scene: &Scene) {
        if let Some(camera) = &scene.camera {
            self.item(camera);
        }
        self.item(&scene.background);
        if let Some(fog) = &scene.fog {
            self.item(&fog.value);
        }
        if let Some(lights) = &scene.lights {
            self.block("Lights", |w| {
                w.line(format!("numLights {}", lights.len()));
                lights.iter().for_each(|light| w.item(&light.value));
            });
        }
        let mut textures = scene.assets.textures().peekable();
        if textures.peek().is_some() {
            self.block("Textures", |w| textures.for_each(|texture| w.item(&texture)));
        }
        if !scene.materials.is_empty() {
            self.block("Materials", |w| {
                w.line(format!("numMaterials {}", scene.materials.len()));
                scene.materials.iter().for_each(|material| w.material(&material.value));
            });
        }
        if let Some(root) = &scene.root {
            self.group(root);
        }
    }

    fn material(&mut self, material: &Material) {
        match material {
            Material::Phong(phong, noise) => {
                let word = if self.dialect == Dialect::F23 { "Material" } else { "PhongMaterial" };
                self.block(word, |w| {
                    w.fields(&**phong);
                    if let Some(noise) = noise {
                        w.block("Noise", |w| w.fields(noise));
                    }
                });
            }
            Material::Principled(principled) => self.item(&**principled),
            Material::Hair(hair) => self.item(hair),
            Material::Solid(solid, transform) => self.block(solid.keyword(self.dialect), |w| {
                if !transform.is_empty() {
                    w.block("Transform", |w| transform.iter().for_each(|op| w.matrix(op)));
                }
                w.fields(solid);
            }),
        }
    }

    fn group(&mut self, group: &Group) {
        self.block("Group", |w| {
            w.line(format!("numObjects {}", group.objects.len()));
            w.objects(&group.objects);
        });
    }

    fn objects(&mut self, objects: &[Object]) {
        for object in objects {
            if let Some(index) = object.material.filter(|_| object.material != self.material) {
                self.line(format!("MaterialIndex {index}"));
                self.material = Some(index);
            }
            self.object(object);
        }
    }

    fn object(&mut self, object: &Object) {
        match &object.node {
            ObjectKind::Group(group) => self.group(group),
            ObjectKind::Transform(ops, inner) => self.block("Transform", |w| {
                ops.iter().for_each(|op| w.matrix(op));
                match inner.material == object.material {
                    true => w.object(inner),
                    // A transform cannot contain a `MaterialIndex`, but a group inside it can.
                    false => w.group(&Group { objects: vec![Object::clone(inner)] }),
                }
            }),
            ObjectKind::Primitive(shape) => self.item(shape),
            ObjectKind::Mesh(mesh) => self.item(mesh),
            ObjectKind::HeightField(field) => self.item(field),
            ObjectKind::Solid(operation, parts) => self.block(operation.keyword(), |w| w.objects(parts)),
            ObjectKind::Voxels(grid, balls) => self.block(grid.keyword(self.dialect), |w| w.voxels(grid, balls)),
        }
    }

    fn voxels(&mut self, grid: &VoxelGrid, balls: &[Sphere]) {
        self.fields(grid);
        balls.iter().for_each(|ball| self.block("rasterizeSphere", |w| w.fields(ball)));
    }

    fn matrix(&mut self, op: &MatrixOp) {
        let old = self.dialect == Dialect::F03;
        let braced = |word: &str, values: String| match old {
            true => format!("{word} {{ {values} }}"),
            false => format!("{word} {values}"),
        };
        let text = match *op {
            MatrixOp::Translate(v) => braced("Translate", vec3_text(v)),
            MatrixOp::Scale(v) => braced("Scale", vec3_text(v)),
            MatrixOp::UniformScale(s) => braced("UniformScale", s.to_string()),
            MatrixOp::XRotate(a) => braced("XRotate", a.to_string()),
            MatrixOp::YRotate(a) => braced("YRotate", a.to_string()),
            MatrixOp::ZRotate(a) => braced("ZRotate", a.to_string()),
            MatrixOp::Rotate(axis, a) => format!("Rotate {{ {} {a} }}", vec3_text(axis)),
            MatrixOp::Matrix(rows) => {
                let by_rows = matches!(self.dialect, Dialect::F03 | Dialect::F04 | Dialect::Durer);
                let listed: [f32; 16] = if by_rows { rows } else { std::array::from_fn(|i| rows[i % 4 * 4 + i / 4]) };
                let word = if by_rows { "Matrix" } else { "Matrix4f" };
                format!("{word} {{ {} }}", listed.map(|x| x.to_string()).join(" "))
            }
        };
        self.line(text);
    }

    fn node_scene(&mut self, scene: &Scene) {
        if let Some(camera) = &scene.camera {
            self.item(camera);
        }
        self.item(&scene.background);
        self.block("Materials", |w| scene.materials.iter().for_each(|m| w.material(&m.value)));
        let lights = scene.lights.as_deref().unwrap_or_default();
        if scene.root.is_some() || !lights.is_empty() {
            self.block("Scene", |w| {
                scene.root.iter().flat_map(|root| &root.objects).for_each(|object| w.node(object));
                lights.iter().for_each(|light| w.light_node(&light.value));
            });
        }
    }

    fn node(&mut self, object: &Object) {
        self.block("Node", |w| {
            if let ObjectKind::Transform(ops, _) = &object.node {
                w.block("Transform", |w| ops.iter().for_each(|op| w.node_matrix(op)));
            }
            if let Some(index) = object.material {
                w.line(format!("Component<Material> {{ index {index} }}"));
            }
            match &object.node {
                ObjectKind::Group(group) => group.objects.iter().for_each(|inner| w.node(inner)),
                ObjectKind::Primitive(shape) => w.component("Object", shape),
                ObjectKind::Mesh(mesh) => w.component("Object", mesh),
                ObjectKind::HeightField(field) => w.component("Object", field),
                ObjectKind::Solid(operation, parts) => {
                    w.block(operation.keyword(), |w| parts.iter().for_each(|part| w.node(part)));
                }
                ObjectKind::Voxels(grid, balls) => w.voxels_component(grid, balls),
                ObjectKind::Transform(_, inner) => match &inner.node {
                    _ if inner.material != object.material => w.node(inner),
                    ObjectKind::Primitive(shape) => w.component("Object", shape),
                    ObjectKind::Mesh(mesh) => w.component("Object", mesh),
                    ObjectKind::Voxels(grid, balls) => w.voxels_component(grid, balls),
                    _ => w.node(inner),
                },
            }
        });
    }

    fn light_node(&mut self, light: &Light) {
        self.block("Node", |w| {
            let Light::Point(point) = light else { return w.component("Light", light) };
            w.block("Transform", |w| w.node_matrix(&MatrixOp::Translate(point.position)));
            // The transform of the node determines the position of the light.
            w.component("Light", &Light::Point(PointLight { position: Vec3::ZERO, ..point.clone() }));
        });
    }

    fn component<T: DescribedKind>(&mut self, name: &str, item: &T) {
        self.block(&format!("Component<{name}>"), |w| {
            w.line(format!("type {}", item.keyword(w.dialect)));
            w.fields(item);
        });
    }

    fn voxels_component(&mut self, grid: &VoxelGrid, balls: &[Sphere]) {
        self.block("Component<Object>", |w| {
            w.line(format!("type {}", grid.keyword(w.dialect)));
            w.voxels(grid, balls);
        });
    }

    fn node_matrix(&mut self, op: &MatrixOp) {
        let text = match *op {
            MatrixOp::Translate(v) => format!("translate {}", vec3_text(v)),
            MatrixOp::Scale(v) => format!("scale {}", vec3_text(v)),
            MatrixOp::UniformScale(s) => format!("uniform_scale {s}"),
            MatrixOp::XRotate(a) => format!("x_rotate {a}"),
            MatrixOp::YRotate(a) => format!("y_rotate {a}"),
            MatrixOp::ZRotate(a) => format!("z_rotate {a}"),
            MatrixOp::Rotate(axis, a) => format!("rotate {} {a}", vec3_text(axis)),
            MatrixOp::Matrix(_) => return self.matrix(op),
        };
        self.line(text);
    }
}

fn value_text(value: &Value) -> String {
    match value {
        Value::Float(x) => x.to_string(),
        Value::Int(i) => i.to_string(),
        Value::Vec3(v) => vec3_text(*v),
        Value::Path(name) => name.path.clone(),
        Value::Word(word) => word.clone(),
        Value::Rows(rows) => {
            let numbers: Vec<String> = rows.iter().flatten().map(f32::to_string).collect();
            format!("{{ {} }}", numbers.join(" "))
        }
    }
}

fn vec3_text(v: Vec3) -> String {
    format!("{} {} {}", v.x, v.y, v.z)
}
