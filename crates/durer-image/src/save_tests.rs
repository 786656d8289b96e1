//! Tests of saving files.

use super::*;

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn file_is_created_and_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    save(&path, b"one").unwrap();
    save(&path, b"two").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"two");
    assert_eq!(names(folder.path()), ["a.png"]);
}

#[test]
fn impossible_destinations_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    save(&file, b"old").unwrap();
    assert!(matches!(save(folder.path(), b"x"), Err(SaveError::IsFolder { .. })));
    assert!(matches!(save(folder.path().join("no/a.png"), b"x"), Err(SaveError::NoFolder { .. })));
    let below = save(file.join("a.png"), b"x").unwrap_err();
    assert!(below.to_string().contains("does not exist"), "{below}");
    assert!(matches!(save("", b"x"), Err(SaveError::Io { .. })));
    assert!(matches!(save(folder.path().join("a\0b"), b"x"), Err(SaveError::Io { .. })));
    assert_eq!(fs::read(&file).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["file"]);
}

#[test]
fn of_several_files_all_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
    save(&a, b"old").unwrap();
    let place = |path: &Path| Destination::new(path).unwrap();
    let lost = folder.path().join("lost");
    fs::create_dir(&lost).unwrap();
    let (to_a, to_lost) = (place(&a), place(&lost.join("b")));
    fs::remove_dir(&lost).unwrap();
    assert!(save_all(&[(&to_a, "new"), (&to_lost, "new")]).is_err());
    assert_eq!(fs::read(&a).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["a"]);
    save_all(&[(&to_a, "new"), (&place(&b), "other")]).unwrap();
    assert_eq!((fs::read(&a).unwrap(), fs::read(&b).unwrap()), (b"new".to_vec(), b"other".to_vec()));
}

#[cfg(unix)]
#[test]
fn permissions_are_those_of_an_ordinary_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;
    let [ordinary, saved] = ["ordinary", "saved"].map(|name| folder.path().join(name));
    fs::write(&ordinary, "").unwrap();
    save(&saved, b"").unwrap();
    assert_eq!(mode(&saved), mode(&ordinary));
    fs::set_permissions(&saved, PermissionsExt::from_mode(0o640)).unwrap();
    save(&saved, b"x").unwrap();
    assert_eq!(mode(&saved), 0o640);
}

#[cfg(unix)]
#[test]
fn a_symbolic_link_stays_one() {
    let folder = tempfile::tempdir().unwrap();
    let [real, link] = ["real", "link"].map(|name| folder.path().join(name));
    save(&real, b"old").unwrap();
    std::os::unix::fs::symlink("real", &link).unwrap();
    save(&link, b"new").unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&real).unwrap(), b"new");
}

#[cfg(target_os = "linux")]
#[test]
fn devices_are_written_to_directly() {
    use std::os::unix::fs::FileTypeExt;
    save("/dev/null", b"x").unwrap();
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());

    // The device `/dev/full` is always full. A file that is saved together with it stays unchanged.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    save(&path, b"old").unwrap();
    let place = |path: &Path| Destination::new(path).unwrap();
    let error = save_all(&[(&place(&path), b"new"), (&place(Path::new("/dev/full")), b"new")]).unwrap_err();
    assert!(error.to_string().starts_with("cannot write `/dev/full`: No space left"), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["a"]);
}

#[cfg(unix)]
#[test]
fn links_that_lead_nowhere_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [dangling, one, two] = ["dangling", "one", "two"].map(|name| folder.path().join(name));
    std::os::unix::fs::symlink("missing", &dangling).unwrap();
    std::os::unix::fs::symlink("two", &one).unwrap();
    std::os::unix::fs::symlink("one", &two).unwrap();
    for path in [dangling, one] {
        assert!(matches!(save(&path, b"x"), Err(SaveError::BrokenLink { .. })));
        assert!(fs::symlink_metadata(&path).unwrap().is_symlink());
    }
    assert_eq!(names(folder.path()), ["dangling", "one", "two"]);
}

#[cfg(unix)]
#[test]
fn pipes_are_written_through_or_refused() {
    use std::io::Read;
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    assert!(matches!(Destination::new(&pipe), Err(SaveError::NoReader { .. })));
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || {
            let mut bytes = Vec::new();
            File::open(pipe).unwrap().read_to_end(&mut bytes).unwrap();
            bytes
        }
    });
    let place = loop {
        match Destination::new(&pipe) {
            Err(SaveError::NoReader { .. }) => std::thread::yield_now(),
            place => break place.unwrap(),
        }
    };
    // The data is larger than the capacity of a pipe.
    let bytes = vec![7; 1 << 20];
    save_all(&[(&place, &bytes)]).unwrap();
    drop(place);
    assert!(reader.join().unwrap() == bytes);
    let socket = folder.path().join("socket");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    assert!(matches!(Destination::new(&socket), Err(SaveError::NotAFile { .. })));
}
