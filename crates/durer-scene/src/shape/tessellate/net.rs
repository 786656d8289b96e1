//! Creates surfaces over rectangular grids of points: height fields, bilinear patches and NURBS.
//!
//! Source: Piegl and Tiller, *The NURBS Book*, 2nd edition, 1997.

use crate::math::{Vec2, Vec3};
use crate::shape::MeshData;
use glam::{DVec3, DVec4};

/// Number of segments along each side of a NURBS surface.
const STEPS: u32 = 48;

/// Number of segments along each side of a patch that is not flat.
const PATCH: u32 = 8;

/// Adds triangles between the neighbouring points of a grid.
fn grid(data: &mut MeshData, [columns, rows]: [u32; 2]) {
    for (j, i) in (1..rows).flat_map(|j| (1..columns).map(move |i| (j - 1, i - 1))) {
        let p = |di: u32, dj: u32| (j + dj) * columns + i + di;
        data.triangles.extend([[p(0, 0), p(1, 0), p(1, 1)], [p(0, 0), p(1, 1), p(0, 1)]]);
    }
    data.triangle_uvs.clone_from(&data.triangles);
}

/// Tessellates a height field over the unit square, whose heights are given row by row. There are
/// `columns` times `rows` heights, and both numbers must be at least 2.
pub fn heights([columns, rows]: [u32; 2], heights: impl IntoIterator<Item = f32>) -> MeshData {
    let mut data = MeshData::default();
    for (k, height) in (0_u32..).zip(heights) {
        let place = Vec2::new((k % columns) as f32 / (columns - 1) as f32, (k / columns) as f32 / (rows - 1) as f32);
        data.positions.push(place.extend(height));
        data.uvs.push(place);
    }
    grid(&mut data, [columns, rows]);
    data
}

/// Bilinear patches to tessellate, which are given by their corners.
#[derive(Clone, Debug, Default)]
pub struct Patches {
    /// Positions.
    pub positions: Vec<Vec3>,
    /// Normals, one for each position; may be empty.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one for each position; may be empty.
    pub uvs: Vec<Vec2>,
    /// Corners of each patch, in the order (0, 0), (1, 0), (0, 1) and (1, 1).
    pub faces: Vec<[u32; 4]>,
}

/// Tessellates bilinear patches. A flat patch becomes two triangles, and a curved one becomes a
/// grid.
pub fn bilinear(patches: &Patches) -> MeshData {
    let Patches { positions, normals, uvs, faces } = patches;
    let mut data = MeshData::default();
    for face in faces {
        let at = |i: usize| positions[face[i] as usize];
        let edges = [at(1) - at(0), at(2) - at(0), at(3) - at(0)].map(|edge| edge.as_dvec3());
        let volume = edges[0].cross(edges[1]).dot(edges[2]).abs();
        let size = edges.iter().map(|edge| edge.length()).fold(0.0, f64::max);
        let steps = if volume <= 1e-5 * size * size * size { 1 } else { PATCH };
        let base = data.positions.len() as u32;
        let corner = |k: usize| Vec2::new((k % 2) as f32, (k / 2) as f32);
        for (j, i) in (0..=steps).flat_map(|j| (0..=steps).map(move |i| (j, i))) {
            let (u, v) = (i as f32 / steps as f32, j as f32 / steps as f32);
            let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
            let mix = |list: &[Vec3]| (0..4).map(|k| weights[k] * list[face[k] as usize]).sum::<Vec3>();
            data.positions.push(mix(positions));
            let corner_uvs = (0..4).map(|k| weights[k] * uvs.get(face[k] as usize).copied().unwrap_or(corner(k)));
            data.uvs.push(corner_uvs.sum());
            data.normals.push(match normals.is_empty() {
                false => mix(normals),
                true => {
                    let along = (at(1) - at(0)) * (1.0 - v) + (at(3) - at(2)) * v;
                    let across = (at(2) - at(0)) * (1.0 - u) + (at(3) - at(1)) * u;
                    along.cross(across)
                }
            });
        }
        for (j, i) in (0..steps).flat_map(|j| (0..steps).map(move |i| (j, i))) {
            let p = |di: u32, dj: u32| base + (j + dj) * (steps + 1) + i + di;
            data.triangles.extend([[p(0, 0), p(1, 0), p(1, 1)], [p(0, 0), p(1, 1), p(0, 1)]]);
        }
    }
    (data.triangle_uvs, data.triangle_normals) = (data.triangles.clone(), data.triangles.clone());
    data
}

/// Knots along one side of a NURBS surface, and the parameter interval to tessellate.
#[derive(Clone, Copy, Debug)]
pub struct NurbsSide<'a> {
    /// Knots in ascending order. The number of knots is the number of control points plus the
    /// order.
    pub knots: &'a [f64],
    /// Order of the surface on this side, which is the degree plus 1 and at least 2.
    pub order: usize,
    /// Start of the interval.
    pub from: f64,
    /// End of the interval.
    pub to: f64,
}

/// Tessellates a NURBS surface whose control points have positive weights. The control points are
/// given row by row, with `columns` points in each row.
pub fn nurbs(points: &[DVec4], columns: u32, sides: &[NurbsSide; 2]) -> MeshData {
    let side = STEPS + 1;
    let mut data = MeshData::default();
    for (j, i) in (0..side).flat_map(|j| (0..side).map(move |i| (j, i))) {
        let at = [i, j].map(|k| f64::from(k) / f64::from(STEPS));
        let (point, normal) = place(points, columns, sides, at);
        data.positions.push(point.as_vec3());
        data.normals.push(normal.try_normalize().map_or(Vec3::Z, |n| n.as_vec3()));
        data.uvs.push(Vec2::new(at[0] as f32, at[1] as f32));
    }
    grid(&mut data, [side; 2]);
    data.triangle_normals.clone_from(&data.triangles);
    data
}

/// Returns the index of the first control point that has influence at a parameter, the weights of
/// this point and the following ones, and the derivatives of these weights.
fn weights(knots: &NurbsSide, t: f64) -> (usize, Vec<f64>, Vec<f64>) {
    let (all, degree) = (knots.knots, knots.order - 1);
    let last = all.len() - knots.order - 1;
    let span = (all.partition_point(|knot| *knot <= t).max(1) - 1).clamp(degree, last);
    let mut values = vec![1.0];
    let mut slopes = vec![0.0];
    for d in 1..=degree {
        let mut next = vec![0.0; d + 1];
        let mut inclines = vec![0.0; d + 1];
        for (r, value) in values.iter().enumerate() {
            let (low, high) = (all[span + 1 + r - d], all[span + 1 + r]);
            let width = high - low;
            if width > 0.0 {
                next[r] += value * (high - t) / width;
                next[r + 1] += value * (t - low) / width;
                inclines[r] -= d as f64 * value / width;
                inclines[r + 1] += d as f64 * value / width;
            }
        }
        (values, slopes) = (next, inclines);
    }
    (span - degree, values, slopes)
}

/// Returns a point on the surface and the cross product of its tangents.
fn place(points: &[DVec4], columns: u32, sides: &[NurbsSide; 2], at: [f64; 2]) -> (DVec3, DVec3) {
    let t = |side: usize| sides[side].from + at[side] * (sides[side].to - sides[side].from);
    let (first_u, us, us_slope) = weights(&sides[0], t(0));
    let (first_v, vs, vs_slope) = weights(&sides[1], t(1));
    let sum = |us: &[f64], vs: &[f64]| {
        let mut sum = DVec4::ZERO;
        for (j, v) in vs.iter().enumerate() {
            for (i, u) in us.iter().enumerate() {
                sum += u * v * points[(first_v + j) * columns as usize + first_u + i];
            }
        }
        sum
    };
    let (whole, du, dv) = (sum(&us, &vs), sum(&us_slope, &vs), sum(&us, &vs_slope));
    let point = whole.truncate() / whole.w;
    let slope = |d: DVec4| (d.truncate() - d.w * point) / whole.w;
    (point, slope(du).cross(slope(dv)))
}
