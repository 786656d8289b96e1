//! Common mistakes of student programs, and the pictures that they cause.
//!
//! A row of [`MISTAKES`] describes an error in words and as correct and wrong code. It changes a
//! [`SceneVariant`] so that the picture of a [`BuggyTracer`] shows the error. [`diagnose()`]
//! renders with all rows, alone and in pairs, and returns the ones that explain a given picture.
//! The lesson shows some of them. To add a mistake, add a row.

mod buggy_tracer;
pub mod bugs;
mod diagnose;
mod path_habits;
mod paths;
mod pictures;
mod question;
mod search;
mod speckles;
mod table;
mod variant;

#[cfg(test)]
mod tests;

pub use buggy_tracer::BuggyTracer;
pub use path_habits::Paths;
pub use question::{Diagnosis, DiagnosisInput, Explanation};
pub use table::{Formulas, MISTAKES, Mistake, Values, of_name};
pub use variant::SceneVariant;

/// Finds the mistakes that explain a picture, with the method of the job. `reported` receives the
/// progress, from 0 to 1.
pub fn diagnose(question: &DiagnosisInput, reported: &(dyn Fn(f64) + Sync)) -> Diagnosis {
    match question.job.method.path_options() {
        Some(_) => paths::diagnose(question, reported),
        None => diagnose::diagnose(question, reported),
    }
}

/// Returns the share of the reference in which a render of the scene differs from it: share of a
/// sample of pixels or, with path tracing, of the blocks that differ by more than noise.
pub fn off(question: &DiagnosisInput) -> f64 {
    match question.job.method.path_options() {
        Some(_) => paths::off(question),
        None => diagnose::off(question),
    }
}
