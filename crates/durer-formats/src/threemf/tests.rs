//! Tests of the 3MF reader, which use generated archives, the positions of errors, and the test
//! files of the 3MF Consortium if they are installed.

use durer::{LoadOptions, load};
use durer_diag::{Diagnostics, Files};
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::Vec3;
use durer_scene::math::random::Random;
use durer_scene::scene::{Material, MatrixOp, MatrixRules, Object, ObjectKind, Scene};
use durer_scene::shape::Primitive;
use glam::{DAffine3, DVec3};
use rawzip::{CompressionMethod, ZipArchiveWriter};
use std::io::Write;
use std::path::{Path, PathBuf};

const RELATIONS: &str = "<Relationships><Relationship Target='/3D/a.model' Type='http://x/3dmodel'/></Relationships>";

/// Returns an archive that contains compressed parts.
fn archive(parts: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut zip = ZipArchiveWriter::new(&mut bytes);
    for (name, data) in parts {
        let (mut entry, config) = zip.new_file(name).compression_method(CompressionMethod::DEFLATE).start().unwrap();
        let encoder = flate2::write::DeflateEncoder::new(&mut entry, flate2::Compression::default());
        let mut writer = config.wrap(encoder);
        writer.write_all(data).unwrap();
        let (encoder, sums) = writer.finish().unwrap();
        encoder.finish().unwrap();
        entry.finish(sums).unwrap();
    }
    zip.finish().unwrap();
    bytes
}

/// Reads a file and returns its scene and the diagnostics.
fn read_file(path: &Path) -> (Option<Scene>, Vec<String>) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let loaded = load(path, &LoadOptions::default(), &mut files, &mut diagnostics).unwrap();
    let messages = diagnostics.iter().map(|found| {
        let place = found.span.and_then(|span| {
            let (line, column) = files.position(span)?;
            Some(format!("{}:{line}:{column} ", files.name(span.file)?.rsplit('/').next()?))
        });
        format!("{}{:?} {}", place.unwrap_or_default(), found.severity, found.message)
    });
    (loaded.map(|loaded| loaded.scene), messages.collect())
}

fn read_parts(parts: &[(&str, &[u8])]) -> (Option<Scene>, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.3mf");
    std::fs::write(&path, archive(parts)).unwrap();
    read_file(&path)
}

/// Returns a model of a tetrahedron; additional attributes on its triangles, resources, and build
/// items can be given.
fn model(resources: &str, object: &str, triangles: [&str; 4], items: &str) -> String {
    let corners =
        ["<triangle v1='0' v2='2' v3='1'", "<triangle v1='0' v2='1' v3='3'", "<triangle v1='1' v2='2' v3='3'"];
    let corners = [corners[0], corners[1], corners[2], "<triangle v1='2' v2='0' v3='3'"];
    let all: String = corners.iter().zip(triangles).map(|(corner, more)| format!("{corner} {more}/>")).collect();
    format!(
        "<model unit='centimeter' xmlns:m='x'><resources>{resources}<object id='1' {object}><mesh><vertices>\
         <vertex x='0' y='0' z='0'/><vertex x='1' y='0' z='0'/><vertex x='0' y='1' z='0'/><vertex x='0' y='0' z='1'/></vertices>\
         <triangles>{all}</triangles></mesh></object></resources><build>{items}</build></model>"
    )
}

const ITEM: &str = "<item objectid='1'/>";

fn read(model: &str) -> (Option<Scene>, Vec<String>) {
    read_parts(&[("_rels/.rels", RELATIONS.as_bytes()), ("3D/a.model", model.as_bytes())])
}

fn clean(model: &str) -> Scene {
    let (scene, messages) = read(model);
    assert_eq!(messages, [""; 0], "{model}");
    scene.unwrap()
}

/// Returns the shapes in a file, each with its transform to world space.
fn shown(scene: &Scene) -> Vec<(DAffine3, &Object)> {
    fn gather<'a>(object: &'a Object, map: DAffine3, all: &mut Vec<(DAffine3, &'a Object)>) {
        match &object.node {
            ObjectKind::Group(group) => group.objects.iter().for_each(|object| gather(object, map, all)),
            ObjectKind::Transform(ops, inner) => {
                gather(inner, map * MatrixOp::product(ops, MatrixRules::default()), all)
            }
            // Skip the ground that is added by default.
            ObjectKind::Primitive(Primitive::Plane(_)) => {}
            _ => all.push((map, object)),
        }
    }
    let mut all = Vec::new();
    scene.root.iter().flat_map(|root| &root.objects).for_each(|object| gather(object, DAffine3::IDENTITY, &mut all));
    all
}

#[test]
fn a_build_without_items_is_reported() {
    let messages = read(&model("", "", [""; 4], "")).1;
    let expected = "the file shows none of its objects: `<build>` in `3D/a.model` has no `<item>`";
    assert!(messages.iter().any(|message| message.ends_with(expected)), "{messages:?}");
}

#[test]
fn units_items_and_components_are_transformed() {
    let scene = clean(&model("", "", [""; 4], ITEM));
    let data = scene.assets.meshes.values().next().unwrap();
    let most = data.positions.iter().copied().reduce(Vec3::max).unwrap();
    assert_eq!((most, data.triangles.len(), data.flat), (Vec3::splat(10.0), 4, true));
    let turn = "transform='0 1 0 -1 0 0 0 0 1 5 6 7'";
    let text = model("", "", [""; 4], &format!("{ITEM}<item objectid='2' {turn}/>")).replace(
        "</resources>",
        &format!("<object id='2'><components><component objectid='1'/><component objectid='1' {turn}/></components></object></resources>"),
    );
    let scene = clean(&text);
    let places = shown(&scene);
    assert_eq!((places.len(), scene.assets.meshes.len()), (3, 1));
    // A centimetre is ten millimetres. The transform maps x to y, and y to -x.
    let x = |i: usize| places[i].0.transform_point3(10.0 * DVec3::X);
    assert_eq!([x(0), x(1)], [DVec3::new(10.0, 0.0, 0.0), DVec3::new(50.0, 70.0, 70.0)]);
    assert_eq!(x(2), DVec3::new(50.0 - 70.0, 60.0 + 50.0, 140.0));
}

#[test]
fn colours_mixtures_and_pictures() {
    let lists = "<basematerials id='5'><base name='a' displaycolor='#FF0000'/><base name='b' displaycolor='#0000FF80'/></basematerials>\
        <m:colorgroup id='6'><m:color color='#00FF00'/><m:color color='#FFFFFF'/></m:colorgroup>\
        <m:compositematerials id='7' matid='5' matindices='0 1'><m:composite values='3 1'/></m:compositematerials>";
    let triangles = ["pid='5' p1='1'", "pid='6' p1='0' p2='1' p3='0'", "pid='7' p1='0'", ""];
    let scene = clean(&model(lists, "pid='5' pindex='0'", triangles, ITEM));
    let data = scene.assets.meshes.values().next().unwrap();
    let color = |i: usize, k: usize| data.colors[data.triangles[i][k] as usize];
    assert_eq!(color(0, 0), [0.0, 0.0, 1.0, 128.0 / 255.0]);
    assert_eq!((color(1, 0), color(1, 1)), ([0.0, 1.0, 0.0, 1.0], [1.0; 4]));
    assert_eq!(color(2, 1)[..3], [0.75, 0.0, 0.25]);
    assert_eq!(color(3, 2), [1.0, 0.0, 0.0, 1.0]);
    let picture = "<m:texture2d id='8' path='/3D/p.png' contenttype='image/png' tilestyleu='mirror'/>\
        <m:texture2dgroup id='9' texid='8'><m:tex2coord u='0' v='0.25'/><m:tex2coord u='1' v='1'/></m:texture2dgroup>";
    let text = model(picture, "", ["pid='9' p1='0' p2='1' p3='1'", "", "", ""], ITEM);
    let parts: [(&str, &[u8]); 3] =
        [("_rels/.rels", RELATIONS.as_bytes()), ("3D/a.model", text.as_bytes()), ("3D/p.png", b"x")];
    let (scene, messages) = read_parts(&parts);
    assert_eq!(messages, [""; 0]);
    let scene = scene.unwrap();
    let pictured = |m: &PrincipledMaterial| m.base_color_texture.is_some();
    let count = scene.materials.iter().filter(|m| matches!(&m.value, Material::Principled(m) if pictured(m))).count();
    assert_eq!((count, scene.assets.meshes.len(), scene.assets.pictures.len()), (1, 2, 1));
    let with_uvs = scene.assets.meshes.values().find(|mesh| !mesh.uvs.is_empty()).unwrap();
    assert_eq!((with_uvs.triangles.len(), with_uvs.uvs[0].y), (1, 0.25));
}

#[test]
fn errors_have_positions() {
    let usual = || model("", "", [""; 4], ITEM);
    for (text, expected) in [
        (
            usual().replace("v3='1'", "v3='9'"),
            "a.model:1:239 Error vertex 9 does not exist: the mesh has only the vertices 0 to 3",
        ),
        (usual().replace("x='1'", "x='one'"), "expected a number, found `one`"),
        (usual().replace("centimeter", "cm"), "Error unknown unit `cm`"),
        (usual().replace("objectid='1'", "objectid='3'"), "Error object 3 does not exist"),
        (usual().replace("<build>", "<!--").replace("</build>", "-->"), "Error a model needs a `<build>`"),
        (usual().replace("object id='1'", "object id='1' type='thing'"), "unknown object type `thing`"),
        (usual().replace("v1='0' v2='2'", "p1='0' v1='0' v2='2'"), "`p1` needs a `pid`"),
        (usual().replace("v1='0' v2='2'", "pid='4' p1='0' v1='0' v2='2'"), "no property list 4"),
        (usual().replace("<item", "<item transform='1 2'"), "expected twelve numbers, found `1 2`"),
        (usual().replace("<item", "<item transform='0 0 0 0 0 0 0 0 0 0 0 0'"), "expected an invertible transform"),
        (format!("<!DOCTYPE model>{}", usual()), "a.model:1:1 Error document type declarations"),
        (model("<basematerials id='1'/>", "", [""; 4], ITEM), "two resources have the id 1"),
        (usual().replace("</mesh>", "</mash>"), "Error `</mash>` closes an element that is not open"),
    ] {
        let (scene, messages) = read(&text);
        assert!(scene.is_none() && messages.iter().any(|line| line.contains(expected)), "{expected}: {messages:?}"); // prose: keep
    }
    let (_, messages) = read_parts(&[("a.txt", b"x")]);
    assert!(messages[0].contains("the archive has no model"), "{messages:?}");
    let (_, messages) = read_parts(&[("_rels/.rels", RELATIONS.as_bytes())]);
    assert!(messages[0].contains("the archive has no part `3D/a.model`"), "{messages:?}");
}

#[test]
fn bombs_and_cycles_are_errors() {
    let blanks = vec![b' '; 96 << 20];
    let (scene, messages) = read_parts(&[("_rels/.rels", RELATIONS.as_bytes()), ("3D/a.model", &blanks)]);
    assert!(scene.is_none() && messages[0].contains("unpacks to 100663296 bytes"), "{messages:?}");
    let circle = model("", "", [""; 4], "<item objectid='2'/>").replace(
        "</resources>",
        "<object id='2'><components><component objectid='2'/></components></object></resources>",
    );
    let (scene, messages) = read(&circle);
    assert!(scene.is_none() && messages[0].contains("nested more than"), "{messages:?}");
    let mut laughs = String::new();
    for i in 2..30 {
        let inner = format!("<component objectid='{}'/>", i - 1).repeat(10);
        laughs += &format!("<object id='{i}'><components>{inner}</components></object>");
    }
    let text =
        model("", "", [""; 4], "<item objectid='29'/>").replace("</resources>", &format!("{laughs}</resources>"));
    let (scene, messages) = read(&text);
    assert!(scene.is_none() && messages[0].contains("counting each use"), "{messages:?}");
}

#[test]
fn changed_bytes_cause_no_panic() {
    let text = model(
        "<m:colorgroup id='6'><m:color color='#00FF00'/></m:colorgroup>",
        "",
        ["pid='6' p1='0'", "", "", ""],
        ITEM,
    );
    let bytes = archive(&[("_rels/.rels", RELATIONS.as_bytes()), ("3D/a.model", text.as_bytes())]);
    for end in (0..bytes.len()).step_by(3) {
        durer::fuzz::model(&bytes[..end], "x.3mf");
    }
    let mut numbers = Random(7);
    let mut random = |below| numbers.below(below);
    for round in 0..600 {
        // Change some bytes of the archive, or of the text inside it.
        let inner = round % 2 == 0;
        let mut changed = if inner { text.as_bytes().to_vec() } else { bytes.clone() };
        for _ in 0..1 + random(3) {
            let at = random(changed.len());
            changed[at] = changed[random(changed.len())];
        }
        if inner {
            changed = archive(&[("_rels/.rels", RELATIONS.as_bytes()), ("3D/a.model", &changed)]);
        }
        durer::fuzz::model(&changed, "x.3mf");
    }
}

/// Returns the folder that contains the Consortium's test files, if it exists.
fn corpus() -> Option<PathBuf> {
    let usual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let corpus = std::env::var_os("DURER_CORPUS").map_or(usual, PathBuf::from).join("samples/meshes/3mf");
    let there = corpus.is_dir();
    if !there {
        println!("skipped: no {}", corpus.display());
    }
    there.then_some(corpus)
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let found = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<PathBuf> = found.filter(|path| path.extension().is_some_and(|e| e == "3mf")).collect();
    found.sort();
    found
}

/// Test files with invalid models that are still read without an error, because the fault does not
/// affect the picture. The faults concern relationships and data that are not shown, schemas, and
/// property layers that a printer could not produce.
const HARMLESS: [&str; 18] = [
    "3MF100_Extension_Chapter4b_MatId_IsNotBaseMaterials",
    "3MF100_Extension_Chapter5b_MultipleReferenceToBaseAndCompositeMatterials",
    "3MF100_Extension_Chapter5b_MultipleReferenceToBaseMatterials",
    "3MF100_Extension_Chapter5b_ReferToAnotherMultiProperties",
    "3MF100_Extension_Chapter5c_MultipleReferenceToColorgroup",
    "3MF100_Extension_Chapter5d_MultipleReferenceToCompositeMaterials",
    "3MF100_Extension_Chapter5e_ReferenceToMultiProperties",
    "3MF100_Extension_Chapter6_2DTexture_InvalidContentType",
    "Chapter2.1.1a_PartsRelationships_NonExist3DModelPart",
    "Chapter2.1.1b_PartsRelationships_LinkToExternal",
    "Chapter2.1.3_PartsRelationships_NonExistThumbnailPart",
    "Chapter2.1.4_PartsRelationships_MoreThanOnePrintTicket",
    "Chapter2.3.2c_UndefinedNameSpaceInXDS",
    "Chapter2.3.2d_UndefinedXMLXSIInXSDSchema",
    "Chapter2.3.4_WhiteSpace",
    "Chapter3.4.1a_MissingMetadataName",
    "Chapter3.4.1b_DuplicatedMetadataName",
    "Chapter3.4.3.1b_BuildItemReferToObjectOfTypeOther",
];

#[test]
fn consortium_files_are_accepted_or_rejected() {
    let Some(corpus) = corpus() else { return };
    let sound = entries(&corpus).into_iter().chain(entries(&corpus.join("mustpass")));
    for path in sound {
        let (scene, messages) = read_file(&path);
        let scene = scene.unwrap_or_else(|| panic!("{}: {messages:?}", path.display())); // prose: keep
        assert!(!shown(&scene).is_empty(), "{}", path.display());
    }
    let read = entries(&corpus.join("mustfail")).into_iter().filter(|path| read_file(path).0.is_some());
    let names: Vec<String> = read.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(names, HARMLESS.map(|name| format!("MUSTFAIL_{name}")));
}

#[test]
fn part_names_ignore_case_and_escapes() {
    let text = model("", "", [""; 4], ITEM);
    let relation = |target: &str| {
        format!("<Relationships><Relationship Target='{target}' Type='http://x/3dmodel'/></Relationships>")
    };
    for (target, part) in
        [("/3D/A.model", "3D/a.model"), ("/3D/a%20b.model", "3D/a b.model"), ("/3D/a%20b.model", "3D/a%20b.model")]
    {
        let (scene, messages) = read_parts(&[("_rels/.rels", relation(target).as_bytes()), (part, text.as_bytes())]);
        assert!(scene.is_some() && messages.is_empty(), "{target} {part}: {messages:?}"); // prose: keep
    }
}

#[test]
fn models_may_be_in_utf_16() {
    let text = model("", "", [""; 4], ITEM);
    for number in [u16::to_le_bytes, u16::to_be_bytes] {
        let bytes: Vec<u8> = "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(number).collect();
        let (scene, messages) = read_parts(&[("_rels/.rels", RELATIONS.as_bytes()), ("3D/a.model", &bytes)]);
        assert!(scene.is_some() && messages.is_empty(), "{messages:?}");
    }
}
