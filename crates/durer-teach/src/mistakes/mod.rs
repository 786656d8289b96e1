//! Common mistakes in student programs, and the pictures that they cause.
//!
//! A row of [`MISTAKES`] describes an error in words and shows the correct and the wrong code. It
//! changes a [`SceneVariant`] so that the picture of a [`BuggyTracer`] shows the error.
//! [`diagnose()`] renders with all rows, both alone and in pairs, and returns the rows that explain
//! a given picture. The lesson shows some of the mistakes. A new mistake is added by adding a row.

mod buggy_tracer;
pub mod bugs;
mod diagnose;
mod fit;
mod input;
mod path_bugs;
mod paths;
mod pictures;
mod speckles;
mod table;
mod variant;

#[cfg(test)]
mod tests;

pub use buggy_tracer::BuggyTracer;
pub use input::{Diagnosis, DiagnosisInput, Explanation};
pub use path_bugs::PathBugs;
pub use pictures::mistaken_picture;
pub use table::{Formulas, MISTAKES, Mistake, Values, mistake_by_name};
pub use variant::SceneVariant;

/// Finds the mistakes that explain a picture, using the rendering method of the job. `reported`
/// receives the progress as a number from 0 to 1.
pub fn diagnose(input: &DiagnosisInput, reported: &(dyn Fn(f64) + Sync)) -> Diagnosis {
    match input.job.method.path_options() {
        Some(_) => paths::diagnose(input, reported),
        None => diagnose::diagnose(input, reported),
    }
}

/// Returns the fraction of the reference in which a render of the scene differs from it. This is a
/// fraction of a sample of pixels or, with path tracing, of the blocks that differ by more than
/// noise.
pub fn off(input: &DiagnosisInput) -> f64 {
    match input.job.method.path_options() {
        Some(_) => paths::off(input),
        None => diagnose::reference_difference(input),
    }
}
