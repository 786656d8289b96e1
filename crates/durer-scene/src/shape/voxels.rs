//! A box of equal cells, some of which are filled. The course of 2003 used such boxes to show how
//! its grid rasterizes a sphere.

use super::{MeshData, Sphere};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::Vec3;

described! {
    /// A box divided into cells. Each `rasterizeSphere { center radius }` inside it fills the cells
    /// whose centres are inside that sphere.
    VoxelGrid ["Grid" in set::F03 | set::DURER] {
        /// Corner with the smallest coordinates.
        min: Vec3 = Vec3::splat(-1.0), required, Constraint::Any, ["min" in set::F03 | set::DURER];
        /// Corner with the largest coordinates.
        max: Vec3 = Vec3::ONE, required, Constraint::Any, ["max" in set::F03 | set::DURER];
        /// Number of cells along x, y and z, each from 1 to 256.
        num_cells: Vec3 = Vec3::ONE, required, Constraint::Counts(256), ["numCells" in set::F03 | set::DURER];
    }
}

impl VoxelGrid {
    /// Checks that the fields are valid in combination.
    ///
    /// # Errors
    ///
    /// Fails if `min` is not less than `max` in some coordinate.
    pub fn validate(&self) -> Result<(), String> {
        match self.min.cmplt(self.max).all() {
            true => Ok(()),
            false => {
                Err("each coordinate of the grid's `max` must be greater than the same coordinate of `min`".into())
            }
        }
    }

    /// Returns the outer faces of the cells that the spheres fill, as two triangles each,
    /// counter-clockwise as seen from outside.
    pub fn mesh(&self, balls: &[Sphere]) -> MeshData {
        let cells = self.num_cells.to_array().map(|n| n as u32);
        let (min, size) = (self.min.as_dvec3(), self.max.as_dvec3() - self.min.as_dvec3());
        let place = |p: glam::DVec3| min + size * p / self.num_cells.as_dvec3();
        let filled = |cell: [u32; 3]| {
            let middle = place(glam::DVec3::from(cell.map(f64::from)) + 0.5);
            balls.iter().any(|b| (middle - b.center.as_dvec3()).length() <= f64::from(b.radius))
        };
        let mut data = MeshData::default();
        for z in 0..cells[2] {
            for y in 0..cells[1] {
                for x in (0..cells[0]).filter(|&x| filled([x, y, z])) {
                    for (axis, step) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
                        let mut beside = [x, y, z];
                        beside[axis] = if step == 1 { beside[axis] + 1 } else { beside[axis].wrapping_sub(1) };
                        if beside[axis] < cells[axis] && filled(beside) {
                            continue;
                        }
                        // These are the corners of the face. For a far face, the next axis comes
                        // first.
                        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                        let first = data.positions.len() as u32;
                        for (a, b) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                            let mut corner = [x, y, z];
                            corner[axis] += step;
                            corner[next] += if step == 1 { a } else { b };
                            corner[last] += if step == 1 { b } else { a };
                            data.positions.push(place(glam::DVec3::from(corner.map(f64::from))).as_vec3());
                        }
                        data.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|i| first + i)));
                    }
                }
            }
        }
        data
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sphere_of_cells_is_closed_and_has_their_volume() {
        let grid =
            VoxelGrid { min: Vec3::splat(-1.5), max: Vec3::new(1.5, 1.5, 3.0), num_cells: Vec3::new(3.0, 6.0, 9.0) };
        let balls =
            [Sphere { center: Vec3::ZERO, radius: 1.4 }, Sphere { center: Vec3::new(0.3, 0.0, 2.0), radius: 0.9 }];
        let data = grid.mesh(&balls);
        // The volume is computed by the divergence theorem, so inverted faces would give negative
        // volumes.
        let volume: f32 = data
            .triangles
            .iter()
            .map(|t| t.map(|i| data.positions[i as usize]))
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        let mut cells = 0;
        for i in 0..3 * 6 * 9 {
            let middle =
                Vec3::new(-1.0 + (i % 3) as f32, -1.25 + 0.5 * (i / 3 % 6) as f32, -1.25 + 0.5 * (i / 18) as f32);
            cells += u32::from(balls.iter().any(|b| middle.distance(b.center) <= b.radius));
        }
        assert!(cells > 30 && (volume - 0.25 * cells as f32).abs() < 1e-4, "{cells} {volume}");
        // Every edge must be used once in each direction.
        let key = |i: u32| data.positions[i as usize].to_array().map(f32::to_bits);
        let mut edges = std::collections::HashMap::new();
        for t in &data.triangles {
            for i in 0..3 {
                let (a, b) = (key(t[i]), key(t[(i + 1) % 3]));
                *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|&n| n == 0));
    }
}
