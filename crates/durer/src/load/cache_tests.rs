//! Tests that unchanged files in the cache are neither read nor built again.

use super::*;
use durer_render::compile::CacheStatistics;
use durer_scene::source::Digest;
use std::collections::BTreeSet;
use std::fs;
use std::time::SystemTime;

const SCENE: &str = "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }
Lights { PointLight { position 0 0 5 color 1 1 1 } }
Materials { PhongMaterial { diffuseColor 1 1 1 texture a.ppm } PrincipledMaterial { baseColorTexture b.ppm } }
Group { MaterialIndex 0 TriangleMesh { obj_file a.obj } MaterialIndex 1 TriangleMesh { obj_file b.obj } }";
const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";

/// A temporary folder that contains a scene with its meshes and pictures, together with a cache for
/// loading the scene.
struct TestFolder {
    folder: tempfile::TempDir,
    cache: Option<Arc<AssetCache>>,
}

impl TestFolder {
    fn new() -> Self {
        let place = TestFolder { folder: tempfile::tempdir().unwrap(), cache: Some(Arc::default()) };
        place.put("scene.txt", SCENE.as_bytes());
        ["a.obj", "b.obj"].iter().for_each(|name| place.put(name, MESH.as_bytes()));
        ["a.ppm", "b.ppm"].iter().for_each(|name| place.put(name, b"P6 1 1 255\n\x01\x02\x03"));
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn put(&self, name: &str, content: &[u8]) {
        fs::write(self.path(name), content).unwrap();
    }

    /// Replaces a file with one of the same size and modification time.
    fn replace(&self, name: &str, content: &[u8]) {
        let old = fs::metadata(self.path(name)).unwrap();
        assert_eq!(old.len(), content.len() as u64);
        self.put(name, content);
        self.date(name, old.modified().unwrap());
    }

    fn date(&self, name: &str, when: SystemTime) {
        fs::File::options().write(true).open(self.path(name)).unwrap().set_modified(when).unwrap();
    }

    /// Returns the digest of the world and the files that were read, or `None` if there are errors.
    fn world(&self, scene: &str, cache: bool) -> Option<(Digest, BTreeSet<PathBuf>)> {
        let options =
            LoadOptions { cache: self.cache.clone().filter(|_| cache), dialect: None, ..LoadOptions::default() };
        let (mut files, mut found) = (Files::default(), Diagnostics::default());
        let loaded = load(&self.path(scene), &options, &mut files, &mut found).unwrap()?;
        let world = loaded.compile(&options, &mut files, &mut found)?;
        Some((world.digest(), loaded.files().into_iter().collect()))
    }

    /// Checks that the cache does not change the world. Returns the numbers of reused items.
    #[track_caller]
    fn watched(&self, scene: &str) -> (usize, usize) {
        assert_eq!(self.world(scene, true).unwrap(), self.world(scene, false).unwrap());
        self.reuse()
    }

    fn reuse(&self) -> (usize, usize) {
        let CacheStatistics { built, reused } = self.cache.as_ref().unwrap().statistics();
        (built, reused)
    }
}

#[test]
fn unchanged_files_are_not_read_again() {
    let place = TestFolder::new();
    assert_eq!(place.watched("scene.txt"), (4, 0));
    place.put("scene.txt", SCENE.replace("color 1 1 1 }", "color 1 0 0 }").as_bytes());
    assert_eq!(place.watched("scene.txt"), (0, 4));
    // A mesh file that is overwritten is read again, even if its size and time stay the same. Only
    // Unix records when a file was changed.
    place.replace("a.obj", format!("{:1$}", "f 7 8 9", MESH.len()).as_bytes());
    assert_eq!(place.world("scene.txt", true).is_none(), cfg!(unix));
    assert!(place.world("scene.txt", false).is_none());
    place.replace("a.obj", MESH.as_bytes());
    place.watched("scene.txt");
    // Change the size of one file and the modification time of another.
    place.put("b.obj", [MESH, MESH].concat().as_bytes());
    place.date("b.ppm", SystemTime::UNIX_EPOCH);
    assert_eq!(place.watched("scene.txt"), (2, 2));
    assert_eq!(place.watched("scene.txt"), (0, 4));
}

#[test]
fn cache_survives_errors_and_drops_unused_files() {
    let place = TestFolder::new();
    assert_eq!(place.watched("scene.txt"), (4, 0));
    place.put("scene.txt", SCENE.replace("b.obj", "c.obj").as_bytes());
    assert!(place.world("scene.txt", true).is_none());
    place.put("scene.txt", SCENE.as_bytes());
    assert_eq!(place.watched("scene.txt"), (0, 4));
    place.put("scene.txt", SCENE.replace("b.obj", "a.obj").replace("texture a.ppm", "").as_bytes());
    assert_eq!(place.watched("scene.txt"), (0, 2));
    place.put("scene.txt", SCENE.as_bytes());
    assert_eq!(place.watched("scene.txt"), (2, 2));
}

#[test]
fn meshes_and_pictures_of_models_are_compared_by_content() {
    let place = TestFolder::new();
    place.put("a.mtl", b"newmtl m\nmap_Kd a.ppm\n");
    let model = |more: &str| place.put("m.obj", format!("{more}mtllib a.mtl\nusemtl m\n{MESH}").as_bytes());
    model("");
    assert_eq!(place.watched("m.obj"), (2, 0));
    model("# the same\n");
    assert_eq!(place.watched("m.obj"), (0, 2));
    place.put("m.obj", format!("mtllib a.mtl\nusemtl m\n{}", MESH.replace("v 1 0 0", "v 2 0 0")).as_bytes());
    assert_eq!(place.watched("m.obj"), (1, 1));
}
