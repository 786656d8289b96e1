//! Checks for coplanar faces that overlap, so that it is random which of them is visible
//! (z-fighting).

use super::scene_probe::SceneProbe;
use super::shapes::shape;
use durer_render::world::Object;
use durer_scene::camera::Projection;
use durer_scene::math::Vec3;
use durer_scene::shape::Shape as _;

/// Maximum number of objects for which this check runs.
const MAX_OBJECTS: usize = 300;

/// A flat face of a box or rectangle in world space, which is compared with others to find coplanar
/// overlaps. `outward_normal` is its normal if only that side can be visible.
struct Face {
    object: usize,
    corners: Vec<Vec3>,
    outward_normal: Option<Vec3>,
}

impl Face {
    fn normal(&self) -> Vec3 {
        (self.corners[1] - self.corners[0]).cross(self.corners[2] - self.corners[0]).normalize_or_zero()
    }
}

fn faces_of(number: usize, object: &Object) -> Vec<Face> {
    let world = |corners: &[Vec3]| corners.iter().map(|p| object.world_point(*p)).collect::<Vec<Vec3>>();
    let Some(shape) = shape(object) else { return Vec::new() };
    let polygons = shape.polygons();
    // Triangles often come in hundreds and share edges. They are compared only with planes, in
    // `objects::in_plane`.
    let mut faces: Vec<Face> = polygons
        .iter()
        .filter(|polygon| polygon.len() > 3)
        .map(|polygon| Face { object: number, corners: world(polygon), outward_normal: None })
        .collect();
    if shape.flip().is_none() {
        let corners = || polygons.iter().flatten();
        let middle = object.world_point(corners().sum::<Vec3>() / corners().count().max(1) as f32);
        for face in &mut faces {
            let n = face.normal();
            face.outward_normal = Some(if n.dot(face.corners[0] - middle) < 0.0 { -n } else { n });
        }
    }
    faces
}

/// Returns true if two faces are coplanar and overlap.
fn overlap(a: &Face, b: &Face) -> bool {
    let (n, m) = (a.normal(), b.normal());
    if n == Vec3::ZERO || m == Vec3::ZERO || n.dot(m).abs() < 1.0 - 1e-6 {
        return false;
    }
    let size = a.corners.iter().chain(&b.corners).map(|p| (*p - a.corners[0]).length()).fold(0.0, f32::max);
    if b.corners.iter().any(|p| (*p - a.corners[0]).dot(n).abs() > 1e-5 * size) {
        return false;
    }
    // Convex faces are disjoint if an edge of either face separates them. Faces that only touch
    // each other count as disjoint.
    let separates = |one: &Face, other: &Face| {
        let count = one.corners.len();
        (0..count).any(|i| {
            let side = one.corners[(i + 1) % count] - one.corners[i];
            let out = side.cross(n).normalize_or_zero();
            let reach = |face: &Face| {
                face.corners.iter().map(|p| out.dot(*p)).fold((f32::MAX, f32::MIN), |(a, b), x| (a.min(x), b.max(x)))
            };
            let ((a0, a1), (b0, b1)) = (reach(one), reach(other));
            a1.min(b1) - a0.max(b0) < 1e-3 * size
        })
    };
    !separates(a, b) && !separates(b, a)
}

/// Returns pairs of objects (boxes or rectangles) whose faces overlap on the side that the camera
/// sees.
pub(super) fn overlapping(scene_probe: &SceneProbe) -> Vec<(usize, usize)> {
    let objects = scene_probe.world().objects();
    if objects.len() > MAX_OBJECTS {
        return Vec::new();
    }
    let eye = scene_probe.world().camera().pose().center;
    let faces: Vec<Face> = objects.iter().enumerate().flat_map(|(i, object)| faces_of(i, object)).collect();
    let faces_eye = |face: &Face| face.outward_normal.is_none_or(|n| n.dot(eye - face.corners[0]) > 0.0);
    let mut overlapping: Vec<(usize, usize)> = Vec::new();
    for (i, a) in faces.iter().enumerate() {
        for b in faces[i + 1..].iter().filter(|b| b.object != a.object) {
            let (first, second) = (a.object, b.object);
            if !overlapping.contains(&(first, second)) && faces_eye(a) && faces_eye(b) && overlap(a, b) {
                // Adjacent boxes touch with opposite normals.
                let opposite = a.outward_normal.zip(b.outward_normal).is_some_and(|(n, m)| n.dot(m) < 0.0);
                if !opposite {
                    overlapping.push((first, second));
                }
            }
        }
    }
    overlapping
}
