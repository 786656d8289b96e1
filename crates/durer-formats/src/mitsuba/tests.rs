//! Tests of the Mitsuba reader: its syntax, its conventions compared with analytic results, and the
//! positions of errors.

mod bright;
mod conventions;
mod materials;
mod shapes;

use crate::testing::{folder, read_in};
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::random::Random;
use durer_scene::scene::{Material, Object, ObjectKind, Scene};
use durer_scene::shape::{MeshData, Primitive};
use std::path::Path;

fn read(text: &str) -> (Option<Scene>, Vec<String>) {
    read_in(&std::env::temp_dir(), "scene.xml", text)
}

/// Reads elements inside a scene, which must not cause any diagnostics.
fn clean(inner: &str) -> Scene {
    let (scene, messages) = read(&format!("<scene version='3.0.0'>{inner}</scene>"));
    assert_eq!(messages, [""; 0], "{inner}");
    scene.unwrap()
}

/// Reads a scene whose files are in a folder. The scene must not cause any diagnostics.
fn clean_in(files: &[(&str, &[u8])], inner: &str) -> Scene {
    let folder = folder(files);
    let (scene, messages) = read_in(folder.path(), "scene.xml", &format!("<scene version='3.0.0'>{inner}</scene>"));
    assert_eq!(messages, [""; 0], "{inner}");
    scene.unwrap()
}

/// Returns a PFM file of 2 x 1 pixels.
fn picture(pixels: [[f32; 3]; 2]) -> Vec<u8> {
    let mut bytes = b"PF\n2 1\n-1.0\n".to_vec();
    pixels.as_flattened().iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    bytes
}

fn layers(bsdf: &str) -> PrincipledMaterial {
    let scene = clean(&format!("<shape type='sphere'>{bsdf}</shape>"));
    let Material::Principled(layers) = material(&scene) else { panic!("{bsdf}") };
    (**layers).clone()
}

/// Returns the only mesh of a scene.
fn mesh(scene: &Scene) -> &MeshData {
    scene.assets.meshes.values().next().unwrap()
}

/// Returns the objects that have a shape, in order.
fn objects(scene: &Scene) -> Vec<&Object> {
    fn gather<'a>(object: &'a Object, all: &mut Vec<&'a Object>) {
        match &object.node {
            ObjectKind::Group(group) => group.objects.iter().for_each(|object| gather(object, all)),
            ObjectKind::Transform(_, inner) => gather(inner, all),
            // Skip the ground that belongs to the default scene setup.
            ObjectKind::Primitive(Primitive::Plane(_)) => {}
            _ => all.push(object),
        }
    }
    let mut all = Vec::new();
    scene.root.iter().flat_map(|root| &root.objects).for_each(|object| gather(object, &mut all));
    all
}

/// Returns the material of the first object.
fn material(scene: &Scene) -> &Material {
    &scene.materials[objects(scene)[0].material.unwrap() as usize].value
}

#[test]
fn variables_includes_and_old_names_are_read() {
    let folder = folder(&[
        ("a.xml", b"<scene version='3.0.0'><default name='r' value='3'/><default name='rr' value='5'/><include filename='sub/b.xml'/></scene>"),
        ("sub/b.xml", b"<scene><default name='r' value='7'/><shape type='sphere'><float name='radius' value='$r'/></shape>\
            <shape type='sphere'><float name='radius' value='1$rr'/></shape></scene>"),
        ("c.xml", b"<scene version='0.6.0'><bsdf type='plastic' id='m'><spectrum name='diffuseReflectance' value='.1,.2,.3'/>\
            <float name='intIOR' value='1.6'/><float name='extIOR' value='1'/></bsdf><shape type='sphere'><transform name='toWorld'>\
            <translate x='1'/></transform><ref id='m'/></shape></scene>"),
    ]);
    let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let (scene, messages) = read_in(folder.path(), "a.xml", &text("a.xml"));
    assert_eq!(messages, [""; 0]);
    let spheres = objects(scene.as_ref().unwrap()).into_iter().map(|object| format!("{:?}", object.node));
    let spheres: Vec<String> = spheres.collect();
    assert!(spheres[0].contains("radius: 3.0") && spheres[1].contains("radius: 15.0"), "{spheres:?}");
    let (scene, messages) = read_in(folder.path(), "c.xml", &text("c.xml"));
    assert_eq!(messages, [""; 0]);
    let scene = scene.unwrap();
    let Material::Principled(layers) = material(&scene) else { panic!() };
    assert_eq!(layers.specular_ior, 1.6);
    // Mitsuba approximates the light that plastic reflects inside, to within 0.1 %.
    assert!((layers.base_color.z / 0.3 - 1.0).abs() < 1e-3, "{}", layers.base_color.z);
    assert!(format!("{:?}", objects(&scene)[0].node).contains("Vec3(1.0, 0.0, 0.0)"));
}

#[test]
fn diagnostics_have_their_place() {
    // Each entry has a scene, a text at whose last occurrence the diagnostic is expected, and the
    // diagnostic.
    for (inner, there, expected) in [
        ("<shape type='sphere'><float name='radius' value='x'/></shape>", "x'/>", "error expected a number, found `x`"),
        ("<shape type='sphere'><float name='radius' value='-1'/></shape>", "-1", "error `radius` must be more than 0"),
        (
            "<shape type='sphere'><float name='radius' value='$a'/></shape>",
            "$a",
            "error the variable `$a` is undefined (write",
        ),
        (
            "<shape type='spher'/>",
            "spher",
            "warning the shape `spher` has no counterpart: it is ignored (did you mean `sphere`?)",
        ),
        ("<shape/>", "shape", "error `<shape>` needs `type=\"...\"`"),
        ("<shap type='sphere'/>", "shap", "error unknown element `<shap>` (did you mean `shape`?)"),
        ("<shape type='sphere'><ref id='m'/></shape>", "m'/>", "error no plugin has the id `m`"),
        (
            "<shape type='sphere'><float name='radus' value='2'/></shape>",
            "radus'",
            "warning the shape `sphere` has no property `radus`: it is ignored (did you mean `radius`?)",
        ),
        (
            "<shape type='sphere'><bsdf type='measured'/></shape>",
            "measured",
            "warning the material `measured` has no counterpart: diffuse grey is used",
        ),
        (
            "<shape type='sphere'><float name='a' value='1'/><float name='a' value='2'/></shape>",
            "2'/>",
            "error `a` is given twice",
        ),
        ("<bsdf type='diffuse' id='a'/><bsdf type='diffuse' id='a'/>", "a'/>", "error the id `a` is given twice"),
        ("<shape type='serialized'/>", "serialized", "error the shape `serialized` needs a `filename`"),
        (
            "<shape type='serialized'><string name='filename' value='none.serialized'/><integer name='shape_index' value='-1'/></shape>",
            "-1",
            "error `shape_index` must be an integer of 0 or more",
        ),
        (
            "<shape type='ply'><string name='filename' value='none.ply'/></shape>",
            "none.ply",
            "error the mesh cannot be read",
        ),
        (
            "<shape type='ply'><string name='filename' value='../x.ply'/></shape>",
            "../x.ply",
            "error the mesh cannot be read",
        ),
        ("<include filename='scene.xml'/>", "scene.xml", "error `scene.xml` includes itself"),
        (
            "<sensor type='perspective'><float name='fov' value='200'/></sensor>",
            "200",
            "error a field of view must be more than 0",
        ),
        (
            "<sensor type='perspective'><film type='hdrfilm'><string name='pixel_format' value='luminance'/></film></sensor>",
            "luminance",
            "warning the pixel format `luminance` has no counterpart: `rgb` is used",
        ),
        ("<sensor type='fisheye'/>", "fisheye", "warning the sensor `fisheye` has no counterpart"),
        (
            "<emitter type='constant'/><emitter type='constant'/>",
            "constant",
            "error a scene may have only one infinite light",
        ),
        (
            "<shape type='sphere'><transform name='to_world'><scale value='0'/></transform></shape>",
            "scale",
            "error this step gives the transform no inverse",
        ),
        (
            "<shape type='sphere'><transform name='to_world'><turn/></transform></shape>",
            "turn",
            "error a transform cannot contain `<turn>`",
        ),
        (
            "<shape type='sphere'><bsdf type='conductor'><string name='material' value='Gold'/></bsdf></shape>",
            "Gold",
            "error unknown metal `Gold`",
        ),
        (
            "<shape type='sphere'><bsdf type='roughplastic'><string name='distribution' value='phong'/></bsdf></shape>",
            "phong",
            "warning the distribution `phong` has no counterpart",
        ),
    ] {
        let text = format!("<scene>{inner}</scene>");
        let (_, messages) = read(&text);
        let expected = format!("scene.xml:1:{} {expected}", 1 + text.rfind(there).unwrap());
        assert!(messages.iter().any(|line| line.starts_with(&expected)), "{expected}: {messages:#?}"); // prose: keep
    }
}

#[test]
fn errors_are_reported_once() {
    let messages = |inner: &str| read(&format!("<scene>{inner}</scene>")).1;
    for inner in [
        "<shape type='sphere'><float name='radius' value='$a'/></shape>",
        "<shape type='sphere'><point name='center' value='$a'/></shape>",
        "<shape type='sphere'><transform name='to_world'><scale value='$a'/></transform></shape>",
        "<bsdf type='diffuse' id='$a'/>",
    ] {
        let messages = messages(inner);
        assert!(messages.len() == 1 && messages[0].contains("the variable `$a` is undefined"), "{messages:?}");
    }
    let messages = messages(
        "<shape type='ply'><string name='filename' value='none.ply'/><bsdf type='diffuse'/>\
        <emitter type='area'/></shape>",
    );
    assert!(messages.len() == 1 && messages[0].contains("the mesh cannot be read"), "{messages:?}");
}

#[test]
fn hostile_files_are_refused() {
    // Cycles of materials, shapes and files, an XML entity expansion attack, deep nesting, and
    // instances of instances.
    let (scene, messages) = read(
        "<scene><bsdf type='twosided' id='a'><ref id='b'/></bsdf><bsdf type='twosided' id='b'><ref id='a'/></bsdf>\
        <shape type='sphere'><ref id='a'/></shape></scene>",
    );
    assert!(scene.is_none() && messages[0].contains("nested more than"), "{messages:?}");
    let (scene, messages) = read(
        "<scene><shape type='shapegroup' id='g'><shape type='instance'><ref id='g'/></shape></shape>\
        <shape type='instance'><ref id='g'/></shape></scene>",
    );
    assert!(scene.is_none() && messages[0].contains("nested more than"), "{messages:?}");
    let (scene, messages) = read("<!DOCTYPE s [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;'>]><scene/>");
    assert!(scene.is_none() && messages[0].contains("1:1 error"), "{messages:?}");
    let deep = "<bsdf type='twosided'>".repeat(3000);
    assert!(read(&format!("<scene>{deep}</scene>")).1[0].contains("nested more than"));
    let mut groups =
        String::from("<shape type='shapegroup' id='g0'><shape type='sphere'/><shape type='sphere'/></shape>");
    for i in 1..24 {
        let inner = format!("<shape type='instance'><ref id='g{}'/></shape>", i - 1).repeat(4);
        groups += &format!("<shape type='shapegroup' id='g{i}'>{inner}</shape>");
    }
    let (scene, messages) = read(&format!("<scene>{groups}<shape type='instance'><ref id='g23'/></shape></scene>"));
    assert!(scene.is_none() && messages[0].contains("more than 1048576 objects"), "{messages:?}");
    let folder = folder(&[
        ("a.xml", b"<scene><include filename='b.xml'/></scene>"),
        ("b.xml", b"<scene><include filename='a.xml'/></scene>"),
    ]);
    let (scene, messages) = read_in(folder.path(), "a.xml", "<scene><include filename='b.xml'/></scene>");
    assert!(scene.is_none() && messages[0].starts_with("b.xml:1:27 error `a.xml` includes itself"), "{messages:?}");
    let (_, messages) = read_in(folder.path(), "a.xml", "<scene><include filename='/etc/hostname'/></scene>");
    assert!(messages[0].starts_with("a.xml:1:27 error"), "{messages:?}");
}

#[test]
fn truncated_and_changed_files_never_panic() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/xml/own.xml");
    let Ok(text) = std::fs::read(path) else { return };
    for end in (0..text.len()).step_by(7) {
        durer::fuzz::model(&text[..end], "x.xml");
    }
    let mut numbers = Random(7);
    let mut random = |below| numbers.below(below);
    for _ in 0..600 {
        let mut changed = text.clone();
        for _ in 0..1 + random(4) {
            let at = random(changed.len());
            changed[at] = changed[random(changed.len())];
        }
        durer::fuzz::model(&changed, "x.xml");
    }
}
