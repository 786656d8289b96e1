//! Reference of the scene language, which lists each keyword with its fields, its dialects and an
//! example.
//!
//! Keywords with fields are taken from the descriptions of the statements. The table `GRAMMAR`
//! lists the remaining keywords, which belong to the grammar itself.

use super::write::write_item;
use durer_scene::camera::Camera;
use durer_scene::describe::{Constraint, DescribedKind, FieldKind, Value};
use durer_scene::dialect::{Dialect, DialectSet, set};
use durer_scene::light::Light;
use durer_scene::material::{ColorNoise, HairMaterial, PatternMaterial, PhongMaterial, PrincipledMaterial};
use durer_scene::math::Vec3;
use durer_scene::medium::Fog;
use durer_scene::scene::{Background, CsgOperation, NamedTexture};
use durer_scene::shape::{HeightField, Primitive, TriangleMesh, VoxelGrid};

/// Chapter of the scene language reference, into which its entries are grouped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chapter {
    /// Structure of a scene file, such as its sections, groups and counts.
    Structure,
    /// Cameras.
    Cameras,
    /// Lights.
    Lights,
    /// Surface materials.
    Materials,
    /// Shapes that rays can hit.
    Shapes,
    /// Shapes combined by Boolean operations.
    Solids,
    /// Transforms of objects.
    Transforms,
}

impl Chapter {
    /// All chapters in the order in which they are read.
    pub const ALL: [Chapter; 7] = [
        Chapter::Structure,
        Chapter::Cameras,
        Chapter::Lights,
        Chapter::Materials,
        Chapter::Shapes,
        Chapter::Solids,
        Chapter::Transforms,
    ];

    /// Title of the chapter.
    pub fn title(self) -> &'static str {
        match self {
            Chapter::Structure => "Structure",
            Chapter::Cameras => "Cameras",
            Chapter::Lights => "Lights",
            Chapter::Materials => "Materials",
            Chapter::Shapes => "Shapes",
            Chapter::Solids => "Solids",
            Chapter::Transforms => "Transforms",
        }
    }
}

/// Keyword or field name, with the dialects that spell it this way.
pub type Spelling = (&'static str, DialectSet);

/// Entry of the scene language reference, which has a keyword with its description, its fields and
/// an example.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Spellings of the keyword with their dialects. The first one is the name of the entry.
    pub keywords: Vec<Spelling>,
    /// Chapter to which the entry belongs.
    pub chapter: Chapter,
    /// Description of the keyword.
    pub doc: String,
    /// Values that follow a keyword without a block, such as `x y z`.
    pub values: &'static str,
    /// Fields in the keyword's block.
    pub fields: Vec<FieldEntry>,
    /// Example in the Dürer dialect, or in the keyword's own dialect if the Dürer dialect does not
    /// have it.
    pub example: String,
}

/// Field of a keyword's block, as it is listed in the scene language reference.
#[derive(Clone, Debug)]
pub struct FieldEntry {
    /// Name of the field in the code.
    pub name: &'static str,
    /// Type of the value.
    pub kind: FieldKind,
    /// Spellings of the field's name with their dialects.
    pub words: Vec<Spelling>,
    /// Type and range of the value as text.
    pub value: String,
    /// True if the field must be present.
    pub required: bool,
    /// Default value as text, if there is one.
    pub default: Option<String>,
    /// Meaning of the field and its unit.
    pub doc: String,
}

impl Entry {
    /// Returns the name of the entry.
    pub fn name(&self) -> &'static str {
        self.keywords[0].0
    }

    /// Returns the dialects that have this keyword.
    pub fn dialects(&self) -> DialectSet {
        self.keywords.iter().fold(0, |all, keyword| all | keyword.1)
    }

    /// Returns a scene that shows the example, if the example is visible.
    pub fn scene(&self) -> Option<String> {
        let example = &self.example;
        Some(match self.chapter {
            Chapter::Structure => return None,
            Chapter::Cameras => format!("{example}\n{TOWN}"),
            Chapter::Lights => format!(
                "{EYE}Background {{ color 0 0 0 ambientLight 0.05 0.05 0.05 }}\nLights {{ {example} }}\n{MATERIALS}{STILL_LIFE}"
            ),
            Chapter::Materials => format!(
                "{EYE}{DAY}Materials {{\n    {GROUND_MATERIAL}\n    PhongMaterial {{ diffuseColor 0.75 0.35 0.2 }}\n    \
                 PhongMaterial {{ diffuseColor 0.9 0.85 0.7 }}\n    {example}\n}}\nGroup {{\n    MaterialIndex 0 \
                 Plane {{ normal 0 1 0 offset -1 }}\n    MaterialIndex 3 Sphere {{ center 0 0 0 radius 1 }}\n}}\n"
            ),
            Chapter::Shapes | Chapter::Solids | Chapter::Transforms => {
                format!(
                    "{EYE}{DAY}{MATERIALS}Group {{\n    MaterialIndex 0 {FLOOR}\n    MaterialIndex 1\n{example}\n}}\n"
                )
            }
        })
    }
}

const EYE: &str = "PerspectiveCamera { center 3.2 2.3 4.4 direction -3.2 -2.4 -4.4 up 0 1 0 angle 34 }\n";
const DAY: &str = "Background { color 0.78 0.84 0.92 ambientLight 0.3 0.3 0.32 }
Lights { DirectionalLight { direction -1 -2.2 -0.7 color 0.75 0.75 0.7 } }
";
const GROUND_MATERIAL: &str = "PhongMaterial { diffuseColor 0.72 0.72 0.7 }";
const MATERIALS: &str = "Materials {
    PhongMaterial { diffuseColor 0.72 0.72 0.7 }
    PhongMaterial { diffuseColor 0.8 0.5 0.25 specularColor 0.25 0.25 0.25 exponent 30 }
    PhongMaterial { diffuseColor 0.3 0.5 0.7 }
}
";
const FLOOR: &str = "Plane { normal 0 1 0 offset -1.3 }";
const STILL_LIFE: &str = "Group {
    MaterialIndex 0 Plane { normal 0 1 0 offset -1 }
    MaterialIndex 1 Sphere { center 0.4 -0.2 0 radius 0.8 }
    MaterialIndex 2 Box { min -1.5 -1 -1.2 max -0.5 0.6 -0.2 }
}
";
const TOWN: &str = "Background { color 0.78 0.84 0.92 ambientLight 0.35 0.35 0.37 }
Lights { DirectionalLight { direction -1 -2 -0.7 color 0.7 0.7 0.65 } }
Materials {
    PhongMaterial { diffuseColor 0.72 0.72 0.7 }
    PhongMaterial { diffuseColor 0.8 0.35 0.25 }
    PhongMaterial { diffuseColor 0.3 0.5 0.7 }
    PhongMaterial { diffuseColor 0.45 0.65 0.35 }
    PhongMaterial { diffuseColor 0.85 0.75 0.3 }
    PhongMaterial { diffuseColor 0.4 0.4 0.4 }
    Checkerboard { materialIndex 0 materialIndex 5 }
}
Group {
    MaterialIndex 6 Plane { normal 0 1 0 offset -1 }
    MaterialIndex 1 Sphere { center -1.3 -0.2 -5 radius 0.8 }
    MaterialIndex 2 Box { min 0.4 -1 -6 max 1.8 0.7 -4.6 }
    MaterialIndex 3 Cone { base 4 -1 -3 top 4 1.5 -3 baseRadius 0.9 }
    MaterialIndex 4 Cylinder { base -4.5 -1 -2 top -4.5 1.2 -2 radius 0.6 }
    MaterialIndex 1 Box { min 4 -1 1 max 5 1.2 2 }
    MaterialIndex 2 Sphere { center -4 -0.1 2.5 radius 0.9 }
    MaterialIndex 3 Sphere { center 0.5 -0.3 5 radius 0.7 }
    MaterialIndex 4 Torus { center 0 4 0 axis 0 1 0 majorRadius 1.5 minorRadius 0.3 }
}
";

/// Examples that show more than the default values of a statement.
const EXAMPLES: [(&str, &str); 30] = [
    ("Fog", "Fog { extinction 0.25 color 0.9 0.95 1 }"),
    ("Texture", "Texture { name bark picture bark.png wrapU mirror uvTransform { 4 0 0  0 4 0 } }"),
    ("Background", "Background { color 0.7 0.8 0.9 ambientLight 0.2 0.2 0.2 }"),
    ("DirectionalLight", "DirectionalLight { direction -1 -2 -0.7 color 0.9 0.85 0.7 }"),
    ("PointLight", "PointLight { position 1.6 1.8 1.4 color 3 2.8 2.4 falloff 0.4 }"),
    ("SpotLight", "SpotLight { position 0 3 1 direction 0 -1 -0.3 color 9 8 6 angle 35 innerAngle 10 }"),
    ("PhotometricLight", "PhotometricLight { position 0 3 1 file lamps/street.ies color 0.3 0.28 0.24 }"), // prose: keep
    (
        "PhongMaterial",
        "PhongMaterial { diffuseColor 0.2 0.4 0.6 specularColor 0.8 0.8 0.8 exponent 60 reflectiveColor 0.2 0.2 0.2 }",
    ),
    ("PrincipledMaterial", "PrincipledMaterial { baseColor 0.9 0.55 0.3 baseMetalness 1 specularRoughness 0.25 }"),
    ("HairMaterial", "HairMaterial { eumelanin 0.4 pheomelanin 0.5 longitudinalRoughness 0.25 }"),
    ("Checkerboard", "Checkerboard { Transform { UniformScale 0.5 } materialIndex 1 materialIndex 2 }"),
    ("Noise", "Noise { Transform { UniformScale 0.12 } materialIndex 1 materialIndex 2 octaves 2 }"),
    ("Marble", "Marble { materialIndex 1 materialIndex 2 octaves 4 frequency 6 amplitude 5 }"),
    ("Wood", "Wood { materialIndex 1 materialIndex 2 octaves 2 frequency 20 amplitude 2 }"),
    ("Mix", "Mix { materialIndex 1 materialIndex 2 share 0.7 }"),
    ("TwoSided", "TwoSided { materialIndex 1 materialIndex 2 }"),
    (
        "Noise in a material",
        "PhongMaterial { Noise { color 0.2 0.1 0.05 color 0.9 0.7 0.5 octaves 3 frequency 5 amplitude 4 } }",
    ),
    ("Plane", "Plane { normal 2 1 0.4 offset -1.6 }"),
    ("Triangle", "Triangle { vertex0 -1.2 -1 0.4 vertex1 1.2 -1 0.4 vertex2 0 1.1 -0.4 }"),
    ("Box", "Box { min -0.8 -1.3 -0.8 max 0.8 0.3 0.8 }"),
    ("Cylinder", "Cylinder { base 0 -1.3 0 top 0 0.6 0 radius 0.8 }"),
    ("Cone", "Cone { base 0 -1.3 0 top 0 0.6 0 baseRadius 1 topRadius 0.4 }"),
    ("Torus", "Torus { center 0 -0.5 0 axis 0.3 1 0.2 majorRadius 1 minorRadius 0.35 }"),
    ("Ellipsoid", "Ellipsoid { center 0 -0.3 0 radii 1.2 0.9 0.6 }"),
    ("Disc", "Disc { center 0 -0.4 0 normal 0.3 1 0.6 radius 1.2 innerRadius 0.5 }"),
    ("Rectangle", "Rectangle { corner -1 -1.1 0.5 edge0 2 0 0 edge1 0 1.6 -1 }"),
    (
        "TriangleMesh",
        "Transform { Translate 0 -1.3 0 UniformScale 0.75 TriangleMesh { obj_file meshes/durer-solid.obj } }",
    ),
    ("HeightField", "HeightField { picture textures/hills.png min -1.4 -1 -1.4 max 1.4 0.2 1.4 depth 0.3 }"),
    ("Quadric", "Quadric { squares 1 2 1.5 products 0.8 0 0.5 linear 0 0.8 0 constant -0.6 }"),
    ("Grid", "Grid { min -1 -1.2 -1 max 1 0.8 1 numCells 10 10 10 rasterizeSphere { center 0 -0.2 0 radius 0.95 } }"),
];

/// Description of the field `preset`.
const PRESET: &str = "A real material by name, as the first field of a `PrincipledMaterial`; later fields change it. Names: aluminum-brushed, \
    beryllium, blackboard, blood, brass, brick, carpaint, cesium, charcoal, chromium, cobalt, coffee, concrete, \
    cooking-oil, copper, diamond, egg-shell, eye-cornea, eye-lens, gasoline, germanium, glass, gold, gray-card, \
    honey-liquid, ice, iridium, iron, lcd-display-6500k, lead, light-bulb-2700k, light-bulb-5000k, lithium, \
    magnesium, manganese, mercury, molybdenum, nickel, office-paper, palladium, plastic-acrylic, plastic-pc, \
    plastic-pet, plastic-polyurethane, plastic-pp, plastic-pvc, platinum, potassium, quartz, rubidium, salt, sand, \
    sapphire, silicon, silver, sodium, stainless-steel, tire, titanium, toner-black, tungsten, vanadium, velvet, \
    water, whiteboard, zinc.";

/// Keywords of the grammar itself. Each entry has the spellings, the chapter, the values, a
/// description and an example.
#[rustfmt::skip]
const GRAMMAR: &[(&[Spelling], Chapter, &str, &str, &str)] = &[
    (&[("Lights", set::CLASSIC)], Chapter::Structure, "{ lights }",
        "The lights. Without any light, an ambient light of 0 0 0 becomes 1 1 1.", "Lights { PointLight { position 0 4 0 color 1 1 1 } }"),
    (&[("Textures", set::DURER)], Chapter::Structure, "{ textures }",
        "Named pictures with their mappings. Materials refer to them by name in place of a file.",
        "Textures { Texture { name bark picture bark.png wrapU mirror } }"),
    (&[("Materials", set::ALL)], Chapter::Structure, "{ materials }",
        "The materials, numbered from 0 in file order. In the Dürer dialect, a name may precede each block.",
        "Materials { PhongMaterial red { diffuseColor 0.8 0.2 0.2 } }"),
    (&[("Group", set::CLASSIC)], Chapter::Structure, "{ objects }",
        "Several objects. A scene has one group at its top; groups may be nested.",
        "Group { MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }"),
    (&[("MaterialIndex", set::CLASSIC)], Chapter::Structure, "n",
        "The material of all following objects, up to the next `MaterialIndex`: its number or, in the Dürer dialect, its name.", "MaterialIndex red"),
    (&[("include", set::DURER)], Chapter::Structure, "file",
        "Inserts the text of a file in or below the scene's folder. The file must close all blocks that it opens.",
        "include room.txt"),
    (&[("define", set::DURER)], Chapter::Structure, "name object",
        "Names an object without showing it. Its parts without a material take the one that is current at each use. Allowed \
         at the top of a file or in a group, before its first use.",
        "define column Group { Cylinder { base 0 0 0 top 0 3 0 radius 0.3 } Box { min -0.5 3 -0.5 max 0.5 3.3 0.5 } }"),
    (&[("use", set::DURER)], Chapter::Structure, "name",
        "A copy of a defined object. Allowed in groups, transforms and solids.", "Transform { Translate 2 0 0 use column }"),
    (&[("numObjects", set::CLASSIC), ("num_objects", set::F03)], Chapter::Structure, "n",
        "Number of objects in this group. The course's programs require it; Dürer checks it if it is present.",
        "Group { numObjects 1 MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }"),
    (&[("numLights", set::CLASSIC)], Chapter::Structure, "n", "Number of lights; see `numObjects`.",
        "Lights { numLights 1 DirectionalLight { direction 0 -1 0 color 1 1 1 } }"),
    (&[("numMaterials", set::CLASSIC)], Chapter::Structure, "n", "Number of materials; see `numObjects`.",
        "Materials { numMaterials 1 PhongMaterial { diffuseColor 0.8 0.2 0.2 } }"),
    (&[("Scene", set::F23)], Chapter::Structure, "{ nodes and components }", "The root node of a scene of 2020 to 2023.",
        "Scene { Node { Transform { translate 0 1 0 } Component<Material> { index 0 } Component<Object> { type sphere radius 1 } } }"),
    (&[("Node", set::F23)], Chapter::Structure, "{ Transform, nodes and components }",
        "A node in the tree of a scene of 2020 to 2023. Its transform applies to all its contents.",
        "Node { Transform { translate 0 1 0 } Component<Material> { index 0 } Component<Object> { type sphere radius 1 } }"),
    (&[("Component<Object>", set::F23)], Chapter::Structure, "{ type ... }",
        "An object at a node: `type` is `sphere`, `plane`, `triangle` or `mesh`; the fields of that shape follow.",
        "Component<Object> { type sphere radius 1 }"),
    (&[("Component<Light>", set::F23)], Chapter::Structure, "{ type ... }",
        "A light at a node: `type` is `point` or `directional`; its fields follow.",
        "Component<Light> { type directional direction -0.5 -0.3 -1 color 0.9 0.9 0.9 }"),
    (&[("Component<Material>", set::F23)], Chapter::Structure, "{ index n }",
        "The material of a node's objects, as a number in `Materials`.", "Component<Material> { index 0 }"),
    (&[("type", set::F23)], Chapter::Structure, "word", "Kind of a component.", "Component<Object> { type mesh obj_file models/cube.obj }"),
    (&[("index", set::F23)], Chapter::Structure, "n", "The number of a material.", "Component<Material> { index 1 }"),
    (&[("preset", set::DURER)], Chapter::Materials, "name",
        PRESET, "PrincipledMaterial { preset gold specularRoughness 0.2 }"),
    (&[("Transform", set::ALL)], Chapter::Transforms, "{ matrices object }",
        "One transformed object. The matrices are multiplied in file order: the last one is applied to the object first.",
        "Transform { Translate 0 -0.4 0 ZRotate 25 Scale 1 0.5 0.7 Sphere { center 0 0 0 radius 1 } }"),
    (&[("Translate", set::CLASSIC), ("translate", set::F23)], Chapter::Transforms, "x y z", "Moves by a vector.",
        "Transform { Translate 0.8 -0.5 0 Sphere { center 0 0 0 radius 0.7 } }"),
    (&[("Scale", set::CLASSIC), ("scale", set::F23)], Chapter::Transforms, "x y z",
        "Scales along the axes. Factors must not be 0; negative factors mirror.",
        "Transform { Scale 1.2 0.5 0.8 Sphere { center 0 0 0 radius 1 } }"),
    (&[("UniformScale", set::CLASSIC), ("uniform_scale", set::F23)], Chapter::Transforms, "s",
        "Scales equally along all axes.", "Transform { UniformScale 0.6 Sphere { center 0 0 0 radius 1 } }"),
    (&[("XRotate", set::CLASSIC), ("x_rotate", set::F23)], Chapter::Transforms, "degrees",
        "Rotates about the x axis, from y towards z.", "Transform { XRotate 30 Box { min -0.6 -0.9 -0.6 max 0.6 0.9 0.6 } }"),
    (&[("YRotate", set::CLASSIC), ("y_rotate", set::F23)], Chapter::Transforms, "degrees",
        "Rotates about the y axis, from z towards x.", "Transform { YRotate 60 Box { min -1 -1.2 -0.4 max 1 0.3 0.4 } }"),
    (&[("ZRotate", set::CLASSIC), ("z_rotate", set::F23)], Chapter::Transforms, "degrees",
        "Rotates about the z axis, from x towards y.", "Transform { ZRotate 30 Box { min -0.6 -0.9 -0.6 max 0.6 0.9 0.6 } }"),
    (&[("Rotate", set::CLASSIC), ("rotate", set::F23)], Chapter::Transforms, "{ x y z degrees }",
        "Rotates about an axis through the origin.",
        "Transform { Rotate { 1 1 0 50 } Box { min -0.6 -0.9 -0.6 max 0.6 0.9 0.6 } }"),
    (&[("Matrix", set::OLD | set::DURER), ("Matrix4f", set::NEW | set::DURER)], Chapter::Transforms, "{ 16 numbers }",
        "Any affine map. `Matrix` lists rows, `Matrix4f` columns; the last row is 0 0 0 1.",
        "Transform { Matrix { 1 0.6 0 0  0 1 0 -0.4  0 0 1 0  0 0 0 1 } Box { min -0.6 -0.8 -0.6 max 0.6 0.8 0.6 } }"),
];

/// Returns the entries of all keywords, sorted by chapter.
pub fn entries() -> Vec<Entry> {
    let mut all: Vec<Entry> = Vec::new();
    all.extend(of::<Background>(Chapter::Structure));
    all.extend(of::<Fog>(Chapter::Structure));
    all.extend(of::<NamedTexture>(Chapter::Structure));
    all.extend(of::<Camera>(Chapter::Cameras));
    all.extend(of::<Light>(Chapter::Lights));
    all.extend(of::<PhongMaterial>(Chapter::Materials));
    all.extend(of::<PrincipledMaterial>(Chapter::Materials));
    all.extend(of::<HairMaterial>(Chapter::Materials));
    let noise = of::<ColorNoise>(Chapter::Materials);
    all.extend(noise.into_iter().map(|entry| Entry { example: example_of("Noise in a material"), ..entry }));
    all.extend(of::<PatternMaterial>(Chapter::Materials));
    all.extend(of::<Primitive>(Chapter::Shapes));
    all.extend(of::<TriangleMesh>(Chapter::Shapes));
    all.extend(of::<HeightField>(Chapter::Shapes));
    all.extend(of::<VoxelGrid>(Chapter::Shapes));
    all.extend(CsgOperation::ALL.map(|(word, operation)| Entry {
        keywords: vec![(word, set::DURER)],
        chapter: Chapter::Solids,
        doc: operation.doc().into(),
        values: "{ closed shapes, solids and groups of them }",
        fields: Vec::new(),
        example: format!(
            "{word} {{ Box {{ min -1 -1.3 -1 max 0.6 0.3 0.6 }} Sphere {{ center 0.5 0 0.5 radius 0.8 }} }}"
        ),
    }));
    all.extend(GRAMMAR.iter().map(|&(keywords, chapter, values, doc, example)| Entry {
        keywords: keywords.to_vec(),
        chapter,
        doc: doc.into(),
        values,
        fields: Vec::new(),
        example: example.into(),
    }));
    all.sort_by_key(|entry| Chapter::ALL.iter().position(|chapter| *chapter == entry.chapter));
    all
}

/// Returns the entries for a list of statements that have descriptions.
fn of<T: DescribedKind>(chapter: Chapter) -> Vec<Entry> {
    let entry = |mut kind: T| {
        let keywords = kind.keywords().to_vec();
        let own = keywords.iter().fold(0, |all, keyword| all | keyword.1);
        let fields = (0..kind.fields().len()).map(|i| field(&kind, i, own)).collect();
        let doc = one_line(kind.doc());
        let name = keywords[0].0;
        let example = match EXAMPLES.iter().any(|row| row.0 == name) {
            true => example_of(name),
            false => {
                // Raise the camera slightly above the ground, so that it sees more of the scene.
                let center = kind.fields().iter().position(|field| field.name == "center");
                if let (Chapter::Cameras, Some(center)) = (chapter, center) {
                    kind.set(center, Value::Vec3(Vec3::new(0.0, 0.3, 0.0)));
                }
                let text = write_item(&kind, Dialect::Durer);
                text.split_whitespace().collect::<Vec<_>>().join(" ")
            }
        };
        Entry { keywords, chapter, doc, values: "", fields, example }
    };
    T::kinds().into_iter().map(entry).collect()
}

fn example_of(name: &str) -> String {
    EXAMPLES.iter().find(|row| row.0 == name).map_or(String::new(), |row| row.1.into())
}

fn field<T: DescribedKind>(kind: &T, i: usize, own: DialectSet) -> FieldEntry {
    let field = &kind.fields()[i];
    let words = field.keywords.iter().map(|&(word, dialects)| (word, dialects & own)).collect();
    let default = kind.get(i).filter(|_| !field.required).map(|value| value_text(&value));
    FieldEntry {
        name: field.name,
        kind: field.kind,
        words,
        value: value_of(field.kind, field.constraint),
        required: field.required,
        default: default.filter(|text| !text.is_empty()),
        doc: one_line(field.doc),
    }
}

/// Returns the names of the dialects that are in a set, or `all dialects` for the complete set.
pub fn dialect_names(dialects: DialectSet) -> String {
    if dialects == set::ALL {
        return "all dialects".into();
    }
    let names: Vec<&str> = Dialect::ALL.into_iter().filter(|d| d.is_in(dialects)).map(Dialect::name).collect();
    names.join(", ")
}

/// Describes in words the values that a type and a constraint allow.
fn value_of(kind: FieldKind, rule: Constraint) -> String {
    let kind = match kind {
        FieldKind::Float => "number".to_string(),
        FieldKind::Int => "whole number".into(),
        FieldKind::Vec3 => "three numbers".into(),
        FieldKind::Path => "path".into(),
        FieldKind::Word(words) => return words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", "),
        FieldKind::Rows(width) => format!("`{{ }}` with rows of {width} numbers"),
    };
    let rule = match rule {
        Constraint::Any => return kind,
        Constraint::Positive => "more than 0".to_string(),
        Constraint::NonNegative => "0 or more".into(),
        Constraint::NonZero => "not 0 0 0".into(),
        Constraint::Between(low, high) => format!("more than {low}, less than {high}"),
        Constraint::Within(low, high) => format!("from {low} to {high}"),
        Constraint::UnitInterval => "from 0 to 1".into(),
        Constraint::UpTo(high) => format!("more than 0, at most {high}"),
        Constraint::AtMost(most) => format!("at most {most}"),
        Constraint::OneTo(last) => format!("from 1 to {last}"),
        Constraint::Rows(least, most) if least == most => format!("{least} of them"),
        Constraint::Rows(least, most) => format!("{least} to {most} of them"),
        Constraint::Counts(most) => format!("whole, 1 to {most}"),
    };
    format!("{kind}, {rule}")
}

fn value_text(value: &Value) -> String {
    match value {
        Value::Float(x) => x.to_string(),
        Value::Int(i) => i.to_string(),
        Value::Vec3(v) => format!("{} {} {}", v.x, v.y, v.z),
        Value::Path(name) => name.path.clone(),
        Value::Word(word) => word.clone(),
        Value::Rows(_) => String::new(),
    }
}

fn one_line(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns all words of the language in sorted order, including names of fields and values. The
/// list is used by editors and for suggestions.
pub fn all_words() -> Vec<&'static str> {
    let mut words: Vec<&'static str> = Vec::new();
    for entry in entries() {
        words.extend(entry.keywords.iter().map(|keyword| keyword.0));
        words.extend(entry.fields.iter().flat_map(|field| field.words.iter().map(|word| word.0)));
    }
    words.sort_unstable();
    words.dedup();
    words
}

#[cfg(test)]
mod tests;
