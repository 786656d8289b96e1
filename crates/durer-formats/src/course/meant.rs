//! Words that are not in the language, or not in this year's, and what they mean there.

use super::words::dialects_of;
use durer_scene::dialect::Dialect;

/// The same in the first grammar and in that of nodes.
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

/// What people write, what they mean, and what is to be said of it. The first of the meant words
/// that is known in the place counts.
const SLIPS: [(&str, &[&str], &str); 29] = [
    ("plain", &["Plane", "plane"], ""),
    ("ball", &["Sphere", "sphere"], ""),
    ("mesh", &["TriangleMesh"], ""),
    ("model", &["TriangleMesh", "mesh"], ""),
    ("file", &["obj_file"], ""),
    ("obj", &["obj_file", "TriangleMesh", "mesh"], ""),
    ("arealight", &["PointLight"], "a surface shines by the `emissionLuminance` of its `PrincipledMaterial`"),
    ("light", &["PointLight", "DirectionalLight"], ""),
    ("sun", &["DirectionalLight"], ""),
    ("camera", &["PerspectiveCamera", "Camera"], ""),
    (
        "rotation",
        &["YRotate", "y_rotate"],
        "`XRotate`, `YRotate` and `ZRotate` turn about an axis, `Rotate { x y z angle }` about any",
    ),
    (
        "rotate",
        &["YRotate", "y_rotate"],
        "`XRotate`, `YRotate` and `ZRotate` turn about an axis, `Rotate { x y z angle }` about any",
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
    ("intensity", &["color"], "the colour is the strength too"),
    ("colour", &["color"], ""),
    ("ambient", &["ambientLight", "ambient_light"], ""),
    ("reflection", &["reflectiveColor"], ""),
    ("refraction", &["indexOfRefraction", "refractionIndex"], ""),
    ("ior", &["indexOfRefraction", "refractionIndex"], ""),
    ("material", &["MaterialIndex"], ""),
];

/// The word of this dialect's grammar for a word of the other.
pub(super) fn counterpart(word: &str, dialect: Dialect) -> Option<&'static str> {
    let nodes = dialect == Dialect::F23;
    let row = COUNTERPARTS.iter().find(|(classic, node)| if nodes { *classic == word } else { *node == word })?;
    let there = if nodes { row.1 } else { row.0 };
    dialects_of(there).filter(|set| dialect.is_in(*set) || dialect == Dialect::Durer).map(|_| there)
}

/// The same in different years of the first grammar.
const YEARS: [(&str, &str); 5] = [
    ("exponent", "shininess"),
    ("falloff", "attenuation"),
    ("refractionIndex", "indexOfRefraction"),
    ("num_objects", "numObjects"),
    ("Matrix", "Matrix4f"),
];

/// The word of this dialect for a word of another year.
pub(super) fn here(word: &str, dialect: Dialect) -> Option<&'static str> {
    let other = YEARS.iter().find_map(|&(a, b)| (a == word).then_some(b).or((b == word).then_some(a)));
    let known = |word: &&str| dialects_of(word).is_some_and(|set| dialect.is_in(set));
    counterpart(word, dialect).or(other.filter(known))
}

/// The known word that a slip means, and what is to be said of it.
pub(super) fn slip<'w>(word: &str, known: impl IntoIterator<Item = &'w str>) -> Option<(&'w str, &'static str)> {
    let known: Vec<&str> = known.into_iter().collect();
    let row = SLIPS.iter().find(|row| row.0.eq_ignore_ascii_case(word))?;
    let meant = row.1.iter().find_map(|meant| known.iter().find(|known| *known == meant))?;
    (*meant != word).then_some((meant, row.2))
}

/// What is to be said of a word of the language in a block that has another for it.
pub(super) fn misplaced(word: &str, place: &str) -> Option<&'static str> {
    let within = |block: &str| place.contains(block);
    Some(match word {
        "position" if within("DirectionalLight") || within("directional") => {
            "a directional light has no place: its `direction` says where its light goes; a `PointLight` has a `position`"
        }
        "direction" if within("PointLight") || within("point") => {
            "a point light shines to all sides: its `position` says where it is; a `DirectionalLight` has a `direction`"
        }
        "position" if within("Camera") => "the camera's place is its `center`",
        "position" => "the place of a sphere is its `center`",
        "color" if within("Material") => {
            "a material's colour is its `diffuseColor` (`diffuse` in the grammar of nodes)"
        }
        "angle" if within("Orthographic") => "an orthographic picture has a `size`, not an angle",
        "size" if within("Perspective") => "a perspective picture has an `angle`, not a size",
        _ => return None,
    })
}
