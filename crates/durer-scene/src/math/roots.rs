//! Real roots of polynomials, in double precision.

/// Two roots of a t^2 + 2 b t + c at which the sign changes, in ascending order; `None` if there
/// are no such roots. A double root does not count.
///
/// `a` must not be 0. Computing one root as c / q avoids cancellation. Source: Press et al.,
/// *Numerical Recipes*, section 5.6.
pub fn quadratic(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    let discriminant = b * b - a * c;
    if discriminant.is_nan() || discriminant <= 0.0 {
        return None;
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let (x, y) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    Some(if x < y { (x, y) } else { (y, x) })
}

/// Roots between `low` and `high` at which a polynomial of degree 4 changes its sign, in ascending
/// order, and the number of these roots.
///
/// Coefficients start with the constant term. A polynomial is monotonic between the roots of its
/// derivative. Each of these intervals in which the sign changes therefore has one root, which is
/// found by bisection accelerated by Newton's method. The roots of the derivatives are found in the
/// same way. A polynomial with the same sign at both ends has an even number of roots.
pub fn quartic(c: [f64; 5], low: f64, high: f64) -> ([f64; 4], usize) {
    let second = [2.0 * c[2], 6.0 * c[3], 12.0 * c[4]];
    let first = [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4]];
    let mut bends = [0.0; 4];
    let mut count = 0;
    let inside = |t: f64| t > low && t < high;
    if let Some((x, y)) = quadratic(second[2], 0.5 * second[1], second[0]).filter(|_| second[2] != 0.0) {
        for t in [x, y].into_iter().filter(|&t| inside(t)) {
            bends[count] = t;
            count += 1;
        }
    }
    let (turns, count) = roots_between(&first, &bends[..count], low, high);
    roots_between(&c, &turns[..count], low, high)
}

/// Finds the roots at which a polynomial changes its sign. The polynomial must be monotonic between
/// the `cuts`.
fn roots_between(c: &[f64], cuts: &[f64], low: f64, high: f64) -> ([f64; 4], usize) {
    let mut roots = [0.0; 4];
    let mut count = 0;
    let mut from = (low, value(c, low).0);
    for &cut in cuts.iter().chain([&high]) {
        let to = (cut, value(c, cut).0);
        if (from.1 < 0.0) != (to.1 < 0.0) && count < 4 {
            roots[count] = refine(c, from, to);
            count += 1;
        }
        from = to;
    }
    (roots, count)
}

/// Value and derivative of a polynomial, computed by Horner's rule.
fn value(c: &[f64], t: f64) -> (f64, f64) {
    c.iter().rev().fold((0.0, 0.0), |(value, slope), &c| (value * t + c, slope * t + value))
}

/// Finds the root between two points at which the polynomial has different signs.
fn refine(c: &[f64], a: (f64, f64), b: (f64, f64)) -> f64 {
    let (mut low, mut high) = if a.1 < 0.0 { (a.0, b.0) } else { (b.0, a.0) };
    let mut t = 0.5 * (low + high);
    for _ in 0..100 {
        let (v, slope) = value(c, t);
        if v < 0.0 {
            low = t;
        } else {
            high = t;
        }
        let newton = t - v / slope;
        // Use bisection if Newton's step leaves the bracket or is NaN.
        let held = newton > low.min(high) && newton < low.max(high);
        let next = if held { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= 1e-16 * t.abs() || next == t {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    #[test]
    fn quartic_finds_the_roots_of_products() {
        let mut random = Random(1);
        for _ in 0..100_000 {
            let mut expected: [f64; 4] = std::array::from_fn(|_| f64::from(random.between(-1.0, 1.0)));
            expected.sort_by(f64::total_cmp);
            let scale = f64::from(random.between(0.1, 10.0));
            // Multiply out (t - a)(t - b)(t - c)(t - d), factor by factor.
            let mut c = [scale, 0.0, 0.0, 0.0, 0.0];
            for root in expected {
                for i in (0..5).rev() {
                    c[i] = if i > 0 { c[i - 1] } else { 0.0 } - root * c[i];
                }
            }
            let (roots, count) = quartic(c, -1.5, 1.5);
            assert_eq!(count % 2, 0);
            // Roots that are closer together than 1e-3 are less accurate, or merge into one.
            if expected.windows(2).any(|w| w[1] - w[0] < 1e-3) {
                continue;
            }
            assert_eq!(count, 4, "{expected:?} {roots:?}");
            for (found, expected) in roots.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{expected} {found}");
            }
        }
    }

    #[test]
    fn quadratic_avoids_cancellation() {
        let (x, y) = quadratic(1.0, -0.5e8, 1.0).unwrap();
        assert!((x - 1e-8).abs() < 1e-22 && (y - 1e8).abs() < 1e-7, "{x} {y}");
        assert_eq!(quadratic(1.0, -1.0, 1.0), None);
        assert_eq!(quadratic(1.0, 0.0, 1.0), None);
        assert_eq!(quadratic(f64::NAN, 0.0, -1.0), None);
        assert_eq!(quadratic(-1.0, 0.0, 4.0), Some((-2.0, 2.0)));
    }
}
