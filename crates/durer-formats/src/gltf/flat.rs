//! Handles meshes whose nodes scale them to 0 along one axis.
//!
//! Source: *glTF 2.0 Specification*, chapter 3.5.3: only nodes scaled to 0 along all axes may be
//! omitted.

use super::deform::normal_matrix;
use durer_scene::math::Vec3;
use durer_scene::shape::MeshData;
use glam::{DAffine3, DMat3, DVec3};

/// Minimum area of a triangle as a fraction of the square of its longest side.
const AREA: f64 = 1e-9;

/// Returns true if a singular transform flattens space to a plane, and not to a line or a point.
pub(super) fn flattens_to_plane(map: DAffine3) -> bool {
    let longest = |map: DMat3| [map.x_axis, map.y_axis, map.z_axis].map(DVec3::length).into_iter().fold(0.0, f64::max);
    let (size, area) = (longest(map.matrix3), longest(normal_matrix(map.matrix3)));
    area.is_finite() && area > 1e-12 * size * size
}

/// Returns a mesh that a singular transform has flattened, in world space, or `None` if its numbers
/// overflow. Faces that collapse to lines are removed.
pub(super) fn flattened(data: &MeshData, map: DAffine3) -> Option<MeshData> {
    let mut flat = data.clone();
    for place in &mut flat.positions {
        *place = map.transform_point3(place.as_dvec3()).as_vec3();
        if !place.is_finite() {
            return None;
        }
    }
    for tangent in &mut flat.tangents {
        let [x, y, z, _] = *tangent;
        let along = Vec3::new(x, y, z);
        let turned = map.transform_vector3(along.as_dvec3()).as_vec3().normalize_or(along);
        tangent[..3].copy_from_slice(&turned.to_array());
    }
    // All vertices are in one plane, so the face normals are used.
    (flat.normals, flat.triangle_normals, flat.flat) = (Vec::new(), Vec::new(), true);
    let has_area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|i| data.positions[i as usize].as_dvec3());
        let [ab, bc, ca] = [b - a, c - b, a - c].map(|side| map.transform_vector3(side));
        let longest = [ab, bc, ca].map(DVec3::length_squared).into_iter().fold(0.0, f64::max);
        ab.cross(ca).length() > AREA * longest
    };
    let kept: Vec<bool> = flat.triangles.iter().map(has_area).collect();
    for list in [&mut flat.triangles, &mut flat.triangle_uvs] {
        let mut kept = kept.iter();
        list.retain(|_| *kept.next().unwrap_or(&true));
    }
    Some(flat)
}
