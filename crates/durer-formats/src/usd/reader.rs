//! State of the conversion of a stage to a scene.

use super::stage::{Prim, Stage};
use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::{Affine, Vec3};
use durer_scene::scene::{Material, MatrixOp, Object, ObjectKind, Scene, Spanned};
use durer_scene::shape::MeshData;
use glam::{DAffine3, DMat4};
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// State that a prim inherits from its ancestors.
#[derive(Clone, Default)]
pub(super) struct Inherited {
    pub to_world: DAffine3,
    /// Path of the bound material.
    pub material: Option<String>,
    /// True if the material is stronger than those of descendants.
    pub is_stronger: bool,
    /// Nearest ancestor with a constant display colour.
    pub display: Option<Rc<Prim>>,
    /// Paths of the skeleton and of its animation.
    pub skeleton: [Option<String>; 2],
}

/// Prim that is left out: its span, and the attribute with its value that hides it.
pub(super) type Invisible = (Span, &'static str, &'static str);

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
    /// Prims that are invisible, and whose descendants are therefore left out.
    pub invisible: Vec<Invisible>,
}

/// Material of the scene, with the primvars that it uses: the names of the texture coordinates of
/// its pictures, and display colours.
pub(super) struct BoundMaterial {
    pub number: u32,
    pub uvs: Vec<String>,
    /// True if it uses the display colours of the mesh.
    pub uses_colors: bool,
}

/// Radiance of a light surface.
#[derive(Clone, Debug)]
pub(super) struct Emission {
    pub radiance: Vec3,
    /// Colour temperature, such as `6500K`.
    pub spectrum: Option<String>,
    /// Picture that multiplies the radiance.
    pub picture: Option<FileName>,
}

impl Emission {
    /// Returns a black material with this emission.
    pub fn material(&self) -> PrincipledMaterial {
        let named = |path: &String| FileName { path: path.clone(), span: Span::default() };
        PrincipledMaterial {
            base_color: Vec3::ZERO,
            specular_weight: 0.0,
            emission_luminance: 1.0,
            emission_color: self.radiance,
            emission_spectrum: self.spectrum.as_ref().map(named),
            emission_texture: self.picture.clone(),
            ..PrincipledMaterial::default()
        }
    }
}

/// Camera of the scene. The field of view follows from the shape of the picture.
pub(super) struct CameraData {
    pub name: String,
    pub path: String,
    pub at: Span,
    pub to_world: DAffine3,
    pub is_orthographic: bool,
    /// Width and height of the film, in world units.
    pub film: [f64; 2],
    /// Offset of the film, in world units.
    pub offset: [f64; 2],
    pub focal_length: f64,
    pub f_stop: f64,
    pub focus_distance: f64,
    /// Near and far distance, if the file states them.
    pub clipping: Option<[f64; 2]>,
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
            invisible: Vec::new(),
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

    /// Returns the path of the material that a prim binds itself, and true if it is stronger than
    /// the materials of descendants.
    pub fn bound_material(&self, prim: &Prim) -> Option<(String, bool)> {
        let purposes = ["material:binding:full", "material:binding", "material:binding:preview"];
        let bound = purposes.into_iter().find_map(|name| Some((prim.targets(name).into_iter().next()?, name)));
        if bound.is_none() && prim.property_names().iter().any(|name| name.starts_with("material:binding:collection")) {
            let message = "bindings of materials to collections have no counterpart: they are left out";
            self.stage.files.report.unsupported_once(prim.span(), message);
        }
        if let Some((path, _)) = bound.as_ref().filter(|(path, _)| self.stage.prim(path).is_none()) {
            let message = format!("the material `{path}` does not exist: the display colour is used");
            self.stage.files.report.unsupported_once(prim.span(), message);
        }
        let strength = |name| prim.field_of(name, "bindMaterialAs");
        bound.map(|(path, name)| (path, strength(name).as_deref() == Some("strongerThanDescendants")))
    }

    /// Adds a material to the scene and returns its number.
    pub fn add_material(&mut self, material: PrincipledMaterial, at: Span) -> u32 {
        self.scene.materials.push(Spanned { value: Material::Principled(Box::new(material)), span: at });
        self.scene.materials.len() as u32 - 1
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
