//! Loading of material textures. Each picture is decoded only once, even if several textures use
//! it.

use super::cache::AssetKey;
use super::decoded::{Encoding, decode};
use super::files::{Loader, PictureKey};
use crate::world::{MaterialTextures, ParameterTexture};
use durer_diag::Diagnostics;
use durer_image::Encoded;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::parameters::{TEXTURE_FIELDS, TextureEffect, TextureField};
use durer_scene::scene::PictureBytes;
use durer_scene::source::Digest;
use durer_scene::texture::{Channel, Mapping, Texture};
use rayon::prelude::*;
use std::collections::HashSet;

impl Loader<'_> {
    /// Returns the index of a principled material's texture. The picture is an asset or a file. A
    /// picture from a file repeats over the surface.
    fn map(&mut self, name: &FileName, encoding: Encoding, diagnostics: &mut Diagnostics) -> Option<u32> {
        let key = (name.path.clone(), encoding);
        if let Some(known) = self.map_numbers.get(&key) {
            return *known;
        }
        let (bytes, mapping) = self.locate(name);
        let texture = match mapping.mipmaps {
            true => self.mipmapped(name, bytes, encoding, diagnostics),
            false => self.picture(name, bytes, encoding, diagnostics),
        };
        let number = texture.map(|texture| {
            self.textures.push(texture.with_mapping(mapping));
            (self.textures.len() - 1) as u32
        });
        self.map_numbers.insert(key, number);
        number
    }

    /// Returns the index of a texture that contains numbers instead of colours.
    pub(super) fn number_map(&mut self, name: &FileName, diagnostics: &mut Diagnostics) -> Option<u32> {
        self.map(name, Encoding::Linear, diagnostics)
    }

    /// Returns the location of a picture's data and the mapping of the picture to a surface.
    fn locate(&self, name: &FileName) -> (PictureBytes, Mapping) {
        if let Some(asset) = self.assets.pictures.get(&name.path) {
            return (asset.bytes.clone(), asset.mapping);
        }
        let word = name.path.rsplit_once(':').and_then(|(path, word)| Some((path, Channel::from_word(word)?)));
        let mapping = Mapping { channel: word.map(|(_, channel)| channel), ..Mapping::default() };
        (PictureBytes::File(word.map_or(name.path.as_str(), |(path, _)| path).into()), mapping)
    }

    /// Decodes the pictures of materials in parallel, as long as they fit into memory together.
    /// Pictures that cannot be decoded are skipped here, and their errors are reported when they
    /// are used.
    pub(super) fn decode_ahead<'m>(&mut self, materials: impl Iterator<Item = &'m PrincipledMaterial>) {
        let mut left = self.resources.memory;
        let (mut packed, mut seen) = (Vec::new(), HashSet::new());
        for (name, encoding) in materials.flat_map(pictures) {
            let (bytes, _) = self.locate(name);
            let key: PictureKey = (bytes.path().into(), encoding);
            // Several materials can share a picture.
            if !seen.insert(key.clone()) {
                continue;
            }
            let origin = self.picture_origin(&bytes);
            if origin.and_then(|origin| self.resources.cache?.picture(&origin, encoding)).is_some() {
                continue;
            }
            let bytes = match bytes {
                PictureBytes::Memory(_, bytes) => Some(bytes),
                PictureBytes::File(path) => self.resources.source.read(&path).ok(),
            };
            let Some(bytes) = bytes else { continue };
            let needed = Encoded::open(&bytes, &key.0).map_or(0, |encoded| encoded.memory_needed_raster());
            let Some(rest) = left.checked_sub(needed) else { break };
            left = rest;
            packed.push((key, bytes));
        }
        if packed.len() < 2 {
            return;
        }
        let memory = self.resources.memory;
        let decoded = packed.into_par_iter().filter_map(|(key, bytes)| {
            let name = FileName { path: key.0.clone(), span: Default::default() };
            let texture = decode(&name, &key.0, &bytes, key.1 == Encoding::Srgb, memory, &mut Diagnostics::default())?;
            Some((key, texture))
        });
        self.predecoded = decoded.collect();
    }

    /// Returns the textures of a principled material. If a texture has an error, the error is
    /// reported and the texture is omitted.
    pub(super) fn maps(&mut self, layers: &PrincipledMaterial, diagnostics: &mut Diagnostics) -> MaterialTextures {
        let mut one = |name: Option<&FileName>, encoding| name.and_then(|name| self.map(name, encoding, diagnostics));
        let mut maps = MaterialTextures {
            base_color: one(layers.base_color_texture.as_ref(), Encoding::Srgb),
            emission: one(layers.emission_texture.as_ref(), Encoding::Srgb),
            opacity: one(layers.opacity_texture.as_ref(), Encoding::Linear),
            normal: one(layers.normal_texture.as_ref(), Encoding::Linear),
            green: layers.normal_green,
            bump: one(layers.bump_texture.as_ref(), Encoding::Linear),
            bump_height: layers.bump_height,
            bump_gradient: layers.bump_gradient,
            parameters: Vec::new(),
        };
        for (row, textured) in TEXTURE_FIELDS.iter().enumerate() {
            if let Some(texture) = one((textured.texture_file)(layers), encoding_of(textured)) {
                maps.parameters.push(ParameterTexture { row, texture, channel: None });
            }
        }
        if let Some(texture) = one(layers.metallic_roughness_texture.as_ref(), Encoding::Linear) {
            for (row, textured) in TEXTURE_FIELDS.iter().enumerate() {
                let channel = match textured.field {
                    "specular_roughness_texture" => Channel::Green,
                    "base_metalness_texture" => Channel::Blue,
                    _ => continue,
                };
                maps.parameters.push(ParameterTexture { row, texture, channel: Some(channel) });
            }
        }
        maps
    }

    /// Returns a decoded picture. All textures that use the picture share the decoded data.
    pub(super) fn picture(
        &mut self,
        name: &FileName,
        bytes: PictureBytes,
        encoding: Encoding,
        diagnostics: &mut Diagnostics,
    ) -> Option<Texture> {
        let path = bytes.path().to_string();
        let key = (path.clone(), encoding);
        if let Some(known) = self.decoded.get(&key) {
            return known.clone();
        }
        let origin = self.picture_origin(&bytes);
        if let Some(known) = origin.as_ref().and_then(|origin| self.resources.cache?.picture(origin, encoding)) {
            self.remember(&path, origin.as_ref(), known.digest);
            let texture = Some(known.value).filter(|texture| self.charge(name, texture.bytes() as u64, diagnostics));
            self.decoded.insert(key, texture.clone());
            return texture;
        }
        let texture = match self.predecoded.remove(&key) {
            Some(texture) => Some(texture),
            None => {
                let bytes = match bytes {
                    PictureBytes::Memory(_, bytes) => Some(bytes),
                    PictureBytes::File(path) => self.read(&FileName { path, span: name.span }, "texture", diagnostics),
                };
                let (srgb, memory) = (encoding == Encoding::Srgb, self.resources.memory);
                bytes.and_then(|bytes| decode(name, &path, &bytes, srgb, memory, diagnostics))
            }
        };
        let texture = texture.filter(|texture| self.charge(name, texture.bytes() as u64, diagnostics));
        if let (Some(cache), Some(origin), Some(texture)) = (self.resources.cache, origin, &texture) {
            cache.keep_picture(origin, encoding, texture, self.resources.source.record().digest_of(&path));
        }
        self.decoded.insert(key, texture.clone());
        texture
    }

    /// Returns a decoded picture with mipmaps.
    fn mipmapped(
        &mut self,
        name: &FileName,
        bytes: PictureBytes,
        encoding: Encoding,
        diagnostics: &mut Diagnostics,
    ) -> Option<Texture> {
        let key = (bytes.path().to_string(), encoding);
        if let Some(known) = self.mipmapped.get(&key) {
            return known.clone();
        }
        let texture = self.picture(name, bytes, encoding, diagnostics);
        // Mipmaps increase the memory by a third: 1/4 + 1/16 + ...
        let texture = texture.filter(|texture| self.charge(name, texture.bytes() as u64 / 3, diagnostics));
        let texture = texture.map(Texture::with_levels);
        self.mipmapped.insert(key, texture.clone());
        texture
    }

    /// Returns the cache key of a picture, or `None` if caching is off.
    fn picture_origin(&self, bytes: &PictureBytes) -> Option<AssetKey> {
        match bytes {
            PictureBytes::File(path) => self.origin(path, || None),
            PictureBytes::Memory(path, bytes) => self.origin(path, || Some(Digest::of(bytes))),
        }
    }
}

/// Iterates over the pictures that a principled material names.
fn pictures(layers: &PrincipledMaterial) -> impl Iterator<Item = (&FileName, Encoding)> {
    let own = [
        (layers.emission_texture.as_ref(), Encoding::Srgb),
        (layers.opacity_texture.as_ref(), Encoding::Linear),
        (layers.normal_texture.as_ref(), Encoding::Linear),
        (layers.bump_texture.as_ref(), Encoding::Linear),
        (layers.metallic_roughness_texture.as_ref(), Encoding::Linear),
    ];
    let parameters = TEXTURE_FIELDS.iter().map(|textured| ((textured.texture_file)(layers), encoding_of(textured)));
    own.into_iter().chain(parameters).filter_map(|(name, encoding)| Some((name?, encoding)))
}

/// Returns the encoding of a parameter's texture: sRGB for colours and linear for numbers.
fn encoding_of(textured: &TextureField) -> Encoding {
    match textured.change {
        TextureEffect::Number(_) => Encoding::Linear,
        TextureEffect::Color(_) => Encoding::Srgb,
    }
}
