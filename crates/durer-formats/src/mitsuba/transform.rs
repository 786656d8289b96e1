//! Reads transforms. The transform that comes first in the file is applied first.

use super::load::{ErrorReported, Loader, numbers};
use crate::shared_report::suggest;
use crate::xml::{Tag, Xml};
use durer_diag::Diagnostic;
use durer_scene::math::fp;
use durer_scene::scene::MatrixOp;
use glam::{DAffine3, DMat3, DMat4, DVec3};

const TRANSFORMS: [&str; 6] = ["translate", "rotate", "scale", "matrix", "lookat", "lookAt"];

impl Loader<'_> {
    /// Reads a `<transform>` element and combines its operations into one affine matrix.
    pub(super) fn transform(&mut self, xml: &mut Xml) -> Result<DAffine3, ErrorReported> {
        let mut transform = DAffine3::IDENTITY;
        while let Some(tag) = self.next_leaf(xml)? {
            let Some(step) = step(self, &tag) else { continue };
            transform = step * transform;
            let finite = |transform: &DAffine3| transform.to_cols_array().iter().all(|x| (*x as f32).is_finite());
            if !finite(&transform) || transform.matrix3.determinant() == 0.0 || !finite(&transform.inverse()) {
                self.error(tag.at, "this step gives the transform no inverse", None);
                transform = DAffine3::IDENTITY;
            }
        }
        Ok(transform)
    }
}

/// Returns the matrix of Rodrigues' rotation formula for an axis of any length. The matrix is a
/// rotation only if the length is 1.
fn stretched(axis: DVec3, degrees: f64) -> DMat3 {
    let (sin, cos) = fp::sin_cos_degrees(degrees);
    let across = DMat3::from_cols(
        DVec3::new(0.0, axis.z, -axis.y),
        DVec3::new(-axis.z, 0.0, axis.x),
        DVec3::new(axis.y, -axis.x, 0.0),
    );
    let along = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    DMat3::from_diagonal(DVec3::splat(cos)) + across * sin + along * (1.0 - cos)
}

/// Returns Mitsuba's orthonormal basis whose third axis is the given direction.
///
/// Source: Duff and others, *Building an Orthonormal Basis, Revisited*, JCGT 6(1), 2017.
pub(super) fn frame(n: DVec3) -> DMat3 {
    let sign = 1f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    DMat3::from_cols(
        DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
        DVec3::new(b, sign + n.y * n.y * a, -n.y),
        n,
    )
}

fn step(loader: &Loader, tag: &Tag) -> Option<DAffine3> {
    match tag.name {
        "translate" => loader.triple(tag, 0.0).map(DAffine3::from_translation),
        "scale" => {
            // A single number is used for all three axes.
            let one = match tag.get("value") {
                Some(value) => numbers(&loader.substituted(value)?),
                None => None,
            };
            match one.as_deref() {
                Some(&[one]) => Some(DAffine3::from_scale(DVec3::splat(one))),
                _ => loader.triple(tag, 1.0).map(DAffine3::from_scale),
            }
        }
        "rotate" => {
            let [angle] = loader.numbers(&loader.attribute(tag, "angle")?)?;
            let axis = loader.triple(tag, 0.0)?;
            // Quarters of pi to 2 pi, with the digits that people write.
            let quarters = angle.abs() / std::f64::consts::FRAC_PI_4;
            if angle.fract() != 0.0 && (1.0..8.5).contains(&quarters) && (quarters - quarters.round()).abs() < 2e-3 {
                let message =
                    format!("this angle looks like radians, but angles are in degrees: {}", angle.to_degrees().round());
                loader.warn_value(tag.at, message);
            }
            if axis == DVec3::ZERO {
                loader.error(tag.at, "a rotation needs an axis, for example `x=\"1\"`", None);
                return None;
            }
            let turned = MatrixOp::Rotate(axis.normalize().as_vec3(), angle as f32).matrix();
            if loader.is_old || (axis.length() - 1.0).abs() < 1e-4 {
                return Some(turned);
            }
            loader.warn(
                tag.at,
                "the axis of this rotation does not have length 1, so the rotation also scales, as in Mitsuba 3",
            );
            Some(DAffine3::from_mat3(stretched(axis, angle)))
        }
        "matrix" => {
            let attribute = loader.attribute(tag, "value")?;
            match numbers(&attribute.0).as_deref() {
                Some(nine) if nine.len() == 9 => Some(DAffine3::from_mat3(DMat3::from_cols_slice(nine).transpose())),
                Some(all) if all.len() == 16 => {
                    if all[12..] != [0.0, 0.0, 0.0, 1.0] {
                        loader.error(attribute.1, "the last row of a matrix must be 0 0 0 1", None);
                        return None;
                    }
                    Some(DAffine3::from_mat4(DMat4::from_cols_slice(all).transpose()))
                }
                _ => {
                    loader.error(attribute.1, "a matrix needs 16 or 9 numbers", None);
                    None
                }
            }
        }
        "lookat" | "lookAt" => {
            let point = |name| loader.numbers::<3>(&loader.attribute(tag, name)?).map(DVec3::from_array);
            let (origin, target) = (point("origin")?, point("target")?);
            let forward = (target - origin).try_normalize();
            let up = if tag.get("up").is_some() { point("up")? } else { DVec3::ZERO };
            if let (Some(written), true) = (tag.get("up"), up == DVec3::ZERO) {
                let warning = Diagnostic::warning("`up` is 0 0 0: the picture has an arbitrary rotation");
                loader.report.push(warning.code("bad-value").at(written.at).help("write `up=\"0, 1, 0\"`"));
            }
            // If `up` is missing, use the first axis of Mitsuba's basis around the view direction.
            let up = if up == DVec3::ZERO { frame(forward.unwrap_or(DVec3::Z)).x_axis } else { up };
            let left = forward.and_then(|forward| up.cross(forward).try_normalize());
            let (Some(forward), Some(left)) = (forward, left) else {
                loader.error(
                    tag.at,
                    "`origin` and `target` must differ, and `up` must not be parallel to the viewing direction",
                    None,
                );
                return None;
            };
            let axes = DMat3::from_cols(left, forward.cross(left), forward);
            Some(DAffine3 { matrix3: axes, translation: origin })
        }
        other => {
            loader.error(tag.at, format!("a transform cannot contain `<{other}>`"), suggest(other, TRANSFORMS));
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_about_axis_of_any_length_is_that_of_mitsuba_3() {
        // Columns of the matrix that `rotate([1, 2, .5], 40)` returns in Mitsuba 3.9.
        let theirs = [
            1.0,
            0.789_304_9,
            -1.168_597_3,
            0.146_517_34,
            1.701_866_6,
            0.876_743_14,
            1.402_553,
            -0.408_832,
            0.824_533_36,
        ];
        let ours = stretched(DVec3::new(1.0, 2.0, 0.5), 40.0).to_cols_array();
        assert!(ours.iter().zip(theirs).all(|(a, b)| (a - b).abs() < 1e-6), "{ours:?}");
        let unit = stretched(DVec3::new(0.6, 0.0, 0.8), 70.0);
        let turned = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 70.0_f64.to_radians());
        assert!((unit - turned).to_cols_array().iter().all(|x| x.abs() < 1e-12));
    }
}
