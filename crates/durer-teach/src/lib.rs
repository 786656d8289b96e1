//! Teaching tools: checks that explain an odd picture, the usual mistakes, and the lesson.

pub mod check;
pub mod lesson;
pub mod mistakes;
