//! Arithmetic in double precision, for one number or for several side by side.

/// An `f64`, or several that are computed with alike.
pub(crate) trait Doubles: Copy {
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// This where it is less than the other, else that: also where either is no number.
    fn min(self, other: Self) -> Self;
    /// This where it is greater than the other, else that: also where either is no number.
    fn max(self, other: Self) -> Self;

    /// A vector less another.
    #[inline(always)]
    fn difference([a, b, c]: [Self; 3], [x, y, z]: [Self; 3]) -> [Self; 3] {
        [a.sub(x), b.sub(y), c.sub(z)]
    }

    #[inline(always)]
    fn dot([a, b, c]: [Self; 3], [x, y, z]: [Self; 3]) -> Self {
        a.mul(x).add(b.mul(y)).add(c.mul(z))
    }

    #[inline(always)]
    fn cross([a, b, c]: [Self; 3], [x, y, z]: [Self; 3]) -> [Self; 3] {
        [b.mul(z).sub(c.mul(y)), c.mul(x).sub(a.mul(z)), a.mul(y).sub(b.mul(x))]
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
}

macro_rules! both {
    ($($name:ident)*) => {$(
        #[inline(always)]
        fn $name(self, other: Self) -> Self {
            (self.0.$name(other.0), self.1.$name(other.1))
        }
    )*};
}

/// Those of both, side by side.
impl<D: Doubles> Doubles for (D, D) {
    both! { add sub mul div min max }
}
