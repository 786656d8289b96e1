//! Reads parameters that are spectra: RGB, XYZ, a blackbody, sampled values, a name or a file.

use super::language::Language;
use super::named;
use super::params::{Kind, Param, Params, Values};
use crate::gzip::read_decompressed;
use crate::number::parse_f32;
use crate::shared_report::suggest;
use durer_diag::{Diagnostic, Span};
use durer_scene::math::Vec3;
use durer_scene::spectrum::SpectrumSource;
use durer_scene::spectrum::space::color_of_xyz;

impl Params<'_> {
    /// Returns the spectrum of a parameter, which must not be a texture.
    pub fn spectrum(&self, name: &'static str) -> Option<SpectrumSource> {
        let kinds = [Kind::Rgb, Kind::Xyz, Kind::Blackbody, Kind::Spectrum];
        spectrum_of(self.typed(name, &kinds, "rgb, a spectrum or a blackbody")?, self)
    }
}

/// Returns the spectrum of a parameter, which is converted to RGB for pbrt-v3.
fn spectrum_of(param: &Param, params: &Params) -> Option<SpectrumSource> {
    let found = spectrum_value(param, params)?;
    if params.language == Language::V4 {
        return Some(found);
    }
    // In pbrt-v3, the temperature of a blackbody is followed by a scale.
    let factor = match (&found, param.numbers()) {
        (SpectrumSource::Blackbody(_), [_, factor, ..]) => *factor as f32,
        _ => 1.0,
    };
    Some(SpectrumSource::Rgb(factor.max(0.0) * found.pbrt_v3_color()))
}

fn spectrum_value(param: &Param, params: &Params) -> Option<SpectrumSource> {
    let report = params.report;
    match (param.kind, &param.values) {
        (Kind::Xyz, _) => {
            let xyz = *param.triples().first()?;
            Some(SpectrumSource::Rgb(color_of_xyz(xyz.as_dvec3()).max(Vec3::ZERO)))
        }
        (Kind::Rgb, _) => Some(SpectrumSource::Rgb(params.space.color(*param.triples().first()?).max(Vec3::ZERO))),
        (Kind::Blackbody, _) => {
            let kelvin = param.number();
            if !(kelvin > 0.0 && kelvin < 1e6) {
                report.error(
                    param.values_at,
                    "the temperature of a blackbody must be more than 0 and less than 1000000 kelvin",
                );
                return None;
            }
            Some(SpectrumSource::Blackbody(kelvin))
        }
        (_, Values::Numbers(all)) => {
            let curve = all.chunks_exact(2).map(|pair| [pair[0] as f32, pair[1] as f32]).collect();
            rising(curve, param.values_at, params)
        }
        _ => named_spectrum(param.text(), param.values_at, params),
    }
}

fn rising(mut curve: Vec<[f32; 2]>, at: Span, params: &Params) -> Option<SpectrumSource> {
    if params.language == Language::V3 {
        curve.sort_by(|a, b| a[0].total_cmp(&b[0]));
        curve.dedup_by_key(|row| row[0]);
    }
    if let Some(pair) = curve.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
        let message = format!("the wavelengths of a spectrum must increase: {} comes after {}", pair[1][0], pair[0][0]);
        params.report.error(at, message);
        return None;
    }
    Some(SpectrumSource::Curve(curve))
}

/// Returns the spectrum with a name, which is a named spectrum of pbrt-v4 or a file of wavelengths
/// and values.
fn named_spectrum(name: &str, at: Span, params: &Params) -> Option<SpectrumSource> {
    if params.language == Language::V4
        && let Some(spectrum) = named::spectrum(name)
    {
        return Some(spectrum);
    }
    let bytes = match read_decompressed(params.input.source, name) {
        Ok(bytes) if bytes.len() < u32::MAX as usize => bytes,
        Ok(_) => {
            params.report.error(at, format!("`{name}` is too large for a spectrum"));
            return None;
        }
        Err(error) => {
            let (help, message) = match params.language {
                Language::V3 => (error.help(), format!("cannot read the spectrum: {error}")),
                Language::V4 => {
                    (suggest(name, named::names()), format!("pbrt has no spectrum with the name `{name}`, and {error}"))
                }
            };
            params.report.push(Diagnostic { help, ..Diagnostic::error(message).code("missing-file").at(at) });
            return None;
        }
    };
    let file = params.input.files.borrow_mut().add(name, bytes.clone());
    let (mut numbers, mut start) = (Vec::new(), 0);
    for line in bytes.split_inclusive(|&b| b == b'\n') {
        let text = line.split(|&b| b == b'#').next().unwrap_or_default();
        for word in text.split(|b| b.is_ascii_whitespace() || *b == b',').filter(|word| !word.is_empty()) {
            let place = start + (word.as_ptr() as usize - line.as_ptr() as usize);
            match parse_f32(word) {
                Ok(value) => numbers.push(value),
                Err(_) => {
                    let word_at = Span { file, start: place as u32, end: (place + word.len()) as u32 };
                    let found = crate::report::quoted(word);
                    let error = Diagnostic::error(format!("expected a number, found {found}"));
                    params.report.push(error.code("bad-file").at(word_at).related(at, "used here"));
                    return None;
                }
            }
        }
        start += line.len();
    }
    if numbers.is_empty() || numbers.len() % 2 != 0 {
        params.report.error(at, format!("`{name}` must contain pairs of wavelength and value"));
        return None;
    }
    rising(numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect(), at, params)
}
