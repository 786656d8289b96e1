//! Tests of every form that each statement can have.

use super::*;
use durer_scene::camera::Camera;
use durer_scene::describe::{Constraint, DescribedKind, FieldKind, Value};
use durer_scene::light::Light;
use durer_scene::material::{ColorNoise, PatternMaterial, PhongMaterial, PrincipledMaterial};
use durer_scene::math::Vec3;
use durer_scene::medium::Fog;
use durer_scene::scene::{Background, Material, MatrixOp, Object, ObjectKind};
use durer_scene::shape::{HeightField, Primitive, TriangleMesh};

/// Returns a value of a type that is different from the default, both as text and in the form in
/// which it is read.
fn sample(kind: FieldKind, rule: Constraint) -> (String, Value) {
    let (text, value) = match kind {
        FieldKind::Word(words) => (words[words.len() - 1], Value::Word(words[words.len() - 1].into())),
        FieldKind::Rows(width) => {
            let count = if let Constraint::Rows(least, _) = rule { least } else { 1 };
            let rows: Vec<Vec<f32>> = (0..count).map(|i| (0..width).map(|j| (3 * i + j) as f32).collect()).collect();
            let numbers: Vec<String> = rows.iter().flatten().map(f32::to_string).collect();
            return (format!("{{ {} }}", numbers.join(" ")), Value::Rows(rows));
        }
        FieldKind::Float if matches!(rule, Constraint::UnitInterval | Constraint::Between(..)) => {
            ("0.125", Value::Float(0.125))
        }
        FieldKind::Float => ("12.5", Value::Float(12.5)),
        // Index of one of the two materials that come before the solid texture.
        FieldKind::Int if rule == Constraint::Any => ("1", Value::Int(1)),
        FieldKind::Int => ("7", Value::Int(7)),
        FieldKind::Vec3 if matches!(rule, Constraint::Counts(_)) => ("3 1. 2", Value::Vec3(Vec3::new(3.0, 1.0, 2.0))),
        FieldKind::Vec3 => (".25 -1.5e1 3.", Value::Vec3(Vec3::new(0.25, -15.0, 3.0))),
        FieldKind::Path => {
            ("a/b.x", Value::Path(durer_scene::describe::FileName { path: "a/b.x".into(), ..Default::default() }))
        }
    };
    (text.into(), value)
}

/// Writes every statement of a list with all fields that it has in a dialect, reads it inside the
/// text that `wrap` returns, and compares the result.
fn every_word<T: DescribedKind + PartialEq + std::fmt::Debug>(
    wrap: impl Fn(&str, &str) -> String,
    find: impl Fn(Scene) -> T,
) {
    for dialect in Dialect::ALL.into_iter().filter(|d| *d != Dialect::F23) {
        for kind in T::kinds() {
            for (keyword, set) in kind.keywords().iter().filter(|(_, set)| dialect.is_in(*set)) {
                let mut item = T::from_keyword(keyword).unwrap();
                let mut fields = String::new();
                for (i, field) in kind.fields().iter().enumerate() {
                    let Some(word) = field.keyword(dialect) else { continue };
                    let (text, value) = sample(field.kind, field.constraint);
                    fields += &format!("{word} {text} ");
                    item.set(i, value);
                }
                let _ = set;
                let scene = clean(&wrap(keyword, &format!("{keyword} {{ {fields}}}")), dialect);
                assert_eq!(find(scene), item, "{keyword} in {}", dialect.name());
            }
        }
    }
}

#[test]
fn every_keyword_and_field_is_read_in_every_dialect_that_has_it() {
    every_word::<Camera>(|_, text| text.into(), |scene| scene.camera.unwrap());
    every_word::<Background>(|_, text| text.into(), |scene| scene.background);
    every_word::<Fog>(|_, text| text.into(), |scene| scene.fog.unwrap().value);
    every_word::<Light>(|_, text| format!("Lights {{ numLights 1 {text} }}"), |s| s.lights.unwrap()[0].value.clone());
    let materials = |text: &str| format!("Materials {{ numMaterials 3 Material {{ }} Material {{ }} {text} }}");
    every_word::<PatternMaterial>(
        |_, text| materials(text),
        |scene| match &scene.materials[2].value {
            Material::Solid(solid, _) => solid.clone(),
            other => panic!("{other:?}"),
        },
    );
    let phong = |scene: &Scene| match &scene.materials[2].value {
        Material::Phong(phong, noise) => ((**phong).clone(), noise.clone()),
        other => panic!("{other:?}"),
    };
    every_word::<PhongMaterial>(|_, text| materials(text), |scene| phong(&scene).0);
    every_word::<PrincipledMaterial>(
        |_, text| materials(text),
        |scene| match &scene.materials[2].value {
            Material::Principled(principled) => (**principled).clone(),
            other => panic!("{other:?}"),
        },
    );
    every_word::<ColorNoise>(|_, text| materials(&format!("Material {{ {text} }}")), |scene| phong(&scene).1.unwrap());
    let group = |text: &str| format!("Group {{ numObjects 1 {text} }}");
    let first = |scene: Scene| scene.root.unwrap().objects.remove(0).node;
    every_word::<Primitive>(
        |_, text| group(text),
        |scene| match first(scene) {
            ObjectKind::Primitive(shape) => shape,
            other => panic!("{other:?}"),
        },
    );
    every_word::<HeightField>(
        |_, text| group(text),
        |scene| match first(scene) {
            ObjectKind::HeightField(field) => field,
            other => panic!("{other:?}"),
        },
    );
    every_word::<TriangleMesh>(
        |_, text| group(text),
        |scene| match first(scene) {
            ObjectKind::Mesh(mesh) => mesh,
            other => panic!("{other:?}"),
        },
    );
}

#[test]
fn blanks_comments_and_byte_order_mark_are_ignored() {
    for (dialect, text) in SMALL {
        let scene = clean(text, dialect);
        let dressed = [
            text.replace('\n', "\r\n"),
            text.replace('\n', " "),
            text.replace(' ', "\t\n\u{b}\u{c} "),
            format!("\u{feff}{text}"),
            text.replace(" {", "{").replace("{ ", "{").replace(" }", "}").replace("} ", "}"),
            text.replace('\n', " # Sphere { no } \n"),
            format!("# first\n{text}# last"),
        ];
        for text in dressed {
            assert_eq!(clean(&text, dialect), scene, "{text}");
        }
    }
}

#[test]
fn small_scenes_are_valid_if_strict() {
    for (dialect, text) in SMALL {
        let (scene, findings) = read_as(text.as_bytes(), dialect, true);
        assert_eq!(findings, [""; 0], "{}", dialect.name());
        assert_eq!(scene.unwrap(), clean(text, dialect));
    }
}

#[test]
fn numbers_are_read_as_by_scanf() {
    for (text, value) in
        [(".4", 0.4), ("-.16", -0.16), ("0.", 0.0), ("1e3", 1e3), ("+5", 5.0), ("1E-2", 0.01), ("-3.4e38", -3.4e38)]
    {
        let scene = clean(&format!("Background {{ color {text} 0 {text}}}"), Dialect::F04);
        assert_eq!(scene.background.color.x.to_bits(), f32::to_bits(value), "{text}");
        assert_eq!(scene.background.color.z.to_bits(), f32::to_bits(value), "{text}");
    }
}

#[test]
fn count_of_numbers_decides_between_attenuations() {
    let light =
        |dialect, text: &str| match read_as(text.as_bytes(), dialect, false).0.unwrap().lights.unwrap().remove(0).value
        {
            Light::Point(light) => (light.attenuation, light.falloff),
            other => panic!("{other:?}"),
        };
    let classic = |value: &str| format!("Lights {{ PointLight {{ position 0 0 0 color 1 1 1 attenuation {value} }} }}");
    let nodes = |value: &str| format!("Scene {{ Component<Light> {{ type point color 1 1 1 attenuation {value} }} }}");
    let (three, one) = ((Some(Vec3::X), None), (None, Some(2.0)));
    for dialect in [Dialect::F04, Dialect::F12a4, Dialect::F12a5, Dialect::Durer] {
        assert_eq!(light(dialect, &classic("1 0 0")), three);
    }
    assert_eq!(light(Dialect::Durer, &classic("2")), one);
    assert_eq!(light(Dialect::F23, &nodes("2")), one);
    assert_eq!(light(Dialect::F23, &nodes("1 0 0")), three);
    let found = read_as(classic("1 0").as_bytes(), Dialect::Durer, false).1;
    assert_eq!(found, ["1:66 error: `attenuation` needs number 3 of 3, but found `}` [}]"]);
}

#[test]
fn matrix_lists_rows_in_2004_and_columns_later() {
    let read = |word: &str, dialect| {
        let numbers = "1 2 3 4 5 6 7 8 9 10 11 12 0 0 0 1";
        let columns = "1 5 9 0 2 6 10 0 3 7 11 0 4 8 12 1";
        let listed = if word == "Matrix" { numbers } else { columns };
        let text = format!(
            "Group {{ numObjects 1 Transform {{ {word} {{ {listed} }} Sphere {{ center 0 0 0 radius 1 }} }} }}"
        );
        match clean(&text, dialect).root.unwrap().objects.remove(0).node {
            ObjectKind::Transform(ops, _) => ops,
            other => panic!("{other:?}"),
        }
    };
    let rows = [1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12., 0., 0., 0., 1.];
    for (word, dialect) in
        [("Matrix", Dialect::F04), ("Matrix", Dialect::Durer), ("Matrix4f", Dialect::F16), ("Matrix4f", Dialect::Durer)]
    {
        assert_eq!(read(word, dialect), [MatrixOp::Matrix(rows)], "{word}");
    }
}

#[test]
fn material_index_applies_to_all_following_objects() {
    let ball = "Sphere { center 0 0 0 radius 1 }";
    let text = format!(
        "Materials {{ numMaterials 3 Material {{ }} Material {{ }} Material {{ }} }} Group {{ numObjects 4\n\
         {ball} MaterialIndex 1 {ball} Group {{ numObjects 2 {ball} MaterialIndex 2 {ball} }} Transform {{ {ball} }} }}"
    );
    let scene = clean(&text, Dialect::F04);
    let root = scene.root.unwrap().objects;
    let materials: Vec<_> = root.iter().map(|object| object.material).collect();
    assert_eq!(materials, [None, Some(1), Some(1), Some(2)]);
    let ObjectKind::Group(group) = &root[2].node else { panic!() };
    assert_eq!(group.objects.iter().map(|o| o.material).collect::<Vec<_>>(), [Some(1), Some(2)]);
    let ObjectKind::Transform(_, inner) = &root[3].node else { panic!() };
    assert_eq!(inner.material, Some(2));
}

/// Collects the shapes of a scene with nodes, and their materials, in order.
fn flat(objects: &[Object], out: &mut Vec<(String, Option<u32>)>) {
    for object in objects {
        match &object.node {
            ObjectKind::Group(group) => flat(&group.objects, out),
            ObjectKind::Transform(_, inner) => flat(std::slice::from_ref(inner), out),
            ObjectKind::Primitive(shape) => out.push((shape.keyword(Dialect::F23).into(), object.material)),
            ObjectKind::Mesh(_) | ObjectKind::HeightField(_) => out.push(("mesh".into(), object.material)),
            ObjectKind::Voxels(..) => out.push(("grid".into(), object.material)),
            ObjectKind::Solid(_, parts) => flat(parts, out),
        }
    }
}

#[test]
fn node_does_not_inherit_its_material() {
    let sphere = "Component<Object> { type sphere radius 1 }";
    let material = |i: u32| format!("Component<Material> {{ index {i} }}");
    let text = format!(
        "Materials {{ Material {{ }} Material {{ }} Material {{ }} }} Scene {{\n\
         Node {{ {} Component<Object> {{ type plane normal 0 1 0 offset 0 }} }}\n\
         Node {{ {sphere} {} }}\n\
         Node {{ Node {{ {} {sphere} }} Node {{ Transform {{ }} {sphere} }} Component<Object> {{ type mesh obj_file x.obj }} {} }}\n\
         Node {{ {sphere} }} }}",
        material(2),
        material(1),
        material(0),
        material(1),
    );
    let mut found = Vec::new();
    flat(&clean(&text, Dialect::F23).root.unwrap().objects, &mut found);
    let found: Vec<_> = found.iter().map(|(name, material)| (name.as_str(), *material)).collect();
    let one = ("sphere", Some(1));
    assert_eq!(found, [("plane", Some(2)), one, ("sphere", Some(0)), one, ("mesh", Some(1)), ("sphere", None)]);
}

#[test]
fn point_light_is_positioned_by_its_nodes() {
    let text = "Scene { Node { Component<Light> { type point color 1 2 3 }\n\
                Node { Transform { translate 0 0 2 } Component<Light> { type point color 1 1 1 attenuation 7 }\n\
                Component<Light> { type directional direction 1 0 0 color 1 1 1 } }\n\
                Transform { translate 1 0 0 y_rotate 90 scale 3 3 3 } } }";
    let scene = clean(text, Dialect::F23);
    let lights: Vec<Light> = scene.lights.unwrap().into_iter().map(|light| light.value).collect();
    let [Light::Point(near), Light::Point(far), Light::Directional(sun)] = &lights[..] else { panic!("{lights:?}") };
    assert_eq!(near.position, Vec3::X);
    // The object is moved by 2 along z, scaled by 3, rotated from z to x, and then moved by 1.
    assert_eq!((far.position, far.falloff, near.falloff), (Vec3::new(7.0, 0.0, 0.0), Some(7.0), None));
    assert_eq!(sun.direction, Vec3::X);
    // A node that has only lights is not an object.
    assert_eq!(scene.root.unwrap().objects, []);
}

#[test]
fn node_transforms_all_its_objects() {
    let text = "Scene { Node { Transform { scale 2 2 2 } Component<Object> { type sphere radius 1 }\n\
                Component<Object> { type sphere radius 2 } } }";
    let objects = clean(text, Dialect::F23).root.unwrap().objects;
    let ObjectKind::Transform(ops, inner) = &objects[0].node else { panic!("{objects:?}") };
    assert_eq!(ops[..], [MatrixOp::Scale(Vec3::splat(2.0))]);
    assert!(matches!(&inner.node, ObjectKind::Group(group) if group.objects.len() == 2));
}
