//! Attack `names`: file names in inputs that lead out of the input's folder, or to pipes and
//! devices.

use super::{Attack, Outcome, failure_reason};
use anyhow::Result;
use std::os::unix::fs::symlink;
use std::process::Command;

/// Path prefixes that lead back to the same folder.
const INSIDE_PREFIXES: [&str; 6] = ["./", ".//", "sub/../", "./sub/.././", "sub//../", "sub/deep/../../"];
/// Path prefixes that lead out of the folder.
const OUTSIDE_PREFIXES: [&str; 9] =
    ["../", "sub/../../", "..//", "../case/../", "sub/deep/../../../", "up/", "sub/up2/", "%2e%2e/", "..\\"];
/// Devices and pipes that never end.
const ENDLESS_FILES: [&str; 5] = ["/dev/zero", "/dev/stdin", "pipe", "zero", "/proc/self/fd/0"];

/// Input files that refer to another file: path, text with the placeholder `NAME`, name of the
/// secret file, and command.
const INPUTS: [(&str, &str, &str, &str); 12] = [
    (
        "a.txt",
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 } Materials { PhongMaterial { diffuseColor 1 1 1 } } Group { MaterialIndex 0 TriangleMesh { obj_file NAME } }",
        "s.obj",
        "render",
    ),
    (
        "t.txt",
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 } Materials { PhongMaterial { texture NAME diffuseColor 1 1 1 } } Group { MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }",
        "s.ppm",
        "render",
    ),
    (
        "h.txt",
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 } Materials { PhongMaterial { diffuseColor 1 1 1 } } Group { MaterialIndex 0 HeightField { picture NAME min -1 0 -1 max 1 1 1 } }",
        "s.ppm",
        "render",
    ),
    ("i.txt", "include NAME", "s.txt", "render"),
    ("a.obj", "mtllib NAME\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "s.mtl", "render"),
    (
        "a.gltf",
        r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"NAME"}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"min":[-9,-9,-9],"max":[9,9,9]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]}"#,
        "s.bin",
        "render",
    ),
    ("a.pbrt", "Camera \"perspective\" WorldBegin Shape \"plymesh\" \"string filename\" \"NAME\"\n", "s.ply", "render"),
    ("p.pbrt", "Camera \"perspective\" WorldBegin Include \"NAME\" Shape \"sphere\"\n", "s.pbrt", "render"),
    (
        "a.xml",
        r#"<scene version="3.0.0"><sensor type="perspective"/><shape type="obj"><string name="filename" value="NAME"/></shape></scene>"#,
        "s.obj",
        "render",
    ),
    ("b.xml", r#"<scene version="3.0.0"><include filename="NAME"/></scene>"#, "s.xml", "render"),
    (
        "a.rad",
        "void colorpict p\n7 red green blue NAME . u v\n0\n0\np plastic m\n0\n0\n5 .5 .5 .5 0 0\nm sphere s\n0\n0\n4 0 0 0 1\n",
        "s.ppm",
        "render",
    ),
    ("cm/images.txt", "1 1 0 0 0 0 0 5 1 a.png\n16 16 1\n2 1 0 0 0 .1 0 5 1 NAME\n16 16 1\n", "s.png", "tour"),
];

/// Secret files outside the folder, each valid in its own format.
const SECRETS: [(&str, &str); 9] = [
    ("s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    ("s.ppm", "P3 2 2 255 9 9 9 8 8 8 7 7 7 6 6 6\n"),
    (
        "s.txt",
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 } Materials { PhongMaterial { diffuseColor 1 1 1 } } Group { MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }",
    ),
    ("s.mtl", "newmtl m\nKd 1 0 0\n"),
    ("s.bin", "000000000000000000000000000000000000"),
    (
        "s.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    ),
    ("s.pbrt", "Material \"diffuse\"\n"),
    ("s.xml", "<scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>"),
    ("s.png", ""),
];

/// Runs the attack.
pub fn run(attack: &Attack) -> Result<Outcome> {
    for (name, content) in SECRETS {
        attack.put(&format!("case/out/{name}"), content)?;
    }
    let inside = "case/out/in";
    attack.put(&format!("{inside}/sub/deep/x"), "")?;
    attack.put(&format!("{inside}/cm/cameras.txt"), "1 PINHOLE 32 32 30 30 16 16\n")?;
    attack.put(&format!("{inside}/cm/points3D.txt"), "1 0 0 0 255 0 0 0.1 1 0 2 0\n")?;
    symlink("..", attack.path(&format!("{inside}/up")))?;
    symlink("../..", attack.path(&format!("{inside}/sub/up2")))?;
    symlink("/dev/zero", attack.path(&format!("{inside}/zero")))?;
    Command::new("mkfifo").arg(attack.path(&format!("{inside}/pipe"))).status()?;
    attack.put(&format!("{inside}/ball.txt"), SECRETS[2].1)?;
    for picture in ["case/out/in/a.png", "case/out/s.png"] {
        let arguments = ["render", "case/out/in/ball.txt", "--size", "32x32", "--samples", "1", "-q", "-o", picture];
        attack.limited(&arguments, 4_000_000, 60)?;
    }
    let mut failures = Vec::new();
    for number in 0..attack.count {
        let (file, text, secret, command) = INPUTS[attack.random(number, 0, INPUTS.len() as u64)];
        let name = named(attack, number, secret);
        attack.put(&format!("{inside}/{file}"), text.replace("NAME", &name))?;
        let path = format!("{inside}/{file}");
        let folder = format!("{inside}/cm");
        let arguments = match command {
            "tour" => vec!["photo", "tour", &folder, "--pictures", inside, "-q", "-o", "t.html"],
            _ => vec!["render", &path, "--size", "8x8", "--samples", "1", "-q", "--restart", "-o", "o.png"],
        };
        let output = attack.limited(&arguments, 4_000_000, 20)?;
        let messages = String::from_utf8_lossy(&output.stderr);
        // In some formats an unreadable file causes only a warning, and quiet runs print only
        // errors.
        let outcome = output.status.code() == Some(2) || file == "a.obj" && messages.is_empty();
        if let Some(why) = failure_reason(&output).or_else(|| (!outcome).then(|| "it was read".into())) {
            failures.push(format!("{file} names {name:?}: {why}"));
        }
    }
    Ok(Outcome { tried: attack.count, failures, note: String::new() })
}

/// Returns a name that leads to a secret file, to a device or to a pipe.
fn named(attack: &Attack, number: u64, secret: &str) -> String {
    let pick = |place: u32, list: &[&str]| list[attack.random(number, place, list.len() as u64)].to_string();
    if attack.random(number, 1, 5) == 0 {
        return pick(2, &ENDLESS_FILES);
    }
    let idle: String = (0..attack.random(number, 3, 3)).map(|i| pick(4 + i as u32, &INSIDE_PREFIXES)).collect();
    match attack.random(number, 8, 4) {
        0 => attack.path("case/out").join(idle).join(secret).display().to_string(),
        _ => format!("{idle}{}{secret}", pick(9, &OUTSIDE_PREFIXES)),
    }
}
