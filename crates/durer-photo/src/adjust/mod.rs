//! Bundle adjustment, which moves cameras and points together until the projections match the
//! observations.
//!
//! The method is Levenberg-Marquardt. The diagonal of the normal equations is multiplied by 1 + λ,
//! and a step is accepted if it decreases the cost. λ is adapted to how well the decrease was
//! predicted. The position, orientation, and scale of the reconstruction are not constrained, but
//! damping keeps them from drifting.
//!
//! Sources: Nocedal, Wright, *Numerical Optimisation*, 2nd edition, 2006, chapter 10; for λ:
//! Madsen, Nielsen, Tingleff, *Methods for Non-Linear Least Squares Problems*, 2004, section 3.2.

mod covariance;
mod jacobian;
mod loss;
mod system;

pub use covariance::{Covariance, covariance};
pub use loss::Loss;

use crate::Reconstruction;
use nalgebra::{Cholesky, DMatrix, DVector};
use system::{AdjustmentProblem, Parameters};

/// Options of bundle adjustment: the loss function, which parameters are free, and when to stop.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Loss function applied to each residual.
    pub loss: Loss,
    /// True if focal lengths are adjusted. Photographs with the same lens share one focal length.
    pub focal: bool,
    /// True if the distortion coefficients k1 and k2 are adjusted.
    pub radial: bool,
    /// True if the positions of points are adjusted.
    pub points: bool,
    /// Maximum number of steps.
    pub iterations: usize,
    /// Relative decrease of the cost below which the adjustment stops.
    pub tolerance: f64,
}

impl Default for Options {
    fn default() -> Self {
        Options { loss: Loss::Squared, focal: true, radial: true, points: true, iterations: 100, tolerance: 1e-7 }
    }
}

/// Result of [`adjust`]: the cost after each step, and whether the adjustment converged.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Cost before the first step and after each attempted step. The cost is half the sum of the
    /// losses.
    pub costs: Vec<f64>,
    /// True if the adjustment converged, false if it reached the maximum number of steps.
    pub converged: bool,
}

/// Adjusts the photographs with a known pose, their lenses, and the scene points.
pub fn adjust(reconstruction: &mut Reconstruction, options: &Options) -> Report {
    adjust_with_progress(reconstruction, options, &|_, _| {})
}

/// Runs [`adjust`], and calls `watch` with the number and the cost of each step.
pub fn adjust_with_progress(
    reconstruction: &mut Reconstruction,
    options: &Options,
    watch: &dyn Fn(usize, f64),
) -> Report {
    let (system, mut state, views) = AdjustmentProblem::new(reconstruction, *options);
    let mut cost = system.cost(&state);
    let mut report = Report { costs: vec![cost], converged: false };
    let (mut damping, mut growth) = (1e-4, 2.0);
    while report.costs.len() <= options.iterations && !report.converged {
        let tried = damped_step(&system, &state, damping);
        let (better, fall) = match &tried {
            Some((next, foreseen)) => {
                let next_cost = system.cost(next);
                let fall = cost - next_cost;
                let ratio = fall / foreseen;
                // If a point passed through a camera, the cost is NaN and this test fails.
                if ratio > 1e-3 && fall > 0.0 {
                    let bend = 2.0 * ratio - 1.0;
                    damping = (damping * (1.0 - bend * bend * bend).max(1.0 / 3.0)).max(1e-16);
                    growth = 2.0;
                    (true, fall)
                } else {
                    // The step is so small that it reaches the limit of double precision.
                    report.converged = foreseen.abs() <= 1e-14 * cost;
                    (false, fall)
                }
            }
            None => (false, 0.0),
        };
        match tried {
            Some((next, _)) if better => {
                report.converged = fall <= options.tolerance * cost;
                state = next;
                cost -= fall;
                // The remaining cost is caused only by rounding errors.
                report.converged |= cost <= 1e-20 * report.costs[0];
            }
            _ => {
                damping *= growth;
                growth *= 2.0;
                report.converged |= damping > 1e32;
            }
        }
        watch(report.costs.len(), cost);
        report.costs.push(cost);
    }
    views.iter().zip(state.poses).for_each(|(view, pose)| {
        // The product of many small rotations is no longer exactly a rotation.
        let rotation = crate::model::nearest_rotation(&pose.rotation);
        reconstruction.views[*view].pose = Some(crate::Pose { rotation, ..pose });
    });
    reconstruction.lenses = state.lenses;
    reconstruction.points.iter_mut().zip(state.points).for_each(|(point, position)| point.position = position);
    report
}

/// Returns the derivatives of a pixel with respect to its camera: rotation, translation, f, k1, and
/// k2.
pub(crate) fn camera_jacobian(
    lens: &crate::Lens,
    pose: &crate::Pose,
    point: &nalgebra::Vector3<f64>,
) -> jacobian::CameraJacobian {
    jacobian::project(lens, pose, point).1
}

/// Computes a damped step, and predicts the decrease of the cost.
fn damped_step(system: &AdjustmentProblem, state: &Parameters, damping: f64) -> Option<(Parameters, f64)> {
    let mut reduced = system.reduce(state, damping);
    // A parameter that is fixed or has no influence gets the equation 1 · dx = 0.
    let diagonal_damping: DVector<f64> = reduced.diagonal.map(|d| if d > 0.0 { damping * d } else { 1.0 });
    (0..system.size).for_each(|i| reduced.matrix[(i, i)] += diagonal_damping[i]);
    let step = solve(reduced.matrix, &reduced.right)?;
    let (points, fall) = system.back_substitute(state, damping, &step);
    let predicted = fall + 0.5 * step.dot(&(diagonal_damping.component_mul(&step) - reduced.gradient));
    let (poses, lenses) = system.apply_step(state, &step);
    Some((Parameters { poses, lenses, points }, predicted))
}

/// Solves a symmetric system of equations after scaling it to a unit diagonal.
fn solve(mut matrix: DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let scale = matrix.diagonal().map(|d| 1.0 / d.sqrt());
    if scale.iter().any(|s| !s.is_finite()) {
        return None;
    }
    for (j, mut column) in matrix.column_iter_mut().enumerate() {
        column.component_mul_assign(&scale);
        column *= scale[j];
    }
    let solved = Cholesky::new(matrix)?.solve(&right.component_mul(&scale));
    let step = solved.component_mul(&scale);
    step.iter().all(|s| s.is_finite()).then_some(step)
}
