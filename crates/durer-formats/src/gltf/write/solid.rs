//! Shapes as triangles.

use durer_scene::math::{Vec2, Vec3, fp};
use durer_scene::shape::{MeshData, Primitive};

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
        Primitive::Rectangle(flat) => {
            let mut data = MeshData { flat: true, ..MeshData::default() };
            face(&mut data, flat.corner, [flat.edge0, flat.edge1]);
            Some(data)
        }
        Primitive::Cuboid(cuboid) => Some(block(cuboid.min, cuboid.max)),
        Primitive::Disc(disc) => {
            let mut data = MeshData::default();
            let at = |radius| (disc.center, radius);
            band(&mut data, disc.normal, [at(disc.inner_radius), at(disc.radius)]);
            Some(data)
        }
        Primitive::Cylinder(cylinder) => {
            Some(round([(cylinder.base, cylinder.radius), (cylinder.top, cylinder.radius)]))
        }
        Primitive::Cone(cone) => Some(round([(cone.base, cone.base_radius), (cone.top, cone.top_radius)])),
        _ => None,
    }
}

/// A parallelogram that its edges go around counter-clockwise.
fn face(data: &mut MeshData, corner: Vec3, [e, f]: [Vec3; 2]) {
    let p = data.positions.len() as u32;
    data.positions.extend([corner, corner + e, corner + e + f, corner + f]);
    data.triangles.extend([[p, p + 1, p + 2], [p, p + 2, p + 3]]);
}

/// A box along the axes.
fn block(min: Vec3, max: Vec3) -> MeshData {
    let mut data = MeshData { flat: true, ..MeshData::default() };
    let size = max - min;
    let [x, y, z] = [size.x * Vec3::X, size.y * Vec3::Y, size.z * Vec3::Z];
    for [e, f] in [[y, x], [x, z], [z, y]] {
        face(&mut data, min, [e, f]);
        face(&mut data, max, [-f, -e]);
    }
    data
}

/// What is round about the line between the middles of two circles, with caps.
fn round([base, top]: [(Vec3, f32); 2]) -> MeshData {
    let mut data = MeshData::default();
    let axis = (top.0 - base.0).normalize_or(Vec3::Y);
    band(&mut data, -axis, [(base.0, 0.0), base]);
    band(&mut data, axis, [base, top]);
    band(&mut data, axis, [(top.0, 0.0), top]);
    data
}

/// The surface between two circles about an axis: flat where their middles are the same, and then
/// it faces along the axis; else it faces outwards.
fn band(data: &mut MeshData, axis: Vec3, circles: [(Vec3, f32); 2]) {
    let axis = axis.normalize_or(Vec3::Y);
    let (x, y) = axis.any_orthonormal_pair();
    let [(from, inner), (to, outer)] = circles;
    let along = (to - from).dot(axis);
    let first = data.positions.len() as u32;
    for i in 0..=STEPS {
        let (sin, cos) = fp::sin_cos_degrees(360.0 * f64::from(i) / f64::from(STEPS));
        let outwards = cos as f32 * x + sin as f32 * y;
        // Across the way from one circle to the other.
        let normal = match along == 0.0 {
            true => axis,
            false => (along * outwards + (inner - outer) * axis).normalize_or(outwards),
        };
        for (center, radius) in circles {
            data.positions.push(center + radius * outwards);
            data.normals.push(normal);
        }
    }
    for p in (0..STEPS).map(|i| first + 2 * i) {
        for triangle in [[p, p + 2, p + 3], [p, p + 3, p + 1]] {
            let [a, b, c] = triangle.map(|i| data.positions[i as usize]);
            let face = (b - a).cross(c - a);
            if face == Vec3::ZERO {
                continue;
            }
            let turned = face.dot(data.normals[p as usize]) < 0.0;
            let [a, b, c] = triangle;
            data.triangles.push(if turned { [a, c, b] } else { [a, b, c] });
        }
    }
    data.triangle_normals = data.triangles.clone();
}

/// A ball with the normals of a round one, and its coordinates: u is 1/2 where it looks along -z, v
/// grows upwards.
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

    use durer_scene::shape::{Cone, Cuboid, Cylinder, Disc, Sphere};
    use std::f32::consts::PI;

    /// The volume inside of triangles that face outwards.
    fn volume(shape: impl Into<Primitive>) -> f32 {
        let data = mesh(&shape.into()).unwrap();
        data.triangles
            .iter()
            .map(|t| t.map(|i| data.positions[i as usize]))
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum()
    }

    #[test]
    fn shapes_are_closed_and_face_outwards() {
        let center = Vec3::new(1.0, 2.0, 3.0);
        let top = center + Vec3::new(0.0, 3.0, 4.0);
        let cylinder = Cylinder { base: center, top, radius: 2.0 };
        let cone = Cone { base: center, top, base_radius: 2.0, top_radius: 1.0 };
        for (found, expected) in [
            (volume(Sphere { center, radius: 2.0 }), 4.0 / 3.0 * PI * 8.0),
            (volume(Cuboid { min: center, max: center + Vec3::new(1.0, 2.0, 3.0) }), 6.0),
            (volume(cylinder), PI * 4.0 * 5.0),
            (volume(cone), PI / 3.0 * 5.0 * (4.0 + 2.0 + 1.0)),
        ] {
            // But for the flatness of 96 steps.
            assert!((found / expected - 1.0).abs() < 3e-3, "{found} {expected}");
        }
        let disc = Disc { center, normal: Vec3::NEG_Z, radius: 2.0, inner_radius: 1.0 };
        let data = mesh(&disc.into()).unwrap();
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| data.positions[i as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        assert!((data.triangles.iter().map(area).sum::<f32>() / (-3.0 * PI) - 1.0).abs() < 3e-3);
    }

    #[test]
    fn a_balls_coordinates_are_ours() {
        let data = ball(Vec3::ZERO, 2.0);
        let seen = data.uvs.iter().zip(&data.normals).find(|(_, n)| n.z < -0.99).unwrap();
        assert!((seen.0.x - 0.5).abs() < 0.05);
    }
}
