//! Computes the part of a line that lies inside a convex solid by clipping the line at each face.

use crate::math::Vec2;

/// Interval of a line that lies inside a convex solid, with the numbers of the faces through which
/// the line enters and leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    enter: (f64, f32),
    leave: (f64, f32),
}

impl Chord {
    /// The full line, which has not been clipped.
    pub(super) const LINE: Chord = Chord { enter: (f64::NEG_INFINITY, 0.0), leave: (f64::INFINITY, 0.0) };

    /// Clips the chord to an interval whose ends lie on the given faces.
    #[inline(always)]
    pub(super) fn clip(mut self, enter: f64, leave: f64, faces: [u32; 2]) -> Chord {
        if enter > self.enter.0 {
            self.enter = (enter, faces[0] as f32);
        }
        if leave < self.leave.0 {
            self.leave = (leave, faces[1] as f32);
        }
        self
    }

    /// Clips the chord to the interval where the coordinate `o + t d` lies between two bounds.
    /// `faces` holds the number of the face at each bound.
    #[inline(always)]
    pub(super) fn slab(mut self, o: f64, d: f64, [low, high]: [f64; 2], faces: [u32; 2]) -> Chord {
        if d == 0.0 {
            // Select scalars here, since selecting whole structs would go through memory.
            self.leave.0 = if o < low || o > high { f64::NEG_INFINITY } else { self.leave.0 };
            return self;
        }
        let (a, b) = ((low - o) / d, (high - o) / d);
        if d > 0.0 { self.clip(a, b, faces) } else { self.clip(b, a, [faces[1], faces[0]]) }
    }

    /// Clips the chord to the interval where a t^2 + 2 b t + c is at most 0, for a > 0 or a = b =
    /// 0.
    #[inline(always)]
    pub(super) fn quadratic(mut self, a: f64, b: f64, c: f64, face: u32) -> Chord {
        if a > 0.0
            && let Some((enter, leave)) = crate::math::roots::quadratic(a, b, c)
        {
            return self.clip(enter, leave, [face; 2]);
        }
        self.leave.0 = if a > 0.0 || c > 0.0 || c.is_nan() { f64::NEG_INFINITY } else { self.leave.0 };
        self
    }

    /// Returns both ends of the interval, or `None` if it is empty.
    #[inline(always)]
    pub(super) fn ends(self) -> Option<(f64, f64)> {
        (self.enter.0 < self.leave.0).then_some((self.enter.0, self.leave.0))
    }

    /// Reports both ends of the interval as crossings.
    #[inline(always)]
    pub(super) fn emit_ends(self, emit: &mut impl FnMut(f64, Vec2)) {
        if self.ends().is_some() {
            for (t, face) in [self.enter, self.leave] {
                emit(t, Vec2::new(face, 0.0));
            }
        }
    }
}
