use super::Vec3;
use glam::DVec3;

/// A ray: the points `origin + t * dir` for `t` in the open interval (`t_min`, `t_max`).
///
/// `dir` is not normalised, so that `t` means the same in world and in object space: a transform
/// moves origin and direction and leaves `t` alone. `t_min` may be minus infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
// The kernel reads rays as eight numbers in this order.
#[repr(C)]
pub struct Ray {
    /// Where `t` is 0.
    pub origin: Vec3,
    /// Direction; its length is one unit of `t`.
    pub dir: Vec3,
    /// Hits must lie beyond this.
    pub t_min: f32,
    /// Hits must lie before this.
    pub t_max: f32,
}

impl Ray {
    /// The half-line from `origin` along `dir`.
    pub const fn new(origin: Vec3, dir: Vec3) -> Self {
        Ray { origin, dir, t_min: 0.0, t_max: f32::INFINITY }
    }

    /// The point at `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.dir
    }

    /// Whether `t` lies in the open interval of this ray. False for NaN.
    pub fn contains(&self, t: f32) -> bool {
        t > self.t_min && t < self.t_max
    }

    /// The whole line through it, in double precision.
    pub fn line(&self) -> Line {
        Line { origin: self.origin.as_dvec3(), dir: self.dir.as_dvec3() }
    }
}

/// The points `origin + t * dir` for all `t`, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Where `t` is 0.
    pub origin: DVec3,
    /// Direction; its length is one unit of `t`.
    pub dir: DVec3,
}

impl Line {
    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.dir
    }

    /// The `t` at which the line is nearest to a point.
    pub fn nearest(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.dir) / self.dir.dot(self.dir)
    }

    /// Whether it can meet anything: all finite, with a direction.
    pub fn is_sound(&self) -> bool {
        self.origin.is_finite() && self.dir.is_finite() && self.dir != DVec3::ZERO
    }
}
