//! Tests of every kind of error and warning, including their spans and messages.

use super::*;
use durer_scene::math::Vec3;
use durer_scene::scene::{MatrixOp, ObjectKind};

fn findings(text: &str, dialect: Dialect) -> Vec<String> {
    read_as(text.as_bytes(), dialect, false).1
}

#[track_caller]
fn one(text: &str, expected: &str) {
    assert_eq!(findings(text, Dialect::F04), [expected], "{text}");
}

#[track_caller]
fn one_of_nodes(text: &str, expected: &str) {
    assert_eq!(findings(text, Dialect::F23), [expected], "{text}");
}

#[track_caller]
fn in_group(text: &str, expected: &str) {
    one(&format!("Group {{\n{text}\n}}"), expected);
}

#[test]
fn unknown_words() {
    one(
        "\nBackgrund { color 1 1 1 }",
        "2:1 error: unknown word `Backgrund` at the top of a scene [Backgrund] (did you mean `Background`?)",
    );
    one(
        "Background { colour 1 1 1 }",
        "1:14 error: `Background` has no field `colour` [colour] (did you mean `color`?)",
    );
    in_group(
        "Sphre { center 0 0 0 radius 1 }",
        "2:1 error: unknown word `Sphre` among objects [Sphre] (did you mean `Sphere`?)",
    );
    in_group(
        "materialIndex 0\nSphere { center 0 0 0 radius 1 }",
        "2:1 error: unknown word `materialIndex` among objects [materialIndex] (did you mean `MaterialIndex`?)",
    );
    in_group(
        "numObject 0",
        "2:1 error: unknown word `numObject` among objects [numObject] (did you mean `numObjects`?)",
    );
    in_group(
        "Transform { Translat 1 2 3 Sphere { center 0 0 0 radius 1 } }",
        "2:13 error: unknown word `Translat` in a transform [Translat] (did you mean `Translate`?)",
    );
    one(
        "Lights { PointLihgt { position 0 0 0 color 1 1 1 } }",
        "1:10 error: unknown word `PointLihgt` among lights [PointLihgt] (did you mean `PointLight`?)",
    );
    one(
        "Materials { PhongMateral { diffuseColor 1 1 1 } }",
        "1:13 error: unknown word `PhongMateral` among materials [PhongMateral] (did you mean `PhongMaterial`?)",
    );
    one(
        "Materials { Material { difuseColor 1 1 1 } }",
        "1:24 error: `Material` has no field `difuseColor` [difuseColor] (did you mean `diffuseColor`?)",
    );
    one_of_nodes("Scene { Nod { } }", "1:9 error: unknown word `Nod` in a node [Nod] (did you mean `Node`?)");
    one_of_nodes(
        "Scene { Node { Transform { xrotate 4 } Component<Object> { type sphere radius 1 } } }",
        "1:28 error: unknown word `xrotate` in a transform [xrotate] (did you mean `x_rotate`?)",
    );
    one_of_nodes(
        "Scene { Component<Object> { type spere radius 1 } }",
        "1:34 error: `Component<Object>` has no type `spere` [spere] (did you mean `sphere`?)",
    );
    one_of_nodes(
        "Scene { Component<Object> { radius 1 type sphere } }",
        "1:29 error: `Component<Object>` must begin with its `type` [radius] (known types are sphere, plane, \
         triangle, mesh, Grid)",
    );
}

#[test]
fn byte_order_mark_takes_no_column_and_control_bytes_are_escaped() {
    let help =
        "(the words allowed here are PerspectiveCamera, OrthographicCamera, Background, Lights, Materials, Group)";
    let found = |text: &str| findings(text, Dialect::F04);
    assert_eq!(
        found("\u{feff}Foo { }\n Foo { }"),
        [
            format!("1:1 error: unknown word `Foo` at the top of a scene [Foo] {help}"),
            format!("2:2 error: unknown word `Foo` at the top of a scene [Foo] {help}"),
        ]
    );
    assert!(
        found("\u{1b}[31m { }")[0].starts_with("1:1 error: unknown word `\\u{1b}[31m`"),
        "{:?}",
        found("\u{1b}[31m")
    );
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x01{\0\0}\xff\xfe";
    let (scene, found) = read_as(png, Dialect::F04, false);
    assert!(scene.is_none() && found.len() <= 20, "{found:?}");
}

#[test]
fn words_in_the_wrong_place() {
    one(
        "Sphere { center 0 0 0 radius 1 }",
        "1:1 error: unknown word `Sphere` at the top of a scene [Sphere] (`Sphere` belongs in a `Group` block)",
    );
    one(
        "PointLight { position 0 0 0 color 1 1 1 }",
        "1:1 error: unknown word `PointLight` at the top of a scene [PointLight] (`PointLight` belongs in a `Lights` \
         block)",
    );
    in_group(
        "Translate 1 2 3",
        "2:1 error: unknown word `Translate` among objects [Translate] (`Translate` belongs in a `Transform` block)",
    );
    one(
        "Scene { Node { } }",
        "1:1 error: unknown word `Scene` at the top of a scene [Scene] (`Scene` is a word of f23)",
    );
    one_of_nodes(
        "Group { numObjects 0 }",
        "1:1 error: unknown word `Group` at the top of a scene [Group] (`Group` is a word of f03, f04, f12a4, f12a5, \
         f16, durer; write `Node` in f23)",
    );
}

#[test]
fn fields_and_values() {
    in_group(
        "Sphere { center 0 0 0 }",
        "2:1 error: `Sphere` has no `radius` [Sphere] (add it to the block, for example `radius 1`)",
    );
    in_group(
        "Sphere { center 0 0\n radius 1 }",
        "3:2 error: `center` needs number 3 of 3, but found `radius` [radius]",
    );
    in_group("Sphere { center 0 0 0 radius }", "2:30 error: `radius` needs a number, but found `}` [}]");
    in_group("Sphere { center 0 0 0 radius big }", "2:30 error: `radius` needs a number, but found `big` [big]");
    in_group(
        "Sphere { center 0 0 0 radius 1e39 }",
        "2:30 error: `1e39` is too large a number [1e39] (numbers must be within about ±3.4e38)",
    );
    for word in ["inf", "nan", "-inf", "NaN", "infinity", "1.2.3", "--1", "1e", "½"] {
        let column = format!("2:30 error: `radius` needs a number, but found `{word}` [{word}]");
        in_group(&format!("Sphere {{ center 0 0 0 radius {word} }}"), &column);
    }
    in_group(
        "Sphere { center 0 0 0 radius 0x10 }",
        "2:30 error: `radius` needs a number, but found `0x10` [0x10] (write numbers in decimal)",
    );
    in_group(
        "Sphere { center 0 0 0 radius 1,5 }",
        "2:30 error: `radius` needs a number, but found `1,5` [1,5] (write decimals with a point, and separate \
         numbers with spaces only)",
    );
    in_group(
        "Sphere { center 1, 2, 3 radius 1 }",
        "2:17 error: `center` needs number 1 of 3, but found `1,` [1,] (separate numbers with spaces only: `1 0.5 0`)",
    );
    in_group(
        "Sphere { center 0 0 0 radius 1.f }",
        "2:30 error: `radius` needs a number, but found `1.f` [1.f] (separate numbers with spaces only: `1 0.5 0`)",
    );
    in_group("MaterialIndex -1", "2:15 error: `MaterialIndex` needs a whole number, but found `-1` [-1]");
    in_group("MaterialIndex 1.5", "2:15 error: `MaterialIndex` needs a whole number, but found `1.5` [1.5]");
    in_group("TriangleMesh { obj_file }", "2:25 error: `obj_file` needs a path, but found `}` [}]");
    in_group("Sphere center 0 0 0 radius 1 }", "2:8 error: `Sphere` needs `{`, but found `center` [center]");
}

#[test]
fn surplus_values() {
    in_group(
        "Sphere { center 0 0 0 4 radius 1 }",
        "2:23 error: unexpected number `4` in `Sphere` [4] (`Sphere` has the fields center, radius)",
    );
    in_group(
        "TriangleMesh { obj_file my cube.obj }",
        "2:28 error: `TriangleMesh` has no field `cube.obj` [cube.obj] (a path cannot contain spaces)",
    );
    one(
        "Lights { numLights 0 0 }",
        "1:22 error: unexpected number `0` among lights [0] (the words allowed here are DirectionalLight, PointLight, \
         numLights)",
    );
}

#[test]
fn rules_of_values() {
    in_group("Sphere { center 0 0 0 radius 0 }", "2:30 error: `radius` must be more than 0 [0]");
    in_group("Sphere { center 0 0 0 radius -0 }", "2:30 error: `radius` must be more than 0 [-0]");
    in_group("Plane { normal 0 0. -0 offset 1 }", "2:16 error: `normal` must not be 0 0 0 [0 0. -0]");
    let camera = |direction: &str, angle: &str| {
        format!("PerspectiveCamera {{ center 0 0 0 direction {direction} up 0 1 0 angle {angle} }}")
    };
    one(&camera("0 0 1", "180"), "1:65 error: `angle` must be more than 0 and less than 180 [180]");
    one(&camera("0 0 1", "0"), "1:65 error: `angle` must be more than 0 and less than 180 [0]");
    one(&camera("0 0 1e30", "20"), "1:44 error: `direction` is too long or too short for a direction [0 0 1e30]");
    one(&camera("0 0 1e-30", "20"), "1:44 error: `direction` is too long or too short for a direction [0 0 1e-30]");
    one(
        "Materials { Material { } Noise { materialIndex 0 materialIndex 0 octaves 33 } }",
        "1:74 error: `octaves` must be at most 32 [33]",
    );
    one("Materials { Material { exponent -1 } }", "1:33 error: `exponent` must not be less than 0 [-1]");
}

#[test]
fn counts_and_indices() {
    let ball = "Sphere { center 0 0 0 radius 1 }";
    in_group(
        &format!("numObjects 3 {ball}"),
        "2:1 error: `numObjects` says 3, but 1 follows [numObjects 3] (write `numObjects 1`)",
    );
    in_group(
        &format!("numObjects 1 {ball} {ball}"),
        "2:1 error: `numObjects` says 1, but 2 follow [numObjects 1] (write `numObjects 2`)",
    );
    one("Lights { numLights 1 }", "1:10 error: `numLights` says 1, but 0 follow [numLights 1] (write `numLights 0`)");
    one(
        "Materials { numMaterials 2 Material { } }",
        "1:13 error: `numMaterials` says 2, but 1 follows [numMaterials 2] (write `numMaterials 1`)",
    );
    one(
        "Materials { Checkerboard { materialIndex 0 materialIndex 1 } Material { } }",
        "1:42 error: material 0 may use only earlier materials, not material 0 [0] (materials are numbered from 0, \
         in file order)",
    );
    one(
        "Materials { Material { } Checkerboard { materialIndex 0 materialIndex 5 } }",
        "1:71 error: material 5 does not exist: there are materials 0 to 1 [5] (materials are numbered from 0, in \
         file order)",
    );
    in_group(
        "MaterialIndex 7",
        "2:1 warning: material 7 does not exist: the scene has no materials [MaterialIndex 7] (objects that use it are drawn in plain grey)",
    );
    one_of_nodes(
        "Materials { Material { } } Scene { Node { Component<Material> { index 1 } } }",
        "1:65 warning: material 1 does not exist: there is only material 0 [index 1] (objects that use it are drawn in plain grey)",
    );
}

#[test]
fn transforms() {
    let ball = "Sphere { center 0 0 0 radius 1 }";
    in_group(
        &format!("Transform {{ MaterialIndex 0 {ball} }}"),
        "2:13 error: `MaterialIndex` is not allowed in a `Transform` [MaterialIndex] (write `MaterialIndex` before \
         the `Transform`)",
    );
    in_group(
        &format!("Transform {{ {ball} {ball} {ball} }}"),
        "2:46 error: a `Transform` can contain only one object [Sphere] (put several objects into a `Group`)",
    );
    in_group(
        "Transform { Scale 1 1 1 }",
        "2:1 error: this `Transform` has no object [Transform] (write the object after its matrices: `Transform { Translate 0 1 0 Sphere { ... } }`)",
    );
    in_group(
        &format!("Transform {{ {ball} XRotate 3 YRotate 3 }}"),
        "2:46 error: the matrices of a `Transform` must come before its object [XRotate]",
    );
    for scale in ["Scale -1 0 1", "Scale 0 0 0", "UniformScale 0"] {
        in_group(
            &format!("Transform {{ {scale} {ball} }}"),
            &format!(
                "2:13 error: a scale factor of 0 flattens space: the transform has no inverse [{scale}] (use a factor of 1 along \
                 axes that keep their size)"
            ),
        );
    }
    in_group(
        &format!("Transform {{ Rotate {{ 0 0 0 45 }} {ball} }}"),
        "2:13 error: the axis of a rotation must not be 0 0 0 [Rotate { 0 0 0 45 }] (write the axis first, then the \
         angle)",
    );
    in_group(
        &format!("Transform {{ Rotate 0 1 0 45 {ball} }}"),
        "2:13 error: `Rotate` needs braces around its axis and angle [Rotate 0 1 0 45] (write `Rotate { 0 1 0 45 }`)",
    );
    in_group(
        &format!("Transform {{ Translate 1 x 3 {ball} }}"),
        "2:25 error: `Translate` needs number 2 of 3, but found `x` [x]",
    );
    in_group(
        &format!("Transform {{ Matrix {{ 1 0 0 0 0 1 0 0 0 0 1 0 5 0 0 1 }} {ball} }}"),
        "2:13 error: the last row of a matrix must be 0 0 0 1 [Matrix { 1 0 0 0 0 1 0 0 0 0 1 0 5 0 0 1 }] (`Matrix` of 2003 and 2004 lists rows, `Matrix4f` lists columns)",
    );
    one_of_nodes(
        "Scene { Node { Transform { scale 1 0 1 } } }",
        "1:28 error: a scale factor of 0 flattens space: the transform has no inverse [scale 1 0 1] (use a factor of 1 along \
         axes that keep their size)",
    );
    // A scale by a small factor is not a scale by 0.
    assert_eq!(findings(&format!("Group {{ Transform {{ Scale 1e-30 1e-30 1 {ball} }} }}"), Dialect::F04), [""; 0]);
}

#[test]
fn braces() {
    one("Group {\n numObjects 0", "2:14 error: the file ends inside `Group` []");
    one("Group { Transform { Sphere { center 0 0", "1:40 error: `center` needs number 3 of 3, but the file ends []");
    one("}\n", "1:1 error: this `}` has no matching `{` [}] (look for an extra `}` further up)");
    one("{ Sphere { } }", "1:1 error: `{` without a keyword [{]");
    one("Group { { } }", "1:9 error: `{` without a keyword in `Group` [{]");
    one(
        "Group {\nSphere { center 0 0 0 radius 1\nPlane { normal 0 1 0 offset 0 } }",
        "3:1 error: `Plane` is not allowed in `Sphere` [Plane]",
    );
    one("Group { numObjects 0\nLights { numLights 0 }", "2:1 error: `Lights` is not allowed in `Group` [Lights]");
    one(
        "Group { numObjects 2 Sphere { center 0 0 0 radius 1 }\n}\nPlane { normal 0 1 0 offset 0 } }",
        "2:1 error: this `}` ends `Group` after 1 of its elements, but more elements follow [}]",
    );
    one_of_nodes("Scene { Node {", "1:15 error: the file ends inside `Node` []");
    one_of_nodes("}", "1:1 error: this `}` has no matching `{` [}] (look for an extra `}` further up)");
}

#[test]
fn repeated_and_foreign_words_give_one_warning() {
    one("Background { color 1 1 1 color 0 0 0 }", "1:26 warning: `color` is given twice; the last one is used [color]");
    one(
        "Group { numObjects 0 } Group { numObjects 0 }",
        "1:24 warning: the scene has more than one `Group`; only the last one is used [Group]",
    );
    one(
        "Materials { Material { shininess 1 } Material { shininess 2 } }",
        "1:24 warning: `shininess` is not a word of f04, but of f12a4, f12a5, f16, f23, durer [shininess] (write \
         `exponent` in f04)",
    );
    one(
        "Group { num_objects 0 }",
        "1:9 warning: `num_objects` is not a word of f04, but of f03 [num_objects] (write `numObjects` in f04)",
    );
    let twice = "Scene { Node { Transform { scale 2 2 2 } Transform { translate 1 0 0 } Component<Object> { type sphere radius 1 } } }";
    one_of_nodes(
        twice,
        "1:42 warning: a node can have only one transform; the last one is used [Transform] (use nested nodes to \
         combine several transforms)",
    );
    let objects = read_as(twice.as_bytes(), Dialect::F23, false).0.unwrap().root.unwrap().objects;
    let ObjectKind::Transform(ops, _) = &objects[0].node else { panic!("{objects:?}") };
    assert_eq!(ops[..], [MatrixOp::Translate(Vec3::X)]);
    one("Group { } // no", "1:11 warning: comments begin with `#`, but this comment with `//` is ignored too [// no]");
    let shared = "Lights { PointLight { position 0 0 0 color 1 1 1 attenuation 1 0 0 attenuation 1 0 0 } }";
    assert_eq!(findings(shared, Dialect::F12a5).len(), 2, "{:?}", findings(shared, Dialect::F12a5));
}

#[test]
fn web_colour_is_reported_at_its_value() {
    let text = "Materials { Material { diffuseColor #b38033\n specularColor 1 1 1 } } Group { }";
    let messages = findings(text, Dialect::Durer).join("\n");
    assert!(messages.contains("`diffuseColor` needs number 1 of 3, but `#b38033` begins a comment"), "{messages}");
    assert!(messages.contains("0.702 0.502 0.2"), "{messages}");
    // Other comments are not mistaken for the value.
    let messages = findings(&text.replace("#b38033", "# brown"), Dialect::Durer).join("\n");
    assert!(messages.contains("but found `specularColor`"), "{messages}");
}

#[test]
fn repeated_count_is_reported() {
    let text = "Group { numObjects 1 numObjects 1 Sphere { center 0 0 0 radius 1 } }";
    let messages = findings(text, Dialect::Durer).join("\n");
    assert!(messages.contains("`numObjects` is given twice; the last one is used"), "{messages}");
}
