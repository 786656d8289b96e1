//! Detects which version of pbrt a scene file is written for. Files do not state the version, so it
//! is inferred from the keywords that they use.
//!
//! Sources: *Input File Format* of pbrt-v3 and of pbrt-v4, pbrt.org/fileformat-v3 and
//! pbrt.org/fileformat-v4.

use super::lexer::{Lexer, Token};
use crate::gzip::read_decompressed;
use crate::model::ReadInput;
use crate::shared_report::SharedReport;
use durer_diag::Span;

/// Version of pbrt that a scene file is written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Language {
    V3,
    V4,
}

/// Result of detecting the pbrt version, with the keyword that decided it. `by` is `None` if no
/// keyword decided the version, or if the keyword is in an included file.
#[derive(Clone, Copy, Debug)]
pub(super) struct DetectedLanguage {
    pub language: Language,
    pub by: Option<Span>,
}

/// Directives that exist only in pbrt-v3.
const OLD_DIRECTIVES: [&str; 4] = ["Renderer", "SurfaceIntegrator", "VolumeIntegrator", "WorldEnd"];

/// Directives that exist only in pbrt-v4.
const NEW_DIRECTIVES: [&str; 4] = ["Attribute", "ColorSpace", "Import", "Option"];

/// Types that can follow a directive. Each entry lists the directives, the types that exist only in
/// pbrt-v3, and the types that exist only in pbrt-v4.
const NAMES: [(&[&str], &[&str], &[&str]); 9] = [
    (&["Film"], &["image"], &["rgb", "gbuffer", "spectral"]),
    (&["Camera"], &["environment"], &["spherical"]),
    (
        &["Sampler"],
        &["02sequence", "lowdiscrepancy", "maxmindist", "random"],
        &["independent", "paddedsobol", "pmj02bn", "zsobol"],
    ),
    (
        &["Integrator"],
        &["ao", "directlighting", "whitted"],
        &["function", "lightpath", "randomwalk", "simplepath", "simplevolpath"],
    ),
    (&["Material", "MakeNamedMaterial"], &OLD_MATERIALS, &NEW_MATERIALS),
    (&["MakeNamedMedium"], &["heterogeneous"], &["cloud", "nanovdb", "rgbgrid", "uniformgrid"]),
    (&["Shape"], &["cone", "heightfield", "hyperboloid", "nurbs", "paraboloid"], &["bilinearmesh"]),
    (&["AreaLightSource"], &["area"], &[]),
    (&["LightSource"], &["exinfinite"], &[]),
];

const OLD_MATERIALS: [&str; 11] = [
    "disney",
    "fourier",
    "glass",
    "kdsubsurface",
    "matte",
    "metal",
    "mirror",
    "plastic",
    "substrate",
    "translucent",
    "uber",
];

/// Materials that exist only in pbrt-v4.
pub(super) const NEW_MATERIALS: [&str; 9] = [
    "coatedconductor",
    "coateddiffuse",
    "conductor",
    "dielectric",
    "diffuse",
    "diffusetransmission",
    "interface",
    "measured",
    "thindielectric",
];

/// Parameter names and types that exist only in pbrt-v3.
const OLD_PARAMETERS: [&str; 8] = ["Kd", "Ks", "Kr", "Kt", "bumpmap", "mapname", "namedmaterial1", "namedmaterial2"];
const OLD_TYPES: [&str; 2] = ["color", "xyz"];

/// Maximum number of included files that are searched, and maximum depth of nested includes.
const MAX_FILES: usize = 64;
const MAX_INCLUDE_DEPTH: usize = 8;

/// Detects the version by the first keyword that exists in only one of the two languages. If the
/// file has no such keyword, the version is pbrt-v4.
pub(super) fn decide(input: &ReadInput) -> DetectedLanguage {
    let mut left = MAX_FILES;
    let token = search(Lexer::new(input.bytes.clone(), input.file), input, &mut left, 0);
    let (language, by) = token.unwrap_or((Language::V4, None));
    DetectedLanguage { language, by }
}

/// Finds the keyword that decides the version, and its span if the keyword is in the first file.
/// Included files do not have a file index yet.
fn search(mut text: Lexer, input: &ReadInput, left: &mut usize, depth: usize) -> Option<(Language, Option<Span>)> {
    // Ignore errors here, because they are reported when the file is read.
    let report = SharedReport::default();
    // Current directive, the number of strings that have followed it, and the last string that gave
    // the type and name of a parameter.
    let (mut directive, mut names, mut head) = (String::new(), 0, String::new());
    while let Some(token) = text.next(&report) {
        let here = (depth == 0).then_some(token.at);
        match token.token {
            Token::Word => {
                let word = text.word(token.at);
                if OLD_DIRECTIVES.contains(&word) {
                    return Some((Language::V3, here));
                }
                if NEW_DIRECTIVES.contains(&word) {
                    return Some((Language::V4, here));
                }
                // A token that begins with a letter is not a number.
                if word.starts_with(|first: char| first.is_ascii_uppercase()) {
                    (directive, names, head) = (word.to_string(), 0, String::new());
                }
            }
            Token::Text(name) => {
                names += 1;
                if let Some(language) = language_of(&directive, names, &head, &name) {
                    return Some((language, here));
                }
                if name.contains(' ') {
                    head.clone_from(&name);
                }
                if directive == "Include" && names == 1 && *left > 0 && depth < MAX_INCLUDE_DEPTH {
                    *left -= 1;
                    let file = read_decompressed(input.source, &name).ok();
                    let file = file.filter(|bytes| bytes.len() < u32::MAX as usize);
                    let inner = file.and_then(|bytes| search(Lexer::new(bytes, input.file), input, left, depth + 1));
                    if inner.is_some() {
                        return inner;
                    }
                }
            }
            Token::Open | Token::Close => {}
        }
        if report.is_full() {
            break;
        }
    }
    None
}

/// Returns the language that the string at position `number` after a directive implies. `head` is
/// the string that gives the type and name of the preceding parameter.
fn language_of(directive: &str, number: usize, head: &str, text: &str) -> Option<Language> {
    let mut words = text.split_ascii_whitespace();
    if let (Some(kind), Some(name), None) = (words.next(), words.next(), words.next()) {
        let light = matches!(directive, "LightSource" | "AreaLightSource");
        let colored = matches!(kind, "rgb" | "spectrum" | "color");
        return match (kind, name) {
            _ if OLD_TYPES.contains(&kind) || OLD_PARAMETERS.contains(&name) => Some(Language::V3),
            (_, "scale") if light && colored => Some(Language::V3),
            (_, "nsamples") if light => Some(Language::V3),
            ("float", "scale" | "power" | "illuminance") | ("string", "filename") if light => Some(Language::V4),
            _ => None,
        };
    }
    if directive == "Texture" && number == 2 && text == "color" {
        return Some(Language::V3);
    }
    let is_name = match directive {
        "MakeNamedMaterial" | "MakeNamedMedium" => head == "string type",
        _ => number == 1,
    };
    let (_, old, new) = NAMES.iter().find(|row| is_name && row.0.contains(&directive))?;
    match (old.contains(&text), new.contains(&text)) {
        (true, _) => Some(Language::V3),
        (_, true) => Some(Language::V4),
        _ => None,
    }
}
