//! Traversal of the prims, which adds objects, lights and cameras to the scene.

use super::camera::CameraData;
use super::light::Emission;
use super::material::BoundMaterial;
use super::skel::binding;
use super::stage::{Prim, Stage};
use super::transform::local_transform;
use durer_diag::Span;
use durer_scene::math::Affine;
use durer_scene::scene::{MatrixOp, Object, ObjectKind, Scene};
use durer_scene::shape::MeshData;
use glam::{DAffine3, DMat4};
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// Maximum nesting depth of prims.
const MAX_DEPTH: u32 = 256;

/// State that a prim inherits from its ancestors.
#[derive(Clone, Default)]
pub(super) struct Inherited {
    pub to_world: DAffine3,
    /// Path of the bound material.
    pub material: Option<String>,
    /// Paths of the skeleton and of its animation.
    pub skeleton: [Option<String>; 2],
}

/// Converts the prims of a stage to a scene.
pub(super) struct Reader<'s, 'a> {
    pub stage: &'s Stage<'a>,
    pub scene: Scene,
    /// Materials by path; `None` for prims that are not materials.
    pub materials: HashMap<String, Option<Rc<BoundMaterial>>>,
    /// Materials without a shader, by the colour or emission that they stand for.
    pub plain_materials: HashMap<String, u32>,
    /// Meshes by the place of their attributes, so that instances share them.
    pub meshes: HashMap<String, Option<Arc<MeshData>>>,
    pub cameras: Vec<CameraData>,
    /// True after the first dome light.
    pub has_dome: bool,
}

impl<'s, 'a> Reader<'s, 'a> {
    pub fn new(stage: &'s Stage<'a>) -> Self {
        Reader {
            stage,
            scene: Scene::default(),
            materials: HashMap::new(),
            plain_materials: HashMap::new(),
            meshes: HashMap::new(),
            cameras: Vec::new(),
            has_dome: false,
        }
    }

    /// Adds a prim and its descendants.
    pub fn visit(&mut self, prim: &Prim, inherited: &Inherited, objects: &mut Vec<Object>, depth: u32) {
        let report = self.stage.files.report;
        if report.is_full() {
            return;
        }
        if depth > MAX_DEPTH {
            return report.error(prim.span(), format!("prims are nested more than {MAX_DEPTH} deep"));
        }
        let (local, resets) = local_transform(self.stage, prim);
        let mut here = inherited.clone();
        here.to_world = if resets { local } else { inherited.to_world * local };
        if let Some(material) = self.bound_material(prim) {
            here.material = Some(material);
        }
        here.skeleton = binding(prim, inherited);
        let type_name = prim.type_name().to_string();
        // Materials and skeletons have no visible descendants.
        if matches!(
            type_name.as_str(),
            "Material" | "Shader" | "NodeGraph" | "Skeleton" | "SkelAnimation" | "GeomSubset"
        ) {
            return;
        }
        if type_name == "Camera" {
            // An invisible camera can be used.
            self.read_camera(prim, here.to_world);
        }
        if self.text(prim, "visibility").as_deref() == Some("invisible")
            || matches!(self.text(prim, "purpose").as_deref(), Some("proxy" | "guide"))
        {
            return;
        }
        if type_name == "PointInstancer" {
            return self.instances(prim, &here, objects, depth);
        }
        self.shape(prim, &type_name, &here, objects);
        for child in self.stage.children(prim) {
            self.visit(&child, &here, objects, depth + 1);
        }
    }

    fn shape(&mut self, prim: &Prim, type_name: &str, here: &Inherited, objects: &mut Vec<Object>) {
        let report = self.stage.files.report;
        match type_name {
            "Mesh" => self.mesh(prim, here, objects),
            "Sphere" | "Cube" | "Cylinder" | "Cone" | "Capsule" | "Plane" => {
                self.simple_shape(prim, type_name, here, objects);
            }
            "Points" => self.points(prim, here, objects),
            "BasisCurves" => self.curves(prim, here, objects),
            "DistantLight" | "SphereLight" | "RectLight" | "DiskLight" | "CylinderLight" | "DomeLight"
            | "DomeLight_1" => self.light(prim, type_name, here.to_world, objects),
            "NurbsPatch" | "NurbsCurves" | "HermiteCurves" | "TetMesh" | "Volume" | "GeometryLight" | "PluginLight"
            | "PortalLight" => {
                report.unsupported_once(prim.span(), format!("a {type_name} has no counterpart: it is left out"));
            }
            _ => {}
        }
        if prim.has_api("MeshLightAPI") {
            report.unsupported_once(prim.span(), "the light of a mesh with MeshLightAPI is left out");
        }
        if !prim.targets("skel:blendShapeTargets").is_empty() {
            report.unsupported_once(prim.span(), "blend shapes have no counterpart: they are left out");
        }
    }

    /// Adds an object in the space of the prim.
    pub fn add(
        &mut self,
        node: ObjectKind,
        material: Option<u32>,
        to_world: DAffine3,
        at: Span,
        objects: &mut Vec<Object>,
    ) {
        let files = self.stage.files;
        if !files.limits.count_objects_or_report(1, files.report, at) {
            return;
        }
        let inner = Object { node, material, span: at };
        let matrix = MatrixOp::Matrix(DMat4::from(to_world).transpose().to_cols_array().map(|x| x as f32));
        if Affine::new(matrix.matrix()).is_none() {
            let message = "an object is left out, because its transform flattens it or has numbers that are too large";
            return files.report.unsupported_once(at, message);
        }
        objects.push(inner.transformed(to_world));
    }

    /// Returns the value of a text attribute.
    pub fn text(&self, prim: &Prim, name: &str) -> Option<String> {
        prim.get(self.stage, name).and_then(|opinion| opinion.value.text().map(str::to_string))
    }

    /// Returns the value of a numeric attribute if it is finite.
    pub fn number(&self, prim: &Prim, name: &str) -> Option<f64> {
        prim.get(self.stage, name).and_then(|opinion| opinion.value.number()).filter(|number| number.is_finite())
    }

    /// Returns the components of an attribute of three numbers.
    pub fn triple(&self, prim: &Prim, name: &str) -> Option<[f64; 3]> {
        let opinion = prim.get(self.stage, name)?;
        opinion.value.numbers().first_chunk::<3>().copied().filter(|all| all.iter().all(|x| x.is_finite()))
    }

    /// Returns the value of a boolean attribute.
    pub fn boolean(&self, prim: &Prim, name: &str) -> Option<bool> {
        prim.get(self.stage, name).and_then(|opinion| opinion.value.boolean())
    }

    /// Returns the path of the material that a prim binds itself.
    pub fn bound_material(&self, prim: &Prim) -> Option<String> {
        let purposes = ["material:binding:full", "material:binding", "material:binding:preview"];
        let bound = purposes.into_iter().find_map(|name| prim.targets(name).into_iter().next());
        if bound.is_none() && prim.property_names().iter().any(|name| name.starts_with("material:binding:collection")) {
            let message = "bindings of materials to collections have no counterpart: they are left out";
            self.stage.files.report.unsupported_once(prim.span(), message);
        }
        bound
    }

    /// Returns the material for a surface that emits light.
    pub fn emitter(&mut self, emission: &Emission, at: Span) -> u32 {
        let key = format!("{emission:?}");
        if let Some(known) = self.plain_materials.get(&key) {
            return *known;
        }
        let number = self.add_material(emission.material(), at);
        self.plain_materials.insert(key, number);
        number
    }
}
