//! Grids of measuring points.

use durer::math::Vec3;
use durer::measure::Sensor;
use durer::options::vector;

/// Grid of measuring points on a parallelogram, as given by `--grid`.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Corner from which both edges start.
    pub corner: Vec3,
    /// Edges of the parallelogram.
    pub edges: [Vec3; 2],
    /// Number of cells along each edge.
    pub counts: [u32; 2],
}

/// Parses CORNER:EDGE:EDGE:NxM.
pub fn parse(text: &str) -> Result<Grid, String> {
    let wanted = || "expected CORNER:EDGE:EDGE:NxM, for example 0,0.8,0:4,0,0:0,0,6:8x12".to_string();
    let [corner, a, b, counts] = text.split(':').collect::<Vec<_>>()[..] else { return Err(wanted()) };
    let (n, m) = counts.split_once('x').ok_or_else(wanted)?;
    let count = |word: &str| word.parse().ok().filter(|n| (1..=4096).contains(n)).ok_or_else(wanted);
    Ok(Grid { corner: vector(corner)?, edges: [vector(a)?, vector(b)?], counts: [count(n)?, count(m)?] })
}

impl Grid {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.counts.iter().map(|&count| count as usize).product()
    }

    /// Returns the unit normal of the grid. It points up or, for an upright grid, along the cross
    /// product of the second and the first edge.
    pub fn normal(&self, up: Vec3) -> Vec3 {
        let normal = self.edges[1].cross(self.edges[0]).normalize_or(up);
        if normal.dot(up) < 0.0 { -normal } else { normal }
    }

    /// Iterates over the centres of the cells, row by row. `normal` replaces the normal of the
    /// grid.
    pub fn sensors(&self, normal: Option<Vec3>, up: Vec3) -> impl Iterator<Item = Sensor> {
        let Grid { corner, edges: [a, b], counts: [n, m] } = *self;
        let normal = normal.unwrap_or_else(|| self.normal(up));
        let share = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
        (0..n * m).map(move |i| Sensor { point: corner + share(i % n, n) * a + share(i / n, m) * b, normal })
    }
}
