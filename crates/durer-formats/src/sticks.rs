//! Visible geometry for lines and points, which have no surface: thin sticks and small balls take
//! their place.

use super::report::count_text;
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::ObjectKind;
use durer_scene::shape::{Cone, Cylinder, MeshData, Sphere};

/// Returns a cylinder or cone between two points, with a given radius at each end, or `None` if the
/// points coincide.
pub(super) fn stick(from: Vec3, to: Vec3, [first, last]: [f32; 2]) -> Option<ObjectKind> {
    let shape = match first == last {
        true => Cylinder { base: from, top: to, radius: first }.into(),
        false => Cone { base: from, top: to, base_radius: first, top_radius: last }.into(),
    };
    (from != to).then_some(ObjectKind::Primitive(shape))
}

/// Returns a sphere with its centre at a point.
pub(super) fn ball(center: Vec3, radius: f32) -> ObjectKind {
    ObjectKind::Primitive(Sphere { center, radius }.into())
}

/// Number of sides of a stick that is tessellated.
const SIDES: u32 = 6;
/// Radius of points, and of lines for which no radius is given, as fractions of the diagonal of the
/// bounding box.
const LINE_RADIUS: f32 = 0.006;
const POINT_RADIUS: f32 = 0.015;
/// Maximum number of lines, and of points, that are turned into geometry. If there are more, only
/// every n-th one is shown.
const MAX: usize = 1 << 21;

/// Returns the smallest n for which at most [`MAX`] of `count` items remain if only every n-th item
/// is shown.
fn step(count: usize) -> usize {
    count.div_ceil(MAX).max(1)
}

/// Message saying that lines and points are shown as sticks and balls.
pub(super) fn message(lines: usize, points: usize) -> String {
    let all =
        [(lines, "line", "lines"), (points, "point", "points")].map(|(count, one, many)| match (count, step(count)) {
            (0, _) => String::new(),
            (_, 1) => count_text(count, one, many),
            (_, step) => format!("one in {step} of {count} {many}"),
        });
    let all = all.into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join(" and ");
    format!("lines and points have no surface: thin sticks and small balls are shown for {all}")
}

/// Builds a triangle mesh with thin sticks for the lines between vertices, and small balls for
/// single vertices. The vertices keep their colours and texture coordinates.
pub(super) fn sticks_and_balls(data: &MeshData, lines: &[[u32; 2]], points: &[u32]) -> MeshData {
    let used = || lines.iter().flatten().chain(points).map(|&i| data.positions[i as usize]);
    let low = used().reduce(Vec3::min).unwrap_or_default();
    let size = (used().reduce(Vec3::max).unwrap_or_default() - low).length();
    let size = if size > 0.0 && size.is_finite() { size } else { 1.0 };
    // Limit the radius so that neighbouring balls of a dense point cloud on a surface just touch.
    let shown_points = points.len().div_ceil(step(points.len()));
    let ball = POINT_RADIUS.min(0.6 / (shown_points as f32).sqrt());
    let mut mesh = MeshData::default();
    for &[a, b] in lines.iter().step_by(step(lines.len())) {
        let ends = [a, b].map(|i| data.positions[i as usize]);
        let Some(along) = (ends[1] - ends[0]).try_normalize() else { continue };
        let (x, y) = along.any_orthonormal_pair();
        let first = mesh.positions.len() as u32;
        for (vertex, end) in [a, b].into_iter().zip(ends) {
            for k in 0..SIDES {
                let (sin, cos) = fp::sin_cos_degrees(360.0 * f64::from(k) / f64::from(SIDES));
                let normal = cos as f32 * x + sin as f32 * y;
                push_vertex(&mut mesh, data, vertex, end + LINE_RADIUS * size * normal, normal);
            }
        }
        for k in 0..SIDES {
            let (this, next) = (first + k, first + (k + 1) % SIDES);
            mesh.triangles.extend([[this, next, next + SIDES], [this, next + SIDES, this + SIDES]]);
        }
    }
    for &vertex in points.iter().step_by(step(points.len())) {
        // The ball is an octahedron with the normals of a sphere.
        let first = mesh.positions.len() as u32;
        for normal in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
            push_vertex(&mut mesh, data, vertex, data.positions[vertex as usize] + ball * size * normal, normal);
        }
        for (x, y, z) in [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)] {
            mesh.triangles.push([x, y, z].map(|k| first + k));
        }
    }
    mesh.triangle_normals = mesh.triangles.clone();
    if !mesh.uvs.is_empty() {
        mesh.triangle_uvs = mesh.triangles.clone();
    }
    mesh
}

/// Appends a vertex to `mesh`, with the colour and texture coordinates of the vertex `vertex` of
/// `other`.
fn push_vertex(mesh: &mut MeshData, other: &MeshData, vertex: u32, position: Vec3, normal: Vec3) {
    mesh.positions.push(position);
    mesh.normals.push(normal);
    mesh.colors.extend(other.colors.get(vertex as usize));
    mesh.uvs.extend(other.uvs.get(vertex as usize));
    mesh.second_uvs.extend(other.second_uvs.get(vertex as usize));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sticks_and_balls_face_outwards_and_keep_colours() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let colors = vec![[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]];
        let data = MeshData { positions, colors, ..MeshData::default() };
        let mesh = sticks_and_balls(&data, &[[0, 1]], &[2]);
        assert_eq!((mesh.triangles.len(), mesh.colors.len()), (2 * SIDES as usize + 8, mesh.positions.len()));
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
            let outwards: Vec3 = triangle.iter().map(|&i| mesh.normals[i as usize]).sum();
            assert!((b - a).cross(c - a).dot(outwards) > 0.0, "{triangle:?}");
        }
        assert_eq!(mesh.colors[mesh.positions.len() - 1], data.colors[2]);
        assert!(sticks_and_balls(&data, &[[1, 1]], &[]).triangles.is_empty());
    }
}
