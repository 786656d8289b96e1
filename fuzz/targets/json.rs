//! Arbitrary bytes as a JSON scene.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::json(data));
