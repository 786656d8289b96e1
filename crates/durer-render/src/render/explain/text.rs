//! Explanations as text with one line per term.

use super::derivations::derivations;
use super::numbers::{number, rgb, vector};
use super::{ErrorBound, ExplainedSample, Explanation, SampleCombination};
use crate::integrator::trace::{Bounce, HitRecord, RayKind, RayRecord, Shadow, TermKind, TermValue};
use crate::integrator::{TraceNode, Tree};
use crate::world::emitters::LightId;
use crate::world::{Geometry, Material, World};
use durer_diag::{Files, Span};
use durer_image::Transfer;
use durer_scene::describe::DescribedKind;
use durer_scene::math::{Color, LUMINANCE, Vec3, reflect};
use durer_scene::scene::Scene;
use durer_scene::spectrum::{Lanes, Spectrum};

/// Finds the names of objects, materials and lights and their positions in the scene file, for use
/// in explanations.
#[derive(Clone, Copy, Debug)]
pub struct SceneNames<'a> {
    /// Files that have been read.
    pub files: &'a Files,
    /// Scene as it is written in the file.
    pub scene: &'a Scene,
    /// World that was compiled from the scene.
    pub world: &'a World,
}

/// A line of text in the explanation of a pixel. It shows a term of the trace or a detail of a
/// term.
#[derive(Clone, Debug, PartialEq)]
pub struct TextLine {
    /// Indentation depth.
    pub depth: usize,
    /// Contribution of the term. For a path, this is its contribution to the pixel, and otherwise
    /// the contribution to its parent term. `None` for lines that add details to the line before.
    pub adds: Option<TermValue>,
    /// Colour of this contribution.
    pub color: Color,
    /// Share of the total brightness of the tree, from 0 to 1.
    pub share: f32,
    /// Text of the line.
    pub text: String,
}

/// Options for the text of an explanation, such as which terms to omit and how to show eight-bit
/// values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExplainOptions {
    /// Minimum share of the total brightness. Terms with a smaller share are omitted.
    pub min_share: f32,
    /// Maximum depth of terms. Deeper terms are omitted.
    pub max_depth: usize,
    /// Transfer curve for the eight-bit colour.
    pub transfer: Transfer,
}

impl TextLine {
    /// Creates a line that has no contribution.
    fn plain(depth: usize, text: String) -> Self {
        TextLine { depth, adds: None, color: Color::ZERO, share: 0.0, text }
    }
}

impl Default for ExplainOptions {
    /// Returns options with which nothing is omitted.
    fn default() -> Self {
        ExplainOptions { min_share: 0.0, max_depth: usize::MAX, transfer: Transfer::default() }
    }
}

/// Data from the nodes above a trace node that is needed for its text, such as the enclosing ray.
#[derive(Clone, Copy)]
struct Context<'a> {
    /// Trace that the node belongs to.
    tree: &'a Tree,
    /// Factor by which the node's contribution is multiplied in the total.
    gain: TermValue,
    /// Brightness of the whole tree.
    total: f32,
    /// Direction of the enclosing ray.
    dir: Vec3,
    /// Normal at the hit of the enclosing ray.
    n: Vec3,
    /// Direction to the enclosing light.
    to_light: Vec3,
    /// Material at the hit of the enclosing ray.
    material: Option<u32>,
    /// Fresnel reflectance at that hit.
    fresnel: Option<f32>,
}

fn brightness(color: Color) -> f32 {
    color.dot(LUMINANCE)
}

impl SceneNames<'_> {
    /// Returns the file name, line and column of a span.
    fn place(&self, span: Span) -> String {
        let name = self.files.name(span.file).unwrap_or("?");
        match self.files.position(span) {
            Some((line, column)) => format!("{name}:{line}:{column}"),
            None => name.to_string(),
        }
    }

    /// Returns lines that derive the numbers in a term. `dir` is the direction of the ray that the
    /// term belongs to, and `n` is the normal at the hit of that ray.
    pub fn origins(&self, node: &TraceNode, dir: Vec3, n: Vec3) -> Vec<String> {
        derivations(node, (self.scene, self.world), dir, n)
    }

    /// Returns the line number of a span, or its full position if it is not in the same file as the
    /// camera.
    fn line(&self, span: Span) -> String {
        let scene = self.scene.camera_span.file;
        match self.files.position(span) {
            Some((line, _)) if span.file == scene => format!("of line {line}"),
            _ => self.place(span),
        }
    }

    /// Returns the text in a span.
    fn word(&self, span: Span) -> String {
        let bytes = self.files.bytes(span.file).and_then(|b| b.get(span.start as usize..span.end as usize));
        String::from_utf8_lossy(bytes.unwrap_or(b"object")).into_owned()
    }

    /// Describes an object that has no keyword in the scene file, as in JSON, by its kind and its
    /// name if it has one. Returns `None` if the object has a keyword.
    pub fn name_without_keyword(&self, object: u32) -> Option<String> {
        let object = &self.world.objects()[object as usize];
        let kind = match &object.geometry {
            Geometry::Primitive(shape) => shape.keywords()[0].0,
            Geometry::Mesh(_) => "mesh",
            Geometry::Solid(_) => "solid",
        };
        let word = self.word(object.span);
        match word.strip_prefix('"').and_then(|name| name.strip_suffix('"')) {
            Some(name) => Some(format!("{kind} `{name}`")),
            None => ["", "{"].contains(&word.as_str()).then(|| kind.into()),
        }
    }

    /// Returns the keyword or kind of an object and its span.
    fn keyword(&self, object: u32) -> (String, Span) {
        let span = self.world.objects()[object as usize].span;
        (self.name_without_keyword(object).unwrap_or_else(|| self.word(span)), span)
    }

    /// Describes an object by its keyword and line number.
    pub fn short_object(&self, number: u32) -> String {
        let (keyword, span) = self.keyword(number);
        format!("{keyword} {}", self.line(span))
    }

    /// Describes a material by its index and line number.
    fn short_material(&self, number: u32) -> String {
        match self.scene.materials.get(number as usize) {
            Some(material) => format!("material {number} {}", self.line(material.span)),
            None => "plain grey".into(),
        }
    }

    /// Describes a light by its keyword and line number.
    fn short_light(&self, number: usize) -> String {
        match self.scene.lights.iter().flatten().nth(number) {
            Some(light) => format!("{} {}", light.value.keywords()[0].0, self.line(light.span)),
            None => format!("light {number}"),
        }
    }

    /// Describes an emitter and the line that defines it.
    fn emitter(&self, light: LightId) -> String {
        match light {
            LightId::Light(number) => self.short_light(number as usize),
            LightId::Surface(object, _) => self.short_object(object),
            LightId::Environment => "the environment".into(),
        }
    }

    /// Describes an object by its keyword and its position in the file.
    pub fn object(&self, number: u32) -> String {
        let (keyword, span) = self.keyword(number);
        format!("{keyword} {}", self.place(span))
    }

    /// Describes a material by its index and its position in the file.
    pub fn material(&self, number: u32) -> String {
        match self.scene.materials.get(number as usize) {
            Some(material) => format!("material {number} {}", self.place(material.span)),
            None => "plain grey".into(),
        }
    }

    /// Describes a light by its keyword and its position in the file.
    pub fn light(&self, number: usize) -> String {
        match self.scene.lights.iter().flatten().nth(number) {
            Some(light) => format!("{} {}", light.value.keywords()[0].0, self.place(light.span)),
            None => format!("light {number}"),
        }
    }
}

impl Explanation {
    /// Returns the explanation as lines of text. The lines show the pixel, its samples, and the
    /// tree of the sample with the index `wanted`.
    pub fn lines(&self, names: &SceneNames, wanted: usize, options: &ExplainOptions) -> Vec<TextLine> {
        let mut lines = Vec::new();
        let mut push_line = |depth, text: String| lines.push(TextLine::plain(depth, text));
        let [r, g, b] = options.transfer.encode_pixel(self.color);
        let curve = options.transfer.name();
        push_line(0, format!("pixel {},{} = {}, in eight bits {r} {g} {b} ({curve})", self.x, self.y, rgb(self.color)));
        if self.coverage < 1.0 {
            push_line(1, format!("coverage {:.1} %", 100.0 * self.coverage));
        }
        let all = self.samples.len();
        if all > 1 {
            let sum: f64 = self.samples.iter().map(|s| f64::from(s.weight)).sum();
            let of = match &self.mean {
                SampleCombination::Own => String::new(),
                SampleCombination::Neighbors => ", including samples of neighbouring pixels".into(),
                SampleCombination::SubPixels(_) => ": subpixels, blurred and averaged as the 2012 program does".into(),
            };
            push_line(1, format!("weighted mean of {all} samples{of}; the weights sum to {}", sum as f32));
        }
        if let Some(error) = &self.error {
            let ErrorBound { luminance, bias, standard_error, bound } = *error;
            let [luminance, bias, standard_error, bound] =
                [luminance, bias, standard_error, bound].map(|value| number(value as f32));
            let parts = match error.bias {
                0.0 => format!("standard error {standard_error}"),
                _ => format!("photon bias {bias}, standard error {standard_error}"),
            };
            push_line(1, format!("luminance {luminance}, error at most {bound} with 90 % confidence: {parts}"));
        }
        if let Some(stale) = self.stale_texels {
            push_line(1, format!("plus {} from the quirk `stale-texels`", rgb(stale)));
        }
        let nothing = |i: usize| i != wanted && self.samples[i].weight == 0.0 && self.mean != SampleCombination::Own;
        for (i, sample) in self.samples.iter().enumerate().filter(|(i, _)| !nothing(*i)) {
            sample_lines(sample, self.number(i), names, (i == wanted).then_some(options), &mut lines);
        }
        match (0..all).filter(|&i| nothing(i)).count() {
            0 => {}
            left => {
                let text = format!("{left} more samples have no weight in this pixel");
                lines.push(TextLine::plain(1, text));
            }
        }
        lines
    }

    /// Describes a sample by its index, and also by its pixel if the samples belong to several
    /// pixels.
    fn number(&self, index: usize) -> String {
        let ExplainedSample { of: (x, y), sample, .. } = self.samples[index];
        match self.mean {
            SampleCombination::Own => format!("sample {sample}"),
            _ => format!("sample {index} (number {sample} of pixel {x},{y})"),
        }
    }
}

/// Appends the line of a sample and, if `tree_options` is given, its tree.
fn sample_lines(
    sample: &ExplainedSample,
    name: String,
    names: &SceneNames,
    tree_options: Option<&ExplainOptions>,
    lines: &mut Vec<TextLine>,
) {
    let ExplainedSample { place, weight, light, backdrop, .. } = sample;
    let color_text = match (light, backdrop) {
        (Some(light), _) => rgb(light.sum()),
        (None, Some(backdrop)) => format!("{}, the background's colour, because nothing is hit here", rgb(*backdrop)),
        (None, None) => "the camera sees nothing here".into(),
    };
    let text = format!("{name} at {}, {}, weight {}: {color_text}", place.x, place.y, number(*weight));
    lines.push(TextLine::plain(1, text));
    if let (Some(light), Some(options)) = (light, tree_options) {
        tree_lines(light, names, 2, options, lines);
    }
}

/// Returns the trace of a ray as lines of text.
pub fn ray_text(light: &Tree, names: &SceneNames, options: &ExplainOptions) -> Vec<TextLine> {
    let mut lines = Vec::new();
    tree_lines(light, names, 0, options, &mut lines);
    lines
}

/// Appends the lines of a tree.
fn tree_lines(tree: &Tree, names: &SceneNames, depth: usize, options: &ExplainOptions, lines: &mut Vec<TextLine>) {
    if let Lanes::Wavelengths(waves) = &tree.lanes {
        let list = |numbers: Spectrum| numbers.to_array().map(number).join(", ");
        let text = format!("light at {} nm; converted to RGB", list(waves.nm));
        lines.push(TextLine::plain(depth, text));
        for (name, observer) in ["red", "green", "blue"].into_iter().zip(waves.observer()) {
            lines.push(TextLine::plain(depth + 1, format!("{name}: ({}) · light", list(*observer))));
        }
    }
    node_lines(&tree.root, names, depth, options, Context::of(tree), lines);
}

impl<'a> Context<'a> {
    fn of(tree: &'a Tree) -> Self {
        let (dir, n, to_light) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
        let total = brightness(tree.sum()).max(f32::MIN_POSITIVE);
        let gain = TermValue::Color(Color::ONE);
        Context { tree, gain, total, dir, n, to_light, material: None, fresnel: None }
    }
}

/// Appends the lines of a node and of all terms below it.
fn node_lines(
    node: &TraceNode,
    names: &SceneNames,
    depth: usize,
    options: &ExplainOptions,
    at: Context,
    lines: &mut Vec<TextLine>,
) {
    let (factor, value) = (numbers(node.factor), numbers(node.value));
    let mut more = Vec::new();
    let mut below = Context { gain: at.gain * node.factor * node.scale, ..at };
    let text = match &node.kind {
        TermKind::Ray { from, ray, weight, hit, bounce } => {
            below.dir = ray.dir;
            let from = match from {
                RayKind::Camera => "camera ray",
                RayKind::Reflected => "mirrored ray",
                RayKind::Transmitted => "transmitted ray",
                RayKind::Scattered => "scattered ray",
            };
            more.extend(bounce.iter().map(bounce_line));
            more.push(ray_line(ray));
            match hit {
                Some(hit) => {
                    (below.n, below.material) = (hit.n, Some(hit.material));
                    more.extend(struck_lines(hit, names));
                    more.extend(names.origins(node, ray.dir, hit.n));
                }
                None => more.push("no hit".into()),
            }
            match from {
                "camera ray" => format!("{from}: {value}"),
                _ => {
                    format!(
                        "{from}, weight {} in the pixel: {} · {value}",
                        number(*weight),
                        split(node, from, &at, names)
                    )
                }
            }
        }
        TermKind::Photons { radius, photons } => {
            more.push(format!("{photons} photons at most {} away", number(*radius)));
            format!("caustics: {value}")
        }
        TermKind::Dispersion { nm } => {
            format!(
                "dispersion: only {} nm continues and stands for all four wavelengths: {factor} · {value}",
                number(*nm)
            )
        }
        TermKind::Sky => {
            more.extend(names.origins(node, at.dir, at.n));
            if node.throughput.is_some() { format!("background: {value}") } else { "background".into() }
        }
        TermKind::Emission { mis } => format!("emission: {value}{}", weight_text(*mis)),
        TermKind::Direct { light, to_light, distance, choice, pdf, bsdf, mis, shadow } => {
            more.push(format!("L = {}, {} away", vector(*to_light), number(*distance)));
            more.push(format!(
                "surface: value · cos = {}; chosen with probability {}{}",
                numbers(*bsdf),
                number(*choice),
                if *pdf > 0.0 { format!(" and density {} /sr", number(*pdf)) } else { String::new() }
            ));
            more.extend(shadow.iter().map(|shadow| shadow_line(shadow, names)));
            format!("direct light of {}: {factor} · {value}{}", names.emitter(*light), weight_text(*mis))
        }
        TermKind::Ambient { share } => {
            format!("ambient{}: light {factor} · colour {value}", share_text(*share))
        }
        TermKind::Light { light, to_light, distance, share, shadow } => {
            below.to_light = *to_light;
            more.push(format!(
                "L = {}, {} away; {} arrives",
                vector(*to_light),
                number(*distance),
                numbers(node.scale)
            ));
            more.extend(shadow.iter().map(|shadow| shadow_line(shadow, names)));
            let through = if node.factor.equals(1.0) { String::new() } else { format!("{factor} · ") };
            let sum = if node.terms.is_empty() { value } else { format!("(sum below) · {}", numbers(node.scale)) };
            format!("{}{}: {through}{sum}", names.short_light(*light), share_text(*share))
        }
        TermKind::Diffuse { cosine } => format!("diffuse: max(0, N·L = {}) · {value}", number(*cosine)),
        TermKind::Highlight { model, base, exponent } => {
            more.push(match *model {
                "N·H" => format!("H = norm(L + V) = {}", vector((at.to_light - at.dir).normalize_or_zero())),
                _ => format!("R = d - 2 (d·N) N = {}", vector(reflect(at.dir, at.n))),
            });
            let (base, exponent, strength) = (number(*base), number(*exponent), number(node.factor.numbers()[0]));
            format!("highlight: max(0, {model} = {base})^{exponent} = {strength} · {value}")
        }
        TermKind::Secondary { here, there, fresnel, total } => {
            below.fresnel = *fresnel;
            more.extend(names.origins(node, at.dir, at.n));
            let mut text = match here == there && fresnel.is_none() {
                true => "mirrored light".to_string(),
                false => {
                    format!("mirrored and transmitted light, from index {} to {}", number(*here), number(*there))
                }
            };
            if let Some(share) = fresnel {
                text += &format!("; Fresnel reflectance {}", number(*share));
            }
            if *total {
                text += "; total internal reflection, beyond the critical angle";
            }
            text
        }
        TermKind::BelowMinWeight { weight } => {
            format!("a ray with throughput {} is not traced (--min-throughput)", number(*weight))
        }
        TermKind::DepthLimit => {
            "mirrored and transmitted light is left out: the maximum depth is reached (--bounces)".into()
        }
    };
    let of_whole = |node: &TraceNode, gain| {
        let added = node.path_contribution().unwrap_or_else(|| gain * node.contribution());
        brightness(at.tree.color(added)) / at.total
    };
    let adds = node.path_contribution().unwrap_or_else(|| node.contribution());
    let color = at.tree.color(adds);
    lines.push(TextLine { depth, adds: Some(adds), color, share: of_whole(node, at.gain), text });
    let mut report = |text: String| lines.push(TextLine::plain(depth + 1, text));
    more.into_iter().for_each(&mut report);
    if depth >= options.max_depth && !node.terms.is_empty() {
        return report(format!("{} below (--depth)", terms(node.terms.len())));
    }
    let small = |term: &&TraceNode| of_whole(term, below.gain).abs() < options.min_share;
    let left = node.terms.iter().filter(small).count();
    for term in node.terms.iter().filter(|term| !small(term)) {
        node_lines(term, names, depth + 1, options, below, lines);
    }
    if left > 0 {
        let text = format!("{} of less than {} % each (--min)", terms(left), number(100.0 * options.min_share));
        lines.push(TextLine::plain(depth + 1, text));
    }
}

/// Describes how the direction of a ray was chosen.
fn bounce_line(bounce: &Bounce) -> String {
    let Bounce { lobe, probability, pdf, survival, directions } = bounce;
    let density = if *pdf > 0.0 { format!(", density {} /sr", number(*pdf)) } else { String::new() };
    let survived =
        if *survival < 1.0 { format!("; survived with probability {}", number(*survival)) } else { String::new() };
    let shared =
        if *directions > 1 { format!("; one of {directions} directions with equal weights") } else { String::new() };
    format!("chosen by {lobe} (probability {}){density}{survived}{shared}", number(*probability))
}

/// Describes an MIS weight if it is not 1.
fn weight_text(mis: f32) -> String {
    if mis == 1.0 { String::new() } else { format!(" (MIS weight {})", number(mis)) }
}

fn terms(count: usize) -> String {
    if count == 1 { "1 term".into() } else { format!("{count} terms") }
}

/// Describes the factor of a secondary ray. If Fresnel's equations divide the light, the factor is
/// the material's colour times the Fresnel factor.
fn split(node: &TraceNode, from: &str, at: &Context, names: &SceneNames) -> String {
    let phong = at.material.and_then(|i| names.world.materials().get(i as usize));
    match (at.fresnel, phong) {
        (Some(r), Some(Material::Phong(phong))) if from == "mirrored ray" => {
            format!("`specularColor` {} · {}", rgb(phong.reflective), number(r))
        }
        (Some(r), Some(Material::Phong(phong))) => {
            format!("colour {} · (1 - {})", rgb(phong.transparent), number(r))
        }
        _ => numbers(node.factor),
    }
}

/// Describes what a ray hits.
fn struck_lines(hit: &HitRecord, names: &SceneNames) -> Vec<String> {
    let (object, t) = (names.short_object(hit.object), number(hit.t));
    let mut lines = vec![format!("hits {object} at t = {t}, point {}", vector(hit.position))];
    if hit.barycentric != Vec3::ZERO {
        // See `inset` in `durer_scene::shape::triangle`.
        let is_at_edge = hit.barycentric.min_element() < 1e-5;
        let edge = if is_at_edge { "; the point is kept a few roundings away from the edge" } else { "" };
        lines.push(format!("triangle {}, barycentric {}{edge}", hit.part, vector(hit.barycentric)));
    }
    if let Some(uv) = hit.uv {
        lines.push(format!("uv ({}, {})", number(uv.x), number(uv.y)));
    }
    if let Some(local) = &hit.local {
        lines.push(format!("in object space: {}", ray_line(local)));
    }
    let mut normal = format!("N = {}", vector(hit.n));
    if hit.n_geo != hit.n {
        normal += &format!("; geometric normal {}", vector(hit.n_geo));
    }
    if hit.from_behind {
        normal += if hit.black {
            "; seen from behind, left black"
        } else if hit.n != hit.n_shade {
            "; seen from behind, so it is flipped"
        } else {
            "; seen from behind"
        };
    }
    lines.push(normal);
    lines.push(names.short_material(hit.material));
    lines
}

/// Describes what a shadow ray hits.
fn shadow_line(shadow: &Shadow, names: &SceneNames) -> String {
    let Some((object, t)) = shadow.blocker else { return "the shadow ray is unoccluded".into() };
    let (object, t) = (names.short_object(object), number(t));
    match shadow.share {
        share if share.equals(0.0) => format!("occluded by {object}, {t} away"),
        share if share.equals(1.0) && names.world.shading_rules().shadow_fronts => {
            format!(
                "{object} is {t} away, but does not block the light: the shadow ray hits its back (quirk \
                 `shadow-fronts`)"
            )
        }
        share if share.equals(1.0) => {
            format!("{object} is {t} away, but does not block the light: it transmits all of it")
        }
        share => format!("{object}, {t} away, transmits {}", numbers(share)),
    }
}

fn share_text(share: f32) -> String {
    if share == 1.0 { String::new() } else { format!(", material weight {}", number(share)) }
}

fn ray_line(ray: &RayRecord) -> String {
    format!("{} + t {}", vector(ray.origin), vector(ray.dir))
}

fn numbers(value: TermValue) -> String {
    format!("({})", value.numbers().iter().map(|x| number(*x)).collect::<Vec<_>>().join(", "))
}
