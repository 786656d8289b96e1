//! Phong materials as mixes of simple surfaces, which look as with path tracing in Dürer.

use super::Export;
use super::surface::{Opaque, Paint, Rough, Surface};
use durer_scene::bsdf::lobe::blinn::Blinn;
use durer_scene::bsdf::{Scatter as _, albedo};
use durer_scene::material::PhongMaterial;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::spectrum::Spectrum;

impl Export<'_> {
    /// Returns the surface of a Phong material. Its parts are added, so each part of the mix is
    /// divided by its share.
    pub(super) fn phong(&mut self, m: &PhongMaterial, program: &str) -> Surface {
        let picture = m.texture.as_ref().map(|name| self.picture(name));
        let color = if picture.is_some() { Vec3::ONE } else { m.diffuse_color.unwrap_or(Vec3::ONE) };
        let glass = m.refraction_index.filter(|index| *index > 0.0);
        let (mirror, through, ior) = match glass {
            Some(ior) => {
                // The highlight's colour is also the colour of the mirrored light.
                let tint = if m.transparent_color == Vec3::ZERO { m.specular_color } else { m.transparent_color };
                (Vec3::ZERO, tint, ior)
            }
            None => (m.reflective_color, m.transparent_color, m.index_of_refraction.unwrap_or(1.0)),
        };
        if m.specular_color != Vec3::ZERO {
            self.warn_lost(format!("{program} has no Blinn or Phong highlights: a rough metal is mixed in"));
        }
        // A highlight of GGX that is as wide near its peak. R·L falls off four times as fast as
        // N·H.
        let is_phong = m.exponent.is_none() && m.shininess.is_some();
        let exponent = m.exponent.or(m.shininess).unwrap_or(1.0);
        let alpha = (2.0 / (if is_phong { 4.0 * exponent } else { exponent } + 2.0)).sqrt();
        let strength = match m.specular_color == Vec3::ZERO {
            true => Vec3::ZERO,
            false => m.specular_color * (highlight_albedo(exponent, is_phong) / facet_albedo(alpha)),
        };
        let bound = Blinn::bound(exponent);
        // Dürer scales all parts down if they would reflect more light than arrives.
        let scale = (color + bound * m.specular_color + mirror + through).max_element().max(1.0);
        let metal = |color: Vec3, alpha: f32| {
            Surface::Opaque(
                Opaque::Metal { f0: color, f82: color, index: None, picture: None, rough: Rough::of_alpha(alpha) },
                true,
            )
        };
        let matte = |color: Vec3| {
            Surface::Opaque(
                Opaque::Diffuse(Paint { color, picture: picture.clone(), is_linear: !self.context.srgb_textures }),
                true,
            )
        };
        // Without Fresnel reflection, the mirror is another part of the mix.
        let reflected = if glass.is_some() { m.specular_color.min(Vec3::ONE) } else { Vec3::ZERO };
        let clear = |color: Vec3| Surface::Glass { ior, rough: Rough::of_alpha(0.0), reflected, transmitted: color };
        let parts: [(Vec3, &dyn Fn(Vec3) -> Surface); 4] = [
            (color, &matte),
            (strength, &|color| metal(color, alpha)),
            (mirror, &|color| metal(color, 0.0)),
            (through, &clear),
        ];
        let shown: Vec<_> =
            parts.iter().map(|(color, make)| (*color / scale, make)).filter(|part| part.0 != Vec3::ZERO).collect();
        let whole: f32 = shown.iter().map(|part| part.0.max_element()).sum();
        let (mut surface, mut rest) = (Surface::diffuse(Vec3::ZERO), 0.0);
        for (color, make) in shown.iter().rev() {
            let most = color.max_element();
            let part = make((*color * (whole / most)).min(Vec3::ONE));
            rest += most;
            surface = Surface::mix(part, surface, most / rest, None);
        }
        // The shares of a mix sum to 1.
        if whole > 1.0 + 1e-4 {
            self.warn_lost(format!("mixes of {program} cannot be as bright as this sum of colours: they are darker"));
        }
        surface
    }
}

/// Returns the mean albedo of a highlight of strength 1 over all directions.
fn highlight_albedo(exponent: f32, phong: bool) -> f32 {
    const STEPS: u16 = 16;
    let lobe = Blinn { color: Spectrum::ONE, exponent, phong };
    let step = |i: u16| (f32::from(i) + 0.5) / f32::from(STEPS);
    let mut sum = 0.0;
    for (i, j, k) in (0..STEPS).flat_map(|i| (0..STEPS).flat_map(move |j| (0..STEPS).map(move |k| (i, j, k)))) {
        let mu = step(i).sqrt();
        let wo = Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu);
        if let Some(sample) = lobe.sample(wo, 0.0, Vec2::new(step(j), step(k))) {
            let (value, density) = lobe.eval(wo, sample.wi);
            sum += if density > 0.0 { value.max_element() / density } else { 0.0 };
        }
    }
    let steps = f32::from(STEPS);
    sum / (steps * steps * steps)
}

/// Returns the mean albedo over all directions of facets that reflect all light.
fn facet_albedo(alpha: f32) -> f32 {
    const STEPS: u16 = 32;
    let mean = |i: u16| albedo::ggx(((f32::from(i) + 0.5) / f32::from(STEPS)).sqrt(), alpha.sqrt());
    (0..STEPS).map(mean).sum::<f32>() / f32::from(STEPS)
}
