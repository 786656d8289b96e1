//! Steps shared by the writers of scene formats: reports of losses, files beside the scene, placed
//! shapes, materials reduced to simple surfaces, and light from all around.

#[cfg(any(feature = "mitsuba", feature = "pbrt", feature = "usd"))]
pub(crate) mod camera;
#[cfg(any(feature = "gltf", feature = "usd"))]
pub(crate) mod layers;
#[cfg(any(feature = "mitsuba", feature = "pbrt", feature = "usd"))]
pub(crate) mod light;
#[cfg(any(feature = "mitsuba", feature = "pbrt", feature = "usd"))]
pub(crate) mod metal;
#[cfg(any(feature = "mitsuba", feature = "pbrt", feature = "usd"))]
mod phong;
#[cfg(any(feature = "mitsuba", feature = "pbrt", feature = "usd"))]
pub(crate) mod picture;
#[cfg(any(feature = "mitsuba", feature = "pbrt", feature = "usd"))]
mod principled;
#[cfg(any(feature = "mitsuba", feature = "pbrt", feature = "usd"))]
pub(crate) mod shape;
#[cfg(any(feature = "mitsuba", feature = "pbrt", feature = "usd"))]
pub(crate) mod surface;

use crate::asset_export::{AssetFile, free_name, sanitize_name};
use crate::gzip::read_decompressed;
use crate::model::WriteContext;
use crate::shared_report::NO_COUNTERPART;
use durer_diag::{Diagnostic, Diagnostics};
use durer_scene::describe::FileName;
use durer_scene::scene::{PictureBytes, Scene, TextureImage};
use durer_scene::shape::MeshData;
use durer_scene::texture::{Channel, Mapping};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Scene that is being written, with the warnings and the files that this produces.
pub(crate) struct Export<'a> {
    pub scene: &'a Scene,
    pub context: &'a WriteContext<'a>,
    /// True if the format has distant lights with an angular size.
    pub has_sun_size: bool,
    diagnostics: &'a mut Diagnostics,
    reported: BTreeSet<String>,
    files: Vec<AssetFile>,
    /// Names of files already in use, in lower case because some file systems ignore case.
    used_names: BTreeSet<String>,
    /// Paths of the files by the content that they hold; `None` if the content cannot be written.
    paths: BTreeMap<String, Option<String>>,
}

impl<'a> Export<'a> {
    pub fn new(scene: &'a Scene, context: &'a WriteContext<'a>, diagnostics: &'a mut Diagnostics) -> Self {
        let (reported, files, used_names, paths) = Default::default();
        Export { scene, context, has_sun_size: false, diagnostics, reported, files, used_names, paths }
    }

    /// Warns about content that is lost or changed, once for each message.
    pub fn warn_lost(&mut self, message: impl Into<String>) {
        let message = message.into();
        if self.reported.insert(message.clone()) {
            self.diagnostics.push(Diagnostic::warning(message).code(NO_COUNTERPART));
        }
    }

    /// Returns the mesh that an asset or a file contains.
    pub fn mesh_data(&mut self, name: &str) -> Option<Arc<MeshData>> {
        if let Some(data) = self.scene.assets.meshes.get(name) {
            return Some(data.clone());
        }
        let data = read_decompressed(self.context.source, name)
            .ok()
            .and_then(|bytes| crate::read_mesh(&bytes, 0, name, &mut Diagnostics::default()));
        if data.is_none() {
            self.warn_lost(format!("the mesh `{name}` cannot be read: it is left out"));
        }
        data.map(Arc::new)
    }

    /// Returns the picture that a material names: a texture, or a file with the default mapping.
    /// The part after a colon, as in `picture.png:g`, is a channel.
    pub fn picture(&self, name: &FileName) -> TextureImage {
        if let Some(picture) = self.scene.assets.pictures.get(&name.path) {
            return picture.clone();
        }
        let word = name.path.rsplit_once(':').and_then(|(path, word)| Some((path, Channel::from_word(word)?)));
        let (path, channel) = word.map_or((&name.path[..], None), |(path, channel)| (path, Some(channel)));
        let mapping = Mapping { channel, ..Mapping::default() };
        TextureImage { bytes: PictureBytes::File(path.into()), mapping }
    }

    /// Returns the bytes of a file that the scene names, or of a picture in memory.
    #[cfg(any(feature = "gltf", feature = "mitsuba", feature = "pbrt", feature = "usd"))]
    pub fn picture_bytes(&self, picture: &PictureBytes) -> Option<Arc<[u8]>> {
        match picture {
            PictureBytes::Memory(_, bytes) => Some(bytes.clone()),
            PictureBytes::File(name) => self.context.source.read(name).ok(),
        }
    }

    /// Returns the path of a file beside the scene, which is made when its content `key` is asked
    /// for the first time. The new name is similar to `name`.
    pub fn file(
        &mut self,
        key: String,
        name: &str,
        extension: &str,
        make: impl FnOnce(&mut Self) -> Option<Vec<u8>>,
    ) -> Option<String> {
        if let Some(path) = self.paths.get(&key) {
            return path.clone();
        }
        let path = make(self).map(|bytes| {
            let path = format!("{}/{}", folder_of(self.context.name), free_name(name, extension, &mut self.used_names));
            self.files.push((path.clone(), bytes));
            path
        });
        self.paths.insert(key, path.clone());
        path
    }

    /// Returns all files beside the scene.
    pub fn finish(self) -> Vec<AssetFile> {
        self.files
    }
}

/// Returns the name of the folder for the files of a scene: the name of its file without folder and
/// extension.
fn folder_of(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    sanitize_name(last.rsplit_once('.').map_or(last, |(stem, _)| stem))
}
