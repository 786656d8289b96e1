//! Checks for textures that show only one colour, and for normal maps that contain something else.

use super::finding::{Finding, MAX_FINDINGS};
use super::layers::layers;
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_render::world::{Geometry, Material};
use durer_scene::texture::Mapping;

/// Differences below two steps of an 8-bit value count as rounding errors.
const GREY: f32 = 2.0 / 255.0;

/// Returns true if a mapping gives all points the same texture coordinates.
fn is_constant(mapping: &Mapping) -> bool {
    mapping.transform.iter().all(|row| row[..2] == [0.0, 0.0])
}

/// Reports textures that show a single colour. Either the image has only one colour, or all
/// vertices of a mesh have the same texture coordinates.
pub(super) fn flat_texture(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let mut findings = Vec::new();
    for (number, material) in scene_probe.input.scene.materials.iter().enumerate().take(MAX_FINDINGS) {
        let Some(Material::Phong(phong)) = world.materials().get(number) else { continue };
        let Some(texture) = phong.texture.and_then(|texture| world.textures().get(texture as usize)) else { continue };
        let own = || world.objects().iter().filter(|object| object.material as usize == number);
        let is_still =
            |geometry: &Geometry| matches!(geometry, Geometry::Mesh(tree) if tree.mesh.constant_uv().is_some());
        let one_place = own().find(|object| is_still(&object.geometry));
        let (message, help) = if scene_probe.material_rays()[number] == 0 {
            continue;
        } else if texture.is_flat() {
            (
                format!("the texture of material {number} has only one colour"),
                "check whether the image is the right one",
            )
        } else if texture.mapping().is_some_and(is_constant) {
            (
                format!("the `uvTransform` of the texture of material {number} maps all points to one texel"),
                "write `uvTransform { 1 0 0  0 1 0 }`, which leaves texture coordinates unchanged",
            )
        } else if let Some(object) = one_place {
            let name = scene_probe.text(object.span);
            let message = format!("all vertices of the `{name}` have the same texture coordinates");
            (message, "export the texture coordinates of the mesh: the `vt` lines of its file are all equal")
        } else {
            continue;
        };
        let diagnostic = Diagnostic::warning(message).effect("the texture is invisible").help(help);
        findings.push(Finding::from(scene_probe.at_value(diagnostic, material.span, &["texture"])));
    }
    findings
}

/// Reports normal maps whose red, green and blue are equal everywhere, which are height maps.
pub(super) fn normal_maps(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let is_grey = |[r, g, b]: [f32; 3]| (r - g).abs() < GREY && (g - b).abs() < GREY;
    let map = |number: usize| match world.materials().get(number)? {
        Material::Phong(phong) => world.textures().get(phong.principled.as_ref()?.maps.normal? as usize),
        Material::Mix(..) => None,
    };
    let say = |(number, material, _)| {
        if scene_probe.material_rays()[number] == 0 || !map(number)?.all_texels(is_grey) {
            return None;
        }
        let diagnostic = Diagnostic::warning(format!("the normal map of material {number} is grey everywhere"))
            .effect("all normals point in nearly the same wrong direction, so surfaces are too dark or too bright")
            .help("use `bumpTexture` for a map of heights; a normal map is mostly light blue");
        let span: &durer_scene::scene::Spanned<_> = material;
        Some(Finding::from(scene_probe.at_value(diagnostic, span.span, &["normalTexture"])))
    };
    layers(scene_probe).into_iter().filter_map(say).collect()
}
