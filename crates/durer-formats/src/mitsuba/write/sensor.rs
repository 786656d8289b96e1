//! Writes the sensor, the film, the sampler and the integrator.

use super::element::Element;
use super::{PROGRAM, Writer};
use crate::medium::Medium;
use durer_scene::math::Vec3;
use durer_scene::scene::Emitters;
use glam::{DAffine3, DVec3};

impl Writer<'_> {
    pub(super) fn integrator(&self) -> Element {
        let kind = if self.has_medium { "volpath" } else { "path" };
        // `max_depth` counts the segments of a path, which are two more than the bounces.
        let integrator = Element::plugin("integrator", kind).integer("max_depth", self.export.bounces() + 2);
        match self.export.scene.background.emitters {
            Some(Emitters::Hidden) => integrator.boolean("hide_emitters", true),
            Some(Emitters::Shown) | None => integrator,
        }
    }

    pub(super) fn sensor(&mut self) -> Option<Element> {
        let view = self.export.view(PROGRAM)?;
        let (width, height) = self.export.size();
        let (w, h) = (f64::from(width), f64::from(height));
        let larger = w.max(h);
        let [right, up, forward] = view.axes;
        // In Mitsuba, +x points to the left.
        let frame = view.frame([-right, up, forward]);
        let kind = match (view.is_orthographic, view.lens_radius > 0.0) {
            (true, _) => "orthographic",
            (false, true) => "thinlens",
            (false, false) => "perspective",
        };
        let mut sensor = Element::plugin("sensor", kind);
        if view.is_orthographic {
            // The view is 2 units of camera space wide.
            let half = view.half * w / larger;
            sensor = sensor.transform("to_world", &(frame * DAffine3::from_scale(DVec3::new(half, half, 1.0))));
        } else {
            sensor = sensor.float("fov", view.angle()).text("fov_axis", "larger");
            // The offset is a fraction of the film's width and height, to the right and down.
            for (name, shift, side) in
                [("principal_point_offset_x", view.shift.x, w), ("principal_point_offset_y", -view.shift.y, h)]
            {
                if shift != 0.0 {
                    sensor = sensor.float(name, 0.5 * shift * larger / side);
                }
            }
            if view.lens_radius > 0.0 {
                sensor = sensor.float("aperture_radius", view.lens_radius).float("focus_distance", view.focus_distance);
            }
            if view.near > 0.0 {
                sensor = sensor.float("near_clip", view.near);
            }
            sensor = sensor.transform("to_world", &frame);
        }
        if let Some(far) = view.far {
            sensor = sensor.float("far_clip", far);
        }
        let mut film = Element::plugin("film", "hdrfilm").integer("width", width).integer("height", height);
        if let Some((left, top, columns, rows)) = self.export.scene.render_defaults.crop {
            film = film.integer("crop_offset_x", left).integer("crop_offset_y", top);
            film = film.integer("crop_width", columns).integer("crop_height", rows);
        }
        let sampler = Element::plugin("sampler", "independent").integer("sample_count", self.export.samples());
        let fog = self.export.fog(PROGRAM).map(|fog| self.medium("medium", &fog));
        Some(sensor.and(film).and(sampler).and_all(fog))
    }

    /// Returns the element of a homogeneous medium.
    pub(super) fn medium(&mut self, name: &'static str, medium: &Medium) -> Element {
        self.has_medium = true;
        let extinction = medium.absorption + medium.scattering;
        let albedo = Vec3::from_array(std::array::from_fn(|i| {
            if extinction[i] > 0.0 { (medium.scattering[i] / extinction[i]).clamp(0.0, 1.0) } else { 0.0 }
        }));
        let most = extinction.max_element().max(1e-12);
        let mut element = Element::plugin("medium", "homogeneous").with("name", name);
        element = element.rgb("sigma_t", extinction / most).rgb("albedo", albedo).float("scale", most);
        if medium.anisotropy != 0.0 {
            element = element.and(Element::plugin("phase", "hg").float("g", medium.anisotropy));
        }
        element
    }
}
