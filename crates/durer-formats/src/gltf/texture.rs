//! Reads textures, which combine images with samplers and coordinate transforms.

use super::Model;
use super::buffers::{UriTarget, resolve_uri};
use super::json::JsonRef;
use durer_diag::Span;
use durer_scene::describe::FileName;
use durer_scene::math::fp;
use durer_scene::scene::{PictureBytes, TextureImage};
use durer_scene::texture::{Mapping, Wrap};

/// Returns the wrap mode for the `wrapS` or `wrapT` of a sampler.
fn wrap(at: &JsonRef) -> Option<Wrap> {
    match at.integer(..)? {
        10497 => Some(Wrap::Repeat),
        33648 => Some(Wrap::Mirror),
        33071 => Some(Wrap::Clamp),
        other => {
            at.error("VALUE_NOT_IN_LIST", format!("value {other} is not a wrapping mode"));
            None
        }
    }
}

impl Model<'_> {
    /// Returns the bytes or the file name of each image.
    pub(super) fn images(&self, root: &JsonRef) -> Vec<Option<PictureBytes>> {
        let Some(images) = root.get("images") else { return Vec::new() };
        images.items().map(|image| self.image(&image)).collect()
    }

    fn image(&self, at: &JsonRef) -> Option<PictureBytes> {
        at.object()?;
        let name = format!("{}#{}", self.input.name, at.pointer());
        let kind = at.get("mimeType").and_then(|kind| kind.string());
        let picture = match (at.get("uri"), at.get("bufferView")) {
            (Some(_), Some(_)) | (None, None) => {
                at.error("ONE_OF_MISMATCH", "exactly one of `uri` and `bufferView` must be defined");
                return None;
            }
            (Some(uri), None) => match resolve_uri(&uri)? {
                UriTarget::File(path) => PictureBytes::File(path),
                UriTarget::Data(kind, bytes) => {
                    if !kind.starts_with("image/") {
                        uri.error("IMAGE_MIME_TYPE_INVALID", format!("unexpected media type `{kind}`"));
                    }
                    PictureBytes::Memory(name, bytes)
                }
            },
            (None, Some(view)) => {
                if kind.is_none() {
                    at.error("UNSATISFIED_DEPENDENCY", "`bufferView` needs a `mimeType`");
                }
                let picture = self.views[view.index(self.views.len())?].clone()?;
                if picture.stride.is_some() {
                    view.error(
                        "IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE",
                        "the buffer view of an image must not have a stride",
                    );
                }
                self.charge(picture.length, 1, at)?;
                PictureBytes::Memory(name, picture.slice?.bytes().into())
            }
        };
        Some(picture)
    }

    /// Reads a `textureInfo`, changes its mapping, and returns the name of the new asset.
    pub(super) fn texture(&self, at: &JsonRef, change: impl FnOnce(&mut Mapping)) -> Option<FileName> {
        self.texture_as(at, "", change)
    }

    /// Reads a `textureInfo` as [`Model::texture`] does. The text `role` distinguishes different
    /// uses of the same texture.
    pub(super) fn texture_as(&self, at: &JsonRef, role: &str, change: impl FnOnce(&mut Mapping)) -> Option<FileName> {
        at.object()?;
        let number = at.required("index")?.index(self.textures.len())?;
        let (image, mut mapping, span) = self.textures[number].clone()?;
        let mut set = at.get("texCoord").map_or(Some(0), |set| set.integer(..))?;
        if let Some(transform) = at.get("extensions").as_ref().and_then(|e| e.get("KHR_texture_transform")) {
            set = transform.get("texCoord").and_then(|set| set.integer(..)).unwrap_or(set);
            mapping.transform = transformed(&transform);
        }
        if set > 1 {
            let name = at.name();
            let message = format!(
                "this texture of material{name} uses TEXCOORD_{set}, but only two sets are supported; \
                 TEXCOORD_0 is used"
            );
            at.warning("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", message);
        }
        mapping.second = set == 1;
        if mapping.second {
            self.second_sets.borrow_mut().push(at.pointer());
        }
        change(&mut mapping);
        let path = format!("{}#{}{role}", self.input.name, at.pointer());
        self.pictures.borrow_mut().insert(path.clone(), TextureImage { bytes: image, mapping });
        Some(FileName { path, span })
    }

    /// Reads all textures, and returns `None` in place of each texture that has no usable image.
    pub(super) fn textures(&self, root: &JsonRef) -> Vec<Option<(PictureBytes, Mapping, Span)>> {
        let samplers = match root.get("samplers") {
            Some(samplers) => samplers.items().map(|sampler| self.sampler(&sampler)).collect(),
            None => Vec::new(),
        };
        let Some(textures) = root.get("textures") else { return Vec::new() };
        let one = |at: JsonRef| {
            at.object()?;
            let mapping = match at.get("sampler") {
                Some(sampler) => samplers[sampler.index(samplers.len())?],
                None => Mapping::default(),
            };
            let extensions = at.get("extensions");
            let webp = extensions.as_ref().and_then(|e| e.get("EXT_texture_webp"));
            let other = ["KHR_texture_basisu", "MSFT_texture_dds"];
            let other = other.iter().find_map(|name| extensions.as_ref()?.get(name).map(|_| *name));
            let webp = webp.as_ref().and_then(|webp| webp.get("source"));
            let Some(source) = webp.or(at.get("source")) else {
                match other {
                    Some(name) => at.error(
                        "UNSUPPORTED_EXTENSION",
                        format!(
                            "the texture's picture has an unsupported compression ({name}); convert the file with \
                             `gltf-transform`"
                        ),
                    ),
                    None => at.warning("TEXTURE_NO_SOURCE", "a texture without a picture is left out"),
                }
                return None;
            };
            let image = source.index(self.images.len())?;
            // Errors in a picture are reported at the place where the file names the picture.
            let span = self.report.span(&format!("/images/{image}/uri"));
            Some((self.images[image].clone()?, mapping, span))
        };
        textures.items().map(one).collect()
    }

    fn sampler(&self, at: &JsonRef) -> Mapping {
        let mode = |key| at.get(key).and_then(|mode| wrap(&mode)).unwrap_or_default();
        let nearest = at.get("magFilter").and_then(|filter| filter.integer(9728..=9729)) == Some(9728);
        // The filters from 9984 on use mipmaps.
        let mipmaps = at.get("minFilter").is_some_and(|filter| matches!(filter.integer(9728..=9987), Some(9984..)));
        Mapping { wrap: [mode("wrapS"), mode("wrapT")], nearest, mipmaps, ..Mapping::default() }
    }
}

/// Returns the matrix that KHR_texture_transform defines for an offset, a rotation and a scale.
///
/// Source: KHR_texture_transform: T R S with R = (cos r, sin r; -sin r, cos r).
fn transformed(at: &JsonRef) -> [[f32; 3]; 2] {
    let pair = |key, or| at.get(key).and_then(|pair| pair.numbers::<2>()).unwrap_or(or);
    let ([x, y], [sx, sy]) = (pair("offset", [0.0; 2]), pair("scale", [1.0; 2]));
    let angle = at.get("rotation").and_then(|angle| angle.number()).unwrap_or(0.0);
    let (sin, cos) = fp::sin_cos_degrees(f64::from(angle).to_degrees());
    let (sin, cos) = (sin as f32, cos as f32);
    [[cos * sx, sin * sy, x], [-sin * sx, cos * sy, y]]
}
