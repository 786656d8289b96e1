//! Reports as JSON, in the form of the command's `--json`: explanations, findings, comparisons.
//!
//! [`explanation`] shows why a pixel has its colour, [`findings`] why a scene's picture may be odd,
//! [`comparison`] how two pictures differ. [`outlines`] and [`lights`] draw the scene around them.

mod check;
mod compare;
mod explain;
mod outlines;

pub use check::{finding, findings, place};
pub use compare::comparison;
pub use explain::{Subject, explanation};
pub use outlines::{LightMark, light_marks, lights, object_outlines, outlines};
