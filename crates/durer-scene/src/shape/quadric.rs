//! A general quadric, which is the set of zeros of a polynomial of degree two in x, y and z.

use super::{Flip, MeshData, Plane, Shape, ShapeHit, SurfacePoint, angle_fraction, padded_box};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Vec2, Vec3, fp, gamma, roots};
use glam::{DMat3, DVec3};

described! {
    /// A quadric surface: the zeros of A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z +
    /// J. The polynomial is negative inside.
    Quadric ["Quadric" in set::DURER] {
        /// Coefficients A, B and C.
        squares: Vec3 = Vec3::ONE, required, Constraint::Any, ["squares" in set::DURER];
        /// Coefficients D, E and F.
        products: Vec3 = Vec3::ZERO, optional, Constraint::Any, ["products" in set::DURER];
        /// Coefficients G, H and I.
        linear: Vec3 = Vec3::ZERO, optional, Constraint::Any, ["linear" in set::DURER];
        /// Coefficient J.
        constant: f32 = -1.0, required, Constraint::Any, ["constant" in set::DURER];
    }
}

impl Quadric {
    /// Returns the symmetric matrix M of the polynomial p·M p + g·p + j.
    fn matrix(&self) -> DMat3 {
        let ([a, b, c], [d, e, f]) = (self.squares.as_dvec3().to_array(), (0.5 * self.products.as_dvec3()).to_array());
        DMat3::from_cols(DVec3::new(a, d, e), DVec3::new(d, b, f), DVec3::new(e, f, c))
    }

    fn value(&self, p: DVec3) -> f64 {
        p.dot(self.matrix() * p + self.linear.as_dvec3()) + f64::from(self.constant)
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        2.0 * (self.matrix() * p) + self.linear.as_dvec3()
    }

    /// Returns the polynomial a t^2 + 2 b t + c along a line, where t is measured from the point of
    /// the line nearest to the origin. The function also returns the original `t` of that point.
    fn along(&self, line: &Line) -> (f64, [f64; 3]) {
        let shift = line.nearest(DVec3::ZERO);
        let (o, d) = (line.at(shift), line.dir);
        (shift, [d.dot(self.matrix() * d), 0.5 * self.gradient(o).dot(d), self.value(o)])
    }
}

impl Shape for Quadric {
    /// Only ellipsoids have bounds. If M is positive definite, then |p_i - center_i|^2 <=
    /// -q(center) (M^-1)_ii.
    fn bounds(&self) -> Option<Aabb> {
        let m = self.matrix();
        let minor = m.x_axis.x * m.y_axis.y - m.x_axis.y * m.x_axis.y;
        let (scale, determinant) = (m.x_axis.length().max(m.y_axis.length()).max(m.z_axis.length()), m.determinant());
        let definite = m.x_axis.x > 0.0 && minor > 0.0 && determinant > 1e-9 * scale * scale * scale;
        let inverse = definite.then(|| m.inverse())?;
        let center = -0.5 * (inverse * self.linear.as_dvec3());
        let size = (-self.value(center)).max(0.0);
        let diagonal = DVec3::new(inverse.x_axis.x, inverse.y_axis.y, inverse.z_axis.z);
        let reach = (size * diagonal).map(f64::sqrt) * (1.0 + 1e-6);
        Some(padded_box(center - reach, center + reach))
    }

    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let (shift, [a, b, c]) = self.along(line);
        if a != 0.0 {
            if let Some((first, second)) = roots::quadratic(a, b, c) {
                emit(first + shift, Vec2::ZERO);
                emit(second + shift, Vec2::ZERO);
            }
        } else if b != 0.0 {
            emit(shift - 0.5 * c / b, Vec2::ZERO);
        }
    }

    fn surface(&self, point: DVec3, _crossing: &ShapeHit) -> SurfacePoint {
        // Move the point back onto the surface by Newton steps along the gradient.
        let mut p = point;
        let mut gradient = self.gradient(p);
        for _ in 0..3 {
            let square = gradient.length_squared();
            if square > 0.0 {
                p -= gradient * (self.value(p) / square);
                gradient = self.gradient(p);
            }
        }
        let steepness = gradient.length();
        let bend = 2.0 * self.matrix().to_cols_array().iter().fold(0.0, |sum: f64, x| sum + x.abs());
        let size = p.abs().max_element();
        // Where all terms cancel, for example at the tip of a cone, the normal is undefined and the
        // curvature is unbounded.
        let curvature = (bend / steepness.max(1e-6 * bend * size)).min(1e30);
        // Use longitude and latitude, as seen from the origin, as texture coordinates.
        let direction = p.normalize_or(DVec3::Z);
        let v = fp::asin((direction.y as f32).clamp(-1.0, 1.0)) / std::f32::consts::PI + 0.5;
        let floor = gamma(2) * size as f32;
        SurfacePoint::new(p, gradient, floor, Vec2::new(angle_fraction(-direction.z, direction.x), v)).curved(curvature)
    }

    fn inside(&self, point: DVec3) -> Option<bool> {
        Some(self.value(point) < 0.0)
    }

    fn starts_inside(&self, line: &Line) -> bool {
        let (_, [a, b, c]) = self.along(line);
        a < 0.0 || a == 0.0 && (b > 0.0 || b == 0.0 && c < 0.0)
    }

    fn validate(&self) -> Result<(), String> {
        let nothing = [self.squares, self.products, self.linear].iter().all(|v| *v == Vec3::ZERO);
        match nothing {
            true => Err("a `Quadric` needs at least one coefficient, besides `constant`, that is not 0".into()),
            false => Ok(()),
        }
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        None
    }

    fn flip(&self) -> Option<Flip> {
        None
    }

    fn plane(&self) -> Option<&Plane> {
        None
    }

    fn polygons(&self) -> Vec<Vec<Vec3>> {
        Vec::new()
    }

    fn emitter(&self, _: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
        None
    }

    fn tangent(&self, _: Vec3) -> Option<Vec3> {
        None
    }

    fn to_mesh(&self) -> Option<MeshData> {
        None
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        None
    }
}
