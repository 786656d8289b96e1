//! Computes the real roots of polynomials.

/// Evaluates a polynomial. The coefficients start with the constant term.
fn value(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// Returns the real roots in increasing order. Between two neighbouring extrema (the roots of the
/// derivative), there is at most one root, which is found by bisection. An extremum at which the
/// polynomial is zero, apart from rounding errors, counts as a double root.
pub fn real_roots(coefficients: &[f64]) -> Vec<f64> {
    let largest = coefficients.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    let degree = coefficients.iter().rposition(|c| c.abs() > 1e-14 * largest).unwrap_or(0);
    if degree == 0 || !largest.is_finite() {
        return Vec::new();
    }
    let p = &coefficients[..=degree];
    if degree == 1 {
        return vec![-p[0] / p[1]];
    }
    let derivative: Vec<f64> = (1..=degree).map(|i| i as f64 * p[i]).collect();
    // Use Cauchy's bound on the roots.
    let bound = 1.0 + p[..degree].iter().fold(0.0_f64, |m, c| m.max((c / p[degree]).abs()));
    let ends = [-bound].into_iter().chain(real_roots(&derivative)).chain([bound]).collect::<Vec<_>>();
    let mut roots: Vec<f64> = Vec::new();
    for ends in ends.windows(2) {
        let ([mut low, mut high], mut at_low) = ([ends[0], ends[1]], value(p, ends[0]));
        let at_high = value(p, high);
        let size = p.iter().rev().fold(0.0, |sum, c| sum * high.abs() + c.abs());
        // If an extremum is a root, there is no other root on either side of it up to the next
        // extremum.
        if at_high.abs() < 1e-13 * size && high != bound {
            roots.push(high);
            continue;
        }
        if at_low * at_high > 0.0 || roots.last() == Some(&low) {
            continue;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            let there = value(p, middle);
            if at_low * there > 0.0 {
                (low, at_low) = (middle, there);
            } else {
                high = middle;
            }
        }
        roots.push(high);
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_products_are_found() {
        let wanted = [-3.0, -0.5, 0.0, 0.25, 2.0, 7.0];
        let mut p = vec![1.0, 0.0, 1.0]; // x² + 1 has no real roots.
        for root in wanted {
            let mut product = vec![0.0; p.len() + 1];
            for (i, c) in p.iter().enumerate() {
                product[i] -= root * c;
                product[i + 1] += c;
            }
            p = product;
        }
        let roots = real_roots(&p);
        assert_eq!(roots.len(), wanted.len(), "{roots:?}");
        roots.iter().zip(wanted).for_each(|(a, b)| assert!((a - b).abs() < 1e-9, "{a} {b}"));
        assert_eq!(real_roots(&[1.0, -2.0, 1.0]), [1.0]);
        assert!(real_roots(&[0.0]).is_empty() && real_roots(&[1.0, 0.0, 1.0]).is_empty());
    }
}
