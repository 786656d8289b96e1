//! Builds triangle meshes for shapes of Mitsuba that Dürer represents as meshes.

use durer_scene::math::{Vec2, Vec3, fp};
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use durer_scene::shape::tessellate::revolution;

/// Corners and normal of each face of a cube. The texture coordinates of the corners are those of
/// [`AROUND`], in the same order.
const FACES: [([[f32; 3]; 4], [f32; 3]); 6] = [
    ([[1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, -1.0, -1.0]], [0.0, -1.0, 0.0]),
    ([[1.0, 1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, 1.0, 1.0], [1.0, 1.0, 1.0]], [0.0, 1.0, 0.0]),
    ([[1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0]], [1.0, 0.0, 0.0]),
    ([[1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, 1.0]], [0.0, 0.0, 1.0]),
    ([[-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, -1.0]], [-1.0, 0.0, 0.0]),
    ([[1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, -1.0], [-1.0, 1.0, -1.0]], [0.0, 0.0, -1.0]),
];
/// Number of sides of a tessellated disc.
const SIDES: u32 = 128;
const AROUND: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];

/// Returns the cube that extends from -1 to 1. As in Mitsuba, v = 0 is the upper edge of a picture.
pub(super) fn cube() -> MeshData {
    let mut data = MeshData { flat: true, ..MeshData::default() };
    for (corners, normal) in FACES {
        let p = data.positions.len() as u32;
        data.positions.extend(corners.map(Vec3::from_array));
        data.normals.extend([Vec3::from_array(normal); 4]);
        data.uvs.extend(AROUND.map(Vec2::from_array));
        data.triangles.extend([[p, p + 1, p + 2], [p, p + 2, p + 3]]);
    }
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    data
}

/// Returns the square from -1 to 1 that faces +z. As in Mitsuba, v = 0 is the upper edge of a
/// picture.
pub(super) fn rectangle() -> MeshData {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vec2::from_array);
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    MeshData {
        positions: corners.map(|p| p.extend(0.0)).to_vec(),
        uvs: corners.map(|p| 0.5 * (p + 1.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        triangle_uvs: triangles.clone(),
        triangle_normals: triangles.clone(),
        triangles,
        flat: true,
        ..MeshData::default()
    }
}

/// Returns a triangulated disc of radius 1 that faces +z. The coordinate u increases from the
/// centre outwards, and v increases with the angle from +x.
pub(super) fn disk() -> MeshData {
    let rim = |i: f32| {
        let (sin, cos) = fp::sin_cos_degrees(f64::from(360.0 * i / SIDES as f32));
        Vec3::new(cos as f32, sin as f32, 0.0)
    };
    let mut data = MeshData { flat: true, ..MeshData::default() };
    for i in 0..=SIDES {
        let around = |i: f32| i / SIDES as f32;
        data.positions.push(rim(i as f32));
        data.uvs.push(Vec2::new(1.0, around(i as f32)));
        if i < SIDES {
            // Each triangle has its own vertex at the centre of the disc. The v of this vertex is
            // the mean of those of the two outer corners.
            data.positions.push(Vec3::ZERO);
            data.uvs.push(Vec2::new(0.0, around(i as f32 + 0.5)));
            data.triangles.push([2 * i + 1, 2 * i, 2 * i + 2]);
        }
    }
    data.normals = vec![Vec3::Z; data.positions.len()];
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    data
}

/// Returns a sphere of triangles around the origin, with its poles on the z axis. As in Mitsuba, v
/// is 0 at the pole on the side of +z.
pub(super) fn sphere(radius: f32) -> MeshData {
    with_flipped_v(revolution::sphere(f64::from(radius), [-radius, radius], 360.0))
}

/// Returns an open cylinder of length 1 around the z axis. As in Mitsuba, v = 0 is the upper edge
/// of a picture.
pub(super) fn cylinder(radius: f32) -> MeshData {
    revolution::cylinder(radius, [0.0, 1.0], 360.0)
}

/// Adds tangents that point in the direction of increasing u. The bitangent is computed from the
/// normal and the tangent, regardless of the direction of v.
pub(super) fn with_tangents(mut data: MeshData) -> MeshData {
    let mut tangents = vec![Vec3::ZERO; data.positions.len()];
    for (corners, uvs) in data.triangles.iter().zip(&data.triangle_uvs).filter(|(_, uvs)| !uvs.contains(&NO_INDEX)) {
        let [p, q, r] = corners.map(|i| data.positions[i as usize]);
        let [a, b, c] = uvs.map(|i| data.uvs[i as usize]);
        let (along, across) = (b - a, c - a);
        let u = ((q - p) * across.y - (r - p) * along.y) / along.perp_dot(across);
        corners.iter().filter(|_| u.is_finite()).for_each(|&i| tangents[i as usize] += u);
    }
    data.tangents = tangents.into_iter().map(|u| u.extend(1.0).to_array()).collect();
    data
}

/// Flips the texture coordinate v of a mesh, so that the upper edge of a picture moves from v = 0
/// to v = 1, or vice versa.
pub(super) fn with_flipped_v(mut data: MeshData) -> MeshData {
    data.uvs.iter_mut().chain(&mut data.second_uvs).for_each(|uv| uv.y = 1.0 - uv.y);
    data
}
