//! Creates triangle meshes, with smooth normals, of surfaces of revolution about the z axis. An
//! angle in degrees selects a sector of the surface.
//!
//! u increases with the angle, and v increases along the profile. The outside is the side of du x
//! dv, oriented as in *Physically Based Rendering*, 3rd edition, chapter 3.

use crate::math::{Vec2, Vec3, fp};
use crate::shape::MeshData;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Number of segments in a full turn, and along a curved profile.
const SIDES: f64 = 128.0;
const ROWS: u32 = 64;

/// Number of sides of a cylinder or of a sector of it.
const COLUMNS: u32 = 128;

/// Point on the profile of a surface of revolution, and the tangent of the profile there.
type ProfilePoint = (DVec3, DVec3);

/// Tessellates the surface that a profile sweeps when it rotates about the z axis by an angle in
/// degrees.
fn revolve(degrees: f64, rows: u32, line: impl Fn(f64) -> ProfilePoint) -> MeshData {
    let mut data = MeshData::default();
    let columns = (SIDES * degrees / 360.0).ceil().max(4.0) as u32;
    for i in 0..=columns {
        let u = f64::from(i) / f64::from(columns);
        let (sin, cos) = fp::sin_cos_degrees(degrees * u);
        let turn = |p: DVec3| DVec3::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z);
        for j in 0..=rows {
            let v = f64::from(j) / f64::from(rows);
            let (place, onwards) = line(v);
            // On the axis, use the limit of the direction, since the point itself does not move.
            let around = DVec3::new(-place.y, place.x, 0.0).try_normalize().unwrap_or(DVec3::Y);
            data.positions.push(turn(place).as_vec3());
            data.normals.push(turn(around.cross(onwards)).normalize_or(DVec3::Z).as_vec3());
            data.uvs.push(Vec2::new(u as f32, v as f32));
        }
    }
    for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
        let p = |di: u32, dj: u32| (i + di) * (rows + 1) + j + dj;
        let corners = |triangle: &[u32; 3]| triangle.map(|k| data.positions[k as usize]);
        for triangle in [[p(0, 0), p(1, 0), p(1, 1)], [p(0, 0), p(1, 1), p(0, 1)]] {
            // At a pole, one of the two triangles is degenerate.
            let [a, b, c] = corners(&triangle);
            if a != b && b != c && c != a {
                data.triangles.push(triangle);
            }
        }
    }
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    data
}

/// Creates the part of a sphere between two heights, both of which must be within the sphere.
pub fn sphere(radius: f64, [low, high]: [f32; 2], degrees: f64) -> MeshData {
    // The angles are measured from the equator.
    let angle = |z: f32| {
        let sine = (f64::from(z) / radius).clamp(-1.0, 1.0);
        if sine.abs() == 1.0 { FRAC_PI_2 * sine } else { fp::atan_f64(sine / (1.0 - sine * sine).sqrt()) }
    };
    let (from, to) = (angle(low), angle(high));
    let rows = (f64::from(ROWS) * (to - from) / PI).ceil().max(2.0) as u32;
    let line = |v: f64| {
        let (sin, cos) = fp::sin_cos_degrees((from + v * (to - from)).to_degrees());
        // A pole lies exactly on the axis.
        let cos = if cos.abs() < 1e-12 { 0.0 } else { cos };
        (radius * DVec3::new(cos, 0.0, sin), DVec3::new(-sin, 0.0, cos))
    };
    revolve(degrees, rows, line)
}

/// Creates a ring at the given height that faces along z. v increases inwards.
pub fn ring([inner, outer]: [f64; 2], height: f64, degrees: f64) -> MeshData {
    let line = |v: f64| (DVec3::new(outer + v * (inner - outer), 0.0, height), DVec3::NEG_X);
    revolve(degrees, 1, line)
}

/// Creates a cone with its apex at the given height, without its base at z = 0.
pub fn cone(radius: f64, height: f64, degrees: f64) -> MeshData {
    let line = |v: f64| {
        (DVec3::new((1.0 - v) * radius, 0.0, v * height), DVec3::new(-radius, 0.0, height).normalize_or(DVec3::Z))
    };
    revolve(degrees, 1, line)
}

/// Creates a paraboloid between two heights, which must be at least 0. The radius is given at the
/// upper height.
pub fn paraboloid(radius: f64, [low, high]: [f64; 2], degrees: f64) -> MeshData {
    // Use equal steps of the radius instead of z, since the curvature is highest near the apex.
    let across = |z: f64| radius * (z / high).sqrt();
    let (from, to) = (across(low), across(high));
    let point = |r: f64| {
        let z = high * r * r / (radius * radius);
        (DVec3::new(r, 0.0, z), DVec3::new(1.0, 0.0, 2.0 * high * r / (radius * radius)).normalize_or(DVec3::X))
    };
    let mut data = revolve(degrees, ROWS, |share| point(from + share * (to - from)));
    for (uv, place) in data.uvs.iter_mut().zip(&data.positions) {
        uv.y = ((f64::from(place.z) - low) / (high - low)).clamp(0.0, 1.0) as f32;
    }
    data
}

/// Creates the hyperboloid that is swept by the line between two points.
pub fn hyperboloid([from, to]: [DVec3; 2], degrees: f64) -> MeshData {
    let line = |v: f64| (from.lerp(to, v), (to - from).normalize_or(DVec3::Z));
    revolve(degrees, ROWS, line)
}

/// Creates an open cylinder between two heights, made of flat strips with smooth normals.
pub fn cylinder(radius: f32, [low, high]: [f32; 2], degrees: f32) -> MeshData {
    let mut data = MeshData::default();
    for i in 0..=COLUMNS {
        let share = i as f32 / COLUMNS as f32;
        let (sin, cos) = fp::sin_cos_degrees(f64::from(degrees * share));
        let normal = Vec3::new(cos as f32, sin as f32, 0.0);
        for (z, v) in [(low, 0.0), (high, 1.0)] {
            data.positions.push(radius * normal + z * Vec3::Z);
            data.normals.push(normal);
            data.uvs.push(Vec2::new(share, v));
        }
        if i < COLUMNS {
            let p = 2 * i;
            data.triangles.extend([[p, p + 2, p + 3], [p, p + 3, p + 1]]);
        }
    }
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    data
}
