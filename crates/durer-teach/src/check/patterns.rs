//! Checks for patterns that are not visible because only one part shows or because their cells are
//! smaller than a pixel.

use super::finding::{Finding, MAX_FINDINGS, number, percent};
use super::probes::Probe;
use super::scene_probe::SceneProbe;
use super::shapes::is_black;
use durer_diag::Diagnostic;
use durer_render::world::{Material, World};
use durer_scene::material::{ColorNoise, PatternMaterial};
use durer_scene::math::Vec3;
use durer_scene::scene::Material as ParsedMaterial;
use durer_scene::texture::Texture;

/// Number of steps per pixel at which a pattern is evaluated.
const STEPS: u32 = 24;
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
        let points: Vec<&Probe> =
            scene_probe.hits().filter(|(_, hit)| hit.material as usize == number).map(|(probe, _)| probe).collect();
        if points.len() < MIN_POINTS {
            continue;
        }
        let shares = points.iter().filter_map(|probe| Some(look.at(probe.ray.at(probe.hit.as_ref()?.t))));
        let (least, most) = shares.fold((f32::MAX, f32::MIN), |(a, b), s| (a.min(s), b.max(s)));
        let width = pixel(scene_probe);
        let varies = |probe: &&&Probe| {
            let ways = footprint(scene_probe, probe, width);
            ways.is_some_and(|(point, ways)| ways.into_iter().any(|way| changes(&look, point, way)))
        };
        let fine = points.iter().filter(varies).count();
        let share_texture = match &world.materials()[number] {
            Material::Mix(_, _, Some(map)) => world.textures().get(*map as usize),
            _ => None,
        };
        let uniform = why_uniform(scene_probe, &look, &material.value, share_texture);
        let (message, effect, help) = if let Some((message, help)) = uniform {
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

/// Returns the point that a probe hits, and the two sides of its pixel, projected onto the surface
/// there.
fn footprint(scene_probe: &SceneProbe, probe: &Probe, width: PixelWidth) -> Option<(Vec3, [Vec3; 2])> {
    let (at, hit) = (scene_probe.world().intersect(&probe.ray, &mut ())?, probe.hit.as_ref()?);
    let (n, dir) = (at.surface.n_geo, probe.ray.dir.normalize_or_zero());
    let side = width.constant + hit.t * probe.ray.dir.length() * width.per_distance;
    let tilt = n - n.dot(dir) * dir;
    let upwards = tilt.try_normalize().unwrap_or_else(|| dir.any_orthonormal_vector());
    let onto_surface = |way: Vec3| side * (way - dir * (way.dot(n) / dir.dot(n)));
    Some((at.surface.position, [upwards, upwards.cross(dir)].map(onto_surface)))
}

/// Returns true if a pattern changes between its two parts along a line on a surface.
fn changes(look: &PatternSampler, from: Vec3, way: Vec3) -> bool {
    let first = look.at(from) > 0.5;
    (1..=STEPS).any(|i| (look.at(from + way * (i as f32 / STEPS as f32)) > 0.5) != first)
}

/// Uses the scene description to explain why a pattern does not vary, if possible.
fn why_uniform(
    scene_probe: &SceneProbe,
    look: &PatternSampler,
    material: &ParsedMaterial,
    share_texture: Option<&Texture>,
) -> Option<(String, &'static str)> {
    let PatternSampler::Solid(solid, to_pattern, _) = look else { return None };
    if let (PatternMaterial::Mix(_), Some(texture)) = (solid, share_texture)
        && is_black(texture)
    {
        let message = "the `shareTexture` of this mix is black everywhere: only its second material is visible";
        return Some((message.into(), "use a picture that is white where the first material should be visible"));
    }
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

/// Width of a pixel: a constant part, for cameras with parallel rays, and a part per unit of
/// distance.
#[derive(Clone, Copy)]
struct PixelWidth {
    constant: f32,
    per_distance: f32,
}

/// Estimates the width of a pixel.
fn pixel(scene_probe: &SceneProbe) -> PixelWidth {
    let [a, b] = [0, scene_probe.probes.len() - 1].map(|i| &scene_probe.probes[i]);
    let (p, q) = (a.pixel, b.pixel);
    let apart = ((p.0.abs_diff(q.0).pow(2) + p.1.abs_diff(q.1).pow(2)) as f32).sqrt().max(1.0);
    let turn = (a.ray.dir.normalize_or_zero() - b.ray.dir.normalize_or_zero()).length();
    PixelWidth { constant: (a.ray.origin - b.ray.origin).length() / apart, per_distance: turn / apart }
}
