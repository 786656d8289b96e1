//! Double-precision arithmetic on one number or on several SIMD lanes.

/// Arithmetic on one `f64`, or on several in SIMD lanes, so that the tests for one ray and for
/// several rays share their code.
pub(crate) trait Doubles: Copy {
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// Returns `self` if it is less than `other`, and `other` otherwise, also if either is NaN.
    fn min(self, other: Self) -> Self;
    /// Returns `self` if it is greater than `other`, and `other` otherwise, also if either is NaN.
    fn max(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    /// Returns the magnitude of `self` with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;
}

/// Arithmetic on a vector of three `f64`, or on several such vectors in SIMD lanes.
pub(crate) trait Triple: Doubles {
    /// Type of a component.
    type Component: Doubles;

    fn z(self) -> Self::Component;
    /// Returns the sum of the components in the order (x + y) + z.
    fn sum(self) -> Self::Component;
    /// Returns the components rotated to (y, z, x).
    fn yzx(self) -> Self;

    #[inline(always)]
    fn dot(self, other: Self) -> Self::Component {
        self.mul(other).sum()
    }

    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        self.mul(other.yzx()).sub(self.yzx().mul(other)).yzx()
    }
}

impl Doubles for f64 {
    #[inline(always)]
    fn add(self, other: f64) -> f64 {
        self + other
    }
    #[inline(always)]
    fn sub(self, other: f64) -> f64 {
        self - other
    }
    #[inline(always)]
    fn mul(self, other: f64) -> f64 {
        self * other
    }
    #[inline(always)]
    fn div(self, other: f64) -> f64 {
        self / other
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn copysign(self, sign: f64) -> f64 {
        f64::copysign(self, sign)
    }
}

macro_rules! both {
    ($($name:ident)*) => {$(
        #[inline(always)]
        fn $name(self, other: Self) -> Self {
            (self.0.$name(other.0), self.1.$name(other.1))
        }
    )*};
}

/// Component-wise arithmetic on two values.
impl<D: Doubles> Doubles for (D, D) {
    both! { add sub mul div min max copysign }

    #[inline(always)]
    fn sqrt(self) -> Self {
        (self.0.sqrt(), self.1.sqrt())
    }
}

macro_rules! each {
    ($($name:ident)*) => {$(
        #[inline(always)]
        fn $name(self, [x, y, z]: Self) -> Self {
            [self[0].$name(x), self[1].$name(y), self[2].$name(z)]
        }
    )*};
}

impl<D: Doubles> Doubles for [D; 3] {
    each! { add sub mul div min max copysign }

    #[inline(always)]
    fn sqrt(self) -> Self {
        [self[0].sqrt(), self[1].sqrt(), self[2].sqrt()]
    }
}

impl<D: Doubles> Triple for [D; 3] {
    type Component = D;

    #[inline(always)]
    fn z(self) -> D {
        self[2]
    }
    #[inline(always)]
    fn sum(self) -> D {
        self[0].add(self[1]).add(self[2])
    }
    #[inline(always)]
    fn yzx(self) -> Self {
        [self[1], self[2], self[0]]
    }
}
