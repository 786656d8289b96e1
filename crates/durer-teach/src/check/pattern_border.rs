//! Checks for surfaces that lie exactly on the border between the cells of a checkerboard.

use super::finding::Finding;
use super::scene_probe::SceneProbe;
use super::verdict::most_common;
use durer_diag::Diagnostic;
use durer_render::world::Material;
use durer_scene::material::{Pattern as _, PatternMaterial};

/// Distance from the surface, in cells, at which the pattern is evaluated on both sides.
const STEP: f64 = 1e-3;
/// Minimum number of visible points needed for a conclusion.
const MIN_POINTS: usize = 20;
/// Minimum number of points that must show each of the two cells.
const MIN_EACH: usize = 3;

/// Visible points of a checkerboard at which the two sides of the surface are in different cells.
#[derive(Default)]
struct BorderPoints {
    /// Number of all visible points of the checkerboard.
    all: usize,
    /// Objects of the points on a border, whose colour is that of the cell on the side of the
    /// normal (`front`) or of the other cell (`back`).
    front: Vec<u32>,
    back: Vec<u32>,
}

/// Reports checkerboards on surfaces at the border of two cells, if rounding errors decide which of
/// the two cells is visible.
pub(super) fn on_border(scene_probe: &SceneProbe) -> Vec<Finding> {
    let numbers = 0..scene_probe.input.scene.materials.len();
    let say = |number: usize| {
        let BorderPoints { all, front, back } = border_points(scene_probe, number)?;
        let on_border = front.len() + back.len();
        // If all points are in the same cell, rounding has no effect.
        if all < MIN_POINTS || on_border * 10 < all * 9 || front.len().min(back.len()) < MIN_EACH {
            return None;
        }
        let object = most_common(&[front, back].concat())?;
        let name = scene_probe.object(object);
        let diagnostic =
            Diagnostic::warning(format!("the {name} lies exactly on the border between the cells of this pattern"))
                .at(scene_probe.input.scene.materials[number].span)
                .related(scene_probe.object_span(object), "on the border of two cells")
                .effect("rounding errors decide which cell a point is in, so both colours appear as speckles")
                .help("move the object, or the pattern with a `Translate` in its `Transform`, by a part of a cell");
        Some(Finding::from(diagnostic))
    };
    numbers.filter_map(say).collect()
}

fn border_points(scene_probe: &SceneProbe, number: usize) -> Option<BorderPoints> {
    let world = scene_probe.world();
    let Material::Mix(PatternMaterial::Checkerboard(cells), to_pattern, _) = world.materials().get(number)? else {
        return None;
    };
    let mut points = BorderPoints::default();
    for (probe, hit) in scene_probe.hits().filter(|(_, hit)| hit.material as usize == number) {
        let Some(at) = world.intersect(&probe.ray, &mut ()) else { continue };
        let place = to_pattern.transform_point3(at.surface.position.as_dvec3());
        let step = STEP * to_pattern.transform_vector3(at.surface.n_geo.as_dvec3()).normalize_or_zero();
        let [here, front, back] = [place, place + step, place - step].map(|q| cells.weight(q.as_vec3()));
        points.all += 1;
        if front != back {
            (if here == front { &mut points.front } else { &mut points.back }).push(hit.object);
        }
    }
    Some(points)
}
