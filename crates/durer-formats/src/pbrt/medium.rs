//! Reads participating media, which can be inside shapes or around the camera.
//!
//! Coefficients are given per unit of length in world space. Source of the conventions and of the
//! default coefficients:
//! *Physically Based Rendering*, 4th edition, chapter 11.

use super::defs::MaterialDef;
use super::language::Language;
use super::params::{Param, Params};
use super::state::Reader;
use crate::medium::{Density, Medium};
use crate::shared_report::suggest;
use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Walls;
use durer_scene::math::{Aabb, Vec3};
use durer_scene::medium::DensityGrid;
use glam::{DAffine3, DQuat, DVec3};
use std::rc::Rc;
use std::sync::Arc;

/// Reduced scattering and absorption coefficients per millimetre, for red, green and blue.
///
/// Source: Jensen, Marschner, Levoy and Hanrahan, *A Practical Model for Subsurface Light
/// Transport*, SIGGRAPH 2001, table 5.
const MEASURED_MEDIA: [(&str, [f32; 3], [f32; 3]); 12] = [
    ("Apple", [2.29, 2.39, 1.97], [0.003, 0.0034, 0.046]),
    ("Chicken1", [0.15, 0.21, 0.38], [0.015, 0.077, 0.19]),
    ("Chicken2", [0.19, 0.25, 0.32], [0.018, 0.088, 0.2]),
    ("Cream", [7.38, 5.47, 3.15], [0.0002, 0.0028, 0.0163]),
    ("Ketchup", [0.18, 0.07, 0.03], [0.061, 0.97, 1.45]),
    ("Marble", [2.19, 2.62, 3.0], [0.0021, 0.0041, 0.0071]),
    ("Potato", [0.68, 0.7, 0.55], [0.0024, 0.009, 0.12]),
    ("Skimmilk", [0.7, 1.22, 1.9], [0.0014, 0.0025, 0.0142]),
    ("Skin1", [0.74, 0.88, 1.01], [0.032, 0.17, 0.48]),
    ("Skin2", [1.09, 1.59, 1.79], [0.013, 0.07, 0.145]),
    ("Spectralon", [11.6, 20.4, 14.9], [0.0, 0.0, 0.0]),
    ("Wholemilk", [2.55, 3.21, 3.77], [0.0011, 0.0024, 0.014]),
];

/// Default coefficients of absorption and of scattering.
const DEFAULT_COEFFICIENTS: [[f32; 3]; 2] = [[0.0011, 0.0024, 0.014], [2.55, 3.21, 3.77]];

/// Returns the medium defined by `sigma_a`, `sigma_s`, `g` and `scale`, or the measured medium that
/// the parameter `preset` names.
pub(super) fn medium_of(params: &Params, preset: &'static str) -> Medium {
    with_preset(params, preset, DEFAULT_COEFFICIENTS)
}

/// Returns the medium, using the given default coefficients of absorption and scattering. See
/// [`medium_of`].
fn with_preset(params: &Params, preset: &'static str, [usual_a, usual_s]: [[f32; 3]; 2]) -> Medium {
    let scale = params.float("scale").unwrap_or(1.0).max(0.0);
    if let Some(name) = params.text(preset).filter(|name| !name.is_empty()) {
        match MEASURED_MEDIA.iter().find(|row| row.0 == name) {
            Some((_, scattering, absorption)) => {
                params.mark_known(&["sigma_a", "sigma_s", "g"]);
                let [scattering, absorption] = [scattering, absorption].map(|row| scale * Vec3::from_array(*row));
                return Medium { absorption, scattering, anisotropy: 0.0, density: None };
            }
            None => {
                let message = format!("unknown medium preset `{name}`: the coefficients of the medium are used");
                params.report.unsupported_once(params.span(preset), message);
            }
        }
    }
    let coefficient = |name, default: [f32; 3]| {
        let value = params.spectrum(name).map(|spectrum| spectrum.coefficient());
        scale * value.unwrap_or(Vec3::from_array(default))
    };
    params.warn_unsupported(&["Le", "Lescale", "Le_scale"], "the medium emits no light");
    Medium {
        absorption: coefficient("sigma_a", usual_a),
        scattering: coefficient("sigma_s", usual_s),
        anisotropy: params.float("g").unwrap_or(0.0).clamp(-0.99, 0.99),
        density: None,
    }
}

impl Reader<'_> {
    /// Executes `MakeNamedMedium`.
    pub fn make_named_medium(&mut self, name: String, at: Span, list: Vec<Rc<Param>>) {
        let params = self.params(list, Some(super::state::MEDIUM), at);
        let kind = params.text("type").unwrap_or("homogeneous").to_string();
        let medium = match kind.as_str() {
            "homogeneous" => {
                let medium = medium_of(&params, "preset");
                params.warn_unused(&format!("the medium `{name}`"));
                Some(medium)
            }
            "uniformgrid" | "heterogeneous" => self.grid(&name, &params),
            "rgbgrid" | "cloud" | "nanovdb" => {
                let what = format!("media of type `{kind}` have no counterpart: they are ignored");
                self.report.unsupported_once(at, what);
                None
            }
            other => {
                let help = suggest(other, ["homogeneous", "uniformgrid", "rgbgrid", "cloud", "nanovdb"]);
                return self.report.error_with_help(at, format!("unknown type of medium `{other}`"), help);
            }
        };
        if self.media.insert(name.clone(), medium).is_some() {
            self.report.error(at, format!("the medium `{name}` is already defined"));
        }
    }

    /// Reads a medium whose density is given by a grid of values at the cell centres.
    fn grid(&mut self, name: &str, params: &Params) -> Option<Medium> {
        let default = match params.language {
            Language::V3 => DEFAULT_COEFFICIENTS,
            Language::V4 => [[1.0; 3]; 2],
        };
        let medium = with_preset(params, "preset", default);
        params.warn_unsupported(&["temperature", "temperaturescale", "temperatureoffset"], "the medium emits no light");
        let counts = ["nx", "ny", "nz"].map(|name| params.integer(name).unwrap_or(1));
        let corner = |name, default| params.triple(name).unwrap_or(default).as_dvec3();
        let (low, high) = (corner("p0", Vec3::ZERO), corner("p1", Vec3::ONE));
        let densities = params.floats("density").map(<[f64]>::to_vec);
        params.warn_unused(&format!("the medium `{name}`"));
        let Some(densities) = densities else {
            self.report.error(params.at, "this medium needs a `density`");
            return None;
        };
        let place = params.span("density");
        let wanted = counts.iter().try_fold(1_i64, |product, &n| product.checked_mul(n.max(0)));
        if wanted != Some(densities.len() as i64) {
            let [x, y, z] = counts;
            let count = densities.len();
            self.report.error(
                place,
                format!("`density` needs {x} x {y} x {z} numbers, as given by `nx`, `ny` and `nz`, but has {count}"),
            );
            return None;
        }
        if let Some(bad) = densities.iter().position(|density| *density < 0.0) {
            self.report
                .error(place, format!("density number {} is {}, but must be 0 or more", bad + 1, densities[bad]));
            return None;
        }
        // Surround the grid with zeros, because the density outside it is 0.
        let [nx, ny, nz] = counts.map(|n| n as usize);
        let mut values = vec![0.0; (nx + 2) * (ny + 2) * (nz + 2)];
        for (i, row) in densities.chunks_exact(nx).enumerate() {
            let start = ((i / ny + 1) * (ny + 2) + i % ny + 1) * (nx + 2) + 1;
            values[start..start + nx].iter_mut().zip(row).for_each(|(value, density)| *value = *density as f32);
        }
        let grid = DensityGrid::new(counts.map(|n| n as u32 + 2), values)?;
        let path = format!("{}#densities-{}.vol", self.input.name, self.scene.assets.densities.len());
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        self.scene.assets.densities.insert(path.clone(), (bounds, Arc::new(grid)));
        let cell = (high - low) / DVec3::from_array(counts.map(|n| n as f64));
        let transform = DAffine3::from_scale_rotation_translation(high - low + 2.0 * cell, DQuat::IDENTITY, low - cell);
        let to_world = Some(self.state.transforms.maps[0] * transform);
        Some(Medium { density: Some(Density { name: FileName { path, span: place }, to_world }), ..medium })
    }

    /// Sets the media inside and outside the shapes that follow. The two media must already be
    /// defined.
    pub fn medium_interface(&mut self, names: &[String; 2], at: Span) {
        for name in names.iter().filter(|name| !name.is_empty() && !self.media.contains_key(*name)) {
            let help = suggest(name, self.media.keys().map(String::as_str));
            self.report.error_with_help(at, format!("unknown medium `{name}`"), help);
        }
        let [inside, outside] = names.clone().map(|name| (!name.is_empty()).then_some(name));
        (self.state.inside, self.state.outside) = (inside, outside);
    }

    /// Returns the index of the current material, filled with the medium that is inside the shape.
    pub fn material_with_medium(&mut self) -> usize {
        let plain = self.state.material;
        let Some(name) = self.state.inside.clone() else { return plain };
        let Some(Some(medium)) = self.media.get(&name).cloned() else { return plain };
        if let Some(cached) = self.materials_with_medium.get(&(plain, name.clone())) {
            return *cached;
        }
        let material = match &self.materials[plain] {
            MaterialDef::Interface => {
                let mut m =
                    PrincipledMaterial { specular_ior: 1.0, transmission_weight: 1.0, ..PrincipledMaterial::default() };
                medium.fill(&mut m);
                MaterialDef::Principled(Box::new(m), Span::default())
            }
            MaterialDef::Principled(layers, at) if layers.transmission_weight > 0.0 && layers.walls == Walls::Solid => {
                let mut m = layers.clone();
                medium.fill(&mut m);
                MaterialDef::Principled(m, *at)
            }
            // Light does not enter shapes that have other materials.
            _ => return plain,
        };
        self.materials.push(material);
        let number = self.materials.len() - 1;
        self.materials_with_medium.insert((plain, name), number);
        number
    }

    /// Represents the medium around the camera as fog.
    pub fn fog(&mut self, at: Span) {
        let Some(Some(medium)) = self.state.outside.as_ref().and_then(|name| self.media.get(name)).cloned() else {
            return;
        };
        if let Some(fog) = medium.fog(at, self.report) {
            self.scene.fog = Some(fog);
        }
    }
}
