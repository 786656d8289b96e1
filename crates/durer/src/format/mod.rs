//! File formats. Readers see bytes and make plain data; they never see a world.
pub mod course;
