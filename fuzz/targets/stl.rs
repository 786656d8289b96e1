//! Any bytes as a mesh of triangles alone.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::mesh(data, "x.stl"));
