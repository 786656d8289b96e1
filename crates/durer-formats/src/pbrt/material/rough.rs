//! Reads the roughness parameters of pbrt-v3's materials.

use super::super::params::{Kind, Params};
use super::super::state::Reader;
use durer_scene::bsdf::microfacet::Ggx;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::Switch;
use durer_scene::math::fp;

/// Roughness of a pbrt-v3 material: GGX's alpha, and optionally a picture that multiplies it.
pub(super) struct Roughness {
    picture: Option<FileName>,
    /// GGX alpha along u and along v.
    pub alphas: [f32; 2],
}

impl Roughness {
    pub fn new(alphas: [f32; 2]) -> Self {
        Roughness { picture: None, alphas }
    }

    /// Sets the roughness and anisotropy of a material.
    pub fn apply(&self, m: &mut PrincipledMaterial) {
        m.energy_compensation = Switch::Off;
        m.specular_roughness_texture = self.picture.clone();
        [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(self.alphas);
    }
}

/// Converts a roughness of pbrt-v3, which is in [0, 1], to GGX's alpha.
///
/// Source: *Physically Based Rendering*, 3rd edition, section 8.4.2.
pub(in crate::pbrt) fn alpha_of_roughness(roughness: f32) -> f32 {
    let x = fp::ln(roughness.max(1e-3));
    1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)))
}

impl Reader<'_> {
    /// Reads the roughness from the parameter named `both`, which applies to both directions. If
    /// `each` is true, `uroughness` and `vroughness` take precedence in their own direction.
    pub(super) fn rough(&mut self, params: &Params, both: Option<&'static str>, each: bool, default: f32) -> Roughness {
        const EACH: [&str; 2] = ["uroughness", "vroughness"];
        let remapped = params.boolean("remaproughness").unwrap_or(true);
        let alpha = |roughness: f32| if remapped { alpha_of_roughness(roughness) } else { roughness };
        let names = if each { EACH.map(|name| params.get(name)) } else { [None; 2] };
        let texture = |i: usize| names[i].filter(|param| param.kind == Kind::Texture).map(|param| param.text());
        let pictured = match (names[0].is_some() || names[1].is_some(), both) {
            (true, _) if texture(0).is_some() && texture(0) == texture(1) => Some(EACH[0]),
            (true, _) => None,
            (false, both) => both,
        };
        let picture = pictured.and_then(|name| self.mapped_picture(params, name, false, |x| alpha(x).max(0.0).sqrt()));
        if let Some(picture) = picture {
            return Roughness { picture: Some(picture), alphas: [1.0; 2] };
        }
        let default = both.map_or(default, |name| self.value(params, name, default));
        let alphas = EACH.map(|name| {
            let roughness = if each { self.value(params, name, default) } else { default };
            alpha(roughness).max(1e-3)
        });
        Roughness::new(alphas)
    }

    /// Reads the roughness and averages both directions geometrically, because a coat over a matte
    /// base is isotropic in Dürer. See [`Reader::rough`].
    pub(super) fn isotropic_roughness(
        &mut self,
        params: &Params,
        both: Option<&'static str>,
        each: bool,
        default: f32,
    ) -> Roughness {
        let rough = self.rough(params, both, each, default);
        let [u, v] = rough.alphas;
        if u != v {
            self.report.unsupported_once(
                params.at,
                "an anisotropic coat over a matte base has no counterpart: its mean roughness is used",
            );
        }
        Roughness { alphas: [(u * v).sqrt(); 2], ..rough }
    }
}
