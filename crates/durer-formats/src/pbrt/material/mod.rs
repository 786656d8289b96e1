//! Materials, in the words of OpenPBR.

mod disney;
mod fourth;
mod hair;
mod parts;
mod rough;
mod substrate;
mod third;

#[cfg(test)]
pub(super) use rough::alpha_of_roughness;

use super::language::Language;
use super::made::{AreaLight, Made, Opacity, Texture};
use super::params::{Kind, Param, Params};
use super::state::{MATERIAL, Reader};
use crate::said::meant;
use durer_diag::{Diagnostic, Span};
use durer_scene::describe::FileName;
use durer_scene::material::mix::Mix;
use durer_scene::material::principled::Walls;
use durer_scene::material::{PrincipledMaterial, Solid};
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::{Material, Picture, Spanned};
use durer_scene::texture::Mapping;
use std::rc::Rc;

/// Mixes in mixes.
const DEEPEST: u32 = 32;

impl Made {
    /// What shapes have that nothing is said of.
    pub fn usual() -> Made {
        Made::Layers(Box::new(matte(Vec3::splat(0.5))), Span::default())
    }

    /// How deep it is mixed of others.
    fn depth(&self) -> u32 {
        if let Made::Mix { depth, .. } = self { *depth } else { 0 }
    }

    fn is_pictured(&self) -> bool {
        match self {
            Made::Layers(layers, _) => layers.has_pictures(),
            Made::Mix { pictured, .. } => *pictured,
            Made::Hair(..) | Made::Nothing => false,
        }
    }
}

/// Matte, without a boundary.
fn matte(base_color: Color) -> PrincipledMaterial {
    PrincipledMaterial { base_color, specular_weight: 0.0, specular_roughness: 1.0, ..PrincipledMaterial::default() }
}

/// Lets light go so far into a body, which gives back a colour by a picture.
fn below_skin(m: &mut PrincipledMaterial, params: &Params, (color, picture): (Color, Option<FileName>), path: Vec3) {
    m.subsurface_weight = 1.0;
    (m.subsurface_color, m.subsurface_color_texture) = (color.min(Vec3::ONE), picture);
    m.subsurface_radius = params.float("scale").unwrap_or(1.0).max(1e-6);
    m.subsurface_radius_scale = path.max(Vec3::splat(1e-6));
    m.subsurface_scatter_anisotropy = params.float("g").unwrap_or(0.0).clamp(-0.99, 0.99);
}

impl Reader<'_> {
    /// The number of a material.
    pub fn material(&mut self, kind: &str, at: Span, list: Vec<Rc<Param>>) -> usize {
        let params = self.params(list, Some(MATERIAL), at);
        let made = match self.language {
            Language::Third => self.third(kind, &params, at),
            Language::Fourth => self.fourth(kind, &params, at),
        };
        params.known(&["type", "remaproughness"]);
        params.finish(&format!("the material `{kind}`"));
        self.materials.push(made);
        self.materials.len() - 1
    }

    pub fn make_named_material(&mut self, name: String, at: Span, list: Vec<Rc<Param>>) {
        let kind = list.iter().find(|param| param.name == "type" && param.kind == Kind::Text);
        let Some(kind) = kind.map(|param| param.text().to_string()) else {
            return self.said.bad(at, format!("the material `{name}` needs a `\"string type\"`"));
        };
        let number = self.material(&kind, at, list);
        if self.named_materials.insert(name.clone(), number).is_some() && self.language == Language::Fourth {
            self.said.bad(at, format!("there is a material `{name}` already"));
        }
    }

    pub fn named_material(&mut self, name: &str, at: Span) {
        match self.named_materials.get(name) {
            Some(number) => self.state.material = *number,
            None => {
                let help = meant(name, self.named_materials.keys().map(String::as_str));
                self.said.bad_with(at, format!("there is no material `{name}`"), help);
            }
        }
    }

    /// Complains of a material that is not there; where the file's language has another word for it,
    /// with the word that tells the language.
    fn no_material(&self, name: &str, at: Span, help: Option<String>, other: bool) {
        let language = if self.language == Language::Third { "pbrt-v3" } else { "pbrt-v4" };
        let error = Diagnostic::error(format!("there is no material `{name}` in {language}")).code("bad-value").at(at);
        let error = match self.decided_by.filter(|_| other) {
            Some(by) => error.related(by, &format!("by this word the file is one of {language}")),
            None => error,
        };
        self.said.push(Diagnostic { help, ..error });
    }

    /// Two materials, by number, in a proportion; nothing where they are mixed too deep.
    fn mix(&self, parts: [usize; 2], share: f32, at: Span) -> Made {
        self.mix_by(parts, (share, None), at)
    }

    /// The same in a proportion that a picture multiplies.
    fn mix_by(&self, parts: [usize; 2], (share, picture): (f32, Option<FileName>), at: Span) -> Made {
        let [first, second] = parts.map(|number| &self.materials[number]);
        let depth = 1 + first.depth().max(second.depth());
        let pictured = first.is_pictured() || second.is_pictured() || picture.is_some();
        if depth > DEEPEST {
            self.said.bad(at, format!("materials are mixed more than {DEEPEST} deep"));
            return Made::Nothing;
        }
        Made::Mix { parts, share, picture, depth, pictured, at }
    }

    /// The number of a material that a mix names.
    fn known_material(&self, name: &str, at: Span) -> Option<usize> {
        let found = self.named_materials.get(name).copied();
        if found.is_none() {
            let help = meant(name, self.named_materials.keys().map(String::as_str));
            self.said.bad_with(at, format!("there is no material `{name}` before this"), help);
        }
        found
    }

    /// What bends the normals of a surface: a map of them, and a picture of heights.
    fn surface(&mut self, m: &mut PrincipledMaterial, params: &Params, heights: &'static str) {
        if let Some(name) = params.text("normalmap") {
            let place = params.get("normalmap").map_or(params.at, |param| param.values_at);
            if let Some(bytes) = self.eight_bits(name, place) {
                m.normal_texture = Some(self.asset(Picture { bytes, mapping: Mapping::default() }, place));
            }
        }
        if let Texture::Picture(picture, scale) = self.pattern(params, heights, false, Vec3::ZERO) {
            (m.bump_texture, m.bump_height) = (Some(self.asset(picture, params.place(heights))), scale.x);
        }
    }

    /// Whether pictures lie on what is written now.
    pub fn is_pictured(&self) -> bool {
        let light = self.state.area.as_ref().is_some_and(|light| light.picture.is_some());
        light || self.materials[self.state.material].is_pictured()
    }

    /// The number in the scene of a material that shines with a radiance and is there in part;
    /// `None` for what is not there.
    pub fn number(&mut self, made: usize, light: Option<(&AreaLight, Color)>, opacity: &Opacity) -> Option<u32> {
        let key = (
            made,
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
        if let Some(known) = self.numbers.get(&key) {
            return *known;
        }
        let number = match &self.materials[made] {
            Made::Nothing => None,
            Made::Layers(layers, at) => {
                let (mut m, at) = (layers.clone(), *at);
                m.opacity *= opacity.share.clamp(0.0, 1.0);
                if opacity.picture.is_some() {
                    m.opacity_texture = opacity.picture.clone();
                }
                if let Some((light, color)) = light {
                    self.shine(&mut m, light, color);
                }
                Some(self.scene_material(Material::Principled(m), at))
            }
            Made::Hair(hair, at) => {
                let (hair, at) = (hair.clone(), *at);
                if light.is_some() {
                    self.said.once(at, "hair does not shine");
                }
                if opacity.share < 1.0 || opacity.picture.is_some() {
                    self.said.once(at, "hair is there everywhere, its opacity is left out");
                }
                Some(self.scene_material(Material::Hair(hair), at))
            }
            Made::Mix { parts: [a, b], share, picture, at, .. } => {
                let (a, b, share, share_texture, at) = (*a, *b, *share, picture.clone(), *at);
                match (self.number(a, light, opacity), self.number(b, light, opacity)) {
                    (Some(material1), Some(material2)) => {
                        let solid = Solid::from(Mix { material1, material2, share, share_texture });
                        Some(self.scene_material(Material::Solid(solid, Vec::new()), at))
                    }
                    (Some(only), None) | (None, Some(only)) => {
                        self.said.once(at, "a mix with what is not there has no counterpart: the other counts alone");
                        Some(only)
                    }
                    (None, None) => None,
                }
            }
        };
        self.numbers.insert(key, number);
        number
    }

    fn scene_material(&mut self, value: Material, span: Span) -> u32 {
        self.scene.materials.push(Spanned { value, span });
        (self.scene.materials.len() - 1) as u32
    }

    fn shine(&mut self, m: &mut PrincipledMaterial, light: &AreaLight, color: Color) {
        let most = color.max_element();
        if most <= 0.0 {
            return;
        }
        (m.emission_luminance, m.emission_color) = (most, color / most);
        if light.two_sided {
            match m.transmission_weight > 0.0 && m.walls == Walls::Solid {
                true => self.said.once(light.at, "glass shines outwards only"),
                false => m.walls = Walls::Thin,
            }
        }
        if let Some(name) = &light.picture
            && let Some(bytes) = self.eight_bits(name, light.at)
        {
            m.emission_texture = Some(self.asset(Picture { bytes, mapping: Mapping::default() }, light.at));
        }
    }
}
