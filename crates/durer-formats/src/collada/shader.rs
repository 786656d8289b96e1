//! Parameters of effects: colours, numbers and textures.

use super::document::Element;
use super::reader::Reader;
use crate::files::percent_decoded;
use crate::pictures::asset;
use durer_diag::{Diagnostic, Span};
use durer_scene::describe::FileName;
use durer_scene::math::Vec3;
use durer_scene::scene::{PictureBytes, TextureImage};
use durer_scene::texture::{Mapping, Wrap};

/// Maximum number of references between a parameter and its value.
const MAX_REFERENCES: u32 = 16;

/// Value of a colour parameter.
pub(super) enum Value<'r> {
    Color(Vec3, f32),
    Texture(&'r Element<'r>),
}

/// Profile of an effect with its technique, in which parameters are looked up.
#[derive(Clone, Copy)]
pub(super) struct Effect<'r> {
    pub effect: &'r Element<'r>,
    pub profile: &'r Element<'r>,
    pub technique: &'r Element<'r>,
}

/// Converts a colour from sRGB to linear values unless it is linear. Components above 1 stay.
pub(super) fn linear(color: Vec3, is_linear: bool) -> Vec3 {
    if is_linear {
        return color;
    }
    color.map(|x| if x > 1.0 { x } else { durer_image::linear_from_srgb(x) })
}

impl<'r> Effect<'r> {
    /// Returns the parameter with a sid.
    fn parameter(&self, sid: &str) -> Option<&'r Element<'r>> {
        let places = [self.technique, self.profile, self.effect];
        places.into_iter().find_map(|place| place.all("newparam").find(|param| param.get("sid") == Some(sid)))
    }
}

impl<'r> Reader<'r> {
    /// Returns the value of a colour parameter of a shader.
    pub fn value(&self, effect: Effect<'r>, shader: &'r Element<'r>, name: &str) -> Option<Value<'r>> {
        let mut element = shader.child(name)?;
        for _ in 0..MAX_REFERENCES {
            if let Some(texture) = element.child("texture") {
                return Some(Value::Texture(texture));
            }
            if let Some(reference) = element.child("param") {
                element = effect.parameter(reference.get("ref").unwrap_or(reference.text()))?;
                continue;
            }
            let color = ["color", "float4", "float3"].into_iter().find_map(|name| element.child(name))?;
            let numbers = color.numbers(self.report, self.limits);
            let rgb = Vec3::from_array(*numbers.first_chunk::<3>()?);
            let alpha = numbers.get(3).copied().filter(|alpha| alpha.is_finite()).unwrap_or(1.0);
            return rgb.is_finite().then(|| Value::Color(rgb.max(Vec3::ZERO), alpha));
        }
        None
    }

    /// Returns the value of a number parameter of a shader.
    pub fn shader_number(&self, effect: Effect<'r>, shader: &'r Element<'r>, name: &str) -> Option<f32> {
        let mut element = shader.child(name)?;
        for _ in 0..MAX_REFERENCES {
            if let Some(number) = element.child("float") {
                return number.number(self.report, self.limits).map(|number| number as f32);
            }
            let reference = element.child("param")?;
            element = effect.parameter(reference.get("ref").unwrap_or(reference.text()))?;
        }
        None
    }

    /// Returns the picture of a texture with its mapping. `set` finds the position of the texture
    /// coordinates by their name.
    pub fn picture(
        &mut self,
        effect: Effect<'r>,
        texture: &'r Element<'r>,
        set: &dyn Fn(&str) -> Option<usize>,
        change: impl FnOnce(&mut Mapping),
    ) -> Option<FileName> {
        let (report, at) = (self.report, texture.at);
        let name = texture.get("texture").unwrap_or_default();
        let sampler = effect.parameter(name).and_then(|param| param.child("sampler2D"));
        let image = match sampler {
            Some(sampler) => self.image_of_sampler(effect, sampler),
            // Some programs name the image itself.
            None => self.ids.get(name).copied().filter(|image| image.name == "image"),
        };
        let Some(image) = image else {
            let message = format!("the texture `{name}` has no picture: it is left out");
            report.warn_once("missing-file", texture.span_of("texture"), message);
            return None;
        };
        let path = self.path(image)?;
        let mut mapping = Mapping::default();
        if let Some(sampler) = sampler {
            mapping.wrap = ["wrap_s", "wrap_t"].map(|name| match sampler.child(name).map(Element::text) {
                Some("MIRROR") => Wrap::Mirror,
                Some("CLAMP" | "BORDER" | "NONE") => Wrap::Clamp,
                _ => Wrap::Repeat,
            });
            mapping.nearest = sampler.child("magfilter").is_some_and(|filter| filter.text() == "NEAREST");
            mapping.mipmaps = sampler.child("minfilter").is_some_and(|filter| filter.text().contains("MIPMAP"));
        }
        self.place_uvs(texture, &mut mapping);
        match set(texture.get("texcoord").unwrap_or_default()) {
            Some(position @ (0 | 1)) => mapping.second = position == 1,
            _ => report.unsupported_once(at, "only two sets of texture coordinates are used: the first is taken"),
        }
        change(&mut mapping);
        let picture = TextureImage { bytes: PictureBytes::File(path), mapping };
        Some(asset(&mut self.scene, picture, at))
    }

    /// Sets the repetition and the offset of a picture, as Maya and 3ds Max write them.
    fn place_uvs(&self, texture: &'r Element<'r>, mapping: &mut Mapping) {
        let techniques = texture.child("extra").into_iter().flat_map(|extra| extra.all("technique"));
        let Some(technique) = techniques.into_iter().find(|technique| technique.child("repeatU").is_some()) else {
            return;
        };
        let number = |name: &str, default: f32| self.number(technique, name).map_or(default, |number| number as f32);
        let [u, v] = [number("repeatU", 1.0), number("repeatV", 1.0)];
        let [x, y] = [number("offsetU", 0.0), number("offsetV", 0.0)];
        // The coordinate v of the mapping points downwards.
        mapping.transform = [[u, 0.0, x], [0.0, v, 1.0 - v - y]];
    }

    /// Returns the image that a sampler shows.
    fn image_of_sampler(&self, effect: Effect<'r>, sampler: &'r Element<'r>) -> Option<&'r Element<'r>> {
        let id = match sampler.child("instance_image") {
            Some(instance) => instance.get("url")?.strip_prefix('#')?,
            None => {
                let surface = effect.parameter(sampler.child("source")?.text())?.child("surface")?;
                surface.child("init_from").or_else(|| surface.child("init_as")).map_or("", Element::text)
            }
        };
        self.ids.get(id).copied().filter(|image| image.name == "image")
    }

    /// Returns the path of the file of an image, and warns if there is none.
    fn path(&self, image: &'r Element<'r>) -> Option<String> {
        let Some(from) = image.child("init_from") else {
            self.report.unsupported_once(image.at, "pictures inside the file have no counterpart: they are left out");
            return None;
        };
        let from = from.child("ref").unwrap_or(from);
        let at: Span = from.text_span();
        let uri = from.text();
        let decoded = percent_decoded(uri).unwrap_or_else(|| uri.to_string()).replace('\\', "/");
        let plain = decoded.strip_prefix("file://").unwrap_or(&decoded);
        let plain = plain.strip_prefix("./").unwrap_or(plain);
        let last = plain.rsplit('/').next().unwrap_or_default();
        // Many files name the place on the disk of their author.
        let found = [plain, uri, last].into_iter().find(|name| !name.is_empty() && self.input.source.contains(name));
        if found.is_none() {
            let message = format!("the picture `{uri}` was not found: the texture is left out");
            self.report.push(Diagnostic::warning(message).code("missing-file").at(at));
        }
        found.map(str::to_string)
    }
}
