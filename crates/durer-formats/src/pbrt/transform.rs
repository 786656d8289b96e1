//! Current transformation matrix of pbrt, and the directives that change it.

use super::lexer::{Lexer, Token};
use super::params::number;
use crate::shared_report::SharedReport;
use durer_diag::{Diagnostic, Span};
use durer_scene::math::fp;
use glam::{DAffine3, DMat3, DMat4, DVec3};

/// Current transformation matrices of pbrt, which map from the current space to world space when
/// the shutter opens and when it closes. Before `WorldBegin`, they map from world space to camera
/// space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Transforms {
    pub maps: [DAffine3; 2],
    /// Flags for the two maps, which are true if directives change the map, as set by
    /// `ActiveTransform`.
    pub active: [bool; 2],
}

impl Default for Transforms {
    fn default() -> Self {
        Transforms { maps: [DAffine3::IDENTITY; 2], active: [true; 2] }
    }
}

impl Transforms {
    /// Multiplies by `transform` on the right, so that the last directive in the file is applied
    /// first.
    pub fn apply(&mut self, transform: DAffine3) {
        self.change(|now| now * transform);
    }

    /// Changes the maps that are active.
    pub fn change(&mut self, change: impl Fn(DAffine3) -> DAffine3) {
        for (transform, active) in self.maps.iter_mut().zip(self.active) {
            if active {
                *transform = change(*transform);
            }
        }
    }

    /// Returns true if the two maps are different, in which case objects move while the shutter is
    /// open.
    pub fn moves(&self) -> bool {
        self.maps[0] != self.maps[1]
    }
}

/// Reads `N` numbers after a directive, with or without brackets.
pub(super) fn numbers<const N: usize>(text: &mut Lexer, directive: Span, report: &SharedReport) -> Option<[f64; N]> {
    let open = text.peek(report).filter(|token| token.token == Token::Open).map(|token| token.at);
    if open.is_some() {
        text.next(report);
    }
    let mut all = [0.0; N];
    for (i, value) in all.iter_mut().enumerate() {
        let Some(token) = text.peek(report).filter(|token| token.token == Token::Word).cloned() else {
            let message = format!("{} needs {N} numbers, found {i}", text.quoted(directive));
            report.push(Diagnostic::error(message).code("bad-value").at(directive));
            return None;
        };
        text.next(report);
        *value = number(text, token.at, report)?;
    }
    if let Some(open) = open
        && text.next(report).is_none_or(|token| token.token != Token::Close)
    {
        let message = format!("these brackets must contain {N} numbers and be closed");
        report.push(Diagnostic::error(message).code("unclosed").at(open));
        return None;
    }
    Some(all)
}

/// Returns the affine map that a matrix of 16 numbers in column-major order represents.
pub(super) fn matrix(m: [f64; 16], at: Span, report: &SharedReport) -> Option<DAffine3> {
    let matrix = DMat4::from_cols_array(&m);
    let [a, b, c, d] = [m[3], m[7], m[11], m[15]];
    if d == 0.0 || [a, b, c].iter().any(|x| (x / d).abs() > 1e-9) {
        report.error(at, "this matrix is not affine: the last numbers of its columns must be 0 0 0 1");
        return None;
    }
    let transform = DAffine3::from_mat4(matrix * (1.0 / d));
    invertible(transform, at, report)
}

/// Returns a map if it is invertible, and reports an error if it is singular.
pub(super) fn invertible(transform: DAffine3, at: Span, report: &SharedReport) -> Option<DAffine3> {
    let determinant = transform.matrix3.determinant();
    if determinant == 0.0 || !determinant.is_finite() || !transform.inverse().is_finite() {
        report.push(
            Diagnostic::error("this transform flattens space, or has numbers that are too large")
                .code("flat-transform")
                .at(at),
        );
        return None;
    }
    Some(transform)
}

/// Returns the rotation by an angle in degrees around an axis of any length.
pub(super) fn rotation([degrees, x, y, z]: [f64; 4]) -> Option<DAffine3> {
    let axis = DVec3::new(x, y, z).try_normalize()?;
    let (sin, cos) = fp::sin_cos_degrees(degrees);
    let column = |v: DVec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    Some(DAffine3::from_mat3(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))))
}

/// Returns the map from world space to the space of a camera at `e` that looks along +z towards
/// `l`. In that space, +x points to the right, so it is left-handed.
///
/// Source: *Physically Based Rendering*, 4th edition, section 3.9.7.
pub(super) fn look_at([ex, ey, ez, lx, ly, lz, ux, uy, uz]: [f64; 9]) -> Option<DAffine3> {
    let (eye, at, up) = (DVec3::new(ex, ey, ez), DVec3::new(lx, ly, lz), DVec3::new(ux, uy, uz));
    let forward = (at - eye).try_normalize()?;
    let right = up.try_normalize()?.cross(forward).try_normalize()?;
    let transform = DAffine3 { matrix3: DMat3::from_cols(right, forward.cross(right), forward), translation: eye };
    Some(transform.inverse())
}
