//! Covariance of estimated cameras.
//!
//! If each component of each observation has an error of σ pixels, the parameters near the solution
//! have the covariance σ² (Jᵀ J)⁻¹. The covariance of the cameras is σ² times the inverse of the
//! reduced matrix. Photographs do not determine the position, orientation, and scale of the
//! reconstruction. These are therefore fixed by holding two values constant: the pose of the first
//! photograph, and the largest component of the translation from it to the most distant photograph.
//!
//! Source: Hartley, Zisserman, *Multiple View Geometry in Computer Vision*, 2nd edition, 2004,
//! sections 5.2 and A6.

use super::{AdjustmentProblem, Loss, Options};
use crate::{Error, Reconstruction};
use nalgebra::{Cholesky, DMatrix, Matrix6};

/// Covariance matrix of all camera and lens parameters of a reconstruction, computed by
/// [`covariance`] from the residuals.
pub struct Covariance {
    /// Standard deviation in pixels of one component of an observation, estimated from the
    /// residuals.
    pub sigma: f64,
    /// Photograph number of each known pose, and the first of its six columns: a rotation ω that
    /// replaces R by exp(\[ω\]×) R, followed by the translation.
    pub views: Vec<(usize, usize)>,
    /// Covariance matrix of all cameras, with six rows per pose, followed by three rows per lens
    /// (f, k1, k2). Entries of fixed parameters are zero.
    pub matrix: DMatrix<f64>,
    /// Row indices of the free parameters in `matrix`.
    pub free: Vec<usize>,
}

impl Covariance {
    /// Returns the 6x6 covariance matrix of a photograph's pose, with the rotation first, or `None`
    /// if the pose is unknown.
    pub fn pose(&self, view: usize) -> Option<Matrix6<f64>> {
        let (_, at) = *self.views.iter().find(|(number, _)| *number == view)?;
        Some(self.matrix.fixed_view::<6, 6>(at, at).into_owned())
    }

    /// Returns the standard deviation of a camera's position, as a length in world units.
    pub fn position_deviation(&self, reconstruction: &Reconstruction, view: usize) -> Option<f64> {
        let (pose, covariance) = (reconstruction.views[view].pose?, self.pose(view)?);
        let turn = pose.rotation.transpose();
        let mut jacobian = nalgebra::Matrix3x6::zeros();
        // R becomes (1 + [ω]×) R, so C = -Rᵀ t changes by -Rᵀ [ω]×ᵀ t = Rᵀ (ω × t) = -Rᵀ [t]× ω.
        jacobian.fixed_columns_mut::<3>(0).copy_from(&(-turn * pose.translation.cross_matrix()));
        jacobian.fixed_columns_mut::<3>(3).copy_from(&-turn);
        Some((jacobian * covariance * jacobian.transpose()).trace().max(0.0).sqrt())
    }
}

/// Computes the covariance of the cameras after bundle adjustment. `options` must be the options
/// that the adjustment used.
///
/// # Errors
///
/// Returns an error if the observations do not determine all cameras, or if fewer than two poses
/// are known.
pub fn covariance(reconstruction: &Reconstruction, options: &Options) -> Result<Covariance, Error> {
    let options = Options { loss: Loss::Squared, ..*options };
    // A point with a single observation does not constrain the cameras, and its own position is
    // undetermined.
    let known = |observation: &&crate::Observation| reconstruction.views[observation.view].pose.is_some();
    let mut kept = reconstruction.clone();
    kept.points.retain(|point| !options.points || point.track.iter().filter(known).count() > 1);
    let (system, state, views) = AdjustmentProblem::new(&kept, options);
    if views.len() < 2 {
        return Err(Error::new("a covariance needs at least two photographs whose pose is known"));
    }
    let reduced = system.reduce(&state, 0.0);
    let first = state.poses[0].center();
    // Compute the translations of the other photographs relative to the first one.
    let from_first = |i: usize| state.poses[i].apply(&first);
    let far = (1..views.len()).fold(1, |far, i| if from_first(i).norm() > from_first(far).norm() { i } else { far });
    let scale = from_first(far).iamax();
    let free: Vec<usize> =
        (6..system.size).filter(|i| *i != 6 * far + 3 + scale && reduced.diagonal[*i] > 0.0).collect();
    let part = DMatrix::from_fn(free.len(), free.len(), |i, j| reduced.matrix[(free[i], free[j])]);
    let size: Vec<f64> = free.iter().map(|i| reduced.matrix[(*i, *i)].max(0.0).sqrt()).collect();
    let scaled = DMatrix::from_fn(free.len(), free.len(), |i, j| part[(i, j)] / (size[i] * size[j]));
    let inverse = Cholesky::new(scaled).map(|factor| factor.inverse()).filter(|m| m.iter().all(|c| c.is_finite()));
    let inverse = inverse.ok_or_else(|| Error::new("at least one camera is not determined by the observations"))?;
    let unknowns = free.len() + if options.points { 3 * kept.points.len() } else { 0 };
    let spare = system.residual_count().saturating_sub(unknowns).max(1);
    let sigma = (2.0 * system.cost(&state) / spare as f64).sqrt();
    let mut matrix = DMatrix::zeros(system.size, system.size);
    for (i, row) in free.iter().enumerate() {
        for (j, column) in free.iter().enumerate() {
            matrix[(*row, *column)] = sigma * sigma * inverse[(i, j)] / (size[i] * size[j]);
        }
    }
    let views = views.into_iter().enumerate().map(|(i, view)| (view, 6 * i)).collect();
    Ok(Covariance { sigma, views, matrix, free })
}
