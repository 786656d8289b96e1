//! Tests of models that are used as scenes, including their contents, errors and positions.

use super::*;
use durer_diag::Diagnostic;
use durer_scene::describe::FileName;
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::{DefaultLighting, Material, ObjectKind, PresetView};
use durer_scene::source::Digest;
use durer_scene::texture::Channel;
use std::fs;

/// Loads a file in a folder. Returns the scene if there were no errors, and the diagnostics in the
/// form `code: message`.
fn read(folder: &Path, name: &str, options: &LoadOptions) -> (Option<Scene>, Vec<String>) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let loaded = load(&folder.join(name), options, &mut files, &mut diagnostics).unwrap();
    assert_eq!(loaded.is_none(), diagnostics.has_errors());
    let compiled = loaded.as_ref().map(|loaded| loaded.compile(options, &mut files, &mut diagnostics));
    let line = |d: &Diagnostic| format!("{}: {}", d.code, d.message);
    let found = diagnostics.iter().map(line).collect();
    (loaded.filter(|_| compiled.flatten().is_some()).map(|loaded| loaded.scene), found)
}

/// Returns the digest of a small render of a file.
fn hash(folder: &Path, name: &str, options: &LoadOptions) -> Digest {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let loaded = load(&folder.join(name), options, &mut files, &mut diagnostics).unwrap().unwrap();
    let world = loaded.compile(options, &mut files, &mut diagnostics).unwrap();
    let job = durer_render::render::Job { width: 24, height: 16, ..durer_render::render::Job::default() };
    let part = durer_render::render::PartialRender::new(&world, &job, durer_render::render::Shard::WHOLE).unwrap();
    part.render(&world, &durer_render::render::Control::default(), &mut |_, _| {}).unwrap();
    part.hash()
}

fn principled(scene: &Scene, number: usize) -> &PrincipledMaterial {
    let Material::Principled(layers) = &scene.materials[number].value else { panic!("no layers") };
    layers
}

const TETRAHEDRON: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.25], [0.5, 1.0, 0.5], [0.25, 0.125, 1.0]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

/// Writes the same tetrahedron to a folder in every format.
fn tetrahedra() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let row = |p: &[f32; 3]| format!("{} {} {}\n", p[0], p[1], p[2]);
    let face = |f: &[usize; 3], from: usize| format!("{} {} {}\n", f[0] + from, f[1] + from, f[2] + from);
    let mut obj: String = TETRAHEDRON.iter().map(|p| format!("v {}", row(p))).collect();
    FACES.iter().for_each(|f| obj += &format!("f {}", face(f, 1)));
    put("a.obj", obj.as_bytes());
    let mut ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element face 4\nproperty list uchar int vertex_index\nend_header\n"
        .to_string();
    TETRAHEDRON.iter().for_each(|p| ply += &row(p));
    FACES.iter().for_each(|f| ply += &format!("3 {}", face(f, 0)));
    put("a.ply", ply.as_bytes());
    let mut stl = "solid\n".to_string();
    for f in FACES {
        stl += "facet normal 0 0 0\nouter loop\n";
        f.iter().for_each(|&i| stl += &format!("vertex {}", row(&TETRAHEDRON[i])));
        stl += "endloop\nendfacet\n";
    }
    put("a.stl", (stl + "endsolid\n").as_bytes());
    let mut bin: Vec<u8> = TETRAHEDRON.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bin.extend(FACES.iter().flatten().map(|&i| i as u8));
    put("a.bin", &bin);
    put("a.gltf", GLTF.as_bytes());
    let json = GLTF.replace("\"uri\": \"a.bin\", ", "");
    let json = format!("{json}{}", " ".repeat(json.len().next_multiple_of(4) - json.len()));
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    glb.extend((12 + 8 + json.len() as u32 + 8 + 60).to_le_bytes());
    glb.extend((json.len() as u32).to_le_bytes());
    glb.extend(b"JSON");
    glb.extend(json.as_bytes());
    glb.extend(60u32.to_le_bytes());
    glb.extend(b"BIN\0");
    glb.extend(&bin);
    put("a.glb", &glb);
    folder
}

const GLTF: &str = r#"{
  "asset": { "version": "2.0" },
  "buffers": [{ "uri": "a.bin", "byteLength": 60 }],
  "bufferViews": [
    { "buffer": 0, "byteLength": 48 },
    { "buffer": 0, "byteOffset": 48, "byteLength": 12 }
  ],
  "accessors": [
    { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1] },
    { "bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR" }
  ],
  "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
  "nodes": [{ "mesh": 0 }],
  "scenes": [{ "nodes": [0] }]
}"#;

/// Returns a folder with the glTF file of the tetrahedron after one change.
fn changed(from: &str, to: &str) -> tempfile::TempDir {
    let folder = tetrahedra();
    assert!(GLTF.contains(from), "{from}");
    fs::write(folder.path().join("a.gltf"), GLTF.replace(from, to)).unwrap();
    folder
}

#[test]
fn model_renders_the_same_in_every_format() {
    let folder = tetrahedra();
    let options = LoadOptions::default();
    let up = LoadOptions {
        scene_defaults: SceneDefaults { up: Some(durer_scene::scene::Axis::Y), ..SceneDefaults::default() },
        ..options.clone()
    };
    let obj = hash(folder.path(), "a.obj", &options);
    for name in ["a.ply", "a.stl"] {
        assert_eq!(hash(folder.path(), name, &up), obj, "{name}");
    }
    // Without normals, glTF requires flat shading. The other formats use smooth shading up to a
    // crease angle.
    assert_eq!(hash(folder.path(), "a.gltf", &up), hash(folder.path(), "a.glb", &up));
    // STL files have z as the up axis by default.
    assert_ne!(hash(folder.path(), "a.stl", &options), obj);
    // A different view gives a different picture and a different digest.
    let front = LoadOptions {
        scene_defaults: SceneDefaults { view: Some(PresetView::Front), ..SceneDefaults::default() },
        ..options.clone()
    };
    assert_ne!(hash(folder.path(), "a.obj", &front), obj);
}

#[test]
fn model_format_is_detected_by_content() {
    let folder = tetrahedra();
    for name in ["a.ply", "a.stl", "a.gltf", "a.glb"] {
        fs::copy(folder.path().join(name), folder.path().join("model")).unwrap();
        let (scene, _) = read(folder.path(), "model", &LoadOptions::default());
        assert_eq!(scene.unwrap().assets.meshes.len(), 1, "{name}");
    }
}

#[test]
fn compressed_model_is_read_and_a_bomb_is_refused() {
    use std::io::Write;
    let folder = tetrahedra();
    let pack = |bytes: &[u8]| {
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        packer.write_all(bytes).unwrap();
        packer.finish().unwrap()
    };
    let put = |bytes: &[u8]| fs::write(folder.path().join("b.ply.gz"), bytes).unwrap();
    let packed = pack(&fs::read(folder.path().join("a.ply")).unwrap());
    put(&packed);
    let plain = read(folder.path(), "a.ply", &LoadOptions::default()).0.unwrap();
    let unpacked = read(folder.path(), "b.ply.gz", &LoadOptions::default()).0.unwrap();
    assert_eq!(plain.assets.meshes["a.ply"], unpacked.assets.meshes["b.ply"]);
    put(&packed[..packed.len() - 1]);
    assert!(read(folder.path(), "b.ply.gz", &LoadOptions::default()).1[0].starts_with("bad-file"));
    put(&pack(&vec![0; 1 << 22]));
    let options = LoadOptions { memory: Some(1 << 20), ..LoadOptions::default() };
    assert!(read(folder.path(), "b.ply.gz", &options).1[0].contains("too large"));
}

#[test]
fn meshes_are_equal_after_writing_and_reading() {
    let folder = tetrahedra();
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let options = LoadOptions::default();
    let loaded = load(&folder.path().join("a.ply"), &options, &mut files, &mut diagnostics).unwrap().unwrap();
    let (mesh, left_out) = loaded.compile(&options, &mut files, &mut diagnostics).unwrap().merged_mesh();
    // The ground plane is not a mesh.
    assert_eq!((mesh.triangles.len(), left_out), (4, 1));
    for format in durer_formats::MESH_FORMATS {
        let bytes = (format.write)(&mesh);
        let name = format!("x.{}", format.extensions[0]);
        let again = durer_formats::read_mesh(&bytes, 0, &name, &mut diagnostics).unwrap();
        let corners = |data: &durer_scene::shape::MeshData| -> Vec<Vec3> {
            data.triangles.iter().flatten().map(|&i| data.positions[i as usize]).collect()
        };
        assert_eq!(corners(&again), corners(&mesh), "{name}");
    }
}

#[test]
fn model_without_light_is_dark_only_on_request() {
    let folder = tetrahedra();
    let none = LoadOptions {
        scene_defaults: SceneDefaults { lighting: Some(DefaultLighting::None), ..SceneDefaults::default() },
        ..Default::default()
    };
    let scene = read(folder.path(), "a.ply", &none).0.unwrap();
    assert!(scene.lights.unwrap().is_empty() && scene.root.unwrap().objects.len() == 1);
    assert_eq!(read(folder.path(), "a.ply", &LoadOptions::default()).1, [""; 0]);
}

#[test]
fn uris_stay_below_the_folder() {
    let outside = tempfile::tempdir().unwrap();
    fs::write(outside.path().join("a.bin"), [0; 60]).unwrap();
    let out = outside.path().file_name().unwrap().to_string_lossy().into_owned();
    let absolute = outside.path().join("a.bin").display().to_string();
    for (uri, code) in [
        (format!("../{out}/a.bin"), "IO_ERROR"),
        (format!("%2e%2e/{out}/a.bin"), "IO_ERROR"),
        (format!("..%2F{out}%2Fa.bin"), "IO_ERROR"),
        (format!("..\\\\{out}\\\\a.bin"), "IO_ERROR"),
        (absolute.clone(), "INVALID_URI"),
        (absolute.replace('/', "%2F"), "INVALID_URI"),
        (format!("file://{absolute}"), "INVALID_URI"),
        ("https://example.com/a.bin".into(), "INVALID_URI"),
        ("a%00.bin".into(), "INVALID_URI"),
        ("a%zz.bin".into(), "INVALID_URI"),
        ("link".into(), "IO_ERROR"),
    ] {
        let folder = changed("\"a.bin\"", &format!("\"{uri}\""));
        #[cfg(unix)]
        std::os::unix::fs::symlink(&absolute, folder.path().join("link")).unwrap();
        let (scene, found) = read(folder.path(), "a.gltf", &LoadOptions::default());
        assert!(scene.is_none() && found[0].starts_with(&format!("{code}: /buffers/0/uri")), "{uri}: {found:?}");
    }
}

#[test]
fn gltf_errors_name_the_place_and_the_fault() {
    for (from, to, wanted) in [
        ("\"version\": \"2.0\"", "\"version\": \"1.0\"", "UNKNOWN_ASSET_MAJOR_VERSION: /asset/version"),
        ("\"count\": 12", "\"count\": 1000000000", "ACCESSOR_TOO_LONG: /accessors/1"),
        ("\"bufferView\": 1, ", "", "too-large: /meshes/0/primitives/0/indices"),
        ("\"POSITION\": 0", "\"POSITION\": 7", "UNRESOLVED_REFERENCE: /meshes/0/primitives/0/attributes/POSITION"),
        ("\"mesh\": 0 }", "\"mesh\": 0, \"children\": [0] }", "NODE_LOOP: /nodes/0"),
        ("\"byteLength\": 48 }", "\"byteLength\": 480 }", "BUFFER_VIEW_TOO_LONG: /bufferViews/0/byteLength"),
        ("\"asset\"", "\"extensionsRequired\": [\"KHR_texture_basisu\"], \"asset\"", "UNSUPPORTED_EXTENSION"),
        ("[0] }]", "[0] }", "INVALID_JSON"),
    ] {
        // The size of an accessor without a buffer, whose elements are all zero, is also limited.
        let to = if to.is_empty() { "\"normalized\": false, " } else { to };
        let folder = match wanted {
            "too-large: /meshes/0/primitives/0/indices" => {
                let text = GLTF.replace(from, "").replace("\"count\": 12", "\"count\": 1000000000");
                let folder = tetrahedra();
                fs::write(folder.path().join("a.gltf"), text).unwrap();
                folder
            }
            _ => changed(from, to),
        };
        let (scene, found) = read(folder.path(), "a.gltf", &LoadOptions::default());
        assert!(scene.is_none() && found[0].starts_with(wanted), "{wanted}: {found:?}");
    }
}

#[test]
fn gltf_materials_become_openpbr_parameters() {
    let material = r#""materials": [{ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 1, 0.5], "metallicFactor": 0.25,
        "roughnessFactor": 0.75 }, "alphaMode": "BLEND", "emissiveFactor": [1, 0.5, 0], "extensions": {
        "KHR_materials_ior": { "ior": 1.25 }, "KHR_materials_emissive_strength": { "emissiveStrength": 4 },
        "KHR_materials_clearcoat": { "clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.125 },
        "KHR_materials_sheen": { "sheenColorFactor": [0.5, 0.25, 0] },
        "KHR_materials_transmission": { "transmissionFactor": 0.75 },
        "KHR_materials_volume": { "thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0, 1, 0] },
        "KHR_materials_subsurface": {} } }, {}], "meshes""#;
    let folder = changed("\"meshes\"", material);
    let (scene, found) = read(folder.path(), "a.gltf", &LoadOptions::default());
    // The file does not list its extensions.
    let found: Vec<&String> = found.iter().filter(|found| !found.starts_with("UNDECLARED_EXTENSION")).collect();
    assert_eq!(found, ["KHR_materials_subsurface: subsurface scattering is left out"]);
    let scene = scene.unwrap();
    let m = principled(&scene, 0);
    assert_eq!((m.base_color, m.base_metalness, m.specular_roughness), (Vec3::new(0.5, 0.25, 1.0), 0.25, 0.75));
    assert_eq!((m.opacity, m.specular_ior, m.emission_luminance), (0.5, 1.25, 4.0));
    assert_eq!((m.coat_weight, m.coat_roughness, m.coat_ior, m.coat_darkening), (0.5, 0.125, 1.5, 0.0));
    assert_eq!((m.fuzz_weight, m.fuzz_color), (0.5, Vec3::new(1.0, 0.5, 0.0)));
    assert_eq!((m.transmission_weight, m.transmission_depth, m.transmission_color), (0.75, 2.0, Vec3::Y));
    // The default material of glTF is a rough, white metal.
    let m = principled(&scene, 1);
    assert_eq!((m.base_color, m.base_metalness, m.specular_roughness, m.opacity), (Vec3::ONE, 1.0, 1.0, 1.0));
}

#[test]
fn gltf_camera_is_chosen_by_name() {
    let nodes = r#""cameras": [{ "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1 } }],
        "nodes": [{ "mesh": 0 }, { "name": "left", "camera": 0, "translation": [1, 2, 3] },
        { "name": "right", "camera": 0, "rotation": [0, 1, 0, 0] }],"#;
    let folder = changed("\"nodes\": [{ \"mesh\": 0 }],", nodes);
    fs::write(
        folder.path().join("a.gltf"),
        GLTF.replace("\"nodes\": [{ \"mesh\": 0 }],", nodes).replace("[0] }]", "[0, 1, 2] }]"),
    )
    .unwrap();
    let seen = |camera: &str| {
        let scene_defaults =
            SceneDefaults { camera: Some(camera.into()), aspect: Some(2.0), ..SceneDefaults::default() };
        read(folder.path(), "a.gltf", &LoadOptions { scene_defaults, ..LoadOptions::default() })
    };
    let Some(durer_scene::camera::Camera::Perspective(left)) = seen("left").0.unwrap().camera else {
        panic!("no camera")
    };
    assert_eq!((left.center, left.direction), (Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z));
    // The picture is twice as wide as high, so tan(angle / 2) = 2 tan(1/2).
    assert!((left.angle - 2.0 * fp::atan_f64(2.0 * fp::tan_f64(0.5)).to_degrees() as f32).abs() < 1e-4);
    assert_eq!(seen("right").0.unwrap().camera, seen("1").0.unwrap().camera);
    assert!(seen("rigth").1[0].contains("did you mean `right`?"));
}

#[test]
fn obj_is_split_by_material_and_reads_mtl() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    put(
        "m.obj",
        "mtllib my materials.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red one\nf 1 2 3\nusemtl glass\nf 1 3 4\n\
         usemtl red one\nf 1 2 4\nusemtl gone\nf 2 3 4\n",
    );
    put(
        "my materials.mtl",
        "newmtl red one\nKd 1 0 0\nPr 0.25\nPm 1\nmap_Kd -s 2 3 1 -o 0.5 0.25 -clamp on C:\\pictures\\a b.ppm\n\
         newmtl glass\nd 0.25\nillum 4\nNi 1.25\nTf 1 1 1\nKe 0 2 4\n",
    );
    fs::write(folder.path().join("a b.ppm"), b"P6 1 1 255\n\xff\xff\xff").unwrap();
    let (scene, found) = read(folder.path(), "m.obj", &LoadOptions::default());
    assert!(
        found[0].starts_with("absolute-path: ")
            && found[1].starts_with("no-material: no material file defines the material `gone`")
            && found.len() == 2,
        "{found:?}"
    );
    let scene = scene.unwrap();
    // There are three meshes, in the order of the first triangle of each material, followed by the
    // ground.
    let objects = &scene.root.as_ref().unwrap().objects;
    let triangles = objects.iter().filter_map(|object| match &object.node {
        ObjectKind::Mesh(mesh) => Some((scene.assets.meshes[&mesh.obj_file.path].triangles.len(), object.material)),
        _ => None,
    });
    assert_eq!(triangles.collect::<Vec<_>>(), [(2, Some(0)), (1, Some(1)), (1, Some(2))]);
    let red = principled(&scene, 0);
    assert_eq!((red.base_color, red.base_metalness, red.specular_roughness), (Vec3::X, 1.0, 0.25));
    let picture = &scene.assets.pictures[&red.base_color_texture.as_ref().unwrap().path];
    assert_eq!(picture.mapping.wrap, [durer_scene::texture::Wrap::Clamp; 2]);
    // With v upwards, the coordinate is 3 v + 0.25. With v downwards, it is 3 w + 1 - 3 - 0.25.
    assert_eq!(picture.mapping.transform, [[2.0, 0.0, 0.5], [0.0, 3.0, -2.25]]);
    let glass = principled(&scene, 1);
    assert_eq!((glass.transmission_weight, glass.specular_ior, glass.emission_luminance), (0.75, 1.25, 4.0));
}

#[test]
fn mtl_pictures_set_their_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    put("m.obj", b"mtllib m.mtl\nv 0 0 0\nv 3 0 0\nv 3 4 0\nusemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n");
    let maps =
        "map_Ks p.ppm\nmap_Pr -imfchan g p.ppm\nmap_Pm -mm 0.25 0.5 p.ppm\nmap_Pc p.ppm\nmap_d p.ppm\nmap_Ke p.ppm\n";
    put("m.mtl", format!("newmtl a\n{maps}map_bump -bm 3 p.ppm\nnewmtl b\nbump p_normal.ppm\n").as_bytes());
    put("p.ppm", b"P6 1 1 255\n\xff\xff\xff");
    put("p_normal.ppm", b"P6 1 1 255\n\x80\x80\xff");
    let (scene, found) = read(folder.path(), "m.obj", &LoadOptions::default());
    let scene = scene.unwrap_or_else(|| panic!("{found:?}"));
    let (m, other) = (principled(&scene, 0), principled(&scene, 1));
    let mapping = |name: &Option<FileName>| scene.assets.pictures[&name.as_ref().unwrap().path].mapping;
    assert_eq!(mapping(&m.specular_roughness_texture).channel, Some(Channel::Green));
    assert_eq!(mapping(&m.base_metalness_texture).range, [0.25, 0.75]);
    assert!(m.specular_color_texture.is_some() && m.opacity_texture.is_some() && m.emission_texture.is_some());
    // If a parameter is given only by a texture, the texture is not scaled.
    assert_eq!((m.specular_roughness, m.base_metalness, m.coat_weight, m.emission_luminance), (1.0, 1.0, 1.0, 1.0));
    // The height of a bump map is relative to the size of the model, which is 5 here.
    assert!(m.bump_texture.is_some() && (m.bump_height - 3.0 * 0.002 * 5.0).abs() < 1e-6, "{}", m.bump_height);
    assert!(other.bump_texture.is_none() && other.normal_texture.is_some());
}
