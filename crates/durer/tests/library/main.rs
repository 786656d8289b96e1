//! Tests of the library as other programs see it.
//! They are one program, so that they are linked once.

mod examples;
mod layering;
mod official_hits;
mod official_values;
mod public_api;
mod quirks;
mod scenes;
