//! Models on the command line: rendered, told about, converted, refused at their place.

mod common;

use common::Place;

const STL: &str = "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 1\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 1 1 0.5\nvertex 0 1 1\nendloop\nendfacet\nendsolid a\n";

const SMALL: &str = "--size 24x16 --samples 2";

#[test]
fn a_model_is_rendered_from_all_sides_in_any_light() {
    let place = Place::new();
    place.put("a.stl", STL);
    let hash = |more: &str| place.gives(0, &format!("render a.stl -o a.png {SMALL} --hash -q {more}")).out;
    let usual = hash("");
    assert_eq!(hash("--up z --view three-quarter --studio soft"), usual);
    for other in ["--up y", "--view front", "--view side", "--view top", "--view iso", "--studio sun", "--studio none"]
    {
        assert_ne!(hash(other), usual, "{other}");
    }
    place.refused(2, "render a.stl -o a.png --view behind", &["behind", "three-quarter"]);
    place.refused(2, "render a.stl -o a.png --at soon", &["--at", "seconds"]);
    assert!(place.gives(0, "info a.stl").out.contains("2 in meshes"));
}

#[test]
fn a_model_is_converted_and_is_no_scene_in_words() {
    let place = Place::new();
    place.put("a.stl", STL);
    for name in ["b.ply", "b.obj", "b.stl"] {
        place.gives(0, &format!("convert a.stl -o {name}"));
        assert!(place.gives(0, &format!("info {name}")).out.contains("2 in meshes"), "{name}");
    }
    place.refused(2, "convert a.stl -o a.txt", &[".ply, .obj, .stl"]);
}

#[test]
fn what_is_wrong_with_a_model_is_said_at_line_and_column() {
    let place = Place::new();
    place.put("a.stl", STL.replace("1 1 0.5", "1 1 x"));
    place.refused(2, "render a.stl -o a.png", &["a.stl:12:12", "expected a number, found `x`"]);
    place.put("a.gltf", "{ \"asset\": { \"version\": \"2.0\" },\n  \"nodes\": [{ \"mesh\": 3 }] }");
    place.refused(2, "render a.gltf -o a.png", &["UNRESOLVED_REFERENCE", "/nodes/0/mesh", "a.gltf:2:23"]);
    assert!(!place.path("a.png").exists());
}
