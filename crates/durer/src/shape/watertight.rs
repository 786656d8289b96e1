//! Ray against triangle, watertight: a ray never slips between two triangles that share an edge, and
//! crosses exactly one of those around an edge or a vertex.
//!
//! The triangle is sheared so that the ray runs along one axis; what remains is whether a polygon's edges go
//! round the origin of a plane. Corners shared by two triangles are rounded alike, and the sign of each edge
//! function is exact, so two neighbours never disagree. Where an edge passes through the ray, the ray counts
//! as moved by an infinitesimal (e, e^2) in the plane across it.
//!
//! Sources: Woop, Benthin, Wald, *Watertight Ray/Triangle Intersection*, JCGT 2(1), 2013; the infinitesimal is
//! Edelsbrunner and Mücke's *Simulation of Simplicity*, ACM TOG 9(1), 1990.

use super::Crossing;
use crate::math::{Ray, Vec2, Vec3};

/// A ray prepared for many triangles.
#[derive(Clone, Copy, Debug)]
pub struct Sheared {
    origin: Vec3,
    axes: [usize; 3],
    shear: Vec3,
}

impl Sheared {
    /// Prepares a ray. One without direction hits nothing.
    pub fn new(ray: &Ray) -> Self {
        let d = ray.dir.abs();
        // The longest component of the direction becomes the third axis.
        let kz = if d.x > d.y && d.x > d.z {
            0
        } else if d.y > d.z {
            1
        } else {
            2
        };
        let (mut kx, mut ky) = ((kz + 1) % 3, (kz + 2) % 3);
        if ray.dir[kz] < 0.0 {
            std::mem::swap(&mut kx, &mut ky);
        }
        let z = ray.dir[kz];
        let shear = Vec3::new(ray.dir[kx] / z, ray.dir[ky] / z, 1.0 / z);
        Sheared { origin: ray.origin, axes: [kx, ky, kz], shear }
    }

    /// The crossing with a triangle in the open interval (`t_min`, `t_max`), from either side.
    #[inline]
    pub fn intersect(&self, corners: [Vec3; 3], t_min: f32, t_max: f32) -> Option<Crossing> {
        let [kx, ky, kz] = self.axes;
        let [a, b, c] = corners.map(|corner| {
            let p = corner - self.origin;
            Vec3::new(p[kx] - self.shear.x * p[kz], p[ky] - self.shear.y * p[kz], self.shear.z * p[kz])
        });
        let (u, u_front) = edge(b, c);
        let (v, v_front) = edge(c, a);
        let (w, w_front) = edge(a, b);
        if u_front != v_front || v_front != w_front {
            return None;
        }
        // Zero for a triangle that the ray sees from its side; such a one is crossed by no ray.
        let det = u + v + w;
        let t = (u * a.z + v * b.z + w * c.z) / det;
        // Refuses also NaN.
        (t > t_min && t < t_max && t.is_finite()).then(|| Crossing { t, uv: Vec2::new(v / det, w / det) })
    }
}

/// The edge function of the edge from `p` to `q` about the origin, and its sign, which is never zero.
#[inline]
fn edge(p: Vec3, q: Vec3) -> (f32, bool) {
    let value = q.x * p.y - q.y * p.x;
    if value != 0.0 {
        // Rounding is monotonic: the difference of two rounded products has the sign of the true one.
        return (value, value > 0.0);
    }
    edge_exact(p, q)
}

/// As [`edge`], where single precision sees zero.
#[cold]
fn edge_exact(p: Vec3, q: Vec3) -> (f32, bool) {
    // A product of two f32 is exact in f64.
    let value = f64::from(q.x) * f64::from(p.y) - f64::from(q.y) * f64::from(p.x);
    // Terms of the edge function about (e, e^2), in falling order: 1, e, e^2.
    let sign = [value, f64::from(q.y) - f64::from(p.y), f64::from(p.x) - f64::from(q.x)]
        .into_iter()
        .find(|term| *term != 0.0)
        .unwrap_or(0.0);
    (value as f32, sign > 0.0)
}
