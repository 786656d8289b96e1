use glam::Vec3;

/// An axis-aligned bounding box. The box is empty if `min` exceeds `max` along any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Minimum corner.
    pub min: Vec3,
    /// Maximum corner.
    pub max: Vec3,
}

impl Aabb {
    /// A box that contains no point.
    pub const EMPTY: Aabb = Aabb { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// Returns the smallest box that contains some points.
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Aabb::EMPTY, Aabb::union_point)
    }

    /// Returns the smallest box that contains this box and a point.
    #[inline]
    pub fn union_point(self, point: Vec3) -> Self {
        Aabb { min: self.min.min(point), max: self.max.max(point) }
    }

    /// Returns the smallest box that contains both boxes.
    #[inline]
    pub fn union(self, other: Aabb) -> Self {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns the largest absolute value among the coordinates of the corners.
    #[inline]
    pub fn max_abs_coordinate(&self) -> f32 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// Returns true if the point lies in the box or on its boundary.
    #[inline]
    pub fn contains(&self, point: Vec3) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }

    /// Returns true if the box contains no point.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Returns the edge lengths, which are zero for an empty box.
    #[inline]
    pub fn size(&self) -> Vec3 {
        (self.max - self.min).max(Vec3::ZERO)
    }

    /// Returns the centre of the box.
    #[inline]
    pub fn center(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Returns true if the box is so far from the origin, relative to its size, that single
    /// precision is coarse in it. This is the case if the largest absolute coordinate of the centre
    /// exceeds 256 times the longest edge.
    #[inline]
    pub fn is_far(self) -> bool {
        self.center().abs().max_element() > 256.0 * self.size().max_element()
    }

    /// Returns half the surface area, for the surface area heuristic.
    #[inline]
    pub fn half_area(&self) -> f32 {
        let d = self.size();
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// Returns the eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let pick = |axis: usize| if i >> axis & 1 == 1 { self.max[axis] } else { self.min[axis] };
            Vec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// Returns the interval of `t` in which `origin + t * dir` lies in the closed box, if there is
    /// one.
    ///
    /// The sign of the direction determines which plane of each slab is the near one. A ray that
    /// lies in a face of the box counts as inside.
    pub fn clip(&self, origin: Vec3, dir: Vec3) -> Option<(f32, f32)> {
        let (mut enter, mut leave) = (f32::NEG_INFINITY, f32::INFINITY);
        for axis in 0..3 {
            if dir[axis] == 0.0 {
                if origin[axis] < self.min[axis] || origin[axis] > self.max[axis] {
                    return None;
                }
                continue;
            }
            let (near, far) = if dir[axis] > 0.0 { (self.min, self.max) } else { (self.max, self.min) };
            enter = enter.max((near[axis] - origin[axis]) / dir[axis]);
            leave = leave.min((far[axis] - origin[axis]) / dir[axis]);
        }
        (enter <= leave).then_some((enter, leave))
    }
}
