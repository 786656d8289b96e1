use glam::{DVec3, Vec3};

/// A ray: the points `origin + t * dir` for `t` in the open interval (`t_min`, `t_max`).
///
/// `dir` does not have to be normalised. A transform maps the origin and direction and leaves `t`
/// unchanged, so `t` has the same meaning in world space and in object space. `t_min` can be minus
/// infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
// SIMD code loads a ray as eight numbers in this order.
#[repr(C)]
pub struct Ray {
    /// Origin of the ray, which is the point at `t` = 0.
    pub origin: Vec3,
    /// Direction of the ray. Its length is one unit of `t`.
    pub dir: Vec3,
    /// Lower end of the open interval of `t`.
    pub t_min: f32,
    /// Upper end of the open interval of `t`.
    pub t_max: f32,
}

impl Ray {
    /// Creates the half-line from `origin` along `dir`.
    #[inline]
    pub const fn new(origin: Vec3, dir: Vec3) -> Self {
        Ray { origin, dir, t_min: 0.0, t_max: f32::INFINITY }
    }

    /// Returns the point at `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.dir
    }

    /// Returns true if `t` lies in the open interval of this ray. Returns false for NaN.
    #[inline]
    pub fn contains(&self, t: f32) -> bool {
        t > self.t_min && t < self.t_max
    }

    /// Returns the infinite line through the ray, in double precision.
    #[inline]
    pub fn line(&self) -> Line {
        Line { origin: self.origin.as_dvec3(), dir: self.dir.as_dvec3() }
    }
}

/// A ray whose origin is known in double precision.
///
/// Queries of scenes take rays of this type. Far from the coordinate origin, rounding to single
/// precision would move the origin of a secondary ray off its surface, possibly to the other side
/// of a nearby wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray64 {
    /// The ray with its origin rounded to single precision.
    pub rounded: Ray,
    /// The part of the origin that rounding removed.
    pub origin_error: Vec3,
    /// Primitive that the ray leaves, and the side of it on which the ray starts.
    pub side: StartSide,
}

/// Primitive on whose surface a ray starts, and the side (inside or outside) on which it starts.
/// Near an edge, the origin is not accurate enough to determine the side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
// 0 if unknown. Otherwise 2 * number + 1, plus 1 if the ray starts inside.
pub struct StartSide(u32);

impl StartSide {
    /// Side of a ray that does not start on a primitive or starts on an unknown one.
    pub const UNKNOWN: StartSide = StartSide(0);

    /// Creates the inside or outside of a primitive. The caller numbers the primitives. Numbers
    /// above 2^31 - 2 result in [`StartSide::UNKNOWN`].
    #[inline]
    pub fn of(primitive: u32, inside: bool) -> StartSide {
        if primitive < (1 << 31) - 1 { StartSide(2 * primitive + 1 + u32::from(inside)) } else { StartSide::UNKNOWN }
    }

    /// Returns true if the ray starts inside the primitive, or `None` if it starts on a different
    /// primitive or an unknown one.
    #[inline]
    pub fn inside(self, primitive: u32) -> Option<bool> {
        (self != StartSide::UNKNOWN && (self.0 - 1) / 2 == primitive).then_some(self.0.is_multiple_of(2))
    }
}

impl Ray64 {
    /// Creates the ray from `origin` along `dir` in an open interval of `t`.
    #[inline]
    pub fn new(origin: DVec3, dir: Vec3, t_min: f32, t_max: f32) -> Self {
        let near = origin.as_vec3();
        let origin_error = (origin - near.as_dvec3()).as_vec3();
        Ray64 { rounded: Ray { origin: near, dir, t_min, t_max }, origin_error, side: StartSide::UNKNOWN }
    }

    /// Sets the primitive that the ray leaves and the side on which it starts.
    #[inline]
    pub fn on_side(self, side: StartSide) -> Self {
        Ray64 { side, ..self }
    }

    /// Returns the origin of the ray, which is the point at `t` = 0.
    #[inline]
    pub fn origin(&self) -> DVec3 {
        self.rounded.origin.as_dvec3() + self.origin_error.as_dvec3()
    }

    /// Returns the direction of the ray. Its length is one unit of `t`.
    #[inline]
    pub fn dir(&self) -> Vec3 {
        self.rounded.dir
    }

    /// Returns the infinite line through the ray.
    #[inline]
    pub fn line(&self) -> Line {
        Line { origin: self.origin(), dir: self.rounded.dir.as_dvec3() }
    }
}

impl From<Ray> for Ray64 {
    #[inline]
    fn from(rounded: Ray) -> Self {
        Ray64 { rounded, origin_error: Vec3::ZERO, side: StartSide::UNKNOWN }
    }
}

impl From<&Ray> for Ray64 {
    #[inline]
    fn from(ray: &Ray) -> Self {
        Ray64::from(*ray)
    }
}

impl From<&Ray64> for Ray64 {
    #[inline]
    fn from(ray: &Ray64) -> Self {
        *ray
    }
}

/// An infinite line: the points `origin + t * dir` for all `t`, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Origin of the line, which is the point at `t` = 0.
    pub origin: DVec3,
    /// Direction of the line. Its length is one unit of `t`.
    pub dir: DVec3,
}

impl Line {
    /// Returns the point at `t`.
    #[inline]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.dir
    }

    /// Returns the parameter `t` of the point on the line that is nearest to `point`.
    #[inline]
    pub fn nearest(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.dir) / self.dir.dot(self.dir)
    }

    /// Returns true if the line can hit anything, which requires it to be finite with a nonzero
    /// direction.
    #[inline]
    pub fn is_valid(&self) -> bool {
        self.origin.is_finite() && self.dir.is_finite() && self.dir != DVec3::ZERO
    }
}
