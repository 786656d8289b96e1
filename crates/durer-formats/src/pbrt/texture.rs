//! Reads textures, each of which becomes a constant or a picture.

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
            Texture::Constant(color) => Texture::Constant(color * by),
            Texture::Picture(picture, scale) => Texture::Picture(picture, scale * by),
        }
    }

    /// Returns the colour if the texture is constant.
    pub fn constant(&self) -> Option<Color> {
        if let Texture::Constant(color) = self { Some(*color) } else { None }
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
        let third = self.language == Language::V3;
        if kind != "float" && kind != "spectrum" && !(third && kind == "color") {
            let help = suggest(kind, ["float", "spectrum"]);
            return self.report.error_with_help(
                kind_at,
                format!("a texture must be of type `float` or `spectrum`, not `{kind}`"),
                help,
            );
        }
        let params = self.params(list, Some(TEXTURE), at);
        let (is_color, report) = (kind != "float", self.report);
        let instead =
            |what: &str| report.unsupported_once(at, format!("the texture `{class}` has no counterpart: {what}"));
        let of = |name: &'static str, default: f32| self.texture_value(&params, name, is_color, Vec3::splat(default));
        let both = |texture: &Texture, other: &Texture, share: f32| match (texture.constant(), other.constant()) {
            (Some(a), Some(b)) => Some(Texture::Constant(a.lerp(b, share))),
            _ => None,
        };
        let value = match class {
            "constant" => of("value", 1.0),
            "scale" if third => match (of("tex1", 1.0), of("tex2", 1.0)) {
                (texture, Texture::Constant(by)) | (Texture::Constant(by), texture) => texture.scaled(by),
                (texture, other) => self.combine([&texture, &other], at, |a, b| a * b).unwrap_or_else(|| {
                    instead("the first of two pictures with different mappings is used");
                    texture
                }),
            },
            "uv" if third => self.corners([Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::new(1.0, 1.0, 0.0)], &params),
            "scale" => {
                let scale = self.texture_value(&params, "scale", false, Vec3::ONE);
                match (of("tex", 1.0), scale) {
                    (texture, Texture::Constant(by)) => texture.scaled(by),
                    (Texture::Constant(by), texture) => texture.scaled(by),
                    (texture, _) => {
                        instead("the first of two pictures is used");
                        texture
                    }
                }
            }
            "mix" | "directionmix" => {
                let (first, second) = (of("tex1", 0.0), of("tex2", 1.0));
                let amount = self.texture_value(&params, "amount", false, Vec3::splat(0.5)).constant().map(|c| c.x);
                params.mark_known(&["dir"]);
                let share = amount.unwrap_or_else(|| {
                    instead("an `amount` of 0.5 is used in place of a picture");
                    0.5
                });
                let mixed = || self.combine([&first, &second], at, |a, b| a.lerp(b, share));
                both(&first, &second, share).or_else(mixed).unwrap_or_else(|| {
                    instead("the first of two pictures with different mappings is used");
                    if first.constant().is_some() { second } else { first }
                })
            }
            "imagemap" => self.imagemap(&params, is_color).unwrap_or(Texture::Constant(Vec3::splat(0.5))),
            "checkerboard" => {
                let (odd, even) = (of("tex2", 0.0), of("tex1", 1.0));
                match (even.constant(), odd.constant(), params.integer("dimension").unwrap_or(2)) {
                    (Some(a), Some(b), 2) => self.checkerboard(a, b, &params),
                    _ => {
                        instead("the mean of its two textures is used");
                        both(&even, &odd, 0.5).unwrap_or(even)
                    }
                }
            }
            "bilerp" => {
                let corners = [of("v00", 0.0), of("v01", 1.0), of("v10", 0.0), of("v11", 1.0)];
                match corners.each_ref().map(Texture::constant) {
                    [Some(a), Some(b), Some(c), Some(d)] => self.corners([a, b, c, d], &params),
                    all => {
                        instead("the mean of its four corners is used");
                        Texture::Constant(all.into_iter().flatten().sum::<Color>() / 4.0)
                    }
                }
            }
            "dots" => {
                instead("`outside` is used");
                params.mark_known(&["inside"]);
                of("outside", 0.0)
            }
            "fbm" | "wrinkled" | "windy" | "marble" | "ptex" => {
                instead("0.5 is used");
                params.mark_known(&["octaves", "roughness", "scale", "variation", "filename", "encoding"]);
                Texture::Constant(Vec3::splat(0.5))
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
                return self.report.error_with_help(at, format!("unknown texture `{other}`"), suggest(other, known));
            }
        };
        if third {
            params.mark_known(&["aamode", "dimension"]);
        }
        params.mark_known(&["mapping", "uscale", "vscale", "udelta", "vdelta", "v1", "v2"]);
        params.warn_unused("this texture");
        self.textures.insert((is_color, name), value);
    }

    /// Returns the value of a parameter that may be a texture, or `default` if the parameter is
    /// missing.
    pub fn texture_value(&self, params: &Params, name: &'static str, is_color: bool, default: Color) -> Texture {
        let Some(param) = params.get(name) else { return Texture::Constant(default) };
        if param.kind == Kind::Texture {
            if let Some(texture) = self.textures.get(&(is_color, param.text().to_string())) {
                return texture.clone();
            }
            let known = self.textures.keys().filter(|key| key.0 == is_color).map(|key| key.1.as_str());
            let what = if is_color { "spectrum" } else { "float" };
            let message = format!("unknown texture `{}` of type `{what}`", param.text());
            self.report.error_with_help(param.values_at, message, suggest(param.text(), known));
            return Texture::Constant(default);
        }
        Texture::Constant(match is_color {
            true => params.spectrum(name).map_or(default, |spectrum| spectrum.albedo()),
            false => params.float(name).map_or(default, Vec3::splat),
        })
    }

    /// Returns a float parameter that may be a texture. For a picture, returns its mean.
    pub fn value(&self, params: &Params, name: &'static str, default: f32) -> f32 {
        match self.texture_value(params, name, false, Vec3::splat(default)) {
            Texture::Constant(color) => color.x,
            Texture::Picture(picture, scale) => {
                self.mean_of(params, name, &picture).map_or(default, |mean| mean * scale.x)
            }
        }
    }

    /// Returns the mean of a picture, for a parameter that must be a single number in Dürer.
    pub fn mean_of(&self, params: &Params, name: &'static str, picture: &TextureImage) -> Option<f32> {
        let at = params.span(name);
        self.report.unsupported_once(at, format!("a picture for `{name}` has no counterpart: its mean is used"));
        self.pictures().mean(picture, at)
    }

    /// Returns the picture of a parameter after applying `change` to its values, or `None` if the
    /// parameter is not a picture.
    pub fn mapped_picture(
        &mut self,
        params: &Params,
        name: &'static str,
        is_color: bool,
        change: impl Fn(f32) -> f32,
    ) -> Option<FileName> {
        let Texture::Picture(picture, scale) = self.texture_value(params, name, is_color, Vec3::ZERO) else {
            return None;
        };
        let at = params.span(name);
        let mean = |p: Color| (p.x + p.y + p.z) / 3.0;
        let picture = self.pictures().changed(&picture, at, decode_srgb, |p| change(scale.x * mean(p)))?;
        Some(self.asset(picture, at))
    }

    /// Returns a float parameter that may be a picture. `change` is applied to the value. For a
    /// picture, `change` is applied to the picture and the value is 1.
    pub fn number_or_texture(
        &mut self,
        params: &Params,
        name: &'static str,
        default: f32,
        change: impl Fn(f32) -> f32,
    ) -> (f32, Option<FileName>) {
        match self.mapped_picture(params, name, false, &change) {
            Some(picture) => (1.0, Some(picture)),
            None => (change(self.value(params, name, default)), None),
        }
    }

    /// Returns a colour parameter that may be a picture. For a picture, returns a factor and the
    /// name of the picture.
    pub fn color_or_texture(&mut self, params: &Params, name: &'static str, default: f32) -> (Color, Option<FileName>) {
        match self.texture_value(params, name, true, Vec3::splat(default)) {
            Texture::Constant(color) => (color, None),
            Texture::Picture(picture, scale) => (scale, Some(self.asset(picture, params.span(name)))),
        }
    }

    /// Adds a picture to the scene and returns its name.
    pub fn asset(&mut self, picture: TextureImage, span: Span) -> FileName {
        pictures::asset(&mut self.scene, picture, span)
    }

    fn pictures(&self) -> Pictures<'_> {
        Pictures { input: self.input, report: self.report }
    }

    /// Returns a file as a picture with 8 bits per channel, after converting it if it has another
    /// format.
    pub fn eight_bits(&self, name: &str, at: Span) -> Option<PictureBytes> {
        self.pictures().eight_bits(name, at)
    }

    fn imagemap(&self, params: &Params, is_color: bool) -> Option<Texture> {
        let Some(name) = params.text("filename") else {
            self.report.error(params.at, "an `imagemap` needs a `filename`");
            return None;
        };
        let at = params.get("filename").map_or(params.at, |param| param.values_at);
        let mut mapping = self.mapping(params);
        match params.text("wrap").unwrap_or("repeat") {
            "repeat" => {}
            "clamp" => mapping.wrap = [Wrap::Clamp; 2],
            "black" => {
                self.report
                    .unsupported_once(params.span("wrap"), "the wrap mode `black` has no counterpart: `clamp` is used");
                mapping.wrap = [Wrap::Clamp; 2];
            }
            other => {
                let help = suggest(other, ["repeat", "clamp", "black"]);
                self.report.error_with_help(params.span("wrap"), format!("unknown wrap mode `{other}`"), help);
            }
        }
        mapping.nearest = params.text("filter") == Some("point");
        mapping.mipmaps = matches!(params.text("filter"), Some("trilinear" | "ewa" | "EWA"));
        if self.language == Language::V3 {
            // Ignore pbrt-v3's mipmap settings, because sampling does not need mipmaps.
            params.mark_known(&["trilinear", "maxanisotropy"]);
            let scale = Vec3::splat(params.float("scale").unwrap_or(1.0));
            let plain = params.boolean("gamma") == Some(false);
            let bytes = self.eight_bits(name, at)?;
            let picture = TextureImage { bytes, mapping };
            let curved = if plain { self.pictures().reencoded(&picture, at, true, |x| x) } else { None };
            return Some(Texture::Picture(curved.unwrap_or(picture), scale));
        }
        let gamma = self.encoding(params);
        let inverted = params.boolean("invert") == Some(true);
        params.mark_known(&["maxanisotropy", "trilinear"]);
        let scale = Vec3::splat(params.float("scale").unwrap_or(1.0));
        let picture = TextureImage { bytes: self.eight_bits(name, at)?, mapping };
        if gamma.is_none() && !inverted {
            return Some(Texture::Picture(picture, scale));
        }
        let decode = |x: f32| {
            let decoded = gamma.map_or_else(|| linear_from_srgb(x), |gamma| fp::pow(x, gamma));
            if inverted { (1.0 - decoded).max(0.0) } else { decoded }
        };
        let recoded = self.pictures().reencoded(&picture, at, is_color, decode);
        Some(Texture::Picture(recoded.unwrap_or(picture), scale))
    }

    /// Returns the exponent that converts the picture's values to linear values, or `None` for the
    /// sRGB curve.
    fn encoding(&self, params: &Params) -> Option<f32> {
        let text = params.text("encoding").filter(|encoding| *encoding != "sRGB")?;
        if text == "linear" {
            return Some(1.0);
        }
        let words: Vec<&str> = text.split_whitespace().collect();
        let gamma = if let ["gamma", x] = words[..] { x.parse::<f32>().ok().filter(|x| *x > 0.0) } else { None };
        if gamma.is_none() {
            let message = format!("unknown encoding `{text}`: use `sRGB`, `linear`, or `gamma` with a number");
            self.report.error(params.span("encoding"), message);
        }
        gamma
    }

    fn mapping(&self, params: &Params) -> Mapping {
        if let Some(other) = params.text("mapping").filter(|mapping| *mapping != "uv") {
            let what = format!("the mapping `{other}` has no counterpart: the surface's uv coordinates are used");
            self.report.unsupported_once(params.span("mapping"), what);
        }
        let number = |name: &'static str, default: f32| params.float(name).unwrap_or(default);
        let (su, sv) = (number("uscale", 1.0), number("vscale", 1.0));
        let (du, dv) = (number("udelta", 0.0), number("vdelta", 0.0));
        // In pbrt and in Dürer, v increases upwards, but the rows of a picture are stored from top
        // to bottom.
        Mapping { transform: [[su, 0.0, du], [0.0, sv, 1.0 - sv - dv]], ..Mapping::default() }
    }

    /// Interpolates bilinearly between the values at (u, v) = (0, 0), (0, 1), (1, 0) and (1, 1).
    /// Returns the result as a picture of 2 x 2 texels.
    fn corners(&self, [v00, v01, v10, v11]: [Color; 4], params: &Params) -> Texture {
        let mut mapping = self.mapping(params);
        // Map [0, 1] to the range between the texel centres. The rows are stored from top to
        // bottom.
        let [[su, _, du], [_, sv, dv]] = mapping.transform;
        mapping.transform = [[0.5 * su, 0.0, 0.25 + 0.5 * du], [0.0, 0.5 * sv, 0.25 + 0.5 * dv]];
        mapping.wrap = [Wrap::Clamp; 2];
        match pictures::from_four_texels([v01, v11, v00, v10]) {
            Some((bytes, most)) => Texture::Picture(TextureImage { bytes, mapping }, Vec3::splat(most)),
            None => Texture::Constant(0.25 * (v00 + v01 + v10 + v11)),
        }
    }

    /// Combines two textures texel by texel. Returns `None` if their pictures have different
    /// mappings.
    fn combine(&self, textures: [&Texture; 2], at: Span, join: impl Fn(Color, Color) -> Color) -> Option<Texture> {
        let pictures = self.pictures();
        let (picture, most) = match textures {
            [Texture::Picture(a, by), Texture::Constant(b)] => pictures.joined([a, a], at, |a, _| join(*by * a, *b)),
            [Texture::Constant(a), Texture::Picture(b, by)] => pictures.joined([b, b], at, |b, _| join(*a, *by * b)),
            [Texture::Picture(a, by), Texture::Picture(b, other)] => {
                pictures.joined([a, b], at, |a, b| join(*by * a, *other * b))
            }
            _ => None,
        }?;
        Some(Texture::Picture(picture, Vec3::splat(most)))
    }

    /// Returns a checkerboard as a picture of 2 x 2 texels.
    fn checkerboard(&self, even: Color, odd: Color, params: &Params) -> Texture {
        let mut mapping = self.mapping(params);
        // Each texel covers one unit of u and one unit of v. The origin is the lower left corner of
        // an even texel.
        let [[su, _, du], [_, sv, _]] = mapping.transform;
        let dv = params.float("vdelta").unwrap_or(0.0);
        mapping.transform = [[0.5 * su, 0.0, 0.5 * du], [0.0, 0.5 * sv, 1.0 - 0.5 * sv - 0.5 * dv]];
        mapping.nearest = true;
        match pictures::checkerboard(odd, even) {
            Some((bytes, most)) => Texture::Picture(TextureImage { bytes, mapping }, Vec3::splat(most)),
            None => Texture::Constant(0.5 * (even + odd)),
        }
    }
}
