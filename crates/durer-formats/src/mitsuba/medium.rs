//! Converts participating media, which are homogeneous or have a volume as their density.

use super::plugin::{Key, Plugin};
use super::state::Reader;
use crate::files::read_named;
use crate::medium::{Density, Medium};
use crate::vol;
use durer_diag::Diagnostics;
use durer_scene::describe::FileName;
use durer_scene::math::{Color, Vec3};
use glam::{DAffine3, DQuat};
use std::rc::Rc;
use std::sync::Arc;

impl Reader<'_> {
    /// Reads a medium and returns it with the key of its plugin, or `None` if Dürer has no
    /// counterpart.
    pub fn medium(&mut self, plugin: &Rc<Plugin>) -> Option<(Medium, Key)> {
        let report = self.report;
        if !matches!(plugin.kind.as_str(), "homogeneous" | "heterogeneous") {
            let what = format!("the medium `{}` has no counterpart: it is ignored", plugin.kind);
            report.unsupported_once(plugin.at, what);
            return None;
        }
        let scale = plugin.number(report, "scale").unwrap_or(1.0).max(0.0);
        let density = self.density(plugin);
        let color = |name, default| self.volume_color(plugin, name, default).max(Vec3::ZERO);
        let (absorption, scattering) = match plugin.get("sigma_s").is_some() || plugin.get("sigma_a").is_some() {
            // These parameters are from Mitsuba 0.6.
            true => (color("sigma_a", Vec3::ZERO), color("sigma_s", Vec3::ZERO)),
            false => {
                // If the extinction is a volume, the volume becomes the density of a medium whose
                // extinction is 1.
                let extinction = if density.is_some() { Vec3::ONE } else { color("sigma_t", Vec3::ONE) };
                let albedo = color("albedo", Vec3::splat(0.75)).min(Vec3::ONE);
                (extinction * (Vec3::ONE - albedo), extinction * albedo)
            }
        };
        let mut anisotropy = 0.0;
        for (_, phase) in self.child_plugins(plugin, Some("phase")) {
            match phase.kind.as_str() {
                "isotropic" => {}
                "hg" => anisotropy = phase.number(report, "g").unwrap_or(0.8).clamp(-0.99, 0.99),
                other => report.unsupported_once(
                    phase.at,
                    format!("the phase function `{other}` has no counterpart: isotropic scattering is used"),
                ),
            }
        }
        plugin.mark_known(&["sample_emitters", "has_spectral_extinction", "majorant_resolution_factor"]);
        plugin.warn_unused(report);
        let medium = Medium { absorption: scale * absorption, scattering: scale * scattering, anisotropy, density };
        Some((medium, plugin.key()))
    }

    /// Returns a colour that may be given by a volume. For a grid, returns the mean of its values.
    fn volume_color(&self, plugin: &Plugin, name: &'static str, default: Color) -> Color {
        let volume = self.named_plugin(plugin, name).filter(|volume| volume.kind.ends_with("volume"));
        let Some(volume) = volume else {
            return self.color(plugin, name, default);
        };
        let color = match volume.kind.as_str() {
            "constvolume" => self.color(&volume, "value", default),
            _ => {
                let at = volume.at;
                self.report
                    .unsupported_once(at, format!("a spatially varying `{name}` has no counterpart: its mean is used"));
                let bytes = volume.text(self.report, "filename");
                let bytes = bytes.and_then(|path| read_named(self.input, self.report, "the volume", &path, at));
                let mean = bytes.and_then(|(bytes, file)| {
                    self.collect_diagnostics(|diagnostics| vol::mean(&bytes, file, self.input.memory, diagnostics))
                });
                mean.unwrap_or(default)
            }
        };
        volume.mark_known(&["to_world", "use_grid_bbox", "raw", "accel", "wrap_mode", "filter_type"]);
        volume.warn_unused(self.report);
        color
    }

    /// Runs a reader that writes to a `Diagnostics`, and adds its diagnostics to the report.
    fn collect_diagnostics<T>(&self, read: impl FnOnce(&mut Diagnostics) -> T) -> T {
        let mut diagnostics = Diagnostics::default();
        let result = read(&mut diagnostics);
        self.report.extend(diagnostics);
        result
    }

    /// Reads the density of a medium whose extinction is a `gridvolume`.
    fn density(&mut self, plugin: &Plugin) -> Option<Density> {
        let volume = self.named_plugin(plugin, "sigma_t").filter(|volume| volume.kind == "gridvolume")?;
        let report = self.report;
        let Some(name) = volume.text(report, "filename") else {
            report.error(volume.at, "a `gridvolume` needs a `filename`");
            return None;
        };
        let at = volume.span("filename");
        let (bytes, file) = read_named(self.input, report, "the densities", &name, at)?;
        let (bounds, grid) =
            self.collect_diagnostics(|diagnostics| vol::read(&bytes, file, self.input.memory, diagnostics))?;
        let to_world = volume.transform(report, "to_world");
        let own = match volume.boolean(report, "use_grid_bbox").unwrap_or(false) {
            true => DAffine3::from_scale_rotation_translation(
                (bounds.max - bounds.min).as_dvec3(),
                DQuat::IDENTITY,
                bounds.min.as_dvec3(),
            ),
            false => DAffine3::IDENTITY,
        };
        volume.mark_known(&["raw", "accel", "wrap_mode", "filter_type"]);
        volume.warn_unused(report);
        self.scene.assets.densities.insert(name.clone(), (bounds, Arc::new(grid)));
        Some(Density { name: FileName { path: name, span: at }, to_world: Some(to_world * own) })
    }
}
