//! State of the pbrt reader: the graphics state that directives change, and the scene that has been
//! built so far.

use super::defs::{AreaLight, InfiniteLight, MaterialDef, Texture};
use super::language::{DetectedLanguage, Language};
use super::lexer::Lexer;
use super::params::{Param, Params};
use super::transform::Transforms;
use crate::growth::ResourceLimits;
use crate::medium::Medium;
use crate::model::ReadInput;
use crate::shared_report::SharedReport;
use durer_diag::Span;
use durer_scene::scene::{Group, Object, Scene};
use durer_scene::shape::MeshData;
use durer_scene::spectrum::space::RgbSpace;
use glam::DAffine3;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

/// Targets of the `Attribute` directive, as indices into [`State::attributes`].
pub(super) const SHAPE: usize = 0;
pub(super) const LIGHT: usize = 1;
pub(super) const MATERIAL: usize = 2;
pub(super) const MEDIUM: usize = 3;
pub(super) const TEXTURE: usize = 4;

/// Graphics state of pbrt, such as the current transformation and material. `AttributeBegin` saves
/// a copy of this state.
#[derive(Clone, Default)]
pub(super) struct State {
    pub transforms: Transforms,
    pub reversed: bool,
    /// Index of the current material.
    pub material: usize,
    /// Directive that set the current material.
    pub material_at: Option<Span>,
    /// Number of shapes so far, which tells whether a shape precedes a directive in its scope.
    pub shapes: usize,
    pub area_light: Option<Rc<AreaLight>>,
    /// Names of the media inside and outside the shapes that follow.
    pub inside: Option<String>,
    pub outside: Option<String>,
    /// Parameters that `Attribute` has set for shapes, lights, materials, media and textures.
    pub attributes: [Vec<Rc<Param>>; 5],
    pub space: RgbSpace,
}

/// Kind of a scope that a directive such as `AttributeBegin` has opened. The kind determines which
/// directive closes the scope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scope {
    Attribute,
    Transform,
    Object,
    /// Imported file.
    Import,
}

/// Camera, film or other directive whose evaluation is deferred until the whole file has been read.
pub(super) struct DeferredDirective {
    pub kind: String,
    pub list: Vec<Rc<Param>>,
    pub at: Span,
    pub transforms: Transforms,
    pub space: RgbSpace,
}

/// File that is being read: the main file, or a file that a directive includes or imports.
pub(super) struct OpenFile {
    pub text: Lexer,
    pub name: String,
    /// Span of the directive that includes the file.
    pub at: Span,
    /// True if the file is imported, so that the end of the file closes every scope that it opened.
    pub imported: bool,
}

/// Reader that executes the directives of a pbrt scene file and builds the scene.
pub(super) struct Reader<'a> {
    pub input: &'a ReadInput<'a>,
    pub report: &'a SharedReport,
    pub language: Language,
    /// Span of the keyword that decided the version of pbrt.
    pub decided_by: Option<Span>,
    pub texts: Vec<OpenFile>,
    pub state: State,
    pub stack: Vec<(Scope, State, Span)>,
    pub coordinate_systems: BTreeMap<String, [DAffine3; 2]>,
    pub materials: Vec<MaterialDef>,
    pub named_materials: BTreeMap<String, usize>,
    /// Indices of materials in the scene, by the material, emission and opacity that a shape uses.
    pub material_indices: BTreeMap<(usize, String), Option<u32>>,
    pub textures: BTreeMap<(bool, String), Texture>,
    /// Media by name, with `None` for a medium that has no counterpart in Dürer.
    pub media: BTreeMap<String, Option<Medium>>,
    /// Indices of the materials that are filled with a medium, by material and medium.
    pub materials_with_medium: BTreeMap<(usize, String), usize>,
    pub objects: BTreeMap<String, Rc<Group>>,
    /// Name and contents of the object that is being defined.
    pub defining: Option<(String, Group)>,
    pub limits: ResourceLimits,
    /// Number of triangles so far that result from tessellating shapes.
    pub tessellated_triangles: usize,
    /// Number of files included so far.
    pub included: usize,
    pub camera: Option<DeferredDirective>,
    pub film: Option<DeferredDirective>,
    /// First directive that appears before `WorldBegin`, but is allowed only after it.
    pub too_early: Option<Span>,
    pub in_world: bool,
    /// Number of shapes that emit light because of an `AreaLightSource` outside of any scope, and
    /// the materials of these shapes, by the span's start and file.
    pub open_lights: BTreeMap<(u32, u32), (Span, usize, BTreeSet<usize>)>,
    /// Spans of the `AreaLightSource` directives that a shape follows, by file and start.
    pub used_lights: BTreeSet<(u32, u32)>,
    /// Spans of the directives that set the material of a shape, by file and start.
    pub used_materials: BTreeSet<(u32, u32)>,
    pub infinite: Vec<InfiniteLight>,
    pub meshes: BTreeMap<(String, bool), Arc<MeshData>>,
    pub scene: Scene,
}

impl<'a> Reader<'a> {
    pub fn new(input: &'a ReadInput<'a>, decided: DetectedLanguage, report: &'a SharedReport) -> Self {
        let text = Lexer::new(input.bytes.clone(), input.file);
        let at = Span { file: input.file, start: 0, end: 0 };
        Reader {
            input,
            report,
            language: decided.language,
            decided_by: decided.by,
            texts: vec![OpenFile { text, name: input.name.to_string(), at, imported: false }],
            state: State::default(),
            stack: Vec::new(),
            coordinate_systems: BTreeMap::new(),
            materials: vec![MaterialDef::default_material()],
            named_materials: BTreeMap::new(),
            material_indices: BTreeMap::new(),
            textures: BTreeMap::new(),
            media: BTreeMap::new(),
            materials_with_medium: BTreeMap::new(),
            objects: BTreeMap::new(),
            defining: None,
            limits: ResourceLimits::with_memory(input.memory),
            tessellated_triangles: 0,
            included: 0,
            camera: None,
            film: None,
            too_early: None,
            in_world: false,
            open_lights: BTreeMap::new(),
            used_lights: BTreeSet::new(),
            used_materials: BTreeSet::new(),
            infinite: Vec::new(),
            meshes: BTreeMap::new(),
            scene: Scene::default(),
        }
    }

    /// Returns the parameters of a directive, including those that `Attribute` has set for
    /// directives of its kind.
    pub fn params(&self, list: Vec<Rc<Param>>, attributes: Option<usize>, at: Span) -> Params<'a> {
        let attributes = attributes.map_or(&[][..], |kind| &self.state.attributes[kind]);
        Params::new(list, attributes, at, (self.input, self.report), (self.language, self.state.space))
    }

    /// Returns the parameters of a deferred directive.
    pub fn params_of(&self, directive: &DeferredDirective) -> Params<'a> {
        Params::new(
            directive.list.clone(),
            &[],
            directive.at,
            (self.input, self.report),
            (self.language, directive.space),
        )
    }

    /// Returns the transform from the current space to world space when the shutter opens. Warns if
    /// objects move.
    pub fn map(&self, at: Span) -> DAffine3 {
        if self.state.transforms.moves() {
            self.report
                .unsupported_once(at, "motion has no counterpart: everything stays where it is when the shutter opens");
        }
        self.state.transforms.maps[0]
    }

    /// Adds an object to the scene, or to the object that is being defined.
    pub fn add(&mut self, object: Object) {
        match &mut self.defining {
            Some((_, group)) => group.objects.push(object),
            None => self.scene.root.get_or_insert_default().objects.push(object),
        }
    }
}
