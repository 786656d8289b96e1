//! What a scene has in memory, as files beside its text: meshes as PLY, pictures as they are.

use super::extension;
use super::ply::write_whole;
use crate::describe::{Describe, FileName, Value};
use crate::scene::{Group, Material, Node, PictureBytes, Scene};
use crate::source::Source;
use crate::texture::Mapping;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A file's name, seen from the scene, and what it holds.
pub type Beside = (String, Arc<[u8]>);

/// The same scene with all its meshes and pictures in files of a folder beside it, and these files.
/// Files that it names are copied there; those that cannot be read are named as before.
pub fn put_beside(scene: &Scene, folder: &str, source: &Source) -> (Scene, Vec<Beside>) {
    let mut put = Put { scene, folder, source, files: Vec::new(), taken: BTreeSet::new(), known: BTreeMap::new() };
    let mut made = scene.clone();
    made.assets.meshes.clear();
    made.assets.pictures.clear();
    if let Some(root) = &mut made.root {
        put.group(root);
    }
    let mut textures = BTreeMap::new();
    for material in &mut made.materials {
        if let Material::Principled(layers) = &mut material.value {
            put.fields(&mut **layers, &mut textures);
        }
    }
    put.fields(&mut made.background, &mut textures);
    made.assets.pictures = textures.into_values().collect();
    (made, put.files)
}

struct Put<'a> {
    scene: &'a Scene,
    folder: &'a str,
    source: &'a Source,
    files: Vec<Beside>,
    /// Names of files and textures that are given, in lower case: some systems tell no others apart.
    taken: BTreeSet<String>,
    /// The new names of meshes and of pictures' files, by the old.
    known: BTreeMap<(&'static str, String), String>,
}

/// Named textures by the names that they had.
type Textures = BTreeMap<String, (String, crate::scene::Picture)>;

impl Put<'_> {
    /// A name of letters that is not yet taken, of one that may be anything.
    fn name(&mut self, of: &str, ending: &str) -> String {
        let last = of.rsplit(['/', '\\']).next().unwrap_or_default();
        let kept = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' };
        let stem: String = last.strip_suffix(ending).unwrap_or(last).chars().map(kept).take(60).collect();
        let stem = if stem.trim_matches('.').is_empty() { "unnamed" } else { stem.trim_start_matches('.') };
        let numbered = (0..).map(|i| if i == 0 { format!("{stem}{ending}") } else { format!("{stem}-{i}{ending}") });
        let free = |name: &String| !self.taken.contains(&name.to_lowercase());
        let name = numbered.into_iter().find(free).unwrap_or_default();
        self.taken.insert(name.to_lowercase());
        name
    }

    /// Adds a file, and gives its name as the scene has it.
    fn file(&mut self, of: &str, ending: &str, bytes: Arc<[u8]>) -> String {
        let name = self.name(of, ending);
        let path = format!("{}/{name}", self.folder);
        self.files.push((path.clone(), bytes));
        path
    }

    fn group(&mut self, group: &mut Group) {
        group.objects.iter_mut().for_each(|object| self.node(&mut object.node));
    }

    fn node(&mut self, node: &mut Node) {
        match node {
            Node::Group(group) => self.group(group),
            Node::Transform(_, inner) => self.node(&mut inner.node),
            Node::Solid(_, parts) => parts.iter_mut().for_each(|part| self.node(&mut part.node)),
            Node::Mesh(mesh) => mesh.obj_file.path = self.mesh(&mesh.obj_file.path),
            Node::Primitive(_) | Node::Voxels(..) | Node::HeightField(_) => {}
        }
    }

    fn mesh(&mut self, name: &str) -> String {
        let key = ("mesh", name.to_string());
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let scene = self.scene;
        let made = match scene.assets.meshes.get(name) {
            Some(data) => self.file(name, ".ply", Arc::from(write_whole(data))),
            None => self.copied(name),
        };
        self.known.insert(key, made.clone());
        made
    }

    /// A file that the scene names, beside it too.
    fn copied(&mut self, name: &str) -> String {
        match self.source.read(name) {
            Ok(bytes) => {
                let ending = format!(".{}", extension(name));
                self.file(name, &ending, bytes)
            }
            Err(_) => name.to_string(),
        }
    }

    /// What the fields of a thing name.
    fn fields<T: Describe>(&mut self, thing: &mut T, textures: &mut Textures) {
        for i in 0..T::FIELDS.len() {
            let Some(Value::Path(file)) = Describe::get(thing, i) else { continue };
            let path = self.named(&file.path, textures);
            Describe::set(thing, i, Value::Path(FileName { path, ..file }));
        }
    }

    /// The new name of a picture: that of its file, or of a texture that says how it lies.
    fn named(&mut self, name: &str, textures: &mut Textures) -> String {
        if let Some((known, _)) = textures.get(name) {
            return known.clone();
        }
        let Some(picture) = self.scene.assets.pictures.get(name) else {
            // `lamp.csv:red` and `picture.png:g` are a column and a channel of a file.
            return match name.rsplit_once(':').filter(|_| !self.source.contains(name)) {
                Some((path, what)) => format!("{}:{what}", self.whole(path)),
                None => self.whole(name),
            };
        };
        let path = picture.bytes.path().to_string();
        let key = ("picture", path.clone());
        let file = match (self.known.get(&key), &picture.bytes) {
            (Some(known), _) => known.clone(),
            (None, PictureBytes::File(_)) => self.copied(&path),
            (None, PictureBytes::Here(_, bytes)) => self.file(&path, ending(&path, bytes), bytes.clone()),
        };
        self.known.insert(key, file.clone());
        if picture.mapping == Mapping::default() {
            return file;
        }
        let own = self.name(file.rsplit('/').next().unwrap_or_default(), ":");
        let picture = crate::scene::Picture { bytes: PictureBytes::File(file), mapping: picture.mapping };
        textures.insert(name.to_string(), (own.clone(), picture));
        own
    }

    /// A file that is named as it is.
    fn whole(&mut self, name: &str) -> String {
        let key = ("picture", name.to_string());
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let made = self.copied(name);
        self.known.insert(key, made.clone());
        made
    }
}

/// The ending of a picture's file: its own, or what its first bytes say.
fn ending(name: &str, bytes: &[u8]) -> &'static str {
    const ENDINGS: [(&str, &[u8]); 10] = [
        (".png", b"\x89PNG"),
        (".jpg", &[0xff, 0xd8, 0xff]),
        (".webp", b"RIFF"),
        (".ktx2", &[0xab, b'K', b'T', b'X']),
        (".exr", &[0x76, 0x2f, 0x31, 0x01]),
        (".hdr", b"#?"),
        (".pfm", b"PF"),
        (".ppm", b"P6"),
        (".bmp", b"BM"),
        (".tga", b""),
    ];
    let own = format!(".{}", extension(name));
    let known = ENDINGS.iter().find(|(ending, _)| *ending == own);
    known.or_else(|| ENDINGS.iter().find(|(_, magic)| bytes.starts_with(magic))).map_or(".tga", |row| row.0)
}
