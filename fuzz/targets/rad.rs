//! Arbitrary bytes as a Radiance scene.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::model(data, "x.rad"));
