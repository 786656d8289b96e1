//! Tests of vertex colours.

use super::{material, staged};
use durer_scene::material::principled::Switch;
use durer_scene::scene::{Material, SceneDefaults};
use std::path::Path;

/// Returns the material of a triangle that has vertex colours.
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
    let (scene, messages) = staged(text.as_bytes(), Path::new("."), "a.gltf", &SceneDefaults::default());
    let scene = scene.unwrap_or_else(|| panic!("{messages:?}"));
    let Material::Principled(m) = &scene.materials[0].value else { panic!() };
    (**m).clone()
}

#[test]
fn vertex_colours_multiply_unlit_emission() {
    let unlit = r#""extensions":{"KHR_materials_unlit":{}}"#;
    assert_eq!(colored(unlit).emission_vertex_colors, Switch::On);
    // Without colours the emission is uniform, so the mesh can be sampled as a light.
    assert_eq!(material(unlit).emission_vertex_colors, Switch::Off);
    assert_eq!(colored(r#""emissiveFactor":[1,1,1]"#).emission_vertex_colors, Switch::Off);
}

#[test]
fn vertex_alpha_applies_before_the_mask_cutoff() {
    let factor = r#""alphaMode":"MASK","alphaCutoff":0.25,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]}"#;
    let m = colored(factor);
    assert_eq!((m.opacity, m.opacity_cutoff), (0.5, Some(0.25)));
    let m = material(factor);
    assert_eq!((m.opacity, m.opacity_cutoff), (1.0, None));
}
