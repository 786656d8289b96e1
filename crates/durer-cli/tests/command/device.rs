//! Tests the option `--device`.

use crate::common::TestFolder;

const RENDER: &str = "render scene.txt -o picture.png --size 40x30 --hash";

#[test]
fn cpu_is_the_default_and_the_same_picture() {
    let folder = TestFolder::new();
    let plain = folder.expect_exit(0, &format!("{RENDER} --quiet"));
    assert_eq!(folder.expect_exit(0, &format!("{RENDER} --quiet --device cpu")).out, plain.out);
    assert!(folder.expect_exit(2, &format!("{RENDER} --device tpu")).err.contains("--device"));
}

#[cfg(not(feature = "gpu"))]
#[test]
fn without_the_feature_the_reason_is_given() {
    let folder = TestFolder::new();
    folder.expect_failure(2, &format!("{RENDER} --device gpu"), &["built without", "--features gpu"]);
    let plain = folder.expect_exit(0, &format!("{RENDER} --quiet"));
    let auto = folder.expect_exit(0, &format!("{RENDER} --device auto"));
    assert!(auto.err.contains("note: rendering on the CPU: this `durer` was built without"), "{}", auto.err);
    assert!(auto.out.ends_with(&plain.out), "{} {}", auto.out, plain.out);
    assert!(!folder.expect_exit(0, &format!("{RENDER} --quiet --device auto")).err.contains("note"));
}

#[cfg(feature = "gpu")]
#[test]
fn gpu_renders_what_it_can_and_refuses_the_rest_by_name() {
    let folder = TestFolder::new();
    let torus = "PerspectiveCamera { center 0 1 8 direction 0 -0.1 -1 up 0 1 0 angle 40 }
        Group { Torus { center 0 0 0 majorRadius 1 minorRadius 0.3 } }";
    folder.write("torus.txt", torus);
    let first = folder.run(&format!("{RENDER} --device gpu"));
    if first.err.contains("no graphics adapter") {
        eprintln!("skipped: {}", first.err);
        folder.expect_exit(0, &format!("{RENDER} --device auto"));
        return;
    }
    assert_eq!(first.code, Some(0), "{}", first.err);
    let hash = |text: &str| text.lines().last().unwrap_or_default().to_string();
    let again = folder.expect_exit(0, &format!("{RENDER} --device gpu"));
    assert_eq!(hash(&first.out), hash(&again.out));
    assert!(folder.image("picture.png").pixels.iter().any(|color| color.max_element() > 0.1));
    let message = "the GPU cannot render tori yet: remove `--device gpu`, or use `--device auto`";
    folder.expect_failure(2, "render torus.txt -o t.png --size 20x15 --device gpu", &[message]);
    let auto = folder.expect_exit(0, "render torus.txt -o t.png --size 20x15 --device auto");
    assert!(auto.err.contains("note: rendering on the CPU: the "), "{}", auto.err);
    folder.expect_failure(2, &format!("{RENDER} --device gpu --pixel 3,4"), &["--pixel needs the CPU"]);
}

#[cfg(feature = "gpu")]
#[test]
fn parts_of_cpu_and_gpu_do_not_merge() {
    let folder = TestFolder::new();
    let shard = |index: u32, device: &str| {
        format!("render scene.txt --size 40x30 --quiet --device {device} --shard {index}/2 -o {device}{index}.part")
    };
    if folder.run(&shard(1, "gpu")).err.contains("no graphics adapter") {
        eprintln!("skipped: there is no graphics adapter");
        return;
    }
    for arguments in [shard(2, "gpu"), shard(1, "cpu"), shard(2, "cpu")] {
        folder.expect_exit(0, &arguments);
    }
    folder.expect_failure(2, "merge cpu1.part gpu2.part -o m.png", &["`device`"]);
    let merged = folder.expect_exit(0, "merge gpu1.part gpu2.part -o m.exr --hash");
    let whole = folder.expect_exit(0, "render scene.txt --size 40x30 --quiet --device gpu -o w.exr --hash");
    assert_eq!(merged.out.lines().last(), whole.out.lines().last());
}
