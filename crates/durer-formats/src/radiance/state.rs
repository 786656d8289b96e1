//! State of the Radiance reader.

use super::args::RadPrimitive;
use super::body::MaterialMesh;
use super::context::PrimitiveContext;
use super::converted::{ConvertedModifier, DistantSource};
use super::distribution::DirectionalDistribution;
use super::outline::Orientation;
use super::words::{PrimitiveStart, Word, Words};
use crate::model::ReadInput;
use crate::polygon::Triangulator;
use crate::shared_report::{SharedReport, suggest};
use durer_diag::{Diagnostic, Span};
use durer_scene::camera::Projection;
use durer_scene::medium::Fog;
use durer_scene::scene::{Group, Object, ObjectKind, Scene, Spanned};
use glam::DAffine3;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

/// Maximum depth of nested files, and maximum number of included files.
const MAX_DEPTH: u32 = 32;
const MAX_FILES: usize = 4096;
/// Maximum number of materials that patterns and mixtures can create.
const MAX_MATERIALS: usize = 1 << 16;
/// Maximum number of corners and shapes in a scene.
const MAX_SHAPES: usize = 1 << 26;

/// Radiance modifier, such as a material or a pattern, as stored in the file. The modifier contains
/// the indices of the modifiers that it refers to.
pub(super) struct Modifier {
    pub primitive: Rc<RadPrimitive>,
    /// Index of the modifier that applies to this one.
    pub parent: Option<usize>,
    /// Indices of other modifiers that this one names.
    pub others: [Option<usize>; 2],
    pub map: DAffine3,
    /// Length of the longest chain of modifiers that apply to this one.
    pub depth: u32,
}

/// Types of materials that the reader supports.
pub(super) const MATERIALS: [&str; 27] = [
    "plastic",
    "metal",
    "trans",
    "plastic2",
    "metal2",
    "trans2",
    "dielectric",
    "interface",
    "glass",
    "mirror",
    "light",
    "glow",
    "spotlight",
    "illum",
    "antimatter",
    "mist",
    "prism1",
    "prism2",
    "plasfunc",
    "metfunc",
    "transfunc",
    "plasdata",
    "metdata",
    "transdata",
    "BRTDfunc",
    "BSDF",
    "ashik2",
];
/// Types of materials that are newer than the reference manual or have no counterpart in Dürer.
pub(super) const UNSUPPORTED_MATERIALS: [&str; 2] = ["aBSDF", "WGMDfunc"];
pub(super) const PATTERNS: [&str; 10] = [
    "colorfunc",
    "brightfunc",
    "colordata",
    "brightdata",
    "colorpict",
    "colortext",
    "brighttext",
    "texfunc",
    "texdata",
    "spectrum",
];
pub(super) const MIXTURES: [&str; 4] = ["mixfunc", "mixdata", "mixpict", "mixtext"];
pub(super) const SURFACES: [&str; 11] =
    ["source", "sphere", "bubble", "polygon", "cone", "cup", "cylinder", "tube", "ring", "mesh", "instance"];

/// Reader that converts the primitives of a Radiance scene to objects, materials and lights.
pub(super) struct Reader<'a> {
    pub input: &'a ReadInput<'a>,
    pub report: &'a SharedReport,
    pub modifiers: Vec<Modifier>,
    pub names: BTreeMap<String, usize>,
    /// Converted modifiers. The key is the index of the modifier and the bits of the colour by
    /// which earlier patterns multiply it.
    pub converted: BTreeMap<(usize, [u32; 3]), Rc<ConvertedModifier>>,
    /// True after the limit on the number of materials was reached.
    material_limit_reached: bool,
    /// Meshes of merged surfaces, by material.
    pub bodies: BTreeMap<u32, MaterialMesh>,
    /// Fog that corresponds to each material of type `mist`.
    pub mist_fog: BTreeMap<u32, Fog>,
    pub distant: Vec<DistantSource>,
    /// Directional distributions by the index of their modifier, followed by the light profiles
    /// that are made from them. The key of a light profile is its distribution and the orientation
    /// of the surface.
    pub distributions: BTreeMap<usize, Rc<DirectionalDistribution>>,
    pub profiles: Vec<(Rc<DirectionalDistribution>, Orientation)>,
    pub triangulator: Triangulator,
    pub scene: Scene,
    pub count: usize,
    files: usize,
}

impl<'a> Reader<'a> {
    pub fn new(input: &'a ReadInput<'a>, report: &'a SharedReport) -> Self {
        Reader {
            input,
            report,
            modifiers: Vec::new(),
            names: BTreeMap::new(),
            converted: BTreeMap::new(),
            material_limit_reached: false,
            bodies: BTreeMap::new(),
            mist_fog: BTreeMap::new(),
            distant: Vec::new(),
            distributions: BTreeMap::new(),
            profiles: Vec::new(),
            triangulator: Triangulator::new(input.bytes.len()),
            scene: Scene { root: Some(Group::default()), ..Scene::default() },
            count: 0,
            files: 0,
        }
    }

    /// Reads all primitives and commands of a text.
    pub fn text(&mut self, bytes: &[u8], file: u32, place: &PrimitiveContext) {
        let mut words = Words::new(bytes, file, 0..bytes.len());
        while let Some(start) = words.start() {
            if self.report.is_full() {
                return;
            }
            match start {
                PrimitiveStart::Command(range) => self.command(Words::new(bytes, file, range), place),
                PrimitiveStart::Word(modifier) => {
                    let Some(primitive) = RadPrimitive::read(modifier, &mut words, self.report) else { return };
                    self.primitive(primitive, place);
                }
            }
        }
    }

    /// Returns true if the limit on the number of materials has been reached. If many patterns
    /// apply to many mixtures with `void`, the number of materials can be the number of patterns
    /// times the number of mixtures.
    pub fn is_full(&mut self, at: Span) -> bool {
        if !self.material_limit_reached && self.scene.materials.len() > 3 * self.modifiers.len() + MAX_MATERIALS {
            self.material_limit_reached = true;
            self.report
                .error(at, format!("patterns and mixtures with `void` result in more than {MAX_MATERIALS} materials"));
        }
        self.material_limit_reached
    }

    /// Reads a file that a command names. If `beside` is true, commands in the file run in the
    /// folder of that file. Otherwise they run in the current folder, as they do for piped output.
    pub fn file(&mut self, name: &Word, place: &PrimitiveContext, beside: bool) {
        self.files += 1;
        if place.depth >= MAX_DEPTH || self.files > MAX_FILES {
            let message = match place.depth >= MAX_DEPTH {
                true => format!("files are nested more than {MAX_DEPTH} levels deep, or a file includes itself"),
                false => format!("more than {MAX_FILES} files are included"),
            };
            return self.report.error(name.at, message);
        }
        let Some((bytes, file)) = self.open(&place.resolved(name)) else { return };
        let place = if beside { place.in_folder_of(name) } else { place.clone() };
        self.text(&bytes, file, &PrimitiveContext { depth: place.depth + 1, ..place });
    }

    /// Returns the bytes and the index of a file that another file names.
    pub fn open(&self, name: &Word) -> Option<(Arc<[u8]>, u32)> {
        match self.input.source.read(&name.text) {
            Ok(bytes) => {
                let file = self.input.files.borrow_mut().add(&name.text, bytes.clone());
                Some((bytes, file))
            }
            Err(error) => {
                let help = error.help();
                self.report
                    .push(Diagnostic { help, ..Diagnostic::error(error.to_string()).code("missing-file").at(name.at) });
                None
            }
        }
    }

    fn primitive(&mut self, primitive: RadPrimitive, place: &PrimitiveContext) {
        let kind = primitive.kind.text.as_str();
        if SURFACES.contains(&kind) {
            let modifier = place.modifier.as_ref().unwrap_or(&primitive.modifier);
            if let Some(modifier) = self.find(modifier) {
                self.surface(&primitive, modifier, place);
            }
        } else if kind == "alias" {
            self.alias(primitive);
        } else if [&MATERIALS[..], &UNSUPPORTED_MATERIALS, &PATTERNS, &MIXTURES]
            .iter()
            .any(|kinds| kinds.contains(&kind))
        {
            let Some(parent) = self.find(&primitive.modifier) else { return };
            let mut others = [None; 2];
            let named = match kind {
                "illum" | "mirror" => 1,
                _ if MIXTURES.contains(&kind) => 2,
                _ => 0,
            };
            for (other, name) in others.iter_mut().zip(primitive.texts.iter().take(named)) {
                let Some(number) = self.find(name) else { return };
                *other = number;
            }
            let modifier = Modifier { primitive: primitive.into(), parent, others, map: place.map, depth: 0 };
            self.define(modifier.primitive.name.clone(), modifier);
        } else {
            let known = SURFACES.into_iter().chain(MATERIALS).chain(PATTERNS).chain(MIXTURES);
            let help = suggest(kind, known);
            self.report.error_with_help(primitive.kind.at, format!("unknown type {}", primitive.kind.quoted()), help);
        }
    }

    fn define(&mut self, name: Word, mut modifier: Modifier) {
        let below = [modifier.parent, modifier.others[0], modifier.others[1]].into_iter().flatten();
        modifier.depth = below.map(|other| 1 + self.modifiers[other].depth).max().unwrap_or(0);
        if modifier.depth > MAX_DEPTH {
            return self.report.error(name.at, format!("modifiers are nested more than {MAX_DEPTH} levels deep"));
        }
        self.modifiers.push(modifier);
        self.names.insert(name.text, self.modifiers.len() - 1);
    }

    /// Defines an alias, which is another name for a modifier. A different modifier can apply to
    /// the alias.
    fn alias(&mut self, alias: RadPrimitive) {
        let Some(Some(real)) = self.find(&alias.texts[0]) else { return };
        let parent = match alias.modifier.text.as_str() {
            "inherit" => self.modifiers[real].parent,
            _ => match self.find(&alias.modifier) {
                Some(parent) => parent,
                None => return,
            },
        };
        let Modifier { primitive, others, map, .. } = &self.modifiers[real];
        let modifier = Modifier { primitive: primitive.clone(), parent, others: *others, map: *map, depth: 0 };
        self.define(alias.name, modifier);
    }

    /// Finds a modifier by its name and returns its index, or `Some(None)` for `void`. If the name
    /// is unknown, reports an error and returns `None`.
    pub fn find(&self, name: &Word) -> Option<Option<usize>> {
        if name.text == "void" {
            return Some(None);
        }
        let number = self.names.get(&name.text).copied();
        if number.is_none() {
            let help = suggest(&name.text, self.names.keys().map(String::as_str));
            let help = help.or_else(|| Some("name files with materials before the files that use them".into()));
            self.report.error_with_help(
                name.at,
                format!("no modifier {} is defined before this point", name.quoted()),
                help,
            );
        }
        number.map(Some)
    }

    /// Counts `more` additional corners or shapes. Returns false if the limit is exceeded.
    pub fn count_shapes(&mut self, more: usize, at: Span) -> bool {
        let before = self.count;
        self.count = self.count.saturating_add(more);
        if before <= MAX_SHAPES && self.count > MAX_SHAPES {
            self.report.error(
                at,
                format!("the scene has more than {MAX_SHAPES} vertices and shapes, including those of arrays"),
            );
        }
        self.count <= MAX_SHAPES
    }

    /// Adds an object to the scene.
    pub fn add(&mut self, node: ObjectKind, material: u32, span: Span) {
        let object = Object { node, material: Some(material), span };
        self.scene.root.get_or_insert_default().objects.push(object);
    }

    /// Converts the mist around the camera to fog, because rays from the camera do not know that
    /// they start inside a body.
    fn mist_to_fog(&mut self) {
        let Some(eye) = self.scene.camera.as_ref().map(|camera| camera.pose().center) else { return };
        for (number, fog) in std::mem::take(&mut self.mist_fog) {
            let Some(body) = self.bodies.get(&number) else { continue };
            let [min, max] = body.bounds();
            if self.scene.fog.is_some() || eye.cmplt(min).any() || eye.cmpgt(max).any() {
                continue;
            }
            let span = body.at;
            self.report.unsupported_once(
                span,
                "the mist around the camera fills the bounding box of its shape, and attenuates all colours equally",
            );
            self.bodies.remove(&number);
            self.scene.fog = Some(Spanned { value: Fog { min: Some(min), max: Some(max), ..fog }, span });
        }
    }

    /// Completes the scene and returns it.
    pub fn finish(mut self) -> Scene {
        self.mist_to_fog();
        for (material, body) in std::mem::take(&mut self.bodies) {
            let (name, span) = (format!("{}#{material}", self.input.name), body.at);
            let node = self.scene.add_mesh(&name, Arc::new(body.finish()), span);
            self.add(node, material, span);
        }
        self.surround();
        super::unused_materials::remove_unused(&mut self.scene);
        self.scene
    }
}
