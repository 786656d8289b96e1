//! Participating media: homogeneous, or with a volume as density.

use super::plugin::{Key, Plugin};
use super::state::Reader;
use crate::files::named_bytes;
use crate::medium::{Density, Medium};
use crate::vol;
use durer_diag::Diagnostics;
use durer_scene::describe::FileName;
use durer_scene::math::{Color, Vec3};
use glam::{DAffine3, DQuat};
use std::rc::Rc;
use std::sync::Arc;

impl Reader<'_> {
    /// Reads a medium; returns it with the key of its plugin, or `None` if it has no counterpart.
    pub fn medium(&mut self, plugin: &Rc<Plugin>) -> Option<(Medium, Key)> {
        let report = self.report;
        if !matches!(plugin.kind.as_str(), "homogeneous" | "heterogeneous") {
            let what = format!("the medium `{}` has no counterpart: it is ignored", plugin.kind);
            report.once(plugin.at, what);
            return None;
        }
        let scale = plugin.number(report, "scale").unwrap_or(1.0).max(0.0);
        let density = self.density(plugin);
        let color = |name, usual| self.volume_color(plugin, name, usual).max(Vec3::ZERO);
        let (absorption, scattering) = match plugin.get("sigma_s").is_some() || plugin.get("sigma_a").is_some() {
            // Parameters from Mitsuba 0.6.
            true => (color("sigma_a", Vec3::ZERO), color("sigma_s", Vec3::ZERO)),
            false => {
                // If the extinction is a volume, it becomes the density of a medium with an
                // extinction of 1.
                let extinction = if density.is_some() { Vec3::ONE } else { color("sigma_t", Vec3::ONE) };
                let albedo = color("albedo", Vec3::splat(0.75)).min(Vec3::ONE);
                (extinction * (Vec3::ONE - albedo), extinction * albedo)
            }
        };
        let mut anisotropy = 0.0;
        for (_, phase) in self.parts(plugin, Some("phase")) {
            match phase.kind.as_str() {
                "isotropic" => {}
                "hg" => anisotropy = phase.number(report, "g").unwrap_or(0.8).clamp(-0.99, 0.99),
                other => report.once(
                    phase.at,
                    format!("the phase function `{other}` has no counterpart: isotropic scattering is used"),
                ),
            }
        }
        plugin.known(&["sample_emitters", "has_spectral_extinction", "majorant_resolution_factor"]);
        plugin.finish(report);
        let medium = Medium { absorption: scale * absorption, scattering: scale * scattering, anisotropy, density };
        Some((medium, plugin.key()))
    }

    /// Returns a colour that may be a volume; for a grid, its mean.
    fn volume_color(&self, plugin: &Plugin, name: &'static str, usual: Color) -> Color {
        let volume = self.named_part(plugin, name).filter(|volume| volume.kind.ends_with("volume"));
        let Some(volume) = volume else {
            return self.color(plugin, name, usual);
        };
        let color = match volume.kind.as_str() {
            "constvolume" => self.color(&volume, "value", usual),
            _ => {
                let at = volume.at;
                self.report.once(at, format!("a spatially varying `{name}` has no counterpart: its mean is used"));
                let bytes = volume.text(self.report, "filename");
                let bytes = bytes.and_then(|path| named_bytes(self.input, self.report, "the volume", &path, at));
                let mean = bytes.and_then(|(bytes, file)| {
                    self.collect_diagnostics(|found| vol::mean(&bytes, file, self.input.memory, found))
                });
                mean.unwrap_or(usual)
            }
        };
        volume.known(&["to_world", "use_grid_bbox", "raw", "accel", "wrap_mode", "filter_type"]);
        volume.finish(self.report);
        color
    }

    /// Runs a reader that pushes to a `Diagnostics`, and adds its diagnostics to the report.
    fn collect_diagnostics<T>(&self, read: impl FnOnce(&mut Diagnostics) -> T) -> T {
        let mut found = Diagnostics::default();
        let made = read(&mut found);
        self.report.extend(found);
        made
    }

    /// Reads the density of a medium whose extinction is a `gridvolume`.
    fn density(&mut self, plugin: &Plugin) -> Option<Density> {
        let volume = self.named_part(plugin, "sigma_t").filter(|volume| volume.kind == "gridvolume")?;
        let report = self.report;
        let Some(name) = volume.text(report, "filename") else {
            report.bad(volume.at, "a `gridvolume` needs a `filename`");
            return None;
        };
        let at = volume.place("filename");
        let (bytes, file) = named_bytes(self.input, report, "the densities", &name, at)?;
        let (bounds, grid) = self.collect_diagnostics(|found| vol::read(&bytes, file, self.input.memory, found))?;
        let map = volume.map(report, "to_world");
        let own = match volume.truth(report, "use_grid_bbox").unwrap_or(false) {
            true => DAffine3::from_scale_rotation_translation(
                (bounds.max - bounds.min).as_dvec3(),
                DQuat::IDENTITY,
                bounds.min.as_dvec3(),
            ),
            false => DAffine3::IDENTITY,
        };
        volume.known(&["raw", "accel", "wrap_mode", "filter_type"]);
        volume.finish(report);
        self.scene.assets.densities.insert(name.clone(), (bounds, Arc::new(grid)));
        Some(Density { name: FileName { path: name, span: at }, placed: Some(map * own) })
    }
}
