//! Tools for teaching: checks that explain why a picture is wrong, a collection of common mistakes,
//! and the lesson.

pub mod check;
pub mod lesson;
pub mod mistakes;
