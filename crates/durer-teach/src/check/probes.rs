//! A coarse grid of camera rays, traced with all terms of their light. It is the input of the
//! checks.

use durer_diag::{Diagnostic, Files, Span};
use durer_formats::course::place;
use durer_formats::{SceneFormat, scene_format_for};
use durer_render::integrator::trace::{TermKind, TraceNode};
use durer_render::integrator::{IntegratorKind, RenderSettings, Tree};
use durer_render::render::explain::{SceneNames, explain_ray};
use durer_render::render::{Job, center_ray, raster};
use durer_render::world::{Material, World};
use durer_scene::camera::Raster;
use durer_scene::dialect::Dialect;
use durer_scene::material::Pattern as _;
use durer_scene::math::{Color, Ray};
use durer_scene::sampler::SampleId;
use durer_scene::scene::Scene;
use rayon::prelude::*;

/// Number of rays along the larger side of the picture. It is reduced if there are many lights
/// because each hit evaluates every light.
const RAYS: u32 = 48;
const MIN_RAYS: u32 = 6;
const MAX_LIGHT_EVALUATIONS: u32 = 1 << 20;
/// Maximum depth and minimum throughput of secondary rays.
const BOUNCES: u32 = 4;
const MIN_WEIGHT: f32 = 1.0 / 64.0;

/// A compiled scene to be checked, with its source, its dialect and the options of the render.
#[derive(Clone, Copy, Debug)]
pub struct CheckInput<'a> {
    /// The parsed scene.
    pub scene: &'a Scene,
    /// The compiled scene.
    pub world: &'a World,
    /// Dialect of the scene file.
    pub dialect: Dialect,
    /// The files that were read.
    pub files: &'a Files,
    /// Options of the render.
    pub job: &'a Job,
    /// Factor by which colours are multiplied before they are displayed.
    pub exposure: f32,
    /// Column, row and index of a sample that is known to be NaN or infinite, if there is one.
    pub rejected: Option<(u32, u32, u32)>,
}

/// A camera ray that the checks trace, with its colour and its first hit.
#[derive(Clone, Debug)]
pub(super) struct Probe {
    /// Pixel that the ray passes through.
    pub pixel: (u32, u32),
    pub ray: Ray,
    pub color: Color,
    pub hit: Option<ProbeHit>,
    /// Objects that the ray reaches after a reflection or a refraction.
    pub indirect: Vec<u32>,
}

/// First surface that a probe's camera ray hits, and the light at that point.
#[derive(Clone, Debug)]
pub(super) struct ProbeHit {
    pub object: u32,
    pub material: u32,
    pub t: f32,
    pub from_behind: bool,
    /// True if the ray hit a back face that is not shaded.
    pub unshaded_back: bool,
    pub has_uv: bool,
    /// Contribution of the ambient light.
    pub ambient: Color,
    pub lights: Vec<LightContribution>,
}

/// Contribution of one light at a probe's hit, and the object that occludes the light.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightContribution {
    pub light: usize,
    /// N·L (`cosine`), and the light that would arrive without occlusion (`unoccluded`).
    pub cosine: f32,
    pub unoccluded: Color,
    /// First object that occludes the light, if there is one.
    pub blocker: Option<u32>,
    /// Contribution of the light to the pixel's colour.
    pub contribution: Color,
}

/// A scene to be checked, and the results of a coarse grid of camera rays.
#[derive(Debug)]
pub struct ProbeGrid<'a> {
    pub(super) input: CheckInput<'a>,
    pub(super) raster: Raster,
    pub(super) probes: Vec<Probe>,
}

impl<'a> ProbeGrid<'a> {
    /// Traces the probes of a scene.
    pub(super) fn new(input: &CheckInput<'a>) -> Self {
        let Job { width, height, settings, .. } = *input.job;
        let larger = width.max(height);
        let lights = input.world.lights().len().max(1) as u32;
        let rays = (MIN_RAYS..RAYS)
            .take_while(|rays| rays * rays * lights <= MAX_LIGHT_EVALUATIONS)
            .last()
            .unwrap_or(MIN_RAYS)
            + 1;
        let [columns, rows] =
            [width, height].map(|side| ((u64::from(side) * u64::from(rays)).div_ceil(larger.into()) as u32).max(1));
        let raster = raster(input.world, columns, rows);
        let job = Job {
            settings: RenderSettings {
                bounces: settings.bounces.min(BOUNCES),
                min_weight: settings.min_weight.max(MIN_WEIGHT),
                ..settings
            },
            // The checks use the terms of Whitted's method.
            method: IntegratorKind::WHITTED,
            ..input.job.clone()
        };
        let pixels: Vec<(u32, u32)> = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).collect();
        let probe = |&place: &(u32, u32)| {
            let ray = super::visibility::past_hidden_backs(input, center_ray(input.world, &raster, place)?);
            let at =
                |i: u32, of: u32, size: u32| ((2 * u64::from(i) + 1) * u64::from(size) / (2 * u64::from(of))) as u32;
            let pixel = (at(place.0, columns, width), at(place.1, rows, height));
            Some(Probe::of(pixel, ray, &explain_ray(input.world, &job, &ray, SampleId::default())?))
        };
        let probes = pixels.par_iter().filter_map(probe).collect();
        ProbeGrid { input: *input, raster, probes }
    }

    /// Returns the larger side of the picture in pixels.
    pub(super) fn larger_side(&self) -> f32 {
        self.input.job.width.max(self.input.job.height) as f32
    }

    /// Returns the compiled scene.
    pub(super) fn world(&self) -> &'a World {
        self.input.world
    }

    /// Iterates over the rays that hit something.
    pub(super) fn hits(&self) -> impl Iterator<Item = (&Probe, &ProbeHit)> {
        self.probes.iter().filter_map(|probe| Some((probe, probe.hit.as_ref()?)))
    }

    /// Returns, for each material, the number of rays that hit it, either directly or as part of a
    /// mix.
    pub(super) fn count_rays(&self) -> Vec<usize> {
        let materials = self.world().materials();
        let (mut direct, mut all) = (vec![0; materials.len()], vec![0; materials.len()]);
        self.hits().for_each(|(_, hit)| direct[hit.material as usize] += 1);
        for (whole, count) in direct.iter().enumerate().filter(|(_, count)| **count > 0) {
            // A part is counted once even if it occurs several times in the mix.
            let (mut parts, mut known) = (vec![whole], vec![false; materials.len()]);
            while let Some(part) = parts.pop() {
                if std::mem::replace(&mut known[part], true) {
                    continue;
                }
                all[part] += count;
                if let Material::Mix(solid, ..) = &materials[part] {
                    parts.extend(solid.materials().map(|inner| inner as usize));
                }
            }
        }
        all
    }

    /// Returns true if the job uses path tracing.
    pub(super) fn is_physical(&self) -> bool {
        self.input.job.method.path_options().is_some()
    }

    /// Returns the format of the scene file if it is a model and not in the scene language.
    pub(super) fn model_format(&self) -> Option<&'static SceneFormat> {
        self.input.files.name(0).and_then(scene_format_for)
    }

    /// Returns true if an object is transparent.
    pub(super) fn is_glass(&self, object: u32) -> bool {
        let world = self.world();
        let phong =
            |material: &Material| matches!(material, Material::Phong(phong) if phong.transparent.max_element() > 0.0);
        world.materials().get(world.objects()[object as usize].material as usize).is_some_and(phong)
    }

    /// Returns the way in which messages name the scene's objects and materials.
    pub(super) fn names(&self) -> SceneNames<'a> {
        SceneNames { files: self.input.files, scene: self.input.scene, world: self.input.world }
    }

    /// Names an object by its keyword and line. An object of a model is named by its own name and
    /// position. If the object comes from another file than the scene, that file is named too.
    pub(super) fn object(&self, number: u32) -> String {
        let (span, files) = (self.object_span(number), self.input.files);
        let (line, column) = files.position(span).unwrap_or_default();
        let file = files.name(span.file).filter(|_| span.file != 0);
        // Lines of a binary file have no meaning.
        let is_binary = files.bytes(span.file).is_some_and(|bytes| bytes.contains(&0));
        match (self.names().name_without_keyword(number), file) {
            (Some(name), _) if is_binary => name,
            (Some(name), None) => format!("{name} at {line}:{column}"),
            (Some(name), Some(file)) => format!("{name} at {file}:{line}:{column}"),
            (None, None) => format!("`{}` of line {line}", self.text(span)),
            (None, Some(file)) => format!("`{}` of line {line} of `{file}`", self.text(span)),
        }
    }

    /// Returns the span of an object in the scene file.
    pub(super) fn object_span(&self, number: u32) -> Span {
        self.world().objects()[number as usize].span
    }

    /// Returns a keyword as it is written in the grammar that the scene uses, which is either the
    /// course's first grammar or the node grammar.
    pub(super) fn keyword_of_grammar(&self, classic: &'static str, nodes: &'static str) -> &'static str {
        if self.input.dialect == Dialect::F23 { nodes } else { classic }
    }

    /// Returns the text in a span.
    pub(super) fn text(&self, span: Span) -> String {
        let bytes = self.input.files.bytes(span.file).and_then(|b| b.get(span.start as usize..span.end as usize));
        String::from_utf8_lossy(bytes.unwrap_or_default()).into_owned()
    }

    /// Returns the span of a field's value in the block that starts at `block`. The first of
    /// `fields` that is present counts.
    pub(super) fn field_span(&self, block: Span, fields: &[&str]) -> Option<Span> {
        let bytes = self.input.files.bytes(block.file)?;
        fields.iter().find_map(|field| place::value(bytes, block, field))
    }

    /// Places a diagnostic at a field's value, or at the block's keyword if the field is not
    /// present.
    pub(super) fn at_value(&self, diagnostic: Diagnostic, block: Span, fields: &[&str]) -> Diagnostic {
        diagnostic.at(self.field_span(block, fields).unwrap_or(block))
    }
}

impl ProbeHit {
    /// Returns the contribution of the light with the given index.
    pub fn contribution(&self, light: usize) -> Option<&LightContribution> {
        self.lights.get(light).filter(|lit| lit.light == light)
    }
}

/// Adds the objects that the rays of a term hit.
fn add_hits(term: &TraceNode, objects: &mut Vec<u32>) {
    if let TermKind::Ray { hit: Some(hit), .. } = &term.kind {
        objects.push(hit.object);
    }
    term.terms.iter().for_each(|inner| add_hits(inner, objects));
}

impl Probe {
    fn of(pixel: (u32, u32), ray: Ray, tree: &Tree) -> Self {
        let mut probe = Probe { pixel, ray, color: tree.sum(), hit: None, indirect: Vec::new() };
        tree.root.terms.iter().for_each(|term| add_hits(term, &mut probe.indirect));
        let TermKind::Ray { hit: Some(hit), .. } = &tree.root.kind else { return probe };
        let mut seen = ProbeHit {
            object: hit.object,
            material: hit.material,
            t: hit.t,
            from_behind: hit.from_behind,
            unshaded_back: hit.black,
            has_uv: hit.uv.is_some(),
            ambient: Color::ZERO,
            lights: Vec::new(),
        };
        for term in &tree.root.terms {
            match &term.kind {
                TermKind::Ambient { .. } => seen.ambient += tree.color(term.contribution()),
                // A mix of materials has one term per light for each of its parts.
                TermKind::Light { light, to_light, shadow, .. } => {
                    let adds = tree.color(term.contribution());
                    match seen.lights.last_mut().filter(|lit| lit.light == *light) {
                        Some(lit) => lit.contribution += adds,
                        None => seen.lights.push(LightContribution {
                            light: *light,
                            cosine: hit.n.dot(*to_light),
                            unoccluded: tree.color(term.scale),
                            blocker: shadow
                                .as_ref()
                                .filter(|s| s.share.equals(0.0))
                                .and_then(|s| s.blocker)
                                .map(|b| b.0),
                            contribution: adds,
                        }),
                    }
                }
                _ => {}
            }
        }
        probe.hit = Some(seen);
        probe
    }
}
