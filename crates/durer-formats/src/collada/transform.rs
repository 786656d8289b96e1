//! Transforms of nodes.

use super::document::Element;
use crate::growth::ResourceLimits;
use crate::shared_report::SharedReport;
use durer_scene::math::fp;
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

/// Returns the transform of a node relative to its parent, which is the product of its elements in
/// the order of the file.
pub(super) fn local_transform(node: &Element, report: &SharedReport, limits: &ResourceLimits) -> DAffine3 {
    let mut whole = DAffine3::IDENTITY;
    for step in &node.children {
        let map = match step.name {
            "matrix" => step.exactly(report, limits).map(from_rows),
            "translate" => step.exactly(report, limits).map(|v| DAffine3::from_translation(v.into())),
            "scale" => step.exactly(report, limits).map(|v| DAffine3::from_scale(v.into())),
            "rotate" => step.exactly(report, limits).and_then(rotation),
            "lookat" => {
                let map = step.exactly(report, limits).map(look_at);
                if map == Some(None) {
                    report.warn_once("bad-value", step.at, "a `lookat` that has no direction is left out");
                }
                map.flatten()
            }
            "skew" => {
                report.unsupported_once(step.at, "`skew` has no counterpart: it is left out");
                None
            }
            _ => None,
        };
        whole *= map.unwrap_or(DAffine3::IDENTITY);
    }
    whole
}

/// Returns the transform of a matrix whose rows are given.
pub(super) fn from_rows(rows: [f64; 16]) -> DAffine3 {
    DAffine3::from_mat4(DMat4::from_cols_array(&rows).transpose())
}

/// Returns a rotation about an axis, by an angle in degrees.
fn rotation([x, y, z, degrees]: [f64; 4]) -> Option<DAffine3> {
    let axis = DVec3::new(x, y, z).try_normalize()?;
    let (sin, cos) = fp::sin_cos_degrees(0.5 * degrees);
    Some(DAffine3::from_quat(DQuat::from_vec4((sin * axis).extend(cos))))
}

/// Returns the transform that places something at a point, turned so that -z points to a target.
fn look_at([ex, ey, ez, tx, ty, tz, ux, uy, uz]: [f64; 9]) -> Option<DAffine3> {
    let [eye, target, up] = [DVec3::new(ex, ey, ez), DVec3::new(tx, ty, tz), DVec3::new(ux, uy, uz)];
    let z = (eye - target).try_normalize()?;
    let x = up.cross(z).try_normalize()?;
    Some(DAffine3 { matrix3: DMat3::from_cols(x, z.cross(x), z), translation: eye })
}
