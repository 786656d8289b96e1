//! The height field: a picture as a landscape, made into a closed mesh.

use super::MeshData;
use crate::describe::{FileName, Rule, described};
use crate::dialect::set;
use crate::math::{Vec2, Vec3};

described! {
    /// A block whose top is a landscape: a picture's greys are heights, its lower edge is towards
    /// z.
    HeightField ["HeightField" in set::DURER] {
        /// Path of the picture. Black is lowest, and white, or 1 in pictures of floating point, is
        /// highest.
        picture: FileName = FileName::default(), required, Rule::Any, ["picture" in set::DURER];
        /// Corner of the landscape's box of least coordinates: where heights are 0.
        min: Vec3 = Vec3::splat(-1.0), required, Rule::Any, ["min" in set::DURER];
        /// Corner of the landscape's box of greatest coordinates: where heights are 1.
        max: Vec3 = Vec3::ONE, required, Rule::Any, ["max" in set::DURER];
        /// How far the block goes on below `min`.
        depth: f32 = 1.0, optional, Rule::Positive, ["depth" in set::DURER];
    }
}

impl HeightField {
    /// At most this many pixels.
    pub const MAX_PIXELS: usize = 1 << 22;

    /// What is wrong with the values of its fields taken together, if anything.
    pub fn flaw(&self) -> Option<&'static str> {
        let wide = self.min.cmplt(self.max).all();
        (!wide).then_some("`min` of a `HeightField` must be less than its `max` in x, y and z")
    }

    /// Two triangles between each four neighbouring pixels, with walls around them and a floor
    /// below.
    ///
    /// `heights` are rows from the top, `columns` wide; both sides must be at least 2.
    pub fn mesh(&self, columns: usize, heights: &[f32]) -> MeshData {
        let rows = heights.len() / columns;
        let size = self.max - self.min;
        let share = |i: usize, count: usize| i as f32 / (count - 1) as f32;
        // The border's points and the middle of the floor are added, and three triangles for each.
        let around = 2 * (rows + columns) - 4;
        let mut data = MeshData {
            positions: Vec::with_capacity(heights.len() + around + 1),
            uvs: Vec::with_capacity(heights.len() + around + 1),
            triangles: Vec::with_capacity(2 * (rows - 1) * (columns - 1) + 3 * around),
            ..MeshData::default()
        };
        for (i, height) in heights.iter().enumerate() {
            let (u, v) = (share(i % columns, columns), share(i / columns, rows));
            data.positions.push(self.min + size * Vec3::new(u, *height, v));
            data.uvs.push(Vec2::new(u, 1.0 - v));
        }
        let at = |column: usize, row: usize| (row * columns + column) as u32;
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                let [a, b] = [at(column, row), at(column, row + 1)];
                data.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
            }
        }
        // The border, counter-clockwise seen from above.
        let border: Vec<u32> = (0..rows - 1)
            .map(|row| at(0, row))
            .chain((0..columns - 1).map(|column| at(column, rows - 1)))
            .chain((1..rows).rev().map(|row| at(columns - 1, row)))
            .chain((1..columns).rev().map(|column| at(column, 0)))
            .collect();
        let below = data.positions.len() as u32;
        let floor = self.min.y - self.depth;
        for &i in &border {
            data.positions.push(data.positions[i as usize].with_y(floor));
            data.uvs.push(data.uvs[i as usize]);
        }
        let middle = data.positions.len() as u32;
        data.positions.push((self.min + 0.5 * size).with_y(floor));
        data.uvs.push(Vec2::splat(0.5));
        for (i, &p) in border.iter().enumerate() {
            let next = (i + 1) % border.len();
            let (q, p_below, q_below) = (border[next], below + i as u32, below + next as u32);
            data.triangles.extend([[p, p_below, q_below], [p, q_below, q], [middle, q_below, p_below]]);
        }
        data.triangle_uvs = data.triangles.clone();
        data
    }
}
