//! Common mistakes as one table, and their pictures of a scene.
//!
//! A row of [`MISTAKES`] states an error of a student's program in words and in both forms of the
//! code, and changes a [`Variant`] so that a [`Pupil`]'s picture shows it. [`diagnose()`] renders
//! the rows, alone and in pairs, and names the one that explains a given picture; the lesson shows
//! some of them. A new mistake is a new row.

mod diagnose;
pub mod habits;
pub mod paths;
mod pictures;
mod pupil;
mod search;
mod speckles;
mod table;
mod variant;

#[cfg(test)]
mod tests;

pub use diagnose::{Diagnosis, Named, Question, diagnose, off};
pub use pupil::Pupil;
pub use table::{Formulas, MISTAKES, Mistake, Values, of_name};
pub use variant::Variant;
