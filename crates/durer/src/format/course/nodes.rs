//! The grammar of 2020 to 2023: a tree of nodes with components.

use super::fields::Order;
use super::lexer::TokenKind;
use super::reader::Reader;
use crate::camera::Camera;
use crate::describe::DescribedList;
use crate::diag::{Diagnostic, Span};
use crate::light::Light;
use crate::math::Vec3;
use crate::scene::{Group, MatrixOp, Node, Object, Spanned};
use crate::shape::{Primitive, TriangleMesh};
use glam::DAffine3;

impl Reader<'_, '_> {
    /// The whole file.
    pub(super) fn nodes_file(&mut self) {
        const SECTIONS: [&str; 4] = ["Camera", "Background", "Materials", "Scene"];
        self.scene.lights = Some(Vec::new());
        while let Some(token) = self.peek() {
            self.advance();
            let (word, span) = (self.text(token.span), token.span);
            match word.as_str() {
                "Camera" => self.camera(Camera::Perspective(Default::default()), span),
                "Background" => self.background(span),
                "Materials" => self.node_materials(span),
                "Scene" => self.root_node(span),
                _ => self.unknown(&word, span, "at the top of a scene", &SECTIONS),
            }
        }
    }

    fn node_materials(&mut self, keyword: Span) {
        let name = self.text(keyword);
        if !self.open(&name) {
            return;
        }
        while let Some((word, span)) = self.word_before_close(&name) {
            if let Some(value) = self.material(&word, span) {
                self.scene.materials.push(Spanned { value, span });
            }
        }
    }

    fn root_node(&mut self, keyword: Span) {
        let mut objects = Vec::new();
        self.node(keyword, DAffine3::IDENTITY, None, &mut objects);
        self.scene.root = Some(Group { objects });
    }

    /// One node: its transform, its components and its nodes, added to `objects` as one transformed group.
    fn node(&mut self, keyword: Span, outer: DAffine3, material: Option<u32>, objects: &mut Vec<Object>) {
        const KNOWN: [&str; 5] = ["Node", "Transform", "Component<Material>", "Component<Light>", "Component<Object>"];
        let name = self.text(keyword);
        if self.depth >= 200 {
            self.error(Diagnostic::error("nodes are nested deeper than 200").at(keyword));
            return self.skip_block();
        }
        if !self.open(&name) {
            return;
        }
        self.depth += 1;
        let mut ops: Vec<MatrixOp> = Vec::new();
        let mut material = material;
        let mut inner = Vec::new();
        // Children are read with the transform known so far; the official files write it first.
        while let Some((word, span)) = self.word_before_close(&name) {
            match word.as_str() {
                "Transform" => ops = self.node_matrices(),
                "Node" => self.node(span, outer * MatrixOp::product(&ops, false), material, &mut inner),
                "Component<Material>" => {
                    material = self.component_index(&word, span).or(material);
                }
                "Component<Light>" => self.component_light(&word, span, outer * MatrixOp::product(&ops, false)),
                "Component<Object>" => {
                    if let Some(node) = self.component_object(&word, span) {
                        inner.push(Object { node, material: None, span });
                    }
                }
                _ => self.unknown(&word, span, "in a node", &KNOWN),
            }
        }
        self.depth -= 1;
        // A material may be written after the object that it belongs to; nodes inside have their own already.
        for object in &mut inner {
            if object.material.is_none() {
                object.material = material;
            }
        }
        let node = match (inner.len(), ops.is_empty()) {
            (0, _) => return,
            (_, true) => return objects.append(&mut inner),
            (1, false) => Node::Transform(ops, Box::new(inner.remove(0))),
            (_, false) => {
                let group = Object { node: Node::Group(Group { objects: inner }), material, span: keyword };
                Node::Transform(ops, Box::new(group))
            }
        };
        objects.push(Object { node, material, span: keyword });
    }

    fn node_matrices(&mut self) -> Vec<MatrixOp> {
        const KNOWN: [&str; 7] = ["translate", "scale", "x_rotate", "y_rotate", "z_rotate", "uniform_scale", "rotate"];
        let mut ops = Vec::new();
        if !self.open("Transform") {
            return ops;
        }
        while let Some((word, span)) = self.word_before_close("Transform") {
            let op = match word.as_str() {
                "translate" => self.vec3(&word).map(MatrixOp::Translate),
                "scale" => self.vec3(&word).map(MatrixOp::Scale),
                "uniform_scale" => self.number(&word, 1, 1).map(MatrixOp::UniformScale),
                "x_rotate" => self.number(&word, 1, 1).map(MatrixOp::XRotate),
                "y_rotate" => self.number(&word, 1, 1).map(MatrixOp::YRotate),
                "z_rotate" => self.number(&word, 1, 1).map(MatrixOp::ZRotate),
                "rotate" => self.vec3(&word).and_then(|axis| Some(MatrixOp::Rotate(axis, self.number(&word, 1, 1)?))),
                _ => {
                    self.unknown(&word, span, "in a transform", &KNOWN);
                    None
                }
            };
            ops.extend(op);
        }
        ops
    }

    fn component_index(&mut self, name: &str, keyword: Span) -> Option<u32> {
        if !self.open(name) {
            return None;
        }
        let mut index = None;
        while let Some((word, span)) = self.word_before_close(name) {
            if word != "index" {
                self.unknown(&word, span, "in a material component", &["index"]);
                continue;
            }
            index = self.whole(&word);
            if let Some(index) = index {
                self.material_uses.push((index, span.to(self.last_span())));
            }
        }
        if index.is_none() && !self.diagnostics.has_errors() {
            self.error(Diagnostic::error(format!("`{name}` has no `index`")).at(keyword));
        }
        index
    }

    /// The `type` of a component, whose `{` is left to be read by its fields.
    fn component_type(&mut self, name: &str, known: &[&str]) -> Option<String> {
        // The word after `{ type` is known before any field is read: type comes first in every file.
        let at = |reader: &Self, i: usize| reader.ahead(i).map(|t| reader.text(t.span));
        let is_type = at(self, 1).as_deref() == Some("type");
        let found = at(self, 2).filter(|_| is_type);
        match found {
            Some(kind) if known.contains(&kind.as_str()) => Some(kind),
            Some(kind) => {
                self.advance();
                self.advance();
                let span = self.advance();
                self.unknown(&kind, span, &format!("as a type of `{name}`"), known);
                self.rewind_to_block();
                None
            }
            None => {
                let span = self.peek().map_or(self.end_span(), |t| t.span);
                self.error(Diagnostic::error(format!("`{name}` must begin with its `type`")).at(span));
                self.skip_block();
                None
            }
        }
    }

    /// After an unknown type: passes over the rest of the component.
    fn rewind_to_block(&mut self) {
        while let Some(token) = self.peek() {
            match token.kind {
                TokenKind::Open => self.skip_block(),
                TokenKind::Close => {
                    self.advance();
                    return;
                }
                _ => {
                    self.advance();
                }
            }
        }
    }

    fn component_light(&mut self, name: &str, keyword: Span, to_world: DAffine3) {
        let Some(kind) = self.component_type(name, &["point", "directional"]) else { return };
        let Some(mut light) = Light::from_keyword(&kind) else { return };
        if let Light::Point(point) = &mut light {
            point.position = to_world.translation.as_vec3();
        }
        self.component_fields(&mut light, keyword);
        self.scene.lights.get_or_insert_default().push(Spanned { value: light, span: keyword });
    }

    fn component_object(&mut self, name: &str, keyword: Span) -> Option<Node> {
        let kind = self.component_type(name, &["sphere", "plane", "triangle", "mesh"])?;
        if kind == "mesh" {
            let mut mesh = TriangleMesh::default();
            self.component_fields(&mut mesh, keyword);
            return Some(Node::Mesh(mesh));
        }
        let mut shape = Primitive::from_keyword(&kind)?;
        if let Primitive::Sphere(sphere) = &mut shape {
            sphere.center = Vec3::ZERO;
        }
        self.component_fields(&mut shape, keyword);
        Some(Node::Primitive(shape))
    }

    /// The fields of a component, of which `type` is passed over.
    fn component_fields<T: DescribedList>(&mut self, thing: &mut T, keyword: Span) {
        self.fields(thing, keyword, Order::Any, |reader, word, _| {
            let is_type = word == "type";
            if is_type {
                reader.advance();
            }
            is_type
        });
    }
}
