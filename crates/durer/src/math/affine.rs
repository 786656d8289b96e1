use super::{Aabb, Ray, Vec3, gamma};
use glam::{DAffine3, DMat3, Mat3};

/// An invertible affine map between two spaces, with its inverse.
///
/// Both directions are computed in double precision and rounded once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    linear: Mat3,
    translation: Vec3,
    inverse_linear: Mat3,
    inverse_translation: Vec3,
}

impl Affine {
    /// The map that leaves everything where it is.
    pub const IDENTITY: Affine = Affine {
        linear: Mat3::IDENTITY,
        translation: Vec3::ZERO,
        inverse_linear: Mat3::IDENTITY,
        inverse_translation: Vec3::ZERO,
    };

    /// From a double-precision matrix; `None` where it is singular or not finite.
    pub fn new(forward: DAffine3) -> Option<Self> {
        let m = forward.matrix3;
        let inverse = forward.inverse();
        let scale = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
        // A determinant lost in rounding means that space is flattened.
        let regular = m.determinant().abs() > 1e-14 * scale && scale > 0.0;
        let affine = Affine {
            linear: to_f32(m),
            translation: forward.translation.as_vec3(),
            inverse_linear: to_f32(inverse.matrix3),
            inverse_translation: inverse.translation.as_vec3(),
        };
        let finite = [affine.linear, affine.inverse_linear].iter().all(|m| m.is_finite())
            && affine.translation.is_finite()
            && affine.inverse_translation.is_finite();
        (regular && finite).then_some(affine)
    }

    /// Whether this map moves nothing.
    pub fn is_identity(&self) -> bool {
        *self == Affine::IDENTITY
    }

    /// Maps a point forward.
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.linear * p + self.translation
    }

    /// Maps a direction forward; its length is kept in step with the map.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.linear * v
    }

    /// Maps a normal forward, by the inverse transpose; not normalised.
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let m = &self.inverse_linear;
        Vec3::new(m.x_axis.dot(n), m.y_axis.dot(n), m.z_axis.dot(n))
    }

    /// Maps a point backward.
    pub fn inverse_point(&self, p: Vec3) -> Vec3 {
        self.inverse_linear * p + self.inverse_translation
    }

    /// Maps a ray backward, into the space that this map leads out of. `t` keeps its meaning.
    pub fn inverse_ray(&self, ray: &Ray) -> Ray {
        Ray { origin: self.inverse_point(ray.origin), dir: self.inverse_linear * ray.dir, ..*ray }
    }

    /// Bound on the absolute error of `point(p)` when `p` itself is known to within `error`.
    ///
    /// Both roundings on the way forward and on a later way back are covered.
    /// Source: Pharr, Jakob, Humphreys, *Physically Based Rendering*, 4th edition, section 6.8.1.
    pub fn point_error(&self, p: Vec3, error: Vec3) -> Vec3 {
        let abs = self.linear.abs();
        let own = gamma(3) * (abs * p.abs() + self.translation.abs());
        own + (1.0 + gamma(3)) * (abs * (error + self.return_error(self.point(p))))
    }

    /// Bound on the absolute error of `inverse_point(p)`, in the inner space.
    fn return_error(&self, p: Vec3) -> Vec3 {
        // One more rounding than the multiplication: the matrix itself is rounded.
        gamma(5) * (self.inverse_linear.abs() * p.abs() + self.inverse_translation.abs())
    }

    /// The least box around the image of a box, enlarged by the rounding of its corners.
    pub fn bounds(&self, b: Aabb) -> Aabb {
        let image = Aabb::around(b.corners().map(|c| self.point(c)));
        let largest = b.min.abs().max(b.max.abs());
        let error = gamma(4) * (self.linear.abs() * largest + self.translation.abs());
        Aabb { min: image.min - error, max: image.max + error }
    }
}

fn to_f32(m: DMat3) -> Mat3 {
    Mat3::from_cols(m.x_axis.as_vec3(), m.y_axis.as_vec3(), m.z_axis.as_vec3())
}
