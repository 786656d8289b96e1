//! Vectors in space, in double precision.

/// Three components, and a fourth that means nothing; a value of the type proves that the processor has it.
pub(in crate::bvh) trait Doubles: Copy {
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    /// The second component, the third, and the first.
    fn yzx(self) -> Self;
    /// The dot products with two others.
    fn dots(self, others: [Self; 2]) -> [f64; 2];
    fn to_array(self) -> [f64; 3];

    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        self.mul(other.yzx()).sub(self.yzx().mul(other)).yzx()
    }
}

/// In plain code.
#[derive(Clone, Copy)]
pub struct Plain(pub [f64; 3]);

impl Doubles for Plain {
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let (Plain([a, b, c]), Plain([d, e, f])) = (self, other);
        Plain([a - d, b - e, c - f])
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (Plain([a, b, c]), Plain([d, e, f])) = (self, other);
        Plain([a * d, b * e, c * f])
    }
    #[inline(always)]
    fn yzx(self) -> Self {
        let Plain([x, y, z]) = self;
        Plain([y, z, x])
    }
    #[inline(always)]
    fn dots(self, [p, q]: [Self; 2]) -> [f64; 2] {
        let (Plain([a, b, c]), Plain([d, e, f])) = (self.mul(p), self.mul(q));
        [a + b + c, d + e + f]
    }
    #[inline(always)]
    fn to_array(self) -> [f64; 3] {
        self.0
    }
}
