//! Arbitrary bytes as an STL mesh.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::mesh(data, "x.stl"));
