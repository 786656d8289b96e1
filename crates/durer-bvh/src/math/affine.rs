use super::aabb::Aabb;
use super::ray::{Line, Ray, Ray64};
use super::rounding::gamma;
use glam::{DAffine3, DVec3, Vec3};

/// An invertible affine map between two spaces, such as object space and world space, with its
/// inverse.
///
/// The matrices are in double precision and results are rounded only once, so mapping a distant
/// point there and back loses no digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    forward: DAffine3,
    inverse: DAffine3,
}

impl Affine {
    /// Identity map.
    pub const IDENTITY: Affine = Affine { forward: DAffine3::IDENTITY, inverse: DAffine3::IDENTITY };

    /// Creates a map from a matrix. Returns `None` if the matrix is singular or out of the range of
    /// single precision.
    pub fn new(forward: DAffine3) -> Option<Self> {
        let m = forward.matrix3;
        let inverse = forward.inverse();
        let scale = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
        // If the determinant is no larger than its rounding error, the map flattens space.
        let regular = m.determinant().abs() > 1e-14 * scale && scale > 0.0;
        let in_range = |map: DAffine3| {
            let linear = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
            linear.into_iter().chain([map.translation]).all(|v| v.as_vec3().is_finite())
        };
        (regular && in_range(forward) && in_range(inverse)).then_some(Affine { forward, inverse })
    }

    /// Returns true if this is the identity map.
    #[inline]
    pub fn is_identity(&self) -> bool {
        *self == Affine::IDENTITY
    }

    /// Returns true if the map reverses handedness.
    #[inline]
    pub fn flips_handedness(&self) -> bool {
        self.forward.matrix3.determinant() < 0.0
    }

    /// Returns the matrix of the forward map.
    #[inline]
    pub fn forward(&self) -> DAffine3 {
        self.forward
    }

    /// Maps a point forward.
    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.point64(p).as_vec3()
    }

    /// Maps a point forward, without rounding the result to single precision.
    #[inline]
    pub fn point64(&self, p: Vec3) -> DVec3 {
        self.forward.transform_point3(p.as_dvec3())
    }

    /// Maps a point backward.
    #[inline]
    pub fn inverse_point(&self, p: Vec3) -> Vec3 {
        self.inverse.transform_point3(p.as_dvec3()).as_vec3()
    }

    /// Maps a vector forward. The translation has no effect on it.
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.forward.transform_vector3(v.as_dvec3()).as_vec3()
    }

    /// Maps a unit normal forward with the inverse transpose matrix. The result has unit length.
    #[inline]
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let image = self.inverse.matrix3.transpose() * n.as_dvec3();
        image.normalize_or(n.as_dvec3()).as_vec3()
    }

    /// Maps a unit normal backward. This is the inverse of [`Affine::normal`].
    #[inline]
    pub fn inverse_normal(&self, n: Vec3) -> Vec3 {
        (self.forward.matrix3.transpose() * n.as_dvec3()).normalize_or(n.as_dvec3()).as_vec3()
    }

    /// Maps a normal forward as [`Affine::normal`] does, without normalising the result.
    #[inline]
    pub fn unnormalized_normal(&self, n: Vec3) -> Vec3 {
        (self.inverse.matrix3.transpose() * n.as_dvec3()).as_vec3()
    }

    /// Maps a ray backward, into the source space of this map. `t` does not change.
    #[inline]
    pub fn inverse_ray(&self, ray: impl Into<Ray64>) -> Ray {
        let ray = ray.into();
        let origin = self.inverse.transform_point3(ray.origin()).as_vec3();
        let dir = self.inverse.transform_vector3(ray.rounded.dir.as_dvec3()).as_vec3();
        Ray { origin, dir, ..ray.rounded }
    }

    /// Maps the line through a ray backward, in double precision. `t` does not change.
    #[inline]
    pub fn inverse_line(&self, ray: &Ray64) -> Line {
        let Line { origin, dir } = ray.line();
        Line { origin: self.inverse.transform_point3(origin), dir: self.inverse.transform_vector3(dir) }
    }

    /// Returns a bound on the absolute error of `point64(p)` if `p` has an error of at most
    /// `error`.
    ///
    /// The bound covers the rounding errors of the forward map and of mapping the point back later.
    /// World space uses double precision, with 2^-40 to allow for ill-conditioned maps, and object
    /// space uses single precision.
    pub fn point_error(&self, p: Vec3, error: Vec3) -> Vec3 {
        const DOUBLE: f32 = 1.0 / (1u64 << 40) as f32;
        let far = self.forward.translation.abs().as_vec3() + self.error_bound(p.abs());
        DOUBLE * far + self.error_bound(error + gamma(2) * p.abs())
    }

    /// Given a bound on the absolute components of a vector, returns a bound for the mapped vector.
    #[inline]
    pub fn error_bound(&self, bound: Vec3) -> Vec3 {
        (self.forward.matrix3.abs() * bound.as_dvec3()).as_vec3()
    }

    /// Given a bound on the absolute components of a vector, returns a bound after applying the
    /// inverse map; see [`Affine::error_bound`].
    #[inline]
    pub fn inverse_error_bound(&self, bound: Vec3) -> Vec3 {
        (self.inverse.matrix3.abs() * bound.as_dvec3()).as_vec3()
    }

    /// Returns the smallest box around the image of a box, enlarged by the rounding error of its
    /// corners.
    pub fn bounds(&self, b: Aabb) -> Aabb {
        let image = Aabb::around(b.corners().map(|c| self.point(c)));
        let largest = b.min.abs().max(b.max.abs());
        let error = gamma(2) * (image.min.abs().max(image.max.abs()) + self.error_bound(largest));
        Aabb { min: image.min - error, max: image.max + error }
    }
}
