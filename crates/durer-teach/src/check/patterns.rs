//! Checks for patterns that are not visible because only one part shows or because their cells are
//! smaller than a pixel.

use super::finding::{Finding, MAX_FINDINGS, number, percent};
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_render::world::{Geometry, Material, World};
use durer_scene::material::{ColorNoise, PatternMaterial};
use durer_scene::math::Vec3;
use durer_scene::scene::Material as ParsedMaterial;
use durer_scene::texture::Mapping;

/// Number of steps per pixel at which a pattern is evaluated.
const STEPS: u32 = 24;
/// Number of changes within a pixel above which a pattern is only noise.
const MAX_CHANGES: usize = 3;
/// A pattern is invisible if its cells are wider than the scene by this factor.
const MAX_CELL_SIZE: f32 = 3.0;
/// Minimum number of visible points needed for a conclusion.
const MIN_POINTS: usize = 20;

/// Solid pattern or colour noise of a material, which is evaluated to find out whether it is
/// visible in the picture. `Solid` contains the matrix to pattern space and
/// [`ShadingRules::conic_rings`](durer_render::world::ShadingRules::conic_rings).
enum PatternSampler<'w> {
    Solid(&'w PatternMaterial, &'w glam::DAffine3, bool),
    Noise(&'w ColorNoise),
}

impl PatternSampler<'_> {
    fn of(world: &World, material: u32) -> Option<PatternSampler<'_>> {
        match world.materials().get(material as usize)? {
            Material::Mix(solid, to_pattern, _) => {
                Some(PatternSampler::Solid(solid, to_pattern, world.shading_rules().conic_rings))
            }
            Material::Phong(phong) => phong.noise.as_ref().map(PatternSampler::Noise),
        }
    }

    fn at(&self, point: Vec3) -> f32 {
        match self {
            PatternSampler::Solid(solid, to_pattern, conic_rings) => {
                solid.share(to_pattern.transform_point3(point.as_dvec3()).as_vec3(), *conic_rings)
            }
            PatternSampler::Noise(noise) => {
                let range = noise.color1 - noise.color2;
                let most = range.abs().max_element().max(1e-6);
                (noise.color(point) - noise.color2).abs().max_element() / most
            }
        }
    }
}

/// Reports patterns of which only one part or only noise is visible.
pub(super) fn scale(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let mut findings = Vec::new();
    for (number, material) in scene_probe.input.scene.materials.iter().enumerate().take(MAX_FINDINGS) {
        let Some(look) = PatternSampler::of(world, number as u32) else { continue };
        // Use direct hits only, because a pattern nested in another one is visible only in some
        // places.
        let points: Vec<(Vec3, f32)> = scene_probe
            .hits()
            .filter(|(_, hit)| hit.material as usize == number)
            .map(|(probe, hit)| (probe.ray.at(hit.t), hit.t * probe.ray.dir.length()))
            .collect();
        if points.len() < MIN_POINTS {
            continue;
        }
        let shares: Vec<f32> = points.iter().map(|(point, _)| look.at(*point)).collect();
        let (least, most) = shares.iter().fold((f32::MAX, f32::MIN), |(a, b), s| (a.min(*s), b.max(*s)));
        let width = pixel(scene_probe);
        let across = [Vec3::new(0.8, 0.36, 0.48), Vec3::new(-0.48, 0.8, 0.36)];
        let noisy = |&(point, away): &(Vec3, f32)| {
            across.iter().all(|way| {
                let step = |i: u32| look.at(point + *way * (width * away * i as f32 / STEPS as f32)) > 0.5;
                (1..STEPS).filter(|&i| step(i) != step(i - 1)).count() > MAX_CHANGES
            })
        };
        let fine = points.iter().filter(|point| noisy(point)).count();
        let (message, effect, help) = if let Some((message, help)) = why_uniform(scene_probe, &look, &material.value) {
            (
                message,
                "the pattern is invisible because only one colour or a few large patches are in the picture",
                help,
            )
        } else if matches!(look, PatternSampler::Solid(PatternMaterial::Mix(_) | PatternMaterial::TwoSided(_), ..)) {
            continue;
        } else if most - least < 1e-3 {
            (
                "only one part of this pattern is in the picture".to_string(),
                "the pattern is invisible because only one colour is in the picture",
                match &material.value {
                    ParsedMaterial::Solid(PatternMaterial::Checkerboard(_), _) => {
                        "check the `Scale` of the `Transform`: the cells of the pattern are larger than the visible \
                         scene"
                    }
                    _ => "check the `frequency`, `amplitude` and `Transform` of the pattern",
                },
            )
        } else if fine * 10 > points.len() * 9 {
            (
                "this pattern is finer than a pixel".to_string(),
                "the pattern looks like noise or averages to one colour",
                "check the `frequency` of the pattern, or the `Scale` of its `Transform`: sizes are in scene units",
            )
        } else {
            continue;
        };
        let mut diagnostic = Diagnostic::warning(message).at(material.span).effect(effect).help(help);
        diagnostic = diagnostic
            .label(format!("on {} of the visible surfaces", percent(points.len(), scene_probe.hits().count())));
        findings.push(Finding::from(diagnostic));
    }
    findings
}

/// Uses the scene description to explain why a pattern does not vary, if possible.
fn why_uniform(
    scene_probe: &SceneProbe,
    look: &PatternSampler,
    material: &ParsedMaterial,
) -> Option<(String, &'static str)> {
    let PatternSampler::Solid(solid, to_pattern, _) = look else { return None };
    if let PatternMaterial::Mix(mix) = solid {
        let message = format!("the `share` of this mix is {}", number(mix.share));
        let help = "use a `share` between 0 and 1 to show both materials";
        let shows_one = mix.share <= 0.0 || mix.share >= 1.0 && mix.share_texture.is_none();
        return shows_one.then_some((message, help));
    }
    if !matches!(solid, PatternMaterial::Checkerboard(_)) || !matches!(material, ParsedMaterial::Solid(..)) {
        return None;
    }
    let cell = to_pattern.inverse().matrix3;
    let cell = cell.x_axis.length().min(cell.y_axis.length()).min(cell.z_axis.length()) as f32;
    // A scene of unbounded objects has no size that could be compared.
    let size = match scene_probe.world().bounds() {
        bounds if bounds.is_empty() => return None,
        bounds => bounds.size().max_element(),
    };
    let message = format!(
        "the cells of this pattern are {} wide, but all objects together are only {} wide",
        number(cell),
        number(size)
    );
    let help = "check the `Scale` of the `Transform`: the cells of the pattern are larger than the visible scene";
    (cell > MAX_CELL_SIZE * size).then_some((message, help))
}

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

/// Estimates the width of a pixel at distance 1.
fn pixel(scene_probe: &SceneProbe) -> f32 {
    let [a, b] = [0, scene_probe.probes.len() - 1].map(|i| &scene_probe.probes[i]);
    let (p, q) = (a.pixel, b.pixel);
    let apart = (p.0.abs_diff(q.0).pow(2) + p.1.abs_diff(q.1).pow(2)) as f32;
    (a.ray.dir.normalize_or_zero() - b.ray.dir.normalize_or_zero()).length() / apart.sqrt().max(1.0)
}
