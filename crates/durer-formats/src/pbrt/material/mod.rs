//! Converts materials to OpenPBR parameters.

mod disney;
mod fourth;
mod hair;
mod parts;
mod rough;
mod substrate;
mod third;

#[cfg(test)]
pub(super) use rough::alpha_of_roughness;

use super::defs::{AreaLight, MaterialDef, Opacity, Texture};
use super::language::Language;
use super::params::{Kind, Param, Params};
use super::state::{MATERIAL, Reader};
use crate::shared_report::suggest;
use durer_diag::{Diagnostic, Span};
use durer_scene::describe::FileName;
use durer_scene::material::mix::Mix;
use durer_scene::material::principled::{Switch, Walls};
use durer_scene::material::{PatternMaterial, PrincipledMaterial};
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::{Material, Spanned, TextureImage};
use durer_scene::texture::{Mapping, Wrap};
use std::rc::Rc;

/// Maximum depth of nested mixes.
const MAX_DEPTH: u32 = 32;

impl MaterialDef {
    /// Returns the material of shapes that are not preceded by a `Material` directive.
    pub fn default_material() -> MaterialDef {
        MaterialDef::Principled(Box::new(matte(Vec3::splat(0.5))), Span::default())
    }

    /// Returns the depth of nested mixes in a material.
    fn depth(&self) -> u32 {
        if let MaterialDef::Mix { depth, .. } = self { *depth } else { 0 }
    }

    fn is_pictured(&self) -> bool {
        match self {
            MaterialDef::Principled(layers, _) => layers.has_textures(),
            MaterialDef::Mix { has_picture, .. } => *has_picture,
            MaterialDef::Hair(..) | MaterialDef::Interface => false,
        }
    }
}

/// Returns a diffuse material that has no specular boundary.
fn matte(base_color: Color) -> PrincipledMaterial {
    PrincipledMaterial { base_color, specular_weight: 0.0, specular_roughness: 1.0, ..PrincipledMaterial::default() }
}

/// Adds subsurface scattering with the mean free path `path` and the albedo `color`, which can be
/// multiplied by a picture.
fn set_subsurface(
    m: &mut PrincipledMaterial,
    params: &Params,
    (color, picture): (Color, Option<FileName>),
    path: Vec3,
) {
    m.subsurface_weight = 1.0;
    (m.subsurface_color, m.subsurface_color_texture) = (color.min(Vec3::ONE), picture);
    m.subsurface_radius = params.float("scale").unwrap_or(1.0).max(1e-6);
    m.subsurface_radius_scale = path.max(Vec3::splat(1e-6));
    m.subsurface_scatter_anisotropy = params.float("g").unwrap_or(0.0).clamp(-0.99, 0.99);
}

impl Reader<'_> {
    /// Adds a material to the reader's list and returns its index.
    pub fn material(&mut self, kind: &str, at: Span, list: Vec<Rc<Param>>) -> usize {
        let params = self.params(list, Some(MATERIAL), at);
        let material = match self.language {
            Language::V3 => self.third(kind, &params, at),
            Language::V4 => self.fourth(kind, &params, at),
        };
        params.mark_known(&["type", "remaproughness"]);
        params.warn_unused(&format!("the material `{kind}`"));
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Executes `MakeNamedMaterial`.
    pub fn make_named_material(&mut self, name: String, at: Span, list: Vec<Rc<Param>>) {
        let kind = list.iter().find(|param| param.name == "type" && param.kind == Kind::Text);
        let Some(kind) = kind.map(|param| param.text().to_string()) else {
            return self.report.error(at, format!("the material `{name}` needs a `\"string type\"`"));
        };
        let number = self.material(&kind, at, list);
        if self.named_materials.insert(name.clone(), number).is_some() && self.language == Language::V4 {
            self.report.error(at, format!("the material `{name}` is already defined"));
        }
    }

    /// Executes `NamedMaterial`, which selects the current material.
    pub fn named_material(&mut self, name: &str, at: Span) {
        match self.named_materials.get(name) {
            Some(number) => self.state.material = *number,
            None => {
                let help = suggest(name, self.named_materials.keys().map(String::as_str));
                self.report.error_with_help(at, format!("unknown material `{name}`"), help);
            }
        }
    }

    /// Reports that a material does not exist. If the other version of pbrt has this material, the
    /// message points at the keyword that decided the version.
    fn no_material(&self, name: &str, at: Span, help: Option<String>, other: bool) {
        let language = if self.language == Language::V3 { "pbrt-v3" } else { "pbrt-v4" };
        let error = Diagnostic::error(format!("unknown material `{name}` in {language}")).code("bad-value").at(at);
        let error = match self.decided_by.filter(|_| other) {
            Some(by) => error.related(by, &format!("this word shows that the file is {language}")),
            None => error,
        };
        self.report.push(Diagnostic { help, ..error });
    }

    /// Returns a mix of two materials that are given by index, or `MaterialDef::Interface` if mixes
    /// are nested too deeply.
    fn mix(&self, parts: [usize; 2], share: f32, at: Span) -> MaterialDef {
        self.mix_by(parts, (share, None), at)
    }

    /// Returns a mix whose share is multiplied by a picture. See [`Reader::mix`].
    fn mix_by(&self, parts: [usize; 2], (share, picture): (f32, Option<FileName>), at: Span) -> MaterialDef {
        let [first, second] = parts.map(|number| &self.materials[number]);
        let depth = 1 + first.depth().max(second.depth());
        let has_picture = first.is_pictured() || second.is_pictured() || picture.is_some();
        if depth > MAX_DEPTH {
            self.report.error(at, format!("mixes of materials are nested more than {MAX_DEPTH} levels deep"));
            return MaterialDef::Interface;
        }
        MaterialDef::Mix { parts, share, picture, depth, has_picture, at }
    }

    /// Returns the index of one of the materials that a mix names.
    fn known_material(&self, name: &str, at: Span) -> Option<usize> {
        let index = self.named_materials.get(name).copied();
        if index.is_none() {
            let help = suggest(name, self.named_materials.keys().map(String::as_str));
            self.report.error_with_help(at, format!("no material `{name}` is defined before this point"), help);
        }
        index
    }

    /// Reads the normal map and the bump map of a material.
    fn surface(&mut self, m: &mut PrincipledMaterial, params: &Params, heights: &'static str) {
        if let Some(name) = params.text("normalmap") {
            let place = params.get("normalmap").map_or(params.at, |param| param.values_at);
            if let Some(bytes) = self.eight_bits(name, place) {
                m.normal_texture = Some(self.asset(TextureImage { bytes, mapping: Mapping::default() }, place));
            }
        }
        if let Texture::Picture(picture, scale) = self.texture_value(params, heights, false, Vec3::ZERO) {
            (m.bump_texture, m.bump_height) = (Some(self.asset(picture, params.span(heights))), scale.x);
        }
    }

    /// Returns true if the current material or light has a picture.
    pub fn is_pictured(&self) -> bool {
        let light = self.state.area_light.as_ref().is_some_and(|light| light.picture.is_some());
        light || self.materials[self.state.material].is_pictured()
    }

    /// Returns true if the directions of u and v matter for the current material.
    pub fn is_anisotropic(&self) -> bool {
        self.has_anisotropy(self.state.material)
    }

    fn has_anisotropy(&self, material: usize) -> bool {
        match &self.materials[material] {
            MaterialDef::Principled(layers, _) => layers.specular_anisotropy > 0.0,
            MaterialDef::Mix { parts, .. } => parts.iter().any(|&part| self.has_anisotropy(part)),
            MaterialDef::Hair(..) | MaterialDef::Interface => false,
        }
    }

    /// Returns the scene index of a material with its emission and opacity, or `None` for a
    /// material that is not rendered.
    pub fn material_index(
        &mut self,
        material: usize,
        light: Option<(&AreaLight, Color)>,
        opacity: &Opacity,
    ) -> Option<u32> {
        let key = (
            material,
            match light {
                Some((light, color)) => {
                    format!(
                        "{opacity:?} {:?} {} {:?}",
                        color.to_array().map(f32::to_bits),
                        light.two_sided,
                        light.picture
                    )
                }
                None => format!("{opacity:?}"),
            },
        );
        if let Some(cached) = self.material_indices.get(&key) {
            return *cached;
        }
        let number = match &self.materials[material] {
            MaterialDef::Interface => None,
            MaterialDef::Principled(layers, at) => {
                let (mut m, at) = (layers.clone(), *at);
                m.smooth_shadows = Switch::Off;
                m.opacity *= opacity.share.clamp(0.0, 1.0);
                if opacity.picture.is_some() {
                    m.opacity_texture = opacity.picture.clone();
                }
                if let Some((light, color)) = light {
                    self.set_emission(&mut m, light, color);
                }
                Some(self.scene_material(Material::Principled(m), at))
            }
            MaterialDef::Hair(hair, at) => {
                let (hair, at) = (hair.clone(), *at);
                if light.is_some() {
                    self.report.unsupported_once(at, "emission of hair has no counterpart: it is ignored");
                }
                if opacity.share < 1.0 || opacity.picture.is_some() {
                    self.report.unsupported_once(at, "opacity of hair has no counterpart: it is ignored");
                }
                Some(self.scene_material(Material::Hair(hair), at))
            }
            MaterialDef::Mix { parts: [a, b], share, picture, at, .. } => {
                let (a, b, share, share_texture, at) = (*a, *b, *share, picture.clone(), *at);
                match (self.material_index(a, light, opacity), self.material_index(b, light, opacity)) {
                    (Some(material1), Some(material2)) => {
                        let solid = PatternMaterial::from(Mix { material1, material2, share, share_texture });
                        Some(self.scene_material(Material::Solid(solid, Vec::new()), at))
                    }
                    (Some(only), None) | (None, Some(only)) => {
                        self.report.unsupported_once(
                            at,
                            "a mix with an invisible material has no counterpart: only the other material is used",
                        );
                        Some(only)
                    }
                    (None, None) => None,
                }
            }
        };
        self.material_indices.insert(key, number);
        number
    }

    fn scene_material(&mut self, value: Material, span: Span) -> u32 {
        self.scene.materials.push(Spanned { value, span });
        (self.scene.materials.len() - 1) as u32
    }

    fn set_emission(&mut self, m: &mut PrincipledMaterial, light: &AreaLight, color: Color) {
        let most = color.max_element();
        if most <= 0.0 {
            return;
        }
        (m.emission_luminance, m.emission_color) = (most, color / most);
        if light.two_sided {
            match m.transmission_weight > 0.0 && m.walls == Walls::Solid {
                true => self.report.unsupported_once(
                    light.at,
                    "two-sided emission of glass has no counterpart: the glass emits outwards only",
                ),
                false => m.walls = Walls::Thin,
            }
        }
        if let Some(name) = &light.picture
            && let Some(bytes) = self.eight_bits(name, light.at)
        {
            // Beyond its edges, the picture continues with its last texels.
            let mapping = Mapping { wrap: [Wrap::Clamp; 2], ..Mapping::default() };
            m.emission_texture = Some(self.asset(TextureImage { bytes, mapping }, light.at));
        }
    }
}
