//! Materials, in the words of OpenPBR.
//!
//! Source of all meanings: *Physically Based Rendering*, 4th edition, chapters 9, 10 and 14. A coat
//! over a matte base is a coat that darkens it; a metal is its reflectance at 0 and at 82 degrees;
//! GGX's alpha is the square of our roughness.

use super::made::{AreaLight, Made, Medium, Opacity};
use super::params::{Kind, Param, Params};
use super::spectrum::{Spectrum, metal};
use super::state::{MATERIAL, Reader};
use crate::bsdf::microfacet::Ggx;
use crate::describe::FileName;
use crate::diag::Span;
use crate::format::said::meant;
use crate::material::mix::Mix;
use crate::material::principled::Walls;
use crate::material::{PrincipledMaterial, Solid};
use crate::math::{Color, Vec3, fp};
use crate::scene::{Material, Picture, Spanned};
use crate::texture::Mapping;
use std::rc::Rc;

/// Mixes in mixes.
const DEEPEST: u32 = 32;

const KNOWN: [&str; 12] = [
    "diffuse",
    "coateddiffuse",
    "conductor",
    "coatedconductor",
    "dielectric",
    "thindielectric",
    "diffusetransmission",
    "mix",
    "interface",
    "subsurface",
    "measured",
    "hair",
];

/// Materials of pbrt-v3, and what they are now.
const OLD: [(&str, &str); 8] = [
    ("matte", "diffuse"),
    ("plastic", "coateddiffuse"),
    ("metal", "conductor"),
    ("glass", "dielectric"),
    ("mirror", "conductor"),
    ("substrate", "coateddiffuse"),
    ("uber", "coateddiffuse"),
    ("translucent", "diffusetransmission"),
];

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
            Made::Nothing => false,
        }
    }
}

/// Matte, without a boundary.
fn matte(base_color: Color) -> PrincipledMaterial {
    PrincipledMaterial { base_color, specular_weight: 0.0, specular_roughness: 1.0, ..PrincipledMaterial::default() }
}

impl Reader<'_> {
    /// GGX's alpha along both directions, by three parameters: of both, and of each.
    fn alphas(&self, params: &Params, [both, u, v]: [&'static str; 3], remapped: bool) -> [f32; 2] {
        let usual = self.value(params, both, 0.0);
        // Source: pbrt-v4 takes the root of what is written, where that is asked for.
        [u, v].map(|name| {
            let written = self.value(params, name, usual).max(0.0);
            if remapped { written.sqrt() } else { written }
        })
    }

    /// The roughness of a picture of GGX's alpha, and what alpha it multiplies: that of the
    /// picture, or of the numbers.
    fn roughness(&mut self, params: &Params, names: [&'static str; 3], remapped: bool) -> (Option<FileName>, [f32; 2]) {
        let each = names[1..].iter().any(|name| params.get(name).is_some());
        let fourth = |x: f32| x.max(0.0).sqrt().sqrt();
        let picture = if each {
            None
        } else {
            self.changed(params, names[0], |x| if remapped { fourth(x) } else { x.max(0.0).sqrt() })
        };
        match picture {
            Some(picture) => (Some(picture), [1.0; 2]),
            None => (None, self.alphas(params, names, remapped)),
        }
    }

    /// The number of a material.
    pub fn material(&mut self, kind: &str, at: Span, list: Vec<Rc<Param>>) -> usize {
        let params = self.params(list, Some(MATERIAL), at);
        let made = self.made(kind, &params, at);
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
        if self.named_materials.insert(name.clone(), number).is_some() {
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

    fn made(&mut self, kind: &str, params: &Params, at: Span) -> Made {
        let remapped = params.truth("remaproughness").unwrap_or(true);
        let mut m = PrincipledMaterial::default();
        const ROUGHNESS: [&str; 3] = ["roughness", "uroughness", "vroughness"];
        match kind {
            "diffuse" => {
                let (color, picture) = self.colored(params, "reflectance", 0.5);
                m = PrincipledMaterial { base_color_texture: picture, ..matte(color) };
                params.left_out(&["sigma"], "the surface is Lambert's");
            }
            "coateddiffuse" => {
                let (color, picture) = self.colored(params, "reflectance", 0.5);
                m = PrincipledMaterial { base_color_texture: picture, ..matte(color) };
                let alphas;
                (m.coat_roughness_texture, alphas) = self.roughness(params, ROUGHNESS, remapped);
                m.coat_ior = self.index(params, "eta", 1.5);
                self.coat(&mut m, alphas, params);
            }
            "conductor" => {
                let alphas;
                (m.specular_roughness_texture, alphas) = self.roughness(params, ROUGHNESS, remapped);
                self.conductor(&mut m, params, ["eta", "k", "reflectance"], alphas, 1.0);
            }
            "coatedconductor" => {
                let interface = ["interface.roughness", "interface.uroughness", "interface.vroughness"];
                let conductor = ["conductor.roughness", "conductor.uroughness", "conductor.vroughness"];
                let (above, below);
                (m.coat_roughness_texture, above) = self.roughness(params, interface, remapped);
                (m.specular_roughness_texture, below) = self.roughness(params, conductor, remapped);
                m.coat_ior = self.index(params, "interface.eta", 1.5);
                let ior = m.coat_ior;
                self.conductor(&mut m, params, ["conductor.eta", "conductor.k", "reflectance"], below, ior);
                self.coat(&mut m, above, params);
            }
            "dielectric" | "thindielectric" => {
                m.transmission_weight = 1.0;
                m.specular_ior = self.index(params, "eta", 1.5);
                let mut alphas = [0.0; 2];
                if kind == "dielectric" {
                    (m.specular_roughness_texture, alphas) = self.roughness(params, ROUGHNESS, remapped);
                }
                [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(alphas);
                m.walls = if kind == "thindielectric" { Walls::Thin } else { Walls::Solid };
            }
            "diffusetransmission" => {
                let scale = params.float("scale").unwrap_or(1.0);
                let [reflected, through] = ["reflectance", "transmittance"].map(|name| {
                    let (color, picture) = self.colored(params, name, 0.25);
                    if picture.is_some() {
                        let what = "light that is scattered through a surface by a picture has no counterpart: one colour is taken";
                        self.said.once(params.place(name), what);
                    }
                    scale * color
                });
                // A sheet divides what it scatters by one number for all colours.
                let sum = |color: Color| color.element_sum().max(1e-6);
                m = PrincipledMaterial {
                    subsurface_weight: 1.0,
                    subsurface_color: (reflected + through).min(Vec3::ONE),
                    subsurface_scatter_anisotropy: ((sum(through) - sum(reflected)) / (sum(through) + sum(reflected)))
                        .clamp(-0.999, 0.999),
                    walls: Walls::Thin,
                    ..matte(Vec3::ZERO)
                };
            }
            "subsurface" => {
                let alphas;
                (m.specular_roughness_texture, alphas) = self.roughness(params, ROUGHNESS, remapped);
                [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(alphas);
                m.specular_ior = self.index(params, "eta", 1.33);
                params.left_out(&["name"], "the coefficients count");
                if params.get("reflectance").is_some() {
                    let (color, picture) = self.colored(params, "reflectance", 1.0);
                    m.subsurface_color_texture = picture;
                    let path = params.spectrum("mfp").map_or(Vec3::ONE, |spectrum| spectrum.coefficient());
                    m.subsurface_weight = 1.0;
                    m.subsurface_color = color.min(Vec3::ONE);
                    m.subsurface_radius = params.float("scale").unwrap_or(1.0).max(1e-6);
                    m.subsurface_radius_scale = path.max(Vec3::splat(1e-6));
                    m.subsurface_scatter_anisotropy = params.float("g").unwrap_or(0.0).clamp(-0.99, 0.99);
                } else {
                    // The skin refracts, and what is inside scatters.
                    m.transmission_weight = 1.0;
                    Medium::of(params).fill(&mut m);
                }
            }
            "measured" => {
                params.known(&["filename"]);
                m = matte(Vec3::splat(0.5));
                self.said.once(at, "measured materials have no counterpart: matte grey is taken");
            }
            "hair" => {
                params.known(&[
                    "sigma_a",
                    "reflectance",
                    "color",
                    "eumelanin",
                    "pheomelanin",
                    "eta",
                    "beta_m",
                    "beta_n",
                    "alpha",
                ]);
                m = matte(Vec3::new(0.2, 0.12, 0.07));
                self.said.once(at, "hair has no counterpart: matte brown is taken");
            }
            "mix" => return self.mixed(params, at),
            "interface" | "" | "none" => return Made::Nothing,
            other => {
                let old = OLD.iter().find(|row| row.0 == other);
                let help = match old {
                    Some((_, now)) => {
                        Some(format!("this is of pbrt-v3; `{now}` is nearest, and `pbrt --upgrade` converts a file"))
                    }
                    None => meant(other, KNOWN),
                };
                self.said.bad_with(at, format!("there is no material `{other}`"), help);
                return Made::Nothing;
            }
        }
        if let Some(name) = params.text("normalmap") {
            let place = params.get("normalmap").map_or(at, |param| param.values_at);
            if let Some(bytes) = self.eight_bits(name, place) {
                m.normal_texture = Some(self.asset(Picture { bytes, mapping: Mapping::default() }, place));
            }
        }
        if let super::made::Texture::Picture(picture, scale) = self.pattern(params, "displacement", false, Vec3::ZERO) {
            (m.bump_texture, m.bump_height) = (Some(self.asset(picture, params.place("displacement"))), scale.x);
        }
        Made::Layers(Box::new(m), at)
    }

    /// An index of refraction, which may be a spectrum.
    fn index(&self, params: &Params, name: &'static str, usual: f32) -> f32 {
        let index = match params.get(name).map(|param| param.kind) {
            Some(Kind::Spectrum | Kind::Rgb) => params.spectrum(name).map_or(usual, |spectrum| spectrum.index()),
            _ => self.value(params, name, usual),
        };
        if index <= 0.0 {
            self.said.bad(params.place(name), "an index of refraction must be more than 0");
            return usual;
        }
        index
    }

    fn coat(&self, m: &mut PrincipledMaterial, [u, v]: [f32; 2], params: &Params) {
        (m.coat_weight, m.coat_roughness) = (1.0, (u.min(1.0) * v.min(1.0)).sqrt().sqrt());
        if u != v {
            self.said.once(params.at, "a coat is as rough in both directions: their mean is taken");
        }
        if params.get("albedo").is_some_and(|param| param.numbers().iter().any(|x| *x != 0.0)) {
            self.said.once(params.place("albedo"), "what is inside a coat has no counterpart: the coat is clear");
        }
        params.known(&["thickness", "g", "maxdepth", "nsamples", "twosided"]);
    }

    fn conductor(
        &mut self,
        m: &mut PrincipledMaterial,
        params: &Params,
        [eta, k, reflectance]: [&'static str; 3],
        alphas: [f32; 2],
        outside: f32,
    ) {
        let copper = |which: &str| super::named::spectrum(&format!("metal-Cu-{which}"));
        let [f0, f82] = match params.get(reflectance) {
            Some(param) => {
                if params.get(eta).is_some() || params.get(k).is_some() {
                    self.said.bad(param.at, format!("a metal has either `{reflectance}` or `{eta}` and `{k}`"));
                }
                let share = match self.pattern(params, reflectance, true, Vec3::splat(0.5)) {
                    super::made::Texture::Even(color) => color,
                    super::made::Texture::Picture(picture, scale) => {
                        // What it reflects at right angles is the picture's; grazing light has no
                        // colour of its own.
                        m.base_color_texture = Some(self.asset(picture, param.at));
                        (m.base_metalness, m.base_color) = (1.0, scale);
                        [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(alphas);
                        return;
                    }
                };
                // Such a k, with an index of 1, reflects that share at right angles.
                let k = share.map(|r| 2.0 * (r.min(0.9999) / (1.0 - r.min(0.9999))).sqrt());
                metal(&Spectrum::Rgb(Vec3::ONE), &Spectrum::Rgb(k), 1.0)
            }
            None => {
                let given = |name, which| params.spectrum(name).or_else(|| copper(which));
                let grey = Spectrum::Rgb(Vec3::ONE);
                metal(&given(eta, "eta").unwrap_or(grey.clone()), &given(k, "k").unwrap_or(grey), outside)
            }
        };
        const REST: f32 = 6.0 / 7.0;
        let schlick = f0 + (Vec3::ONE - f0) * fp::pow(REST, 5.0);
        (m.base_metalness, m.base_color, m.specular_color) = (1.0, f0, f82 / schlick.max(Vec3::splat(1e-6)));
        [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(alphas);
    }

    fn mixed(&self, params: &Params, at: Span) -> Made {
        let share = 1.0 - self.value(params, "amount", 0.5).clamp(0.0, 1.0);
        let Some(param) = params.get("materials") else {
            self.said.bad(at, "a mix needs two names, `\"string materials\" [ \"a\" \"b\" ]`");
            return Made::Nothing;
        };
        let super::params::Values::Texts(names) = &param.values else { return Made::Nothing };
        let [first, second] = names.as_slice() else {
            self.said.bad(param.values_at, format!("a mix is of two materials, not of {}", names.len()));
            return Made::Nothing;
        };
        let found = [first, second].map(|name| self.named_materials.get(name).copied());
        let [Some(a), Some(b)] = found else {
            let missing = if found[0].is_none() { first } else { second };
            let help = meant(missing, self.named_materials.keys().map(String::as_str));
            self.said.bad_with(param.values_at, format!("there is no material `{missing}` before this"), help);
            return Made::Nothing;
        };
        let [first, second] = [a, b].map(|number| &self.materials[number]);
        let depth = 1 + first.depth().max(second.depth());
        let pictured = first.is_pictured() || second.is_pictured();
        if depth > DEEPEST {
            self.said.bad(at, format!("materials are mixed more than {DEEPEST} deep"));
            return Made::Nothing;
        }
        Made::Mix { parts: [a, b], share, depth, pictured, at }
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
                m.opacity = opacity.share.clamp(0.0, 1.0);
                m.opacity_texture = opacity.picture.clone();
                if let Some((light, color)) = light {
                    self.shine(&mut m, light, color);
                }
                Some(self.scene_material(Material::Principled(m), at))
            }
            Made::Mix { parts: [a, b], share, at, .. } => {
                let (a, b, share, at) = (*a, *b, *share, *at);
                match (self.number(a, light, opacity), self.number(b, light, opacity)) {
                    (Some(material1), Some(material2)) => {
                        let solid = Solid::from(Mix { material1, material2, share });
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
