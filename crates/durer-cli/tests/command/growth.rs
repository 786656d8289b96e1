//! Tests small files and options that describe huge amounts of data. The program must compute the
//! size before it allocates memory, and reject oversized input with an error instead of aborting.
use crate::common::{SCENE, TestFolder};
use std::fmt::Write;

/// Checks that the program rejects a command line with an error while its address space and time
/// are limited.
#[track_caller]
fn refused(folder: &TestFolder, line: &str, words: &str) {
    let script = format!("ulimit -v 900000; export RAYON_NUM_THREADS=2; timeout 60 $DURER {line}");
    let output = folder.shell(&script);
    assert_eq!(output.code, Some(2), "{line}: {}", output.err);
    assert!(output.err.contains(words), "{line}: {}", output.err);
    assert!(output.err.len() < 40_000, "{line}: {}", output.err.len());
}

fn render(file: &str) -> String {
    format!("render {file} --size 8x8 --samples 1 -q --restart -o o.png --threads 2 --memory 256M")
}

/// Returns a Mitsuba scene with 40 elements, each twice as large as the previous one.
fn doubled(first: &str, double: impl Fn(usize) -> String, last: &str) -> String {
    let mut scene =
        format!("<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>\n{first}\n");
    (1..=40).for_each(|i| scene += &double(i));
    scene + last + "</scene>\n"
}

#[test]
fn doubling_in_mitsuba_scene_is_refused() {
    let folder = TestFolder::new();
    let variable = doubled(
        r#"<default name="a0" value="xx"/>"#,
        |i| format!("<default name=\"a{i}\" value=\"$a{0}$a{0}\"/>\n", i - 1),
        r#"<shape type="sphere"><string name="x" value="$a40"/></shape>"#,
    );
    folder.write("variable.xml", variable);
    refused(
        &folder,
        &render("variable.xml"),
        "this value is longer than 1048576 bytes after its variables are replaced",
    );
    let many = r#"<shape type="sphere"><string name="x" value="$a18"/></shape>"#.repeat(2000);
    let values = doubled(
        r#"<default name="a0" value="xx"/>"#,
        |i| format!("<default name=\"a{i}\" value=\"$a{0}$a{0}\"/>\n", (i - 1).min(17)),
        &many,
    );
    folder.write("values.xml", values);
    refused(&folder, &render("values.xml"), "needs more memory than");
    for (file, words, inner) in [("empty.xml", "objects", ""), ("ball.xml", "objects", r#"<shape type="sphere"/>"#)] {
        let group = |i: usize, inner: &str| format!("<shape type=\"shapegroup\" id=\"g{i}\">{inner}</shape>\n");
        let instance = |i: usize| format!(r#"<shape type="instance"><ref id="g{i}"/></shape>"#);
        let two = |i: usize| group(i, &instance(i - 1).repeat(2));
        folder.write(file, doubled(&group(0, inner), two, &instance(40)));
        refused(&folder, &render(file), "error");
        // This scene has fewer levels, which are within the depth limit.
        let shallow = (1..=25).map(two).collect::<String>();
        let scene = format!("<scene version=\"3.0.0\">{}{shallow}{}</scene>", group(0, inner), instance(25));
        folder.write(file, scene);
        refused(&folder, &render(file), words);
    }
    let shown = r#"<shape type="sphere"><ref id="b30"/></shape>"#;
    for (file, material) in [("blend.xml", "blendbsdf"), ("sides.xml", "twosided")] {
        let first = r#"<bsdf type="diffuse" id="b0"/>"#;
        let both = |i: usize| {
            let part = format!(r#"<ref id="b{}"/>"#, i - 1);
            format!("<bsdf type=\"{material}\" id=\"b{i}\">{part}{part}</bsdf>\n")
        };
        folder.write(file, doubled(first, both, shown));
        refused(&folder, &render(file), "this material consists of more than 4096 materials");
    }
    // The scene contains many copies of a material that is just below the size limit.
    let mut copies = String::from("<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"b0\"/>\n");
    for i in 1..=11 {
        let part = format!(r#"<ref id="b{}"/>"#, i - 1);
        let _ = writeln!(copies, "<bsdf type=\"blendbsdf\" id=\"b{i}\">{part}{part}</bsdf>");
    }
    for i in 0..3000 {
        let mask = format!(r#"<bsdf type="mask" id="m{i}"><ref id="b11"/></bsdf>"#);
        let _ = writeln!(copies, "{mask}<shape type=\"sphere\"><ref id=\"m{i}\"/></shape>");
    }
    folder.write("copies.xml", copies + "</scene>");
    refused(&folder, &render("copies.xml"), "needs more memory than");
}

#[test]
fn doubling_names_in_scene_are_refused() {
    let folder = TestFolder::new();
    for inner in ["Group { }", "Sphere { center 0 0 0 radius 1 }"] {
        let mut text = format!("define a0 {inner}\n");
        (1..=40).for_each(|i| text += &format!("define a{i} Group {{ use a{0} use a{0} }}\n", i - 1));
        folder.write("a.txt", SCENE.replace("Group {", &format!("{text} Group {{ use a40")));
        refused(&folder, &format!("{} --dialect durer", render("a.txt")), "objects");
    }
}

/// Returns a glTF file whose nodes share a mesh. If `copies` is greater than 0, each node has that
/// many instances.
fn gltf(nodes: usize, primitives: usize, copies: usize) -> String {
    // The buffer contains only three vertices and the instance translations.
    let zeros = |count: usize| "A".repeat(count.div_ceil(3) * 4);
    let bytes = (12 * copies).max(36);
    let primitive = r#"{"attributes":{"POSITION":0},"indices":2}"#;
    let extension = match copies {
        0 => String::new(),
        _ => r#","extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1}}}"#.into(),
    };
    let list = |count: usize, item: &str| vec![item; count].join(",");
    let roots: Vec<String> = (0..nodes).map(|i| i.to_string()).collect();
    format!(
        r#"{{"asset":{{"version":"2.0"}},"extensionsUsed":["EXT_mesh_gpu_instancing"],
        "buffers":[{{"byteLength":{total},"uri":"data:application/octet-stream;base64,AAABAAIA{data}"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":6}},{{"buffer":0,"byteOffset":8,"byteLength":{bytes}}}],
        "accessors":[{{"bufferView":1,"componentType":5126,"type":"VEC3","count":3,"min":[0,0,0],"max":[0,0,0]}},
        {{"bufferView":1,"componentType":5126,"type":"VEC3","count":{copied}}},
        {{"bufferView":0,"componentType":5123,"type":"SCALAR","count":3}}],
        "meshes":[{{"primitives":[{primitives}]}}],"nodes":[{nodes}],"scenes":[{{"nodes":[{roots}]}}]}}"#,
        total = 8 + bytes,
        data = zeros(bytes + 2),
        copied = copies.max(1),
        primitives = list(primitives, primitive),
        nodes = list(nodes, &format!(r#"{{"mesh":0{extension}}}"#)),
        roots = roots.join(","),
    )
}

#[test]
fn gltf_has_same_object_limit_as_other_scenes() {
    let folder = TestFolder::new();
    for (nodes, primitives, copies) in [(1, 5000, 5000), (5000, 5000, 0), (50, 50, 5000)] {
        folder.write("many.gltf", gltf(nodes, primitives, copies));
        refused(&folder, &render("many.gltf"), "the scene has more than 1048576 objects");
    }
}

#[test]
fn rows_that_no_file_holds_count_as_memory() {
    let folder = TestFolder::new();
    let model = |attributes: &str, count: u32, more: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0{attributes}}}{more}}}]}}],
            "accessors":[{{"componentType":5126,"type":"VEC3","count":{count},"min":[0,0,0],"max":[1,1,1]}},
            {{"componentType":5126,"type":"VEC4","count":{count}}},{{"componentType":5125,"type":"SCALAR","count":{count}}}]}}"#
        )
    };
    for (attributes, count, more) in [
        ("", 16_777_218, ""),
        ("", 12_000_000, ""),
        ("", 4_000_000_000, ""),
        (r#","COLOR_0":1"#, 9_000_000, ""),
        ("", 12_000_000, r#","indices":2"#),
        ("", 12_000_000, r#","mode":5"#),
        ("", 6_000_000, r#","mode":0"#),
    ] {
        folder.write("rows.gltf", model(attributes, count, more));
        let script = format!("ulimit -v 900000; export RAYON_NUM_THREADS=2; timeout 60 $DURER {}", render("rows.gltf"));
        let output = folder.shell(&script);
        assert_eq!(output.code, Some(2), "{count} {attributes} {more}: {}", output.err);
        assert!(output.err.contains("memory"), "{count} {attributes} {more}: {}", output.err);
    }
}

/// Returns a JPEG that has empty scan data and components with the given sampling factors.
fn jpeg(kind: u8, [width, height]: [u16; 2], factors: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0xff, 0xd8];
    let mut segment = |kind: u8, content: &[u8]| {
        bytes.extend([0xff, kind]);
        bytes.extend((content.len() as u16 + 2).to_be_bytes());
        bytes.extend(content);
    };
    segment(0xdb, &[&[0][..], &[1; 64]].concat());
    let ([w1, w0], [h1, h0]) = (width.to_be_bytes(), height.to_be_bytes());
    let mut frame = vec![8, h1, h0, w1, w0, factors.len() as u8];
    (1..).zip(factors).for_each(|(id, factor)| frame.extend([id, *factor, 0]));
    segment(kind, &frame);
    for class in [0, 0x10] {
        segment(0xc4, &[&[class, 1][..], &[0; 15], &[0]].concat());
    }
    let mut scan = vec![factors.len() as u8];
    (1..=factors.len() as u8).for_each(|id| scan.extend([id, 0]));
    segment(0xda, &[&scan[..], &[0, 0, 0]].concat());
    bytes.extend([0; 64]);
    bytes.extend([0xff, 0xd9]);
    bytes
}

#[test]
fn photographs_take_the_memory_that_their_heads_announce() {
    let folder = TestFolder::new();
    folder.write("texture.txt", SCENE.replace("Material { diffuse", "PhongMaterial { texture p.jpg diffuse"));
    for (size, factors) in [
        ([65_500, 64], &[0x44, 0x11, 0x11][..]),
        ([65_500, 1], &[0x44, 0x44, 0x44]),
        ([2000, 2000], &[0x11, 0x22, 0x22]),
        ([2000, 2000], &[0x22, 0x11, 0x11, 0x22]),
    ] {
        for kind in [0xc0, 0xc1, 0xc2] {
            folder.write("p.jpg", jpeg(kind, size, factors));
            // The address space is large enough for the program and for `--memory` but not for the
            // decoded picture.
            let script = "ulimit -v 500000; export RAYON_NUM_THREADS=2; \
                timeout 60 $DURER render texture.txt --dialect durer --size 8x8 --samples 1 -q --restart -o o.png \
                --threads 2 --memory 16M";
            let output = folder.shell(script);
            assert!(
                matches!(output.code, Some(0 | 2)),
                "{size:?} {factors:?} {kind:x}: {:?} {}",
                output.code,
                output.err
            );
        }
    }
}

#[test]
fn large_pictures_under_limits_of_the_system_are_errors() {
    let folder = TestFolder::new();
    for options in ["--size 268435456x1", "--size 1x268435456", "--size 268435456x1 --memory 64G"] {
        let line = format!("render scene.txt {options} --samples 1 -q --restart -o o.pfm --threads 2");
        let script = format!("ulimit -v 900000; export RAYON_NUM_THREADS=2; timeout 20 $DURER {line}");
        let output = folder.shell(&script);
        // A tall picture is rendered in bands, which takes longer.
        assert!(matches!(output.code, Some(2 | 124)), "{options}: {:?} {}", output.code, output.err);
        assert!(output.code == Some(124) || output.err.contains("memory"), "{options}: {}", output.err);
    }
    let sizes = ["--size 16384x16384", "--size 16384x16384 --memory 64G"];
    for command in
        ["render scene.txt -o o.png --show color,depth,normals", "render scene.txt -o o.png --filter gaussian"]
    {
        for size in sizes {
            let script = format!(
                "ulimit -v 900000; export RAYON_NUM_THREADS=2; timeout 20 $DURER {command} {size} -q --restart --samples 1 --threads 2"
            );
            let output = folder.shell(&script);
            assert!(matches!(output.code, Some(2 | 124)), "{command} {size}: {:?} {}", output.code, output.err);
        }
    }
    for line in [
        "course -input scene.txt -size 16384 16384 -output o.tga",
        "lesson scene.txt -o lesson --size 16384x16384 --samples 1",
        "photo place scene.txt --backplate o.png -o p.png",
    ] {
        let script = format!("ulimit -v 500000; export RAYON_NUM_THREADS=2; timeout 20 $DURER {line}");
        let output = folder.shell(&script);
        assert!(matches!(output.code, Some(0..=2 | 124)), "{line}: {:?} {}", output.code, output.err);
    }
}

#[test]
fn scene_file_larger_than_memory_is_an_error() {
    let folder = TestFolder::new();
    // The file is sparse, so that it takes no space on the disk.
    for name in ["big.txt", "big.ply", "big.gltf"] {
        std::fs::File::create(folder.path(name)).unwrap().set_len(2 << 30).unwrap();
        let output = folder.shell(&format!("ulimit -v 1500000; timeout 20 $DURER info {name}"));
        assert_eq!(output.code, Some(2), "{name}: {}", output.err);
        assert!(output.err.contains("is too large: 2147483648 bytes"), "{name}: {}", output.err);
    }
}

#[test]
fn too_little_address_space_is_an_error() {
    let folder = TestFolder::new();
    for limit in [90_000, 150_000, 240_000] {
        for line in ["render scene.txt -o o.png --size 64x64 -q", "check scene.txt", "lesson scene.txt -o l.html"] {
            let output = folder.shell(&format!("ulimit -v {limit}; RAYON_NUM_THREADS=2 timeout 20 $DURER {line}"));
            assert!(matches!(output.code, Some(0 | 1)), "{limit} {line}: {:?} {}", output.code, output.err);
            assert!(
                output.code == Some(0) || output.err.contains("MiB of address space"),
                "{limit} {line}: {}",
                output.err
            );
        }
    }
}
