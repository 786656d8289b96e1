use super::*;
use std::os::unix::fs::symlink;

/// Creates `outside/secret.obj` and `scene/{near.obj, models/cube.obj}`, and returns a source that
/// reads from `scene`.
fn house() -> (tempfile::TempDir, FolderSource) {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir_all(root.path().join("scene/models")).unwrap();
    fs::create_dir(root.path().join("outside")).unwrap();
    for (name, text) in
        [("outside/secret.obj", "secret"), ("scene/near.obj", "near"), ("scene/models/cube.obj", "cube")]
    {
        fs::write(root.path().join(name), text).unwrap();
    }
    let source = FolderSource::new(root.path().join("scene"));
    (root, source)
}

#[test]
fn files_below_the_folder_are_read_with_either_separator() {
    let (_root, source) = house();
    for name in ["models/cube.obj", "models\\cube.obj", "./models/../models/cube.obj", ".\\models//cube.obj"] {
        assert_eq!(&*source.read(name).unwrap(), b"cube", "{name}");
        assert!(source.contains(name));
    }
}

#[test]
fn names_match_across_case_and_percent_escapes() {
    let (root, source) = house();
    fs::write(root.path().join("scene/my mesh.obj"), "blank").unwrap();
    for (name, text) in [
        ("Models/CUBE.obj", "cube"),
        ("nowhere/../near.obj", "near"),
        ("my%20mesh.obj", "blank"),
        ("MODELS/../My%20Mesh.OBJ", "blank"),
    ] {
        assert_eq!(&*source.read(name).unwrap(), text.as_bytes(), "{name}");
        assert!(source.contains(name));
    }
    for name in ["nowhere/../../outside/secret.obj", "../OUTSIDE/secret.obj", "%2e%2e/outside/secret.obj"] {
        assert!(!source.contains(name) && source.read(name).is_err(), "{name}");
    }
}

#[test]
fn nothing_outside_the_folder_is_read_unless_allowed() {
    let (root, source) = house();
    symlink(root.path().join("outside/secret.obj"), root.path().join("scene/link.obj")).unwrap();
    symlink(root.path().join("outside"), root.path().join("scene/folder")).unwrap();
    let absolute = root.path().join("outside/secret.obj").display().to_string();
    let names = ["../outside/secret.obj", "..\\outside\\secret.obj", "link.obj", "folder/secret.obj", &absolute];
    for name in names {
        assert!(matches!(source.read(name), Err(SourceError::Outside { .. })), "{name}");
        assert!(!source.contains(name));
    }
    let free = source.clone().allow_outside();
    for name in names {
        assert_eq!(&*free.read(name).unwrap(), b"secret", "{name}");
    }
    // A link to a file inside the allowed folder may be followed.
    symlink("models/cube.obj", root.path().join("scene/inner.obj")).unwrap();
    assert_eq!(&*source.read("inner.obj").unwrap(), b"cube");
}

#[test]
fn missing_file_suggests_a_name_from_inside_only() {
    let (_root, source) = house();
    let similar = |name: &str| match source.read(name) {
        Err(SourceError::Missing { similar, tried, .. }) => {
            assert!(!tried.is_empty());
            similar
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(similar("neat.obj").as_deref(), Some("near.obj"));
    assert_eq!(similar("models/Cubes.OBJ").as_deref(), Some("cube.obj"));
    assert_eq!(similar("near.png"), None);
    // A wrong name of a folder is compared with the folders beside it.
    assert_eq!(similar("modles/cube.obj").as_deref(), Some("models"));
    assert_eq!(similar("nearobj/cube.obj"), None);
    assert_eq!(similar("nothing/like/it.txt"), None);
    assert_eq!(similar("../outside/secrets.obj"), None);
}

#[test]
fn each_searched_path_is_listed_once() {
    let (root, source) = house();
    let source = source.search_in(root.path().join("scene/./."), true).search_in(root.path().join("outside"), false);
    let Err(SourceError::Missing { tried, .. }) = source.read("a/b.obj") else { panic!() };
    assert_eq!(tried, [root.path().join("scene/a/b.obj"), root.path().join("outside/a/b.obj")]);
}

#[test]
fn folders_pipes_and_devices_are_rejected() {
    let (root, source) = house();
    let pipe = root.path().join("scene/pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for name in ["models", ".", "pipe"] {
        assert!(matches!(source.read(name), Err(SourceError::NotAFile { .. })), "{name}");
    }
    assert!(matches!(source.read("/dev/zero"), Err(SourceError::Outside { .. })));
    assert!(matches!(source.allow_outside().read("/dev/zero"), Err(SourceError::NotAFile { .. })));
}

#[test]
fn budget_covers_all_files() {
    let (_root, source) = house();
    let source = source.budget(7);
    assert_eq!(&*source.read("near.obj").unwrap(), b"near");
    match source.read("models/cube.obj") {
        Err(SourceError::TooLarge { size: 4, left: 3, .. }) => {}
        other => panic!("{other:?}"),
    }
    assert_eq!(&*source.clone().budget(u64::MAX).read("near.obj").unwrap(), b"near");
    assert_eq!(&*source.budget(4).read("near.obj").unwrap(), b"near");
}

#[test]
fn asset_folders_are_searched_by_path_and_bare_name() {
    let (root, source) = house();
    let source = source.assets(root.path().join("outside"));
    for name in ["secret.obj", "models/secret.obj", "C:\\somebody\\secret.obj"] {
        assert_eq!(&*source.read(name).unwrap(), b"secret", "{name}");
    }
    // The scene's own folder takes precedence.
    fs::write(root.path().join("outside/near.obj"), "far").unwrap();
    assert_eq!(&*source.read("near.obj").unwrap(), b"near");
    assert!(matches!(source.read("../../etc/passwd.obj"), Err(SourceError::Missing { .. })));
}

#[test]
fn given_files_take_precedence_and_enter_the_record() {
    let (root, source) = house();
    let in_memory = source
        .clone()
        .add_in_memory("near.obj", b"given".as_slice().into())
        .add_in_memory("none.obj", b"n".as_slice().into());
    assert!(in_memory.contains("none.obj") && !source.contains("none.obj"));
    assert_eq!(
        (&*in_memory.read("near.obj").unwrap(), &*in_memory.read("none.obj").unwrap()),
        (&b"given"[..], &b"n"[..])
    );
    fs::write(root.path().join("scene/near.obj"), "given").unwrap();
    fs::write(root.path().join("scene/none.obj"), "n").unwrap();
    source.read("near.obj").unwrap();
    source.read("none.obj").unwrap();
    assert_eq!(source.record().digest(b""), in_memory.record().digest(b""));
}

#[test]
fn file_is_read_whole_despite_a_wrong_size() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    fs::write(&path, b"0123456789").unwrap();
    let read = |size, most| read_all(fs::File::open(&path).unwrap(), size, most).unwrap().to_vec();
    // The file may have grown or shrunk since its size was determined. The function reads at most
    // one byte beyond the limit.
    for size in [10, 0, 4, 25] {
        assert_eq!(read(size, 100), b"0123456789", "{size}");
    }
    assert_eq!(read(4, 6).len(), 7);
}
