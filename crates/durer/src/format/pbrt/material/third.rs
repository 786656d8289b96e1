//! Materials of pbrt-v3. Most are sums: Lambert's and a rough mirror beside each other, where later
//! there are layers. Sums are mixes here, whose parts are as much brighter as they are less there.
//!
//! Source of all meanings: *Physically Based Rendering*, 3rd edition, chapters 8 and 9, and *Input File
//! Format*, pbrt.org/fileformat-v3.

use super::super::made::{Made, Medium, Texture};
use super::super::params::{Kind, Params};
use super::super::spectrum::{Spectrum, metal};
use super::super::state::Reader;
use super::matte;
use crate::bsdf::albedo;
use crate::bsdf::microfacet::Ggx;
use crate::describe::FileName;
use crate::diag::Span;
use crate::format::said::meant;
use crate::material::PrincipledMaterial;
use crate::material::principled::Walls;
use crate::math::{Color, Vec3, fp};

const KNOWN: [&str; 15] = [
    "disney",
    "fourier",
    "glass",
    "hair",
    "kdsubsurface",
    "matte",
    "metal",
    "mirror",
    "mix",
    "none",
    "plastic",
    "substrate",
    "subsurface",
    "translucent",
    "uber",
];

/// Materials of pbrt-v4 alone.
const NEW: [&str; 8] = [
    "coatedconductor",
    "coateddiffuse",
    "conductor",
    "dielectric",
    "diffuse",
    "diffusetransmission",
    "interface",
    "thindielectric",
];

/// Indices of copper for red, green and blue: what its spectra come to in pbrt-v3.
///
/// Source of the spectra: as pbrt-v3 has them, from Palik, *Handbook of Optical Constants of Solids*,
/// 1985.
const COPPER: [Vec3; 2] = [Vec3::new(0.200438, 0.924033, 1.102212), Vec3::new(3.912949, 2.452848, 2.142188)];

/// One of those that are added.
pub(super) struct Part {
    pub layers: PrincipledMaterial,
    /// The most that it gives back.
    pub most: f32,
}

/// How rough something is.
pub(super) struct Rough {
    picture: Option<FileName>,
    /// GGX's alpha along u and v.
    pub alphas: [f32; 2],
    /// Our roughness; of a picture its mean.
    mean: f32,
}

impl Rough {
    pub fn new(alphas: [f32; 2]) -> Self {
        Rough { picture: None, alphas, mean: (alphas[0] * alphas[1]).sqrt().min(1.0).sqrt() }
    }

    pub fn put(&self, m: &mut PrincipledMaterial) {
        m.specular_roughness_texture = self.picture.clone();
        [m.specular_roughness, m.specular_anisotropy, m.specular_rotation] = Ggx::parameters(self.alphas);
    }

    fn is_smooth(&self) -> bool {
        self.picture.is_none() && self.alphas == [0.0; 2]
    }

    /// The share of light that it gives back at once, where it reflects all, on the mean over all
    /// directions: pbrt-v3 leaves the rest out, and we do not.
    fn kept_by_metal(&self) -> f32 {
        const STEPS: u16 = 8;
        let given = |i: u16| albedo::ggx(((f32::from(i) + 0.5) / f32::from(STEPS)).sqrt(), self.mean);
        (0..STEPS).map(given).sum::<f32>() / f32::from(STEPS)
    }

    /// The same of a boundary, reflected or refracted.
    fn kept(&self, index: f32) -> f32 {
        if self.is_smooth() { 1.0 } else { albedo::single_means(index, self.mean)[1] }
    }
}

/// GGX's alpha of a roughness from 0 to 1.
///
/// Source: *Physically Based Rendering*, 3rd edition, section 8.4.2.
pub(in crate::format::pbrt) fn alpha_of_roughness(roughness: f32) -> f32 {
    let x = fp::ln(roughness.max(1e-3));
    1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)))
}

/// A rough boundary that reflects, with nothing below it.
pub(super) fn glossy((color, picture): (Color, Option<FileName>), ior: f32, rough: &Rough) -> PrincipledMaterial {
    let mut m = matte(Vec3::ZERO);
    (m.specular_weight, m.specular_ior) = (1.0, ior);
    (m.specular_color, m.specular_color_texture) = (rough.kept(ior) * color, picture);
    rough.put(&mut m);
    m
}

/// The colour of an energy-preserving rough surface that gives back as much on the mean as Oren's and
/// Nayar's does, and its roughness.
///
/// Source: Oren and Nayar, *Generalization of Lambert's Reflectance Model*, SIGGRAPH 1994.
fn oren_nayar(color: Color, degrees: f32) -> (Color, f32) {
    // The mean of max(0, cos) sin tan over both directions by their cosines: 2/3 - 64 / (45 pi).
    const LEANING: f32 = 0.213_954;
    let sigma = degrees.to_radians();
    let variance = sigma * sigma;
    let (a, b) = (1.0 - 0.5 * variance / (variance + 0.33), 0.45 * variance / (variance + 0.09));
    let roughness = (b / a).clamp(0.0, 1.0);
    // As in `bsdf::lobe::diffuse`: what is scattered once on the mean, and again.
    let mean = (1.0 + 0.072_488 * roughness) / (1.0 + 0.287_793 * roughness);
    let whole = |c: f32| c * mean + c * c * mean * (1.0 - mean) / (1.0 - c * (1.0 - mean));
    let solved = color.map(|wanted| {
        let wanted = wanted.min(1.0) * (a + LEANING * b);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            if whole(middle) < wanted { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    });
    (solved, roughness)
}

impl Reader<'_> {
    /// Roughness by one parameter for both directions, if there is such, or by one for each.
    pub(super) fn rough(&mut self, params: &Params, both: Option<&'static str>, each: bool, usual: f32) -> Rough {
        const EACH: [&str; 2] = ["uroughness", "vroughness"];
        let remapped = params.truth("remaproughness").unwrap_or(true);
        let alpha = |written: f32| if remapped { alpha_of_roughness(written) } else { written };
        let names = if each { EACH.map(|name| params.get(name)) } else { [None; 2] };
        let texture = |i: usize| names[i].filter(|param| param.kind == Kind::Texture).map(|param| param.text());
        let pictured = match (names[0].is_some() || names[1].is_some(), both) {
            (true, _) if texture(0).is_some() && texture(0) == texture(1) => Some(EACH[0]),
            (true, _) => None,
            (false, both) => both,
        };
        let picture = pictured.and_then(|name| self.changed(params, name, false, |x| alpha(x).max(0.0).sqrt()));
        if let Some(picture) = picture {
            // What is left out is that of its mean.
            let mean = self.mean_of_asset(&picture, params.at).unwrap_or(0.5);
            return Rough { picture: Some(picture), alphas: [1.0; 2], mean };
        }
        let usual = both.map_or(usual, |name| self.value(params, name, usual));
        let alphas = EACH.map(|name| {
            let written = if each { self.value(params, name, usual) } else { usual };
            alpha(written).max(1e-3)
        });
        Rough::new(alphas)
    }

    /// The same as the mean of both directions: what lies on a matte base has but one here.
    pub(super) fn even_rough(&mut self, params: &Params, both: Option<&'static str>, each: bool, usual: f32) -> Rough {
        let rough = self.rough(params, both, each, usual);
        let [u, v] = rough.alphas;
        if u != v {
            self.said.once(
                params.at,
                "what is reflected on a matte base is as rough in both directions: their mean is taken",
            );
        }
        Rough { alphas: [(u * v).sqrt(); 2], ..rough }
    }

    /// An index of refraction, `eta` or `index`.
    pub(super) fn old_index(&self, params: &Params, usual: f32) -> f32 {
        let name = if params.get("eta").is_some() { "eta" } else { "index" };
        let index = match params.get(name).map(|param| param.kind) {
            Some(Kind::Spectrum | Kind::Rgb) => params.spectrum(name).map_or(usual, |spectrum| spectrum.plain().y),
            _ => self.value(params, name, usual),
        };
        if index <= 0.0 {
            self.said.bad(params.place(name), "an index of refraction must be more than 0");
            return usual;
        }
        index
    }

    /// A material that scatters as several do together.
    pub(super) fn sum(&mut self, parts: Vec<Part>, at: Span) -> Made {
        // What gives nothing back may still be there in part only.
        let opacity =
            parts.first().map_or((1.0, None), |part| (part.layers.opacity, part.layers.opacity_texture.clone()));
        let black = PrincipledMaterial { opacity: opacity.0, opacity_texture: opacity.1, ..matte(Vec3::ZERO) };
        let mut parts: Vec<Part> = parts.into_iter().filter(|part| part.most > 0.0).collect();
        let whole: f32 = parts.iter().map(|part| part.most).sum();
        let Some(last) = parts.pop() else { return Made::Layers(Box::new(black), at) };
        if parts.is_empty() {
            return Made::Layers(Box::new(last.layers), at);
        }
        let layers = |part: Part| {
            let (mut m, factor) = (part.layers, whole / part.most);
            for color in [&mut m.base_color, &mut m.specular_color, &mut m.transmission_color, &mut m.subsurface_color]
            {
                *color *= factor;
            }
            Made::Layers(Box::new(m), at)
        };
        let mut rest = last.most;
        let mut made = layers(last);
        while let Some(part) = parts.pop() {
            let share = part.most / (part.most + rest);
            rest += part.most;
            let numbers = [layers(part), made].map(|made| {
                self.materials.push(made);
                self.materials.len() - 1
            });
            made = self.mix(numbers, share, at);
        }
        made
    }

    pub(super) fn third(&mut self, kind: &str, params: &Params, at: Span) -> Made {
        let parts = match kind {
            "matte" => {
                let (color, picture) = self.colored(params, "Kd", 0.5);
                let degrees = self.value(params, "sigma", 0.0).clamp(0.0, 90.0);
                let (color, roughness) = if degrees > 0.0 { oren_nayar(color, degrees) } else { (color, 0.0) };
                let layers = PrincipledMaterial {
                    base_color_texture: picture,
                    base_diffuse_roughness: roughness,
                    ..matte(color)
                };
                vec![Part { layers, most: 1.0 }]
            }
            "plastic" => {
                let rough = self.even_rough(params, Some("roughness"), false, 0.1);
                // Its index is 1.5 outside and 1 inside: it reflects as from within.
                vec![self.lambert(params, "Kd", 0.25), self.gloss(params, "Ks", (0.25, 1.0 / 1.5), &rough)]
            }
            "uber" => self.uber(params),
            "translucent" => self.translucent(params),
            "substrate" => self.substrate(params),
            "metal" => {
                let rough = self.rough(params, Some("roughness"), true, 0.01);
                let [eta, k] = ["eta", "k"].map(|name| params.spectrum(name).map(|spectrum| spectrum.plain()));
                let [eta, k] = [eta.unwrap_or(COPPER[0]), k.unwrap_or(COPPER[1])];
                let [f0, f82] = metal(&Spectrum::Rgb(eta), &Spectrum::Rgb(k), 1.0);
                vec![Part { layers: metallic(f0, f82, &rough), most: 1.0 }]
            }
            "mirror" => {
                let (color, picture) = self.colored(params, "Kr", 0.9);
                let most = color.max_element().clamp(1e-6, 1.0);
                // It reflects the same share at all angles.
                let m = PrincipledMaterial {
                    base_metalness: 1.0,
                    base_color: color / most,
                    base_color_texture: picture,
                    specular_weight: most,
                    specular_roughness: 0.0,
                    ..PrincipledMaterial::default()
                };
                vec![Part { layers: m, most: if color == Vec3::ZERO { 0.0 } else { 1.0 } }]
            }
            "glass" => {
                let index = self.old_index(params, 1.5);
                let (reflected, through) = (self.colored(params, "Kr", 1.0), self.colored(params, "Kt", 1.0));
                let smooth = ["uroughness", "vroughness"].iter().all(|name| {
                    params.get(name).is_none_or(|param| param.kind != Kind::Texture && param.number() == 0.0)
                });
                let rough = if smooth { None } else { Some(self.rough(params, None, true, 0.0)) };
                vec![Part { layers: glass(reflected, through, index, rough.as_ref()), most: 1.0 }]
            }
            "disney" => return self.disney(params, at),
            "subsurface" | "kdsubsurface" => vec![self.below(kind, params)],
            "mix" => return self.mix_of_two(params, at),
            "" | "none" => return Made::Nothing,
            "fourier" => {
                params.known(&["bsdffile"]);
                self.said.once(at, "measured materials have no counterpart: matte grey is taken");
                vec![Part { layers: matte(Vec3::splat(0.5)), most: 1.0 }]
            }
            "hair" => {
                params.known(&["sigma_a", "color", "eumelanin", "pheomelanin", "eta", "beta_m", "beta_n", "alpha"]);
                self.said.once(at, "hair has no counterpart: matte brown is taken");
                vec![Part { layers: matte(Vec3::new(0.2, 0.12, 0.07)), most: 1.0 }]
            }
            other => {
                let help = match NEW.contains(&other) {
                    true => Some("this is of pbrt-v4".into()),
                    false => meant(other, KNOWN),
                };
                self.no_material(other, at, help, NEW.contains(&other));
                return Made::Nothing;
            }
        };
        let mut bent = Vec::with_capacity(parts.len());
        for Part { mut layers, most } in parts {
            self.surface(&mut layers, params, "bumpmap");
            bent.push(Part { layers, most });
        }
        self.sum(bent, at)
    }

    /// What Lambert's law scatters.
    fn lambert(&mut self, params: &Params, name: &'static str, usual: f32) -> Part {
        let (color, picture) = self.colored(params, name, usual);
        let layers = PrincipledMaterial { base_color_texture: picture, ..matte(color) };
        Part { layers, most: color.max_element() }
    }

    /// What facets reflect: by default so much of what a boundary of an index does.
    fn gloss(&mut self, params: &Params, name: &'static str, (usual, ior): (f32, f32), rough: &Rough) -> Part {
        let color = self.colored(params, name, usual);
        Part { most: color.0.max_element(), layers: glossy(color, ior, rough) }
    }

    fn uber(&mut self, params: &Params) -> Vec<Part> {
        let rough = self.even_rough(params, Some("roughness"), true, 0.1);
        let index = self.old_index(params, 1.5);
        let smooth = Rough::new([0.0; 2]);
        let mut parts = vec![self.lambert(params, "Kd", 0.25), self.gloss(params, "Ks", (0.25, index), &rough)];
        let (reflected, through) = (self.colored(params, "Kr", 0.0), self.colored(params, "Kt", 0.0));
        parts.push(match through.0 == Vec3::ZERO {
            true => Part { most: reflected.0.max_element(), layers: glossy(reflected, index, &smooth) },
            false => {
                let most = reflected.0.max_element().max(through.0.max_element());
                Part { most, layers: glass(reflected, through, index, None) }
            }
        });
        let (share, picture) = match self.pattern(params, "opacity", true, Vec3::ONE) {
            Texture::Even(color) => {
                if color.max_element() - color.min_element() > 1e-3 {
                    let what = "an `opacity` of a colour has no counterpart: the mean of its parts is taken";
                    self.said.once(params.place("opacity"), what);
                }
                (color.element_sum() / 3.0, None)
            }
            Texture::Picture(..) => (1.0, self.changed(params, "opacity", true, |x| x)),
        };
        for part in &mut parts {
            (part.layers.opacity, part.layers.opacity_texture) = (share, picture.clone());
        }
        parts
    }

    /// What is matte on both sides, with facets that reflect.
    fn translucent(&mut self, params: &Params) -> Vec<Part> {
        let rough = self.rough(params, Some("roughness"), false, 0.1);
        let even = |reader: &mut Self, name, usual| reader.pattern(params, name, true, Vec3::splat(usual)).even();
        let [up, down] = ["reflect", "transmit"].map(|name| even(self, name, 0.5).unwrap_or(Vec3::splat(0.5)));
        let (color, picture) = self.colored(params, "Kd", 0.25);
        let sum = |color: Color| color.element_sum().max(1e-6);
        let layers = PrincipledMaterial {
            subsurface_weight: 1.0,
            subsurface_color: color * (up + down),
            subsurface_color_texture: picture,
            // A sheet divides what it scatters by one number for all colours.
            subsurface_scatter_anisotropy: ((sum(down) - sum(up)) / (sum(down) + sum(up))).clamp(-0.999, 0.999),
            walls: Walls::Thin,
            ..matte(Vec3::ZERO)
        };
        let matte = Part { most: (color * (up + down)).max_element(), layers };
        let (shine, picture) = self.colored(params, "Ks", 0.25);
        let gloss = glossy((up * shine, picture.clone()), 1.5, &rough);
        let mut parts = vec![matte, Part { most: (up * shine).max_element(), layers: gloss }];
        // Facets let light through too; those of a sheet do not refract.
        if (down * shine).max_element() > 0.0 {
            let what = "light that facets of `translucent` let through is not refracted here";
            self.said.once(params.at, what);
            let kept = 0.5 * (rough.kept(1.5) + rough.kept(1.0 / 1.5));
            let mut through = super::matte(Vec3::ZERO);
            (through.specular_weight, through.specular_color) = (1.0, Vec3::ZERO);
            (through.transmission_weight, through.walls) = (1.0, Walls::Thin);
            (through.transmission_color, through.transmission_color_texture) = (kept * down * shine, picture);
            rough.put(&mut through);
            parts.push(Part { most: (down * shine).max_element(), layers: through });
        }
        parts
    }

    /// What scatters light below a skin that refracts.
    fn below(&mut self, kind: &str, params: &Params) -> Part {
        let rough = self.rough(params, None, true, 0.0);
        let mut m = PrincipledMaterial::default();
        rough.put(&mut m);
        m.specular_ior = self.old_index(params, 1.33);
        params.left_out(&["Kr", "Kt"], "the skin takes no light");
        if kind == "kdsubsurface" {
            let (color, picture) = self.colored(params, "Kd", 0.5);
            let path = params.spectrum("mfp").map_or(Vec3::ONE, |spectrum| spectrum.plain());
            m.subsurface_weight = 1.0;
            (m.subsurface_color, m.subsurface_color_texture) = (color.min(Vec3::ONE), picture);
            m.subsurface_radius = params.float("scale").unwrap_or(1.0).max(1e-6);
            m.subsurface_radius_scale = path.max(Vec3::splat(1e-6));
            m.subsurface_scatter_anisotropy = params.float("g").unwrap_or(0.0).clamp(-0.99, 0.99);
        } else {
            m.transmission_weight = 1.0;
            Medium::of(params, "name").fill(&mut m);
        }
        Part { layers: m, most: 1.0 }
    }

    /// `amount` is the share of the first.
    fn mix_of_two(&mut self, params: &Params, at: Span) -> Made {
        let amount = match self.pattern(params, "amount", true, Vec3::splat(0.5)) {
            Texture::Even(color) => {
                if color.max_element() - color.min_element() > 1e-3 {
                    let what = "an `amount` of a colour has no counterpart: the mean of its parts is taken";
                    self.said.once(params.place("amount"), what);
                }
                color.element_sum() / 3.0
            }
            Texture::Picture(picture, scale) => self.mean_of(params, "amount", &picture).unwrap_or(0.5) * scale.x,
        };
        let names = ["namedmaterial1", "namedmaterial2"].map(|name| (name, params.text(name).map(str::to_string)));
        let mut numbers = [0; 2];
        for (number, (name, given)) in numbers.iter_mut().zip(names) {
            let Some(given) = given else {
                self.said.bad(at, format!("a mix needs `\"string {name}\"`"));
                return Made::Nothing;
            };
            let place = params.get(name).map_or(at, |param| param.values_at);
            match self.known_material(&given, place) {
                Some(found) => *number = found,
                None => return Made::Nothing,
            }
        }
        self.mix(numbers, amount.clamp(0.0, 1.0), at)
    }
}

/// A metal by what it reflects at right angles and at 82 degrees, without what a rough one gives back
/// later, on the mean over all directions.
fn metallic(f0: Color, f82: Color, rough: &Rough) -> PrincipledMaterial {
    let kept = rough.kept_by_metal();
    let (lost, strongest) = ((1.0 - kept) / kept, f0.max_element());
    let weight = 1.0 / (1.0 + strongest * lost);
    // Ours is x (1 + x lost) times the weight.
    let ours = f0.map(|f0| match lost > 1e-4 {
        true => ((1.0 + 4.0 * lost * f0 / weight).sqrt() - 1.0) / (2.0 * lost),
        false => f0 / weight,
    });
    let ours = ours.min(Vec3::ONE);
    let schlick = ours + (Vec3::ONE - ours) * fp::pow(6.0 / 7.0, 5.0);
    let wanted = f82 / (weight * (Vec3::ONE + ours * lost));
    let mut m = PrincipledMaterial {
        base_metalness: 1.0,
        base_color: ours,
        specular_color: wanted / schlick.max(Vec3::splat(1e-6)),
        specular_weight: weight,
        ..PrincipledMaterial::default()
    };
    rough.put(&mut m);
    m
}

/// A body of glass, rough or smooth.
fn glass(
    (reflected, reflected_picture): (Color, Option<FileName>),
    (through, through_picture): (Color, Option<FileName>),
    index: f32,
    rough: Option<&Rough>,
) -> PrincipledMaterial {
    // Light goes in and out.
    let kept = rough.map_or(1.0, |rough| 0.5 * (rough.kept(index) + rough.kept(1.0 / index)));
    let mut m = PrincipledMaterial {
        transmission_weight: 1.0,
        transmission_color: kept * through,
        transmission_color_texture: through_picture,
        specular_color: kept * reflected,
        specular_color_texture: reflected_picture,
        specular_ior: index,
        specular_roughness: 0.0,
        ..PrincipledMaterial::default()
    };
    rough.into_iter().for_each(|rough| rough.put(&mut m));
    m
}
