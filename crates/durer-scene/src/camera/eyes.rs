//! One eye or a stereo pair, and the layout of the pair in one picture.
//!
//! In omnidirectional stereo, each eye looks along the tangents of the circle on which it moves as
//! the head turns. Sources: Ishiguro, Yamamoto, Tsuji, *Omni-Directional Stereo*, PAMI 14(2), 1992;
//! Peleg, Ben-Ezra, Pritch, *Omnistereo: Panoramic Stereo Imaging*, PAMI 23(3), 2001.

use super::sheet::PictureSheet;
use crate::describe::described_words;
use crate::math::fp;
use glam::{DVec2, DVec3};

described_words! {
    /// Eye that a stereo camera renders, or layout of both eyes in one picture.
    Eyes { Middle = "middle", Left = "left", Right = "right", SideBySide = "sideBySide", TopBottom = "topBottom" }
}

/// Part of a stereo picture that shows the view of one eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeView {
    /// -1 for the left eye, 1 for the right eye, and 0 for the midpoint between them.
    pub side: f64,
    /// Position of the lower left corner of the view on the full sheet.
    pub corner: DVec2,
}

impl Eyes {
    /// Returns the sheet that holds the views of all eyes, each of which has the size `eye_size`.
    pub fn sheet(self, eye_size: DVec2) -> PictureSheet {
        PictureSheet(match self {
            Eyes::SideBySide => DVec2::new(2.0 * eye_size.x, eye_size.y),
            Eyes::TopBottom => DVec2::new(eye_size.x, 2.0 * eye_size.y),
            _ => eye_size,
        })
    }

    /// Returns the views of all eyes, each of which has the size `eye_size`. The view of the left
    /// eye is on the left or on top.
    pub fn views(self, eye_size: DVec2) -> impl Iterator<Item = EyeView> {
        let view = |side, x, y| EyeView { side, corner: eye_size * DVec2::new(x, y) };
        let (first, second) = match self {
            Eyes::Middle => (view(0.0, 0.0, 0.0), None),
            Eyes::Left => (view(-1.0, 0.0, 0.0), None),
            Eyes::Right => (view(1.0, 0.0, 0.0), None),
            Eyes::SideBySide => (view(-1.0, 0.0, 0.0), Some(view(1.0, 1.0, 0.0))),
            Eyes::TopBottom => (view(-1.0, 0.0, 1.0), Some(view(1.0, 0.0, 0.0))),
        };
        std::iter::once(first).chain(second)
    }

    /// Returns the view that contains a pixel, and the position of a point on the sheet of that
    /// view. Returns `None` if the pixel is outside all views.
    pub fn view(self, eye_size: DVec2, point: DVec2, pixel: DVec2) -> Option<(EyeView, DVec2)> {
        let sheet = self.sheet(eye_size);
        let at = sheet.position(pixel);
        let view = self.views(eye_size).find(|view| PictureSheet(eye_size).contains(at - view.corner))?;
        Some((view, sheet.position(point) - view.corner))
    }

    /// Returns the point of the full picture for a position on the sheet of a view.
    pub fn point(self, eye_size: DVec2, view: EyeView, position: DVec2) -> DVec2 {
        self.sheet(eye_size).point(position + view.corner)
    }
}

/// Circle on which an eye moves in omnidirectional stereo. The eye looks along the tangents of the
/// circle.
///
/// At the heading a, which is 0 ahead and increases to the right, the head looks along h = (sin a,
/// 0, cos a). An eye at the offset r to the right is then at r (cos a, 0, -sin a).
#[derive(Clone, Copy, Debug)]
pub struct EyeCircle {
    /// Signed radius, which is negative for the left eye.
    pub radius: f64,
}

impl EyeCircle {
    /// Returns the position of the eye and its horizontal view direction at a heading in radians.
    pub fn tangent(self, heading: f64) -> (DVec3, DVec3) {
        let (sin, cos) = fp::sin_cos_f64(heading);
        (self.radius * DVec3::new(cos, 0.0, -sin), DVec3::new(sin, 0.0, cos))
    }

    /// Returns the heading at which a point is seen, from -pi to pi, and the horizontal distance of
    /// the point from the eye at that heading. Returns `None` for points inside the circle or on
    /// its axis.
    pub fn heading(self, point: DVec3) -> Option<(f64, f64)> {
        let square = point.x * point.x + point.z * point.z - self.radius * self.radius;
        if square <= 0.0 {
            return None;
        }
        let distance = square.sqrt();
        // Seen from the centre of the circle, the point is farther to the right than seen from the
        // eye. The second angle accounts for this difference.
        let heading = fp::atan2_f64(point.x, point.z) - fp::atan2_f64(self.radius, distance);
        Some((wrap_angle(heading), distance))
    }
}

/// Wraps an angle in radians to the range from -pi to pi.
fn wrap_angle(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    match angle {
        a if a < -PI => a + TAU,
        a if a > PI => a - TAU,
        a => a,
    }
}
