//! Tests against reports of the Khronos glTF validator, and of accessors and damaged files.

use crate::folder::FolderSource;
use crate::scene::{ReadInput, find_scene_format, read_model};
use durer_diag::{Diagnostics, Files, Severity};
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::{Backs, Walls};
use durer_scene::math::random::Random;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::{Material, Scene, SceneDefaults};
use durer_scene::shape::MeshData;
use durer_scene::texture::Channel;
use std::path::{Path, PathBuf};

mod animation;
mod places;
mod vertices;

/// Reads bytes as a file in a folder. Returns the severity, code and message of each diagnostic.
fn read(
    bytes: &[u8],
    folder: &Path,
    name: &str,
    animation_time: Option<f32>,
) -> (Option<Scene>, Vec<(Severity, String)>) {
    staged(bytes, folder, name, &SceneDefaults { animation_time, ..SceneDefaults::default() })
}

fn staged(
    bytes: &[u8],
    folder: &Path,
    name: &str,
    scene_defaults: &SceneDefaults,
) -> (Option<Scene>, Vec<(Severity, String)>) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let bytes = bytes.into();
    let file = files.add(name, std::sync::Arc::clone(&bytes));
    let source = FolderSource::new(folder);
    let files = std::cell::RefCell::new(files);
    let input =
        ReadInput { bytes: &bytes, file, files: &files, name, source: &source, scene_defaults, memory: u64::MAX };
    let format = find_scene_format(&bytes, name).expect("it is known");
    let scene = read_model(format, &input, &mut diagnostics);
    // Every error has a span.
    assert!(diagnostics.iter().all(|d| d.severity != Severity::Error || d.span.is_some()), "{diagnostics:?}");
    for span in diagnostics.iter().filter_map(|finding| finding.span) {
        assert!(span.start <= span.end && span.end as usize <= bytes.len(), "{span:?}");
    }
    assert_eq!(scene.is_none(), diagnostics.has_errors(), "{name}");
    let found = diagnostics.iter().filter(|d| d.code != "UNDECLARED_EXTENSION");
    (scene, found.map(|d| (d.severity, format!("{} {}", d.code, d.message))).collect())
}

fn corpus(folder: &str) -> Option<PathBuf> {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let root = std::env::var_os("DURER_CORPUS").map_or_else(default, PathBuf::from).join("samples/gltf").join(folder);
    if !root.is_dir() {
        println!("skipped: no {}", root.display());
        return None;
    }
    Some(root)
}

fn files_below(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        match path.is_dir() {
            true => files_below(&path, found),
            false if path.extension().is_some_and(|e| e == "gltf" || e == "glb") => found.push(path),
            false => {}
        }
    }
}

/// Errors that the validator reports but Dürer accepts: code, part of the path, and reason.
const SURVIVED: &[(&str, &str, &str)] = &[
    ("", "/animation", "animations are read only if a time is requested"),
    ("ACCESSOR_ELEMENT_OUT_OF_", "accessor_data/", "bounds are computed from the data; declared bounds are ignored"),
    ("ACCESSOR_MAX_MISMATCH", "accessor_data/", "as before"),
    ("ACCESSOR_MIN_MISMATCH", "accessor_data/", "as before"),
    ("BUFFER_VIEW_INVALID_BYTE_STRIDE", "buffer_view/", "a stride is applied even where the specification forbids it"),
    ("BUFFER_VIEW_TARGET_OVERRIDE", "mesh/", "the target of a view is a hint for graphics hardware"),
    ("IMAGE_", "image", "pictures are recognised by their bytes, and decoded only if a material uses them"),
    ("INVALID_URI", "image", "as before: the bytes are not of the kind that is declared"),
    ("TEXTURE_INVALID_IMAGE_MIME_TYPE", "texture", "as before"),
    ("MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE", "mesh/", "accessors that share a view are read without a stride"),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT", "mesh/", "application-specific attributes are not read"),
    ("MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH", "mesh/", "only the first set is read"),
    ("MESH_PRIMITIVE_NO_TANGENT_SPACE", "clearcoat", "normals of coats are not read"),
    ("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "uv_sets", "a texture without coordinates is left out"),
    (
        "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE",
        "mesh/",
        "rejected only if the view has bytes, which it lacks here",
    ),
    ("NODE_SKIN_NO_SCENE", "skin/", "joints need not be in the shown scene"),
    ("NODE_WEIGHTS_INVALID", "node/", "surplus weights have no effect"),
    ("NON_REQUIRED_EXTENSION", "quantization", "extensions in use are supported, required or not"),
    ("SKIN_NO_COMMON_ROOT", "skin/", "joints are positioned by their own parents"),
    ("SKIN_SKELETON_INVALID", "skin/", "the root of a skeleton is a hint"),
    ("TYPE_MISMATCH", "variants", "variants are read only if one is requested"),
    ("UNDEFINED_PROPERTY", "variants", "as before"),
    ("UNRESOLVED_REFERENCE", "variants", "as before"),
    ("VALUE_NOT_IN_RANGE", "iridescence", "iridescence is not read"),
    ("VALUE_NOT_IN_RANGE", "dispersion", "dispersion is not read"),
    ("TYPE_MISMATCH", "visibility", "visibility of nodes is not read"),
    ("UNDECLARED_EXTENSION", "webp", "an undeclared extension is read, with a note"),
    ("UNEXPECTED_EXTENSION_OBJECT", "", "an extension in a wrong place is ignored"),
    ("UNSATISFIED_DEPENDENCY", "node/", "weights and skins of nodes without a mesh have no effect"),
];

#[test]
fn files_of_the_validator_are_rejected_or_accepted_for_a_reason() {
    let Some(root) = corpus("validator") else { return };
    let mut paths = Vec::new();
    files_below(&root, &mut paths);
    let (mut refused, mut same, mut clean, mut survivors) = (0, 0, 0, 0);
    let mut unreasoned = Vec::new();
    for path in &paths {
        let report = path.with_file_name(format!("{}.report.json", path.file_name().unwrap().to_string_lossy()));
        let report: serde_json::Value = serde_json::from_slice(&std::fs::read(report).unwrap()).unwrap();
        let messages = report["issues"]["messages"].as_array().unwrap();
        let errors: Vec<_> = messages.iter().filter(|message| message["severity"] == 0).collect();
        let codes: Vec<&str> = errors.iter().map(|error| error["code"].as_str().unwrap()).collect();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let (scene, findings) = read(&std::fs::read(path).unwrap(), path.parent().unwrap(), &name, None);
        let ours: Vec<&String> = findings.iter().filter(|f| f.0 == Severity::Error).map(|f| &f.1).collect();
        let shown = path.strip_prefix(&root).unwrap().display();
        match (errors.is_empty(), scene.is_some()) {
            (true, true) => clean += 1,
            (true, false) => panic!("{shown} is sound, and refused: {ours:?}"),
            (false, true) => {
                let place = format!("/{shown}");
                let reason = |code: &&str| {
                    SURVIVED.iter().any(|(known, folder, _)| code.starts_with(known) && place.contains(folder))
                };
                if !codes.iter().all(reason) {
                    unreasoned.push(format!("{shown}: {codes:?}"));
                }
                survivors += 1;
            }
            (false, false) => {
                refused += 1;
                let place = |error: &&&serde_json::Value| {
                    let pointer = error["pointer"].as_str().unwrap_or_default();
                    let code = error["code"].as_str().unwrap();
                    ours.iter().any(|own| own.starts_with(code) && own.contains(pointer))
                };
                same += usize::from(errors.iter().filter(place).count() > 0);
            }
        }
    }
    println!(
        "{refused} refused, {same} of them with the validator's code and place; {survivors} survive; {clean} clean"
    );
    assert!(unreasoned.is_empty(), "these should be refused: {unreasoned:#?}");
    assert!(same * 10 >= refused * 9, "{same} of {refused}");
}

#[test]
fn khronos_models_are_read_at_rest_and_animated() {
    let Some(root) = corpus("khronos") else { return };
    let mut paths = Vec::new();
    files_below(&root, &mut paths);
    for path in &paths {
        for at in [None, Some(0.6)] {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let (scene, findings) = read(&std::fs::read(path).unwrap(), path.parent().unwrap(), &name, at);
            let scene = scene.unwrap_or_else(|| panic!("{}: {findings:?}", path.display()));
            assert!(!scene.assets.meshes.is_empty(), "{}", path.display());
            for mesh in scene.assets.meshes.values() {
                assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.positions.len()));
                assert!(mesh.positions.iter().all(|p| p.is_finite()));
            }
        }
    }
}

/// Returns a document that has one mesh with one primitive, and a buffer of the given bytes.
fn document(views: &str, accessors: &str, primitive: &str, bytes: &[u8]) -> String {
    use base64::Engine;
    let data = base64::engine::general_purpose::STANDARD.encode(bytes);
    format!(
        r#"{{"asset":{{"version":"2.0"}},
"buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{data}"}}],
"bufferViews":[{views}],"accessors":[{accessors}],
"meshes":[{{"primitives":[{{{primitive}}}]}}],"nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}]}}"#,
        bytes.len()
    )
}

fn mesh(text: &str) -> MeshData {
    let (scene, findings) = read(text.as_bytes(), Path::new("."), "a.gltf", None);
    let scene = scene.unwrap_or_else(|| panic!("{findings:?}"));
    MeshData::clone(scene.assets.meshes.values().next().unwrap())
}

const BOUNDS: &str = r#""min":[0,0,0],"max":[9,9,9]"#;

#[test]
fn accessors_are_strided_normalised_and_sparse() {
    // Data of four 16-bit positions in rows of 12 bytes, with 8-bit texture coordinates. One of the
    // rows is replaced by a sparse value.
    let mut bytes: Vec<u8> = Vec::new();
    for i in 0..4u16 {
        [i, 2 * i, 3 * i].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0, 0, 255, 51 * i as u8, 0, 0]);
    }
    bytes.extend([2, 0]);
    [7u16, 8, 9].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    let views = r#"{"buffer":0,"byteLength":48,"byteStride":12},{"buffer":0,"byteOffset":48,"byteLength":8}"#;
    let accessors = format!(
        r#"{{"bufferView":0,"componentType":5123,"count":4,"type":"VEC3",{BOUNDS},"sparse":{{"count":1,
            "indices":{{"bufferView":1,"componentType":5121}},"values":{{"bufferView":1,"byteOffset":2}}}}}},
           {{"bufferView":0,"byteOffset":8,"componentType":5121,"normalized":true,"count":4,"type":"VEC2"}}"#
    );
    let primitive = r#""attributes":{"POSITION":0,"TEXCOORD_0":1},"mode":5"#;
    let text = document(views, &accessors, primitive, &bytes)
        .replace(r#""asset":"#, r#""extensionsUsed":["KHR_mesh_quantization"],"asset":"#);
    let data = mesh(&text);
    let at = |x: f32| Vec3::new(x, 2.0 * x, 3.0 * x);
    assert_eq!(data.positions, [at(0.0), at(1.0), Vec3::new(7.0, 8.0, 9.0), at(3.0)]);
    assert_eq!(data.uvs[1], Vec2::new(1.0, 1.0 - 0.2));
    // Every second triangle of a strip is reversed, and all triangles have flat shading.
    assert_eq!(data.triangles, [[0, 1, 2], [1, 3, 2]]);
    assert!(data.flat && data.triangle_normals.is_empty());
}

#[test]
fn fans_and_lists_without_indices() {
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 1.0], [0.5; 3]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let views = r#"{"buffer":0,"byteLength":72}"#;
    let accessors = format!(r#"{{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3",{BOUNDS}}}"#);
    let of =
        |mode: &str| mesh(&document(views, &accessors, &format!(r#""attributes":{{"POSITION":0}}{mode}"#), &bytes));
    assert_eq!(of("").triangles, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(of(r#","mode":6"#).triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]);
    let text = document(views, &accessors, r#""attributes":{"POSITION":0},"mode":1"#, &bytes);
    let (scene, findings) = read(text.as_bytes(), Path::new("."), "a.gltf", None);
    assert!(scene.is_some() && findings[0].1.contains("points and lines"), "{findings:?}");
}

#[test]
fn textures_of_extensions_change_their_parameters() {
    let bytes: Vec<u8> = (0..9).flat_map(|i| (i as f32).to_le_bytes()).collect();
    let views = r#"{"buffer":0,"byteLength":36}"#;
    let accessors = format!(r#"{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",{BOUNDS}}}"#);
    let text = document(views, &accessors, r#""attributes":{"POSITION":0},"material":0"#, &bytes);
    let t = r#"{"index":0}"#;
    let extensions = format!(
        r#""KHR_materials_specular":{{"specularTexture":{t},"specularColorTexture":{t}}},
           "KHR_materials_transmission":{{"transmissionFactor":1,"transmissionTexture":{t}}},
           "KHR_materials_clearcoat":{{"clearcoatFactor":1,"clearcoatTexture":{t},"clearcoatRoughnessTexture":{t}}},
           "KHR_materials_sheen":{{"sheenColorTexture":{t},"sheenRoughnessTexture":{t}}},
           "KHR_materials_anisotropy":{{"anisotropyStrength":0.5,"anisotropyRotation":1.570796,"anisotropyTexture":{t}}},
           "KHR_materials_iridescence":{{"iridescenceFactor":0.75,"iridescenceIor":1.25,"iridescenceThicknessMinimum":200,
             "iridescenceThicknessMaximum":800,"iridescenceTexture":{t},"iridescenceThicknessTexture":{t}}},
           "KHR_materials_dispersion":{{"dispersion":0.5}}"#
    );
    let text = text.replace(
        r#""nodes":[{"mesh":0}]"#,
        &format!(
            r#""images":[{{"uri":"a.png"}}],"textures":[{{"source":0}}],"materials":[{{"extensions":{{{extensions}}},
               "pbrMetallicRoughness":{{"metallicFactor":0}}}}],"nodes":[{{"mesh":0}}]"#
        ),
    );
    let (scene, findings) = read(text.as_bytes(), Path::new("."), "a.gltf", None);
    let scene = scene.unwrap_or_else(|| panic!("{findings:?}"));
    let Material::Principled(m) = &scene.materials[0].value else { panic!() };
    let mapping = |name: &Option<FileName>| scene.assets.pictures[&name.as_ref().unwrap().path].mapping;
    let number = |name| (mapping(name).channel.unwrap(), mapping(name).range);
    let plain = |channel| (channel, [0.0, 1.0]);
    for (name, expected) in [
        (&m.specular_weight_texture, plain(Channel::Alpha)),
        (&m.transmission_weight_texture, plain(Channel::Red)),
        (&m.coat_weight_texture, plain(Channel::Red)),
        (&m.coat_roughness_texture, plain(Channel::Green)),
        (&m.fuzz_roughness_texture, plain(Channel::Alpha)),
        (&m.specular_anisotropy_texture, plain(Channel::Blue)),
        (&m.specular_rotation_texture, plain(Channel::Angle)),
        (&m.thin_film_weight_texture, plain(Channel::Red)),
        (&m.thin_film_thickness_texture, (Channel::Green, [0.25, 1.0])),
    ] {
        assert_eq!(number(name), expected, "{name:?}");
    }
    assert!(mapping(&m.specular_color_texture).channel.is_none() && mapping(&m.fuzz_color_texture).channel.is_none());
    assert_eq!((m.thin_film_weight, m.thin_film_thickness, m.thin_film_ior), (0.75, 0.8, 1.25));
    assert_eq!((m.transmission_dispersion_scale, m.transmission_dispersion_abbe_number), (0.5, 20.0));
    assert!((m.specular_rotation - 0.25).abs() < 1e-4);
}

/// Returns the material of a triangle for the given factors and extensions.
fn layers(factors: &str, extensions: &str) -> PrincipledMaterial {
    material(&format!(r#""pbrMetallicRoughness":{{{factors}}},"extensions":{{{extensions}}}"#))
}

fn material(words: &str) -> PrincipledMaterial {
    let bytes: Vec<u8> = (0..9).flat_map(|i| (i as f32).to_le_bytes()).collect();
    let accessors = format!(r#"{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",{BOUNDS}}}"#);
    let attributes = r#""attributes":{"POSITION":0},"material":0"#;
    let text = document(r#"{"buffer":0,"byteLength":36}"#, &accessors, attributes, &bytes);
    let material = format!(r#""materials":[{{{words}}}],"nodes":[{{"mesh":0}}]"#);
    let text = text.replace(r#""nodes":[{"mesh":0}]"#, &material);
    let (scene, findings) = read(text.as_bytes(), Path::new("."), "a.gltf", None);
    let scene = scene.unwrap_or_else(|| panic!("{findings:?}"));
    let Material::Principled(m) = &scene.materials[0].value else { panic!() };
    (**m).clone()
}

#[test]
fn white_material_exists_only_for_colours_without_material() {
    let bytes: Vec<u8> = (0..9).flat_map(|i| (i as f32).to_le_bytes()).collect();
    let accessors = format!(r#"{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",{BOUNDS}}}"#);
    let count = |attributes: &str| {
        let text = document(r#"{"buffer":0,"byteLength":36}"#, &accessors, attributes, &bytes);
        let bare = SceneDefaults { convert_only: true, ..SceneDefaults::default() };
        let (scene, findings) = staged(text.as_bytes(), Path::new("."), "a.gltf", &bare);
        scene.unwrap_or_else(|| panic!("{findings:?}")).materials.len()
    };
    assert_eq!([count(r#""attributes":{"POSITION":0}"#), count(r#""attributes":{"POSITION":0,"COLOR_0":0}"#)], [0, 1]);
}

#[test]
fn anisotropic_material_has_alphas_of_the_extension() {
    let of = |roughness: f32, strength: f32| {
        let factors = format!(r#""roughnessFactor":{roughness}"#);
        let m = layers(&factors, &format!(r#""KHR_materials_anisotropy":{{"anisotropyStrength":{strength}}}"#));
        durer_scene::bsdf::microfacet::Ggx::new(m.specular_roughness, m.specular_anisotropy).alpha
    };
    for (roughness, strength) in [(0.3, 0.8), (0.6, 0.2), (0.0, 0.5), (1.0, 0.7), (0.5, 0.0)] {
        let alpha = f32::max(roughness * roughness, if strength > 0.0 { 1e-3 } else { 0.0 });
        let along = alpha + (1.0 - alpha) * strength * strength;
        let wanted = durer_scene::math::Vec2::new(along, alpha);
        let found = of(roughness, strength);
        assert!((found - wanted).abs().max_element() < 1e-5, "{roughness} {strength}: {found} and not {wanted}");
    }
}

#[test]
fn specular_extension_applies_to_dielectrics_only() {
    let of = |metallic: f32, more: &str| {
        let specular = r#""KHR_materials_specular":{"specularFactor":0.25,"specularColorFactor":[1,0,0]}"#;
        let m = layers(&format!(r#""metallicFactor":{metallic}"#), &format!("{specular}{more}"));
        (m.specular_weight, m.specular_ior, m.specular_color)
    };
    let red = Vec3::X;
    assert_eq!(of(0.0, ""), (0.25, 1.5, red));
    // The extension has no effect on metals.
    assert_eq!(of(1.0, ""), (1.0, 1.5, Vec3::ONE));
    // For a material that is partly metallic, the weight is replaced with a smaller index of
    // refraction, which reflects a quarter of 0.04 at normal incidence.
    let (weight, ior, _) = of(0.5, "");
    let root = (ior - 1.0) / (ior + 1.0);
    assert!(weight == 1.0 && (root * root - 0.01).abs() < 1e-6, "{weight} {ior}");
    // Transmissive materials keep their index of refraction.
    assert_eq!(of(0.5, r#","KHR_materials_transmission":{"transmissionFactor":1}"#), (0.25, 1.5, red));
}

/// The reflectance is 0.04 times weight and colour at normal incidence, and 1 at grazing angles.
#[test]
fn specular_color_brightness_becomes_the_weight() {
    let of = |weight: f32, color: &str| {
        let extension = format!(r#""specularFactor":{weight},"specularColorFactor":{color}"#);
        let m = layers(r#""metallicFactor":0"#, &format!(r#""KHR_materials_specular":{{{extension}}}"#));
        (m.specular_weight, m.specular_color)
    };
    assert_eq!(of(1.0, "[2,2,2]"), (2.0, Vec3::ONE));
    assert_eq!(of(0.5, "[0.5,0.5,0.5]"), (0.25, Vec3::ONE));
    assert_eq!(of(0.5, "[2,1,0]"), (1.0, Vec3::new(1.0, 0.5, 0.0)));
    assert_eq!(of(1.0, "[0,0,0]"), (0.0, Vec3::ONE));
}

#[test]
fn double_sided_emitters_emit_on_both_sides() {
    let of = |words: &str| {
        let m = material(words);
        (m.walls, m.backs)
    };
    let emissive = r#","emissiveFactor":[1,1,1]"#;
    assert_eq!(of(&format!(r#""doubleSided":true{emissive}"#)), (Walls::Thin, Backs::Shown));
    assert_eq!(of(&format!(r#""doubleSided":false{emissive}"#)), (Walls::Solid, Backs::Hidden));
    assert_eq!(of(r#""doubleSided":true"#), (Walls::Solid, Backs::Shown));
    let unlit = r#""doubleSided":true,"extensions":{"KHR_materials_unlit":{}}"#;
    assert_eq!(of(unlit), (Walls::Thin, Backs::Shown));
}

#[test]
fn damaged_files_do_not_panic() {
    let bytes: Vec<u8> = (0..9).flat_map(|i| (i as f32).to_le_bytes()).chain([0, 1, 2, 0]).collect();
    let views = r#"{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}"#;
    let accessors = format!(
        r#"{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",{BOUNDS}}},
           {{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}}"#
    );
    let text =
        document(views, &accessors, r#""attributes":{"POSITION":0,"NORMAL":0},"indices":1,"material":0"#, &bytes);
    let text = text.replace(
        r#""nodes":[{"mesh":0}]"#,
        r#""materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}],"cameras":[{"type":"perspective",
        "perspective":{"yfov":0.7,"znear":0.1}}],"nodes":[{"mesh":0,"children":[1]},{"camera":0,"rotation":[0,0,0,1]}]"#,
    );
    assert!(mesh(&text).triangles.len() == 1);
    for end in 0..text.len() {
        read(&text.as_bytes()[..end], Path::new("."), "a.gltf", Some(1.0));
    }
    let mut numbers = Random(5);
    let mut random = |below| numbers.below(below);
    let words = ["0", "-1", "1e300", "4294967295", "null", "[]", "{}", "\"\"", "true", "9", "0.5"];
    for _ in 0..2000 {
        let mut changed = text.clone().into_bytes();
        let at = random(changed.len());
        match random(3) {
            0 => changed[at] = random(256) as u8,
            1 => {
                // Replace a number with another value.
                let from = (at..changed.len()).find(|&i| changed[i].is_ascii_digit()).unwrap_or(at);
                changed.splice(from..from + 1, words[random(words.len())].bytes());
            }
            _ => changed[at] = changed[random(changed.len())],
        }
        read(&changed, Path::new("."), "a.gltf", Some(1.0));
    }
}

/// Returns the number of triangles of all meshes, and their bounds and area in world space.
fn measures(root: &Path, name: &str) -> (usize, [Vec3; 2], f64) {
    let path = root.join(name);
    let file = path.file_name().unwrap().to_string_lossy().into_owned();
    let (scene, findings) = read(&std::fs::read(&path).unwrap(), path.parent().unwrap(), &file, None);
    let scene = scene.unwrap_or_else(|| panic!("{name}: {findings:?}"));
    let (mut least, mut most) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    durer_scene::scene::extent::points(&scene, &mut |p| {
        (least, most) = (least.min(p.as_vec3()), most.max(p.as_vec3()))
    });
    let (mut count, mut area) = (0, 0.0);
    for mesh in scene.assets.meshes.values() {
        count += mesh.triangles.len();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].as_dvec3());
            area += (b - a).cross(c - a).length() / 2.0;
        }
        for n in &mesh.normals {
            assert!((n.length() - 1.0).abs() < 0.02, "{name}: {n}");
        }
    }
    (count, [least, most], area)
}

#[test]
fn compressed_models_match_uncompressed_ones() {
    let Some(root) = corpus("") else { return };
    for (packed, plain) in [
        ("khronos/Box/glTF-Draco/Box.gltf", "khronos/Box/glTF/Box.gltf"),
        ("khronos/Duck/glTF-Draco/Duck.gltf", "khronos/Duck/glTF/Duck.gltf"),
        (
            "khronos/MorphPrimitivesTest/glTF-Draco/MorphPrimitivesTest.gltf",
            "khronos/MorphPrimitivesTest/glTF-Binary/MorphPrimitivesTest.glb",
        ),
        ("transform/BoxDraco.gltf", "khronos/Box/glTF/Box.gltf"),
        ("transform/BoxMeshopt.glb", "khronos/Box/glTF/Box.gltf"),
        ("transform/BoxMeshopt.gltf", "khronos/Box/glTF/Box.gltf"),
    ] {
        if !root.join(packed).exists() || !root.join(plain).exists() {
            println!("skipped: {packed}");
            continue;
        }
        let (packed_count, packed_box, packed_area) = measures(&root, packed);
        let (count, corners, area) = measures(&root, plain);
        // Coordinates are rounded to at least 11 bits.
        let step = (corners[1] - corners[0]).max_element() / 1024.0;
        assert_eq!(packed_count, count, "{packed}");
        let same = (0..2).all(|i| packed_box[i].abs_diff_eq(corners[i], step));
        assert!(same, "{packed}: {packed_box:?} {corners:?}");
        assert!(
            (packed_area / area - 1.0).abs() < 2e-3 || packed.contains("Meshopt"),
            "{packed}: {packed_area} {area}"
        );
    }
    assert_eq!(measures(&root, "transform/DracoSparseMesh.gltf").0, 102);
}

#[test]
fn damaged_compressed_data_do_not_panic() {
    let Some(root) = corpus("") else { return };
    for (name, bytes, least) in [
        ("transform/BoxMeshopt.gltf", "transform/BoxMeshopt.bin", 0.05),
        ("transform/DracoSparseMesh.gltf", "transform/DracoSparseMesh.bin", 0.05),
        ("khronos/Box/glTF-Draco/Box.gltf", "khronos/Box/glTF-Draco/Box.bin", 0.2),
        ("khronos/Duck/glTF-Draco/Duck.gltf", "khronos/Duck/glTF-Draco/Duck.bin", 0.05),
    ] {
        use base64::Engine;
        let text = std::fs::read_to_string(root.join(name)).unwrap();
        let sound = std::fs::read(root.join(bytes)).unwrap();
        let uri = bytes.rsplit('/').next().unwrap();
        let mut numbers = Random(7);
        let mut random = |below| numbers.below(below);
        let mut refused = 0;
        const TRIES: usize = 400;
        for i in 0..TRIES {
            let mut changed = sound.clone();
            // Most of the important numbers are in the first few bytes.
            let at = random(if i % 2 == 0 { changed.len() } else { changed.len().min(64) });
            let end = changed.len().min(at + 1 + random(8));
            match i % 5 {
                0 | 1 => changed[at] ^= 1 << random(8),
                2 => changed[at..end].iter_mut().for_each(|byte| *byte = random(256) as u8),
                3 => changed[at..end].fill(0xff),
                _ => changed[at..].fill(0),
            }
            let data = base64::engine::general_purpose::STANDARD.encode(&changed);
            let text = text.replace(uri, &format!("data:application/octet-stream;base64,{data}"));
            refused += usize::from(read(text.as_bytes(), &root, "a.gltf", None).0.is_none());
        }
        let share = refused as f64 / TRIES as f64;
        assert!(share > least, "{name}: {share}");
    }
}

#[test]
fn variant_is_selected_by_name_or_number() {
    let bytes: Vec<u8> = (0..9).flat_map(|i| (i as f32).to_le_bytes()).collect();
    let views = r#"{"buffer":0,"byteLength":36}"#;
    let accessors = format!(r#"{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",{BOUNDS}}}"#);
    let primitive = r#""attributes":{"POSITION":0},"material":0,"extensions":{"KHR_materials_variants":{"mappings":[
        {"material":1,"variants":[0,2]},{"material":2,"variants":[1]}]}}"#;
    let text = document(views, &accessors, primitive, &bytes).replace(
        r#""nodes":[{"mesh":0}]"#,
        r#""materials":[{},{},{}],"extensions":{"KHR_materials_variants":{"variants":[{"name":"red"},{"name":"green"},
           {"name":"2nd red"}]}},"nodes":[{"mesh":0}]"#,
    );
    let shown = |variant: Option<&str>| {
        let scene_defaults = SceneDefaults { variant: variant.map(Into::into), ..SceneDefaults::default() };
        let (scene, findings) = staged(text.as_bytes(), Path::new("."), "a.gltf", &scene_defaults);
        scene.map(|scene| scene.root.unwrap().objects[0].material).ok_or(format!("{findings:?}"))
    };
    assert_eq!(shown(None), Ok(Some(0)));
    for (variant, material) in [("red", 1), ("green", 2), ("2nd red", 1), ("1", 2)] {
        assert_eq!(shown(Some(variant)), Ok(Some(material)), "{variant}");
    }
    assert!(shown(Some("gren")).unwrap_err().contains("did you mean `green`?"));
    assert!(shown(Some("3")).unwrap_err().contains("no variant `3`"));
}

/// Indices out of range are errors even if the list of diagnostics is full.
#[test]
fn errors_count_if_diagnostics_are_full() {
    let lost = r#"{"asset":{"version":"2.0"},"nodes":[{"children":[7]}],"scenes":[{"nodes":[0]}]}"#;
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    (0..100).for_each(|_| diagnostics.push(durer_diag::Diagnostic::error("before")));
    let file = files.add("a.gltf", lost.as_bytes().into());
    let (source, files) = (FolderSource::new("."), std::cell::RefCell::new(files));
    let (name, scene_defaults) = ("a.gltf", SceneDefaults::default());
    let input = ReadInput {
        bytes: &lost.as_bytes().into(),
        file,
        files: &files,
        name,
        source: &source,
        scene_defaults: &scene_defaults,
        memory: 1 << 30,
    };
    assert!(read_model(find_scene_format(lost.as_bytes(), name).unwrap(), &input, &mut diagnostics).is_none());
    // Many warnings come before the error.
    let wide = r#"{"type":"perspective","perspective":{"yfov":4,"znear":0.1}},"#.repeat(400);
    let text = lost.replace(r#""nodes":[{"#, &format!(r#""cameras":[{}],"nodes":[{{"#, wide.trim_end_matches(',')));
    let (scene, messages) = read(text.as_bytes(), Path::new("."), "a.gltf", None);
    let last = messages.last().unwrap();
    assert!(scene.is_none() && messages.len() > 20 && last.0 == Severity::Error, "{} {last:?}", messages.len()); // prose: keep
}
