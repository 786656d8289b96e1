//! Any bytes as a scene of pbrt's.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::model(data, "x.pbrt"));
