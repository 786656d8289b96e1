//! Geometry of emitting surfaces: their projected areas, and points that are spread over them.

use durer_scene::math::fp;
use glam::DVec3;
use std::f64::consts::PI;

/// Shape of a surface that may emit light, which is needed to replace it with point lights.
pub(super) enum EmitterShape<'a> {
    /// Flat polygon, given by its corners.
    Polygon(&'a [DVec3]),
    Ring {
        center: DVec3,
        normal: DVec3,
        radii: [f64; 2],
    },
    Ball {
        center: DVec3,
        radius: f64,
    },
    /// Lateral surface of a cylinder or cone.
    Side {
        ends: [DVec3; 2],
        radii: [f64; 2],
    },
}

/// Orientation of an emitting surface, which determines its projected area in each direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Orientation {
    /// Flat surface with a unit normal.
    Flat(DVec3),
    /// Round surface around an axis. A cone is treated like a cylinder.
    Round(DVec3),
    Spherical,
}

impl Orientation {
    /// Returns the projected area in a direction, as a fraction of the area, and the cosine of the
    /// angle to the normal. The cosine is 1 for round surfaces.
    pub fn projected_area(self, dir: DVec3) -> (f64, f64) {
        match self {
            // The tolerance excludes directions that lie in the plane of the surface.
            Orientation::Flat(normal) if normal.dot(dir) > 1e-6 => (normal.dot(dir), normal.dot(dir)),
            Orientation::Flat(_) => (0.0, 1.0),
            Orientation::Round(axis) => ((1.0 - axis.dot(dir) * axis.dot(dir)).max(0.0).sqrt() / PI, 1.0),
            Orientation::Spherical => (0.25, 1.0),
        }
    }
}

impl EmitterShape<'_> {
    /// Returns the area of the surface.
    pub fn area(&self) -> f64 {
        match self {
            EmitterShape::Polygon(corners) => 0.5 * double_area_normal(corners).length(),
            EmitterShape::Ring { radii: [inner, outer], .. } => PI * (outer * outer - inner * inner),
            EmitterShape::Ball { radius, .. } => 4.0 * PI * radius * radius,
            EmitterShape::Side { ends, radii: [a, b] } => {
                let length = ends[0].distance(ends[1]);
                PI * (a + b) * (length * length + (a - b) * (a - b)).sqrt()
            }
        }
    }

    /// Returns the orientation of the surface.
    pub fn orientation(&self) -> Orientation {
        match self {
            EmitterShape::Polygon(corners) => Orientation::Flat(double_area_normal(corners).normalize_or_zero()),
            EmitterShape::Ring { normal, .. } => Orientation::Flat(*normal),
            EmitterShape::Ball { .. } => Orientation::Spherical,
            EmitterShape::Side { ends, .. } => Orientation::Round((ends[1] - ends[0]).normalize_or_zero()),
        }
    }

    /// Returns points that are spread over the surface and represent equal areas. For round
    /// surfaces, the points are at the centre or on the axis.
    pub fn points(&self, count: u32) -> Vec<DVec3> {
        let share = |i: u32| (f64::from(i) + 0.5) / f64::from(count);
        match *self {
            EmitterShape::Polygon(corners) => polygon(corners, count),
            EmitterShape::Ring { center, normal, radii: [inner, outer] } => {
                let (x, y) = normal.any_orthonormal_pair();
                let place = |i: u32| {
                    // In Vogel's spiral, equal areas contain equal numbers of points.
                    let radius = (inner * inner + (outer * outer - inner * inner) * share(i)).sqrt();
                    let (sin, cos) = fp::sin_cos_degrees(137.507_764 * f64::from(i));
                    radius * (cos * x + sin * y)
                };
                // Pairs of opposite points keep the mean of all points at the centre of the ring.
                (0..count / 2).map(|i| place(2 * i)).flat_map(|offset| [center + offset, center - offset]).collect()
            }
            EmitterShape::Ball { center, .. } => vec![center],
            EmitterShape::Side { ends, .. } => (0..count).map(|i| ends[0].lerp(ends[1], share(i))).collect(),
        }
    }
}

/// Returns a normal of a polygon, whose length is twice the area.
fn double_area_normal(corners: &[DVec3]) -> DVec3 {
    corners.windows(2).skip(1).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0])).sum()
}

/// Returns points that are spread over a polygon, which is divided into a fan of triangles around
/// its first corner.
fn polygon(corners: &[DVec3], count: u32) -> Vec<DVec3> {
    let areas: Vec<f64> =
        corners.windows(2).skip(1).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0]).length()).collect();
    let whole: f64 = areas.iter().sum();
    let place = |i: u32| {
        let mut along = whole * (f64::from(i) + 0.5) / f64::from(count);
        let mut triangle = 0;
        while triangle + 1 < areas.len() && along > areas[triangle] {
            along -= areas[triangle];
            triangle += 1;
        }
        // The fractional parts of multiples of the golden ratio are distributed evenly.
        let (u, v) = (
            (along / areas[triangle].max(f64::MIN_POSITIVE)).clamp(0.0, 1.0),
            (f64::from(i) * 0.618_033_988_749).fract(),
        );
        let root = u.sqrt();
        let [a, b, c] = [corners[0], corners[triangle + 1], corners[triangle + 2]];
        a * (1.0 - root) + root * ((1.0 - v) * b + v * c)
    };
    let mut places: Vec<DVec3> = (0..count).map(place).collect();
    // Shift the points so that their mean is the centroid of the polygon, which is important for
    // the light at a distance.
    let middle =
        areas.iter().enumerate().map(|(i, area)| *area * (corners[0] + corners[i + 1] + corners[i + 2])).sum::<DVec3>()
            / (3.0 * whole.max(f64::MIN_POSITIVE));
    let shift = middle - places.iter().sum::<DVec3>() / f64::from(count);
    places.iter_mut().for_each(|place| *place += shift);
    places
}
