//! Disney's material, which Mitsuba calls `principled`.
//!
//! Source: Burley, *Physically-Based Shading at Disney*, SIGGRAPH 2012, and *Extending the Disney
//! BRDF to a BSDF*, 2015, as *Mitsuba 3 documentation* has their parameters.
//!
//! Disney's matte base is seen as if no boundary took light from it, and gives back more the rougher
//! it is; its sheen is faint. Ours keep energy, so colour and weight are what has the same mean over
//! all directions.

use super::plugin::Plugin;
use super::state::Reader;
use crate::bsdf::albedo;
use crate::bsdf::fresnel::ior_of_reflectance;
use crate::material::PrincipledMaterial;
use crate::material::principled::Walls;
use crate::math::{LUMINANCE, Vec3, fp};

impl Reader<'_> {
    /// The layers of `principled` and `principledthin`.
    pub fn principled(&mut self, plugin: &Plugin) -> PrincipledMaterial {
        let thin = plugin.kind == "principledthin";
        let (base_color, base_color_texture) = self.colored(plugin, "base_color", 0.5);
        let whole = |x: f32| x.clamp(0.0, 1.0);
        let (roughness, roughness_texture) = self.pictured(plugin, "roughness", 0.5, whole);
        let (metalness, metalness_texture) = self.pictured(plugin, "metallic", 0.0, whole);
        let share = |name, usual: f32| self.value(plugin, name, usual).clamp(0.0, 1.0);
        // Disney's alpha is the square of the roughness, stretched by the aspect.
        let aspect = (1.0 - 0.9 * share("anisotropic", 0.0)).sqrt();
        let [u, v] = [roughness * roughness / aspect, roughness * roughness * aspect];
        let luminance = base_color.dot(LUMINANCE).max(1e-6);
        let tinted = |tint: f32| Vec3::ONE.lerp(base_color / luminance, tint).clamp(Vec3::ZERO, Vec3::ONE);
        let ior = match plugin.get("eta") {
            Some(_) => self.value(plugin, "eta", 1.5),
            // The reflectance at right angles is 0.08 times `specular`.
            None => {
                let root = (0.08 * share("specular", 0.5)).sqrt();
                (1.0 + root) / (1.0 - root)
            }
        };
        let clear = share("spec_trans", 0.0);
        let metallic = if thin { 0.0 } else { metalness };
        // Of pictures something between.
        let rough = if roughness_texture.is_some() { 0.5 } else { roughness };
        let given = means(|pair| pair.matte(rough));
        let pictured = base_color_texture.is_some();
        let matte = |color: Vec3| {
            if thin {
                return given * color;
            }
            if metalness_texture.is_some() {
                return color;
            }
            // Theirs loses what their mirror loses between facets; ours gives it back.
            let [reflected, all] = albedo::single_means(ior, rough);
            let lost = if pictured { 0.0 } else { reflected / all - reflected };
            let same = (given * color - lost).max(Vec3::ZERO) / passing(ior, rough);
            color.lerp(same, 1.0 - metallic)
        };
        let sheen = share("sheen", 0.0);
        let fuzz_weight = if sheen > 0.0 { sheen * means(Pair::sheen) / fuzz_mean() } else { 0.0 };
        // From 0, all on the lit side, to 2, all on the other.
        let through = if thin { self.value(plugin, "diff_trans", 0.0).clamp(0.0, 2.0) } else { 0.0 };
        let m = PrincipledMaterial {
            base_color: matte(base_color),
            base_color_texture: base_color_texture.clone(),
            subsurface_weight: through.min(1.0),
            subsurface_color: matte(base_color),
            subsurface_color_texture: base_color_texture.filter(|_| through > 0.0),
            subsurface_scatter_anisotropy: (through - 1.0).max(0.0),
            base_metalness: metallic,
            base_metalness_texture: metalness_texture.filter(|_| !thin),
            // A thin sheet mirrors only where it is clear.
            specular_weight: if thin { 0.0 } else { 1.0 },
            specular_ior: if thin { one_sided(ior) } else { ior.max(1e-3) },
            specular_color: tinted(share("spec_tint", 0.0)),
            specular_roughness: (0.5 * (u * u + v * v)).sqrt().min(1.0).sqrt(),
            specular_roughness_texture: roughness_texture,
            specular_anisotropy: 1.0 - v / u.max(1e-12),
            transmission_weight: clear,
            // Disney's glass takes the root of the colour at each of two surfaces.
            transmission_color: if thin { base_color } else { base_color.map(f32::sqrt) }.clamp(Vec3::ZERO, Vec3::ONE),
            // The coat has a quarter of the weight, and an index of 1.5.
            coat_weight: if thin { 0.0 } else { 0.25 * share("clearcoat", 0.0) },
            coat_ior: 1.5,
            coat_darkening: 0.0,
            coat_roughness: (0.1 + share("clearcoat_gloss", 0.0) * (0.001 - 0.1)).sqrt(),
            fuzz_weight,
            fuzz_roughness: FUZZ_ROUGHNESS,
            fuzz_color: tinted(share("sheen_tint", 0.0)),
            walls: if thin { Walls::Thin } else { Walls::Solid },
            ..PrincipledMaterial::default()
        };
        let none = "the surface is Lambert's below its boundary";
        plugin.left_out(self.said, &["flatness"], none);
        plugin.known(&["diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate"]);
        m
    }
}

/// How rough fuzz is that is brightest at grazing directions, as Disney's sheen is.
const FUZZ_ROUGHNESS: f32 = 0.2;

/// Two directions above a surface.
struct Pair {
    /// Their cosines to the normal.
    cosines: [f32; 2],
    /// The cosine of half the angle between them.
    half: f32,
}

fn schlick(cosine: f32) -> f32 {
    let m = (1.0 - cosine).clamp(0.0, 1.0);
    m * m * m * m * m
}

impl Pair {
    /// Disney's matte base, over Lambert's.
    fn matte(&self, roughness: f32) -> f32 {
        let [out, into] = self.cosines.map(schlick);
        let retro = 2.0 * roughness * self.half * self.half;
        (1.0 - 0.5 * out) * (1.0 - 0.5 * into) + retro * (out + into + out * into * (retro - 1.0))
    }

    /// White sheen, over Lambert's white.
    fn sheen(&self) -> f32 {
        std::f32::consts::PI * schlick(self.half)
    }
}

/// The mean over all pairs of directions by their cosines.
fn means(value: impl Fn(&Pair) -> f32) -> f32 {
    const STEPS: usize = 16;
    let step = |i: usize| (i as f32 + 0.5) / STEPS as f32;
    let mut sum = 0.0;
    // Each cosine counts by itself.
    for (i, j, k) in (0..STEPS.pow(3)).map(|n| (n % STEPS, n / STEPS % STEPS, n / (STEPS * STEPS))) {
        let cosines @ [a, b] = [step(i), step(j)];
        let [s, t] = cosines.map(|cosine| (1.0 - cosine * cosine).sqrt());
        let between = a * b + s * t * fp::sin_cos_turn(0.5 * step(k)).1;
        sum += 4.0 * a * b * value(&Pair { cosines, half: (0.5 + 0.5 * between).max(0.0).sqrt() });
    }
    sum / STEPS.pow(3) as f32
}

/// The index of a pane that reflects at right angles what one surface of another index does: theirs
/// has no second one.
fn one_sided(ior: f32) -> f32 {
    let root = (ior - 1.0) / (ior + 1.0);
    let r0 = root * root;
    ior_of_reflectance(r0 / (2.0 - r0))
}

/// What our boundary lets through to a matte base and out again, on the mean.
pub(super) fn passing(ior: f32, roughness: f32) -> f32 {
    let [reflected, all] = albedo::single_means(ior, roughness);
    1.0 - reflected / all
}

fn fuzz_mean() -> f32 {
    const STEPS: usize = 64;
    let at = |i: usize| albedo::fuzz(((i as f32 + 0.5) / STEPS as f32).sqrt(), FUZZ_ROUGHNESS);
    (0..STEPS).map(at).sum::<f32>() / STEPS as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matte_base_has_its_mean() {
        // Of (1 - cos)^5 the mean by the cosine is 1/21, and directions are independent.
        let expected = (1.0_f32 - 0.5 / 21.0) * (1.0 - 0.5 / 21.0);
        assert!((means(|pair| pair.matte(0.0)) - expected).abs() < 1e-3);
        assert!(means(|pair| pair.matte(1.0)) > 1.0 && means(Pair::sheen) < 0.05);
    }

    #[test]
    fn a_pane_reflects_what_one_surface_does() {
        let root = (one_sided(1.5) - 1.0) / (one_sided(1.5) + 1.0);
        let r = root * root;
        assert!((2.0 * r / (1.0 + r) - 0.04).abs() < 1e-5, "{r}");
    }
}
