//! Tools for teaching: checks that explain a wrong picture, common mistakes, and the lesson.

pub mod check;
pub mod lesson;
pub mod mistakes;
