//! Teaching tools: checks that explain an odd picture, common mistakes, and the lesson.

pub mod check;
pub mod lesson;
pub mod mistakes;
