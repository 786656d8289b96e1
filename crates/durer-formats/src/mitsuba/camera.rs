//! Reads the sensor, the film, the sampler and the integrator.
//!
//! Source: *Mitsuba 3 documentation*, "Sensors", "Films" and "Integrators". A camera looks along
//! +z, with +y pointing up and +x pointing to the left.

use super::plugin::Plugin;
use super::state::Reader;
use crate::report::range_text;
use crate::shared_report::NO_COUNTERPART;
use crate::shared_report::suggest;
use durer_diag::Diagnostic;
use durer_image::MAX_PIXELS;
use durer_scene::camera::{Camera, Handedness, OrthographicCamera, PerspectiveCamera, ThinLensCamera};
use durer_scene::math::fp;
use durer_scene::scene::Emitters;
use glam::{DAffine3, DVec2, DVec3};
use std::rc::Rc;

/// Default size of a film, in pixels.
const SIZE: [u32; 2] = [768, 576];
/// Default distances of the near and far clipping planes of Mitsuba's cameras.
const NEAR: f32 = 0.01;
const FAR: f32 = 10_000.0;
/// Number of bounces that replaces an unlimited path length.
const UNLIMITED_BOUNCES: u32 = 64;

const SENSORS: [&str; 3] = ["perspective", "thinlens", "orthographic"];

impl Reader<'_> {
    /// Reads the camera, which is the sensor selected by id or number, or otherwise the first
    /// sensor.
    pub fn camera(&mut self, sensors: &[Rc<Plugin>]) {
        let id = |sensor: &Rc<Plugin>| {
            let ids = self.loader.plugins.iter();
            ids.clone().find(|(_, plugin)| Rc::ptr_eq(plugin, sensor)).map_or(String::new(), |(id, _)| id.clone())
        };
        self.scene.camera_names = sensors.iter().map(id).collect();
        let Some(sensor) = self.chosen(sensors) else { return };
        let report = self.report;
        let (width, height) = self.film(&sensor);
        self.scene.render_defaults.size = Some((width, height));
        self.sampler(&sensor);
        for (property, medium) in self.child_plugins(&sensor, Some("medium")) {
            if let Some((medium, _)) = self.medium(&medium) {
                self.scene.fog = medium.fog(property.at, report);
            }
        }
        let to_world = sensor.transform(report, "to_world");
        let size = DVec2::new(f64::from(width), f64::from(height));
        let camera = match sensor.kind.as_str() {
            "perspective" | "thinlens" => Some(self.perspective(&sensor, to_world, size)),
            "orthographic" => {
                let m = to_world.matrix3;
                let [across, upwards] = [m.x_axis.length(), m.y_axis.length()];
                if (across - upwards).abs() > 1e-4 * across {
                    let what = "a scale of an orthographic camera that differs along x and y has no counterpart: \
                                that along x is used";
                    report.unsupported_once(sensor.span("to_world"), what);
                }
                Some(orthographic(to_world, size, self.clipping(&sensor)))
            }
            other => {
                let what = format!("the sensor `{other}` has no counterpart: a camera that frames the scene is used");
                let warning = Diagnostic::warning(what).code(NO_COUNTERPART).at(sensor.at);
                report.push(Diagnostic { help: suggest(other, SENSORS), ..warning });
                None
            }
        };
        sensor.mark_known(&["near_clip", "far_clip", "shutter_open", "shutter_close"]);
        if camera.is_some() {
            sensor.warn_unused(report);
        }
        self.scene.camera = camera;
        self.scene.camera_span = sensor.at;
    }

    fn chosen(&self, sensors: &[Rc<Plugin>]) -> Option<Rc<Plugin>> {
        let Some(wanted) = &self.input.scene_defaults.camera else { return sensors.first().cloned() };
        let ids = &self.loader.plugins;
        let by_id = ids.get(wanted).filter(|plugin| plugin.element == "sensor").cloned();
        let sensor = by_id.or_else(|| sensors.get(wanted.parse::<usize>().ok()?).cloned());
        if sensor.is_none() {
            let known = ids.iter().filter(|(_, plugin)| plugin.element == "sensor").map(|(id, _)| id.as_str());
            let has = range_text(sensors.len(), "sensor", "sensors");
            let message = format!("unknown sensor `{wanted}`: the file has {has}");
            let help = suggest(wanted, known);
            self.report.push(Diagnostic { help, ..Diagnostic::error(message).code("bad-value") });
        }
        sensor
    }

    fn film(&mut self, sensor: &Plugin) -> (u32, u32) {
        let report = self.report;
        let films = self.child_plugins(sensor, Some("film"));
        let Some((_, film)) = films.first() else { return (SIZE[0], SIZE[1]) };
        let side = |name, default: u32| match film.number(report, name) {
            Some(value) if (1.0..=1048576.0).contains(&value) && value.fract() == 0.0 => value as u32,
            Some(_) => {
                report.error(film.span(name), format!("`{name}` must be a whole number from 1 to {}", 1 << 20));
                default
            }
            None => default,
        };
        let (width, height) = (side("width", SIZE[0]), side("height", SIZE[1]));
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            report.error(film.at, format!("too many pixels: {width} x {height}"));
        }
        let crop = ["crop_offset_x", "crop_offset_y", "crop_width", "crop_height"];
        if crop.iter().any(|name| film.get(name).is_some()) {
            let number = |name, default: u32| film.number(report, name).unwrap_or(default as f32);
            let part = [number(crop[0], 0), number(crop[1], 0), number(crop[2], width), number(crop[3], height)];
            let [left, top, columns, rows] = part.map(|value| value as u32);
            let whole = part.iter().all(|value| *value >= 0.0 && value.fract() == 0.0);
            let fits = |from: u32, count: u32, of: u32| count > 0 && from.saturating_add(count) <= of;
            if whole && fits(left, columns, width) && fits(top, rows, height) {
                self.scene.render_defaults.crop = Some((left, top, columns, rows));
            } else {
                let place = crop.iter().find_map(|name| film.get(name)).map_or(film.at, |property| property.at);
                report
                    .error(place, format!("the crop window must lie within the picture of {width} x {height} pixels"));
            }
        }
        if let Some(format) =
            film.text(report, "pixel_format").filter(|format| !format.to_lowercase().starts_with("rgb"))
        {
            let what = format!("the pixel format `{format}` has no counterpart: `rgb` is used");
            report.unsupported_once(film.span("pixel_format"), what);
        }
        // Ignore output formats and reconstruction filters.
        film.properties.iter().for_each(|property| property.used.set(true));
        (width, height)
    }

    fn sampler(&mut self, sensor: &Plugin) {
        let samplers = self.child_plugins(sensor, Some("sampler"));
        let Some((_, sampler)) = samplers.first() else { return };
        match sampler.number(self.report, "sample_count") {
            Some(count) if (1.0..=1048576.0).contains(&count) => {
                self.scene.render_defaults.samples = Some(count as u32)
            }
            Some(_) => self.report.error(sampler.span("sample_count"), "samples per pixel must be from 1 to 1048576"),
            None => {}
        }
    }

    fn perspective(&self, sensor: &Plugin, to_world: DAffine3, size: DVec2) -> Camera {
        let report = self.report;
        let half = self.half_view(sensor, size);
        let (right, up, forward) = axes(to_world);
        // Ignore the scale, because Mitsuba forbids scaling in the transform of a camera.
        let (center, handedness) = (to_world.translation.as_vec3(), handedness(right, up, forward));
        let angle = ((2.0 * fp::atan_f64(half.max_element())).to_degrees() as f32).clamp(1e-4, 179.99);
        let [direction, up] = [forward, up].map(|v| v.normalize_or(DVec3::Y).as_vec3());
        let offset = |name| f64::from(sensor.number(report, name).unwrap_or(0.0));
        // The offset is a fraction of the film's width and height, and moves the view to the right
        // and down.
        let offset = 2.0 * DVec2::new(offset("principal_point_offset_x"), offset("principal_point_offset_y"));
        let shift = offset * half / half.max_element();
        let aperture = match sensor.kind.as_str() {
            "thinlens" => 2.0 * sensor.positive(report, "aperture_radius").unwrap_or(0.0),
            _ => 0.0,
        };
        let focus = sensor.positive(report, "focus_distance").unwrap_or(1.0);
        if sensor.kind == "thinlens" && aperture == 0.0 {
            report.error(sensor.at, "a `thinlens` needs an `aperture_radius`");
        }
        let (near, far) = self.clipping(sensor);
        if aperture == 0.0 && handedness == Handedness::Right && shift == DVec2::ZERO && near == 0.0 && far.is_none() {
            return PerspectiveCamera { center, direction, up, angle }.into();
        }
        let (shift_right, shift_up) = (shift.x as f32, -shift.y as f32);
        let lens = ThinLensCamera {
            center,
            direction,
            up,
            angle,
            aperture,
            focus_distance: focus,
            handedness,
            near,
            far,
            ..Default::default()
        };
        ThinLensCamera { shift_right, shift_up, ..lens }.into()
    }

    /// Returns the distances of the near and far clipping planes. The default planes are ignored,
    /// because they do not clip anything visible.
    fn clipping(&self, sensor: &Plugin) -> (f32, Option<f32>) {
        let near = sensor.number(self.report, "near_clip").filter(|near| *near > NEAR).unwrap_or(0.0);
        (near, sensor.positive(self.report, "far_clip").filter(|far| *far < FAR))
    }

    /// Returns half the width and half the height of the view at distance 1.
    pub(super) fn half_view(&self, sensor: &Plugin, size: DVec2) -> DVec2 {
        let report = self.report;
        let aspect = size.x / size.y;
        let tan = |degrees: f64| fp::tan_f64(0.5 * degrees.to_radians());
        let (mut fov, mut axis) = (f64::from(sensor.number(report, "fov").unwrap_or(0.0)), "x".to_string());
        if let Some(text) = sensor.text(report, "fov_axis") {
            axis = text;
        }
        match (sensor.text(report, "focal_length"), sensor.get("fov")) {
            (Some(_), Some(fov)) => report.error(fov.at, "a camera takes either `fov` or `focal_length`, but not both"),
            (text, None) => {
                let text = text.unwrap_or("50mm".into());
                let length = text.trim().trim_end_matches("mm").trim().parse::<f64>().ok().filter(|x| *x > 0.0);
                if length.is_none() {
                    let message = format!("expected a length in millimetres such as `50mm`, found `{text}`");
                    report.error(sensor.span("focal_length"), message);
                }
                // The field of view is measured across the diagonal of a 36 x 24 mm film.
                let half = (36f64 * 36.0 + 24.0 * 24.0).sqrt() / 2.0;
                fov = 2.0 * fp::atan_f64(half / length.unwrap_or(50.0)).to_degrees();
                axis = "diagonal".into();
            }
            (None, Some(_)) => {}
        }
        if !(fov > 0.0 && fov < 180.0) {
            report.error(sensor.span("fov"), "a field of view must be more than 0 and less than 180 degrees");
            fov = 45.0;
        }
        let tan = tan(fov);
        let x = match axis.as_str() {
            "x" => tan,
            "y" => tan * aspect,
            "diagonal" => tan * aspect / (1.0 + aspect * aspect).sqrt(),
            "smaller" => tan * aspect.max(1.0),
            "larger" => tan * aspect.min(1.0),
            other => {
                let help = suggest(other, ["x", "y", "diagonal", "smaller", "larger"]);
                report.error_with_help(sensor.span("fov_axis"), format!("unknown axis `{other}`"), help);
                tan
            }
        };
        DVec2::new(x, x / aspect)
    }

    /// Reads the integrator. `max_depth` counts the segments of a path, so `bounces` is smaller by
    /// two.
    pub fn integrator(&mut self, plugin: &Plugin, depth: u32) {
        let report = self.report;
        if self.too_deep(depth, plugin.at) {
            return;
        }
        match plugin.kind.as_str() {
            "path" | "volpath" | "volpathmis" | "prb" | "ptracer" | "bdpt" => {}
            "direct" => {
                self.scene.render_defaults.bounces = Some(0);
                plugin.mark_known(&["emitter_samples", "bsdf_samples", "shading_samples"]);
            }
            // Integrators of these types contain the integrator that renders the picture.
            "aov" | "moment" => {
                for (_, inner) in self.child_plugins(plugin, Some("integrator")) {
                    self.integrator(&inner, depth + 1);
                }
                plugin.mark_known(&["aovs"]);
            }
            other => {
                let what = format!("the integrator `{other}` has no counterpart: path tracing is used");
                let known = ["path", "volpath", "volpathmis", "direct", "aov", "moment", "ptracer", "bdpt"];
                let note = Diagnostic::note(what).code(NO_COUNTERPART).at(plugin.at);
                report.push(Diagnostic { help: suggest(other, known), ..note });
                plugin.properties.iter().for_each(|property| property.used.set(true));
            }
        }
        match plugin.number(report, "max_depth") {
            Some(-1.0) => self.scene.render_defaults.bounces = Some(UNLIMITED_BOUNCES),
            Some(depth) if (0.0..=1e6).contains(&depth) => {
                let (limit, defaults) = (depth as u32, &mut self.scene.render_defaults);
                defaults.bounces = Some(limit.saturating_sub(2));
                defaults.no_scattering = (limit < 2).then(|| (limit, plugin.span("max_depth")));
            }
            Some(_) => report.error(plugin.span("max_depth"), "`max_depth` must be -1 or from 0 to 1000000"),
            None if plugin.kind.contains("path") => self.scene.render_defaults.bounces = Some(UNLIMITED_BOUNCES),
            None => {}
        }
        // At a depth of 0, not even emitters are visible.
        let is_black = self.scene.render_defaults.no_scattering.is_some_and(|(limit, _)| limit == 0);
        if plugin.boolean(report, "hide_emitters") == Some(true) || is_black {
            self.scene.background.emitters = Some(Emitters::Hidden);
        }
        plugin.mark_known(&["rr_depth", "strict_normals", "samples_per_pass", "block_size", "timeout"]);
        plugin.warn_unused(report);
    }
}

/// Returns the axes that point right, up and forward. The length of each axis is the length of one
/// unit of camera space along that axis.
fn axes(to_world: DAffine3) -> (DVec3, DVec3, DVec3) {
    let m = to_world.matrix3;
    (-m.x_axis, m.y_axis, m.z_axis)
}

/// Returns `Handedness::Left` if the picture is mirrored, which means that `right` points to the
/// left of a viewer who looks along `forward`.
fn handedness(right: DVec3, up: DVec3, forward: DVec3) -> Handedness {
    if forward.cross(up).dot(right) < 0.0 { Handedness::Left } else { Handedness::Right }
}

/// Returns an orthographic camera whose view has a width of 2 units of camera space.
fn orthographic(to_world: DAffine3, size: DVec2, (near, far): (f32, Option<f32>)) -> Camera {
    let (right, up, forward) = axes(to_world);
    let across = 2.0 * right.length();
    OrthographicCamera {
        center: to_world.translation.as_vec3(),
        direction: forward.normalize_or(DVec3::NEG_Z).as_vec3(),
        up: up.normalize_or(DVec3::Y).as_vec3(),
        size: (across * (size.y / size.x).max(1.0)) as f32,
        handedness: handedness(right, up, forward),
        near: Some(near),
        far,
    }
    .into()
}
