//! Statements of a material in an `.mtl` file, and their conversion to OpenPBR parameters.

use durer_diag::Span;
use durer_scene::bsdf::layers::opaque_ior;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::Vec3;

/// Material from an `.mtl` file, which stores the values of its statements before they are
/// converted to OpenPBR parameters.
#[derive(Default)]
pub(super) struct MtlMaterial {
    pub name: String,
    /// Span of the name.
    pub at: Span,
    pub diffuse: Option<Vec3>,
    pub specular: Option<Vec3>,
    pub emission: Option<Vec3>,
    /// Transmission filter (`Tf`).
    pub filter: Option<Vec3>,
    pub filter_at: Span,
    pub exponent: Option<f32>,
    pub ior: Option<f32>,
    pub opacity: Option<f32>,
    /// Span of the statement that sets the opacity.
    pub opacity_at: Span,
    pub model: Option<f32>,
    /// Span of the statement that sets the illumination model.
    pub model_at: Span,
    pub roughness: Option<f32>,
    pub metalness: Option<f32>,
    pub sheen: Option<f32>,
    pub coat: Option<f32>,
    pub coat_roughness: Option<f32>,
    pub anisotropy: Option<f32>,
    pub diffuse_map: Option<FileName>,
    /// True if the material has a `map_Kd` statement, even if the file is missing.
    pub has_diffuse_map: bool,
    /// The other textures, and the height of the bump map; all other fields have default values.
    pub other_textures: PrincipledMaterial,
}

impl MtlMaterial {
    /// Returns true if the material uses the extension for physically based rendering.
    fn is_physical(&self) -> bool {
        let pictured = |picture: &Option<FileName>| picture.is_some();
        let pictures = [&self.other_textures.specular_roughness_texture, &self.other_textures.base_metalness_texture];
        self.roughness.is_some() || self.metalness.is_some() || pictures.into_iter().any(pictured)
    }

    fn model(&self) -> i32 {
        self.model.unwrap_or(2.0) as i32
    }

    /// Returns the fraction of light that the material transmits. In a physically based material,
    /// this fraction is `Tf`, as Blender reads and writes it. In other materials, it follows from
    /// the illumination model: models 4, 6, 7, and 9 are glass.
    fn transmission(&self) -> f32 {
        let opacity = self.opacity();
        match (self.filter, self.model()) {
            (Some(filter), _) if self.is_physical() => filter.max_element().min(1.0),
            (_, 4 | 6 | 7 | 9) if opacity < 1.0 => 1.0 - opacity,
            (_, 4 | 6 | 7 | 9) => 1.0,
            _ => 0.0,
        }
    }

    /// Returns true if the illumination model alone makes the material glass, although its colour
    /// is that of an opaque surface.
    pub fn is_glass_by_model(&self) -> bool {
        let states_glass = self.opacity.is_some() || self.filter.is_some() || self.ior.is_some();
        let is_colored = self.has_diffuse_map || self.diffuse.is_some_and(|color| color.max_element() > 0.1);
        self.transmission() == 1.0 && !states_glass && is_colored && !self.is_physical()
    }

    fn opacity(&self) -> f32 {
        self.opacity.unwrap_or(1.0).clamp(0.0, 1.0)
    }

    /// Returns true if the transmitted light should be tinted but the conversion cannot express
    /// this.
    pub fn drops_filter(&self) -> bool {
        let filters = self.filter.is_some_and(|filter| filter != Vec3::ONE);
        filters && !self.is_physical() && self.transmission() == 0.0 && self.opacity() < 1.0
    }

    /// Converts the statements to OpenPBR parameters.
    pub fn into_principled(self) -> PrincipledMaterial {
        let (physical, model) = (self.is_physical(), self.model());
        let (transmission, opacity) = (self.transmission(), self.opacity());
        // A texture without `Kd` is shown at full brightness.
        let default = if self.diffuse_map.is_some() { Vec3::ONE } else { Vec3::splat(0.8) };
        let mut m = PrincipledMaterial { base_color: self.diffuse.unwrap_or(default), ..self.other_textures };
        m.base_color_texture = self.diffuse_map;
        // Programs that use only the texture often write a black `Kd` as well.
        if self.has_diffuse_map && m.base_color == Vec3::ZERO {
            m.base_color = Vec3::ONE;
        }
        let pictured = |picture: &Option<FileName>| if picture.is_some() { 1.0 } else { 0.0 };
        let specular = self.specular.unwrap_or(Vec3::splat(pictured(&m.specular_color_texture)));
        // Choose the roughness that gives a highlight as wide as that of Blinn's model with this
        // exponent: alpha^2 = 2 / (n + 2) and roughness^2 = alpha.
        let exponent = self.exponent.unwrap_or(if specular == Vec3::ZERO { 0.0 } else { 50.0 }).max(0.0);
        let rough = m.specular_roughness_texture.is_some();
        let by_exponent = if rough { 1.0 } else { (2.0 / (exponent + 2.0)).sqrt().sqrt() };
        m.specular_roughness = self.roughness.unwrap_or(by_exponent).clamp(0.0, 1.0);
        m.base_metalness = self.metalness.unwrap_or(pictured(&m.base_metalness_texture)).clamp(0.0, 1.0);
        m.specular_ior = self.ior.filter(|ior| *ior >= 1.0 && *ior < 10.0).unwrap_or(1.5);
        let level = specular.max_element().min(1.0);
        m.specular_weight = match model {
            // Illumination models with these numbers have no highlights.
            0 | 1 => 0.0,
            _ if !physical => level,
            // In a physically based material, `Ks` is Disney's `specular` parameter, where 0.5
            // stands for the reflectance that the index of refraction gives, as in Blender.
            _ if self.specular.is_some() || m.specular_color_texture.is_some() => 2.0 * level,
            _ => 1.0,
        };
        if physical && m.base_metalness > 0.0 {
            // The specular weight applies only to the dielectric part of the material.
            (m.specular_ior, m.specular_weight) = (opaque_ior(&m), 1.0);
        }
        // Illumination models 3 and 8 are mirrors. A mirror that has a black base colour is a
        // metal.
        if matches!(model, 3 | 8) && m.base_color.max_element() < 0.05 && specular != Vec3::ZERO {
            (m.base_color, m.base_metalness, m.specular_weight) = (specular.min(Vec3::ONE), 1.0, 1.0);
        }
        let by_filter = physical && self.filter.is_some();
        match transmission > 0.0 && !by_filter {
            true => m.specular_weight = 1.0,
            // In the other models, `d` is an opacity.
            false => m.opacity = opacity,
        }
        m.transmission_weight = transmission;
        if let Some(filter) = self.filter.filter(|_| transmission > 0.0) {
            let (tint, picture) = match by_filter {
                // The largest component of `Tf` is the transmitted fraction. The base colour also
                // tints transmitted light.
                true => (m.base_color * filter / filter.max_element(), m.base_color_texture.clone()),
                false => (filter.min(Vec3::ONE), None),
            };
            // Light crosses the surface twice: on entering and on leaving.
            m.transmission_color = Vec3::from_array(tint.to_array().map(f32::sqrt));
            m.transmission_color_texture = picture;
        }
        let emission = self.emission.unwrap_or(Vec3::splat(pictured(&m.emission_texture)));
        if emission != Vec3::ZERO {
            m.emission_luminance = emission.max_element();
            m.emission_color = emission / emission.max_element();
        }
        m.fuzz_weight = self.sheen.unwrap_or(pictured(&m.fuzz_weight_texture)).clamp(0.0, 1.0);
        m.coat_weight = self.coat.unwrap_or(pictured(&m.coat_weight_texture)).clamp(0.0, 1.0);
        m.coat_roughness = self.coat_roughness.unwrap_or(pictured(&m.coat_roughness_texture)).clamp(0.0, 1.0);
        m.specular_anisotropy = self.anisotropy.unwrap_or(0.0).clamp(0.0, 1.0);
        m
    }
}

#[cfg(test)]
mod tests;
