//! Converts the hair material of pbrt-v3 and pbrt-v4.
//!
//! Source: *Physically Based Rendering*, 4th edition, section 9.9.

use crate::pbrt::defs::{MaterialDef, Texture};
use crate::pbrt::params::Params;
use crate::pbrt::state::Reader;
use durer_diag::Span;
use durer_scene::material::HairMaterial;
use durer_scene::math::Vec3;

impl Reader<'_> {
    /// Reads a hair material, which is defined by its absorption, by its colour (one of the
    /// parameters in `names`) or by its melanin.
    pub(super) fn hair(&self, params: &Params, names: &[&'static str], at: Span) -> MaterialDef {
        let given = names.iter().copied().find(|name| params.get(name).is_some());
        let absorption = params.spectrum("sigma_a").map(|spectrum| spectrum.coefficient().max(Vec3::ZERO));
        let color = given.filter(|_| absorption.is_none()).map(|name| {
            match self.texture_value(params, name, true, Vec3::ONE) {
                Texture::Constant(color) => color,
                Texture::Picture(picture, scale) => {
                    self.mean_of(params, name, &picture).map_or(scale, |mean| mean * scale)
                }
            }
        });
        let has_melanin = ["eumelanin", "pheomelanin"].iter().any(|name| params.get(name).is_some());
        let default = HairMaterial::default();
        let brown = if has_melanin { 0.0 } else { default.eumelanin };
        let value = |name, default| self.value(params, name, default);
        MaterialDef::Hair(
            HairMaterial {
                eumelanin: value("eumelanin", brown).max(0.0),
                pheomelanin: value("pheomelanin", 0.0).max(0.0),
                color: color.map(|color| color.clamp(Vec3::ZERO, Vec3::ONE)),
                absorption,
                longitudinal_roughness: value("beta_m", default.longitudinal_roughness).clamp(0.0, 1.0),
                azimuthal_roughness: value("beta_n", default.azimuthal_roughness).clamp(0.0, 1.0),
                scale_tilt: value("alpha", default.scale_tilt).clamp(-45.0, 45.0),
                ior: value("eta", default.ior).clamp(1.0, 4.0),
            },
            at,
        )
    }
}
