//! Checks quadrics whose equation has no real solution.

use super::finding::{Finding, MAX_FINDINGS};
use super::scene_probe::SceneProbe;
use super::shapes::shape;
use durer_diag::Diagnostic;
use durer_render::world::Object;
use durer_scene::math::Vec3;
use durer_scene::shape::{Primitive, Quadric};

/// Coefficients below this fraction of the largest coefficient count as zero.
const ZERO: f64 = 1e-7;

/// Returns the objects that are quadrics without real points.
pub(super) fn without_points(scene_probe: &SceneProbe) -> Vec<u32> {
    let objects = scene_probe.world().objects().iter().enumerate();
    let none = |object: &Object| match shape(object) {
        Some(Primitive::Quadric(quadric)) => has_no_points(quadric),
        _ => false,
    };
    objects.filter(|(_, object)| none(object)).map(|(number, _)| number as u32).take(MAX_FINDINGS).collect()
}

/// Returns true if the polynomial of a quadric is positive everywhere, or negative everywhere.
fn has_no_points(quadric: &Quadric) -> bool {
    [1.0, -1.0].into_iter().any(|sign| is_positive(quadric, sign))
}

/// Returns true if the polynomial, multiplied by `sign`, is positive everywhere. The squares are
/// completed one variable after another, the one with the largest coefficient first.
fn is_positive(quadric: &Quadric, sign: f64) -> bool {
    let scaled = |v: Vec3| v.to_array().map(|x| sign * f64::from(x));
    let ([a, b, c], [d, e, f], [g, h, i]) = (scaled(quadric.squares), scaled(quadric.products), scaled(quadric.linear));
    let mut m = [[a, 0.5 * d, 0.5 * e], [0.5 * d, b, 0.5 * f], [0.5 * e, 0.5 * f, c]];
    let mut linear = [0.5 * g, 0.5 * h, 0.5 * i];
    let mut rest = sign * f64::from(quadric.constant);
    let largest = m.iter().flatten().chain(&linear).fold(rest.abs(), |most, x| most.max(x.abs()));
    let zero = ZERO * largest;
    let mut left = vec![0, 1, 2];
    while let Some(at) = (0..left.len()).max_by(|&p, &q| m[left[p]][left[p]].total_cmp(&m[left[q]][left[q]])) {
        let pivot = left[at];
        if m[pivot][pivot] <= zero {
            break;
        }
        left.remove(at);
        for &row in &left {
            let factor = m[row][pivot] / m[pivot][pivot];
            for &column in &left {
                m[row][column] -= factor * m[pivot][column];
            }
            linear[row] -= factor * linear[pivot];
        }
        rest -= linear[pivot] * linear[pivot] / m[pivot][pivot];
    }
    // The remaining variables must not occur.
    let absent = |&row: &usize| linear[row].abs() <= zero && left.iter().all(|&column| m[row][column].abs() <= zero);
    rest > zero && left.iter().all(absent)
}

/// Reports quadrics whose equation has no real solution.
pub(super) fn no_surface(scene_probe: &SceneProbe) -> Vec<Finding> {
    let say = |number: u32| {
        let name = scene_probe.object(number);
        let diagnostic = Diagnostic::warning(format!("the equation of the {name} has no real solution"))
            .effect("the quadric has no points, so it is invisible")
            .help("check the signs: for x² + y² + z² = 1, write `squares 1 1 1 constant -1`");
        let diagnostic = scene_probe.at_value(diagnostic, scene_probe.object_span(number), &["constant"]);
        Finding::from(diagnostic).affecting_whole_picture(scene_probe.hits().next().is_none())
    };
    without_points(scene_probe).into_iter().map(say).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_without_real_solutions_are_found() {
        let quadric = |squares: [f32; 3], products: [f32; 3], linear: [f32; 3], constant| Quadric {
            squares: Vec3::from_array(squares),
            products: Vec3::from_array(products),
            linear: Vec3::from_array(linear),
            constant,
        };
        let zero = [0.0; 3];
        for (quadric, expected) in [
            (quadric([1.0; 3], zero, zero, -1.0), false),
            (quadric([1.0; 3], zero, zero, 1.0), true),
            (quadric([-1.0; 3], zero, zero, -1.0), true),
            (quadric([-1.0; 3], zero, zero, 1.0), false),
            // The sphere (x - 3)² + y² + z² = 8 and the empty (x - 3)² + y² + z² = -1.
            (quadric([1.0; 3], zero, [-6.0, 0.0, 0.0], 1.0), false),
            (quadric([1.0; 3], zero, [-6.0, 0.0, 0.0], 10.0), true),
            // A pair of imaginary planes, a parabolic cylinder, a cylinder, and hyperboloids.
            (quadric([1.0, 0.0, 0.0], zero, zero, 1.0), true),
            (quadric([1.0, 0.0, 0.0], zero, [0.0, 1.0, 0.0], 1.0), false),
            (quadric([1.0, 0.0, 1.0], zero, zero, -1.0), false),
            (quadric([1.0, 0.0, 1.0], zero, zero, 1.0), true),
            (quadric([1.0, -1.0, 1.0], zero, zero, 1.0), false),
            (quadric([1.0, -1.0, 1.0], zero, zero, -1.0), false),
            // A plane, the saddle x y + 1 = 0, and the empty (x + y)² + 1 = 0.
            (quadric(zero, zero, [0.0, 1.0, 0.0], 1.0), false),
            (quadric(zero, [1.0, 0.0, 0.0], zero, 1.0), false),
            (quadric([1.0, 1.0, 0.0], [2.0, 0.0, 0.0], zero, 1.0), true),
            // A single point.
            (quadric([1.0; 3], zero, zero, 0.0), false),
        ] {
            assert_eq!(has_no_points(&quadric), expected, "{quadric:?}");
        }
    }
}
