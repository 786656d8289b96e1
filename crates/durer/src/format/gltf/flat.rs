//! Meshes that their nodes scale to 0 along one axis.
//!
//! Source: *glTF 2.0 Specification*, chapter 3.5.3: only what is scaled to 0 along all axes need not
//! be shown.

use super::deform::of_normals;
use crate::math::Vec3;
use crate::shape::MeshData;
use glam::{DAffine3, DVec3};

/// Of the square of its longest side, what a triangle at least has of area.
const AREA: f64 = 1e-9;

/// The sheet that a map without an inverse makes of a mesh, in the world; `None` where it makes a
/// line or a point of everything, or leaves the range of numbers. Faces that are seen from the side
/// are gone.
pub(super) fn flattened(data: &MeshData, map: DAffine3) -> Option<MeshData> {
    let columns = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
    let size = columns.into_iter().map(DVec3::length).fold(0.0, f64::max);
    let cofactors = of_normals(map.matrix3);
    let areas = [cofactors.x_axis, cofactors.y_axis, cofactors.z_axis];
    let area = areas.into_iter().map(DVec3::length).fold(0.0, f64::max);
    if !area.is_finite() || area <= 1e-12 * size * size {
        return None;
    }
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
    // All of it lies as its faces do.
    (flat.normals, flat.triangle_normals, flat.flat) = (Vec::new(), Vec::new(), true);
    let has_area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|i| flat.positions[i as usize].as_dvec3());
        let sides = [b - a, c - b, a - c].map(DVec3::length_squared);
        (b - a).cross(c - a).length() > AREA * sides.into_iter().fold(0.0, f64::max)
    };
    let kept: Vec<bool> = flat.triangles.iter().map(has_area).collect();
    for list in [&mut flat.triangles, &mut flat.triangle_uvs] {
        let mut kept = kept.iter();
        list.retain(|_| *kept.next().unwrap_or(&true));
    }
    Some(flat)
}
