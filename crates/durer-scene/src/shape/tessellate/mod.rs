//! Creates triangle meshes of shapes. The functions in this file approximate primitives, for
//! [`Shape::to_mesh`](super::Shape::to_mesh). The submodules tessellate surfaces that are not
//! primitives.

pub mod catmull_clark;
pub mod net;
pub mod revolution;
pub mod subdivision;
pub mod tube;

use super::MeshData;
use crate::math::{Vec2, Vec3, fp};

/// Number of segments around a sphere, which has half as many from pole to pole.
const STEPS: u32 = 96;

/// Creates a single flat triangle.
pub(super) fn triangle(corners: [Vec3; 3]) -> MeshData {
    MeshData { positions: corners.to_vec(), triangles: vec![[0, 1, 2]], flat: true, ..MeshData::default() }
}

/// Creates a flat parallelogram.
pub(super) fn parallelogram(corner: Vec3, edges: [Vec3; 2]) -> MeshData {
    let mut data = MeshData { flat: true, ..MeshData::default() };
    push_parallelogram(&mut data, corner, edges);
    data
}

/// Creates a flat ring around `axis`, which is a disc if `inner` is 0.
pub(super) fn ring(center: Vec3, axis: Vec3, [inner, outer]: [f32; 2]) -> MeshData {
    let mut data = MeshData::default();
    push_band(&mut data, axis, [(center, inner), (center, outer)]);
    data
}

/// Adds a parallelogram, with its edges in counter-clockwise order.
pub(super) fn push_parallelogram(data: &mut MeshData, corner: Vec3, [e, f]: [Vec3; 2]) {
    let p = data.positions.len() as u32;
    data.positions.extend([corner, corner + e, corner + e + f, corner + f]);
    data.triangles.extend([[p, p + 1, p + 2], [p, p + 2, p + 3]]);
}

/// Creates an axis-aligned box.
pub(super) fn cuboid(min: Vec3, max: Vec3) -> MeshData {
    let mut data = MeshData { flat: true, ..MeshData::default() };
    let size = max - min;
    let [x, y, z] = [size.x * Vec3::X, size.y * Vec3::Y, size.z * Vec3::Z];
    for [e, f] in [[y, x], [x, z], [z, y]] {
        push_parallelogram(&mut data, min, [e, f]);
        push_parallelogram(&mut data, max, [-f, -e]);
    }
    data
}

/// Creates a solid of revolution between two circles, including its caps.
pub(super) fn frustum([base, top]: [(Vec3, f32); 2]) -> MeshData {
    let mut data = MeshData::default();
    let axis = (top.0 - base.0).normalize_or(Vec3::Y);
    push_band(&mut data, -axis, [(base.0, 0.0), base]);
    push_band(&mut data, axis, [base, top]);
    push_band(&mut data, axis, [(top.0, 0.0), top]);
    data
}

/// Adds the surface between two circles around an axis. If the circles have the same centre, the
/// surface is flat and faces along the axis. Otherwise, the surface faces outwards.
pub(super) fn push_band(data: &mut MeshData, axis: Vec3, circles: [(Vec3, f32); 2]) {
    let axis = axis.normalize_or(Vec3::Y);
    let (x, y) = axis.any_orthonormal_pair();
    let [(from, inner), (to, outer)] = circles;
    let along = (to - from).dot(axis);
    let first = data.positions.len() as u32;
    for i in 0..=STEPS {
        let (sin, cos) = fp::sin_cos_degrees(360.0 * f64::from(i) / f64::from(STEPS));
        let outwards = cos as f32 * x + sin as f32 * y;
        // This vector is perpendicular to the line from one circle to the other.
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

/// Creates a sphere with exact normals and texture coordinates. u is 1/2 towards -z, and v
/// increases upwards.
pub(super) fn ball(center: Vec3, radius: f32) -> MeshData {
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
        // At the poles, one of the two triangles is degenerate.
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

/// Creates an ellipsoid whose axes are parallel to the coordinate axes.
pub(super) fn ellipsoid(center: Vec3, radii: Vec3) -> MeshData {
    let mut data = ball(Vec3::ZERO, 1.0);
    data.positions.iter_mut().for_each(|p| *p = center + radii * *p);
    data.normals.iter_mut().for_each(|n| *n = (*n / radii).normalize_or(*n));
    data
}

/// Creates a torus around `axis`, which is a circle of radius `minor` swept along a circle of
/// radius `major`.
pub(super) fn torus(center: Vec3, axis: Vec3, [major, minor]: [f32; 2]) -> MeshData {
    let mut data = MeshData::default();
    let axis = axis.normalize_or(Vec3::Y);
    let (x, y) = axis.any_orthonormal_pair();
    let around = |i: u32, steps: u32| {
        let (sin, cos) = fp::sin_cos_degrees(360.0 * f64::from(i) / f64::from(steps));
        [sin as f32, cos as f32]
    };
    let rows = STEPS / 2;
    for i in 0..=STEPS {
        let [sin, cos] = around(i, STEPS);
        let outwards = cos * x + sin * y;
        for j in 0..=rows {
            let [sin, cos] = around(j, rows);
            let normal = cos * outwards + sin * axis;
            data.positions.push(center + major * outwards + minor * normal);
            data.normals.push(normal);
        }
    }
    for (i, j) in (0..STEPS).flat_map(|i| (0..rows).map(move |j| (i, j))) {
        let [a, b] = [i, i + 1].map(|i| i * (rows + 1) + j);
        data.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
    }
    data.triangle_normals = data.triangles.clone();
    data
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Cone, Cuboid, Cylinder, Disc, Ellipsoid, Primitive, Shape, Sphere, Torus};
    use std::f32::consts::PI;

    /// Returns the volume enclosed by triangles that face outwards.
    fn volume(shape: impl Into<Primitive>) -> f32 {
        let data = shape.into().to_mesh().unwrap();
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
            (volume(Ellipsoid { center, radii: Vec3::new(1.0, 2.0, 3.0) }), 4.0 / 3.0 * PI * 6.0),
            (volume(Torus { center, axis: top, major_radius: 3.0, minor_radius: 1.0 }), 2.0 * PI * PI * 3.0),
        ] {
            // The tolerance is the error of a mesh with 96 segments around the axis, or 48 around
            // the tube of the torus.
            assert!((found / expected - 1.0).abs() < 5e-3, "{found} {expected}");
        }
        let disc = Disc { center, normal: Vec3::NEG_Z, radius: 2.0, inner_radius: 1.0 };
        let data = disc.to_mesh().unwrap();
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| data.positions[i as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        assert!((data.triangles.iter().map(area).sum::<f32>() / (-3.0 * PI) - 1.0).abs() < 3e-3);
    }

    #[test]
    fn ball_has_the_texture_coordinates_of_a_sphere() {
        let data = ball(Vec3::ZERO, 2.0);
        let vertex = data.uvs.iter().zip(&data.normals).find(|(_, n)| n.z < -0.99).unwrap();
        assert!((vertex.0.x - 0.5).abs() < 0.05);
    }

    #[test]
    fn tessellated_surfaces_match_closed_forms() {
        // The points of a sphere between two heights lie on the sphere, and the area is 2 pi r h.
        let area = |data: &MeshData| -> f32 {
            let corners = data.triangles.iter().map(|t| t.map(|i| data.positions[i as usize]));
            corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
        };
        let zone = revolution::sphere(2.0, [-1.0, 0.5], 90.0);
        assert!(zone.positions.iter().all(|p| (p.length() - 2.0).abs() < 1e-5));
        assert!((area(&zone) / (0.25 * 2.0 * PI * 2.0 * 1.5) - 1.0).abs() < 2e-3, "{}", area(&zone));
        // The radius of a paraboloid grows with the square root of the height.
        let bowl = revolution::paraboloid(1.0, [0.0, 4.0], 360.0);
        assert!(bowl.positions.iter().all(|p| (p.truncate().length_squared() - 0.25 * p.z).abs() < 1e-5));
        // A tube around a straight segment has the lateral area of a cylinder, which lies between
        // the areas of the inscribed and the circumscribed prism.
        let line = tube::straight([[0.0, 0.0, 0.0, 0.5], [0.0, 0.0, 3.0, 0.5]].map(Into::into));
        let mut data = MeshData::default();
        tube::add_tube(&mut data, &tube::sample_curve(&[line], 1), false);
        assert!((area(&data) / (PI * 0.5 * 3.0) - 1.0).abs() < 0.02, "{}", area(&data));
        // A flat bilinear patch becomes two triangles.
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y];
        let flat = net::Patches { positions: corners.to_vec(), faces: vec![[0, 1, 2, 3]], ..Default::default() };
        assert_eq!(net::bilinear(&flat).triangles.len(), 2);
        // A NURBS surface for a quarter of a cylinder is round if it has the weights of a circle.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let row = |z: f64| [[1.0, 0.0, z, 1.0], [half, half, half * z, half], [0.0, 1.0, z, 1.0]];
        let points: Vec<glam::DVec4> = row(0.0).into_iter().chain(row(1.0)).map(Into::into).collect();
        let side = |knots, order| net::NurbsSide { knots, order, from: 0.0, to: 1.0 };
        let sides = [side(&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0][..], 3), side(&[0.0, 0.0, 1.0, 1.0][..], 2)];
        let round = net::nurbs(&points, 3, &sides);
        assert!(round.positions.iter().all(|p| (p.truncate().length() - 1.0).abs() < 1e-6));
    }

    #[test]
    fn subdivided_octahedron_becomes_round() {
        let positions = vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
        let triangles = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        let control = MeshData { positions, triangles, ..MeshData::default() };
        let (data, levels) = subdivision::loop_surface(&control, 3, usize::MAX);
        assert_eq!((levels, data.triangles.len()), (3, 8 * 64));
        let normals = data.positions.iter().zip(&data.normals);
        assert!(normals.clone().all(|(p, n)| p.normalize().dot(*n) > 0.9));
        assert_eq!(subdivision::loop_surface(&control, 3, 8 * 16).1, 2);
    }
}
