//! Line drawings of a scene for the 3D view of the web page.

use crate::document::NamedScene;
use crate::protocol::{LightMarker, Outline};
use durer::math::Vec3;
use durer::render::explain::SceneNames;
use durer::report::{LightMark, light_marks, object_outlines};

/// Maximum number of lights that are drawn.
const MAX_LIGHTS: usize = 32;

/// Returns the polylines that show the objects.
pub(crate) fn outlines(names: &SceneNames) -> Vec<Outline> {
    let flat = |line: &Vec<Vec3>| line.iter().flat_map(Vec3::to_array).collect();
    let one =
        |(i, lines): (usize, Vec<Vec<Vec3>>)| Outline { object: i as u32, lines: lines.iter().map(flat).collect() };
    object_outlines(names.world).enumerate().map(one).collect()
}

/// Returns markers for the lights with their names.
pub(crate) fn light_markers(scene: NamedScene) -> Vec<LightMarker> {
    let marks = light_marks(scene.world()).take(MAX_LIGHTS).enumerate();
    marks
        .map(|(i, LightMark { at, is_far })| LightMarker { at: at.into(), far: is_far, name: scene.light(i) })
        .collect()
}
