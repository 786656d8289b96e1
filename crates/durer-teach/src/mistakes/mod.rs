//! Common mistakes as one table, and their pictures of a scene.
//!
//! A row of [`MISTAKES`] describes an error of a student's program in words and as correct and
//! wrong code, and changes a [`SceneVariant`] so that a [`BuggyTracer`]'s picture shows it.
//! [`diagnose()`] renders the rows, alone and in pairs, and names the one that explains a given
//! picture. The lesson shows some of them. A new mistake is a new row.

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

/// Tries all mistakes of the job's method. `reported` receives the progress, from 0 to 1.
pub fn diagnose(question: &DiagnosisInput, reported: &(dyn Fn(f64) + Sync)) -> Diagnosis {
    match question.job.method.transport() {
        Some(_) => paths::diagnose(question, reported),
        None => diagnose::diagnose(question, reported),
    }
}

/// Returns the fraction of the reference in which the scene's own picture differs from it: of a
/// sample of its pixels, or with path tracing of the blocks that differ by more than noise.
pub fn off(question: &DiagnosisInput) -> f64 {
    match question.job.method.transport() {
        Some(_) => paths::off(question),
        None => diagnose::off(question),
    }
}
