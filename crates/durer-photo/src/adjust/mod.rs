//! Bundle adjustment: cameras and points are moved together until the points are seen where the
//! photographs show them.
//!
//! Levenberg's and Marquardt's method: of the normal equations with the diagonal times 1 + λ, a
//! step is taken if the cost falls, and λ follows from how well the fall was foreseen. The whole is
//! free to move, turn and grow: the damping holds it.
//!
//! Sources: Nocedal, Wright, *Numerical Optimization*, 2nd edition, 2006, chapter 10; for λ:
//! Madsen, Nielsen, Tingleff, *Methods for Non-Linear Least Squares Problems*, 2004, section 3.2.

mod covariance;
mod jacobian;
mod loss;
mod system;

pub use covariance::{Covariance, covariance};
pub use loss::Loss;

use crate::Reconstruction;
use nalgebra::{Cholesky, DMatrix, DVector};
use system::{State, System};

/// What is adjusted, and how.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// How much a residual counts.
    pub loss: Loss,
    /// Whether focal lengths are free. Photographs of one lens share it.
    pub focal: bool,
    /// Whether k1 and k2 are free.
    pub radial: bool,
    /// Whether points are free.
    pub points: bool,
    /// Steps that are tried at most.
    pub iterations: usize,
    /// It ends when a step lowers the cost by less than this share.
    pub tolerance: f64,
}

impl Default for Options {
    fn default() -> Self {
        Options { loss: Loss::Squared, focal: true, radial: true, points: true, iterations: 100, tolerance: 1e-7 }
    }
}

/// What adjusting did.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The cost at the start and after each step that was tried: half the sum of the losses.
    pub costs: Vec<f64>,
    /// Whether it ended because nothing more was to be had.
    pub converged: bool,
}

/// Adjusts the photographs whose pose is known, their lenses, and the points.
pub fn adjust(all: &mut Reconstruction, options: &Options) -> Report {
    adjust_watched(all, options, &|_, _| {})
}

/// The same, and tells of each step its number and the cost.
pub fn adjust_watched(all: &mut Reconstruction, options: &Options, watch: &dyn Fn(usize, f64)) -> Report {
    let (system, mut state, views) = System::new(all, *options);
    let mut cost = system.cost(&state);
    let mut report = Report { costs: vec![cost], converged: false };
    let (mut damping, mut growth) = (1e-4, 2.0);
    while report.costs.len() <= options.iterations && !report.converged {
        let tried = attempt(&system, &state, damping);
        let (better, fall) = match &tried {
            Some((next, foreseen)) => {
                let next_cost = system.cost(next);
                let fall = cost - next_cost;
                let ratio = fall / foreseen;
                // Not a number, where a step led through a camera, is no fall.
                if ratio > 1e-3 && fall > 0.0 {
                    let bend = 2.0 * ratio - 1.0;
                    damping = (damping * (1.0 - bend * bend * bend).max(1.0 / 3.0)).max(1e-16);
                    growth = 2.0;
                    (true, fall)
                } else {
                    // The end of what double precision can tell.
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
                // Nothing but rounding is left.
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
        // Many small turns are not quite a rotation any more.
        let rotation = crate::model::nearest_rotation(&pose.rotation);
        all.views[*view].pose = Some(crate::Pose { rotation, ..pose });
    });
    all.lenses = state.lenses;
    all.points.iter_mut().zip(state.points).for_each(|(point, position)| point.position = position);
    report
}

/// The derivatives of a pixel by its camera: rotation, translation, f, k1, k2.
pub(crate) fn camera_jacobian(
    lens: &crate::Lens,
    pose: &crate::Pose,
    point: &nalgebra::Vector3<f64>,
) -> jacobian::CameraJacobian {
    jacobian::project(lens, pose, point).1
}

/// A damped step, and the fall of the cost that it promises.
fn attempt(system: &System, state: &State, damping: f64) -> Option<(State, f64)> {
    let mut reduced = system.reduce(state, damping);
    // Parameters on which nothing depends, or which are held, stand alone.
    let held: DVector<f64> = reduced.diagonal.map(|d| if d > 0.0 { damping * d } else { 1.0 });
    (0..system.size).for_each(|i| reduced.matrix[(i, i)] += held[i]);
    let step = solve(reduced.matrix, &reduced.right)?;
    let (points, fall) = system.back(state, damping, &step);
    let foreseen = fall + 0.5 * step.dot(&(held.component_mul(&step) - reduced.gradient));
    let (poses, lenses) = system.moved(state, &step);
    Some((State { poses, lenses, points }, foreseen))
}

/// Solves symmetric equations, which are scaled to a diagonal of 1 first.
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
