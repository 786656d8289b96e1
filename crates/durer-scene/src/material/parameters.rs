//! Parameters of a layered material at one surface point, and the textures that change them.

use super::principled::{Facets, Layering, PrincipledMaterial, Switch, Walls};
use crate::describe::FileName;
use crate::math::Vec3;

macro_rules! parameters {
    ($($field:ident: $type:ty,)+) => {
        /// Parameters of a [`PrincipledMaterial`] at one surface point, after textures are applied.
        /// They determine the scattering at that point, and have the same names as the fields of
        /// the material.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Parameters {
            $(#[doc = concat!("[`PrincipledMaterial::", stringify!($field), "`] at the point.")] pub $field: $type,)+
            /// Factor that scales the reflection of an opaque base or a metal, at all angles.
            pub reflection: f32,
            /// Factor that scales light when it enters a scattering interior.
            pub entry_tint: Vec3,
            /// True if the material has a scattering interior, even if its share is 0 at this
            /// point.
            pub has_body: bool,
        }

        impl Parameters {
            /// Returns the parameters as written in the material, without textures. `base_color`
            /// includes `base_weight`.
            pub fn of(m: &PrincipledMaterial) -> Self {
                let has_body = m.has_subsurface();
                let written = Parameters { $($field: m.$field,)+ reflection: 1.0, entry_tint: Vec3::ONE, has_body };
                Parameters { base_color: m.base_weight * m.base_color, ..written }
            }
        }
    };
}

parameters! {
    base_color: Vec3,
    base_diffuse_roughness: f32,
    base_metalness: f32,
    base_flatness: f32,
    layering: Layering,
    specular_weight: f32,
    specular_color: Vec3,
    specular_tint: f32,
    specular_roughness: f32,
    specular_facets: Facets,
    specular_anisotropy: f32,
    specular_rotation: f32,
    specular_ior: f32,
    metal_ior: Option<Vec3>,
    metal_extinction: Vec3,
    energy_compensation: Switch,
    transmission_weight: f32,
    transmission_color: Vec3,
    transmission_depth: f32,
    subsurface_weight: f32,
    subsurface_color: Vec3,
    subsurface_scatter_anisotropy: f32,
    subsurface_through: Option<Vec3>,
    coat_weight: f32,
    coat_color: Vec3,
    coat_roughness: f32,
    coat_ior: f32,
    coat_darkening: f32,
    fuzz_weight: f32,
    fuzz_color: Vec3,
    fuzz_roughness: f32,
    thin_film_weight: f32,
    thin_film_thickness: f32,
    thin_film_ior: f32,
    walls: Walls,
}

impl Parameters {
    /// Returns the parameters with weights clamped to [0, 1] and colours clamped to at least 0.
    /// Textures can exceed these bounds.
    pub fn clamped(mut self) -> Self {
        let shares = [
            &mut self.base_diffuse_roughness,
            &mut self.base_metalness,
            &mut self.specular_roughness,
            &mut self.specular_anisotropy,
            &mut self.transmission_weight,
            &mut self.subsurface_weight,
            &mut self.coat_weight,
            &mut self.coat_roughness,
            &mut self.coat_darkening,
            &mut self.fuzz_weight,
            &mut self.fuzz_roughness,
            &mut self.thin_film_weight,
            &mut self.reflection,
        ];
        shares.into_iter().for_each(|share| *share = share.clamp(0.0, 1.0));
        let colors = [
            &mut self.base_color,
            &mut self.specular_color,
            &mut self.transmission_color,
            &mut self.subsurface_color,
            &mut self.coat_color,
            &mut self.fuzz_color,
            &mut self.entry_tint,
        ];
        colors.into_iter().for_each(|color| *color = color.max(Vec3::ZERO));
        self
    }
}

impl PrincipledMaterial {
    /// True if the material has a texture.
    pub fn has_textures(&self) -> bool {
        let others = [&self.emission_texture, &self.normal_texture, &self.bump_texture, &self.opacity_texture];
        TEXTURE_FIELDS.iter().any(|row| (row.texture_file)(self).is_some())
            || others.iter().any(|picture| picture.is_some())
            || self.metallic_roughness_texture.is_some()
    }
}

/// Function by which a texture changes the parameters of a principled material.
#[derive(Clone, Copy, Debug)]
pub enum TextureEffect {
    /// Function that applies one channel of the texture.
    Number(fn(&mut Parameters, f32)),
    /// Function that applies the colour of the texture.
    Color(fn(&mut Parameters, Vec3)),
}

/// Row of the table of texture fields that a `PrincipledMaterial` can have in a scene file, with
/// the parameter that the texture changes.
#[derive(Clone, Copy, Debug)]
pub struct TextureField {
    /// Name of the field.
    pub field: &'static str,
    /// Returns the texture file of a material.
    pub texture_file: fn(&PrincipledMaterial) -> Option<&FileName>,
    /// Effect of the texture on the parameters.
    pub change: TextureEffect,
}

macro_rules! textured {
    ($($field:ident $kind:ident $change:expr;)+) => {
        /// All textures that change a parameter. Textures for emission, opacity and normals are
        /// handled elsewhere.
        pub const TEXTURE_FIELDS: &[TextureField] =
            &[$(TextureField {
                field: stringify!($field),
                texture_file: |m| m.$field.as_ref(),
                change: TextureEffect::$kind($change),
            },)+];
    };
}

textured! {
    base_color_texture Color |p, by| p.base_color *= by;
    base_weight_texture Number |p, by| p.base_color *= by;
    base_diffuse_roughness_texture Number |p, by| p.base_diffuse_roughness *= by;
    base_metalness_texture Number |p, by| p.base_metalness *= by;
    specular_weight_texture Number |p, by| p.reflection *= by;
    specular_color_texture Color |p, by| p.specular_color *= by;
    specular_roughness_texture Number |p, by| p.specular_roughness *= by;
    specular_anisotropy_texture Number |p, by| p.specular_anisotropy *= by;
    specular_rotation_texture Number |p, by| p.specular_rotation += by;
    transmission_weight_texture Number |p, by| p.transmission_weight *= by;
    transmission_color_texture Color |p, by| p.transmission_color *= by;
    subsurface_weight_texture Number |p, by| p.subsurface_weight *= by;
    subsurface_color_texture Color |p, by| (p.subsurface_color, p.entry_tint) = (p.subsurface_color * by, p.entry_tint * by);
    coat_weight_texture Number |p, by| p.coat_weight *= by;
    coat_color_texture Color |p, by| p.coat_color *= by;
    coat_roughness_texture Number |p, by| p.coat_roughness *= by;
    coat_darkening_texture Number |p, by| p.coat_darkening *= by;
    fuzz_weight_texture Number |p, by| p.fuzz_weight *= by;
    fuzz_color_texture Color |p, by| p.fuzz_color *= by;
    fuzz_roughness_texture Number |p, by| p.fuzz_roughness *= by;
    thin_film_weight_texture Number |p, by| p.thin_film_weight *= by;
    thin_film_thickness_texture Number |p, by| p.thin_film_thickness *= by;
}
