//! Reads textures, each of which becomes a constant or a picture.

use super::plugin::{Plugin, Property};
use super::state::Reader;
use crate::pictures::{asset, checkerboard};
use crate::shared_report::NO_COUNTERPART;
use crate::shared_report::suggest;
use durer_diag::Span;
use durer_image::{decode_linear, decode_srgb};
use durer_scene::describe::FileName;
use durer_scene::math::{Color, LUMINANCE, Vec3};
use durer_scene::scene::{PictureBytes, TextureImage};
use durer_scene::texture::{Mapping, Wrap};
use glam::DAffine3;

/// Number of texels that replace a texel along each side, if their values are to be changed by a
/// curved function. The error of linear interpolation falls with its square.
const REFINEMENT: u32 = 8;

/// Value of a Mitsuba texture plugin, which is a constant colour or a picture.
#[derive(Clone)]
pub(super) enum Texture {
    Constant(Color),
    /// Picture, the factor that multiplies its values, and a flag that is true if its bytes are
    /// linear (`raw`).
    Picture(TextureImage, Color, bool),
}

/// Returns true if a picture is a file with integer values. Other pictures have been converted, and
/// are in sRGB encoding even if they are `raw`.
pub(super) fn is_file(picture: &TextureImage) -> bool {
    matches!(picture.bytes, PictureBytes::File(_))
}

impl Reader<'_> {
    /// Returns the value of a property that may be a texture, or `default` if the property is
    /// missing.
    pub fn texture(&self, plugin: &Plugin, name: &'static str, default: Color) -> Texture {
        plugin.get(name).map_or(Texture::Constant(default), |property| self.texture_of(property, default))
    }

    /// Returns the value of a property that may be a picture with values above 1. Pictures with
    /// values above 1 are divided by their maximum. See [`Reader::texture`].
    pub fn bright_texture(&self, plugin: &Plugin, name: &'static str, default: Color) -> Texture {
        let bitmap = self.named_plugin(plugin, name).filter(|part| part.kind == "bitmap");
        let Some(bitmap) = bitmap else { return self.texture(plugin, name, default) };
        let raw = bitmap.boolean(self.report, "raw").unwrap_or(false);
        let picture = self.bitmap_as(&bitmap, |name, at| self.pictures().own_depth(name, true, at));
        bitmap.warn_unused(self.report);
        picture
            .map_or(Texture::Constant(default), |(picture, scale)| Texture::Picture(picture, Vec3::splat(scale), raw))
    }

    /// Returns the picture in sRGB encoding, after converting it if its bytes are linear (`raw`).
    pub fn srgb_encoded(&self, picture: TextureImage, raw: bool, at: Span) -> TextureImage {
        if raw { self.pictures().reencoded(&picture, at, true, |x| x).unwrap_or(picture) } else { picture }
    }

    fn texture_of(&self, property: &Property, default: Color) -> Texture {
        if let Some(color) = self.reflectance(property) {
            return Texture::Constant(color);
        }
        let Some(texture) = self.child_plugin(property) else {
            if !matches!(property.value, super::plugin::Value::Ref(_)) {
                self.report.error(property.at, format!("`{}` must be a colour or a texture", property.name));
            }
            return Texture::Constant(default);
        };
        let value = match texture.kind.as_str() {
            "bitmap" => {
                let raw = texture.boolean(self.report, "raw").unwrap_or(false);
                self.bitmap(&texture).map(|picture| Texture::Picture(picture, Vec3::ONE, raw))
            }
            "checkerboard" => Some(self.checkerboard(&texture, [("color0", 0.4), ("color1", 0.2)])),
            // Vertex colours multiply the material's colour.
            "mesh_attribute" if texture.text(self.report, "name").is_some_and(|name| name == "vertex_color") => {
                Some(Texture::Constant(Vec3::splat(texture.number(self.report, "scale").unwrap_or(1.0))))
            }
            other => {
                let message = format!("the texture `{other}` has no counterpart: the default value is used");
                let known = ["bitmap", "checkerboard", "mesh_attribute"];
                let known = known.into_iter().filter(|word| *word != other);
                let warning = durer_diag::Diagnostic::warning(message).code(NO_COUNTERPART).at(texture.at);
                self.report.push(durer_diag::Diagnostic { help: suggest(other, known), ..warning });
                return Texture::Constant(default);
            }
        };
        texture.warn_unused(self.report);
        value.unwrap_or(Texture::Constant(default))
    }

    /// Returns the colour of a property and the picture that the colour multiplies.
    pub fn color_or_texture(&mut self, plugin: &Plugin, name: &'static str, default: f32) -> (Color, Option<FileName>) {
        match self.texture(plugin, name, Vec3::splat(default)) {
            Texture::Constant(color) => {
                if color.min_element() < 0.0 {
                    self.report.unsupported_once(
                        plugin.span(name),
                        format!("a negative `{name}` has no counterpart: 0 is used"),
                    );
                }
                (color.max(Vec3::ZERO), None)
            }
            Texture::Picture(picture, scale, raw) => {
                let picture = self.srgb_encoded(picture, raw, plugin.span(name));
                (scale, Some(asset(&mut self.scene, picture, plugin.span(name))))
            }
        }
    }

    /// Returns a number that may be a texture. `change` is applied to the number. For a picture,
    /// `change` is applied to the picture and the number is 1.
    pub fn number_or_texture(
        &mut self,
        plugin: &Plugin,
        name: &'static str,
        default: f32,
        change: impl Fn(f32) -> f32,
    ) -> (f32, Option<FileName>) {
        match plugin.get(name).and_then(|property| self.number_texture(property, &change)) {
            Some(picture) => (1.0, Some(picture)),
            None => (change(self.value(plugin, name, default)), None),
        }
    }

    /// Returns the square root of a number that may be a texture, from 0 to 1. Where texels are
    /// interpolated, the root is that of the interpolated values.
    pub fn root_or_texture(&mut self, plugin: &Plugin, name: &'static str, default: f32) -> (f32, Option<FileName>) {
        let root = |x: f32| x.clamp(0.0, 1.0).sqrt();
        match plugin.get(name).and_then(|property| self.changed_texture(property, root, REFINEMENT)) {
            Some(picture) => (1.0, Some(picture)),
            None => (root(self.value(plugin, name, default)), None),
        }
    }

    /// Returns the picture of a property after applying `change` to its luminance, or `None` if the
    /// property is not a picture.
    pub fn number_texture(&mut self, property: &Property, change: impl Fn(f32) -> f32) -> Option<FileName> {
        self.changed_texture(property, change, 1)
    }

    /// Version of [`Reader::number_texture`] that first replaces each texel by a square of `finer`
    /// by `finer` interpolated ones.
    fn changed_texture(&mut self, property: &Property, change: impl Fn(f32) -> f32, finer: u32) -> Option<FileName> {
        let fields =
            self.child_plugin(property).filter(|part| part.element == "texture" && part.kind == "checkerboard");
        let texture = match fields {
            // Mitsuba swaps the two colours of a checkerboard when it is used as a number.
            Some(fields) => {
                let value = self.checkerboard(&fields, [("color1", 0.2), ("color0", 0.4)]);
                fields.warn_unused(self.report);
                value
            }
            None => self.texture_of(property, Vec3::ZERO),
        };
        let Texture::Picture(picture, scale, raw) = texture else { return None };
        let decode = if raw && is_file(&picture) { decode_linear } else { decode_srgb };
        // The luminance of a colour is used where a number is expected.
        let number = |p: Color| Color::splat(change(scale.x * p.dot(LUMINANCE)));
        let picture = self.pictures().refined(&picture, property.at, decode, finer, number)?;
        Some(asset(&mut self.scene, picture, property.at))
    }

    /// Returns a number that may be a texture. For a picture, returns its mean.
    pub fn value(&self, plugin: &Plugin, name: &'static str, default: f32) -> f32 {
        let color = self.color(plugin, name, Vec3::splat(default));
        color.dot(LUMINANCE)
    }

    /// Returns a colour that may be a texture. For a picture, returns its mean.
    pub fn color(&self, plugin: &Plugin, name: &'static str, default: Color) -> Color {
        match self.texture(plugin, name, default) {
            Texture::Constant(color) => color,
            Texture::Picture(picture, scale, _) => {
                let at = plugin.span(name);
                self.report
                    .unsupported_once(at, format!("a picture for `{name}` has no counterpart: its mean is used"));
                self.pictures().mean(&picture, at).map_or(default, |mean| mean * scale)
            }
        }
    }

    /// Reads the picture of a `bitmap` texture.
    pub fn bitmap(&self, texture: &Plugin) -> Option<TextureImage> {
        self.bitmap_as(texture, |name, at| self.pictures().own_depth(name, false, at)).map(|(picture, _)| picture)
    }

    /// Reads the picture of a `bitmap` texture and the factor that multiplies it. The function
    /// `make` reads the file.
    fn bitmap_as(
        &self,
        texture: &Plugin,
        make: impl FnOnce(&str, Span) -> Option<(PictureBytes, f32)>,
    ) -> Option<(TextureImage, f32)> {
        let report = self.report;
        let Some(name) = texture.text(report, "filename") else {
            report.error(texture.at, "a `bitmap` needs a `filename`");
            return None;
        };
        let mut mapping = self.mapping(texture);
        let word = |name, default: &str| texture.text(report, name).unwrap_or(default.into());
        mapping.wrap = match word("wrap_mode", "repeat").as_str() {
            "repeat" => [Wrap::Repeat; 2],
            "mirror" => [Wrap::Mirror; 2],
            "clamp" => [Wrap::Clamp; 2],
            other => {
                let help = suggest(other, ["repeat", "mirror", "clamp"]);
                report.error_with_help(texture.span("wrap_mode"), format!("unknown wrap mode `{other}`"), help);
                return None;
            }
        };
        mapping.nearest = match word("filter_type", "bilinear").as_str() {
            // The last two filters are from Mitsuba 0.6.
            "bilinear" | "ewa" | "trilinear" => false,
            "nearest" => true,
            other => {
                let help = suggest(other, ["bilinear", "nearest"]);
                report.error_with_help(texture.span("filter_type"), format!("unknown filter `{other}`"), help);
                return None;
            }
        };
        texture.mark_known(&["raw", "accel", "format"]);
        // In Mitsuba, the alpha channel of a picture does not make the surface transparent. Only
        // `mask` makes a surface transparent.
        mapping.cutoff = Some(0.0);
        let (bytes, scale) = make(&self.loader.path(&name), texture.span("filename"))?;
        Some((TextureImage { bytes, mapping }, scale))
    }

    /// Reads the mapping from texture coordinates to a texture. In Mitsuba, v increases downwards
    /// from the upper edge, as in Dürer's pictures.
    fn mapping(&self, texture: &Plugin) -> Mapping {
        let report = self.report;
        let mut transform = texture.transform(report, "to_uv");
        let old = |name, default: f32| f64::from(texture.number(report, name).unwrap_or(default));
        // These parameters are from Mitsuba 0.6.
        let scale = glam::DVec3::new(old("uscale", 1.0), old("vscale", 1.0), 1.0);
        transform *= DAffine3::from_scale(scale);
        transform.translation += glam::DVec3::new(old("uoffset", 0.0), old("voffset", 0.0), 0.0);
        let [x, y, t] =
            [transform.matrix3.x_axis, transform.matrix3.y_axis, transform.translation].map(|v| v.as_vec3());
        Mapping { transform: [[x.x, y.x, t.x], [x.y, y.y, t.y]], ..Mapping::default() }
    }

    /// Returns a checkerboard whose squares are half a unit wide, as a picture of 2 x 2 texels. The
    /// first square is at the origin.
    fn checkerboard(&self, texture: &Plugin, fields: [(&'static str, f32); 2]) -> Texture {
        let mapping = Mapping { nearest: true, ..self.mapping(texture) };
        let [one, other] = fields.map(|(name, default)| {
            let field = self.texture(texture, name, Vec3::splat(default));
            if matches!(field, Texture::Picture(..)) {
                let at: Span = texture.span(name);
                self.report.unsupported_once(
                    at,
                    "a picture in a field of a `checkerboard` has no counterpart: the default colour is used",
                );
            }
            match field {
                Texture::Constant(color) => color,
                Texture::Picture(..) => Vec3::splat(default),
            }
        });
        match checkerboard(one, other) {
            Some((bytes, most)) => Texture::Picture(TextureImage { bytes, mapping }, Vec3::splat(most), false),
            None => Texture::Constant(0.5 * (one + other)),
        }
    }
}
