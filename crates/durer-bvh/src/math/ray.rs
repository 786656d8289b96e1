use glam::{DVec3, Vec3};

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
    #[inline]
    pub const fn new(origin: Vec3, dir: Vec3) -> Self {
        Ray { origin, dir, t_min: 0.0, t_max: f32::INFINITY }
    }

    /// The point at `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.dir
    }

    /// Whether `t` lies in the open interval of this ray. False for NaN.
    #[inline]
    pub fn contains(&self, t: f32) -> bool {
        t > self.t_min && t < self.t_max
    }

    /// The whole line through it, in double precision.
    #[inline]
    pub fn line(&self) -> Line {
        Line { origin: self.origin.as_dvec3(), dir: self.dir.as_dvec3() }
    }
}

/// A ray whose origin is known in double precision.
///
/// What the world is asked with: far from the origin of coordinates, single precision would move a
/// secondary ray off the surface that it starts from, and through the wall beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray64 {
    /// The ray with its origin rounded to single precision.
    pub rounded: Ray,
    /// What rounding left of the origin.
    pub rest: Vec3,
    /// What it leaves, and on which side of that it starts.
    pub side: Side,
}

/// The thing that a ray leaves, and whether it starts inside of it: where the origin is nearer to
/// an edge than it is known, coordinates do not tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
// Nothing, or one more than twice the number, and one more inside.
pub struct Side(u32);

impl Side {
    /// Of a ray that leaves nothing, or of which nobody knows.
    pub const ANY: Side = Side(0);

    /// Inside or outside of a thing, by the caller's number for it; beyond 2^31 - 2 none is known.
    #[inline]
    pub fn of(thing: u32, inside: bool) -> Side {
        if thing < (1 << 31) - 1 { Side(2 * thing + 1 + u32::from(inside)) } else { Side::ANY }
    }

    /// Whether a ray starts inside a thing; `None` of other things than the one that it leaves.
    #[inline]
    pub fn inside(self, thing: u32) -> Option<bool> {
        (self != Side::ANY && (self.0 - 1) / 2 == thing).then_some(self.0.is_multiple_of(2))
    }
}

impl Ray64 {
    /// The ray from `origin` along `dir` in an open interval of `t`.
    #[inline]
    pub fn new(origin: DVec3, dir: Vec3, t_min: f32, t_max: f32) -> Self {
        let near = origin.as_vec3();
        let rest = (origin - near.as_dvec3()).as_vec3();
        Ray64 { rounded: Ray { origin: near, dir, t_min, t_max }, rest, side: Side::ANY }
    }

    /// The same ray, which leaves a thing.
    #[inline]
    pub fn on_side(self, side: Side) -> Self {
        Ray64 { side, ..self }
    }

    /// Where `t` is 0.
    #[inline]
    pub fn origin(&self) -> DVec3 {
        self.rounded.origin.as_dvec3() + self.rest.as_dvec3()
    }

    /// Direction; its length is one unit of `t`.
    #[inline]
    pub fn dir(&self) -> Vec3 {
        self.rounded.dir
    }

    /// The whole line through it.
    #[inline]
    pub fn line(&self) -> Line {
        Line { origin: self.origin(), dir: self.rounded.dir.as_dvec3() }
    }
}

impl From<Ray> for Ray64 {
    #[inline]
    fn from(rounded: Ray) -> Self {
        Ray64 { rounded, rest: Vec3::ZERO, side: Side::ANY }
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
    #[inline]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.dir
    }

    /// The `t` at which the line is nearest to a point.
    #[inline]
    pub fn nearest(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.dir) / self.dir.dot(self.dir)
    }

    /// Whether it can meet anything: all finite, with a direction.
    #[inline]
    pub fn is_sound(&self) -> bool {
        self.origin.is_finite() && self.dir.is_finite() && self.dir != DVec3::ZERO
    }
}
