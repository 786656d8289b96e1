//! Checks for textures that are repeated so often that a repetition is smaller than a pixel.

use super::finding::{Finding, MAX_FINDINGS, number as number_word};
use super::probes::Probe;
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_render::render::{center_ray, raster};
use durer_render::world::Material;
use durer_scene::math::Vec2;
use durer_scene::texture::{Mapping, Wrap};

/// Maximum number of hits at which a texture is examined, and minimum number for a conclusion.
const MAX_POINTS: usize = 80;
const MIN_POINTS: usize = 12;
/// Number of repetitions in a pixel above which a texture cannot be recognised, and fraction of the
/// hits at which it must be exceeded.
const MIN_REPEATS: f32 = 0.7;
const MIN_SHARE: f32 = 0.9;

/// Reports textures whose repetitions are smaller than a pixel.
pub(super) fn fine_texture(scene_probe: &SceneProbe) -> Vec<Finding> {
    let world = scene_probe.world();
    let mut findings = Vec::new();
    for (number, material) in scene_probe.input.scene.materials.iter().enumerate().take(MAX_FINDINGS) {
        let Some(Material::Phong(phong)) = world.materials().get(number) else { continue };
        let Some(texture) = phong.texture.and_then(|texture| world.textures().get(texture as usize)) else { continue };
        let Some(mapping) = texture.mapping().filter(|mapping| !texture.is_flat() && is_repeated(mapping)) else {
            continue;
        };
        let own: Vec<&Probe> =
            (scene_probe.hits().filter(|(_, hit)| hit.material as usize == number)).map(|(probe, _)| probe).collect();
        let chosen = own.iter().step_by(own.len().div_ceil(MAX_POINTS).max(1));
        let mut repeats: Vec<f32> = chosen.filter_map(|probe| repeats_in_pixel(scene_probe, probe, mapping)).collect();
        repeats.sort_by(f32::total_cmp);
        let fine = repeats.iter().filter(|count| **count > MIN_REPEATS).count();
        if repeats.len() < MIN_POINTS || (fine as f32) < MIN_SHARE * repeats.len() as f32 {
            continue;
        }
        let middle = number_word(repeats[repeats.len() / 2]);
        let message =
            format!("the texture of material {number} is finer than a pixel: a pixel shows {middle} copies of it");
        let help = match scene_probe.model_format() {
            Some(_) => "check the scale of the texture coordinates".to_string(),
            None => "use smaller factors in its `uvTransform`, which repeats the picture".into(),
        };
        let diagnostic =
            Diagnostic::warning(message).effect("the texture looks like noise or averages to one colour").help(help);
        let fields = ["texture", "baseColorTexture"];
        findings.push(Finding::from(scene_probe.at_value(diagnostic, material.span, &fields)));
    }
    findings
}

fn is_repeated(mapping: &Mapping) -> bool {
    !mapping.second && mapping.wrap.iter().any(|wrap| *wrap != Wrap::Clamp)
}

/// Returns the number of copies of a texture along a pixel at the hit of a probe, in the direction
/// in which the copies are larger.
fn repeats_in_pixel(scene_probe: &SceneProbe, probe: &Probe, mapping: &Mapping) -> Option<f32> {
    let (world, job) = (scene_probe.world(), scene_probe.input.job);
    let raster = raster(world, job.width, job.height);
    let at = |x: u32, y: u32| {
        let hit = world.intersect(&center_ray(world, &raster, (x, y))?, &mut ())?;
        Some((hit.hit.object, hit.surface.uv.get()?))
    };
    let (x, y) = probe.pixel;
    let (object, here) = at(x, y)?;
    // The last column and row have their neighbours on the other side.
    let beside = |at_end: bool, value: u32| if at_end { value.checked_sub(1) } else { Some(value + 1) };
    let next = [(beside(x + 1 >= job.width, x)?, y), (x, beside(y + 1 >= job.height, y)?)];
    let steps = next.map(|(x, y)| at(x, y).filter(|(other, _)| *other == object).map(|(_, uv)| uv - here));
    let [Some(a), Some(b)] = steps else { return None };
    let length = |step: Vec2| {
        let [u, v] = mapping.transform.map(|[p, q, _]| p * step.x - q * step.y);
        Vec2::new(u, v).length()
    };
    Some(length(a).min(length(b)))
}
