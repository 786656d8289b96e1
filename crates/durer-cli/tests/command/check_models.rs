//! Tests the findings of `durer check` about model files: their causes, and their words, which must
//! not be those of the scene language.

use crate::common::{self, TestFolder};
use serde_json::Value;

/// Keywords of the scene language that no finding about a model may contain.
const KEYWORDS: [&str; 8] = [
    "baseColor",
    "diffuseColor",
    "`direction",
    "MaterialIndex",
    "walls thin",
    "emissionLuminance",
    "`center",
    "`color",
];

const PBRT: &str = r#"Film "rgb" "integer xresolution" 100 "integer yresolution" 75
Integrator "path" "integer maxdepth" 8
Scale -1 1 1
LookAt 2 3 8  0 0.8 0  0 1 0
Camera "perspective" "float fov" 36
WorldBegin
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 9 9 8 ]
    Material "diffuse" "rgb reflectance" [ 0 0 0 ]
    Translate 1 5 2
    Rotate 90 1 0 0
    Shape "disk" "float radius" 0.8
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.48 ]
Shape "trianglemesh" "integer indices" [ 0 2 1 0 3 2 ] "point3 P" [ -8 0 -8  8 0 -8  8 0 8  -8 0 8 ]
AttributeBegin
    Material "coateddiffuse" "rgb reflectance" [ 0.1 0.3 0.7 ] "float roughness" 0.1
    Translate 0 1 0
    Shape "sphere" "float radius" 1
AttributeEnd
"#;

const MITSUBA: &str = r#"<scene version="3.0.0">
  <integrator type="path"><integer name="max_depth" value="8"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="36"/>
    <transform name="to_world"><lookat origin="2,3,8" target="0,0.8,0" up="0,1,0"/></transform>
    <film type="hdrfilm"><integer name="width" value="100"/><integer name="height" value="75"/></film>
  </sensor>
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="90"/><translate x="1" y="5" z="2"/></transform>
    <emitter type="area"><rgb name="radiance" value="7,7,6"/></emitter>
  </shape>
  <shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="-90"/><scale value="8"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.5,0.5,0.48"/></bsdf>
  </shape>
  <shape type="sphere"><point name="center" x="0" y="1" z="0"/><float name="radius" value="1"/>
    <bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.1,0.3,0.7"/></bsdf></shape>
</scene>
"#;

const RADIANCE: &str = "void plastic grey
0
0
5 0.5 0.5 0.48 0 0
void light lamp
0
0
3 12 12 10
grey polygon floor
0
0
12  -4 -4 0   4 -4 0   4 4 0   -4 4 0
grey sphere ball
0
0
4 0 0 1 1
lamp polygon panel
0
0
12  -0.5 0.5 4   0.5 0.5 4   0.5 -0.5 4   -0.5 -0.5 4
";

const GLTF: &str = include_str!("files/panel.gltf");

const USD: &str = include_str!("files/ball.usda");

const STL: &str = "solid sheet
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 1 0 0
vertex 1 1 0
vertex 0 1 0
endloop
endfacet
endsolid sheet
";

/// Extension of a model, its text, replacements in the text, and the expected code.
type Case = (&'static str, &'static str, &'static [(&'static str, &'static str)], &'static str);

/// Changes of correct models, each with the code of the first finding. An empty code means that
/// there is no warning.
const CASES: &[Case] = &[
    ("pbrt", PBRT, &[], ""),
    ("pbrt", PBRT, &[("\"integer maxdepth\" 8", "\"integer maxdepth\" 0")], "no-bounces"),
    ("pbrt", PBRT, &[("Rotate 90", "Rotate -90")], "lamp-turned"),
    ("pbrt", PBRT, &[("Rotate 90", "Rotate 1.5708")], "radians"),
    ("pbrt", PBRT, &[("\"float fov\" 36", "\"float fov\" 0.6")], "too-narrow"),
    (
        "pbrt",
        PBRT,
        &[
            ("AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 8 ]", ""),
            ("WorldBegin", "WorldBegin\nLightSource \"infinite\" \"rgb L\" [ 0.6 0.7 0.9 ] \"float scale\" 0"),
        ],
        "black-sky",
    ),
    (
        "pbrt",
        PBRT,
        &[
            ("AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 8 ]", ""),
            ("WorldBegin", "WorldBegin\nLightSource \"point\" \"rgb I\" [ 0.05 0.05 0.05 ] \"point3 from\" [ 2 4 3 ]"),
        ],
        "light-faint",
    ),
    ("pbrt", PBRT, &[("[ 0.5 0.5 0.48 ]", "[ 0 0 0 ]")], "black-material"),
    ("pbrt", PBRT, &[("WorldBegin\n", "")], "bad-place"),
    (
        "pbrt",
        PBRT,
        &[
            ("LookAt 2 3 8  0 0.8 0  0 1 0\n", ""),
            ("\"float fov\" 36\n", "\"float fov\" 36\nLookAt 2 3 8  0 0.8 0  0 1 0\n"),
        ],
        "bad-place",
    ),
    (
        "pbrt",
        PBRT,
        &[
            ("WorldBegin\nAttributeBegin\n", "WorldBegin\n"),
            ("\"float radius\" 0.8\nAttributeEnd", "\"float radius\" 0.8"),
        ],
        "bad-place",
    ),
    // The light ends before its shape, and no shape follows it at all.
    ("pbrt", PBRT, &[("\"rgb L\" [ 9 9 8 ]\n", "\"rgb L\" [ 9 9 8 ]\nAttributeEnd\nAttributeBegin\n")], "bad-place"),
    // The material comes after its shape.
    (
        "pbrt",
        PBRT,
        &[
            ("    Material \"coateddiffuse\" \"rgb reflectance\" [ 0.1 0.3 0.7 ] \"float roughness\" 0.1\n", ""),
            ("\"float radius\" 1\n", "\"float radius\" 1\n    Material \"coateddiffuse\"\n"),
        ],
        "bad-place",
    ),
    ("pbrt", PBRT, &[("WorldBegin\n", "WorldBegin\nScale 1000 1000 1000\n")], "camera-inside"),
    // The eye and the target are exchanged.
    (
        "pbrt",
        PBRT,
        &[
            ("LookAt 2 3 8  0 0.8 0", "LookAt 1.6 1.6 0  2 1.4 8"),
            ("Material \"coateddiffuse\"", "Shape \"sphere\" \"float radius\" 0.4\nMaterial \"coateddiffuse\""),
        ],
        "camera-away",
    ),
    (
        "pbrt",
        PBRT,
        &[
            ("\"integer maxdepth\" 8", "\"integer maxdepth\" 1"),
            ("coateddiffuse", "dielectric"),
            ("\"rgb reflectance\" [ 0.1 0.3 0.7 ] \"float roughness\" 0.1", ""),
        ],
        "no-bounces",
    ),
    ("xml", MITSUBA, &[], ""),
    ("xml", MITSUBA, &[("name=\"max_depth\" value=\"8\"", "name=\"max_depth\" value=\"1\"")], "no-bounces"),
    ("xml", MITSUBA, &[("angle=\"90\"", "angle=\"-90\"")], "lamp-turned"),
    ("xml", MITSUBA, &[("angle=\"-90\"", "angle=\"90\"")], "seen-from-behind"),
    // The light lies in the floor, because it is moved before it is turned.
    (
        "xml",
        MITSUBA,
        &[(
            "<rotate x=\"1\" angle=\"90\"/><translate x=\"1\" y=\"5\" z=\"2\"/>",
            "<translate y=\"3\"/><rotate x=\"1\" angle=\"90\"/>",
        )],
        "lamp-turned",
    ),
    (
        "xml",
        MITSUBA,
        &[("<float name=\"fov\"", "<float name=\"far_clip\" value=\"3\"/><float name=\"fov\"")],
        "clipped",
    ),
    // The far distance cuts away the ball, but not all of the floor.
    (
        "xml",
        MITSUBA,
        &[("<float name=\"fov\"", "<float name=\"far_clip\" value=\"6.5\"/><float name=\"fov\"")],
        "clipped",
    ),
    ("xml", MITSUBA, &[("value=\"7,7,6\"", "value=\"0,0,0\"")], "black-light"),
    ("xml", MITSUBA, &[("value=\"0.5,0.5,0.48\"", "value=\"128, 128, 122\"")], "color-range"),
    // The light is below the floor and faces down.
    (
        "xml",
        MITSUBA,
        &[(
            "<rotate x=\"1\" angle=\"90\"/><translate x=\"1\" y=\"5\" z=\"2\"/>",
            "<translate x=\"1\" y=\"5\" z=\"2\"/><rotate x=\"1\" angle=\"90\"/>",
        )],
        "lamp-blocked",
    ),
    ("xml", MITSUBA, &[("value=\"7,7,6\"", "value=\"0.007,0.007,0.006\"")], "too-dark"),
    ("rad", RADIANCE, &[], ""),
    (
        "rad",
        RADIANCE,
        &[("-0.5 0.5 4   0.5 0.5 4   0.5 -0.5 4   -0.5 -0.5 4", "-0.5 -0.5 4   0.5 -0.5 4   0.5 0.5 4   -0.5 0.5 4")],
        "lamp-turned",
    ),
    ("rad", RADIANCE, &[("5 0.5 0.5 0.48", "5 178 26 26")], "color-range"),
    ("rad", RADIANCE, &[("12  -4 -4 0", "9  -4 -4 0")], "bad-value"),
    ("rad", RADIANCE, &[("12  -4 -4 0", "15  -4 -4 0")], "bad-value"),
    ("rad", RADIANCE, &[("4 0 0 1 1", "4 0 0 800 800")], "out-of-scale"),
    ("gltf", GLTF, &[], ""),
    ("gltf", GLTF, &[("\"yfov\":0.6", "\"yfov\":35")], "CAMERA_YFOV_GEQUAL_PI"),
    ("gltf", GLTF, &[("[0,1,2,3]}],\"nodes\"", "[1,2,3]}],\"nodes\"")], "NODE_NO_SCENE"),
    // A second scene may contain nodes that the first one does not.
    ("gltf", GLTF, &[("[0,1,2,3]}],\"nodes\"", "[1,2,3]},{\"nodes\":[0]}],\"nodes\"")], ""),
    ("gltf", GLTF, &[("\"TEXCOORD_0\":1", "\"TEXCOORD_0\":1,\"COLOR_0\":2")], "dark-colors"),
    (
        "gltf",
        GLTF,
        &[("\"name\":\"Poster\",", "\"name\":\"Poster\",\"normalTexture\":{\"index\":0,\"texCoord\":1},")],
        "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
    ),
    ("gltf", GLTF, &[("\"byteOffset\":128", "\"byteOffset\":56")], "ACCESSOR_INDEX_OOB"),
    (
        "gltf",
        GLTF,
        &[("\"name\":\"Poster\",", "\"name\":\"Poster\",\"alphaMode\":\"MASK\",\"alphaCutoff\":9,")],
        "ALPHA_CUTOFF",
    ),
    (
        "gltf",
        GLTF,
        &[
            ("\"name\":\"Poster\",", "\"name\":\"Poster\",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.9,"),
            (
                "\"baseColorTexture\":{\"index\":0}",
                "\"baseColorTexture\":{\"index\":0},\"baseColorFactor\":[1,1,1,0.8]",
            ),
        ],
        "ALPHA_CUTOFF",
    ),
    // The triangles are wound against their normals, so that the front is hidden.
    (
        "gltf",
        GLTF,
        &[
            ("\"TEXCOORD_0\":1", "\"TEXCOORD_0\":1,\"NORMAL\":2"),
            (
                "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAEAAgAAAAIAAwA=",
                "gD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAIAAQAAAAMAAgA=",
            ),
        ],
        "inside-out",
    ),
    // The sun shines upwards, from below a floor, and the background brightens the picture.
    (
        "gltf",
        GLTF,
        &[
            (
                "\"scale\":[2,2,1],\"translation\":[0,-1,-2]",
                "\"rotation\":[-0.7071,0,0,0.7071],\"scale\":[20,20,1],\"translation\":[0,-0.01,20]",
            ),
            ("\"translation\":[-1,0,0]", "\"translation\":[-1,0,0],\"scale\":[0.4,0.4,0.4]"),
            ("\"name\":\"Sun\",", "\"name\":\"Sun\",\"rotation\":[0.5,0,0,0.866],"),
        ],
        "light-behind",
    ),
    // The wall is a metal, which the sun does not light towards the camera.
    (
        "gltf",
        GLTF,
        &[
            ("[0.5,0.5,0.5,1],\"metallicFactor\":0", "[0.5,0.5,0.5,1],\"roughnessFactor\":0.1"),
            ("\"name\":\"Sun\",", "\"name\":\"Sun\",\"rotation\":[-0.3,0.3,0.09,0.9],"),
        ],
        "metal-default",
    ),
    (
        "gltf",
        GLTF,
        &[
            ("[0.5,0.5,0.5,1],\"metallicFactor\":0", "[0.5,0.5,0.5,1],\"metallicFactor\":0.2"),
            ("\"name\":\"Sun\",", "\"name\":\"Sun\",\"rotation\":[-0.3,0.3,0.09,0.9],"),
        ],
        "",
    ),
    ("usda", USD, &[], ""),
    (
        "usda",
        USD,
        &[("(0, 0.7, 0)\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]", "(0, 0.7, 0)")],
        "missing-field",
    ),
    ("usda", USD, &[("(0, 0.7, 0)", "(0, 0.7, 0")], "syntax"),
    ("usda", USD, &[("upAxis = \"Y\"\n)", "upAxis = \"Y\"\n")], "syntax"),
    (
        "usda",
        USD,
        &[
            ("def Mesh \"Ground\"\n{", "def Mesh \"Ground\"\n{\n    uniform token purpose = \"guide\""),
            ("def Sphere \"Ball\"\n{", "def Sphere \"Ball\"\n{\n    uniform token purpose = \"guide\""),
            // The surface of a light would be visible.
            ("def SphereLight \"Bulb\"", "def DistantLight \"Sun\""),
        ],
        "no-objects",
    ),
    // The radius of the ball is in another unit, so that it surrounds everything but the sun.
    (
        "usda",
        USD,
        &[("radius = 0.7", "radius = 70"), ("def SphereLight \"Bulb\"", "def DistantLight \"Sun\"")],
        "camera-inside",
    ),
    // The camera is upside down above a floor that is a mesh.
    (
        "usda",
        USD,
        &[(
            "(0, 1.2, 7)\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]",
            "(0, 1.2, 7)\n    float xformOp:rotateZ = 180\n    uniform token[] xformOpOrder = \
             [\"xformOp:translate\", \"xformOp:rotateZ\"]",
        )],
        "upside-down",
    ),
    // The sun has no rotation, so it shines along the floor.
    (
        "usda",
        USD,
        &[("def SphereLight \"Bulb\"", "def DistantLight \"Sun\""), ("intensity = 40", "intensity = 50000")],
        "light-behind",
    ),
    ("stl", STL, &[], ""),
    ("obj", STL, &[], "bad-file"),
    (
        "stl",
        STL,
        &[("1 0 0\nvertex 0 1 0", "0 0 0\nvertex 0 1 0"), ("vertex 1 1 0", "vertex 1 0 0")],
        "degenerate-mesh",
    ),
    ("stl", OBJ, &[], "bad-file"),
    ("ply", PLY, &[], ""),
    ("ply", PLY, &[("element vertex 4", "element vertex 3")], "bad-file"),
    ("ply", PLY, &[("format ascii", "format binary_little_endian")], "bad-file"),
    ("off", OFF, &[], ""),
    ("off", OFF, &[("OFF\n5 6", "OFF\n6 5")], "bad-file"),
    ("off", OFF, &[("3 0 1 4", "4 0 1 4")], "bad-file"),
    // A point cloud is shown as small balls.
    ("ply", CLOUD, &[], ""),
    (
        "ply",
        PLY,
        &[("255 128 0\n1 0 0 255 128 0", "1 0 0\n1 0 0 1 0 0"), ("200 90 10\n0 0 1 200 90 10", "0 1 1\n0 0 1 1 1 1")],
        "dark-colors",
    ),
    ("obj", OBJ, &[], ""),
    (
        "obj",
        OBJ,
        &[("v 0 2 0", "v 0 2 0\nv 50000 0 0\nv 50000 1 0\nv 50000 0 1"), ("f 1 2 3", "f 1 2 3\nf 6 7 8")],
        "stray-points",
    ),
];

const PLY: &str = "ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 4
property list uchar int vertex_indices
end_header
0 0 0 255 128 0
1 0 0 255 128 0
0 1 0 200 90 10
0 0 1 200 90 10
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
";

const OFF: &str = "OFF
5 6 0
0 0 0
1 0 0
1 1 0
0 1 0
0.5 0.5 1
3 0 1 4
3 1 2 4
3 2 3 4
3 3 0 4
3 0 3 2
3 0 2 1
";

const CLOUD: &str = "ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
end_header
0 0 0
1 0 0
0 1 0
0 0 1
0.5 0.4 0.6
";

const OBJ: &str = "v 1 0 0
v 0 2 0
v -1 0 0
v 0 0 1
v 0 0.5 2
v 0.2 0.1 -1
v 0.1 0.3 1
f 1 2 3
f 1 4 2
f 3 2 5
f 4 6 7
";

#[test]
fn causes_in_models_are_reported_first_and_in_neutral_words() {
    let folder = TestFolder::new();
    let mut wrong = Vec::new();
    for (number, (extension, text, changes, expected)) in CASES.iter().enumerate() {
        let mut changed = text.to_string();
        for (old, new) in *changes {
            assert!(changed.contains(old), "{old}");
            changed = changed.replacen(old, new, 1);
        }
        let name = format!("{number}.{extension}");
        folder.write(&name, changed);
        let output = folder.run(&format!("check {name} --json"));
        let json: Value = serde_json::from_str(&output.out).unwrap_or_else(|error| panic!("{error}: {}", output.err));
        let findings = json["scenes"][0]["findings"].as_array().unwrap();
        let first = findings.iter().find(|finding| finding["severity"] != "note");
        let code = first.map_or("", |finding| finding["code"].as_str().unwrap());
        if code != *expected {
            wrong.push(format!("{name} {changes:?}: {code} instead of {expected}"));
        }
        for finding in findings {
            let text = ["message", "effect", "help"].map(|field| finding[field].as_str().unwrap_or_default()).join(" ");
            wrong.extend(KEYWORDS.iter().filter(|word| text.contains(**word)).map(|word| format!("{word}: {text}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The only light of Khronos's sample is reflected past the camera, so that most of the metal is
/// black.
#[test]
fn models_whose_only_light_misses_them_are_reported() {
    let path = "samples/gltf/khronos/IridescenceSuzanne/glTF-Binary/IridescenceSuzanne.glb";
    let Some(model) = common::corpus().map(|corpus| corpus.join(path)).filter(|model| model.exists()) else {
        return println!("skipped: no {path} in the corpus");
    };
    let folder = TestFolder::new();
    let output = folder.expect_exit(1, &format!("check {} --studio none", model.display())).out;
    assert!(output.contains("mostly-black") && output.contains("the scene's only light does not reach it"), "{output}");
    // With the surroundings that a model gets by default, all of it is visible.
    let output = folder.run(&format!("check {}", model.display())).out;
    assert!(!output.contains("mostly-black"), "{output}");
}

/// Findings about models name the words of the file and their places.
#[test]
fn places_and_words_are_those_of_the_file() {
    let folder = TestFolder::new();
    let said = |name: &str, text: &str, old: &str, new: &str| {
        assert!(text.contains(old), "{old}");
        folder.write(name, text.replacen(old, new, 1));
        folder.run(&format!("check {name}")).out
    };
    let clip =
        said("a.xml", MITSUBA, "<float name=\"fov\"", "<float name=\"far_clip\" value=\"3\"/><float name=\"fov\"");
    assert!(clip.contains("a.xml:4:18") && clip.contains("write `far_clip "), "{clip}");
    let color = said("b.xml", MITSUBA, "0.5,0.5,0.48", "128, 128, 122");
    assert!(color.contains("divide") || color.contains("not to 255"), "{color}");
    assert!(color.contains("128, 128, 122") && color.contains("^^^^^^^^^^^"), "{color}");
    let word = said("c.xml", MITSUBA, "name=\"fov\"", "name=\"fieldOfView\"");
    assert!(word.contains("no property `fieldOfView`") && word.contains("did you mean `fov`?"), "{word}");
    let light = said("d.pbrt", PBRT, "[ 9 9 8 ]\n", "[ 9 9 8 ]\nAttributeEnd\nAttributeBegin\n");
    assert!(light.contains("this `AreaLightSource` has no shape") && light.contains("d.pbrt:8:22"), "{light}");
    assert!(!light.contains("no-emitter"), "{light}");
    let dim = said("f.xml", MITSUBA, "7,7,6", "0.007,0.007,0.006");
    assert!(dim.contains("f.xml:10:") && dim.contains("emits only 0.007 0.007 0.006"), "{dim}");
    assert!(!dim.contains("one-color"), "{dim}");
    let black = said("m.xml", MITSUBA, "7,7,6", "0,0,0");
    assert!(black.contains("black-light") && !black.contains("moved twice"), "{black}");
    let below = said(
        "g.xml",
        MITSUBA,
        "<rotate x=\"1\" angle=\"90\"/><translate x=\"1\" y=\"5\" z=\"2\"/>",
        "<translate x=\"1\" y=\"5\" z=\"2\"/><rotate x=\"1\" angle=\"90\"/>",
    );
    assert!(below.contains("its center is at 1 -2 5"), "{below}");
    let scaled = said("h.pbrt", PBRT, "WorldBegin\n", "WorldBegin\nScale 1000 1000 1000\n");
    assert!(scaled.contains("h.pbrt:7:1") && scaled.contains("scales all objects, but not the camera"), "{scaled}");
    let parenthesis = said("i.usda", USD, "upAxis = \"Y\"\n)", "upAxis = \"Y\"\n");
    assert!(parenthesis.contains("i.usda:2:1") && parenthesis.contains("before `def`"), "{parenthesis}");
    let rows = said("j.ply", PLY, "element vertex 4", "element vertex 3");
    assert!(rows.contains("one more row of 6 numbers follows") && rows.contains("`element vertex 4`"), "{rows}");
    let text = said("k.ply", PLY, "format ascii", "format binary_little_endian");
    assert!(text.contains("k.ply:2:1") && text.contains("write `format ascii 1.0`"), "{text}");
    let late = said(
        "l.pbrt",
        PBRT,
        "    Shape \"sphere\" \"float radius\" 1\n",
        "    Shape \"sphere\" \"float radius\" 1\n    Material \"conductor\"\n",
    );
    assert!(late.contains("this material applies to no shape"), "{late}");
    let open = said("e.usda", USD, "(0, 0.7, 0)", "(0, 0.7, 0");
    assert!(open.contains("this `(` is not closed"), "{open}");
}

/// A surface that hides its back from the camera is named, and nothing else is blamed.
#[test]
fn a_model_seen_from_its_hidden_back_is_explained() {
    let folder = TestFolder::new();
    let quad = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\
        \"rotation\":[0,1,0,0]},{\"camera\":0,\"translation\":[0.5,0.5,3]}],\"cameras\":[{\"type\":\"perspective\",\
        \"perspective\":{\"yfov\":0.7,\"znear\":0.1}}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],\"materials\":[{}],\
        \"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\
        \"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\
        \"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";
    let quad = quad.replace("\"scenes\":[{\"nodes\":[0]}]", "\"scenes\":[{\"nodes\":[0,1]}]");
    let quad = quad.replace("\"translation\":[0.5,0.5,3]", "\"translation\":[-0.4,0.4,3]");
    folder.write("back.gltf", &quad);
    // With `--camera`, the camera stays where it is, and no ground is added.
    let output = folder.expect_exit(1, "check back.gltf --camera 0").out;
    assert!(output.contains("shows the camera only its back") && output.contains("`doubleSided`"), "{output}");
    assert!(!output.contains("all-missed") && !output.contains("too-dark"), "{output}");
    folder.write("front.gltf", quad.replace("[0,1,0,0]", "[0,0,0,1]").replace("[-0.4,0.4,3]", "[0.4,0.4,3]"));
    let output = folder.run("check front.gltf").out;
    assert!(!output.contains("only its back"), "{output}");
    // Extensions, characters and alignment that other programs do not accept.
    folder.write("char.gltf", quad.replace("AAAAAAAAAAAAAAAAAACAPw", "AAAAAAAA*AAAAAAAAACAPw"));
    let output = folder.expect_exit(2, "check char.gltf").out;
    assert!(output.contains("character 9 of the data, `*`"), "{output}");
    folder.write("extension.gltf", quad.replace("{\"mesh\":0,", "{\"extensions\":{\"KHR_x\":{}},\"mesh\":0,"));
    let output = folder.run("check extension.gltf").out;
    assert!(output.contains("the file uses KHR_x, but `extensionsUsed` does not list it"), "{output}");
}

/// Emission in bytes is reported at its statement in the material file.
#[test]
fn emission_in_bytes_is_reported_at_its_statement() {
    let folder = TestFolder::new();
    let floor = "v -4 0 -4\nv 4 0 -4\nv 4 0 4\nv -4 0 4\nusemtl floor\nf 1 4 3 2\n";
    let glow = "v -3 0 -4\nv 3 0 -4\nv 3 6 -4\nv -3 6 -4\nusemtl glow\nf 5 6 7 8\n";
    folder.write("m.obj", format!("mtllib m.mtl\n{floor}{glow}"));
    folder.write("m.mtl", "newmtl glow\nKd 0.5 0.5 0.5\nKe 255 204 102\nnewmtl floor\nKd 0.5 0.5 0.5\n");
    let output = folder.expect_exit(1, "check m.obj").out;
    assert!(output.contains("m.mtl:3:1") && output.contains("`Ke 1 0.8 0.4`"), "{output}");
}

/// A material whose alpha is below the cutoff is invisible, also with an opaque texture.
#[test]
fn a_cutoff_above_1_hides_the_material() {
    let folder = TestFolder::new();
    let picture = |text: &str| {
        folder.write("a.gltf", text);
        folder.expect_exit(0, "render a.gltf -o a.png --size 24x24 --samples 2");
        folder.bytes("a.png")
    };
    let cut =
        GLTF.replacen("\"name\":\"Poster\",", "\"name\":\"Poster\",\"alphaMode\":\"MASK\",\"alphaCutoff\":1.5,", 1);
    let without = GLTF.replacen("[0,1,2,3]}],\"nodes\"", "[1,2,3]},{\"nodes\":[0]}],\"nodes\"", 1);
    assert_eq!(picture(&cut), picture(&without));
}

/// Lights outside the picture are normal, so they are not mentioned.
#[test]
fn lamps_outside_the_picture_are_not_mentioned() {
    let folder = TestFolder::new();
    for (name, text) in [("a.pbrt", PBRT), ("a.xml", MITSUBA), ("a.usda", USD)] {
        folder.write(name, text);
        let output = folder.expect_exit(0, &format!("check {name}")).out;
        assert!(output.contains("no findings"), "{output}");
    }
}

/// If the automatic camera sees only the outside of a room, a view beside the scene is offered.
#[test]
fn views_beside_a_radiance_scene_are_offered() {
    let folder = TestFolder::new();
    let wall = |corners: &str| format!("grey polygon wall\n0\n0\n12 {corners}\n");
    let room: String = [
        "-4 -4 0  4 -4 0  4 4 0  -4 4 0",
        "-4 -4 4  -4 4 4  4 4 4  4 -4 4",
        "-4 -4 0  -4 -4 4  4 -4 4  4 -4 0",
        "-4 4 0  4 4 0  4 4 4  -4 4 4",
        "-4 -4 0  -4 4 0  -4 4 4  -4 -4 4",
        "4 -4 0  4 -4 4  4 4 4  4 4 0",
    ]
    .map(wall)
    .concat();
    let panel = "lamp polygon panel\n0\n0\n12  -0.5 0.5 3.9   0.5 0.5 3.9   0.5 -0.5 3.9   -0.5 -0.5 3.9\n"; // prose: keep
    let materials: String = RADIANCE.lines().take(8).map(|line| format!("{line}\n")).collect();
    folder.write("room.rad", format!("{materials}{room}{panel}"));
    let before = folder.expect_exit(1, "check room.rad").out;
    assert!(before.contains("black") && !before.contains("--view-file"), "{before}");
    folder.write("inside.vf", "rvu -vtv -vp 0 -3 2 -vd 0 1 0 -vu 0 0 1 -vh 60 -vv 60\n");
    let offered = "use the view in `inside.vf`: `durer render room.rad --view-file inside.vf`";
    let output = folder.expect_exit(1, "check room.rad").out;
    assert!(output.contains(offered), "{output}");
    let output = folder.expect_exit(0, "render room.rad -o a.png --size 40x30 --samples 4");
    assert!(output.err.contains(offered), "{}", output.err);
    assert!(!folder.run("check room.rad --view-file inside.vf").out.contains("--view-file inside.vf`"));
}

/// An illumination model alone does not make a coloured surface glass on purpose.
#[test]
fn glass_by_illumination_model_is_mentioned() {
    let folder = TestFolder::new();
    let said = |material: &str| {
        folder.write("m.obj", format!("mtllib m.mtl\nusemtl paint\n{OBJ}"));
        folder.write("m.mtl", format!("newmtl paint\nKd 0.6 0.2 0.2\n{material}\n"));
        folder.run("check m.obj").out
    };
    let paint = said("illum 4");
    assert!(paint.contains("note[illum-glass]") && paint.contains("m.mtl:3:1"), "{paint}");
    for glass in ["illum 4\nTf 1 1 1", "illum 4\nd 0.1", "illum 6\nNi 1.5", "illum 2"] {
        assert!(!said(glass).contains("illum-glass"), "{glass}");
    }
}
