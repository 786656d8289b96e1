//! Writes the camera.

use super::prim::Prim;
use super::{PROGRAM, Writer};

/// Focal length in tenths of a world unit.
const FOCAL_LENGTH: f64 = 50.0;
/// Near and far distance that cut nothing off.
const CLIPPING: [f32; 2] = [1e-4, 1e6];

impl Writer<'_> {
    pub(super) fn camera(&mut self) -> Option<Prim> {
        let view = self.export.view(PROGRAM)?;
        let (width, height) = self.export.size();
        let (w, h) = (f64::from(width), f64::from(height));
        let [right, up, forward] = view.axes;
        if right.cross(up).dot(forward) > 0.0 {
            self.export.warn_lost("mirrored views cannot be written to USD: the view is not mirrored");
        }
        let frame = view.frame([up.cross(-forward), up, -forward]);
        // The size of the film, whose sides are in tenths of a world unit.
        let larger = match view.is_orthographic {
            true => 20.0 * view.half,
            false => 2.0 * view.half * FOCAL_LENGTH,
        };
        let side = larger / w.max(h);
        let shift = 0.5 * larger * view.shift;
        let mut camera = Prim::new("Camera", "Camera")
            .line(format!(
                "token projection = \"{}\"",
                if view.is_orthographic { "orthographic" } else { "perspective" }
            ))
            .line(format!("float focalLength = {FOCAL_LENGTH}"))
            .line(format!("float horizontalAperture = {}", (side * w) as f32))
            .line(format!("float verticalAperture = {}", (side * h) as f32));
        if view.shift != glam::DVec2::ZERO {
            camera = camera
                .line(format!("float horizontalApertureOffset = {}", shift.x as f32))
                .line(format!("float verticalApertureOffset = {}", shift.y as f32));
        }
        if view.lens_radius > 0.0 {
            let diameter = 2.0 * f64::from(view.lens_radius);
            camera = camera
                .line(format!("float fStop = {}", (0.1 * FOCAL_LENGTH / diameter) as f32))
                .line(format!("float focusDistance = {}", view.focus_distance));
        }
        let [near, far] = CLIPPING;
        let clipping = [view.near.max(near), view.far.unwrap_or(far)];
        camera = camera.line(format!("float2 clippingRange = ({}, {})", clipping[0], clipping[1]));
        Some(camera.transform(&frame))
    }
}
