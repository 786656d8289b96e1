//! Arbitrary bytes as a PLY mesh.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::mesh(data, "x.ply"));
