//! Tests of the scene language reader, and helpers that they share.

mod corpus;
mod errors;
mod forms;
mod limits;
mod malformed;
mod mistakes;
mod named;
mod round_trip;

use super::*;
use durer_diag::{Files, Severity};

/// Reads a text. Returns the diagnostics in the form `line:column severity: message [underlined
/// text] (help)`.
pub(super) fn read_as(text: &[u8], dialect: Dialect, strict: bool) -> (Option<Scene>, Vec<String>) {
    let mut files = Files::default();
    let file = files.add("scene.txt", text.into());
    let mut diagnostics = Diagnostics::default();
    let scene = read(text, file, ReadOptions { dialect, strict, compat: 0 }, &mut diagnostics);
    assert_eq!(scene.is_none(), diagnostics.has_errors());
    let line = |d: &Diagnostic| {
        let span = d.span.expect("every finding has a place");
        for span in [Some(span), d.related.as_ref().map(|r| r.0)].into_iter().flatten() {
            assert!(span.file == file && span.start <= span.end && span.end as usize <= text.len(), "{d:?}");
        }
        let (line, column) = files.position(span).unwrap();
        let underlined = String::from_utf8_lossy(&text[span.start as usize..span.end as usize]);
        let severity = if d.severity == Severity::Error { "error" } else { "warning" };
        let help = d.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
        format!("{line}:{column} {severity}: {} [{underlined}]{help}", d.message)
    };
    let findings: Vec<String> = diagnostics.iter().map(line).collect();
    assert!(findings.iter().filter(|f| f.contains(" error: ")).count() <= durer_diag::ERROR_LIMIT);
    (scene, findings)
}

/// Reads a text, which must not cause any diagnostics.
pub(super) fn clean(text: &str, dialect: Dialect) -> Scene {
    let (scene, findings) = read_as(text.as_bytes(), dialect, false);
    assert_eq!(findings, [""; 0], "{}: {text}", dialect.name());
    scene.unwrap()
}

/// Small scenes in each grammar that use a large part of it.
pub(super) const SMALL: [(Dialect, &str); 4] = [
    (
        Dialect::F04,
        "OrthographicCamera { center 0 0 10 direction 0 0 -1 up 0 1 0 size 5 }\n\
         Lights { numLights 2 PointLight { position 0 5 0 color 1 1 1 attenuation 1 0 .5 }\n\
         DirectionalLight { direction -1 -1 -1 color .9 .9 .9 } }\n\
         Background { color .2 0 .6 ambientLight .1 .1 .1 }\n\
         Materials { numMaterials 3 PhongMaterial { diffuseColor 1 0 0 exponent 20 }\n\
         Material { reflectiveColor 1 1 1 indexOfRefraction 1.5 }\n\
         Wood { Transform { UniformScale 2 Matrix { 1 0 0 2 0 1 0 3 0 0 1 4 0 0 0 1 } }\n\
         materialIndex 0 materialIndex 1 octaves 5 frequency 7 amplitude 2 } }\n\
         Group { numObjects 3 MaterialIndex 0 Sphere { center 0 0 0 radius 1 }\n\
         MaterialIndex 2 Transform { Translate 0 2 0 Rotate { 0 1 0 45 } Scale 1 .5 1\n\
         Group { numObjects 1 MaterialIndex 1 Plane { normal 0 1 0 offset -1 } } }\n\
         Triangle { vertex0 0 0 0 vertex1 1 0 0 vertex2 0 1 0 } }\n",
    ),
    (
        Dialect::F12a5,
        "PerspectiveCamera { center 0 0 10 direction 0 0 -1 up 0 1 0 angle 30 }\n\
         Lights { numLights 1 PointLight { falloff .5 color 1 1 1 position 0 5 0 } }\n\
         Background { color .2 0 .6 cubeMap sky }\n\
         Materials { numMaterials 1 PhongMaterial { shininess 20 texture a.bmp bump b.bmp refractionIndex 1.5\n\
         Noise { color 1 1 1 color 0 0 0 octaves 3 frequency 2 amplitude 4 } } }\n\
         Group { numObjects 1 MaterialIndex 0 Transform { Matrix4f { 1 0 0 0 0 1 0 0 0 0 1 0 2 3 4 1 }\n\
         TriangleMesh { obj_file cube.obj } } }\n",
    ),
    (
        Dialect::F03,
        "OrthographicCamera { center 0 0 10 direction 0 0 -1 up 0 1 0 size 5 }\n\
         Group { num_objects 2 Material { diffuseColor 1 0 0 } Sphere { center 0 0 0 radius 1 }\n\
         Material { diffuseColor 0 1 0 } Transform { Translate { 0 2 0 } YRotate { 45 } Scale { 1 2 3 }\n\
         Sphere { center 1 1 1 radius 2 } } }\n",
    ),
    (
        Dialect::F23,
        "Camera { center 0 0 10 direction 0 0 -1 up 0 1 0 fov 30 }\n\
         Background { color .2 0 .6 ambient_light .1 .1 .1 cube_map sky }\n\
         Materials { Material { diffuse 1 0 0 specular 1 1 1 shininess 5 } Material { diffuse 0 1 0 } }\n\
         Scene { Node { Transform { translate 1 2 3 y_rotate 90 scale 1 2 1 } Component<Material> { index 0 }\n\
         Component<Object> { type sphere radius 1 } Node { Transform { translate 1 0 0 }\n\
         Component<Light> { type point color 1 1 1 attenuation 3 } } }\n\
         Node { Component<Object> { type mesh obj_file cube.obj } Component<Material> { index 1 } }\n\
         Node { Component<Light> { type directional direction 0 -1 0 color 1 1 1 } } }\n",
    ),
];
