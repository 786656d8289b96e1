//! Finds the roots of a polynomial between 0 and 1 from its Bernstein coefficients.
//!
//! In an interval, a polynomial has at most as many roots as there are sign changes in its
//! coefficients. If there is one sign change, the polynomial has exactly one root. Halving the
//! interval by de Casteljau's algorithm separates the roots, and the method of false position then
//! refines each of them.
//!
//! Source: Lane, Riesenfeld, *Bounds on a Polynomial*, BIT 21, 1981; Farin, *Curves and Surfaces
//! for CAGD*, chapter 4.

use glam::DVec3;

/// Polynomial of degree 6, given by its Bernstein coefficients.
pub type Sextic = [f64; 7];

/// Roots that are closer to each other than this are reported only once.
const NARROWEST: f64 = 1.0 / (1u64 << 40) as f64;

/// Dot product of two vector-valued cubics, in Bernstein form.
pub fn dot(a: &[DVec3; 4], b: &[DVec3; 4]) -> Sextic {
    const THREE: [f64; 4] = [1.0, 3.0, 3.0, 1.0];
    const SIX: [f64; 7] = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];
    let mut product = [0.0; 7];
    for i in 0..4 {
        for j in 0..4 {
            product[i + j] += THREE[i] * THREE[j] * a[i].dot(b[j]) / SIX[i + j];
        }
    }
    product
}

/// Calls `emit` with each root, in ascending order. No roots are reported for the zero polynomial.
pub fn for_each_root(polynomial: Sextic, emit: &mut dyn FnMut(f64)) {
    if polynomial.iter().any(|c| *c != 0.0) {
        search(&polynomial, 0.0, 1.0, emit);
    }
}

fn search(c: &Sextic, start: f64, width: f64, emit: &mut dyn FnMut(f64)) {
    // Zero counts as positive, so that a root on the border between two halves belongs to only one
    // of them.
    let changes = c.windows(2).filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0)).count();
    let ends_differ = (c[0] < 0.0) != (c[6] < 0.0);
    match changes {
        0 => {}
        1 => emit(start + width * refine(c)),
        _ if width <= NARROWEST => {
            if ends_differ {
                emit(start + 0.5 * width);
            }
        }
        _ => {
            let (left, right) = split(c, 0.5);
            search(&left, start, 0.5 * width, emit);
            search(&right, start + 0.5 * width, 0.5 * width, emit);
        }
    }
}

/// Splits the coefficients at a point by de Casteljau's algorithm.
fn split(c: &Sextic, at: f64) -> (Sextic, Sextic) {
    let (mut left, mut right) = ([0.0; 7], *c);
    for (i, first) in left.iter_mut().enumerate() {
        *first = right[0];
        for j in 0..6 - i {
            right[j] += at * (right[j + 1] - right[j]);
        }
    }
    (left, right)
}

/// Returns the only root, which is found by false position with the Illinois rule. By this rule,
/// the value at an end is halved if that end is kept twice in a row.
fn refine(c: &Sextic) -> f64 {
    let value = |at: f64| split(c, at).1[0];
    let ((mut a, mut at_a), (mut b, mut at_b)) = ((0.0, c[0]), (1.0, c[6]));
    for _ in 0..200 {
        let middle = (b - at_b * (b - a) / (at_b - at_a)).clamp(a.min(b), a.max(b));
        let at_middle = value(middle);
        if at_middle == 0.0 || (b - a).abs() < 1e-15 || middle == b {
            return middle;
        }
        if (at_middle < 0.0) != (at_b < 0.0) {
            (a, at_a) = (b, at_b);
        } else {
            at_a *= 0.5;
        }
        (b, at_b) = (middle, at_middle);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    /// Returns the polynomial with the given roots in Bernstein form, as a product of the factors
    /// (s - root).
    fn with_roots(roots: &[f64; 6]) -> Sextic {
        let mut c = vec![1.0];
        for root in roots {
            let degree = c.len();
            let mut next = vec![0.0; degree + 1];
            for (i, value) in c.iter().enumerate() {
                // Raise the degree by multiplying with (1 - s) (-root) + s (1 - root).
                next[i] += value * -root * (degree - i) as f64 / degree as f64;
                next[i + 1] += value * (1.0 - root) * (i + 1) as f64 / degree as f64;
            }
            c = next;
        }
        c.try_into().unwrap()
    }

    #[test]
    fn finds_exactly_the_roots_between_0_and_1() {
        let mut random = Random(1);
        for _ in 0..20_000 {
            let mut roots: [f64; 6] = std::array::from_fn(|_| f64::from(random.between(-1.5, 2.5)));
            roots.sort_by(f64::total_cmp);
            if roots.windows(2).any(|pair| pair[1] - pair[0] < 0.02)
                || roots.iter().any(|r| r.abs().min((r - 1.0).abs()) < 1e-3)
            {
                continue;
            }
            let mut collected = Vec::new();
            for_each_root(with_roots(&roots), &mut |root| collected.push(root));
            let inside: Vec<f64> = roots.into_iter().filter(|r| (0.0..1.0).contains(r)).collect();
            assert_eq!(collected.len(), inside.len(), "{collected:?} {inside:?}");
            assert!(collected.iter().zip(&inside).all(|(a, b)| (a - b).abs() < 1e-7), "{collected:?} {inside:?}");
        }
    }

    #[test]
    fn polynomial_without_roots_and_zero_polynomial_give_none() {
        let mut count = 0;
        for_each_root([0.0; 7], &mut |_| count += 1);
        for_each_root([1.0, -0.1, 1.0, 1.0, 1.0, -0.1, 1.0], &mut |_| count += 1);
        assert_eq!(count, 0);
    }
}
