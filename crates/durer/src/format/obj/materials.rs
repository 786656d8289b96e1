//! Wavefront `.mtl`: materials, in the words of OpenPBR.
//!
//! Sources: *The MTL material format*, Alias|Wavefront, 1995; the extension for physically based
//! materials of Clara.io (Pr, Pm, Pc, Pcr, Ps, Ke, norm).

use super::words::Words;
use crate::describe::FileName;
use crate::diag::{Diagnostic, Diagnostics, Span};
use crate::format::model::Input;
use crate::format::number::parse_f32;
use crate::format::report::shown;
use crate::material::PrincipledMaterial;
use crate::math::Vec3;
use crate::scene::{Picture, PictureBytes};
use crate::texture::{Channel, Mapping, Wrap};
use std::collections::BTreeMap;
use std::ops::Range;

/// Materials by name, and the pictures that they show.
#[derive(Default)]
pub(super) struct Library {
    pub materials: BTreeMap<String, PrincipledMaterial>,
    pub pictures: BTreeMap<String, Picture>,
}

/// Reads the files that a `mtllib` names: one whose name has blanks, or several.
pub(super) fn read_files(
    input: &Input,
    names: &Range<usize>,
    span: Span,
    library: &mut Library,
    diagnostics: &mut Diagnostics,
) {
    let all = String::from_utf8_lossy(&input.bytes[names.clone()]).into_owned();
    let files = match found(input, &all, span) {
        Some(whole) => vec![(all.clone(), Some(whole))],
        // Some programs write a blank within a name after a backslash.
        None => {
            let names = all.replace("\\ ", "\0");
            let names = names.split_whitespace().map(|name| name.replace('\0', " "));
            names.map(|name| (name.clone(), found(input, &name, span))).collect()
        }
    };
    for (name, file) in files {
        let bytes = file.and_then(|file| Some((input.source.read(&file.path).ok()?, file.path)));
        let Some((bytes, path)) = bytes else {
            let message =
                format!("there is no file of materials {}: what it has is shown in grey", shown(name.as_bytes()));
            diagnostics.push(Diagnostic::warning(message).code("missing-file").at(span));
            continue;
        };
        if bytes.len() < u32::MAX as usize {
            Reader::new(input, &path, span, library).read(&bytes, diagnostics);
        }
    }
}

/// Words for pictures of parameters, and where they go. What has no number of its own beside them
/// counts as 1.
type Field = fn(&mut PrincipledMaterial) -> &mut Option<FileName>;
const MAPS: [(&str, Field); 12] = [
    ("map_ks", |m| &mut m.specular_color_texture),
    ("map_ke", |m| &mut m.emission_texture),
    ("map_pr", |m| &mut m.specular_roughness_texture),
    ("map_pm", |m| &mut m.base_metalness_texture),
    ("map_ps", |m| &mut m.fuzz_weight_texture),
    ("map_pc", |m| &mut m.coat_weight_texture),
    ("map_pcr", |m| &mut m.coat_roughness_texture),
    ("map_d", |m| &mut m.opacity_texture),
    ("norm", |m| &mut m.normal_texture),
    ("map_kn", |m| &mut m.normal_texture),
    ("bump", |m| &mut m.bump_texture),
    ("map_bump", |m| &mut m.bump_texture),
];

/// How high the white of a bump map lies that is `-bm 1`, in sizes of the model: its own unit is
/// not defined.
const BUMP: f32 = 0.002;

/// What a material's words say, before they are brought together.
#[derive(Default)]
struct Written {
    name: String,
    diffuse: Option<Vec3>,
    specular: Option<Vec3>,
    emission: Option<Vec3>,
    exponent: Option<f32>,
    ior: Option<f32>,
    opacity: Option<f32>,
    model: Option<f32>,
    roughness: Option<f32>,
    metalness: Option<f32>,
    sheen: Option<f32>,
    coat: Option<f32>,
    coat_roughness: Option<f32>,
    anisotropy: Option<f32>,
    diffuse_map: Option<FileName>,
    /// Whether a picture was named, there or not.
    pictured: bool,
    /// Its other pictures, and no more.
    pictures: PrincipledMaterial,
}

struct Reader<'a, 'i> {
    input: &'a Input<'i>,
    /// The name of the file.
    path: &'a str,
    /// Where it is named.
    span: Span,
    library: &'a mut Library,
    /// Words that are left out, and how often.
    left_out: BTreeMap<String, usize>,
}

impl<'a, 'i> Reader<'a, 'i> {
    fn new(input: &'a Input<'i>, path: &'a str, span: Span, library: &'a mut Library) -> Self {
        Reader { input, path, span, library, left_out: BTreeMap::new() }
    }

    fn read(&mut self, bytes: &[u8], diagnostics: &mut Diagnostics) {
        let (mut words, mut current) = (Words::new(bytes), None::<Written>);
        while let Some(keyword) = words.next_statement() {
            let rest: Vec<Range<usize>> = std::iter::from_fn(|| words.next_word()).collect();
            let text = |at: &Range<usize>| String::from_utf8_lossy(&bytes[at.clone()]).into_owned();
            let word = text(&keyword);
            if word == "newmtl" {
                let name = match (rest.first(), rest.last()) {
                    (Some(first), Some(last)) => text(&(first.start..last.end)),
                    _ => String::new(),
                };
                let next = Written { name, ..Written::default() };
                current.replace(next).into_iter().for_each(|written| self.finish(written));
                continue;
            }
            let Some(material) = &mut current else { continue };
            let arguments: Vec<String> = rest.iter().map(text).collect();
            if let Err(problem) = self.word(&word, &arguments, material, diagnostics) {
                let message = format!("`{}`, material `{}`: {problem}", self.path, material.name);
                diagnostics.push(Diagnostic::warning(message).code("bad-value").at(self.span));
            }
        }
        current.into_iter().for_each(|written| self.finish(written));
        if !self.left_out.is_empty() {
            let all: Vec<&str> = self.left_out.keys().map(String::as_str).collect();
            let message =
                format!("`{}` has words without a counterpart, which are left out: {}", self.path, all.join(", "));
            diagnostics.push(Diagnostic::note(message).code("NO_COUNTERPART").at(self.span));
        }
    }

    fn word(
        &mut self,
        word: &str,
        rest: &[String],
        m: &mut Written,
        diagnostics: &mut Diagnostics,
    ) -> Result<(), String> {
        let number = || -> Result<Option<f32>, String> {
            // Some programs write `d -halo 0.5`.
            let text = rest.iter().find(|word| word.as_str() != "-halo").ok_or(format!("`{word}` has no number"))?;
            parse_f32(text.as_bytes())
                .map(Some)
                .map_err(|_| format!("`{word}` needs a number, found {}", shown(text.as_bytes())))
        };
        let color = || -> Result<Option<Vec3>, String> {
            // Colours by spectrum or in CIE XYZ have a word before them.
            let numbers: Vec<f32> = rest.iter().map_while(|text| parse_f32(text.as_bytes()).ok()).collect();
            match numbers[..] {
                [r, g, b, ..] => Ok(Some(Vec3::new(r, g, b).max(Vec3::ZERO))),
                [r, ..] => Ok(Some(Vec3::splat(r.max(0.0)))),
                [] => Err(format!("`{word}` needs three numbers")),
            }
        };
        match word.to_ascii_lowercase().as_str() {
            "kd" => m.diffuse = color()?,
            "ks" => m.specular = color()?,
            "ke" => m.emission = color()?,
            "ns" => m.exponent = number()?,
            "ni" => m.ior = number()?,
            "d" => m.opacity = number()?,
            "tr" => m.opacity = m.opacity.or(number()?.map(|t| 1.0 - t)),
            "illum" => m.model = number()?,
            "pr" => m.roughness = number()?,
            "pm" => m.metalness = number()?,
            "ps" => m.sheen = number()?,
            "pc" => m.coat = number()?,
            "pcr" => m.coat_roughness = number()?,
            "aniso" => m.anisotropy = number()?,
            "map_kd" => {
                m.pictured = true;
                m.diffuse_map = self.map(word, rest, m, diagnostics);
            }
            // Light from everywhere and its maps are computed here.
            "ka" | "map_ka" | "map_aat" => {}
            lower => match MAPS.iter().find(|row| row.0 == lower) {
                Some((_, field)) => {
                    let picture = self.map(word, rest, m, diagnostics);
                    let mut field = *field;
                    if lower.ends_with("bump") {
                        let strength = rest.iter().position(|word| word == "-bm").and_then(|at| rest.get(at + 1));
                        let strength = strength.and_then(|text| parse_f32(text.as_bytes()).ok());
                        m.pictures.bump_height = BUMP * strength.unwrap_or(1.0);
                        // Many programs write pictures of normals where heights belong.
                        if names_normals(rest) {
                            field = |m| &mut m.normal_texture;
                        }
                    }
                    *field(&mut m.pictures) = picture;
                }
                None => *self.left_out.entry(word.to_string()).or_default() += 1,
            },
        }
        Ok(())
    }

    /// A texture: options that begin with `-`, and the name of its picture, which may have blanks.
    fn map(&mut self, word: &str, rest: &[String], m: &Written, diagnostics: &mut Diagnostics) -> Option<FileName> {
        let (mut mapping, mut at) = (Mapping::default(), 0);
        let (mut scale, mut offset) = ([1.0f32; 2], [0.0f32; 2]);
        while let Some(option) = rest.get(at).filter(|word| word.starts_with('-') && word.len() > 1) {
            at += 1;
            let numbers: Vec<f32> =
                rest[at..].iter().take(3).map_while(|text| parse_f32(text.as_bytes()).ok()).collect();
            let pair = |pair: &mut [f32; 2]| {
                pair.iter_mut().zip(&numbers).for_each(|(to, from)| *to = *from);
                numbers.len()
            };
            at += match option.as_str() {
                "-s" => pair(&mut scale),
                "-o" => pair(&mut offset),
                "-t" => numbers.len(),
                "-clamp" => {
                    if rest.get(at).is_some_and(|word| word == "on") {
                        mapping.wrap = [Wrap::Clamp; 2];
                    }
                    1
                }
                "-mm" => {
                    if let [base, gain, ..] = numbers[..] {
                        mapping.range = [base, base + gain];
                    }
                    2
                }
                "-imfchan" => {
                    mapping.channel = rest.get(at).and_then(|word| match word.as_str() {
                        "m" => Some(Channel::Alpha),
                        // Luminance and depth: of grey pictures any channel.
                        word => Channel::from_word(word),
                    });
                    1
                }
                // -blendu, -blendv, -boost, -bm, -cc, -texres, -type, -colorspace.
                _ => 1,
            };
        }
        // Coordinates have v upwards, the picture's rows go down.
        mapping.transform = [[scale[0], 0.0, offset[0]], [0.0, scale[1], 1.0 - scale[1] - offset[1]]];
        let name = rest.get(at..).unwrap_or_default().join(" ");
        let Some(file) = found(self.input, &name, self.span).filter(|_| !name.is_empty()) else {
            let message = format!(
                "`{}`, material `{}`: there is no picture {} ({word})",
                self.path,
                m.name,
                shown(name.as_bytes())
            );
            diagnostics.push(Diagnostic::warning(message).code("missing-file").at(self.span));
            return None;
        };
        let path = format!("{}#{}/{word}", self.path, m.name);
        self.library.pictures.insert(path.clone(), Picture { bytes: PictureBytes::File(file.path), mapping });
        Some(FileName { path, span: self.span })
    }

    /// Brings the words together. A material that is there keeps its place: the first of a name
    /// counts.
    fn finish(&mut self, w: Written) {
        // A picture alone is not darkened.
        let usual = if w.diffuse_map.is_some() { Vec3::ONE } else { Vec3::splat(0.8) };
        let mut m = PrincipledMaterial { base_color: w.diffuse.unwrap_or(usual), ..w.pictures };
        m.base_color_texture = w.diffuse_map;
        // Black under a picture is what programs write that mean the picture alone.
        if w.pictured && m.base_color == Vec3::ZERO {
            m.base_color = Vec3::ONE;
        }
        let model = w.model.unwrap_or(2.0) as i32;
        let pictured = |picture: &Option<FileName>| if picture.is_some() { 1.0 } else { 0.0 };
        let specular = w.specular.unwrap_or(Vec3::splat(pictured(&m.specular_color_texture)));
        // A highlight as wide as Blinn's of the exponent: alpha^2 = 2 / (n + 2); roughness^2 =
        // alpha.
        let exponent = w.exponent.unwrap_or(if specular == Vec3::ZERO { 0.0 } else { 50.0 }).max(0.0);
        let rough = m.specular_roughness_texture.is_some();
        let by_exponent = if rough { 1.0 } else { (2.0 / (exponent + 2.0)).sqrt().sqrt() };
        m.specular_roughness = w.roughness.unwrap_or(by_exponent).clamp(0.0, 1.0);
        let physical = rough || w.roughness.is_some() || w.metalness.is_some() || m.base_metalness_texture.is_some();
        if !physical {
            m.specular_weight = if model == 0 || model == 1 { 0.0 } else { specular.max_element().min(1.0) };
        }
        m.base_metalness = w.metalness.unwrap_or(pictured(&m.base_metalness_texture)).clamp(0.0, 1.0);
        // Models 3 and 8 mirror: what is black and mirrors is metal.
        if matches!(model, 3 | 8) && m.base_color.max_element() < 0.05 && specular != Vec3::ZERO {
            (m.base_color, m.base_metalness, m.specular_weight) = (specular.min(Vec3::ONE), 1.0, 1.0);
        }
        m.specular_ior = w.ior.filter(|ior| *ior >= 1.0 && *ior < 10.0).unwrap_or(1.5);
        let opacity = w.opacity.unwrap_or(1.0).clamp(0.0, 1.0);
        // Models 4, 6, 7 and 9 are glass; others are there in part.
        match model {
            4 | 6 | 7 | 9 => {
                m.transmission_weight = if opacity < 1.0 { 1.0 - opacity } else { 1.0 };
                m.specular_weight = 1.0;
            }
            _ => m.opacity = opacity,
        }
        let emission = w.emission.unwrap_or(Vec3::splat(pictured(&m.emission_texture)));
        if emission != Vec3::ZERO {
            m.emission_luminance = emission.max_element();
            m.emission_color = emission / emission.max_element();
        }
        m.fuzz_weight = w.sheen.unwrap_or(pictured(&m.fuzz_weight_texture)).clamp(0.0, 1.0);
        m.coat_weight = w.coat.unwrap_or(pictured(&m.coat_weight_texture)).clamp(0.0, 1.0);
        m.coat_roughness = w.coat_roughness.unwrap_or(pictured(&m.coat_roughness_texture)).clamp(0.0, 1.0);
        m.specular_anisotropy = w.anisotropy.unwrap_or(0.0).clamp(0.0, 1.0);
        self.library.materials.entry(w.name).or_insert(m);
    }
}

/// Whether the name of a picture, the last of a statement's words, says that it has normals.
fn names_normals(rest: &[String]) -> bool {
    let name = rest.last().map(|name| name.to_lowercase()).unwrap_or_default();
    let stem = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
    ["normal", "_nrm", "_ddn", "_norm"].iter().any(|word| stem.contains(word)) || stem.ends_with("_n")
}

/// The name of a file that may be had, of those that a material may mean: as written, or its last
/// name beside the scene.
fn found(input: &Input, path: &str, span: Span) -> Option<FileName> {
    let portable = path.replace('\\', "/");
    let last = portable.rsplit('/').next().unwrap_or_default();
    let names = [portable.as_str(), last];
    let name = names.into_iter().find(|name| !name.is_empty() && input.source.contains(name))?;
    Some(FileName { path: name.to_string(), span })
}
