//! Reads textures, which become a constant or a picture.

use super::defs::Texture;
use super::language::Language;
use super::params::{Kind, Param, Params};
use super::state::{Reader, TEXTURE};
use crate::pictures::{self, Pictures};
use crate::shared_report::suggest;
use durer_diag::Span;
use durer_image::{decode_srgb, linear_from_srgb};
use durer_scene::describe::FileName;
use durer_scene::math::{Color, Vec3, fp};
use durer_scene::scene::{PictureBytes, TextureImage};
use durer_scene::texture::{Mapping, Wrap};
use std::rc::Rc;

impl Texture {
    fn scaled(self, by: Color) -> Texture {
        match self {
            Texture::Even(color) => Texture::Even(color * by),
            Texture::Picture(picture, scale) => Texture::Picture(picture, scale * by),
        }
    }

    /// Returns the colour if the texture is constant.
    pub fn even(&self) -> Option<Color> {
        if let Texture::Even(color) = self { Some(*color) } else { None }
    }
}

impl Reader<'_> {
    /// Executes a `Texture` directive.
    pub fn texture(
        &mut self,
        name: String,
        (kind, kind_at): (&str, Span),
        (class, at): (&str, Span),
        list: Vec<Rc<Param>>,
    ) {
        let third = self.language == Language::Third;
        if kind != "float" && kind != "spectrum" && !(third && kind == "color") {
            let help = suggest(kind, ["float", "spectrum"]);
            return self.report.bad_with(kind_at, format!("textures are `float` or `spectrum`, not `{kind}`"), help);
        }
        let params = self.params(list, Some(TEXTURE), at);
        let (is_color, report) = (kind != "float", self.report);
        let instead = |what: &str| report.once(at, format!("the texture `{class}` has no counterpart: {what}"));
        let of = |name: &'static str, usual: f32| self.pattern(&params, name, is_color, Vec3::splat(usual));
        let both = |texture: &Texture, other: &Texture, share: f32| match (texture.even(), other.even()) {
            (Some(a), Some(b)) => Some(Texture::Even(a.lerp(b, share))),
            _ => None,
        };
        let made = match class {
            "constant" => of("value", 1.0),
            "scale" if third => match (of("tex1", 1.0), of("tex2", 1.0)) {
                (texture, Texture::Even(by)) | (Texture::Even(by), texture) => texture.scaled(by),
                (texture, other) => self.together([&texture, &other], at, |a, b| a * b).unwrap_or_else(|| {
                    instead("pictures with different mappings cannot be combined, the first is used");
                    texture
                }),
            },
            "uv" if third => self.corners([Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::new(1.0, 1.0, 0.0)], &params),
            "scale" => {
                let scale = self.pattern(&params, "scale", false, Vec3::ONE);
                match (of("tex", 1.0), scale) {
                    (texture, Texture::Even(by)) => texture.scaled(by),
                    (Texture::Even(by), texture) => texture.scaled(by),
                    (texture, _) => {
                        instead("two pictures cannot be combined, the first is used");
                        texture
                    }
                }
            }
            "mix" | "directionmix" => {
                let (first, second) = (of("tex1", 0.0), of("tex2", 1.0));
                let amount = self.pattern(&params, "amount", false, Vec3::splat(0.5)).even().map(|c| c.x);
                params.known(&["dir"]);
                let share = amount.unwrap_or_else(|| {
                    instead("its `amount` cannot be a picture, 0.5 is used");
                    0.5
                });
                let mixed = || self.together([&first, &second], at, |a, b| a.lerp(b, share));
                both(&first, &second, share).or_else(mixed).unwrap_or_else(|| {
                    instead("pictures with different mappings cannot be mixed, the first is used");
                    if first.even().is_some() { second } else { first }
                })
            }
            "imagemap" => self.imagemap(&params, is_color).unwrap_or(Texture::Even(Vec3::splat(0.5))),
            "checkerboard" => {
                let (odd, even) = (of("tex2", 0.0), of("tex1", 1.0));
                match (even.even(), odd.even(), params.whole("dimension").unwrap_or(2)) {
                    (Some(a), Some(b), 2) => self.checkerboard(a, b, &params),
                    _ => {
                        instead("the mean of its two textures is used");
                        both(&even, &odd, 0.5).unwrap_or(even)
                    }
                }
            }
            "bilerp" => {
                let corners = [of("v00", 0.0), of("v01", 1.0), of("v10", 0.0), of("v11", 1.0)];
                match corners.each_ref().map(Texture::even) {
                    [Some(a), Some(b), Some(c), Some(d)] => self.corners([a, b, c, d], &params),
                    all => {
                        instead("the mean of its corners is used");
                        Texture::Even(all.into_iter().flatten().sum::<Color>() / 4.0)
                    }
                }
            }
            "dots" => {
                instead("`outside` is used");
                params.known(&["inside"]);
                of("outside", 0.0)
            }
            "fbm" | "wrinkled" | "windy" | "marble" | "ptex" => {
                instead("0.5 is used");
                params.known(&["octaves", "roughness", "scale", "variation", "filename", "encoding"]);
                Texture::Even(Vec3::splat(0.5))
            }
            other => {
                let known = [
                    "bilerp",
                    "checkerboard",
                    "constant",
                    "directionmix",
                    "dots",
                    "fbm",
                    "imagemap",
                    "marble",
                    "mix",
                    "ptex",
                    "scale",
                    "windy",
                    "wrinkled",
                ];
                return self.report.bad_with(at, format!("unknown texture `{other}`"), suggest(other, known));
            }
        };
        if third {
            params.known(&["aamode", "dimension"]);
        }
        params.known(&["mapping", "uscale", "vscale", "udelta", "vdelta", "v1", "v2"]);
        params.finish("this texture");
        self.textures.insert((is_color, name), made);
    }

    /// Returns the value of a parameter that may be a texture; `usual` is the default.
    pub fn pattern(&self, params: &Params, name: &'static str, is_color: bool, usual: Color) -> Texture {
        let Some(param) = params.get(name) else { return Texture::Even(usual) };
        if param.kind == Kind::Texture {
            if let Some(texture) = self.textures.get(&(is_color, param.text().to_string())) {
                return texture.clone();
            }
            let known = self.textures.keys().filter(|key| key.0 == is_color).map(|key| key.1.as_str());
            let what = if is_color { "spectrum" } else { "float" };
            let message = format!("unknown texture `{}` of type `{what}`", param.text());
            self.report.bad_with(param.values_at, message, suggest(param.text(), known));
            return Texture::Even(usual);
        }
        Texture::Even(match is_color {
            true => params.spectrum(name).map_or(usual, |spectrum| spectrum.albedo()),
            false => params.float(name).map_or(usual, Vec3::splat),
        })
    }

    /// Returns a float parameter that may be a texture; for a picture, its mean.
    pub fn value(&self, params: &Params, name: &'static str, usual: f32) -> f32 {
        match self.pattern(params, name, false, Vec3::splat(usual)) {
            Texture::Even(color) => color.x,
            Texture::Picture(picture, scale) => {
                self.mean_of(params, name, &picture).map_or(usual, |mean| mean * scale.x)
            }
        }
    }

    /// Returns the mean of a picture, for a parameter that can only be a number in Dürer.
    pub fn mean_of(&self, params: &Params, name: &'static str, picture: &TextureImage) -> Option<f32> {
        let at = params.place(name);
        self.report.once(at, format!("a picture for `{name}` has no counterpart: its mean is used"));
        self.pictures().mean(picture, at)
    }

    /// Returns the picture of a parameter with `change` applied to its values; `None` if the
    /// parameter is not a picture.
    pub fn changed(
        &mut self,
        params: &Params,
        name: &'static str,
        is_color: bool,
        change: impl Fn(f32) -> f32,
    ) -> Option<FileName> {
        let Texture::Picture(picture, scale) = self.pattern(params, name, is_color, Vec3::ZERO) else { return None };
        let at = params.place(name);
        let mean = |p: Color| (p.x + p.y + p.z) / 3.0;
        let picture = self.pictures().changed(&picture, at, decode_srgb, |p| change(scale.x * mean(p)))?;
        Some(self.asset(picture, at))
    }

    /// Returns a float parameter that may be a picture: `change` applied to the value, or 1 and the
    /// changed picture.
    pub fn pictured(
        &mut self,
        params: &Params,
        name: &'static str,
        usual: f32,
        change: impl Fn(f32) -> f32,
    ) -> (f32, Option<FileName>) {
        match self.changed(params, name, false, &change) {
            Some(picture) => (1.0, Some(picture)),
            None => (change(self.value(params, name, usual)), None),
        }
    }

    /// Returns a colour parameter that may be a picture: the colour, or a factor and the picture's
    /// name.
    pub fn colored(&mut self, params: &Params, name: &'static str, usual: f32) -> (Color, Option<FileName>) {
        match self.pattern(params, name, true, Vec3::splat(usual)) {
            Texture::Even(color) => (color, None),
            Texture::Picture(picture, scale) => (scale, Some(self.asset(picture, params.place(name)))),
        }
    }

    /// Adds a picture to the scene and returns its name.
    pub fn asset(&mut self, picture: TextureImage, span: Span) -> FileName {
        pictures::asset(&mut self.scene, picture, span)
    }

    fn pictures(&self) -> Pictures<'_> {
        Pictures { input: self.input, report: self.report }
    }

    /// Returns a file as a picture with 8 bits per channel; other formats are converted.
    pub fn eight_bits(&self, name: &str, at: Span) -> Option<PictureBytes> {
        self.pictures().eight_bits(name, at)
    }

    fn imagemap(&self, params: &Params, is_color: bool) -> Option<Texture> {
        let Some(name) = params.text("filename") else {
            self.report.bad(params.at, "an `imagemap` needs a `filename`");
            return None;
        };
        let at = params.get("filename").map_or(params.at, |param| param.values_at);
        let mut mapping = self.mapping(params);
        match params.text("wrap").unwrap_or("repeat") {
            "repeat" => {}
            "clamp" => mapping.wrap = [Wrap::Clamp; 2],
            "black" => {
                self.report.once(params.place("wrap"), "the wrap mode `black` has no counterpart: `clamp` is used");
                mapping.wrap = [Wrap::Clamp; 2];
            }
            other => {
                let help = suggest(other, ["repeat", "clamp", "black"]);
                self.report.bad_with(params.place("wrap"), format!("unknown wrap mode `{other}`"), help);
            }
        }
        mapping.nearest = params.text("filter") == Some("point");
        mapping.mipmaps = matches!(params.text("filter"), Some("trilinear" | "ewa" | "EWA"));
        if self.language == Language::Third {
            // Ignore pbrt-v3's mipmap settings: sampling needs no mipmaps.
            params.known(&["trilinear", "maxanisotropy"]);
            let scale = Vec3::splat(params.float("scale").unwrap_or(1.0));
            let plain = params.truth("gamma") == Some(false);
            let bytes = self.eight_bits(name, at)?;
            let picture = TextureImage { bytes, mapping };
            let curved = if plain { self.pictures().recoded(&picture, at, true, |x| x) } else { None };
            return Some(Texture::Picture(curved.unwrap_or(picture), scale));
        }
        let gamma = self.encoding(params);
        let inverted = params.truth("invert") == Some(true);
        params.known(&["maxanisotropy", "trilinear"]);
        let scale = Vec3::splat(params.float("scale").unwrap_or(1.0));
        let picture = TextureImage { bytes: self.eight_bits(name, at)?, mapping };
        if gamma.is_none() && !inverted {
            return Some(Texture::Picture(picture, scale));
        }
        let decode = |x: f32| {
            let decoded = gamma.map_or_else(|| linear_from_srgb(x), |gamma| fp::pow(x, gamma));
            if inverted { (1.0 - decoded).max(0.0) } else { decoded }
        };
        let recoded = self.pictures().recoded(&picture, at, is_color, decode);
        Some(Texture::Picture(recoded.unwrap_or(picture), scale))
    }

    /// Returns the exponent that decodes the picture's values to linear ones; `None` for the sRGB
    /// curve.
    fn encoding(&self, params: &Params) -> Option<f32> {
        let text = params.text("encoding").filter(|encoding| *encoding != "sRGB")?;
        if text == "linear" {
            return Some(1.0);
        }
        let words: Vec<&str> = text.split_whitespace().collect();
        let gamma = if let ["gamma", x] = words[..] { x.parse::<f32>().ok().filter(|x| *x > 0.0) } else { None };
        if gamma.is_none() {
            let message = format!("unknown encoding `{text}`: use `sRGB`, `linear`, or `gamma` with a number");
            self.report.bad(params.place("encoding"), message);
        }
        gamma
    }

    fn mapping(&self, params: &Params) -> Mapping {
        if let Some(other) = params.text("mapping").filter(|mapping| *mapping != "uv") {
            let what = format!("the mapping `{other}` has no counterpart: the surface's uv coordinates are used");
            self.report.once(params.place("mapping"), what);
        }
        let number = |name: &'static str, usual: f32| params.float(name).unwrap_or(usual);
        let (su, sv) = (number("uscale", 1.0), number("vscale", 1.0));
        let (du, dv) = (number("udelta", 0.0), number("vdelta", 0.0));
        // v grows upwards in pbrt and in Dürer, but a picture's rows go down.
        Mapping { transform: [[su, 0.0, du], [0.0, sv, 1.0 - sv - dv]], ..Mapping::default() }
    }

    /// Returns the bilinear interpolation of the values at (u, v) = (0, 0), (0, 1), (1, 0) and (1,
    /// 1), as a picture of 2 x 2 texels.
    fn corners(&self, [v00, v01, v10, v11]: [Color; 4], params: &Params) -> Texture {
        let mut mapping = self.mapping(params);
        // Map [0, 1] to the range between texel centres; rows go down.
        let [[su, _, du], [_, sv, dv]] = mapping.transform;
        mapping.transform = [[0.5 * su, 0.0, 0.25 + 0.5 * du], [0.0, 0.5 * sv, 0.25 + 0.5 * dv]];
        mapping.wrap = [Wrap::Clamp; 2];
        match pictures::four([v01, v11, v00, v10]) {
            Some((bytes, most)) => Texture::Picture(TextureImage { bytes, mapping }, Vec3::splat(most)),
            None => Texture::Even(0.25 * (v00 + v01 + v10 + v11)),
        }
    }

    /// Combines two textures texel by texel; `None` if their pictures have different mappings.
    fn together(&self, textures: [&Texture; 2], at: Span, join: impl Fn(Color, Color) -> Color) -> Option<Texture> {
        let pictures = self.pictures();
        let (picture, most) = match textures {
            [Texture::Picture(a, by), Texture::Even(b)] => pictures.remade([a, a], at, |a, _| join(*by * a, *b)),
            [Texture::Even(a), Texture::Picture(b, by)] => pictures.remade([b, b], at, |b, _| join(*a, *by * b)),
            [Texture::Picture(a, by), Texture::Picture(b, other)] => {
                pictures.remade([a, b], at, |a, b| join(*by * a, *other * b))
            }
            _ => None,
        }?;
        Some(Texture::Picture(picture, Vec3::splat(most)))
    }

    /// Returns a checkerboard as a picture of 2 x 2 texels.
    fn checkerboard(&self, even: Color, odd: Color, params: &Params) -> Texture {
        let mut mapping = self.mapping(params);
        // One texel covers one unit of uv. The origin is the lower left corner of an even texel.
        let [[su, _, du], [_, sv, _]] = mapping.transform;
        let dv = params.float("vdelta").unwrap_or(0.0);
        mapping.transform = [[0.5 * su, 0.0, 0.5 * du], [0.0, 0.5 * sv, 1.0 - 0.5 * sv - 0.5 * dv]];
        mapping.nearest = true;
        match pictures::checkerboard(odd, even) {
            Some((bytes, most)) => Texture::Picture(TextureImage { bytes, mapping }, Vec3::splat(most)),
            None => Texture::Even(0.5 * (even + odd)),
        }
    }
}
