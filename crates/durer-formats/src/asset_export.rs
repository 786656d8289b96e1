//! Exports the assets that a scene holds in memory as separate files: meshes as PLY, light profiles
//! as IES, density grids as Mitsuba volumes, and pictures unchanged.

use super::ply::write_all_attributes;
use super::{extension, photometry, vol};
use durer_image as image;
use durer_scene::describe::{DescribedKind, FileName, Value};
use durer_scene::scene::{Assets, Group, Material, ObjectKind, PictureBytes, Scene, TextureImage};
use durer_scene::source::AssetSource;
use durer_scene::texture::Mapping;
use std::collections::{BTreeMap, BTreeSet};

/// Path of an exported file relative to the scene file, and the bytes of the exported file.
pub type AssetFile = (String, Vec<u8>);

/// Makes a name valid in a scene file: keeps letters, digits, and `-_.`, and replaces all other
/// characters with `_`.
pub fn sanitize_name(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect()
}

/// Returns a valid name that is similar to `of` and not yet in use. `used_names` holds the names in
/// use, in lower case.
pub(crate) fn free_name(of: &str, extension: &str, used_names: &mut BTreeSet<String>) -> String {
    let ending = if extension.is_empty() { String::new() } else { format!(".{extension}") };
    let last = of.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem: String = sanitize_name(last.strip_suffix(&ending).unwrap_or(last)).chars().take(60).collect();
    let stem = if stem.trim_matches('.').is_empty() { "unnamed" } else { stem.trim_start_matches('.') };
    let numbered = (0..).map(|i| if i == 0 { format!("{stem}{ending}") } else { format!("{stem}-{i}{ending}") });
    let free = |name: &String| !used_names.contains(&name.to_lowercase());
    let name = numbered.into_iter().find(free).unwrap_or_default();
    used_names.insert(name.to_lowercase());
    name
}

/// Returns a copy of the scene in which all meshes and pictures have been moved to files in
/// `folder`, together with these files. Files that the scene names are copied too; files that
/// cannot be read keep their names.
pub fn export_assets(scene: &Scene, folder: &str, source: &dyn AssetSource) -> (Scene, Vec<AssetFile>) {
    let (files, used_names, new_names, textures) = Default::default();
    let mut put = AssetExport { scene, folder, source, files, used_names, new_names, textures };
    let mut new_name = scene.clone();
    if let Some(root) = &mut new_name.root {
        put.group(root);
    }
    for material in &mut new_name.materials {
        match &mut material.value {
            Material::Principled(layers) => put.fields(&mut **layers),
            Material::Solid(solid, _) => put.fields(solid),
            _ => {}
        }
    }
    put.fields(&mut new_name.background);
    for light in new_name.lights.iter_mut().flatten() {
        put.fields(&mut light.value);
    }
    if let Some(name) = new_name.fog.as_mut().and_then(|fog| fog.value.density.as_mut()) {
        name.path = put.rename_asset(&name.path);
    }
    new_name.assets = Assets { pictures: put.textures.into_values().collect(), ..Assets::default() };
    (new_name, put.files)
}

/// State of an asset export: the files written so far, and the new names of assets.
struct AssetExport<'a> {
    scene: &'a Scene,
    folder: &'a str,
    source: &'a dyn AssetSource,
    files: Vec<AssetFile>,
    /// Names of files and textures already in use, in lower case because some file systems ignore
    /// case.
    used_names: BTreeSet<String>,
    /// New name of each asset, by its kind and old name.
    new_names: BTreeMap<(&'static str, String), String>,
    /// Named textures, by their old names.
    textures: BTreeMap<String, (String, TextureImage)>,
}

impl AssetExport<'_> {
    /// Adds a file and returns its path relative to the scene file.
    fn file(&mut self, of: &str, extension: &str, bytes: Vec<u8>) -> String {
        let (folder, name) = (self.folder, free_name(of, extension, &mut self.used_names));
        let path = format!("{folder}/{name}");
        self.files.push((path.clone(), bytes));
        path
    }

    fn group(&mut self, group: &mut Group) {
        group.objects.iter_mut().for_each(|object| self.node(&mut object.node));
    }

    fn node(&mut self, node: &mut ObjectKind) {
        match node {
            ObjectKind::Group(group) => self.group(group),
            ObjectKind::Transform(_, inner) => self.node(&mut inner.node),
            ObjectKind::Solid(_, parts) => parts.iter_mut().for_each(|part| self.node(&mut part.node)),
            ObjectKind::Mesh(mesh) => mesh.obj_file.path = self.mesh(&mesh.obj_file.path),
            ObjectKind::Primitive(_) | ObjectKind::Voxels(..) | ObjectKind::HeightField(_) => {}
        }
    }

    fn mesh(&mut self, name: &str) -> String {
        let scene = self.scene;
        self.rename("mesh", name, |put| match scene.assets.meshes.get(name) {
            Some(data) => put.file(name, "ply", write_all_attributes(data)),
            None => put.copy_file(name),
        })
    }

    /// Returns the new name of an asset, and calls `put` when the asset is used for the first time.
    fn rename(&mut self, kind: &'static str, name: &str, put: impl FnOnce(&mut Self) -> String) -> String {
        let key = (kind, name.to_string());
        if let Some(cached) = self.new_names.get(&key) {
            return cached.clone();
        }
        let new_name = put(self);
        self.new_names.insert(key, new_name.clone());
        new_name
    }

    /// Copies a file that the scene refers to.
    fn copy_file(&mut self, name: &str) -> String {
        match self.source.read(name) {
            Ok(bytes) => self.file(name, &extension(name), bytes.to_vec()),
            Err(_) => name.to_string(),
        }
    }

    /// Exports the files that the fields of a statement refer to.
    fn fields<T: DescribedKind>(&mut self, item: &mut T) {
        for i in 0..item.fields().len() {
            let Some(Value::Path(file)) = DescribedKind::get(item, i) else { continue };
            let path = self.rename_asset(&file.path);
            DescribedKind::set(item, i, Value::Path(FileName { path, ..file }));
        }
    }

    /// Returns the new name of a light profile, density grid, or picture: the name of its file, or
    /// the name of a texture if it has a mapping.
    fn rename_asset(&mut self, name: &str) -> String {
        if let Some((cached, _)) = self.textures.get(name) {
            return cached.clone();
        }
        let scene = self.scene;
        if let Some(profile) = scene.assets.profiles.get(name) {
            return self.rename("lamp", name, |put| put.file(name, "ies", photometry::write(profile)));
        }
        if let Some((bounds, grid)) = scene.assets.densities.get(name) {
            return self.rename("densities", name, |put| put.file(name, "vol", vol::write(bounds, grid)));
        }
        let Some(TextureImage { bytes, mapping }) = scene.assets.pictures.get(name) else {
            // In `light.csv:red` and `picture.png:g`, the part after the colon names a column or a
            // channel of the file.
            let parted = name.rsplit_once(':').filter(|_| !self.source.contains(name));
            let (path, what) = parted.map_or((name, String::new()), |(path, what)| (path, format!(":{what}")));
            return self.rename("picture", path, |put| put.copy_file(path)) + &what;
        };
        let path = bytes.path();
        let file = self.rename("picture", path, |put| match bytes {
            PictureBytes::File(_) => put.copy_file(path),
            PictureBytes::Memory(_, bytes) => {
                let own = extension(path);
                put.file(path, image::extension_of(bytes, path).unwrap_or(&own), bytes.to_vec())
            }
        });
        if *mapping == Mapping::default() {
            return file;
        }
        let own = free_name(&file, "", &mut self.used_names);
        let picture = TextureImage { bytes: PictureBytes::File(file), mapping: *mapping };
        self.textures.insert(name.to_string(), (own.clone(), picture));
        own
    }
}
