//! Writes textures: images, samplers and texture transforms.

use super::Writer;
use crate::pictures::{CONVERSION_BYTES_PER_PIXEL, as_png};
use durer_image::{self as image, Encoded, Transfer};
use durer_scene::describe::FileName;
use durer_scene::scene::{PictureBytes, TextureImage};
use durer_scene::texture::{Mapping, Wrap};
use serde_json::{Value, json};
use std::sync::Arc;

impl Writer<'_> {
    /// Writes a `textureInfo` for a picture that a material names, and also returns the mapping of
    /// the picture.
    pub(super) fn texture(&mut self, name: Option<&FileName>) -> Option<(Value, Mapping)> {
        let name = name?;
        let picture = self.export.picture(name);
        let info = match self.textures.get(&name.path) {
            Some(cached) => cached.clone(),
            None => {
                let info = self.info(&picture);
                self.textures.insert(name.path.clone(), info.clone());
                info
            }
        };
        Some((info?, picture.mapping))
    }

    fn info(&mut self, picture: &TextureImage) -> Option<Value> {
        let source = self.image(&picture.bytes)?;
        let mapping = &picture.mapping;
        let wrap = |wrap: Wrap| match wrap {
            Wrap::Repeat => 10497,
            Wrap::Mirror => 33648,
            Wrap::Clamp => 33071,
        };
        let filter = if mapping.nearest { 9728 } else { 9729 };
        // The value 9987 selects trilinear filtering.
        let smaller = if mapping.mipmaps { 9987 } else { filter };
        let [s, t] = mapping.wrap.map(wrap);
        let sampler = json!({ "wrapS": s, "wrapT": t, "magFilter": filter, "minFilter": smaller });
        let cached = self.lists.get("samplers").and_then(|list| list.iter().position(|cached| *cached == sampler));
        let sampler = cached.unwrap_or_else(|| self.add("samplers", sampler));
        let index = self.add("textures", json!({ "source": source, "sampler": sampler }));
        let mut info = json!({ "index": index });
        if mapping.second {
            info["texCoord"] = 1.into();
        }
        if mapping.transform != Mapping::default().transform {
            self.extensions.insert("KHR_texture_transform");
            info["extensions"] = json!({ "KHR_texture_transform": self.transform(mapping) });
        }
        Some(info)
    }

    /// Returns the offset, rotation and scale of KHR_texture_transform.
    fn transform(&mut self, mapping: &Mapping) -> Value {
        let [[a, b, x], [c, d, y]] = mapping.transform;
        let sx = (a * a + c * c).sqrt();
        let side = if a * d - b * c < 0.0 { -1.0 } else { 1.0 };
        let sy = side * (b * b + d * d).sqrt();
        if (a * b + c * d).abs() > 1e-4 * (sx * sy).abs() {
            self.warn_lost("glTF textures cannot be sheared: the shear is left out");
        }
        let turn = durer_scene::math::fp::atan2(-c, a);
        json!({ "offset": [x, y], "rotation": turn, "scale": [sx, sy] })
    }

    /// Returns the index of an image, which is written when it is used for the first time.
    fn image(&mut self, bytes: &PictureBytes) -> Option<usize> {
        let (PictureBytes::File(name) | PictureBytes::Memory(name, _)) = bytes;
        if let Some(cached) = self.images.get(name) {
            return *cached;
        }
        let found = self.export.picture_bytes(bytes);
        let memory = self.output.memory;
        let Some((bytes, kind)) = found.and_then(|bytes| known_to_gltf(bytes, name, memory)) else {
            self.warn_lost(format!("the picture `{name}` cannot be read"));
            self.images.insert(name.clone(), None);
            return None;
        };
        let view = self.view(&bytes, None);
        let number = self.add("images", json!({ "bufferView": view, "mimeType": kind }));
        self.images.insert(name.clone(), Some(number));
        Some(number)
    }
}

/// Returns PNG and JPEG files unchanged, and converts other formats to PNG with 8 bits per channel.
fn known_to_gltf(bytes: Arc<[u8]>, name: &str, memory: u64) -> Option<(Arc<[u8]>, &'static str)> {
    if bytes.starts_with(b"\x89PNG") {
        return Some((bytes, "image/png"));
    }
    if bytes.starts_with(&[0xff, 0xd8, 0xff]) {
        return Some((bytes, "image/jpeg"));
    }
    let image =
        Encoded::open(&bytes, name).ok()?.read_for(CONVERSION_BYTES_PER_PIXEL, memory, image::decode_srgb).ok()?;
    Some((as_png(image, Transfer::Srgb)?, "image/png"))
}
