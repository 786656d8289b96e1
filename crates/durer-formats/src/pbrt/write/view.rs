//! Writes the film, the sampler, the integrator and the camera.

use super::text::{Directive, transform};
use super::{PROGRAM, Writer};
use crate::medium::Medium;
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::Emitters;
use glam::DVec2;

impl Writer<'_> {
    pub(super) fn view(&mut self) -> String {
        let (width, height) = self.export.size();
        let mut film = Directive::new("Film", "rgb").integer("xresolution", width).integer("yresolution", height);
        if let Some((left, top, columns, rows)) = self.export.scene.render_defaults.crop {
            film = film.numbers("integer", "pixelbounds", [left, left + columns, top, top + rows]);
        }
        let name = self.export.context.name.rsplit(['/', '\\']).next().unwrap_or_default();
        let name = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let mut text = film.string("filename", &format!("{name}.exr")).line();
        text += &Directive::new("Sampler", "zsobol").integer("pixelsamples", self.export.samples()).line();
        if self.export.scene.background.emitters == Some(Emitters::Hidden) {
            self.export.warn_lost("the camera of pbrt sees all emitters, hidden ones too");
        }
        // `maxdepth` includes the first scattering event.
        text += &Directive::new("Integrator", "volpath").integer("maxdepth", self.export.bounces() + 1).line();
        text += &self.fog();
        text + &self.camera()
    }

    /// Returns the medium around the camera, which is also that around all shapes.
    fn fog(&mut self) -> String {
        let Some(fog) = self.export.fog(PROGRAM) else { return String::new() };
        named_medium("fog", &fog) + "MediumInterface \"\" \"fog\"\n"
    }

    fn camera(&mut self) -> String {
        let Some(view) = self.export.view(PROGRAM) else { return String::new() };
        let (width, height) = self.export.size();
        let sides = DVec2::new(f64::from(width), f64::from(height));
        // The transform maps from world space to camera space.
        let text = transform(&view.frame(view.axes).inverse());
        if view.near > 0.0 || view.far.is_some() {
            self.export.warn_lost("cameras of pbrt have no clipping planes: everything is visible");
        }
        if view.is_orthographic {
            let half = view.half * sides / sides.max_element();
            return text
                + &Directive::new("Camera", "orthographic")
                    .numbers("float", "screenwindow", [-half.x, half.x, -half.y, half.y])
                    .line();
        }
        // The field of view is measured across the shorter side.
        let shorter = view.half * sides.min_element() / sides.max_element();
        let mut camera = Directive::new("Camera", "perspective");
        camera = camera.float("fov", 2.0 * fp::atan_f64(shorter).to_degrees());
        if view.shift != DVec2::ZERO {
            let half = sides / sides.min_element();
            let middle = view.shift * half.max_element();
            let (low, high) = (middle - half, middle + half);
            camera = camera.numbers("float", "screenwindow", [low.x, high.x, low.y, high.y]);
        }
        if view.lens_radius > 0.0 {
            camera = camera.float("lensradius", view.lens_radius).float("focaldistance", view.focus_distance);
        }
        text + &camera.line()
    }
}

/// Returns the directive that names a medium.
pub(super) fn named_medium(name: &str, medium: &Medium) -> String {
    let mut directive = Directive::new("MakeNamedMedium", name).string("type", "homogeneous");
    directive = directive.rgb("sigma_a", medium.absorption.max(Vec3::ZERO)).rgb("sigma_s", medium.scattering);
    if medium.anisotropy != 0.0 {
        directive = directive.float("g", medium.anisotropy);
    }
    directive.line()
}
