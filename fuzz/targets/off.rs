//! Arbitrary bytes as an OFF mesh.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::mesh(data, "x.off"));
