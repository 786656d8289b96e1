//! Suggestions for words that do not exist in the language or in the dialect of the file.

use super::words::dialects_of;
use durer_scene::dialect::Dialect;

/// Words of the older grammar and their counterparts in the grammar of nodes.
const COUNTERPARTS: [(&str, &str); 20] = [
    ("angle", "fov"),
    ("ambientLight", "ambient_light"),
    ("cubeMap", "cube_map"),
    ("diffuseColor", "diffuse"),
    ("specularColor", "specular"),
    ("falloff", "attenuation"),
    ("PerspectiveCamera", "Camera"),
    ("Group", "Node"),
    ("MaterialIndex", "Component<Material>"),
    ("Lights", "Component<Light>"),
    ("PointLight", "Component<Light>"),
    ("DirectionalLight", "Component<Light>"),
    ("Sphere", "Component<Object>"),
    ("Plane", "Component<Object>"),
    ("TriangleMesh", "Component<Object>"),
    ("Translate", "translate"),
    ("Scale", "scale"),
    ("XRotate", "x_rotate"),
    ("YRotate", "y_rotate"),
    ("ZRotate", "z_rotate"),
];

/// Common mistakes. Each entry has the wrong word, the words that may have been intended, and a
/// remark. The first of the intended words that is valid in the block is suggested.
const COMMON_MISTAKES: [(&str, &[&str], &str); 59] = [
    ("plain", &["Plane", "plane"], ""),
    ("ball", &["Sphere", "sphere"], ""),
    ("cube", &["Box"], ""),
    ("cuboid", &["Box"], ""),
    ("disk", &["Disc"], ""),
    ("donut", &["Torus"], ""),
    ("subtract", &["Difference"], ""),
    ("subtraction", &["Difference"], ""),
    ("minus", &["Difference"], ""),
    ("mesh", &["TriangleMesh"], ""),
    ("model", &["TriangleMesh", "mesh"], ""),
    ("file", &["obj_file"], ""),
    ("obj", &["obj_file", "TriangleMesh", "mesh"], ""),
    ("arealight", &["PointLight"], "a surface emits light with the `emissionLuminance` of its `PrincipledMaterial`"),
    ("light", &["PointLight", "DirectionalLight"], ""),
    ("sun", &["DirectionalLight"], ""),
    ("camera", &["PerspectiveCamera", "Camera"], ""),
    (
        "rotation",
        &["YRotate", "y_rotate"],
        "`XRotate`, `YRotate` and `ZRotate` rotate about one axis, and `Rotate { x y z angle }` about any axis",
    ),
    (
        "rotate",
        &["YRotate", "y_rotate"],
        "`XRotate`, `YRotate` and `ZRotate` rotate about one axis, and `Rotate { x y z angle }` about any axis",
    ),
    ("move", &["Translate", "translate"], ""),
    ("translation", &["Translate", "translate"], ""),
    ("size", &["radius", "Scale", "scale"], ""),
    ("scaling", &["Scale", "scale"], ""),
    ("scale", &["Scale", "UniformScale"], ""),
    ("eye", &["center"], ""),
    ("lookat", &["direction"], "`direction` is a direction, not a point to look at"),
    ("target", &["direction"], "`direction` is a direction, not a point to look at"),
    ("from", &["center"], ""),
    ("fovy", &["angle", "fov"], ""),
    ("intensity", &["color"], "the colour includes the intensity"),
    ("colour", &["color"], ""),
    ("ambient", &["ambientLight", "ambient_light"], ""),
    ("reflection", &["reflectiveColor"], ""),
    ("refraction", &["indexOfRefraction", "refractionIndex"], ""),
    ("ior", &["indexOfRefraction", "refractionIndex", "specularIor"], ""),
    ("material", &["MaterialIndex"], ""),
    // Parameters of other programs' materials.
    ("roughness", &["specularRoughness"], "that is the roughness of the surface itself, below any coat"),
    ("anisotropy", &["specularAnisotropy"], ""),
    ("specular", &["specularWeight"], ""),
    ("metallic", &["baseMetalness"], ""),
    ("metalness", &["baseMetalness"], ""),
    ("metal", &["baseMetalness"], ""),
    ("albedo", &["baseColor", "diffuseColor"], ""),
    ("diffuse", &["baseColor", "diffuseColor"], ""),
    ("diffuseColor", &["baseColor"], ""),
    ("transmission", &["transmissionWeight"], ""),
    ("transparency", &["transmissionWeight", "transparentColor"], ""),
    ("subsurface", &["subsurfaceWeight"], ""),
    ("coat", &["coatWeight"], ""),
    ("clearcoat", &["coatWeight"], ""),
    ("clearcoatRoughness", &["coatRoughness"], ""),
    ("sheen", &["fuzzWeight"], ""),
    ("fuzz", &["fuzzWeight"], ""),
    ("emission", &["emissionLuminance"], "`emissionColor` is its colour"),
    ("emissive", &["emissionLuminance"], "`emissionColor` is its colour"),
    ("normalMap", &["normalTexture"], ""),
    ("bumpMap", &["bumpTexture"], ""),
    ("indexOfRefraction", &["specularIor"], ""),
    ("alpha", &["opacity"], ""),
];

/// Returns the word in this dialect's grammar for a word of the other grammar.
pub(super) fn counterpart(word: &str, dialect: Dialect) -> Option<&'static str> {
    let nodes = dialect == Dialect::F23;
    let row = COUNTERPARTS.iter().find(|(classic, node)| if nodes { *classic == word } else { *node == word })?;
    let there = if nodes { row.1 } else { row.0 };
    dialects_of(there).filter(|set| dialect.is_in(*set) || dialect == Dialect::Durer).map(|_| there)
}

/// Pairs of words that have the same meaning in different years of the older grammar.
const YEARS: [(&str, &str); 5] = [
    ("exponent", "shininess"),
    ("falloff", "attenuation"),
    ("refractionIndex", "indexOfRefraction"),
    ("num_objects", "numObjects"),
    ("Matrix", "Matrix4f"),
];

/// Returns the word in this dialect for a word of another year.
pub(super) fn word_in_dialect(word: &str, dialect: Dialect) -> Option<&'static str> {
    let other = YEARS.iter().find_map(|&(a, b)| (a == word).then_some(b).or((b == word).then_some(a)));
    let known = |word: &&str| dialects_of(word).is_some_and(|set| dialect.is_in(set));
    counterpart(word, dialect).or(other.filter(known))
}

/// Returns the valid word that corrects a common mistake, and a remark about it.
pub(super) fn common_mistake<'w>(
    word: &str,
    known: impl IntoIterator<Item = &'w str>,
) -> Option<(&'w str, &'static str)> {
    let known: Vec<&str> = known.into_iter().collect();
    let row = COMMON_MISTAKES.iter().find(|row| row.0.eq_ignore_ascii_case(word))?;
    let suggestion = row.1.iter().find_map(|suggestion| known.iter().find(|known| *known == suggestion))?;
    (*suggestion != word).then_some((suggestion, row.2))
}

/// Objects for which people write a field for the material.
const SHAPES: [&str; 9] =
    ["Sphere", "Plane", "Triangle", "TriangleMesh", "Box", "Cylinder", "Cone", "Torus", "Rectangle"];

/// Returns a remark about a word that exists in the language, but that is not allowed in this
/// block.
pub(super) fn misplaced(word: &str, place: &str) -> Option<&'static str> {
    let within = |block: &str| place.contains(block);
    Some(match word {
        "position" if within("DirectionalLight") || within("directional") => {
            "a directional light has a `direction` in which it shines, but no position; a `PointLight` has a `position`"
        }
        "direction" if within("PointLight") || within("point") => {
            "a point light has a `position` and shines in all directions; a `DirectionalLight` has a `direction`"
        }
        "material" | "Material" if SHAPES.contains(&place) => {
            "the material is selected before the object: `MaterialIndex red Sphere { ... }`"
        }
        "name" if within("Material") => "the name stands before the block: `PhongMaterial red { ... }`",
        "position" if within("Camera") => "the position of a camera is its `center`",
        "position" => "the position of a sphere is its `center`",
        "color" if within("PrincipledMaterial") => "the colour of this material is its `baseColor`",
        "color" if within("Material") => {
            "a material's colour is its `diffuseColor` (`diffuse` in the grammar of nodes)"
        }
        "lumens" | "candela" | "lux" | "watts" if within("Material") => {
            "a surface has an `emissionLuminance` in cd/m^2: the flux in lumens divided by pi and the area, if it shines \
             to one side"
        }
        "angle" if within("Orthographic") => "an orthographic camera has a `size`, not an angle",
        "size" if within("Perspective") => "a perspective camera has an `angle`, not a size",
        _ => return None,
    })
}
