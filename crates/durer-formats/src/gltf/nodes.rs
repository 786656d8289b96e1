//! Reads the node hierarchy: the transform of each node and the objects that it contains.

use super::Model;
use super::deform::Skin;
use super::flat::{flattened, flattens_to_plane};
use super::json::JsonRef;
use crate::report::quoted;
use durer_diag::{Diagnostic, Span};
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::{Affine, Vec3};
use durer_scene::scene::{Material, MatrixOp, Object, ObjectKind, Scene, Spanned};
use durer_scene::shape::MeshData;
use glam::{DAffine3, DMat4, DQuat, DVec3};
use std::sync::Arc;

/// Node of a glTF file before it is added to the scene, with its children, its transform and the
/// indices of its contents.
#[derive(Clone, Default)]
pub(super) struct NodeData {
    pub name: String,
    pub children: Vec<usize>,
    parent: Option<usize>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub camera: Option<usize>,
    pub light: Option<usize>,
    pub weights: Vec<f32>,
    pub local: LocalTransform,
    /// Transforms of the instances relative to the node (EXT_mesh_gpu_instancing), or `None` if the
    /// node has no instances.
    copies: Option<Vec<DAffine3>>,
}

/// Transform of a glTF node relative to its parent, given as a matrix or as translation, rotation
/// and scale.
#[derive(Clone, Copy)]
pub(super) struct LocalTransform {
    matrix: Option<DAffine3>,
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl Default for LocalTransform {
    fn default() -> Self {
        LocalTransform { matrix: None, translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
    }
}

impl LocalTransform {
    fn map(&self) -> DAffine3 {
        let trs = || DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation);
        self.matrix.unwrap_or_else(trs)
    }
}

/// Mesh of a glTF node and its transform, ready to be added to the scene.
struct Instance {
    to_world: DAffine3,
    name: String,
    data: Arc<MeshData>,
    span: Span,
}

/// Returns a transform as a matrix operation, or `None` if it is singular or its numbers overflow.
fn matrix_of(map: DAffine3) -> Option<MatrixOp> {
    let op = MatrixOp::Matrix(DMat4::from(map).transpose().to_cols_array().map(|x| x as f32));
    Affine::new(op.matrix()).map(|_| op)
}

fn vector(at: &JsonRef) -> Option<DVec3> {
    at.numbers::<3>().map(|v| Vec3::from_array(v).as_dvec3())
}

impl Model<'_> {
    /// Reads all nodes, and checks that they form a forest.
    pub(super) fn read_nodes(&self, root: &JsonRef) -> Vec<NodeData> {
        let Some(list) = root.get("nodes") else { return Vec::new() };
        let count = list.items().len();
        let mut nodes: Vec<NodeData> = list.items().map(|at| self.node(&at, count)).collect();
        for (i, at) in list.items().enumerate() {
            let Some(children) = at.get("children") else { continue };
            for (at, child) in children.items().zip(nodes[i].children.clone()) {
                if nodes.get(child).is_some_and(|node| node.parent.is_some()) {
                    at.error("NODE_PARENT_OVERRIDE", format!("node {child} already has another parent"));
                } else if let Some(node) = nodes.get_mut(child) {
                    node.parent = Some(i);
                }
            }
        }
        // A node that cannot be reached from any root is part of a cycle or a descendant of one.
        let mut reached = vec![false; count];
        let mut stack: Vec<usize> = (0..count).filter(|&i| nodes[i].parent.is_none()).collect();
        while let Some(i) = stack.pop() {
            reached[i] = true;
            stack.extend(nodes[i].children.iter().copied().filter(|&child| child < count && !reached[child]));
        }
        if let Some(lost) =
            list.items().zip(&reached).find(|(_, reached)| !**reached).filter(|_| !self.report.has_errors())
        {
            lost.0.error("NODE_LOOP", "this node is its own ancestor, or is below a node that is its own ancestor");
        }
        nodes
    }

    fn node(&self, at: &JsonRef, count: usize) -> NodeData {
        let mut node = NodeData::default();
        if at.object().is_none() {
            return node;
        }
        node.name = at.get("name").and_then(|name| name.value.as_str()).unwrap_or_default().to_string();
        node.children = at.list("children", |child| child.index(count).unwrap_or(usize::MAX));
        let index = |key, count| at.get(key).and_then(|number| number.index(count));
        node.mesh = index("mesh", self.meshes.len());
        node.skin = index("skin", self.skins.len());
        node.camera = index("camera", self.cameras.len());
        node.weights = at.list("weights", |weight| weight.number().unwrap_or(0.0));
        node.local = self.local(at);
        if let Some(extensions) = at.get("extensions") {
            let light = extensions.get("KHR_lights_punctual");
            node.light = light.and_then(|light| light.required("light")?.index(self.lights.len()));
            node.copies = extensions.get("EXT_mesh_gpu_instancing").and_then(|copies| self.copies(&copies));
        }
        node
    }

    fn local(&self, at: &JsonRef) -> LocalTransform {
        let mut local = LocalTransform::default();
        if let Some(matrix) = at.get("matrix") {
            if ["translation", "rotation", "scale"].iter().any(|key| at.get(key).is_some()) {
                matrix.error(
                    "NODE_MATRIX_TRS",
                    "a node can have either a matrix, or a translation, a rotation and a scale, but not both",
                );
            }
            if let Some(columns) = matrix.numbers::<16>() {
                if [columns[3], columns[7], columns[11], columns[15]] != [0.0, 0.0, 0.0, 1.0] {
                    matrix.error("NODE_MATRIX_NON_TRS", "the last row of the matrix must be 0 0 0 1");
                }
                local.matrix = Some(DAffine3::from_mat4(DMat4::from_cols_array(&columns.map(f64::from))));
            }
        }
        local.translation = at.get("translation").and_then(|v| vector(&v)).unwrap_or(DVec3::ZERO);
        local.scale = at.get("scale").and_then(|v| vector(&v)).unwrap_or(DVec3::ONE);
        if let Some(rotation) = at.get("rotation")
            && let Some(q) = rotation.numbers::<4>()
        {
            let q = DQuat::from_array(q.map(f64::from));
            if (q.length() - 1.0).abs() > 5e-3 {
                rotation.error("ROTATION_NON_UNIT", "a rotation must be a quaternion of length 1");
            } else {
                local.rotation = q.normalize();
            }
        }
        local
    }

    fn copies(&self, at: &JsonRef) -> Option<Vec<DAffine3>> {
        let attributes = at.required("attributes")?;
        let rows = |key| attributes.get(key).and_then(|at| self.rows::<4>(self.accessor(&at)?, &at));
        let (moves, turns, scales) = (rows("TRANSLATION"), rows("ROTATION"), rows("SCALE"));
        let count = [&moves, &turns, &scales].into_iter().flatten().map(Vec::len).min()?;
        self.charge(count, 512, at)?;
        let vector = |v: [f32; 4]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
        let copy = |i: usize| {
            let scale = scales.as_ref().map_or(DVec3::ONE, |rows| vector(rows[i]));
            let turn = turns.as_ref().map(|rows| DQuat::from_array(rows[i].map(f64::from)));
            let turn = turn.filter(|q| q.length() > 1e-6).map_or(DQuat::IDENTITY, DQuat::normalize);
            let place = moves.as_ref().map_or(DVec3::ZERO, |rows| vector(rows[i]));
            DAffine3::from_scale_rotation_translation(scale, turn, place)
        };
        Some((0..count).map(copy).collect())
    }

    /// Returns the nodes of the visible scene with parents first, and the transforms of all nodes
    /// to world space. Joints can be nodes that are outside the visible scene.
    pub(super) fn world_transforms(&self, root: &JsonRef, nodes: &[NodeData]) -> (Vec<usize>, Vec<DAffine3>) {
        let mut maps = vec![DAffine3::IDENTITY; nodes.len()];
        let mut order = Vec::with_capacity(nodes.len());
        let mut stack: Vec<usize> = (0..nodes.len()).filter(|&i| nodes[i].parent.is_none()).rev().collect();
        let roots = self.root_nodes(root, nodes);
        let mut is_shown = vec![false; nodes.len()];
        roots.iter().for_each(|&i| is_shown[i] = true);
        while let Some(i) = stack.pop() {
            let parent = nodes[i].parent;
            maps[i] = parent.map_or(DAffine3::IDENTITY, |up| maps[up]) * nodes[i].local.map();
            is_shown[i] |= parent.is_some_and(|up| is_shown[up]);
            order.push(i);
            stack.extend(nodes[i].children.iter().rev());
        }
        order.retain(|&i| is_shown[i]);
        (order, maps)
    }

    /// Returns the roots of the visible scene, which is the default scene or otherwise the first
    /// scene. If the file has no scenes, returns all roots.
    fn root_nodes(&self, root: &JsonRef, nodes: &[NodeData]) -> Vec<usize> {
        let all = || (0..nodes.len()).filter(|&i| nodes[i].parent.is_none()).collect();
        let Some(scenes) = root.get("scenes") else {
            if let Some(wanted) = root.get("scene") {
                wanted.index(0);
            }
            return all();
        };
        let roots = |scene: &JsonRef| {
            scene.object();
            scene.list("nodes", |node| {
                let number = node.index(nodes.len());
                if number.is_some_and(|number| nodes[number].parent.is_some()) {
                    node.error("SCENE_NON_ROOT_NODE", "this node is not a root, because it has a parent");
                }
                number
            })
        };
        let all: Vec<Vec<Option<usize>>> = scenes.items().map(|scene| roots(&scene)).collect();
        let wanted = root.get("scene").map_or(Some(0), |wanted| wanted.index(all.len())).unwrap_or(0);
        all.into_iter().nth(wanted).unwrap_or_default().into_iter().flatten().collect()
    }

    /// Warns about a node with a mesh or a light that no scene of the file contains. Nodes that an
    /// extension may refer to are not reported.
    pub(super) fn report_nodes_without_scene(&self, root: &JsonRef, nodes: &[NodeData]) {
        let scenes = root.value.get("scenes").and_then(|scenes| scenes.as_array());
        let Some(scenes) = scenes.filter(|_| root.value.pointer("/extensionsUsed").is_none_or(has_no_levels)) else {
            return;
        };
        let roots = scenes.iter().filter_map(|scene| scene.get("nodes")?.as_array()).flatten();
        let mut stack: Vec<usize> = roots.filter_map(|node| Some(node.as_u64()? as usize)).collect();
        let mut is_reached = vec![false; nodes.len()];
        while let Some(i) = stack.pop() {
            if i < nodes.len() && !std::mem::replace(&mut is_reached[i], true) {
                stack.extend(&nodes[i].children);
            }
        }
        let shows = |node: &NodeData| node.mesh.is_some() || node.light.is_some();
        let left_out = || (0..nodes.len()).filter(|&i| shows(&nodes[i]) && !is_reached[i]);
        let Some(first) = left_out().next() else { return };
        let message = match left_out().count() {
            1 if nodes[first].mesh.is_none() => "no scene contains this node, so its light is off".to_string(),
            1 => "no scene contains this node, so its mesh is not in the picture".to_string(),
            count => format!("no scene contains this node and {} others with meshes or lights", count - 1),
        };
        let at = if nodes[first].name.is_empty() { String::new() } else { "/name".into() };
        self.report.report(Diagnostic::warning, "NODE_NO_SCENE", &format!("/nodes/{first}{at}"), &message);
    }

    /// Adds the mesh of a node to the scene after transforming it to world space.
    pub(super) fn add_mesh(&self, number: usize, nodes: &[NodeData], maps: &[DAffine3], scene: &mut Scene) {
        let node = &nodes[number];
        let Some(mesh) = node.mesh else { return };
        let bones = node.skin.and_then(|skin| self.skins[skin].as_ref()).map(|skin: &Skin| skin.bones(maps));
        let span = self.report.node(number);
        let pointer = || format!("/nodes/{number}");
        for (i, primitive) in self.meshes[mesh].iter().enumerate() {
            let Some(primitive) = primitive else { continue };
            let mut name = format!("{}#/meshes/{mesh}/primitives/{i}", self.input.name);
            let mut data = primitive.data.clone();
            if let Some(pose) = &primitive.pose {
                let weights = if node.weights.is_empty() { &self.weights[mesh] } else { &node.weights };
                if pose.moves(weights, bones.is_some()) {
                    if self.copied(&data, &pointer).is_none() {
                        return;
                    }
                    data = primitive.deformed(pose, weights, bones.as_deref()).into();
                    name += &format!("@/nodes/{number}");
                }
            }
            if data.triangles.is_empty() {
                continue;
            }
            // The joint matrices already contain the transform to world space.
            let here = if bones.is_some() { DAffine3::IDENTITY } else { maps[number] };
            let own = [DAffine3::IDENTITY];
            let copies = node.copies.as_deref().unwrap_or(&own);
            if self.report_limit(self.kept.objects(copies.len()), &pointer).is_none() {
                return;
            }
            for (copy, place) in copies.iter().enumerate() {
                let mut instance = Instance { to_world: here * *place, name: name.clone(), data: data.clone(), span };
                if matrix_of(instance.to_world).is_none() {
                    let is_sheet = flattens_to_plane(instance.to_world);
                    if is_sheet && self.copied(&data, &pointer).is_none() {
                        return;
                    }
                    let flat = is_sheet.then(|| flattened(&data, instance.to_world)).flatten();
                    let Some(flat) = flat else {
                        self.warn_left_out(number, node);
                        continue;
                    };
                    instance.name += &format!("@/nodes/{number}/{copy}");
                    (instance.data, instance.to_world) = (flat.into(), DAffine3::IDENTITY);
                }
                let object = self.object(instance, primitive.material, scene);
                scene.root.get_or_insert_default().objects.extend(object);
            }
        }
    }

    /// Counts a copy of a mesh towards the memory limit.
    fn copied(&self, data: &MeshData, pointer: &dyn Fn() -> String) -> Option<()> {
        self.charge_at(data.bytes(), 1, pointer)?;
        self.report_limit(self.kept.bytes(data.bytes(), 1), pointer)
    }

    /// Warns that a node is left out.
    fn warn_left_out(&self, number: usize, node: &NodeData) {
        let name = if node.name.is_empty() { String::new() } else { format!(" {}", quoted(node.name.as_bytes())) };
        let message = format!(
            "node{name} is left out, because its transform flattens its mesh to a line or point, or has numbers that \
             are too large"
        );
        self.once_at("flat", &format!("/nodes/{number}"), &message);
    }

    fn object(&self, instance: Instance, material: Option<u32>, scene: &mut Scene) -> Option<Object> {
        let Instance { to_world, name, data, span } = instance;
        let op = matrix_of(to_world)?;
        let material = match material {
            None if !data.colors.is_empty() => Some(self.white(span, scene)),
            material => material,
        };
        let mesh = scene.add_mesh(&name, data, span);
        if to_world == DAffine3::IDENTITY {
            return Some(Object { node: mesh, material, span });
        }
        let inner = Object { node: mesh, material, span };
        Some(Object { node: ObjectKind::Transform(vec![op], Box::new(inner)), material, span })
    }

    /// Returns the index of a white material for meshes that have vertex colours but no material.
    /// The default grey material would darken the colours.
    fn white(&self, span: Span, scene: &mut Scene) -> u32 {
        if scene.materials.len() == self.material_count {
            let white = PrincipledMaterial { base_color: Vec3::ONE, ..PrincipledMaterial::default() };
            scene.materials.push(Spanned { value: Material::Principled(Box::new(white)), span });
        }
        self.material_count as u32
    }
}

/// Returns true if a list of extensions does not contain the one for levels of detail, whose nodes
/// belong to no scene.
fn has_no_levels(extensions: &serde_json::Value) -> bool {
    extensions.as_array().is_none_or(|names| names.iter().all(|name| name != "MSFT_lod"))
}
