//! Reader of Wavefront `.mtl` files; `mtl.rs` converts the materials.
//!
//! Sources: *The MTL material format*, Alias|Wavefront, 1995; and Clara.io's extension for
//! physically based rendering (Pr, Pm, Pc, Pcr, Ps, Ke, norm).

use super::mtl::MtlMaterial;
use super::words::Words;
use crate::model::ReadInput;
use crate::number::parse_f32;
use crate::report::quoted;
use crate::shared_report::NO_COUNTERPART;
use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::Vec3;
use durer_scene::scene::{PictureBytes, TextureImage};
use durer_scene::spectrum::space::color_of_xyz;
use durer_scene::texture::{Channel, Mapping, Wrap};
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::Range;

/// Material library of a Wavefront scene, which contains the materials by name and the textures
/// that they use.
#[derive(Default)]
pub(super) struct Library {
    pub materials: BTreeMap<String, (PrincipledMaterial, Span)>,
    pub pictures: BTreeMap<String, TextureImage>,
}

/// Reads the files that an `mtllib` statement names. The statement contains either one file name,
/// possibly with spaces, or several file names.
pub(super) fn read_files(
    input: &ReadInput,
    names: &Range<usize>,
    span: Span,
    library: &mut Library,
    diagnostics: &mut Diagnostics,
) {
    let all = String::from_utf8_lossy(&input.bytes[names.clone()]).into_owned();
    let all = unquoted(&all).to_string();
    let files = match find_file(input, &all, span) {
        Some(whole) => vec![(all.clone(), Some(whole))],
        // Some programs put a backslash before each space in a name.
        None => {
            let names = all.replace("\\ ", "\0");
            let names = names.split_whitespace().map(|name| name.replace('\0', " "));
            names.map(|name| (name.clone(), find_file(input, &name, span))).collect()
        }
    };
    for (name, file) in files {
        let bytes = file.and_then(|file| Some((input.source.read(&file.path).ok()?, file.path)));
        let Some((bytes, path)) = bytes else {
            let message =
                format!("the material file {} was not found: its materials are shown in grey", quoted(name.as_bytes()));
            diagnostics.push(Diagnostic::warning(message).code("missing-file").at(span));
            continue;
        };
        if bytes.len() < u32::MAX as usize {
            let file = input.files.borrow_mut().add_once(&path, &bytes);
            let ignored_keywords = BTreeMap::new();
            Reader { input, file, path: &path, library, ignored_keywords }.read(&bytes, diagnostics);
        }
    }
}

/// Texture statements, with the field that each of them sets. If the file gives no value for the
/// parameter itself, the value counts as 1.
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

/// Height that white stands for in a bump map with `-bm 1`, as a fraction of the diagonal of the
/// model's bounding box, because the format does not define a unit.
const BUMP: f32 = 0.002;

/// Statements that have no counterpart in Dürer, with the value at which each of them has no
/// effect.
const WITHOUT_EFFECT: [(&str, f32); 2] = [("anisor", 0.0), ("sharpness", 60.0)];

/// A word of an `.mtl` statement, with its span.
struct Word {
    text: String,
    at: Span,
}

/// Reads the statements of one `.mtl` file into a [`Library`].
struct Reader<'a, 'i> {
    input: &'a ReadInput<'i>,
    /// Index of the `.mtl` file.
    file: u32,
    /// Name of the `.mtl` file.
    path: &'a str,
    library: &'a mut Library,
    /// Keywords that are ignored, with the span where each was first used.
    ignored_keywords: BTreeMap<String, Span>,
}

impl Reader<'_, '_> {
    fn read(&mut self, bytes: &[u8], diagnostics: &mut Diagnostics) {
        let (mut words, mut current, file) = (Words::new(bytes), None::<MtlMaterial>, self.file);
        while let Some(keyword) = words.next_statement() {
            let rest: Vec<Range<usize>> = std::iter::from_fn(|| words.next_word()).collect();
            let word = |at: Range<usize>| Word {
                text: String::from_utf8_lossy(&bytes[at.clone()]).into_owned(),
                at: Span { file, start: at.start as u32, end: at.end as u32 },
            };
            let keyword = word(keyword);
            if keyword.text == "newmtl" {
                let name = match (rest.first(), rest.last()) {
                    (Some(first), Some(last)) => word(first.start..last.end),
                    _ => Word { text: String::new(), at: keyword.at },
                };
                let next = MtlMaterial { name: name.text, at: name.at, ..MtlMaterial::default() };
                if let Some(finished) = current.replace(next) {
                    self.finish(finished, diagnostics);
                }
                continue;
            }
            let Some(material) = &mut current else { continue };
            let arguments: Vec<Word> = rest.into_iter().map(word).collect();
            if let Err((at, problem)) = self.word(&keyword, &arguments, material, diagnostics) {
                let message = format!("material `{}`: {problem}", material.name);
                diagnostics.push(Diagnostic::warning(message).code("bad-value").at(at));
            }
        }
        if let Some(finished) = current {
            self.finish(finished, diagnostics);
        }
        if let Some(first) = self.ignored_keywords.values().copied().min_by_key(|span| span.start) {
            let all: Vec<&str> = self.ignored_keywords.keys().map(String::as_str).collect();
            let message = format!("some statements have no counterpart and are left out: {}", all.join(", "));
            diagnostics.push(Diagnostic::note(message).code(NO_COUNTERPART).at(first));
        }
    }

    /// Applies a statement to a material. Any error is returned with its span.
    fn word(
        &mut self,
        keyword: &Word,
        rest: &[Word],
        m: &mut MtlMaterial,
        diagnostics: &mut Diagnostics,
    ) -> Result<(), (Span, String)> {
        let word = &keyword.text;
        let number = || -> Result<Option<f32>, (Span, String)> {
            // Some programs write the opacity in the form `d -halo 0.5`.
            let number = rest.iter().find(|word| word.text != "-halo");
            let number = number.ok_or_else(|| (keyword.at, format!("`{word}` needs a number")))?;
            let text = number.text.as_bytes();
            let problem = |_| (number.at, format!("`{word}` needs a number, found {}", quoted(text)));
            parse_f32(text).map(Some).map_err(problem)
        };
        let color = || -> Result<Option<Vec3>, (Span, String)> {
            // A colour that is given in CIE XYZ or as a spectrum begins with a word.
            let is_xyz = rest.first().is_some_and(|word| word.text == "xyz");
            match numbers(&rest[usize::from(is_xyz)..])[..] {
                [x, y, z, ..] if is_xyz => {
                    let xyz = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
                    Ok(Some(color_of_xyz(xyz).max(Vec3::ZERO)))
                }
                [r, g, b, ..] => Ok(Some(Vec3::new(r, g, b).max(Vec3::ZERO))),
                [r, ..] => Ok(Some(Vec3::splat(r.max(0.0)))),
                [] => Err((keyword.at, format!("`{word}` needs three numbers"))),
            }
        };
        let statement = keyword.at.join(rest.last().map_or(keyword.at, |last| last.at));
        match word.to_ascii_lowercase().as_str() {
            "kd" => m.diffuse = color()?,
            "ks" => m.specular = color()?,
            "ke" => m.emission = color()?,
            "tf" => (m.filter, m.filter_at) = (color()?, keyword.at),
            "ns" => m.exponent = number()?,
            "ni" => m.ior = number()?,
            "d" => (m.opacity, m.opacity_at) = (number()?, statement),
            "tr" if m.opacity.is_none() => (m.opacity, m.opacity_at) = (number()?.map(|t| 1.0 - t), statement),
            "tr" => _ = number()?,
            "illum" => (m.model, m.model_at) = (number()?, statement),
            "pr" => m.roughness = number()?,
            "pm" => m.metalness = number()?,
            "ps" => m.sheen = number()?,
            "pc" => m.coat = number()?,
            "pcr" => m.coat_roughness = number()?,
            "aniso" => m.anisotropy = number()?,
            "map_kd" => {
                m.has_diffuse_map = true;
                m.diffuse_map = self.texture_map(keyword, rest, m, diagnostics);
            }
            // The ambient colour and its maps are ignored, because indirect light is computed.
            "ka" | "map_ka" | "map_aat" => {}
            lower => match MAPS.iter().find(|row| row.0 == lower) {
                Some((_, field)) => {
                    let picture = self.texture_map(keyword, rest, m, diagnostics);
                    let mut field = *field;
                    if lower.ends_with("bump") {
                        let strength =
                            rest.iter().position(|word| word.text == "-bm").map(|at| numbers(&rest[at + 1..]));
                        let strength = strength.and_then(|numbers| numbers.first().copied());
                        m.other_textures.bump_height = BUMP * strength.unwrap_or(1.0);
                        // Many programs use the statement for bump maps to specify normal maps.
                        if names_normals(rest) {
                            field = |m| &mut m.normal_texture;
                        }
                    }
                    *field(&mut m.other_textures) = picture;
                }
                None if WITHOUT_EFFECT.iter().any(|row| row.0 == lower && numbers(rest) == [row.1]) => {}
                None => self.leave_out(word, keyword.at),
            },
        }
        Ok(())
    }

    fn leave_out(&mut self, word: &str, at: Span) {
        self.ignored_keywords.entry(word.to_string()).or_insert(at);
    }

    /// Reads a texture, which consists of options that begin with `-` and a file name that may
    /// contain spaces.
    fn texture_map(
        &mut self,
        keyword: &Word,
        rest: &[Word],
        m: &MtlMaterial,
        diagnostics: &mut Diagnostics,
    ) -> Option<FileName> {
        let (mut mapping, mut at) = (Mapping::default(), 0);
        let (mut scale, mut offset) = ([1.0f32; 2], [0.0f32; 2]);
        while let Some(option) = rest.get(at).map(|word| word.text.as_str()) {
            if !option.starts_with('-') || option.len() == 1 {
                break;
            }
            at += 1;
            let numbers = numbers(&rest[at..(at + 3).min(rest.len())]);
            let pair = |pair: &mut [f32; 2]| {
                pair.iter_mut().zip(&numbers).for_each(|(to, from)| *to = *from);
                numbers.len()
            };
            let next = rest.get(at).map(|word| word.text.as_str());
            at += match option {
                "-s" => pair(&mut scale),
                "-o" => pair(&mut offset),
                "-t" => numbers.len(),
                "-clamp" => {
                    if next == Some("on") {
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
                    mapping.channel = next.and_then(|word| match word {
                        "m" => Some(Channel::Alpha),
                        // `l` (luminance) and `z` (depth) name no channel of their own. In a grey
                        // picture, all channels contain these values.
                        word => Channel::from_word(word),
                    });
                    1
                }
                // The options -blendu, -blendv, -boost, -bm, -cc, -texres, -type, and -colorspace
                // have one value.
                _ => 1,
            };
        }
        // The texture coordinate v points upwards, but the rows of the picture are stored from top
        // to bottom.
        mapping.transform = [[scale[0], 0.0, offset[0]], [0.0, scale[1], 1.0 - scale[1] - offset[1]]];
        // Some programs write the options after the file name.
        let named = rest.get(at..).unwrap_or_default();
        let behind = named.iter().skip(1).position(|word| is_option(&word.text));
        let named = &named[..behind.map_or(named.len(), |behind| behind + 1)];
        if behind.is_some() {
            self.leave_out("options after a picture's name", keyword.at);
        }
        let span = named.first().zip(named.last()).map_or(keyword.at, |(first, last)| first.at.join(last.at));
        let name = named.iter().map(|word| word.text.as_str()).collect::<Vec<_>>().join(" ");
        let name = unquoted(&name).to_string();
        let word = &keyword.text;
        let Some(file) = find_file(self.input, &name, span) else {
            let message =
                format!("material `{}`: the picture {} of `{word}` was not found", m.name, quoted(name.as_bytes()));
            let warning = Diagnostic::warning(message).code("missing-file").at(span);
            diagnostics.push(match name.contains(['/', '\\']) {
                true => warning.help("copy the picture into the folder of the model, and write only its name"),
                false => warning,
            });
            return None;
        };
        if is_absolute(&name) && file.path != name.replace('\\', "/") {
            let message = format!(
                "the absolute path {} does not exist here: {} beside the model is used",
                quoted(name.as_bytes()),
                quoted(file.path.as_bytes())
            );
            let note = Diagnostic::note(message).code("absolute-path").at(span);
            diagnostics.push_once(note.help("write only the name: other programs look only for the absolute path"));
        }
        let path = format!("{}#{}/{word}", self.path, m.name);
        self.library.pictures.insert(path.clone(), TextureImage { bytes: PictureBytes::File(file.path), mapping });
        Some(FileName { path, span })
    }

    /// Adds a material to the library, unless the library already contains one with this name.
    fn finish(&mut self, mut material: MtlMaterial, diagnostics: &mut Diagnostics) {
        if material.drops_filter() {
            self.leave_out("Tf", material.filter_at);
        }
        let name = std::mem::take(&mut material.name);
        if material.is_glass_by_model() {
            let model = material.model.unwrap_or_default();
            let message = format!("`illum {model}` makes the material `{name}` clear glass, so its `Kd` has no effect");
            let note = Diagnostic::note(message).code("illum-glass").at(material.model_at);
            diagnostics.push(note.help("write `illum 2` for an opaque material"));
        }
        // The cause of an invisible material is the statement that sets its opacity.
        let at = if material.opacity.is_some_and(|opacity| opacity <= 0.0) { material.opacity_at } else { material.at };
        self.library.materials.entry(name).or_insert_with(|| (material.into_principled(), at));
    }
}

/// Removes the quotes around a name.
fn unquoted(name: &str) -> &str {
    let name = name.trim();
    ['"', '\''].into_iter().find_map(|quote| name.strip_prefix(quote)?.strip_suffix(quote)).unwrap_or(name)
}

/// Returns true if a word is an option of a texture statement.
fn is_option(word: &str) -> bool {
    const OPTIONS: [&str; 13] = [
        "-blendu", "-blendv", "-boost", "-mm", "-o", "-s", "-t", "-texres", "-clamp", "-bm", "-imfchan", "-type", "-cc",
    ];
    OPTIONS.contains(&word)
}

/// Returns the numbers at the start of a list of words.
fn numbers(words: &[Word]) -> Vec<f32> {
    words.iter().map_while(|word| parse_f32(word.text.as_bytes()).ok()).collect()
}

/// Returns true if the file name at the end of a statement looks like the name of a normal map.
fn names_normals(rest: &[Word]) -> bool {
    let name = rest.last().map(|name| name.text.to_lowercase()).unwrap_or_default();
    let stem = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
    ["normal", "_nrm", "_ddn", "_norm"].iter().any(|word| stem.contains(word)) || stem.ends_with("_n")
}

/// Returns true if a path begins with a slash or with the letter of a drive.
fn is_absolute(path: &str) -> bool {
    path.starts_with(['/', '\\']) || path.get(1..3).is_some_and(|drive| drive == ":/" || drive == ":\\")
}

/// Finds a file of the scene, either at its path as written or by its bare file name in the folder
/// of the scene.
fn find_file(input: &ReadInput, path: &str, span: Span) -> Option<FileName> {
    let portable = path.replace('\\', "/");
    let last = portable.rsplit('/').next().unwrap_or_default();
    let names = [portable.as_str(), last];
    let name = names.into_iter().find(|name| !name.is_empty() && input.source.contains(name))?;
    Some(FileName { path: name.to_string(), span })
}
