//! Conversion of the nodes of a visual scene to objects, lights and cameras.

use super::document::{Element, by_id};
use super::parts::{CameraData, Part, Source};
use super::transform::local_transform;
use crate::growth::ResourceLimits;
use crate::model::ReadInput;
use crate::shared_report::SharedReport;
use durer_diag::{Diagnostic, Span};
use durer_scene::math::{Affine, Vec3};
use durer_scene::scene::{Axis, Group, MatrixOp, Object, Scene};
use glam::{DAffine3, DMat4, DVec3};
use std::collections::HashMap;
use std::rc::Rc;

/// Maximum nesting depth of nodes, counting those of instances.
const MAX_DEPTH: u32 = 128;

/// Converts the elements of a file to a scene.
pub(super) struct Reader<'r> {
    pub input: &'r ReadInput<'r>,
    pub report: &'r SharedReport,
    pub limits: &'r ResourceLimits,
    pub root: &'r Element<'r>,
    pub ids: HashMap<&'r str, &'r Element<'r>>,
    pub scene: Scene,
    pub sources: HashMap<&'r str, Option<Rc<Source>>>,
    /// Parts of the geometries by id.
    meshes: HashMap<&'r str, Rc<Vec<Part>>>,
    /// Numbers of materials, by their ids and by the texture coordinates that are bound to them.
    pub materials: HashMap<String, u32>,
    pub cameras: Vec<CameraData>,
    /// Spotlights in the list of lights, with the coefficients of their attenuation.
    pub spots: Vec<(usize, [f64; 3], Span)>,
    /// Transforms of nodes relative to their parents, by address.
    locals: HashMap<usize, DAffine3>,
    /// Places of the nodes of the visual scene, by address, and by sid, id and name.
    pub world: HashMap<usize, DAffine3>,
    pub places: HashMap<&'r str, DAffine3>,
    /// Version of Blender that wrote the file, such as 2.8.
    pub blender: Option<f64>,
    /// True if colours are linear; otherwise they are sRGB.
    pub is_linear: bool,
    /// Scale that converts lengths to metres.
    unit: DAffine3,
    /// Number of meshes that follow a skeleton.
    skins: usize,
}

/// Converts a file to a scene.
pub(super) fn scene<'r>(
    root: &'r Element<'r>,
    input: &'r ReadInput<'r>,
    report: &'r SharedReport,
    limits: &'r ResourceLimits,
) -> Option<Scene> {
    if root.name != "COLLADA" {
        report.error(root.at, format!("the root element must be `COLLADA`, but it is `{}`", root.name));
        return None;
    }
    let tool = root.child("asset").into_iter().flat_map(|asset| asset.all("contributor"));
    let tool = tool.filter_map(|contributor| contributor.child("authoring_tool")).map(Element::text).next();
    let blender = tool.and_then(|tool| tool.strip_prefix("Blender ")).map(|version| {
        let mut parts = version.split(|c: char| !c.is_ascii_digit()).map_while(|part| part.parse::<f64>().ok());
        parts.next().unwrap_or(0.0) + 0.01 * parts.next().unwrap_or(0.0)
    });
    let mut reader = Reader {
        input,
        report,
        limits,
        root,
        ids: by_id(root),
        scene: Scene::default(),
        sources: HashMap::new(),
        meshes: HashMap::new(),
        materials: HashMap::new(),
        cameras: Vec::new(),
        spots: Vec::new(),
        locals: HashMap::new(),
        world: HashMap::new(),
        places: HashMap::new(),
        blender,
        is_linear: blender.is_some(),
        unit: DAffine3::IDENTITY,
        skins: 0,
    };
    reader.unit = reader.asset();
    let mut objects = Vec::new();
    if let Some(visual) = reader.visual_scene() {
        reader.find_places(visual);
        for node in visual.all("node") {
            reader.visit(node, reader.unit, &mut objects, 0);
        }
    }
    if root.child("library_animations").is_some_and(|animations| !animations.children.is_empty()) {
        let at = root.child("library_animations").map_or(root.at, |animations| animations.at);
        report.unsupported_once(at, "animations have no counterpart: the nodes stay where the scene places them");
    }
    reader.set_camera();
    if objects.is_empty() && !report.has_errors() {
        report.push(Diagnostic::warning("the scene has no visible surfaces").code("no-objects").at(root.at));
    }
    reader.scene.root = Some(Group { objects }).filter(|root| !root.objects.is_empty());
    reader.set_attenuation_of_spots();
    Some(reader.scene)
}

impl<'r> Reader<'r> {
    /// Sets the up axis, and returns the scale that converts lengths to metres.
    fn asset(&mut self) -> DAffine3 {
        let asset = self.root.child("asset");
        let up = asset.and_then(|asset| asset.child("up_axis"));
        self.scene.up = Some(match up.map(Element::text) {
            Some("X_UP") => Axis::X,
            Some("Z_UP") => Axis::Z,
            _ => Axis::Y,
        });
        let unit = asset.and_then(|asset| asset.child("unit"));
        let Some((unit, text)) = unit.and_then(|unit| Some((unit, unit.get("meter")?))) else {
            return DAffine3::IDENTITY;
        };
        match text.trim().replace(',', ".").parse::<f64>() {
            Ok(meter) if (1e-9..=1e9).contains(&meter) => DAffine3::from_scale(DVec3::splat(meter)),
            _ => {
                self.report.error(unit.span_of("meter"), "`meter` must be a length in metres greater than 0");
                DAffine3::IDENTITY
            }
        }
    }

    /// Returns the visual scene that the file shows, or the first one.
    fn visual_scene(&mut self) -> Option<&'r Element<'r>> {
        let instance = self.root.child("scene").and_then(|scene| scene.child("instance_visual_scene"));
        if let Some(instance) = instance {
            return self.referred(instance, "url", "visual_scene");
        }
        self.root.all("library_visual_scenes").find_map(|library| library.child("visual_scene"))
    }

    /// Returns the transform of a node relative to its parent.
    pub fn local(&mut self, node: &'r Element<'r>) -> DAffine3 {
        let key = std::ptr::from_ref(node).addr();
        if let Some(known) = self.locals.get(&key) {
            return *known;
        }
        let map = local_transform(node, self.report, self.limits);
        self.locals.insert(key, map);
        map
    }

    /// Adds what a node and its descendants contain.
    fn visit(&mut self, node: &'r Element<'r>, to_parent: DAffine3, objects: &mut Vec<Object>, depth: u32) {
        if self.report.is_full() {
            return;
        }
        if depth > MAX_DEPTH {
            let message = format!("nodes are nested more than {MAX_DEPTH} deep, or a node contains itself");
            return self.report.error(node.at, message);
        }
        if !self.limits.count_objects_or_report(1, self.report, node.at) {
            return;
        }
        let to_world = to_parent * self.local(node);
        for child in &node.children {
            match child.name {
                "node" => self.visit(child, to_world, objects, depth + 1),
                "instance_node" => {
                    if let Some(target) = self.referred(child, "url", "node") {
                        self.visit(target, to_world, objects, depth + 1);
                    }
                }
                "instance_geometry" => {
                    if let Some(geometry) = self.referred(child, "url", "geometry") {
                        self.geometry(child, geometry, to_world, objects);
                    }
                }
                "instance_controller" => self.instance_controller(child, to_world, objects),
                "instance_camera" => {
                    if let Some(camera) = self.referred(child, "url", "camera") {
                        self.read_camera(node, camera, to_world);
                    }
                }
                "instance_light" => {
                    if let Some(light) = self.referred(child, "url", "light") {
                        self.light(light, to_world);
                    }
                }
                _ => {}
            }
        }
    }

    /// Adds the parts of a geometry as objects.
    fn geometry(
        &mut self,
        instance: &'r Element<'r>,
        geometry: &'r Element<'r>,
        to_world: DAffine3,
        objects: &mut Vec<Object>,
    ) {
        let id = geometry.get("id").unwrap_or_default();
        let parts = match self.meshes.get(id) {
            Some(known) => known.clone(),
            None => {
                let parts = Rc::new(self.mesh(geometry, None));
                self.meshes.insert(id, parts.clone());
                parts
            }
        };
        self.add_parts(instance, id, &parts, to_world, objects);
    }

    /// Adds a mesh that follows a skeleton.
    fn instance_controller(&mut self, instance: &'r Element<'r>, to_world: DAffine3, objects: &mut Vec<Object>) {
        let Some(controller) = self.referred(instance, "url", "controller") else { return };
        let Some((geometry, skin)) = self.controller(instance, controller) else { return };
        let Some(skin) = skin else { return self.geometry(instance, geometry, to_world, objects) };
        let parts = self.mesh(geometry, Some(&skin));
        self.skins += 1;
        let name = format!("{}#{}", geometry.get("id").unwrap_or_default(), self.skins);
        // The joints state where the points are, so the node of the mesh does not.
        self.add_parts(instance, &name, &parts, self.unit, objects);
    }

    fn add_parts(
        &mut self,
        instance: &'r Element<'r>,
        name: &str,
        parts: &[Part],
        to_world: DAffine3,
        objects: &mut Vec<Object>,
    ) {
        for (i, part) in parts.iter().enumerate() {
            if !self.limits.count_objects_or_report(1, self.report, instance.at) {
                return;
            }
            let matrix = MatrixOp::Matrix(DMat4::from(to_world).transpose().to_cols_array().map(|x| x as f32));
            if Affine::new(matrix.matrix()).is_none() {
                let message =
                    "an object is left out, because its transform flattens it or has numbers that are too large";
                self.report.unsupported_once(instance.at, message);
                continue;
            }
            let material = self.bound_material(instance, part);
            let node = self.scene.add_mesh(&format!("{name}#{i}"), part.data.clone(), part.at);
            objects.push(Object { node, material, span: instance.at }.transformed(to_world));
        }
    }

    /// Returns the numbers of a child element, with each component at least 0.
    pub fn color(&self, element: &'r Element<'r>) -> Option<Vec3> {
        let numbers = element.numbers(self.report, self.limits);
        let [r, g, b] = *numbers.first_chunk::<3>()?;
        Some(Vec3::new(r, g, b)).filter(|color| color.is_finite()).map(|color| color.max(Vec3::ZERO))
    }

    /// Returns the number of a child element.
    pub fn number(&self, parent: &'r Element<'r>, name: &str) -> Option<f64> {
        parent.child(name)?.number(self.report, self.limits)
    }
}
