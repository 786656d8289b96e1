//! Normal equations, from which the points are eliminated by the Schur complement.
//!
//! With camera parameters c and point parameters p, a step solves
//!
//! ```text
//! | U  W | |dc|     |gc|
//! | Wᵀ V | |dp| = - |gp|
//! ```
//!
//! V consists of 3x3 blocks, one for each point. The system (U - W V⁻¹ Wᵀ) dc = -gc + W V⁻¹ gp is
//! therefore small, and its solution dc determines the step of each point. Source: Triggs,
//! McLauchlan, Hartley, Fitzgibbon, *Bundle Adjustment: A Modern Synthesis*, 2000, section 6.

use super::Options;
use super::jacobian::{CameraJacobian, project};
use crate::{Lens, Pose, Reconstruction};
use nalgebra::{DMatrix, DVector, Matrix2x3, Matrix3, SMatrix, Vector2, Vector3};
use rayon::prelude::*;

/// Parameters that bundle adjustment estimates: poses, lenses, and points.
#[derive(Clone)]
pub struct Parameters {
    pub poses: Vec<Pose>,
    pub lenses: Vec<Lens>,
    pub points: Vec<Vector3<f64>>,
}

/// Observed pixel in a photograph with a known pose, together with the indices of its pose and lens
/// in [`Parameters`].
struct SystemObservation {
    pixel: Vector2<f64>,
    pose: usize,
    lens: usize,
}

/// Nonlinear least-squares problem of bundle adjustment: the observations of each point, and the
/// layout of the camera parameters.
pub struct AdjustmentProblem {
    options: Options,
    observations: Vec<SystemObservation>,
    /// Index in `observations` of each point's first observation. The last entry is the total
    /// number of observations.
    starts: Vec<usize>,
    /// Ranges of consecutive points that are each summed by one task and have similar numbers of
    /// observations. The ranges depend only on the problem, so the order of summation does too.
    runs: Vec<std::ops::Range<usize>>,
    poses: usize,
    /// Number of camera parameters: six for each pose, followed by three for each lens.
    pub size: usize,
}

/// Normal equations of the cameras, after the points have been eliminated by the Schur complement.
pub struct ReducedSystem {
    /// Matrix U - W V⁻¹ Wᵀ, with undamped U.
    pub matrix: DMatrix<f64>,
    /// Right-hand side -gc + W V⁻¹ gp.
    pub right: DVector<f64>,
    /// gc.
    pub gradient: DVector<f64>,
    /// Diagonal of U.
    pub diagonal: DVector<f64>,
}

/// Weighted residual of one observation, and its derivatives with respect to the camera and the
/// point.
struct ResidualRow {
    residual: Vector2<f64>,
    by_camera: CameraJacobian,
    by_point: Matrix2x3<f64>,
}

/// Damped 3x3 normal equations of one point, and the rows of its observations.
struct PointBlock {
    rows: Vec<ResidualRow>,
    inverse: Matrix3<f64>,
    gradient: Vector3<f64>,
    damping: Vector3<f64>,
}

impl AdjustmentProblem {
    /// Creates the problem for a reconstruction. Also returns the initial parameters and the
    /// numbers of the photographs with a known pose.
    pub fn new(reconstruction: &Reconstruction, options: Options) -> (Self, Parameters, Vec<usize>) {
        let views: Vec<usize> =
            (0..reconstruction.views.len()).filter(|i| reconstruction.views[*i].pose.is_some()).collect();
        let mut number = vec![usize::MAX; reconstruction.views.len()];
        views.iter().enumerate().for_each(|(i, view)| number[*view] = i);
        let (mut observations, mut starts) = (Vec::new(), vec![0]);
        for point in &reconstruction.points {
            let known = point.track.iter().filter(|observation| number[observation.view] != usize::MAX);
            observations.extend(known.map(|observation| SystemObservation {
                pixel: observation.pixel,
                pose: number[observation.view],
                lens: reconstruction.views[observation.view].lens,
            }));
            starts.push(observations.len());
        }
        let size = 6 * views.len() + 3 * reconstruction.lenses.len();
        // Use enough ranges to keep the threads busy, but at most 256 MiB for their sums.
        let count = ((1 << 25) / (size * size).max(1)).clamp(1, 16);
        let bound = |i: usize| {
            starts.partition_point(|start| start * count < i * observations.len()).min(reconstruction.points.len())
        };
        let runs = (0..count)
            .map(|i| bound(i)..if i + 1 == count { reconstruction.points.len() } else { bound(i + 1) })
            .collect();
        let poses = views.iter().filter_map(|view| reconstruction.views[*view].pose).collect();
        let points = reconstruction.points.iter().map(|point| point.position).collect();
        let state = Parameters { poses, lenses: reconstruction.lenses.clone(), points };
        (AdjustmentProblem { options, observations, starts, runs, poses: views.len(), size }, state, views)
    }

    /// Returns two ranges of an observation's nine columns, the first for the pose and the second
    /// for the lens. Each range consists of its start in the row, its length, and its start in the
    /// system.
    fn columns(&self, observation: &SystemObservation) -> [(usize, usize, usize); 2] {
        [(0, 6, 6 * observation.pose), (6, 3, 6 * self.poses + 3 * observation.lens)]
    }

    fn observations_of(&self, point: usize) -> &[SystemObservation] {
        &self.observations[self.starts[point]..self.starts[point + 1]]
    }

    /// Returns the cost, which is half the sum of the losses.
    pub fn cost(&self, state: &Parameters) -> f64 {
        let run = |run: &std::ops::Range<usize>| {
            let one = |i: usize| {
                let residual = |observation: &SystemObservation| {
                    let p = state.poses[observation.pose].apply(&state.points[i]);
                    (state.lenses[observation.lens].project(&p) - observation.pixel).norm_squared()
                };
                self.observations_of(i)
                    .iter()
                    .map(|observation| self.options.loss.at(residual(observation)).0 / 2.0)
                    .sum::<f64>()
            };
            run.clone().map(one).sum::<f64>()
        };
        self.runs.par_iter().map(run).collect::<Vec<f64>>().into_iter().sum()
    }

    fn block(&self, state: &Parameters, point: usize, damping: f64) -> PointBlock {
        let rows: Vec<ResidualRow> =
            self.observations_of(point).iter().map(|observation| self.row(state, point, observation)).collect();
        let (mut v, mut gradient) = (Matrix3::zeros(), Vector3::zeros());
        for row in &rows {
            v += row.by_point.transpose() * row.by_point;
            gradient += row.by_point.transpose() * row.residual;
        }
        let diagonal = v.diagonal().map(|d| damping * d);
        let damped = v + Matrix3::from_diagonal(&diagonal);
        // A point that is not constrained keeps its position.
        let inverse = damped.try_inverse().filter(|m| m.iter().all(|c| c.is_finite())).unwrap_or_default();
        PointBlock { rows, inverse, gradient, damping: diagonal }
    }

    fn row(&self, state: &Parameters, point: usize, observation: &SystemObservation) -> ResidualRow {
        let (lens, pose) = (&state.lenses[observation.lens], &state.poses[observation.pose]);
        let (pixel, mut by_camera, by_point) = project(lens, pose, &state.points[point]);
        let residual = pixel - observation.pixel;
        // Convert the loss to a weight. This is Triggs' correction without the term with the second
        // derivative.
        let weight = self.options.loss.at(residual.norm_squared()).1.sqrt();
        for (column, free) in [(6, self.options.focal), (7, self.options.radial), (8, self.options.radial)] {
            if !free {
                by_camera.column_mut(column).fill(0.0);
            }
        }
        let by_point = if self.options.points { weight * by_point } else { Matrix2x3::zeros() };
        ResidualRow { residual: weight * residual, by_camera: weight * by_camera, by_point }
    }

    /// Computes the reduced equations, in which the blocks of the points are damped.
    pub fn reduce(&self, state: &Parameters, damping: f64) -> ReducedSystem {
        let n = self.size;
        let run = |run: &std::ops::Range<usize>| {
            let mut half = DMatrix::zeros(n, n);
            let (mut right, mut gradient, mut diagonal) = (DVector::zeros(n), DVector::zeros(n), DVector::zeros(n));
            for point in run.clone() {
                let block = self.block(state, point, damping);
                let observations = self.observations_of(point);
                let step = block.inverse * block.gradient;
                let w: Vec<SMatrix<f64, 9, 3>> =
                    block.rows.iter().map(|row| row.by_camera.transpose() * row.by_point).collect();
                for (i, row) in block.rows.iter().enumerate() {
                    let squares = row.by_camera.transpose() * row.by_camera;
                    let g = row.by_camera.transpose() * row.residual;
                    let reduced = w[i] * step - g;
                    let solved = w[i] * block.inverse;
                    for (from, count, to) in self.columns(&observations[i]) {
                        for k in 0..count {
                            right[to + k] += reduced[from + k];
                            gradient[to + k] += g[from + k];
                            diagonal[to + k] += squares[(from + k, from + k)];
                        }
                    }
                    // The matrix is the sum of `half` and its transpose, so the diagonal blocks are
                    // halved.
                    self.add(
                        &mut half,
                        &observations[i],
                        &observations[i],
                        &((squares - solved * w[i].transpose()) * 0.5),
                    );
                    if self.options.points {
                        for j in 0..i {
                            self.add(&mut half, &observations[i], &observations[j], &-(solved * w[j].transpose()));
                        }
                    }
                }
            }
            (half, right, gradient, diagonal)
        };
        let parts: Vec<_> = self.runs.par_iter().map(run).collect();
        let sum = parts.into_iter().reduce(|a, b| (a.0 + b.0, a.1 + b.1, a.2 + b.2, a.3 + b.3));
        let (half, right, gradient, diagonal) =
            sum.unwrap_or_else(|| (DMatrix::zeros(n, n), DVector::zeros(n), DVector::zeros(n), DVector::zeros(n)));
        ReducedSystem { matrix: &half + half.transpose(), right, gradient, diagonal }
    }

    /// Adds a block to the columns of two observations.
    fn add(&self, to: &mut DMatrix<f64>, a: &SystemObservation, b: &SystemObservation, block: &SMatrix<f64, 9, 9>) {
        let [(_, _, pose), (_, _, lens)] = self.columns(a);
        let (size, all) = (self.size, to.as_mut_slice());
        for (from, count, start) in self.columns(b) {
            for column in 0..count {
                let target = &mut all[(start + column) * size..][..size];
                let column = block.column(from + column);
                let (of_pose, of_lens) = column.as_slice().split_at(6);
                target[pose..pose + 6].iter_mut().zip(of_pose).for_each(|(to, b)| *to += b);
                target[lens..lens + 3].iter_mut().zip(of_lens).for_each(|(to, b)| *to += b);
            }
        }
    }

    /// Computes the steps of the points from the step of the cameras. Also computes the points'
    /// contribution to the decrease of the quadratic model.
    pub fn back_substitute(&self, state: &Parameters, damping: f64, step: &DVector<f64>) -> (Vec<Vector3<f64>>, f64) {
        let run = |run: &std::ops::Range<usize>| {
            let mut fall = 0.0;
            let moved = run.clone().map(|point| {
                let block = self.block(state, point, damping);
                let mut right = block.gradient;
                for (row, observation) in block.rows.iter().zip(self.observations_of(point)) {
                    let mut along = Vector2::zeros();
                    for (from, count, to) in self.columns(observation) {
                        (0..count).for_each(|k| along += row.by_camera.column(from + k) * step[to + k]);
                    }
                    right += row.by_point.transpose() * along;
                }
                let change = -(block.inverse * right);
                fall += 0.5 * change.dot(&(block.damping.component_mul(&change) - block.gradient));
                state.points[point] + change
            });
            (moved.collect::<Vec<_>>(), fall)
        };
        let parts: Vec<_> = self.runs.par_iter().map(run).collect();
        let fall = parts.iter().map(|part| part.1).sum();
        (parts.into_iter().flat_map(|part| part.0).collect(), fall)
    }

    /// Returns the poses and lenses that result from a step.
    pub fn apply_step(&self, state: &Parameters, step: &DVector<f64>) -> (Vec<Pose>, Vec<Lens>) {
        let (mut poses, mut lenses) = (state.poses.clone(), state.lenses.clone());
        let three = |at: usize| Vector3::new(step[at], step[at + 1], step[at + 2]);
        for (i, pose) in poses.iter_mut().enumerate() {
            pose.rotation = crate::model::rotation_of(&three(6 * i)) * pose.rotation;
            pose.translation += three(6 * i + 3);
        }
        for (i, lens) in lenses.iter_mut().enumerate() {
            let change = three(6 * self.poses + 3 * i);
            lens.focal += change.x;
            lens.distortion[0] += change.y;
            lens.distortion[1] += change.z;
        }
        (poses, lenses)
    }

    /// Returns the number of residual components, which is two for each observation.
    pub fn residual_count(&self) -> usize {
        2 * self.observations.len()
    }
}
