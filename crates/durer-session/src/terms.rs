//! Explanation of the radiance of a pixel as a tree of terms, each with its formula and numbers.

use crate::document::NamedScene;
use crate::protocol::{FormulaRow, PixelExplanation, Segment, SegmentKind, Term};
use crate::rows::{factor, number, row, vector, vector_row};
use durer::diag::Span;
use durer::image::Transfer;
use durer::integrator::trace::{HitRecord, RayKind, RayRecord, Shadow, TermKind, TermValue};
use durer::integrator::{TraceNode, Tree};
use durer::math::{Color, LUMINANCE, Vec2, Vec3};
use durer::render::Job;
use durer::render::explain::Explanation;
use durer::world::World;
use durer::world::emitters::LightId;

/// Explains a pixel through one of its samples. If `sample` is `None`, the sample with the largest
/// contribution is used.
pub(crate) fn explain(
    scene: NamedScene,
    job: &Job,
    explanation: &Explanation,
    sample: Option<u32>,
    transfer: Transfer,
) -> PixelExplanation {
    let chosen = sample.map_or(explanation.max_weight_index(), |sample| sample as usize);
    let chosen = chosen.min(explanation.samples.len().saturating_sub(1));
    let weights: f32 = explanation.samples.iter().map(|sample| sample.weight).sum();
    let sample = explanation.samples.get(chosen);
    let light = sample.and_then(|sample| sample.light.as_ref());
    let at = sample.map_or(Vec2::ZERO, |sample| sample.place);
    let tree = light.map(|light| {
        let mut term = tree_terms(scene, light, transfer);
        let mut rows = camera_rows(scene.world(), job, at);
        rows.append(&mut term.rows);
        term.rows = rows;
        term
    });
    PixelExplanation {
        x: explanation.x,
        y: explanation.y,
        color: explanation.color.into(),
        bytes: transfer.encode_pixel(explanation.color),
        samples: explanation.samples.len() as u32,
        sample: chosen as u32,
        at: at.into(),
        weight: sample.map_or(0.0, |sample| sample.weight / weights),
        tree,
    }
}

/// Returns the terms of the light along a ray.
pub(crate) fn tree_terms(scene: NamedScene, tree: &Tree, transfer: Transfer) -> Term {
    let formatter = TermFormatter { scene, tree, pixel_luminance: tree.sum().dot(LUMINANCE), transfer };
    formatter.term(&tree.root, TermValue::Color(Color::ONE), &TermContext::default())
}

/// Returns the formulas of the camera ray through a position in the picture.
fn camera_rows(world: &World, job: &Job, place: Vec2) -> Vec<FormulaRow> {
    let raster = durer::render::raster(world, job.width, job.height);
    let (point, frame) = (raster.point(place), world.camera_frame());
    let mut rows = vec![FormulaRow {
        name: "(x, y)".into(),
        formula: "position in the picture, from −1 to 1 along its larger side".into(),
        numbers: format!("pixel position ({}, {})", number(place.x.into()), number(place.y.into())),
        result: format!("({}, {})", number(point.x.into()), number(point.y.into())),
        value: None,
    }];
    if matches!(world.camera(), durer::camera::Camera::Perspective(_)) {
        let distance = 1.0 / frame.half_width;
        rows.push(row("D", "1 / tan(angle / 2)", format!("1 / {}", number(frame.half_width)), distance));
        let (w, u, v) = (frame.forward.as_dvec3(), frame.right.as_dvec3(), frame.up.as_dvec3());
        let (x, y) = (f64::from(point.x), f64::from(point.y));
        let numbers =
            format!("{} {} + {} {} + {} {}", number(distance), vector(w), factor(x), vector(u), factor(y), vector(v));
        rows.push(vector_row("d", "D w + x u + y v", numbers, distance * w + x * u + y * v));
    }
    rows
}

/// Vectors from the enclosing terms that the formulas of a term use.
#[derive(Clone, Default)]
struct TermContext {
    dir: Vec3,
    n: Vec3,
    to_light: Vec3,
}

/// Converter from the trace of a pixel sample to the tree of [`Term`]s that the page shows.
struct TermFormatter<'a> {
    scene: NamedScene<'a>,
    tree: &'a Tree,
    /// Luminance of the pixel.
    pixel_luminance: f32,
    /// Transfer curve of eight-bit colours.
    transfer: Transfer,
}

impl TermFormatter<'_> {
    fn term(&self, node: &TraceNode, gain: TermValue, around: &TermContext) -> Term {
        let inside = self.around(node, around);
        let here = gain * node.factor;
        let below = here * node.scale;
        let terms: Vec<Term> = node.terms.iter().map(|term| self.term(term, below, &inside)).collect();
        let adds = match (node.throughput, terms.is_empty()) {
            (Some(throughput), true) => self.tree.color(throughput * node.value),
            (Some(_), false) => terms.iter().map(|term| Color::from(term.adds)).sum(),
            (None, _) if self.tree.root.throughput.is_some() => terms.iter().map(|term| Color::from(term.adds)).sum(),
            (None, _) => self.tree.color(here * node.value),
        };
        let value = self.tree.color(node.value);
        let (ray, t_max) = ray_of(node);
        Term {
            title: self.title(node),
            rows: self.rows(node, around),
            value: value.into(),
            adds: adds.into(),
            share: if self.pixel_luminance > 0.0 { adds.dot(LUMINANCE) / self.pixel_luminance } else { 0.0 },
            swatch: self.transfer.encode_pixel(value),
            place: self.span(node).and_then(|span| self.scene.place(span)),
            segment: self.segment(node),
            normal: hit_of(node).map(|hit| [hit.position.into(), hit.n.into()]),
            ray: ray.map(|ray| [ray.origin.into(), ray.dir.into()]),
            t_max,
            object: hit_of(node).map(|hit| hit.object).or_else(|| blocker(node)),
            origins: self.scene.0.origins(node, around.dir, around.n),
            terms,
        }
    }

    fn around(&self, node: &TraceNode, outer: &TermContext) -> TermContext {
        match &node.kind {
            TermKind::Ray { ray, hit, .. } => {
                TermContext { dir: ray.dir, n: hit.as_ref().map_or(Vec3::ZERO, |hit| hit.n), ..TermContext::default() }
            }
            TermKind::Light { to_light, .. } => TermContext { to_light: *to_light, ..outer.clone() },
            _ => outer.clone(),
        }
    }

    fn title(&self, node: &TraceNode) -> String {
        match &node.kind {
            TermKind::Ray { from, hit, .. } => {
                let ray = match from {
                    RayKind::Camera => "Camera ray",
                    RayKind::Reflected => "Mirrored ray",
                    RayKind::Transmitted => "Transmitted ray",
                    RayKind::Scattered => "Scattered ray",
                };
                match hit {
                    Some(hit) => format!("{ray} hits {}", self.scene.0.short_object(hit.object)),
                    None => format!("{ray} hits nothing"),
                }
            }
            TermKind::Sky => "Background".into(),
            TermKind::Ambient { .. } => "Ambient light".into(),
            TermKind::Light { light, shadow, .. } => {
                let name = self.scene.light(*light);
                match shadow.as_ref().and_then(|shadow| shadow.blocker) {
                    Some((object, _)) => format!("{name}, hidden by {}", self.scene.0.short_object(object)),
                    None => name,
                }
            }
            TermKind::Diffuse { .. } => "Diffuse".into(),
            TermKind::Highlight { .. } => "Highlight".into(),
            TermKind::Secondary { total: true, .. } => "Total reflection".into(),
            TermKind::Secondary { .. } => "Mirrored and transmitted".into(),
            TermKind::BelowMinWeight { .. } => "Contribution too small to be traced".into(),
            TermKind::DepthLimit => "Maximum depth reached".into(),
            TermKind::Emission { .. } => "Emission".into(),
            TermKind::Direct { light, shadow, .. } => {
                let name = match light {
                    LightId::Light(number) => self.scene.light(*number as usize),
                    LightId::Surface(object, _) => self.scene.0.short_object(*object),
                    LightId::Environment => "the environment".into(),
                };
                match shadow.as_ref().and_then(|shadow| shadow.blocker) {
                    Some((object, _)) => format!("Light of {name}, hidden by {}", self.scene.0.short_object(object)),
                    None => format!("Light of {name}"),
                }
            }
            TermKind::Photons { photons, .. } => format!("Caustic of {photons} photons"),
            TermKind::Dispersion { nm } => format!("At {nm:.0} nm only"),
        }
    }

    fn span(&self, node: &TraceNode) -> Option<Span> {
        let world = self.scene.0.world;
        match &node.kind {
            TermKind::Ray { hit: Some(hit), .. } => world.objects().get(hit.object as usize).map(|object| object.span),
            TermKind::Light { light, .. } => self.scene.0.scene.lights.iter().flatten().nth(*light).map(|l| l.span),
            TermKind::Direct { light: LightId::Light(light), .. } => {
                self.scene.0.scene.lights.iter().flatten().nth(*light as usize).map(|light| light.span)
            }
            TermKind::Direct { light: LightId::Surface(object, _), .. } => {
                world.objects().get(*object as usize).map(|object| object.span)
            }
            TermKind::Sky => Some(self.scene.0.scene.background_span),
            _ => None,
        }
    }

    fn segment(&self, node: &TraceNode) -> Option<Segment> {
        let bounds = self.scene.0.world.bounds();
        let far = if bounds.is_empty() { 10.0 } else { bounds.size().length().max(1e-3) };
        match &node.kind {
            TermKind::Ray { from, ray, hit, .. } => {
                let role = match from {
                    RayKind::Camera => SegmentKind::Camera,
                    RayKind::Reflected => SegmentKind::Reflected,
                    RayKind::Transmitted => SegmentKind::Transmitted,
                    RayKind::Scattered => SegmentKind::Scattered,
                };
                let away = ray.origin + far * ray.dir.normalize_or_zero();
                let to = hit.as_ref().map_or(away, |hit| hit.position);
                Some(Segment { role, from: ray.origin.into(), to: to.into(), escapes: hit.is_none() })
            }
            TermKind::Light { shadow: Some(shadow), distance, .. }
            | TermKind::Direct { shadow: Some(shadow), distance, .. } => Some(shadow_segment(shadow, *distance, far)),
            _ => None,
        }
    }

    fn rows(&self, node: &TraceNode, around: &TermContext) -> Vec<FormulaRow> {
        let color = |value: TermValue| vector(self.tree.color(value));
        let mut rows = Vec::new();
        match &node.kind {
            TermKind::Ray { ray, hit, weight, bounce, from } => {
                rows.push(words("ray", &format!("o = {}, d = {}", vector(ray.origin), vector(ray.dir))));
                if *from == RayKind::Reflected && around.n != Vec3::ZERO {
                    let (d, n) = (around.dir.as_dvec3(), around.n.as_dvec3());
                    let formula = "d − 2 (d · n) n";
                    let numbers = format!("{} − 2 · {} · {}", vector(d), factor(d.dot(n)), vector(n));
                    rows.push(vector_row("r", formula, numbers, d - 2.0 * d.dot(n) * n));
                }
                if let Some(hit) = hit {
                    let numbers = format!("{} + {} {}", vector(ray.origin), number(hit.t.into()), vector(ray.dir));
                    rows.push(row("t", "least t of all objects", "", hit.t.into()));
                    rows.push(vector_row("P", "o + t d", numbers, hit.position));
                    rows.push(vector_row("n", "shading normal", "", hit.n));
                    if let Some(uv) = hit.uv {
                        rows.push(words("(u, v)", &format!("({}, {})", number(uv.x.into()), number(uv.y.into()))));
                    }
                    if hit.barycentric != Vec3::ZERO {
                        rows.push(words("triangle", &hit.part.to_string()));
                        rows.push(vector_row("(α, β, γ)", "barycentric", "", hit.barycentric));
                    }
                    if let Some(local) = &hit.local {
                        let text = format!("o = {}, d = {} in object space", vector(local.origin), vector(local.dir));
                        rows.push(words("local", &text));
                    }
                    rows.push(words("material", &self.scene.0.material(hit.material)));
                    if hit.from_behind {
                        rows.push(words("seen", if hit.black { "from behind: black" } else { "from behind" }));
                    }
                }
                if let Some(bounce) = bounce {
                    rows.push(words("lobe", bounce.lobe));
                    rows.push(row("chance", "probability of the lobe", "", bounce.probability.into()));
                    rows.push(row("p", "pdf of the direction", "", bounce.pdf.into()));
                    rows.push(row("q", "survival probability", "", bounce.survival.into()));
                    if bounce.directions > 1 {
                        rows.push(words("directions", &format!("one of {} with equal weights", bounce.directions)));
                    }
                }
                rows.push(row("weight", "weight in the pixel", "", (*weight).into()));
            }
            TermKind::Ambient { share } => {
                rows.push(words("L", &format!("k_a · ambient = {} · {}", color(node.value), color(node.factor))));
                if *share != 1.0 {
                    rows.push(row("share", "of the material at this point", "", (*share).into()));
                }
            }
            TermKind::Light { to_light, distance, shadow, .. } => {
                rows.push(vector_row("l", "unit vector to the light", "", *to_light));
                if distance.is_finite() {
                    rows.push(row("r", "distance to the light", "", (*distance).into()));
                }
                rows.push(words("arrives", &color(node.scale)));
                rows.extend(shadow.as_ref().map(|shadow| self.shadow_row(shadow)));
            }
            TermKind::Diffuse { cosine } => {
                let numbers = format!("{} · {}", vector(around.n), vector(around.to_light));
                rows.push(row("n · l", "cosine; negative values count as 0", numbers, (*cosine).into()));
                rows.push(words(
                    "L",
                    &format!("max(0, n · l) k_d = {} · {}", number(cosine.max(0.0).into()), color(node.value)),
                ));
            }
            TermKind::Highlight { model, base, exponent } => {
                let power = durer::math::fp::pow(base.max(0.0), *exponent);
                let base = *base;
                match *model {
                    "N·H" => {
                        let half = (around.to_light - around.dir.normalize_or_zero()).normalize_or_zero();
                        rows.push(vector_row("h", "(l − d) / |l − d|", "", half));
                        rows.push(row(
                            "n · h",
                            "Blinn",
                            format!("{} · {}", vector(around.n), vector(half)),
                            base.into(),
                        ));
                    }
                    _ => rows.push(row("r · l", "Phong", "", base.into())),
                }
                let numbers = format!("{}^{}", number(base.into()), number((*exponent).into()));
                rows.push(row("power", "max(0, base)^exponent", numbers, power.into()));
                rows.push(words("L", &format!("power · k_s = {} · {}", number(power.into()), color(node.value))));
            }
            TermKind::Secondary { here, there, fresnel, total } => {
                rows.push(row("η", "refractive index on this side", "", (*here).into()));
                rows.push(row("η′", "refractive index behind the surface", "", (*there).into()));
                let cosine = -around.dir.normalize_or_zero().dot(around.n);
                let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                let beyond = f64::from(sine) * f64::from(*here) / f64::from(*there);
                if here != there {
                    let numbers =
                        format!("{} · {} / {}", number((*here).into()), number(sine.into()), number((*there).into()));
                    rows.push(row("sin θ′", "η sin θ / η′ (Snell)", numbers, beyond));
                }
                if *total {
                    rows.push(words("so", "sin θ′ > 1: total reflection"));
                }
                if let Some(fresnel) = fresnel {
                    rows.push(row("R", "reflectance (Fresnel, by Schlick)", "", (*fresnel).into()));
                }
            }
            TermKind::BelowMinWeight { weight } => {
                rows.push(row("weight", "weight in the pixel", "", (*weight).into()))
            }
            TermKind::Emission { mis } => rows.push(row("MIS", "weight of BSDF sampling", "", (*mis).into())),
            TermKind::Direct { to_light, distance, choice, pdf, bsdf, mis, shadow, .. } => {
                rows.push(vector_row("ω", "direction to the light", "", *to_light));
                if distance.is_finite() {
                    rows.push(row("r", "distance to the light", "", (*distance).into()));
                }
                rows.push(words("f cos θ", &color(*bsdf)));
                rows.push(row(
                    "p",
                    "chance · density",
                    format!("{} · {}", number((*choice).into()), number((*pdf).into())),
                    f64::from(*choice) * f64::from(*pdf),
                ));
                rows.push(row("MIS", "weight of light sampling", "", (*mis).into()));
                rows.extend(shadow.as_ref().map(|shadow| self.shadow_row(shadow)));
            }
            TermKind::Photons { radius, photons } => {
                rows.push(row("radius", "search radius", "", (*radius).into()));
                rows.push(row("photons", "number within the radius", "", *photons as f64));
            }
            TermKind::Dispersion { .. } | TermKind::Sky | TermKind::DepthLimit => {}
        }
        if !node.factor.equals(1.0)
            && !matches!(node.kind, TermKind::Ambient { .. } | TermKind::Diffuse { .. } | TermKind::Highlight { .. })
        {
            rows.push(words("factor", &color(node.factor)));
        }
        if let Some(throughput) = node.throughput {
            rows.push(words("throughput", &color(throughput)));
        }
        rows
    }

    fn shadow_row(&self, shadow: &Shadow) -> FormulaRow {
        match shadow.blocker {
            Some((object, t)) => {
                let what = self.scene.0.short_object(object);
                words("shadow ray", &format!("hits {what} at t = {}: shadow", number(t.into())))
            }
            None if shadow.share.equals(1.0) => words("shadow ray", "reaches the light"),
            None => words("shadow ray", &format!("transmits {}", vector(self.tree.color(shadow.share)))),
        }
    }
}

fn words(name: &str, result: &str) -> FormulaRow {
    FormulaRow { name: name.into(), formula: String::new(), numbers: String::new(), result: result.into(), value: None }
}

fn shadow_segment(shadow: &Shadow, distance: f32, far: f32) -> Segment {
    let (origin, dir) = (shadow.ray.origin, shadow.ray.dir);
    let unit = dir.normalize_or_zero();
    match shadow.blocker {
        Some((_, t)) => {
            Segment { role: SegmentKind::Shadowed, from: origin.into(), to: (origin + t * dir).into(), escapes: false }
        }
        None => {
            let escapes = !distance.is_finite() || distance > 4.0 * far;
            let to = origin + if escapes { far } else { distance } * unit;
            Segment { role: SegmentKind::Lit, from: origin.into(), to: to.into(), escapes }
        }
    }
}

fn hit_of(node: &TraceNode) -> Option<&HitRecord> {
    match &node.kind {
        TermKind::Ray { hit, .. } => hit.as_deref(),
        _ => None,
    }
}

fn shadow_of(node: &TraceNode) -> Option<&Shadow> {
    match &node.kind {
        TermKind::Light { shadow, .. } | TermKind::Direct { shadow, .. } => shadow.as_ref(),
        _ => None,
    }
}

fn blocker(node: &TraceNode) -> Option<u32> {
    shadow_of(node)?.blocker.map(|(object, _)| object)
}

fn ray_of(node: &TraceNode) -> (Option<&RayRecord>, Option<f32>) {
    let ray = match &node.kind {
        TermKind::Ray { ray, .. } => Some(ray),
        _ => shadow_of(node).map(|shadow| &shadow.ray),
    };
    (ray, ray.map(|ray| ray.t_max).filter(|t| t.is_finite()))
}
