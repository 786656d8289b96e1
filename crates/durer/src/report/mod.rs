//! Explanations, findings and comparisons as JSON reports, which the command-line option `--json`
//! prints.
//!
//! [`explanation`] shows why a pixel has its colour, [`findings`] lists likely mistakes in a scene,
//! and [`comparison`] shows how two pictures differ. [`outlines`] and [`lights`] are used for
//! drawing the scene.

mod check;
mod compare;
mod explain;
mod outlines;

pub use check::{finding, findings, place};
pub use compare::comparison;
pub use explain::{Explained, explanation};
pub use outlines::{LightMark, light_marks, lights, object_outlines, outlines};
