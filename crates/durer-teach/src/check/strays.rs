//! Checks for vertices of a mesh that are far away from all others.

use super::finding::{Finding, MAX_PER_KIND, counted, vector};
use super::mesh_files::MeshFile;
use super::scene_probe::SceneProbe;
use durer_diag::Diagnostic;
use durer_scene::math::{Aabb, Vec3};

/// Ratio of the distance of stray vertices to the size of the rest of their mesh.
const STRAY_DISTANCE: f32 = 50.0;
/// Minimum number of the other vertices per stray vertex.
const STRAY_SHARE: usize = 2;

/// Reports meshes that have a few vertices far away from all others.
pub(super) fn stray_points(scene_probe: &SceneProbe) -> Vec<Finding> {
    let all = scene_probe.meshes().iter().chain(scene_probe.models());
    let say = |mesh: &MeshFile| {
        let (strays, box_of_rest, far) = strays(&mesh.data.positions)?;
        let count = counted(strays, "vertex", "vertices");
        let is = if strays == 1 { "is" } else { "are" };
        let path = &mesh.name.path;
        let message = format!("{count} of `{path}` {is} far from the others, for example at {}", vector(far));
        let diagnostic = Diagnostic::warning(message);
        let diagnostic = match mesh.vertex(scene_probe, far) {
            Some(line) => diagnostic.at(line).related(mesh.name.span, "the mesh is used here"),
            None => diagnostic.at(mesh.name.span),
        };
        let diagnostic = diagnostic
            .effect(format!(
                "the other {} vertices fill a box of only {}: in a picture of everything, they are a dot",
                mesh.data.positions.len() - strays,
                vector(box_of_rest.size())
            ))
            .help("check the coordinates of these vertices in the file, such as a missing decimal point or minus sign");
        Some(Finding::from(diagnostic))
    };
    all.filter_map(say).take(MAX_PER_KIND).collect()
}

/// Returns the number of vertices that are far from most, the bounding box of the others, and one
/// of the vertices.
fn strays(positions: &[Vec3]) -> Option<(usize, Aabb, Vec3)> {
    for axis in 0..3 {
        let mut values: Vec<f32> = positions.iter().map(|position| position[axis]).collect();
        values.sort_by(f32::total_cmp);
        let Some(gap) = (1..values.len()).max_by(|&a, &b| {
            let gap = |i: usize| values[i] - values[i - 1];
            gap(a).total_cmp(&gap(b))
        }) else {
            continue;
        };
        let (below, width) = (gap, values[gap] - values[gap - 1]);
        let is_above = below * 2 > values.len();
        let strays = if is_above { values.len() - below } else { below };
        if strays * STRAY_SHARE >= values.len() {
            continue;
        }
        let is_stray = |position: &Vec3| (position[axis] >= values[gap]) == is_above;
        let rest = positions.iter().filter(|position| !is_stray(position));
        let rest = rest.fold(Aabb::EMPTY, |all, position| all.union_point(*position));
        if width > STRAY_DISTANCE * rest.size().length() && rest.size() != Vec3::ZERO {
            return Some((strays, rest, *positions.iter().find(|position| is_stray(position))?));
        }
    }
    None
}
