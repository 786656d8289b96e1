//! Table of all words of the scene language.

use durer_scene::camera::Camera;
use durer_scene::describe::DescribedKind;
use durer_scene::dialect::{DialectSet, set};
use durer_scene::light::Light;
use durer_scene::material::{ColorNoise, HairMaterial, PatternMaterial, PhongMaterial, PrincipledMaterial};
use durer_scene::medium::Fog;
use durer_scene::scene::{Background, CsgOperation, NamedTexture};
use durer_scene::shape::{HeightField, Primitive, TriangleMesh, VoxelGrid};
use std::collections::HashMap;
use std::sync::LazyLock;

/// Words that belong to the grammar itself, and not to any described statement.
const GRAMMAR: [(&str, DialectSet); 37] = [
    ("include", set::DURER),
    ("define", set::DURER),
    ("use", set::DURER),
    ("preset", set::DURER),
    ("Lights", set::CLASSIC),
    ("Textures", set::DURER),
    ("Materials", set::ALL),
    ("Group", set::CLASSIC),
    ("Transform", set::ALL),
    ("MaterialIndex", set::CLASSIC),
    ("num_objects", set::F03),
    ("numObjects", set::CLASSIC),
    ("numLights", set::CLASSIC),
    ("numMaterials", set::CLASSIC),
    ("Translate", set::CLASSIC),
    ("Scale", set::CLASSIC),
    ("UniformScale", set::CLASSIC),
    ("XRotate", set::CLASSIC),
    ("YRotate", set::CLASSIC),
    ("ZRotate", set::CLASSIC),
    ("Rotate", set::CLASSIC),
    ("Matrix", set::OLD | set::DURER),
    ("Matrix4f", set::NEW | set::DURER),
    ("Scene", set::F23),
    ("Node", set::F23),
    ("Component<Object>", set::F23),
    ("Component<Light>", set::F23),
    ("Component<Material>", set::F23),
    ("type", set::F23),
    ("index", set::F23),
    ("translate", set::F23),
    ("scale", set::F23),
    ("uniform_scale", set::F23),
    ("x_rotate", set::F23),
    ("y_rotate", set::F23),
    ("z_rotate", set::F23),
    ("rotate", set::F23),
];

static WORDS: LazyLock<HashMap<&'static str, DialectSet>> = LazyLock::new(|| {
    let mut words = HashMap::new();
    list::<Camera>(&mut words);
    list::<Light>(&mut words);
    list::<Primitive>(&mut words);
    list::<PatternMaterial>(&mut words);
    list::<PhongMaterial>(&mut words);
    list::<PrincipledMaterial>(&mut words);
    list::<HairMaterial>(&mut words);
    list::<ColorNoise>(&mut words);
    list::<TriangleMesh>(&mut words);
    list::<HeightField>(&mut words);
    list::<VoxelGrid>(&mut words);
    list::<Background>(&mut words);
    list::<Fog>(&mut words);
    list::<NamedTexture>(&mut words);
    let operations = CsgOperation::ALL.map(|(word, _)| (word, set::DURER));
    for (word, set) in GRAMMAR.into_iter().chain(operations) {
        *words.entry(word).or_insert(0) |= set;
    }
    words
});

fn list<T: DescribedKind>(words: &mut HashMap<&'static str, DialectSet>) {
    for kind in T::kinds() {
        let spellings = kind.fields().iter().flat_map(|field| field.keywords);
        for (word, set) in kind.keywords().iter().chain(spellings) {
            *words.entry(word).or_insert(0) |= set;
        }
    }
}

/// Returns the dialects that have a word, or `None` if the word is not in the language.
pub(super) fn dialects_of(word: &str) -> Option<DialectSet> {
    WORDS.get(word).copied()
}

/// Returns all words of the language.
#[cfg(test)]
pub(super) fn all() -> impl Iterator<Item = &'static str> {
    WORDS.keys().copied()
}

/// Returns true if a word begins a block with braces.
pub(super) fn begins_block(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_uppercase()) && WORDS.contains_key(word)
}

/// Returns true if a word cannot be a name because it begins a statement or a block. Names of
/// fields, such as `base`, can be names.
pub(super) fn is_reserved(word: &str) -> bool {
    begins_block(word) || GRAMMAR.iter().any(|(reserved, _)| *reserved == word)
}

/// Returns the block to which a misplaced word belongs.
pub(super) fn block_of(word: &str) -> Option<&'static str> {
    Some(match word {
        "TriangleMesh" | "HeightField" | "Grid" | "Transform" | "MaterialIndex" | "Group" | "use" | "define" => "Group",
        "PhongMaterial" | "PrincipledMaterial" | "HairMaterial" | "Material" | "Checkerboard" | "Marble" | "Wood"
        | "Mix" | "TwoSided" => "Materials",
        "PointLight" | "DirectionalLight" => "Lights",
        "Texture" => "Textures",
        "Translate" | "Scale" | "UniformScale" | "XRotate" | "YRotate" | "ZRotate" | "Rotate" | "Matrix"
        | "Matrix4f" | "translate" | "scale" | "x_rotate" | "y_rotate" | "z_rotate" => "Transform",
        _ if begins_block(word) && Primitive::from_keyword(word).is_some() => "Group",
        _ if CsgOperation::from_keyword(word).is_some() => "Group",
        _ => return None,
    })
}

/// Top-level sections other than the camera.
pub(super) const SECTIONS: [&str; 6] = ["Background", "Fog", "Lights", "Textures", "Materials", "Group"];

/// Sections that exist only in the Dürer dialect.
pub(super) const DURER_SECTIONS: [&str; 2] = ["Fog", "Textures"];

/// Returns the camera whose block begins with the given word, for files in the grammar without
/// nodes.
pub(super) fn camera_of(word: &str) -> Option<Camera> {
    Camera::from_keyword(word).filter(|_| word != "Camera")
}

/// Returns true if a section at the top level of a file begins with the given word.
pub(super) fn is_section(word: &str) -> bool {
    SECTIONS.contains(&word) || camera_of(word).is_some()
}
