//! Tests of the reconstruction of cameras from photographs.
//! They are one program, so that they are linked once.

mod closed_loop;
mod conventions;
mod features;
mod geometry;
mod samples;
