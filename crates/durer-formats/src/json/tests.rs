//! Tests of JSON scenes: that they can be written and read back, that errors have the right
//! positions, and that the schema agrees with the reader.

use super::{Document, schema, write};
use crate::course;
use crate::course::random::SceneGenerator;
use durer_diag::{Diagnostics, Files, Severity};
use durer_scene::dialect::Dialect;
use durer_scene::scene::{Material, ObjectKind, Scene};
use serde_json::{Value, json};

/// Reads a scene and returns its diagnostics in the form `line:column message`.
fn read(text: &str) -> (Option<Scene>, Vec<String>) {
    let (mut files, mut found) = (Files::default(), Diagnostics::default());
    let file = files.add("x.json", text.as_bytes().into());
    let scene = Document::open(text.as_bytes(), file, &found).scene(&mut found);
    let messages = found.iter().map(|finding| {
        let (line, column) = files.position(finding.span.unwrap()).unwrap();
        format!("{line}:{column}: {}", finding.message)
    });
    (scene, messages.collect())
}

/// Asserts that two scenes are equal bit for bit, because `PartialEq` treats 0 and -0 as equal.
#[track_caller]
fn same(a: &Scene, b: &Scene, context: &str) {
    assert_eq!(a, b, "{context}");
    let bits = |scene: &Scene| serde_json::to_string(scene).unwrap();
    assert_eq!(bits(a), bits(b), "{context}");
}

#[test]
fn random_scenes_round_trip() {
    let mut random = SceneGenerator::seeded(3);
    for _ in 0..500 {
        for dialect in Dialect::ALL {
            let scene = random.scene(dialect);
            let text = write(&scene, dialect);
            let (again, messages) = read(&text);
            let (context, wrong) =
                (format!("{messages:?}\n{text}"), messages.iter().any(|message| !message.contains("does not exist")));
            assert!(!wrong, "{context}");
            same(&scene, &again.expect(&context), &context);
            let document = Document::open(text.as_bytes(), 0, &Diagnostics::default());
            assert_eq!(document.dialect(), dialect);
        }
    }
}

const SMALL: &str = r#"{
    "type": "Scene", "$schema": "here",
    "camera": {"type": "PerspectiveCamera", "center": [0, 0, 5], "direction": [0, 0, -1], "up": [0, 1, 0], "angle": 30},
    "lights": [{"type": "PointLight", "position": [0, 4, 0], "color": [1, 1, 1]}],
    "materials": [
        {"type": "PrincipledMaterial", "preset": "gold", "specular_roughness": 0.5},
        {"type": "PhongMaterial", "noise": {"color1": [0, 0, 0], "color2": [1, 1, 1]}},
        {"type": "Checkerboard", "transform": [{"Scale": [2, 2, 2]}], "material1": 0, "material2": 1.0}
    ],
    "objects": [
        {"type": "Sphere", "center": [0, 0, 0], "radius": 1e0, "material": 2},
        {"type": "Transform", "matrices": [{"Rotate": [0, 1, 0, 30]}], "object":
            {"type": "Group", "material": 1, "objects": [{"type": "TriangleMesh", "obj_file": "a\u002eobj"}]}}
    ]
}"#;

#[test]
fn handwritten_scene_is_read() {
    let (scene, messages) = read(SMALL);
    assert_eq!(messages, [""; 0]);
    let scene = scene.unwrap();
    let Material::Principled(gold) = &scene.materials[0].value else { panic!() };
    assert_eq!((gold.base_metalness, gold.specular_roughness), (1.0, 0.5));
    let objects = &scene.root.as_ref().unwrap().objects;
    // An object without a material takes the material of the previous object; a transform takes
    // that of the object inside it.
    assert_eq!(objects.iter().map(|object| object.material).collect::<Vec<_>>(), [Some(2), Some(1)]);
    let ObjectKind::Transform(_, inner) = &objects[1].node else { panic!() };
    let ObjectKind::Group(group) = &inner.node else { panic!() };
    let ObjectKind::Mesh(mesh) = &group.objects[0].node else { panic!() };
    assert_eq!((mesh.obj_file.path.as_str(), group.objects[0].material), ("a.obj", Some(1)));
}

#[test]
fn material_inside_a_transform_round_trips_in_the_language() {
    let text = r#"{"type": "Scene", "materials": [{"type": "PhongMaterial"}, {"type": "PhongMaterial"}], "objects": [
        {"type": "Transform", "material": 0, "object": {"type": "Sphere", "center": [0, 0, 0], "radius": 1, "material": 1}},
        {"type": "Sphere", "center": [0, 0, 0], "radius": 1}]}"#;
    let scene = read(text).0.unwrap();
    for dialect in Dialect::ALL {
        let words = course::write(&scene, dialect);
        let options = course::ReadOptions { dialect, strict: false, compat: 0 };
        let again = course::read(words.as_bytes(), 0, options, &mut Diagnostics::default()).unwrap();
        let objects = again.root.unwrap().objects;
        let ObjectKind::Transform(_, inner) = &objects[0].node else { panic!("{words}") };
        let inner = match &inner.node {
            ObjectKind::Group(group) => &group.objects[0],
            _ => inner,
        };
        assert_eq!((inner.material, objects[1].material), (Some(1), Some(1)), "{words}");
    }
}

#[test]
fn errors_have_line_and_column() {
    let sphere = |more: &str| format!("{{\"type\": \"Scene\", \"objects\": [\n{{\"type\": \"Sphere\", {more}}}]}}");
    let objects = |more: &str| format!("{{\"type\": \"Scene\", \"objects\": [\n{more}]}}");
    let materials = |more: &str| format!("{{\"type\": \"Scene\", \"materials\": [\n{more}]}}");
    #[rustfmt::skip]
    let cases = [
        (String::new(), "1:1: expected a value, but the file ends"),
        ("{\"type\": \"Scene\",\n}".into(), "2:1: expected a name in quotes, but found `}`"),
        ("{\"type\": \"Scene\"}\n x".into(), "2:2: expected the end of the file, but found `x`"),
        ("{\"type\": \"Scene\",\n \"type\": \"Scene\"}".into(), "2:2: `type` occurs twice in this object"),
        ("[]".into(), "1:1: `scene` needs an object, but found a list"),
        ("{}".into(), "1:1: `scene` has no `type`"),
        ("{\"type\": \"Scen\"}".into(), "1:10: `Scen` is not a type of `scene`"),
        ("{\"type\": \"Scene\",\n\"dialect\": \"f99\"}".into(), "2:12: `dialect` cannot be `f99`"),
        ("{\"type\": \"Scene\",\n\"Objects\": []}".into(), "2:1: `Scene` has no member `Objects`"),
        ("{\"type\": \"Scene\",\n\"lights\": {}}".into(), "2:11: `lights` needs a list, but found an object"),
        (sphere("\"center\": [0, 0, 0], \"radius\": 1, \"color\": 2"), "2:54: `Sphere` has no member `color`"),
        (sphere("\"center\": [0, 0, 0]"), "2:1: `Sphere` has no `radius`"),
        (sphere("\"center\": [0, 0], \"radius\": 1"), "2:30: `center` needs a list of 3 numbers, but this list has 2 values"),
        (sphere("\"center\": [0, 0, \"0\"], \"radius\": 1"), "2:37: `center` needs a number, but found a string"),
        (sphere("\"center\": [0, 0, 0], \"radius\": 1e99"), "2:51: `1e99` is too large a number"),
        (sphere("\"center\": [0, 0, 0], \"radius\": 0"), "2:51: `radius` must be more than 0"),
        (sphere("\"center\": [0, 0, 0], \"radius\": null"), "2:51: `radius` needs a number, but found `null`"),
        (sphere("\"center\": [0, 0, 0], \"radius\": 1, \"material\": -1"), "2:66: `material` needs a whole number, but found `-1`"),
        (sphere("\"center\": [0, 0, 0], \"radius\": 1, \"material\": 0.5"), "2:66: `material` needs a whole number"),
        (sphere("\"center\": [0, 0, 0], \"radius\": 1, \"material\": 4294967296"), "2:66: `material` needs a whole number"),
        (objects("{\"type\": \"Spere\"}"), "2:10: `Spere` is not a type of `object`"),
        (objects("{\"radius\": 1}"), "2:1: `object` has no `type`"),
        (objects("[]"), "2:1: `object` needs an object, but found a list"),
        (objects("{\"type\": \"Transform\"}"), "2:1: `Transform` has no `object`"),
        (objects("{\"type\": \"Union\"}"), "2:1: `Union` has no `objects`"),
        (objects("{\"type\": \"TriangleMesh\", \"obj_file\": \"a b\"}"), "2:38: `obj_file` cannot be `a b`"),
        (objects("{\"type\": \"Transform\", \"matrices\": [{\"Scale\": [1, 0, 1]}], \"object\": {\"type\": \"Group\", \"objects\": []}}"),
            "2:46: a scale factor of 0 flattens space: the transform has no inverse"),
        (objects("{\"type\": \"Transform\", \"matrices\": [{\"Shear\": 1}], \"object\": {\"type\": \"Group\", \"objects\": []}}"),
            "2:37: unknown matrix `Shear`"),
        (objects("{\"type\": \"Transform\", \"matrices\": [{}], \"object\": {\"type\": \"Group\", \"objects\": []}}"),
            "2:36: a matrix must be an object with exactly one member"),
        (materials("{\"type\": \"Checkerboard\", \"material1\": 0, \"material2\": 0}"), "2:1: material 0 may use only earlier materials"),
        (materials("{\"type\": \"PrincipledMaterial\", \"preset\": \"golt\"}"), "2:42: unknown preset `golt`"),
        (materials("{\"type\": \"PrincipledMaterial\", \"base_weight\": 2}"), "2:47: `base_weight` must be from 0 to 1"),
    ];
    for (text, wanted) in cases {
        let (scene, messages) = read(&text);
        assert!(scene.is_none(), "{text}");
        assert!(messages[0].starts_with(wanted), "{text}\n{messages:?}\n{wanted}");
    }
}

#[test]
fn number_of_errors_and_nesting_are_limited() {
    let bad = "{\"type\": \"Sphere\"},".repeat(1000);
    let (scene, messages) = read(&format!("{{\"type\": \"Scene\", \"objects\": [{bad} 1]}}"));
    assert!(scene.is_none() && messages.len() == durer_diag::ERROR_LIMIT);
    let nested = |depth: usize| {
        let open = "{\"type\": \"Group\", \"objects\": [".repeat(depth);
        read(&format!("{{\"type\": \"Scene\", \"objects\": [{open}{}]}}", "]}".repeat(depth)))
    };
    assert!(nested(super::MAX_DEPTH).0.is_some());
    assert!(nested(super::MAX_DEPTH + 1).1[0].contains("objects are nested more than 200 levels deep"));
    assert!(nested(1000).1[0].contains("values are nested more than 640 levels deep"));
    // A material index that is out of range is reported, but the scene is still read.
    let (scene, messages) = read(&SMALL.replace("\"material\": 2", "\"material\": 3"));
    assert!(
        scene.is_some() && messages[0].contains("material 3 does not exist: the scene has only the materials 0 to 2"),
        "{messages:?}"
    );
}

/// Returns true if a value matches a schema. Supports only the part of JSON Schema that the
/// generated schema uses.
fn fits(root: &Value, schema: &Value, value: &Value) -> bool {
    let equal = |a: &Value, b: &Value| match (a, b) {
        (Value::Number(a), Value::Number(b)) => a.as_f64() == b.as_f64(),
        _ => a == b,
    };
    let of_type = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|x| x.fract() == 0.0),
        other => panic!("{other}"),
    };
    let within =
        |limit: &Value, fits: fn(f64, f64) -> bool| value.as_f64().is_none_or(|x| fits(x, limit.as_f64().unwrap()));
    let length = value.as_array().map(Vec::len);
    schema.as_object().unwrap().iter().all(|(word, constraint)| match word.as_str() {
        "description" | "title" | "$schema" | "$defs" => true,
        "$ref" => fits(root, root.pointer(&constraint.as_str().unwrap()[1..]).unwrap(), value),
        "type" => of_type(constraint.as_str().unwrap()),
        "const" => equal(constraint, value),
        "enum" => constraint.as_array().unwrap().iter().any(|one| equal(one, value)),
        "not" => !value.as_array().is_some_and(|list| list.len() == 3 && list.iter().all(|x| x.as_f64() == Some(0.0))),
        "pattern" => {
            value.as_str().is_none_or(|text| !text.is_empty() && !text.contains([' ', '{', '}', '\t', '\n', '\0']))
        }
        "minimum" => within(constraint, |x, limit| x >= limit),
        "maximum" => within(constraint, |x, limit| x <= limit),
        "exclusiveMinimum" => within(constraint, |x, limit| x > limit),
        "exclusiveMaximum" => within(constraint, |x, limit| x < limit),
        "minItems" => length.is_none_or(|length| length as u64 >= constraint.as_u64().unwrap()),
        "maxItems" => length.is_none_or(|length| length as u64 <= constraint.as_u64().unwrap()),
        "items" => value.as_array().is_none_or(|list| list.iter().all(|item| fits(root, constraint, item))),
        "required" => {
            let has = |name: &Value| value.get(name.as_str().unwrap()).is_some();
            !value.is_object() || constraint.as_array().unwrap().iter().all(has)
        }
        "additionalProperties" => {
            value.as_object().is_none_or(|members| members.keys().all(|name| schema["properties"].get(name).is_some()))
        }
        "properties" => value.as_object().is_none_or(|members| {
            members.iter().all(|(name, value)| constraint.get(name).is_none_or(|schema| fits(root, schema, value)))
        }),
        "oneOf" => {
            let kind =
                |one: &&Value| one["properties"].get("type").is_none_or(|kind| value.get("type") == kind.get("const"));
            constraint.as_array().unwrap().iter().filter(kind).filter(|one| fits(root, one, value)).count() == 1
        }
        other => panic!("{other}"),
    })
}

/// Changes one value at a random position in a JSON tree.
fn changed(random: &mut SceneGenerator, value: &mut Value) {
    let others = [
        json!(null),
        json!("x"),
        json!(-1),
        json!(0),
        json!(0.5),
        json!(7),
        json!([]),
        json!({}),
        json!([0, 0, 0]),
        json!(true),
    ];
    match value {
        Value::Object(members) if !members.is_empty() && random.below(6) > 0 => {
            let name = members.keys().nth(random.below(members.len())).unwrap().clone();
            match random.below(10) {
                0 => drop(members.remove(&name)),
                1 => drop(members.insert("radius".into(), json!(1))),
                _ => changed(random, &mut members[&name]),
            }
        }
        Value::Array(items) if !items.is_empty() && random.below(6) > 0 => {
            let index = random.below(items.len());
            match random.below(10) {
                0 => drop(items.remove(index)),
                1 => items.push(items[index].clone()),
                _ => changed(random, &mut items[index]),
            }
        }
        _ => *value = others[random.below(others.len())].clone(),
    }
}

/// Errors that the reader reports but that a JSON Schema cannot express.
const BEYOND: [&str; 7] = [
    "already exists",
    "may use only earlier",
    "flattens space",
    "last row",
    "axis of a rotation",
    "too long or too short",
    "are nested",
];

#[test]
fn schema_and_reader_agree() {
    let schema = schema::schema();
    let mut random = SceneGenerator::seeded(4);
    assert!(fits(&schema, &schema, &serde_json::from_str(SMALL).unwrap()));
    let mut refused = 0;
    for i in 0..600 {
        let text = write(&random.scene(Dialect::Durer), Dialect::Durer);
        let mut value: Value = serde_json::from_str(&text).unwrap();
        assert!(fits(&schema, &schema, &value), "{text}");
        for _ in 0..1 + i % 2 {
            changed(&mut random, &mut value);
        }
        let text = value.to_string();
        let (scene, messages) = read(&text);
        let wrong = messages.iter().filter(|message| !message.contains("does not exist"));
        let beyond =
            scene.is_none() && wrong.clone().all(|messages| BEYOND.iter().any(|words| messages.contains(words)));
        let fits = fits(&schema, &schema, &value);
        assert_eq!(scene.is_some() || beyond, fits, "{messages:?}\n{text}");
        refused += usize::from(!fits);
    }
    assert!((200..550).contains(&refused), "{refused}");
}

#[test]
fn findings_with_a_code_are_errors() {
    let mut found = Diagnostics::default();
    Document::open(b"{\"type\": 1}", 0, &found).scene(&mut found);
    assert!(found.iter().all(|finding| finding.severity == Severity::Error && !finding.code.is_empty()));
}
