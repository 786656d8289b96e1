//! Cache of meshes and pictures between compilations: watching a scene only reloads what changed.

use super::decoded::Encoding;
use crate::world::MeshTree;
use durer_scene::dialect::Rules;
use durer_scene::source::{Digest, Stamp};
use durer_scene::texture::Texture;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Source of a cached item.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Origin {
    /// A file with its modification stamp.
    File(Stamp),
    /// Bytes or numbers in memory.
    Memory(Digest),
}

/// Cached meshes with their trees, and cached pictures.
#[derive(Debug, Default)]
pub struct AssetCache(Mutex<CacheEntries>);

#[derive(Debug, Default)]
struct CacheEntries {
    /// Rules with which the meshes were built.
    rules: Option<Rules>,
    meshes: Items<Origin, Arc<MeshTree>>,
    pictures: Items<(Origin, Encoding), Texture>,
}

/// Cached items by source.
#[derive(Debug)]
struct Items<K, V> {
    all: HashMap<K, Item<V>>,
    made: usize,
    reused: usize,
}

/// A cached item, and the hash of its file.
#[derive(Clone, Debug)]
pub(super) struct Item<V> {
    pub value: V,
    pub digest: Option<Digest>,
    /// True if the current or latest compilation uses it.
    used: bool,
}

/// Statistics of the cache for the latest compilation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reuse {
    /// Number of items that were read and built.
    pub made: usize,
    /// Number of items that were reused.
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

    fn put(&mut self, key: K, value: V, digest: Option<Digest>) {
        self.made += 1;
        self.all.insert(key, Item { value, digest, used: true });
    }

    fn begin(&mut self) {
        (self.made, self.reused) = (0, 0);
        self.all.values_mut().for_each(|item| item.used = false);
    }
}

impl AssetCache {
    fn inside(&self) -> MutexGuard<'_, CacheEntries> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Starts a compilation. Other rules make other meshes, so they clear the cache.
    pub(super) fn begin(&self, rules: &Rules) {
        let mut inside = self.inside();
        if inside.rules.as_ref() != Some(rules) {
            *inside = CacheEntries { rules: Some(rules.clone()), ..CacheEntries::default() };
        }
        inside.meshes.begin();
        inside.pictures.begin();
    }

    /// Ends a compilation; drops unused items.
    pub(super) fn finish(&self) {
        let mut inside = self.inside();
        inside.meshes.all.retain(|_, item| item.used);
        inside.pictures.all.retain(|_, item| item.used);
    }

    /// Returns a cached mesh.
    pub(super) fn mesh(&self, origin: &Origin) -> Option<Item<Arc<MeshTree>>> {
        self.inside().meshes.get(origin)
    }

    /// Adds a mesh.
    pub(super) fn keep_mesh(&self, origin: Origin, mesh: &Arc<MeshTree>, digest: Option<Digest>) {
        self.inside().meshes.put(origin, Arc::clone(mesh), digest);
    }

    /// Returns a cached picture.
    pub(super) fn picture(&self, origin: &Origin, encoding: Encoding) -> Option<Item<Texture>> {
        self.inside().pictures.get(&(origin.clone(), encoding))
    }

    /// Adds a picture.
    pub(super) fn keep_picture(&self, origin: Origin, encoding: Encoding, texture: &Texture, digest: Option<Digest>) {
        self.inside().pictures.put((origin, encoding), texture.clone(), digest);
    }

    /// Returns the numbers of meshes and pictures built and reused in the latest compilation.
    pub fn reuse(&self) -> Reuse {
        let inside = self.inside();
        Reuse { made: inside.meshes.made + inside.pictures.made, reused: inside.meshes.reused + inside.pictures.reused }
    }
}
