//! Transforms of prims: `xformOpOrder` and its operations.
//!
//! Source: *OpenUSD documentation*, `UsdGeomXformOp` and `UsdGeomXformable`.

use super::stage::{Prim, Stage};
use durer_diag::Diagnostic;
use durer_scene::math::fp;
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

/// Returns the transform of a prim relative to its parent, and whether it ignores the transforms of
/// all ancestors.
pub(super) fn local_transform(stage: &Stage, prim: &Prim) -> (DAffine3, bool) {
    let (mut whole, mut resets) = (DAffine3::IDENTITY, false);
    report_missing_order(stage, prim);
    for name in &prim.texts(stage, "xformOpOrder") {
        if name == "!resetXformStack!" {
            (whole, resets) = (DAffine3::IDENTITY, true);
            continue;
        }
        let (name, inverted) = match name.strip_prefix("!invert!") {
            Some(name) => (name, true),
            None => (name.as_str(), false),
        };
        let Some(map) = operation(stage, prim, name) else {
            let message = format!("the operation `{name}` of a transform is unknown or has no value: it is left out");
            stage.files.report.unsupported_once(prim.span(), message);
            continue;
        };
        // USD multiplies row vectors from the left, so the first operation is the outermost.
        whole *= if inverted { map.inverse() } else { map };
    }
    (whole, resets)
}

/// Warns about a prim that has operations, but no `xformOpOrder` that applies them.
fn report_missing_order(stage: &Stage, prim: &Prim) {
    let names = prim.property_names();
    let Some(first) =
        names.iter().find(|name| name.starts_with("xformOp:")).filter(|_| !names.contains("xformOpOrder"))
    else {
        return;
    };
    let mut all: Vec<String> =
        names.iter().filter(|name| name.starts_with("xformOp:")).map(|name| format!("\"{name}\"")).collect();
    // The usual order, in which the first operation is the outermost.
    let rank = |name: &String| ["translate", "rotate", "orient", "scale"].iter().position(|kind| name.contains(kind));
    all.sort_by_key(|name| rank(name).unwrap_or(usize::MAX));
    let (what, have) = match all.len() {
        1 => (format!("`{first}` of `{}`", prim.name()), "has"),
        count => (format!("the {count} transforms of `{}`", prim.name()), "have"),
    };
    let message = format!("{what} {have} no effect, because the prim has no `xformOpOrder`");
    let order = all.join(", ");
    let help = format!("add `uniform token[] xformOpOrder = [{order}]`, which lists all operations in order");
    stage.files.report.push(Diagnostic::warning(message).code("missing-field").at(prim.span()).help(help));
}

fn operation(stage: &Stage, prim: &Prim, name: &str) -> Option<DAffine3> {
    let kind = name.strip_prefix("xformOp:")?.split(':').next()?;
    let value = prim.get(stage, name)?.value;
    let numbers = value.numbers();
    let vector = || Some(DVec3::from_slice(numbers.get(..3)?));
    let about = |axis: char, degrees: f64| {
        let (sin, cos) = fp::sin_cos_degrees(degrees);
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
        match axis {
            'X' => DMat3::from_cols(x, DVec3::new(0.0, cos, sin), DVec3::new(0.0, -sin, cos)),
            'Y' => DMat3::from_cols(DVec3::new(cos, 0.0, -sin), y, DVec3::new(sin, 0.0, cos)),
            _ => DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), z),
        }
    };
    let along = |axis: char, number: f64, rest: f64| match axis {
        'X' => DVec3::new(number, rest, rest),
        'Y' => DVec3::new(rest, number, rest),
        _ => DVec3::new(rest, rest, number),
    };
    let axis = kind.chars().last()?;
    match kind {
        "translate" => Some(DAffine3::from_translation(vector()?)),
        "translateX" | "translateY" | "translateZ" => {
            Some(DAffine3::from_translation(along(axis, value.number()?, 0.0)))
        }
        "scale" => Some(DAffine3::from_scale(vector()?)),
        "scaleX" | "scaleY" | "scaleZ" => Some(DAffine3::from_scale(along(axis, value.number()?, 1.0))),
        "rotateX" | "rotateY" | "rotateZ" => Some(DAffine3::from_mat3(about(axis, value.number()?))),
        "orient" => {
            let [w, x, y, z] = *numbers.first_chunk::<4>()?;
            let turn = DQuat::from_xyzw(x, y, z, w);
            (turn.length() > 1e-9).then(|| DAffine3::from_quat(turn.normalize()))
        }
        "transform" => Some(DAffine3::from_mat4(DMat4::from_cols_array(numbers.first_chunk::<16>()?))),
        _ => {
            // `rotateXYZ` turns about x first.
            let axes = kind.strip_prefix("rotate").filter(|axes| axes.len() == 3)?;
            let degrees = vector()?;
            let turn = axes.chars().try_fold(DMat3::IDENTITY, |turn, axis| {
                let degrees = degrees[['X', 'Y', 'Z'].iter().position(|known| *known == axis)?];
                Some(about(axis, degrees) * turn)
            });
            turn.map(DAffine3::from_mat3)
        }
    }
}
