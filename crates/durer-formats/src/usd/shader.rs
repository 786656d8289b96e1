//! Inputs of shaders: values, and the textures that they are connected to.
//!
//! Source: *UsdPreviewSurface Specification*, version 2.6.

use super::files::joined;
use super::layer::Value;
use super::stage::{Opinion, Prim, Stage};
use durer_diag::Span;
use durer_scene::math::fp;
use durer_scene::texture::{Channel, Mapping, Wrap};

/// Maximum number of connections between an input and its value.
const MAX_CONNECTIONS: u32 = 32;

/// Value of a shader's input.
pub(super) enum Input {
    Value(Opinion),
    Texture(Texture),
    /// Colours of the mesh.
    VertexColor,
}

/// Picture that an input is connected to.
pub(super) struct Texture {
    /// Name of the file.
    pub file: String,
    pub at: Span,
    /// Output of the texture; `None` for its colour.
    pub channel: Option<Channel>,
    /// Name of the texture coordinates.
    pub uv_name: String,
    pub mapping: Mapping,
    pub scale: [f64; 4],
    pub bias: [f64; 4],
    /// True if the file states that the picture is not a colour, or that it is one.
    pub is_raw: Option<bool>,
    /// Value if the picture is missing.
    pub fallback: Option<[f64; 4]>,
}

/// Splits the path of a property into the prim and the name.
fn split(path: &str) -> Option<(&str, &str)> {
    path.rsplit_once('.')
}

/// Returns the shader that an output of a prim leads to, and the name of its output.
pub(super) fn shader_of(stage: &Stage, prim: &Prim, output: &str) -> Option<(Prim, String)> {
    let (mut prim, mut output) = (prim.clone(), output.to_string());
    for _ in 0..MAX_CONNECTIONS {
        let target = prim.targets(&output).into_iter().next()?;
        let (path, name) = split(&target)?;
        (prim, output) = (stage.prim(path)?, name.to_string());
        if prim.type_name() == "Shader" {
            return Some((prim, output));
        }
    }
    None
}

/// Returns an input of a shader, by following its connections.
pub(super) fn input(stage: &Stage, shader: &Prim, name: &str) -> Option<Input> {
    let (mut prim, mut name) = (shader.clone(), format!("inputs:{name}"));
    for _ in 0..MAX_CONNECTIONS {
        let Some(target) = prim.targets(&name).into_iter().next() else {
            return prim.get(stage, &name).map(Input::Value);
        };
        let (path, source) = split(&target)?;
        let Some(next) = stage.prim(path) else {
            let message = format!("`{name}` is connected to `{path}`, which does not exist");
            stage.files.report.unsupported_once(shader.span(), message);
            return prim.get(stage, &name).map(Input::Value);
        };
        if next.type_name() == "Shader" && source.starts_with("outputs:") {
            return connected(stage, &next, source.trim_start_matches("outputs:"));
        }
        // Inputs of a material or of a node graph are connected to values or to other shaders.
        (prim, name) = (next, source.to_string());
    }
    None
}

/// Returns the input that is connected to the output of a shader.
fn connected(stage: &Stage, shader: &Prim, output: &str) -> Option<Input> {
    let id = shader.get(stage, "info:id").and_then(|id| id.value.text().map(str::to_string)).unwrap_or_default();
    match id.as_str() {
        "UsdUVTexture" => texture(stage, shader, output).map(Input::Texture),
        id if id.starts_with("UsdPrimvarReader") => {
            let name = text(stage, shader, "varname").unwrap_or_default();
            if name == "displayColor" {
                return Some(Input::VertexColor);
            }
            let message = format!("the primvar `{name}` has no counterpart in a material: its fallback is used");
            stage.files.report.unsupported_once(shader.span(), message);
            input(stage, shader, "fallback").filter(|input| matches!(input, Input::Value(_)))
        }
        other => {
            let message = format!("the shader `{other}` has no counterpart: what is connected to it is left out");
            stage.files.report.unsupported_once(shader.span(), message);
            None
        }
    }
}

/// Returns the text of an input.
fn text(stage: &Stage, shader: &Prim, name: &str) -> Option<String> {
    match input(stage, shader, name)? {
        Input::Value(opinion) => opinion.value.text().map(str::to_string),
        _ => None,
    }
}

/// Returns the numbers of an input.
pub(super) fn numbers(stage: &Stage, shader: &Prim, name: &str) -> Option<Vec<f64>> {
    match input(stage, shader, name)? {
        Input::Value(opinion) => Some(opinion.value.numbers().to_vec()),
        _ => None,
    }
}

fn texture(stage: &Stage, shader: &Prim, output: &str) -> Option<Texture> {
    let report = stage.files.report;
    let Some(Input::Value(file)) = input(stage, shader, "file") else {
        report.unsupported_once(shader.span(), "a texture without a `file` is left out");
        return None;
    };
    let name = file.value.text().filter(|name| !name.is_empty())?;
    if name.contains("<UDIM>") {
        report.unsupported_once(file.span, "pictures in UDIM tiles have no counterpart: the texture is left out");
        return None;
    }
    let quad = |name: &str| numbers(stage, shader, name).and_then(|all| all.first_chunk::<4>().copied());
    let wrap = |name: &str| match text(stage, shader, name).as_deref() {
        Some("black") => {
            let message = "black outside of a picture has no counterpart: the colours of its border are repeated";
            report.unsupported_once(shader.span(), message);
            Wrap::Clamp
        }
        Some("clamp") => Wrap::Clamp,
        Some("mirror") => Wrap::Mirror,
        _ => Wrap::Repeat,
    };
    let is_raw = match text(stage, shader, "sourceColorSpace").as_deref() {
        Some("raw") => Some(true),
        Some("sRGB") => Some(false),
        _ => None,
    };
    let (uv_name, transform) = coordinates(stage, shader);
    Some(Texture {
        file: joined(&file.layer, name),
        at: file.span,
        channel: match output {
            "r" => Some(Channel::Red),
            "g" => Some(Channel::Green),
            "b" => Some(Channel::Blue),
            "a" => Some(Channel::Alpha),
            _ => None,
        },
        uv_name,
        mapping: Mapping { wrap: [wrap("wrapS"), wrap("wrapT")], transform, ..Mapping::default() },
        scale: quad("scale").unwrap_or([1.0; 4]),
        bias: quad("bias").unwrap_or([0.0; 4]),
        is_raw,
        fallback: quad("fallback"),
    })
}

/// Returns the name of the coordinates of a texture, and their transform with v downwards.
fn coordinates(stage: &Stage, texture: &Prim) -> (String, [[f32; 3]; 2]) {
    let (mut name, mut transform) = ("st".to_string(), Mapping::default().transform);
    let (mut node, mut at) = (texture.clone(), "st".to_string());
    for _ in 0..MAX_CONNECTIONS {
        let Some((next, _)) = shader_of(stage, &node, &format!("inputs:{at}")) else { break };
        let id = next.get(stage, "info:id").and_then(|id| id.value.text().map(str::to_string)).unwrap_or_default();
        if id == "UsdTransform2d" {
            let pair = |input: &str, default: f64| {
                numbers(stage, &next, input).and_then(|all| all.first_chunk::<2>().copied()).unwrap_or([default; 2])
            };
            let degrees = numbers(stage, &next, "rotation").and_then(|all| all.first().copied()).unwrap_or(0.0);
            transform = transformed(pair("scale", 1.0), degrees, pair("translation", 0.0));
            (node, at) = (next, "in".into());
            continue;
        }
        if let Some(varname) = text(stage, &next, "varname") {
            name = varname;
        }
        break;
    }
    (name, transform)
}

/// Returns the transform of coordinates with v downwards, for a scale, a rotation and a translation
/// of coordinates with v upwards.
fn transformed([sx, sy]: [f64; 2], degrees: f64, [x, y]: [f64; 2]) -> [[f32; 3]; 2] {
    let (sin, cos) = fp::sin_cos_degrees(degrees);
    let rows = [[cos * sx, sin * sy, x - sin * sy], [-sin * sx, cos * sy, 1.0 - cos * sy - y]];
    rows.map(|row| row.map(|number| number as f32))
}

/// Returns the number of a value.
pub(super) fn number(value: &Value) -> Option<f32> {
    value.number().map(|number| number as f32).filter(|number| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_scene::math::Vec2;

    #[test]
    fn coordinates_are_scaled_rotated_and_moved() {
        let mapping = Mapping { transform: transformed([2.0, 3.0], 90.0, [0.1, 0.2]), ..Mapping::default() };
        // (0.5, 0.25) is scaled to (1, 0.75), rotated to (-0.75, 1), and moved to (-0.65, 1.2).
        let place = mapping.texture_position(Vec2::new(0.5, 0.25));
        assert!((place - Vec2::new(-0.65, 1.0 - 1.2)).length() < 1e-6, "{place}");
    }
}
