//! Conversion of a parsed JSON document into a scene.

use super::tree::{Member, Node, Value, parse};
use super::values::{Members, Reader};
use super::{MAX_DEPTH, schema};
use crate::course::{flat_matrix_error, invalid_matrix_error};
use crate::report::{Report, quoted, range_text};
use crate::shared_report::suggest;
use durer_diag::{Diagnostic, Diagnostics};
use durer_scene::camera::Camera;
use durer_scene::dialect::Dialect;
use durer_scene::light::Light;
use durer_scene::material::{
    ColorNoise, HairMaterial, Pattern, PatternMaterial, PhongMaterial, PrincipledMaterial, presets,
};
use durer_scene::math::Vec3;
use durer_scene::scene::{CsgOperation, Group, Material, MatrixOp, NamedTexture, Object, ObjectKind as What, Scene};
use durer_scene::shape::{HeightField, Primitive, Sphere, TriangleMesh, VoxelGrid};

/// A JSON document that has been parsed but not yet converted to a scene. See [`Document::scene`].
pub struct Document<'a> {
    text: &'a [u8],
    report: Report,
    root: Option<Node>,
}

impl<'a> Document<'a> {
    /// Parses the JSON text. Syntax errors are not reported until [`Document::scene`] is called.
    pub fn open(text: &'a [u8], file: u32, diagnostics: &Diagnostics) -> Self {
        let mut report = Report::new(file, diagnostics);
        let root = match text.len() < u32::MAX as usize {
            true => parse(text).map_err(|error| {
                let first = error.first.map(|first| (report.span(first), "the first one is here".to_string()));
                let diagnostic = report.error(error.at, error.message);
                (diagnostic.code, diagnostic.related) = ("syntax", first);
            }),
            false => {
                report.error(0..0, "a scene file must be smaller than 4 GiB");
                Err(())
            }
        };
        Document { text, report, root: root.ok() }
    }

    /// Returns the dialect that defines what the keywords mean, or [`Dialect::Durer`] if the file
    /// names none.
    pub fn dialect(&self) -> Dialect {
        let Some(Node { value: Value::Object(members), .. }) = &self.root else { return Dialect::Durer };
        let stated = members.iter().find(|member| member.name == "dialect").map(|member| &member.node.value);
        match stated {
            Some(Value::String(name)) => Dialect::from_name(name).unwrap_or(Dialect::Durer),
            _ => Dialect::Durer,
        }
    }

    /// Reads the scene and reports all errors; returns `None` if there are any.
    pub fn scene(self, diagnostics: &mut Diagnostics) -> Option<Scene> {
        let (text, report, kinds) = (self.text, self.report, schema::objects());
        let mut reader = Reader { text, report, material: None, uses: Vec::new(), depth: 0, object_types: &kinds };
        let scene = self.root.map(|root| reader.scene(&root)).unwrap_or_default();
        reader.report.finish(diagnostics, scene)
    }
}

impl Reader<'_> {
    fn scene(&mut self, root: &Node) -> Scene {
        let mut scene = Scene::default();
        let Some((_, mut members)) = self.typed(root, "scene", &["Scene"]) else { return scene };
        // Reference to the JSON schema, which editors use.
        members.take("$schema");
        if let Some(node) = members.take("dialect") {
            self.one_of(node, "dialect", &Dialect::ALL.map(Dialect::name));
        }
        if let Some(node) = members.take("camera") {
            scene.camera = self.choice::<Camera>(node, "camera");
            scene.camera_span = self.span(&node.head());
        }
        if let Some(node) = members.take("background") {
            scene.background = self.item(scene.background, node, "background");
            scene.background_span = self.span(&node.head());
        }
        if let Some(node) = members.take("fog") {
            scene.fog = self.spanned(node, |reader| Some(reader.item(Default::default(), node, "fog")));
        }
        if let Some(node) = members.take("lights") {
            let lights = self.items(node, "lights").iter();
            let light = |node| self.spanned(node, |reader| reader.choice::<Light>(node, "light"));
            scene.lights = Some(lights.filter_map(light).collect());
        }
        if let Some(node) = members.take("textures") {
            for node in self.items(node, "textures") {
                let texture = self.item(NamedTexture::default(), node, "texture");
                let name = texture.name.path.clone();
                if scene.assets.pictures.insert(name.clone(), texture.picture()).is_some() {
                    let message = format!("a texture {} already exists", quoted(name.as_bytes()));
                    self.error(node.head(), "repeated", message, None);
                }
            }
        }
        if let Some(node) = members.take("materials") {
            for (i, node) in self.items(node, "materials").iter().enumerate() {
                let material = self.spanned(node, |reader| reader.material(node, i as u32));
                scene.materials.extend(material);
            }
        }
        if let Some(node) = members.take("objects") {
            scene.root = Some(Group { objects: self.objects(node, "objects") });
        }
        self.finish(members);
        self.check_materials(scene.materials.len());
        scene
    }

    /// Warns about material indices that are out of range.
    fn check_materials(&mut self, count: usize) {
        for (index, at) in std::mem::take(&mut self.uses) {
            if index as usize >= count {
                let has = range_text(count, "material", "materials");
                let diagnostic =
                    self.report.warning(at, format!("material {index} does not exist: the scene has {has}"));
                diagnostic.code = "material-index";
                diagnostic.help = Some("objects that use it are drawn in plain grey".into());
            }
        }
    }

    fn material(&mut self, node: &Node, own: u32) -> Option<Material> {
        let known = schema::materials();
        let (word, mut members) = self.typed(node, "material", &known)?;
        let material = if let Some(mut solid) = schema::of_keyword::<PatternMaterial>(word) {
            let transform =
                members.take("transform").map(|node| self.matrices(node, "transform", invalid_matrix_error));
            self.fields(&mut solid, &mut members);
            if let Some(index) = solid.materials().into_iter().find(|index| *index >= own) {
                let message = format!("material {own} may use only earlier materials, not material {index}");
                self.error(node.head(), "bad-value", message, None);
            }
            Material::Solid(solid, transform.unwrap_or_default())
        } else if schema::of_keyword::<PrincipledMaterial>(word).is_some() {
            let name = members.take("preset").and_then(|node| Some((node, self.string(node, "preset")?)));
            let preset = name.and_then(|(_, name)| presets::preset(name));
            if let (Some((node, name)), None) = (name, &preset) {
                let help = suggest(name, presets::PRESETS.iter().map(|row| row.0));
                let help = help.unwrap_or("run `durer words preset` to list the presets".into());
                let message = format!("unknown preset {}", quoted(name.as_bytes()));
                self.error(node.at.clone(), "unknown-word", message, Some(help));
            }
            let mut principled = preset.unwrap_or_default();
            self.fields(&mut principled, &mut members);
            Material::Principled(Box::new(principled))
        } else if let Some(mut hair) = schema::of_keyword::<HairMaterial>(word) {
            self.fields(&mut hair, &mut members);
            Material::Hair(hair)
        } else {
            let mut phong = PhongMaterial::default();
            let noise = members.take("noise").map(|node| self.item(ColorNoise::default(), node, "noise"));
            self.fields(&mut phong, &mut members);
            Material::Phong(Box::new(phong), noise)
        };
        self.finish(members);
        Some(material)
    }

    fn matrices(&mut self, node: &Node, name: &str, wrong: fn(MatrixOp) -> Option<Diagnostic>) -> Vec<MatrixOp> {
        self.items(node, name).iter().filter_map(|node| self.matrix(node, wrong)).collect()
    }

    /// Reads a transform such as `{"Translate": [0, 1, 0]}`. `wrong` creates the error for a matrix
    /// with invalid values.
    fn matrix(&mut self, node: &Node, wrong: fn(MatrixOp) -> Option<Diagnostic>) -> Option<MatrixOp> {
        let Value::Object(members) = &node.value else {
            self.expected(node, "an object", "matrix");
            return None;
        };
        let words = MatrixOp::words();
        let [Member { name, at, node: value }] = members.as_slice() else {
            let help = Some(format!("known matrices are {}", words.join(", ")));
            self.error(node.head(), "bad-value", "a matrix must be an object with exactly one member", help);
            return None;
        };
        let Some((name, like)) = MatrixOp::KINDS.iter().find(|row| row.0 == name) else {
            let help = suggest(name, words).unwrap_or_else(|| format!("known matrices are {}", words.join(", ")));
            self.error(at.clone(), "unknown-word", format!("unknown matrix {}", quoted(name.as_bytes())), Some(help));
            return None;
        };
        let op = match like {
            MatrixOp::Translate(_) => MatrixOp::Translate(Vec3::from(self.numbers::<3>(value, name)?)),
            MatrixOp::Scale(_) => MatrixOp::Scale(Vec3::from(self.numbers::<3>(value, name)?)),
            MatrixOp::UniformScale(_) => MatrixOp::UniformScale(self.number(value, name)?),
            MatrixOp::XRotate(_) => MatrixOp::XRotate(self.number(value, name)?),
            MatrixOp::YRotate(_) => MatrixOp::YRotate(self.number(value, name)?),
            MatrixOp::ZRotate(_) => MatrixOp::ZRotate(self.number(value, name)?),
            MatrixOp::Rotate(..) => {
                let [x, y, z, angle] = self.numbers::<4>(value, name)?;
                MatrixOp::Rotate(Vec3::new(x, y, z), angle)
            }
            MatrixOp::Matrix(_) => {
                let rows = self.rows(value, name, 4)?.concat();
                let Ok(rows) = <[f32; 16]>::try_from(rows) else {
                    self.error(value.head(), "bad-value", "`Matrix` needs four rows", None);
                    return None;
                };
                MatrixOp::Matrix(rows)
            }
        };
        if let Some(error) = wrong(op).filter(|_| !self.report.is_full()) {
            self.report.add(value.head(), error);
        }
        Some(op)
    }

    fn objects(&mut self, node: &Node, name: &str) -> Vec<Object> {
        self.items(node, name).iter().filter_map(|node| self.object(node)).collect()
    }

    fn object(&mut self, node: &Node) -> Option<Object> {
        if self.depth >= MAX_DEPTH {
            self.error(node.head(), "bad-value", format!("objects are nested more than {MAX_DEPTH} levels deep"), None);
            return None;
        }
        self.depth += 1;
        let object = self.object_here(node);
        self.depth -= 1;
        object
    }

    fn object_here(&mut self, node: &Node) -> Option<Object> {
        let (word, mut members) = self.typed(node, "object", self.object_types)?;
        let stated = members.take("material");
        if let Some(node) = stated {
            let index = self.integer(node, "material");
            self.uses.extend(index.map(|index| (index, node.at.clone())));
            self.material = index.or(self.material);
        }
        let mut material = self.material;
        let what = if let Some(operation) = CsgOperation::from_keyword(word) {
            What::Solid(operation, self.inside(&mut members))
        } else if let Some(mut shape) = schema::of_keyword::<Primitive>(word) {
            self.fields(&mut shape, &mut members);
            What::Primitive(shape)
        } else if word == "Group" {
            What::Group(Group { objects: self.inside(&mut members) })
        } else if word == "Transform" {
            let wrong = |op| invalid_matrix_error(op).or_else(|| flat_matrix_error(op));
            let ops = members.take("matrices").map(|node| self.matrices(node, "matrices", wrong)).unwrap_or_default();
            let inner = self.required(&mut members, "object").and_then(|node| self.object(node));
            // The object inside a transform may specify its own material.
            if let (None, Some(inner)) = (stated, &inner) {
                material = inner.material;
            }
            What::Transform(ops, Box::new(inner?))
        } else if let Some(mut mesh) = schema::of_keyword::<TriangleMesh>(word) {
            self.fields(&mut mesh, &mut members);
            What::Mesh(mesh)
        } else if let Some(mut field) = schema::of_keyword::<HeightField>(word) {
            self.fields(&mut field, &mut members);
            What::HeightField(field)
        } else {
            let mut grid = VoxelGrid::default();
            self.fields(&mut grid, &mut members);
            let balls = members.take("balls").map_or(&[][..], |node| self.items(node, "balls"));
            What::Voxels(grid, balls.iter().map(|node| self.item(Sphere::default(), node, "ball")).collect())
        };
        self.finish(members);
        Some(Object { node: what, material, span: self.span(&node.head()) })
    }

    /// Reads the member `objects` of the scene.
    fn inside(&mut self, members: &mut Members) -> Vec<Object> {
        let node = self.required(members, "objects");
        node.map(|node| self.objects(node, "objects")).unwrap_or_default()
    }
}
