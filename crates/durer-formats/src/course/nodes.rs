//! Reads the grammar of 2020 to 2023, in which a scene is a tree of nodes with components.

use super::fields::Order;
use super::reader::Reader;
use super::words::camera_of;
use crate::report::quoted;
use durer_diag::{Diagnostic, Span, did_you_mean};
use durer_scene::camera::Camera;
use durer_scene::describe::DescribedKind;
use durer_scene::dialect::{Dialect, Quirk, set};
use durer_scene::light::Light;
use durer_scene::math::Vec3;
use durer_scene::scene::{CsgOperation, Group, MatrixOp, MatrixRules, Object, ObjectKind, Spanned};
use durer_scene::shape::{HeightField, Primitive, TriangleMesh};
use glam::DVec3;

impl Reader<'_, '_> {
    /// Reads the whole file.
    pub(super) fn nodes_file(&mut self) {
        self.scene.lights = Some(Vec::new());
        self.top(&["Camera", "Background", "Materials", "Scene"], |reader, word, span| {
            match word {
                "Camera" => reader.camera(Camera::Perspective(Default::default()), span),
                "Background" => reader.background(span),
                "Materials" => reader.node_materials(span),
                "Scene" => reader.root_node(span),
                _ => match camera_of(word).filter(|camera| !matches!(camera, Camera::Perspective(_))) {
                    Some(camera) => reader.camera(camera, span),
                    None => return false,
                },
            }
            true
        });
    }

    fn node_materials(&mut self, keyword: Span) {
        self.scene.materials.clear();
        if !self.open(keyword) {
            return;
        }
        while let Some((word, span)) = self.word_before_close() {
            if let Some(value) = self.material(&word, span) {
                self.scene.materials.push(Spanned { value, span });
            }
        }
    }

    /// Returns the rules for matrix products that follow from the quirks.
    fn matrix_rules(&self) -> MatrixRules {
        let has = |compat: Quirk| self.options.compat & compat.bit() != 0;
        MatrixRules {
            matrix_on_left: has(Quirk::MatrixOnLeft),
            drop_shear: has(Quirk::DroppedShear),
            ignore_tiny: has(Quirk::TinyTransforms),
        }
    }

    fn root_node(&mut self, keyword: Span) {
        let mut inside = self.node(keyword);
        let to_world = MatrixOp::product(inside.ops.as_deref().unwrap_or_default(), self.matrix_rules());
        let lights = std::mem::take(&mut inside.lights).into_iter().map(|(mut light, position)| {
            if let Light::Point(point) = &mut light.value {
                point.position = to_world.transform_point3(position).as_vec3();
            }
            light
        });
        self.scene.lights = Some(lights.collect());
        self.scene.root = match inside.ops {
            None => Some(Group { objects: inside.objects }),
            Some(_) => Some(Group { objects: inside.object(keyword).into_iter().collect() }),
        };
    }

    /// Reads one node: its transform, components and child nodes, in any order.
    fn node(&mut self, keyword: Span) -> NodeContent {
        const KEYWORDS: [&str; 5] =
            ["Node", "Transform", "Component<Material>", "Component<Light>", "Component<Object>"];
        let mut inside = NodeContent::default();
        if !self.descend("nodes", keyword) || !self.open(keyword) {
            return inside;
        }
        let (mut material_span, mut transform_span) = (None, None);
        while let Some((word, span)) = self.word_before_close() {
            match word.as_str() {
                "Transform" => {
                    if let Some(first) = transform_span.replace(span) {
                        let warning =
                            Diagnostic::warning("a node can have only one transform; the last one is used").at(span);
                        let warning = warning.related(first, "the first transform is here");
                        self.diagnostics.push(warning.help("use nested nodes to combine several transforms"));
                    }
                    inside.ops = Some(self.node_matrices(span));
                }
                "Node" => {
                    let child = self.node(span);
                    inside.has_nodes = true;
                    let to_outer = MatrixOp::product(child.ops.as_deref().unwrap_or_default(), self.matrix_rules());
                    let lights = child.lights.iter().map(|(light, p)| (light.clone(), to_outer.transform_point3(*p)));
                    inside.lights.extend(lights);
                    inside.objects.extend(child.object(span));
                }
                "Component<Material>" => {
                    if let Some(first) = material_span.replace(span) {
                        let warning =
                            Diagnostic::warning("a node can have only one material; the last one is used").at(span);
                        self.diagnostics.push(warning.related(first, "the first material is here"));
                    }
                    inside.material = self.component_index(span).or(inside.material);
                }
                "Component<Light>" => inside.lights.extend(self.component_light(span)),
                "Component<Object>" => {
                    let node = self.component_object(span);
                    inside.objects.extend(node.map(|node| Object { node, material: None, span }));
                }
                _ => match CsgOperation::from_keyword(&word) {
                    Some(operation) => {
                        self.report_foreign_word(&word, span, set::DURER);
                        let node = ObjectKind::Solid(operation, self.node_parts(span));
                        inside.objects.push(Object { node, material: None, span });
                    }
                    None => self.unknown(&word, span, "in a node", &KEYWORDS),
                },
            }
        }
        self.depth -= 1;
        if let Some(material) = inside.material {
            inside.objects.iter_mut().for_each(|object| set_material(object, material));
        }
        inside
    }

    /// Reads the parts of a solid that is built with Boolean operations. Each part is a node that
    /// has no lights.
    fn node_parts(&mut self, keyword: Span) -> Vec<Object> {
        let mut parts = Vec::new();
        if !self.open(keyword) {
            return parts;
        }
        while let Some((word, span)) = self.word_before_close() {
            match word.as_str() {
                "Node" => {
                    let part = self.node(span);
                    if let Some((light, _)) = part.lights.first() {
                        self.error(Diagnostic::error("a light cannot be part of a solid").at(light.span));
                    }
                    parts.extend(part.object(span));
                }
                _ => self.unknown(&word, span, "in a solid", &["Node"]),
            }
        }
        parts
    }

    fn node_matrices(&mut self, keyword: Span) -> Vec<MatrixOp> {
        const KEYWORDS: [&str; 7] =
            ["translate", "scale", "x_rotate", "y_rotate", "z_rotate", "uniform_scale", "rotate"];
        let mut ops = Vec::new();
        if !self.open(keyword) {
            return ops;
        }
        while let Some((word, span)) = self.word_before_close() {
            let op = match word.as_str() {
                "translate" => self.vec3(&word).map(MatrixOp::Translate),
                "scale" => self.vec3(&word).map(MatrixOp::Scale),
                "uniform_scale" => self.number(&word, 1, 1).map(MatrixOp::UniformScale),
                "x_rotate" => self.number(&word, 1, 1).map(MatrixOp::XRotate),
                "y_rotate" => self.number(&word, 1, 1).map(MatrixOp::YRotate),
                "z_rotate" => self.number(&word, 1, 1).map(MatrixOp::ZRotate),
                "rotate" => self.vec3(&word).and_then(|axis| Some(MatrixOp::Rotate(axis, self.number(&word, 1, 1)?))),
                // For operations that nodes do not have, the syntax of earlier years is used.
                "Matrix4f" => self.matrix(&word, span).flatten(),
                _ => {
                    self.unknown(&word, span, "in a transform", &KEYWORDS);
                    continue;
                }
            };
            if op.is_none() {
                self.skip_values();
            }
            self.check_flat(op, span);
            ops.extend(op);
        }
        ops
    }

    fn component_index(&mut self, keyword: Span) -> Option<u32> {
        let errors = self.errors();
        if !self.open(keyword) {
            return None;
        }
        let mut index = None;
        while let Some((word, span)) = self.word_before_close() {
            if word != "index" {
                self.unknown(&word, span, "in a material component", &["index"]);
                continue;
            }
            index = self.integer(&word);
            match index {
                Some(index) => self.material_uses.push((index, span.join(self.last_span()))),
                None => self.skip_values(),
            }
        }
        if index.is_none() && self.errors() == errors {
            let message = format!("`{}` has no `index`", self.text(keyword));
            self.error(Diagnostic::error(message).at(keyword));
        }
        index
    }

    /// Reads the `type` of a component, which must be one of the names in `known` or `ours`. The
    /// `{` is not consumed, so that the reader of the fields finds it.
    fn component_type(&mut self, keyword: Span, known: &[&str], ours: &[&str]) -> Option<String> {
        // Look for `{ type` and a word before any field is read, because `type` comes first in
        // every file.
        let name = self.text(keyword);
        let at = |reader: &Self, i: usize| reader.ahead(i).map(|t| (reader.text(t.span), t.span));
        let first = at(self, usize::from(self.at_open()));
        let Some((_, first_span)) = first.filter(|(word, _)| word == "type") else {
            let span = at(self, 1).map_or(keyword, |(_, span)| span);
            let error = Diagnostic::error(format!("`{name}` must begin with its `type`")).at(span);
            self.error(error.help(format!("known types are {}", known.join(", "))));
            if self.at_open() {
                self.skip_block();
            }
            return None;
        };
        let (kind, span) = at(self, 1 + usize::from(self.at_open())).unwrap_or((String::new(), first_span));
        if known.contains(&kind.as_str()) || ours.contains(&kind.as_str()) {
            return Some(kind);
        }
        let error = Diagnostic::error(format!("`{name}` has no type {}", quoted(kind.as_bytes()))).at(span);
        let list = format!("known types are {}", known.join(", "));
        self.error(
            error.help(
                did_you_mean(&kind, known.iter().copied()).map_or(list, |near| format!("did you mean `{near}`?")),
            ),
        );
        if self.at_open() {
            self.skip_block();
        }
        None
    }

    /// Reads a light in the coordinate system of its node, and returns it with its position in
    /// double precision.
    fn component_light(&mut self, keyword: Span) -> Option<(Spanned<Light>, DVec3)> {
        let kind = self.component_type(keyword, &["point", "directional"], &[])?;
        let mut light = Light::from_keyword(&kind)?;
        if let Light::Point(point) = &mut light {
            point.position = Vec3::ZERO;
        }
        self.component_fields(&mut light, keyword);
        let position = if let Light::Point(point) = &light { point.position.as_dvec3() } else { DVec3::ZERO };
        Some((Spanned { value: light, span: keyword }, position))
    }

    fn component_object(&mut self, keyword: Span) -> Option<ObjectKind> {
        // For shapes that nodes do not have, the names of the Dürer dialect are used.
        let own = Primitive::kinds().into_iter().map(|shape| shape.keyword(Dialect::F23));
        let own: Vec<&str> = own.filter(|word| word.starts_with(char::is_uppercase)).chain(["HeightField"]).collect();
        let kind = self.component_type(keyword, &["sphere", "plane", "triangle", "mesh", "Grid"], &own)?;
        if kind == "Grid" {
            return Some(self.voxels(keyword));
        }
        if kind == "HeightField" {
            let mut field = HeightField::default();
            self.component_fields(&mut field, keyword);
            return Some(ObjectKind::HeightField(field));
        }
        if kind == "mesh" {
            let mut mesh = TriangleMesh::default();
            self.component_fields(&mut mesh, keyword);
            return Some(ObjectKind::Mesh(mesh));
        }
        let mut shape = Primitive::from_keyword(&kind)?;
        if let Primitive::Sphere(sphere) = &mut shape {
            sphere.center = Vec3::ZERO;
        }
        self.component_fields(&mut shape, keyword);
        Some(ObjectKind::Primitive(shape))
    }

    /// Reads the fields of a component other than `type`.
    fn component_fields<T: DescribedKind>(&mut self, item: &mut T, keyword: Span) {
        self.fields(item, keyword, Order::Any, |reader, word, _| {
            let is_type = word == "type";
            if is_type {
                reader.advance();
            }
            is_type
        });
    }
}

/// Contents of a node in the grammar of 2020 to 2023: its transform, material, objects and lights.
#[derive(Default)]
struct NodeContent {
    /// Matrices of the node, or `None` if it has no `Transform`.
    ops: Option<Vec<MatrixOp>>,
    material: Option<u32>,
    objects: Vec<Object>,
    /// Lights of the node and of its descendants, with their positions in the coordinate system of
    /// the node.
    lights: Vec<(Spanned<Light>, DVec3)>,
    has_nodes: bool,
}

impl NodeContent {
    /// Converts the node to one object, or to `None` if it contains only lights.
    fn object(self, span: Span) -> Option<Object> {
        let NodeContent { ops, material, mut objects, lights, has_nodes } = self;
        if objects.is_empty() && !lights.is_empty() {
            return None;
        }
        let alone = objects.len() == 1 && (ops.is_some() || !has_nodes);
        let inner = match alone.then(|| objects.pop()).flatten() {
            Some(object) => object,
            None => Object { node: ObjectKind::Group(Group { objects }), material, span },
        };
        Some(match ops {
            Some(ops) => Object { node: ObjectKind::Transform(ops, Box::new(inner)), material, span },
            None => inner,
        })
    }
}

/// Sets the material of an object and of its parts if they do not have one.
pub(super) fn set_material(object: &mut Object, material: u32) {
    object.material.get_or_insert(material);
    match &mut object.node {
        ObjectKind::Group(group) => group.objects.iter_mut().for_each(|object| set_material(object, material)),
        ObjectKind::Transform(_, inner) => set_material(inner, material),
        ObjectKind::Solid(_, parts) => parts.iter_mut().for_each(|part| set_material(part, material)),
        ObjectKind::Primitive(_) | ObjectKind::Mesh(_) | ObjectKind::HeightField(_) | ObjectKind::Voxels(..) => {}
    }
}
