//! What a scene brings along instead of naming files: meshes and pictures in memory.

use crate::shape::MeshData;
use crate::source::Digest;
use crate::texture::Mapping;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Meshes and pictures by name. A [`FileName`](crate::describe::FileName) of the scene means the
/// asset of that name, if there is one, and else a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assets {
    /// Meshes.
    pub meshes: BTreeMap<String, Arc<MeshData>>,
    /// Pictures and how they lie on surfaces.
    pub pictures: BTreeMap<String, Picture>,
}

/// A picture that a material names.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Where its bytes are.
    pub bytes: PictureBytes,
    /// How it lies on a surface.
    pub mapping: Mapping,
}

/// Where the bytes of a picture are.
#[derive(Clone, Debug, PartialEq)]
pub enum PictureBytes {
    /// In a file of this name, beside the scene.
    File(String),
    /// Here: the bytes of a picture file, and its name for messages.
    Here(String, Arc<[u8]>),
}

impl PictureBytes {
    /// The name.
    pub fn path(&self) -> &str {
        let (PictureBytes::File(path) | PictureBytes::Here(path, _)) = self;
        path
    }
}

impl Assets {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.meshes.is_empty() && self.pictures.is_empty()
    }
}

/// Assets are told by their hashes: a description with megabytes of numbers would be of no use.
impl Serialize for Assets {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.meshes.len() + self.pictures.len()))?;
        for (name, mesh) in &self.meshes {
            map.serialize_entry(name, &mesh.digest())?;
        }
        for (name, picture) in &self.pictures {
            let file = match &picture.bytes {
                PictureBytes::File(name) => name.clone(),
                PictureBytes::Here(_, bytes) => Digest::of(bytes).to_string(),
            };
            map.serialize_entry(name, &(file, &picture.mapping))?;
        }
        map.end()
    }
}
