//! Shapes as triangles.

use crate::math::{Vec2, Vec3, fp};
use crate::shape::{MeshData, Primitive};

/// Steps around a ball, half as many from pole to pole.
const STEPS: u32 = 96;

/// The triangles of a shape; `None` for those that are not written.
pub(super) fn mesh(primitive: &Primitive) -> Option<MeshData> {
    match primitive {
        Primitive::Sphere(sphere) => Some(ball(sphere.center, sphere.radius)),
        Primitive::Triangle(triangle) => {
            let corners = [triangle.vertex0, triangle.vertex1, triangle.vertex2];
            Some(MeshData {
                positions: corners.to_vec(),
                triangles: vec![[0, 1, 2]],
                flat: true,
                ..MeshData::default()
            })
        }
        _ => None,
    }
}

/// A ball with the normals of a round one, and its coordinates: u is 1/2 where it looks along -z, v grows upwards.
fn ball(center: Vec3, radius: f32) -> MeshData {
    let mut data = MeshData::default();
    let rows = STEPS / 2;
    for j in 0..=rows {
        let (sin_v, cos_v) = fp::sin_cos_degrees(180.0 * f64::from(j) / f64::from(rows));
        for i in 0..=STEPS {
            let (u, v) = (i as f32 / STEPS as f32, j as f32 / rows as f32);
            let (sin_u, cos_u) = fp::sin_cos_degrees(360.0 * f64::from(u) - 180.0);
            let normal = Vec3::new((sin_v * sin_u) as f32, -cos_v as f32, (-sin_v * cos_u) as f32);
            data.positions.push(center + radius * normal);
            data.normals.push(normal);
            data.uvs.push(Vec2::new(u, v));
        }
    }
    let at = |j: u32, i: u32| j * (STEPS + 1) + i;
    for (j, i) in (0..rows).flat_map(|j| (0..STEPS).map(move |i| (j, i))) {
        let [a, b, c, d] = [at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)];
        // At the poles one of the two has no area.
        if j > 0 {
            data.triangles.push([a, c, b]);
        }
        if j + 1 < rows {
            data.triangles.push([a, d, c]);
        }
    }
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    data
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_closed_and_faces_outwards() {
        let data = ball(Vec3::new(1.0, 2.0, 3.0), 2.0);
        for [a, b, c] in data.triangles.iter().map(|t| t.map(|i| data.positions[i as usize])) {
            let outwards = (a + b + c) / 3.0 - Vec3::new(1.0, 2.0, 3.0);
            assert!((b - a).cross(c - a).dot(outwards) > 0.0);
        }
        // The volume of the ball, but for the flatness of 96 steps.
        let volume: f32 = data
            .triangles
            .iter()
            .map(|t| t.map(|i| data.positions[i as usize] - Vec3::new(1.0, 2.0, 3.0)))
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        assert!((volume / (4.0 / 3.0 * std::f32::consts::PI * 8.0) - 1.0).abs() < 3e-3, "{volume}");
        let seen = data.uvs.iter().zip(&data.normals).find(|(_, n)| n.z < -0.99).unwrap();
        assert!((seen.0.x - 0.5).abs() < 0.05);
    }
}
