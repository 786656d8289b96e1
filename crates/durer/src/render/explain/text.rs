//! An explanation in words and numbers, line by line.

use super::{Explanation, Mean, SampleAccount};
use crate::describe::DescribedList;
use crate::diag::{Files, Span};
use crate::integrator::Node;
use crate::integrator::account::{Line as RayLine, RayKind, Shadow, Struck, What};
use crate::math::{Color, Vec3};
use crate::scene::Scene;
use crate::world::World;

/// What things are called, and where they are written.
#[derive(Clone, Copy, Debug)]
pub struct Names<'a> {
    /// The files that were read.
    pub files: &'a Files,
    /// The scene as written.
    pub scene: &'a Scene,
    /// The same, compiled.
    pub world: &'a World,
}

/// A line of an explanation.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// How deep it is indented.
    pub depth: usize,
    /// What the term adds to the one above; `None` on lines that only tell more of the line before.
    pub adds: Option<Color>,
    /// The line.
    pub text: String,
}

impl Names<'_> {
    fn place(&self, span: Span) -> String {
        let name = self.files.name(span.file).unwrap_or("?");
        match self.files.position(span) {
            Some((line, column)) => format!("{name}:{line}:{column}"),
            None => name.to_string(),
        }
    }

    /// An object's keyword and place.
    pub fn object(&self, number: u32) -> String {
        let span = self.world.objects[number as usize].span;
        let bytes = self.files.bytes(span.file).and_then(|b| b.get(span.start as usize..span.end as usize));
        format!("{} {}", String::from_utf8_lossy(bytes.unwrap_or(b"object")), self.place(span))
    }

    /// A material's number and place.
    pub fn material(&self, number: u32) -> String {
        match self.scene.materials.get(number as usize) {
            Some(material) => format!("material {number} {}", self.place(material.span)),
            None => "plain grey".into(),
        }
    }

    /// A light's keyword and place.
    pub fn light(&self, number: usize) -> String {
        match self.scene.lights.iter().flatten().nth(number) {
            Some(light) => format!("{} {}", light.value.keywords()[0].0, self.place(light.span)),
            None => format!("light {number}"),
        }
    }
}

impl Explanation {
    /// The explanation in lines: the pixel, its samples, and the tree of one of them, by its place in the list.
    pub fn lines(&self, names: &Names, wanted: usize) -> Vec<Line> {
        let mut lines = Vec::new();
        let mut say = |depth, text: String| lines.push(Line { depth, adds: None, text });
        say(0, format!("pixel {},{} = {}", self.x, self.y, rgb(self.color)));
        if self.coverage < 1.0 {
            say(1, format!("the camera sees something at {:.1} % of it", 100.0 * self.coverage));
        }
        let all = self.samples.len();
        if all > 1 {
            let sum: f64 = self.samples.iter().map(|s| f64::from(s.weight)).sum();
            let of = match &self.mean {
                Mean::Own => String::new(),
                Mean::Around => ", also those of pixels around".into(),
                Mean::SubPixels(_) => ": sub-pixels, blurred and averaged as in 2012".into(),
            };
            say(1, format!("the mean of {all} samples by weight{of}; the weights sum to {}", sum as f32));
        }
        if let Some(stale) = self.stale_texels {
            say(1, format!("and {} by the habit `stale-texels`", rgb(stale)));
        }
        let nothing = |i: usize| i != wanted && self.samples[i].weight == 0.0 && self.mean != Mean::Own;
        for (i, sample) in self.samples.iter().enumerate().filter(|(i, _)| !nothing(*i)) {
            sample_lines(sample, self.number(i), names, i == wanted, &mut lines);
        }
        match (0..all).filter(|&i| nothing(i)).count() {
            0 => {}
            left => lines.push(Line { depth: 1, adds: None, text: format!("{left} samples more have no weight here") }),
        }
        lines
    }

    /// What a sample is called: its number, and whose it is where several pixels' samples are in the list.
    fn number(&self, index: usize) -> String {
        let SampleAccount { of: (x, y), sample, .. } = self.samples[index];
        match self.mean {
            Mean::Own => format!("sample {sample}"),
            _ => format!("sample {index} (number {sample} of pixel {x},{y})"),
        }
    }
}

fn sample_lines(sample: &SampleAccount, name: String, names: &Names, whole: bool, lines: &mut Vec<Line>) {
    let SampleAccount { place, weight, light, .. } = sample;
    let seen = light.as_ref().map_or("the camera sees nothing here".into(), |light| rgb(light.value));
    let text = format!("{name} at {}, {}, weight {weight}: {seen}", place.x, place.y);
    lines.push(Line { depth: 1, adds: None, text });
    if let (Some(light), true) = (light, whole) {
        node_lines(light, names, 2, lines);
    }
}

/// The lines of a tree.
pub fn ray_text(light: &Node, names: &Names) -> Vec<Line> {
    let mut lines = Vec::new();
    node_lines(light, names, 0, &mut lines);
    lines
}

fn node_lines(node: &Node, names: &Names, depth: usize, lines: &mut Vec<Line>) {
    let (factor, value) = (rgb(node.factor), rgb(node.value));
    let mut more = Vec::new();
    let text = match &node.what {
        What::Ray { from, ray, weight, hit } => {
            let from = match from {
                RayKind::Camera => "camera ray",
                RayKind::Reflected => "mirrored ray",
                RayKind::Transmitted => "transmitted ray",
            };
            more.push(ray_line(ray));
            match hit {
                Some(hit) => more.extend(struck_lines(hit, names)),
                None => more.push("it hits nothing".into()),
            }
            match from {
                "camera ray" => format!("{from}: {value}"),
                _ => format!("{from}, which counts for {weight} of the pixel: {factor} · {value}"),
            }
        }
        What::Sky => "background".into(),
        What::Ambient { share } => {
            format!("ambient{}: light {factor} · colour {value}", share_text(*share))
        }
        What::Light { light, to_light, distance, share, shadow } => {
            more.push(format!("L = {}, {} away; {} arrives", vector(*to_light), distance, rgb(node.scale)));
            more.extend(shadow.iter().map(|shadow| shadow_line(shadow, names)));
            let through = if node.factor == Color::ONE { String::new() } else { format!("{factor} · ") };
            format!("{}{}: {through}(sum below) · {}", names.light(*light), share_text(*share), rgb(node.scale))
        }
        What::Diffuse { cosine } => format!("diffuse: max(0, N·L = {cosine}) · {value}"),
        What::Highlight { model, base, exponent } => {
            format!("highlight: max(0, {model} = {base})^{exponent} = {} · {value}", node.factor.x)
        }
        What::Secondary { here, there, fresnel, total } => {
            let mut text = format!("mirrored and transmitted light, from index {here} to {there}");
            if let Some(share) = fresnel {
                text += &format!("; Fresnel's law mirrors {share}");
            }
            if *total {
                text += "; all is mirrored: beyond the critical angle nothing gets through";
            }
            text
        }
        What::Cut { weight } => format!("a ray that counts for {weight} only is not traced (--weight)"),
        What::Spent => "mirrored and transmitted light is left out: no more levels are wanted (--bounces)".into(),
    };
    lines.push(Line { depth, adds: Some(node.contribution()), text });
    lines.extend(more.into_iter().map(|text| Line { depth: depth + 1, adds: None, text }));
    node.terms.iter().for_each(|term| node_lines(term, names, depth + 1, lines));
}

fn struck_lines(hit: &Struck, names: &Names) -> Vec<String> {
    let mut lines = vec![format!("hits {} at t = {}, point {}", names.object(hit.object), hit.t, vector(hit.position))];
    if hit.barycentric != Vec3::ZERO {
        lines.push(format!("triangle {}, barycentric {}", hit.part, vector(hit.barycentric)));
    }
    if let Some(uv) = hit.uv {
        lines.push(format!("uv ({}, {})", uv.x, uv.y));
    }
    if let Some(local) = &hit.local {
        lines.push(format!("in the object's own space: {}", ray_line(local)));
    }
    let mut normal = format!("N = {}", vector(hit.n));
    if hit.n_geo != hit.n {
        normal += &format!("; the true surface's is {}", vector(hit.n_geo));
    }
    if hit.from_behind {
        normal += if hit.black {
            "; seen from behind, which is left black"
        } else if hit.n != hit.n_shade {
            "; seen from behind, so it was turned"
        } else {
            "; seen from behind"
        };
    }
    lines.push(normal);
    lines.push(names.material(hit.material));
    lines
}

fn shadow_line(shadow: &Shadow, names: &Names) -> String {
    match (shadow.blocker, shadow.share) {
        (None, _) => "the shadow ray is free".into(),
        (Some((object, t)), share) if share == Color::ZERO => {
            format!("in the shadow of {}, {t} away", names.object(object))
        }
        (Some((object, t)), Color::ONE) => format!("{} stands {t} away, but does not block it", names.object(object)),
        (Some((object, t)), share) => {
            format!("through {}, {t} away, comes {}", names.object(object), rgb(share))
        }
    }
}

fn share_text(share: f32) -> String {
    if share == 1.0 { String::new() } else { format!(" of a part of {share}") }
}

fn ray_line(ray: &RayLine) -> String {
    format!("{} + t {}", vector(ray.origin), vector(ray.dir))
}

fn vector(v: Vec3) -> String {
    format!("({}, {}, {})", v.x, v.y, v.z)
}

fn rgb(color: Color) -> String {
    vector(color)
}
