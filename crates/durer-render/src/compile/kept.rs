//! What was made of a scene's files, for the next time that it is compiled: who watches a scene
//! waits for what was changed alone.

use super::decoded::Encoding;
use crate::world::MeshTree;
use durer_scene::dialect::Rules;
use durer_scene::source::{Digest, Stamp};
use durer_scene::texture::Texture;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What something was made of.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Origin {
    /// A file, as it was then.
    File(Stamp),
    /// Bytes or numbers in memory.
    Memory(Digest),
}

/// Meshes with their trees, and pictures of materials.
#[derive(Debug, Default)]
pub struct Kept(Mutex<Inside>);

#[derive(Debug, Default)]
struct Inside {
    /// What the words meant of which the meshes were made.
    rules: Option<Rules>,
    meshes: Items<Origin, Arc<MeshTree>>,
    pictures: Items<(Origin, Encoding), Texture>,
}

/// Things by what they were made of.
#[derive(Debug)]
struct Items<K, V> {
    all: HashMap<K, Item<V>>,
    made: usize,
    reused: usize,
}

/// A thing that was made, and the hash of the file of which it was.
#[derive(Clone, Debug)]
pub(super) struct Item<V> {
    pub thing: V,
    pub digest: Option<Digest>,
    /// Whether the scene that is being compiled, or was last, has it.
    used: bool,
}

/// How many things the scene that was compiled last has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reuse {
    /// Those that were read and built for it.
    pub made: usize,
    /// Those that were there already.
    pub reused: usize,
}

impl<K, V> Default for Items<K, V> {
    fn default() -> Self {
        Items { all: HashMap::new(), made: 0, reused: 0 }
    }
}

impl<K: Eq + Hash, V: Clone> Items<K, V> {
    fn get(&mut self, key: &K) -> Option<Item<V>> {
        let item = self.all.get_mut(key)?;
        self.reused += usize::from(!item.used);
        item.used = true;
        Some(item.clone())
    }

    fn put(&mut self, key: K, thing: V, digest: Option<Digest>) {
        self.made += 1;
        self.all.insert(key, Item { thing, digest, used: true });
    }

    fn begin(&mut self) {
        (self.made, self.reused) = (0, 0);
        self.all.values_mut().for_each(|item| item.used = false);
    }
}

impl Kept {
    fn inside(&self) -> MutexGuard<'_, Inside> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A scene is to be compiled. The same file is another mesh by other rules.
    pub(super) fn begin(&self, rules: &Rules) {
        let mut inside = self.inside();
        if inside.rules.as_ref() != Some(rules) {
            *inside = Inside { rules: Some(rules.clone()), ..Inside::default() };
        }
        inside.meshes.begin();
        inside.pictures.begin();
    }

    /// It was compiled: what it does not have is let go.
    pub(super) fn finish(&self) {
        let mut inside = self.inside();
        inside.meshes.all.retain(|_, item| item.used);
        inside.pictures.all.retain(|_, item| item.used);
    }

    /// A mesh that was made.
    pub(super) fn mesh(&self, origin: &Origin) -> Option<Item<Arc<MeshTree>>> {
        self.inside().meshes.get(origin)
    }

    /// Keeps a mesh.
    pub(super) fn keep_mesh(&self, origin: Origin, mesh: &Arc<MeshTree>, digest: Option<Digest>) {
        self.inside().meshes.put(origin, Arc::clone(mesh), digest);
    }

    /// A picture that was decoded.
    pub(super) fn picture(&self, origin: &Origin, encoding: Encoding) -> Option<Item<Texture>> {
        self.inside().pictures.get(&(origin.clone(), encoding))
    }

    /// Keeps a picture.
    pub(super) fn keep_picture(&self, origin: Origin, encoding: Encoding, texture: &Texture, digest: Option<Digest>) {
        self.inside().pictures.put((origin, encoding), texture.clone(), digest);
    }

    /// How many meshes and pictures were made and reused the last time.
    pub fn reuse(&self) -> Reuse {
        let inside = self.inside();
        Reuse { made: inside.meshes.made + inside.pictures.made, reused: inside.meshes.reused + inside.pictures.reused }
    }
}
