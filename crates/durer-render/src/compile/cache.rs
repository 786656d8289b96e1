//! A cache of meshes and pictures that is kept between compilations. When a watched scene changes,
//! only the files that changed are loaded again.

use super::decoded::Encoding;
use crate::world::MeshTree;
use durer_scene::dialect::DialectRules;
use durer_scene::source::{Digest, Stamp};
use durer_scene::texture::Texture;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Key of a cached mesh or picture. It identifies the file or the data in memory that the item was
/// read from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum AssetKey {
    /// A file and its modification stamp.
    File(Stamp),
    /// Data in memory.
    Memory(Digest),
}

/// Cache of meshes (with their BVHs) and decoded pictures, shared by successive compilations of a
/// scene.
#[derive(Debug, Default)]
pub struct AssetCache(Mutex<CacheEntries>);

/// Contents of an [`AssetCache`], which its mutex protects.
#[derive(Debug, Default)]
struct CacheEntries {
    /// Dialect rules that the cached meshes were built with.
    rules: Option<DialectRules>,
    meshes: AssetTable<AssetKey, Arc<MeshTree>>,
    pictures: AssetTable<(AssetKey, Encoding), Texture>,
}

/// Cached meshes or pictures by key, with the numbers of items built and reused.
#[derive(Debug)]
struct AssetTable<K, V> {
    all: HashMap<K, CachedAsset<V>>,
    built: usize,
    reused: usize,
}

/// A cached mesh or picture with the hash of the file that it was read from.
#[derive(Clone, Debug)]
pub(super) struct CachedAsset<V> {
    pub value: V,
    pub digest: Option<Digest>,
    /// True if the current or latest compilation uses the item.
    used: bool,
}

/// Numbers of meshes and pictures that the latest compilation built or took from the cache.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CacheStatistics {
    /// Number of items that were read and built.
    pub built: usize,
    /// Number of items that were reused.
    pub reused: usize,
}

impl<K, V> Default for AssetTable<K, V> {
    fn default() -> Self {
        AssetTable { all: HashMap::new(), built: 0, reused: 0 }
    }
}

impl<K: Eq + Hash, V: Clone> AssetTable<K, V> {
    fn get(&mut self, key: &K) -> Option<CachedAsset<V>> {
        let item = self.all.get_mut(key)?;
        self.reused += usize::from(!item.used);
        item.used = true;
        Some(item.clone())
    }

    fn put(&mut self, key: K, value: V, digest: Option<Digest>) {
        self.built += 1;
        self.all.insert(key, CachedAsset { value, digest, used: true });
    }

    fn begin(&mut self) {
        (self.built, self.reused) = (0, 0);
        self.all.values_mut().for_each(|item| item.used = false);
    }
}

impl AssetCache {
    fn lock(&self) -> MutexGuard<'_, CacheEntries> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Starts a compilation. Clears the cache if the dialect rules have changed, because meshes
    /// depend on them.
    pub(super) fn begin(&self, rules: &DialectRules) {
        let mut inside = self.lock();
        if inside.rules.as_ref() != Some(rules) {
            *inside = CacheEntries { rules: Some(rules.clone()), ..CacheEntries::default() };
        }
        inside.meshes.begin();
        inside.pictures.begin();
    }

    /// Ends a compilation and removes the items that it did not use.
    pub(super) fn finish(&self) {
        let mut inside = self.lock();
        inside.meshes.all.retain(|_, item| item.used);
        inside.pictures.all.retain(|_, item| item.used);
    }

    /// Returns the cached mesh with this key.
    pub(super) fn mesh(&self, origin: &AssetKey) -> Option<CachedAsset<Arc<MeshTree>>> {
        self.lock().meshes.get(origin)
    }

    /// Adds a mesh.
    pub(super) fn keep_mesh(&self, origin: AssetKey, mesh: &Arc<MeshTree>, digest: Option<Digest>) {
        self.lock().meshes.put(origin, Arc::clone(mesh), digest);
    }

    /// Returns the cached picture with this key and encoding.
    pub(super) fn picture(&self, origin: &AssetKey, encoding: Encoding) -> Option<CachedAsset<Texture>> {
        self.lock().pictures.get(&(origin.clone(), encoding))
    }

    /// Adds a picture.
    pub(super) fn keep_picture(&self, origin: AssetKey, encoding: Encoding, texture: &Texture, digest: Option<Digest>) {
        self.lock().pictures.put((origin, encoding), texture.clone(), digest);
    }

    /// Returns the numbers of meshes and pictures that the latest compilation built and reused.
    pub fn statistics(&self) -> CacheStatistics {
        let inside = self.lock();
        CacheStatistics {
            built: inside.meshes.built + inside.pictures.built,
            reused: inside.meshes.reused + inside.pictures.reused,
        }
    }
}
