//! Arbitrary bytes as a scene, in every dialect.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| durer::fuzz::scene(data));
