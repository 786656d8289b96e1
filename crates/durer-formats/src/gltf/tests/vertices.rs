//! What the colours of vertices do.

use super::{material, staged};
use durer_scene::material::principled::Switch;
use durer_scene::scene::{Material, Staging};
use std::path::Path;

/// The material of a triangle whose vertices have colours.
fn colored(words: &str) -> durer_scene::material::PrincipledMaterial {
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"COLOR_0":1}},"material":0}}]}}],"materials":[{{{words}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
        {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC4"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":48}}],
        "buffers":[{{"byteLength":84,"uri":"data:application/octet-stream;base64,{}"}}]}}"#,
        "A".repeat(112)
    );
    let (scene, told) = staged(text.as_bytes(), Path::new("."), "a.gltf", &Staging::default());
    let scene = scene.unwrap_or_else(|| panic!("{told:?}"));
    let Material::Principled(m) = &scene.materials[0].value else { panic!() };
    (**m).clone()
}

#[test]
fn they_multiply_what_is_not_lit() {
    let unlit = r#""extensions":{"KHR_materials_unlit":{}}"#;
    assert_eq!(colored(unlit).emission_vertex_colors, Switch::On);
    // Without colours all points shine alike, and can be chosen as lights.
    assert_eq!(material(unlit).emission_vertex_colors, Switch::Off);
    assert_eq!(colored(r#""emissiveFactor":[1,1,1]"#).emission_vertex_colors, Switch::Off);
}

#[test]
fn their_alpha_counts_before_the_cutoff_of_a_mask() {
    let factor = r#""alphaMode":"MASK","alphaCutoff":0.25,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]}"#;
    let m = colored(factor);
    assert_eq!((m.opacity, m.opacity_cutoff), (0.5, Some(0.25)));
    let m = material(factor);
    assert_eq!((m.opacity, m.opacity_cutoff), (1.0, None));
}
