//! Assets of a scene that are in memory instead of in files: meshes, pictures, light profiles and
//! densities.

use crate::describe::{Constraint, FileName};
use crate::dialect::set;
use crate::light::PhotometricProfile;
use crate::math::Aabb;
use crate::medium::DensityGrid;
use crate::shape::MeshData;
use crate::source::Digest;
use crate::texture::{Channel, Mapping, Wrap};
use crate::{described, described_words};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Meshes, pictures, light profiles and densities of a scene that are in memory, with their names
/// as keys. A [`FileName`] in the scene refers to the asset with that name, or to a file if there
/// is no such asset.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assets {
    /// Meshes.
    pub meshes: BTreeMap<String, Arc<MeshData>>,
    /// Pictures and their mappings.
    pub pictures: BTreeMap<String, TextureImage>,
    /// Light profiles.
    pub profiles: BTreeMap<String, Arc<PhotometricProfile>>,
    /// Densities and their bounds.
    pub densities: BTreeMap<String, (Aabb, Arc<DensityGrid>)>,
}

/// Image of a texture, with its mapping onto surfaces. Materials refer to the texture by name.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureImage {
    /// Location of the bytes of the image.
    pub bytes: PictureBytes,
    /// Mapping of the image onto surfaces.
    pub mapping: Mapping,
}

described_words! {
    /// Magnification filter of a texture.
    MagnificationFilter { Linear = "linear", Nearest = "nearest" }
}

described_words! {
    /// Minification filter of a texture: `texels` takes point samples, which average correctly over
    /// a pixel's samples; `mipmaps` takes a smaller version of the picture, with less noise and
    /// slight blur.
    MinificationFilter { Texels = "texels", Mipmaps = "mipmaps" }
}

described! {
    /// A named texture: an image and its mapping onto surfaces. The texture fields of a
    /// `PrincipledMaterial` refer to it by name.
    NamedTexture ["Texture" in set::DURER] {
        /// Name of the texture.
        name: FileName = FileName::default(), required, Constraint::Any, ["name" in set::DURER];
        /// Image file.
        picture: FileName = FileName::default(), required, Constraint::Any, ["picture" in set::DURER];
        /// Wrap mode beyond the left and right borders: `repeat`, `mirror` or `clamp`.
        wrap_u: Wrap = Wrap::Repeat, optional, Constraint::Any, ["wrapU" in set::DURER];
        /// Wrap mode beyond the upper and lower borders: `repeat`, `mirror` or `clamp`.
        wrap_v: Wrap = Wrap::Repeat, optional, Constraint::Any, ["wrapV" in set::DURER];
        /// Magnification filter: `linear` interpolates the four nearest texels, `nearest` uses one.
        texels: MagnificationFilter = MagnificationFilter::Linear, optional, Constraint::Any, ["texels" in set::DURER];
        /// Minification filter of the path tracer: `texels` samples the full-size image, `mipmaps`
        /// a smaller version of it.
        minified: MinificationFilter = MinificationFilter::Texels, optional, Constraint::Any, ["minified" in set::DURER];
        /// Texture coordinate set of the mesh: 0 for the first, 1 for the second.
        uv_set: u32 = 0, optional, Constraint::AtMost(1), ["uvSet" in set::DURER];
        /// Transform from surface to image coordinates, both with v downwards from the upper
        /// border, as two rows of a matrix.
        uv_transform: Vec<[f32; 3]> = Mapping::default().transform.to_vec(), optional, Constraint::Rows(2, 2), ["uvTransform" in set::DURER];
        /// Alpha threshold: opacity is 1 at or above it and 0 below. Without it, opacity equals
        /// alpha.
        alpha_cutoff: Option<f32> = None, optional, Constraint::Any, ["alphaCutoff" in set::DURER];
        /// Factor on the slope of the normals in a normal map.
        normal_scale: f32 = 1.0, optional, Constraint::Any, ["normalScale" in set::DURER];
        /// Channel used for a scalar field: `r`, `g`, `b`, `a`, or the `angle` of the direction in
        /// red and green. The default is red, or for opacity the alpha channel if there is one.
        channel: Option<Channel> = None, optional, Constraint::Any, ["channel" in set::DURER];
        /// Values that texels of 0 and 1 are mapped to. Normal and bump maps ignore them.
        texel_range: Vec<[f32; 2]> = vec![[0.0, 1.0]], optional, Constraint::Rows(1, 1), ["texelRange" in set::DURER];
    }
}

impl NamedTexture {
    /// Describes a picture as a named texture, or returns `None` if the bytes of the picture are
    /// not in a file.
    pub fn of(name: &str, picture: &TextureImage) -> Option<Self> {
        let PictureBytes::File(file) = &picture.bytes else { return None };
        Some(NamedTexture::with_mapping(name, file, picture.mapping))
    }

    /// Describes a picture as a named texture, given its name, file and mapping.
    pub(super) fn with_mapping(name: &str, file: &str, mapping: Mapping) -> Self {
        let named = |path: &str| FileName { path: path.to_string(), ..FileName::default() };
        let Mapping { wrap: [wrap_u, wrap_v], nearest, mipmaps, second, transform, cutoff, strength, channel, range } =
            mapping;
        NamedTexture {
            name: named(name),
            picture: named(file),
            wrap_u,
            wrap_v,
            texels: if nearest { MagnificationFilter::Nearest } else { MagnificationFilter::Linear },
            minified: if mipmaps { MinificationFilter::Mipmaps } else { MinificationFilter::Texels },
            uv_set: second.into(),
            uv_transform: transform.to_vec(),
            alpha_cutoff: cutoff,
            normal_scale: strength,
            channel,
            texel_range: vec![range],
        }
    }

    /// Returns the picture that the texture describes.
    pub fn picture(&self) -> TextureImage {
        let usual = Mapping::default();
        let mapping = Mapping {
            wrap: [self.wrap_u, self.wrap_v],
            nearest: self.texels == MagnificationFilter::Nearest,
            mipmaps: self.minified == MinificationFilter::Mipmaps,
            second: self.uv_set > 0,
            transform: self.uv_transform.as_slice().try_into().unwrap_or(usual.transform),
            cutoff: self.alpha_cutoff,
            strength: self.normal_scale,
            channel: self.channel,
            range: self.texel_range.first().copied().unwrap_or(usual.range),
        };
        TextureImage { bytes: PictureBytes::File(self.picture.path.clone()), mapping }
    }
}

/// Location of the bytes of a texture image, which is a file or memory.
#[derive(Clone, Debug, PartialEq)]
pub enum PictureBytes {
    /// Name of the image file, relative to the scene.
    File(String),
    /// Name for use in messages, and the bytes of a picture file in memory.
    Memory(String, Arc<[u8]>),
}

impl PictureBytes {
    /// Returns the name of the file, or the name for use in messages.
    pub fn path(&self) -> &str {
        let (PictureBytes::File(path) | PictureBytes::Memory(path, _)) = self;
        path
    }
}

impl Assets {
    /// True if all lists are empty.
    pub fn is_empty(&self) -> bool {
        let Assets { meshes, pictures, profiles, densities } = self;
        meshes.is_empty() && pictures.is_empty() && profiles.is_empty() && densities.is_empty()
    }

    /// True if some assets are not in files, which means that a scene file cannot refer to them.
    pub fn has_in_memory(&self) -> bool {
        let loose = |picture: &TextureImage| matches!(picture.bytes, PictureBytes::Memory(..));
        let Assets { meshes, pictures, profiles, densities } = self;
        !(meshes.is_empty() && profiles.is_empty() && densities.is_empty()) || pictures.values().any(loose)
    }

    /// Describes the pictures that are in files as named textures.
    pub fn textures(&self) -> impl Iterator<Item = NamedTexture> {
        self.pictures.iter().filter_map(|(name, picture)| NamedTexture::of(name, picture))
    }
}

/// Serializes hashes of the assets, since megabytes of numbers would make the output useless.
impl Serialize for Assets {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let count = self.meshes.len() + self.pictures.len() + self.profiles.len() + self.densities.len();
        let mut map = serializer.serialize_map(Some(count))?;
        for (name, mesh) in &self.meshes {
            map.serialize_entry(name, &mesh.digest())?;
        }
        for (name, picture) in &self.pictures {
            let file = match &picture.bytes {
                PictureBytes::File(name) => name.clone(),
                PictureBytes::Memory(_, bytes) => Digest::of(bytes).to_string(),
            };
            map.serialize_entry(name, &(file, &picture.mapping))?;
        }
        for (name, profile) in &self.profiles {
            map.serialize_entry(name, &profile.digest())?;
        }
        for (name, (bounds, densities)) in &self.densities {
            map.serialize_entry(name, &(bounds.min, bounds.max, densities.digest()))?;
        }
        map.end()
    }
}
