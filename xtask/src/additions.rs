//! `cargo xtask additions`: measures how much must be changed to add a feature of each kind. Adds
//! features to a copy of the sources, builds the copy and uses them.

use crate::root;
use anyhow::{Context, Result, bail, ensure};
use std::path::Path;
use std::process::{Command, ExitCode};

/// A feature that `cargo xtask additions` adds: its kind, its file, and its entries in existing
/// lists. An entry consists of the list's file, the text to insert before, and the text to insert.
struct Addition {
    kind: &'static str,
    file: &'static str,
    content: &'static str,
    words: &'static [(&'static str, &'static str, &'static str)],
}

const SHAPES: &str = "durer-scene/src/shape/mod.rs";
const CAMERAS: &str = "durer-scene/src/camera/mod.rs";
const LIGHTS: &str = "durer-scene/src/light/mod.rs";
const MATERIALS: &str = "durer-scene/src/material/mod.rs";
const LOBES: &str = "durer-scene/src/bsdf/lobe/mod.rs";
const INTEGRATORS: &str = "durer-render/src/integrator/mod.rs";
const PICTURES: &str = "durer-image/src/formats.rs";
const FORMATS: &str = "durer-formats/src/lib.rs";
const SCENES: &str = "durer-formats/src/scene.rs";
const EXPORT: &str = "durer-formats/src/export/light.rs";
const GLTF: &str = "durer-formats/src/gltf/write/mod.rs";
const AOVS: &str = "durer-render/src/film/aov.rs";

const ADDITIONS: &[Addition] = &[
    Addition {
        kind: "primitive",
        file: "durer-scene/src/shape/octahedron.rs",
        content: include_str!("additions/octahedron.rs"),
        words: &[
            (SHAPES, "pub mod plane;", "pub mod octahedron;\n"),
            (SHAPES, "Plane(plane::Plane),", "Octahedron(octahedron::Octahedron),\n        "),
        ],
    },
    Addition {
        kind: "camera",
        file: "durer-scene/src/camera/oblique.rs",
        content: include_str!("additions/oblique.rs"),
        words: &[
            (CAMERAS, "pub mod omnimax;", "pub mod oblique;\n"),
            (CAMERAS, "Orthographic(orthographic::OrthographicCamera),", "Oblique(oblique::ObliqueCamera),\n        "),
        ],
    },
    Addition {
        kind: "light",
        file: "durer-scene/src/light/glow.rs",
        content: include_str!("additions/glow.rs"),
        words: &[
            (LIGHTS, "pub mod photometric;", "pub mod glow;\n"),
            (LIGHTS, "Point(point::PointLight),", "Glow(glow::GlowLight),\n        "),
            (EXPORT, "            Light::Photometric(_) => {", "            Light::Glow(_) => None,\n"),
            (GLTF, "            Light::Photometric(_) => {", "            Light::Glow(_) => return None,\n"),
        ],
    },
    Addition {
        kind: "material",
        file: "durer-scene/src/material/stripes.rs",
        content: include_str!("additions/stripes.rs"),
        words: &[
            (MATERIALS, "pub mod wood;", "pub mod stripes;\n"),
            (MATERIALS, "Noise(solid_noise::SolidNoise),", "Stripes(stripes::Stripes),\n        "),
        ],
    },
    Addition {
        kind: "lobe",
        file: "durer-scene/src/bsdf/lobe/retro.rs",
        content: include_str!("additions/retro.rs"),
        words: &[
            (LOBES, "pub mod rough;", "pub mod retro;\n"),
            (LOBES, "Mirror(glass::Mirror),", "Retro(retro::Retro),\n    /// A perfect mirror.\n    "),
        ],
    },
    Addition {
        kind: "integrator",
        file: "durer-render/src/integrator/hits.rs",
        content: include_str!("additions/hits.rs"),
        words: &[
            (INTEGRATORS, "pub mod media;", "pub mod hits;\n"),
            (INTEGRATORS, "Path(path::PathOptions),", "Hits(hits::HitsParameters),\n    "),
        ],
    },
    Addition {
        kind: "scene format",
        file: "durer-formats/src/balls.rs",
        content: include_str!("additions/balls.rs"),
        words: &[
            (FORMATS, "pub mod asset_export;", "mod balls;\n"),
            (SCENES, "    single_mesh_format(&ply::FORMAT),", "    super::balls::FORMAT,\n"),
        ],
    },
    Addition {
        kind: "mesh format",
        file: "durer-formats/src/corners.rs",
        content: include_str!("additions/corners.rs"),
        words: &[
            (FORMATS, "pub mod course;", "mod corners;\n"),
            (FORMATS, "off::FORMAT]", "corners::FORMAT, "),
            (SCENES, "    single_mesh_format(&stl::FORMAT),", "    single_mesh_format(&super::corners::FORMAT),\n"),
        ],
    },
    Addition {
        kind: "picture format",
        file: "durer-image/src/formats/farbfeld.rs",
        content: include_str!("additions/farbfeld.rs"),
        words: &[(PICTURES, "mod hdr;", "mod farbfeld;\n"), (PICTURES, "    pfm::FORMAT,", "    farbfeld::FORMAT,\n")],
    },
    Addition {
        kind: "kind of picture",
        file: "durer-render/src/film/aov/heights.rs",
        content: include_str!("additions/heights.rs"),
        words: &[
            (AOVS, "/// Table of all AOVs in the order in which the help lists them.", "mod heights;\n\n"),
            (AOVS, "    Aov {\n        name: \"normals\"", "    heights::AOV,\n"),
        ],
    },
];

/// A scene that uses the new features.
const SCENE: &str = "ObliqueCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 size 4 slant 0.3 }
Lights { GlowLight { position 2 3 4 color 1 1 1 } }
Materials {
    PhongMaterial { diffuseColor 0.8 0.2 0.1 }
    PhongMaterial { diffuseColor 0.1 0.3 0.8 }
    Stripes { materialIndex 0 materialIndex 1 height 0.25 }
}
Group { MaterialIndex 2 Octahedron { center 0 0 0 radius 1.5 } }
";

/// Runs `cargo xtask additions`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let only = match arguments {
        [] => "",
        [option, text] if option == "--only" => text,
        _ => bail!("cargo xtask additions [--only TEXT]"),
    };
    let root = root()?;
    // Build in a separate folder, so that the real program is not replaced.
    let (copy, built) = (root.join("target/additions"), root.join("target/additions-built"));
    let _ = std::fs::remove_dir_all(&copy);
    std::fs::create_dir_all(&copy)?;
    let files = Command::new("git")
        .args([
            "ls-files",
            "-co",
            "--exclude-standard",
            "crates",
            "web/dist",
            "web/dist-report",
            "xtask",
            "Cargo.toml",
            "Cargo.lock",
        ])
        .current_dir(&root)
        .output()?;
    for name in String::from_utf8(files.stdout)?.lines().filter(|name| root.join(name).is_file()) {
        let to = copy.join(name);
        std::fs::create_dir_all(to.parent().context("a file without a folder")?)?;
        std::fs::copy(root.join(name), to)?;
    }
    let chosen: Vec<&Addition> = ADDITIONS.iter().filter(|addition| addition.kind.contains(only)).collect();
    for addition in &chosen {
        add(&copy.join("crates"), addition).with_context(|| format!("a new {}", addition.kind))?;
    }
    let build = Command::new(crate::cargo())
        .args(["build", "--quiet", "-p", "durer-cli"])
        .env("CARGO_TARGET_DIR", &built)
        .current_dir(&copy)
        .status()?;
    ensure!(build.success(), "the sources do not build with the additions");
    println!("{:16} {:>6} {:>6}", "a new", "places", "lines");
    for addition in &chosen {
        let lines: usize = addition
            .words
            .iter()
            .map(|word| word.2.trim_end().lines().filter(|l| !l.trim().starts_with("///")).count())
            .sum();
        println!("{:16} {:6} {lines:6}", addition.kind, addition.words.len());
    }
    if only.is_empty() {
        used(&built.join("debug/durer"), &copy)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Adds a feature to a copy of the crates.
fn add(crates: &Path, addition: &Addition) -> Result<()> {
    let file = crates.join(addition.file);
    ensure!(!file.exists(), "{} already exists", addition.file);
    std::fs::create_dir_all(file.parent().context("a file without a folder")?)?;
    std::fs::write(file, addition.content)?;
    for (list, before, words) in addition.words {
        let path = crates.join(list);
        let text = std::fs::read_to_string(&path)?;
        ensure!(text.matches(before).count() == 1, "{list} must contain `{before}` exactly once");
        std::fs::write(path, text.replace(before, &format!("{words}{before}")))?;
    }
    Ok(())
}

/// Runs commands that use the new features.
fn used(durer: &Path, folder: &Path) -> Result<()> {
    std::fs::write(folder.join("scene.txt"), SCENE)?;
    std::fs::write(folder.join("a.balls"), "0 0 0 1\n2 0 0 0.5\n")?;
    std::fs::write(folder.join("a.tri"), "0 0 0 1 0 0 0 1 0\n")?;
    for words in [
        "render scene.txt -o a.ff --size 48x48 --show color,heights",
        "render scene.txt -o b.png --size 48x48 --hits-depth 100",
        "render a.balls -o c.png --size 48x32",
        "convert a.tri -o a.ply",
        "convert a.ply -o b.tri",
        "render a.tri -o d.png --size 48x32",
        "words Octahedron",
        "compare a.color.ff a.color.ff",
    ] {
        let done = Command::new(durer).args(words.split(' ')).current_dir(folder).output()?;
        ensure!(done.status.success(), "durer {words}: {}", String::from_utf8_lossy(&done.stderr));
        println!("durer {words}");
    }
    Ok(())
}
